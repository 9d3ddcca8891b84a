"""References to laws by file and name, such as ``walk.py:walk``, in scenario files."""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple, Self

from mars2d.core.description import wrong

EXPECTED = "where a law stands, such as 'walk.py:walk': a file of Python, and a function in it"

MAX_UP = 2
"""The number of folders up to a file that is still named by a relative path."""


class Reference(NamedTuple):
    """A function by its file and its name there.

    >>> Reference.read("control", "team.py")
    Reference(file='team.py', name='control')
    """

    file: str
    name: str

    @classmethod
    def of(cls, function: Callable[..., Any] | None) -> Self | None:
        """Return the reference to a function, with the absolute path of its file.

        None for functions that can't be found by name: lambdas, closures, partials, objects.
        """
        if not inspect.isfunction(function):
            return None
        file, name = Path(function.__code__.co_filename), function.__name__
        if function.__globals__.get(name) is not function or file.suffix != ".py":
            return None
        return cls(str(file.absolute()), name) if file.is_file() else None

    @classmethod
    def read(cls, field: str, value: object) -> Self:
        """Return the reference that ``FILE:FUNCTION`` names; a file alone means its `control`.

        Raises InputError, which begins with `field`, for anything else.
        """
        if not isinstance(value, str):
            raise wrong(field, value, EXPECTED)
        file, colon, name = value.rpartition(":")
        if not colon or value.endswith(".py"):  # the colon may be that of C:\walk.py
            file, name = value, "control"
        if not file.endswith(".py") or not name.isidentifier():
            raise wrong(field, value, EXPECTED)
        return cls(file, name)


def seen_from(file: str, folder: Path) -> str:
    """Return the path of a file seen from `folder`: relative unless it is far away.

    A way that leads through the root of all folders is none: the absolute path is shorter.
    """
    whole, here = os.path.normpath(file), os.path.normpath(folder.absolute())
    try:
        shared, relative = os.path.commonpath([whole, here]), os.path.relpath(whole, here)
    except ValueError:  # on another drive
        return Path(whole).as_posix()
    near = shared != Path(here).anchor and Path(relative).parts.count("..") <= MAX_UP
    return Path(relative if near else whole).as_posix()
