"""Hints at corrections, for the exceptions that the user's code raises."""

from __future__ import annotations

import builtins
import sys
import traceback
from collections.abc import Callable
from importlib import import_module
from types import FrameType

from mars2d.core.errors import InputError, likely
from mars2d.core.words import instead

ROOMS = ("mars2d", "mars2d.sensors", "mars2d.addons", "mars2d.bodies", "mars2d.geometry")
"""The packages whose names people import."""

ABBREVIATIONS = {"np": "import numpy as np", "plt": "import matplotlib.pyplot as plt"}

LIBRARIES = ("numpy", "scipy", "matplotlib", "pygame", "pymunk", "mars2d")


def described(error: BaseException) -> str:
    """Return the message of an exception in the user's code, with a hint at the correction."""
    name, said = type(error).__name__, str(error)
    if isinstance(error, InputError) and said:
        return said
    if isinstance(error, ImportError):
        said = said.partition(" (")[0]  # the path of the module helps nobody
    text = f"{name}: {said}" if said else name
    for kind, hint in _HINTS.items():
        if isinstance(error, kind):
            return text + hint(error)
    line = _line_of(error)
    for kind, part, code, meant in _TEXTS:
        if isinstance(error, kind) and part in said and code in line:
            return f"{text}; {meant}"
    return text


def _of_unbound(error: UnboundLocalError) -> str:
    """Return how a law keeps a number: ``integral += ...`` makes a local one."""
    name, frame = error.name or _quoted(error), _innermost(error)
    if frame is not None and name in frame.f_globals:
        keep = f"robot.memory.{name}" if "robot" in frame.f_locals else "an object of your own"
        return f"; a function that assigns {name!r} has its own: keep it in {keep}"
    return "; give it a value first, in each branch"


def _of_name(error: NameError) -> str:
    """Return the import that lacks, or the known name that is nearest."""
    name, frame = error.name or _quoted(error), _innermost(error)
    if name in ABBREVIATIONS:
        return f"; write `{ABBREVIATIONS[name]}` at the top"
    if name in sys.stdlib_module_names or name in LIBRARIES:
        return f"; write `import {name}` at the top"
    known = set() if frame is None else {*frame.f_locals, *frame.f_globals}
    line = _import_of(name)
    if line:
        return f"; write `{line}` at the top"
    said = {each for each in dir(builtins) if each.islower()}
    return instead(name, "a room") or likely(name, known | said)


def _of_attribute(error: AttributeError) -> str:
    """Return the attribute that is nearest, or how to go without setting it."""
    if "has no setter" in str(error):
        return "; it can't be set: a law returns its command, and keeps things in robot.memory"
    known = {name for name in dir(error.obj) if not name.startswith("_")}
    return likely(error.name, known)


def _of_import(error: ImportError) -> str:
    """Return where a name is, or the package that is nearest."""
    if isinstance(error, ModuleNotFoundError):
        modules = [*ROOMS, *LIBRARIES]
        if (error.name or "").startswith("mars2d."):
            return likely(error.name, ROOMS, 0.6) or f"; there are {', '.join(ROOMS[1:])}"
        return likely(error.name, modules, 0.7)
    name = _quoted(error)
    if not (error.name or "").startswith("mars2d"):
        return ""
    line = _import_of(name)
    if line:
        return f"; write `{line}`"
    known = {each for room in ROOMS for each in import_module(room).__all__}
    return instead(name, "a room") or likely(name, known, 0.7)


_TEXTS: list[tuple[type[BaseException], str, str, str]] = [
    (TypeError, "'numpy.ndarray' object is not callable", "",
     "it is an array: write it without the brackets ()"),
    (TypeError, "object is not callable", "robot.drive(",
     "a law returns its command, such as `return v, omega`"),
    (ValueError, "read-only", "", ("a law can't change the world: it returns its command. "
     "To calculate with an array, take a copy: pose.copy()")),
    (ValueError, "to unpack", ".pose", "a pose is three numbers: x, y, theta = robot.pose"),
    (IndexError, "", ".position[", "a position is (x, y); the angle is pose[2]"),
    (IndexError, "", ".pose[", "a pose is (x, y, theta), from 0 to 2"),
    (EOFError, "", "input(", ("nobody answers while a simulation runs: make it a parameter "
     "of scenario(...)")),
]  # fmt: skip
"""The hint at an exception, by its class, and what its text and the line of code contain."""


_HINTS: dict[type[BaseException], Callable[..., str]] = {
    UnboundLocalError: _of_unbound,
    NameError: _of_name,
    AttributeError: _of_attribute,
    ImportError: _of_import,
}
"""The hint at an exception that has a name in it, by its class; the first that fits."""


def _innermost(error: BaseException) -> FrameType | None:
    """Return the frame in which an exception was raised."""
    frames = [frame for frame, _ in traceback.walk_tb(error.__traceback__)]
    return frames[-1] if frames else None


def _line_of(error: BaseException) -> str:
    """Return the line of code in which an exception was raised, or ""."""
    steps = traceback.extract_tb(error.__traceback__)
    return (steps[-1].line or "") if steps else ""


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
