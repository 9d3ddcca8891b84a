"""Hints at corrections, for the exceptions that the user's code raises."""

from __future__ import annotations

import builtins
import sys
import traceback
from importlib import import_module

from mars2d.core.errors import InputError, likely
from mars2d.core.words import instead

ROOMS = ("mars2d", "mars2d.sensors", "mars2d.addons", "mars2d.bodies", "mars2d.geometry")
"""The packages whose names people import."""

ABBREVIATIONS = {"np": "import numpy as np", "plt": "import matplotlib.pyplot as plt"}

_FIXED: list[tuple[type[BaseException], str, str, str]] = [
    (AttributeError, "has no setter", "",
     "it can't be set: a law returns its command, and keeps things in robot.memory"),
    (TypeError, "'numpy.ndarray' object is not callable", "",
     "it is an array: write it without the brackets ()"),
    (TypeError, "object is not callable", "robot.drive(",
     "a law returns its command, such as `return v, omega`"),
    (ValueError, "read-only", "",
     "a law can't change the world: it returns its command. Calculate with a copy: pose.copy()"),
    (ValueError, "to unpack", ".pose", "a pose is three numbers: x, y, theta = robot.pose"),
    (IndexError, "", ".position[", "a position is (x, y); the angle is pose[2]"),
    (IndexError, "", ".pose[", "a pose is (x, y, theta), from 0 to 2"),
    (EOFError, "", "input(",
     "nobody answers while a simulation runs: make it a parameter of scenario(...)"),
]  # fmt: skip
"""The class of an exception, a part of its text, a part of its line, and the hint."""


def described(error: BaseException) -> str:
    """Return the message of an exception in the user's code, with a hint at the correction."""
    name, said = type(error).__name__, str(error)
    if isinstance(error, InputError) and said:
        return said
    if isinstance(error, ImportError):
        said = said.partition(" (")[0]  # the path of the module helps nobody
    text = f"{name}: {said}" if said else name
    steps = traceback.extract_tb(error.__traceback__)
    line = (steps[-1].line or "") if steps else ""
    for kind, part, code, hint in _FIXED:
        if isinstance(error, kind) and part in said and code in line:
            return f"{text}; {hint}"
    if isinstance(error, NameError):
        return text + _of_name(error)
    if isinstance(error, AttributeError):
        return text + likely(error.name, {n for n in dir(error.obj) if not n.startswith("_")})
    return text + _of_import(error) if isinstance(error, ImportError) else text


def _of_name(error: NameError) -> str:
    """Return how to keep a number, the import that is missing, or the nearest known name."""
    name, known = error.name or _quoted(error), {n for n in dir(builtins) if n.islower()}
    frames = [frame for frame, _ in traceback.walk_tb(error.__traceback__)]
    if isinstance(error, UnboundLocalError):  # ``integral += ...`` makes a local one
        if not frames or name not in frames[-1].f_globals:
            return "; give it a value first, in each branch"
        law = "robot" in frames[-1].f_locals
        keep = f"robot.memory.{name}" if law else "an object of your own"
        return f"; a function that assigns {name!r} has its own: keep it in {keep}"
    line = ABBREVIATIONS.get(name) or _import_of(name)
    if name in sys.stdlib_module_names or name in ("numpy", "mars2d"):
        line = f"import {name}"
    if line:
        return f"; write `{line}` at the top"
    known |= {*frames[-1].f_locals, *frames[-1].f_globals} if frames else set()
    return instead(name, "a room") or likely(name, known)


def _of_import(error: ImportError) -> str:
    """Return where a name is, or the package that is nearest."""
    module = error.name or ""
    if isinstance(error, ModuleNotFoundError):
        return likely(module, ROOMS, 0.6)
    if not module.startswith("mars2d"):
        return ""
    if line := _import_of(name := _quoted(error)):
        return f"; write `{line}`"
    return instead(name, "a room") or likely(name, import_module(module).__all__, 0.7)


def _quoted(error: BaseException) -> str:
    """Return the first name that the text of an exception quotes, or ""."""
    return str(error).partition("'")[2].partition("'")[0]


def _import_of(name: str) -> str:
    """Return the line that imports a name, in whatever letters it is written, or ""."""
    for room in ROOMS:
        for each in import_module(room).__all__:
            if each.lower() == name.lower():
                return f"from {room} import {each}"
    return ""
