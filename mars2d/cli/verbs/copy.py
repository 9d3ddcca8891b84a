"""The verb ``copy``."""

from __future__ import annotations

import argparse
import shlex
import shutil
from pathlib import Path

from mars2d.cli.arguments import option
from mars2d.core.errors import InputError, nearest
from mars2d.core.terminal import tell
from mars2d.scenario.examples import GAME, examples
from mars2d.scenario.experiment import open_experiment

ARGUMENTS = {
    "example": option("EXAMPLE", "its name, as in mars2d demo"),
    "folder": option("FOLDER", "else here", nargs="?", default="."),
}


def execute(arguments: argparse.Namespace) -> None:
    """Copy an example, with its laws and maps, to change it."""
    name, folder = arguments.example, Path(arguments.folder)
    if name not in examples():
        raise InputError(f"there is no example {name!r}{nearest(name, examples())}")
    path = examples()[name]
    if path.name == GAME:
        sources = [path.parent]
    else:
        read = [file.relative_to(path.parent) for file in open_experiment(path).source.written]
        sources = sorted({path.parent / file.parts[0] for file in read})
    for source in sources:
        if (folder / source.name).exists():
            hint = f"name a folder, as mars2d copy {name} mine"
            raise InputError(f"{folder / source.name}: is there already; {hint}")
    folder.mkdir(parents=True, exist_ok=True)
    for source in sources:
        if source.is_dir():
            unwanted = shutil.ignore_patterns("__pycache__", "light.png", "dark.png", "solution.py")
            shutil.copytree(source, folder / source.name, ignore=unwanted)
        else:
            shutil.copyfile(source, folder / source.name)
    copied = ", ".join(f"{each.name}/" if each.is_dir() else each.name for each in sources)
    run = shlex.join(["mars2d", "run", str(folder / path.relative_to(sources[0].parent))])
    tell(f"{copied}: copied; run it: {run}")
