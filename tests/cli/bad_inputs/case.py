"""A bad input: what a user types, the files that lie there, and what the user must be told."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

__all__ = ["HEAD", "Case", "Content", "experiment", "script", "typed"]

Content = str | bytes | Callable[[], bytes] | None
"""What a file holds; what makes it, where that takes long; None is a folder."""

HEAD = """\
import numpy as np
from mars2d import *
from mars2d.addons import *
from mars2d.bodies.joints import *
from mars2d.bodies.props import *
from mars2d.sensors import *
from mars2d.geometry import *
"""
"""The first lines of all Python files here: what a user writes begins in line 8."""

OWN_HANDLER = """\
except InputError as error:
    print(f"{type(error).__name__}: {error}", file=sys.stderr)
    sys.exit(2)
"""


@dataclass(frozen=True)
class Case:
    """One bad input.

    name: of the test. command: as it is typed in a shell. words: all that must be in what is said
    on stderr. files: those in the folder where it is typed.
    """

    name: str
    command: str
    words: tuple[str, ...]
    files: Mapping[str, Content] = field(default_factory=dict)


def typed(name: str, command: str, *words: str, **files: Content) -> Case:
    """Return a command with what it must say; a file's name is written with __ for its dot."""
    return Case(name, command, words, {k.replace("__", "."): v for k, v in files.items()})


def experiment(name: str, code: str, *words: str, stop: float = 0.5) -> Case:
    """Return a run of an experiment with a mistake in it: what is said names the file."""
    command = f"mars2d run bad.py --headless --stop-time {stop}"
    return Case(name, command, ("bad.py", *words), {"bad.py": HEAD + code + "\n"})


def script(name: str, code: str, *words: str, **files: Content) -> Case:
    """Return a script that uses mars2d as a library, and prints the InputError that it gets."""
    body = "".join(f"    {line}\n" for line in code.splitlines())
    text = f"import sys\n{HEAD}try:\n{body}{OWN_HANDLER}"
    return typed(name, "python script.py", *words, script__py=text, **files)
