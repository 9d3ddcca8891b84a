"""The code of a law: its own file and those beside it that it imports."""

from __future__ import annotations

import re
from pathlib import Path

from mars2d.scenario.policy import SUFFIX as POLICY

IMPORT = re.compile(rb"(?:^|[;:])\s*(?:from|import)\s+([a-zA-Z0-9_., \t]+)", re.MULTILINE)


def law_code(law: Path) -> dict[Path, bytes]:
    """Return the contents of a law's file and of the files beside it that it imports, by path.

    All .py files of an imported folder count. The files are not run; imports are found in the text.
    """
    contents: dict[Path, bytes] = {}
    waiting = [law]
    while waiting:
        path = waiting.pop()
        if path in contents or not path.is_file():
            continue
        contents[path] = path.read_bytes()
        if path.suffix != POLICY:  # which imports nothing
            lines = re.findall(IMPORT, contents[path])
            words = {
                word.decode() for line in lines for word in re.findall(rb"[a-zA-Z0-9_]+", line)
            }
            for folder in dict.fromkeys((path.parent, law.parent)):
                for name in sorted(words):
                    waiting += [folder / f"{name}.py", *sorted((folder / name).rglob("*.py"))]
    return contents
