"""Hints at corrections, for the exceptions that the user's code raises."""

from __future__ import annotations

import ast
import builtins
import linecache
import sys
import traceback
from collections.abc import Iterator
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from mars2d.core.errors import InputError, likely
from mars2d.core.words import instead

ROOMS = ("mars2d", "mars2d.sensors", "mars2d.addons", "mars2d.bodies", "mars2d.geometry")
"""The packages whose names people import."""

ABBREVIATIONS = {"np": "import numpy as np", "plt": "import matplotlib.pyplot as plt"}

_FIXED: list[tuple[type[BaseException], str, str]] = [
    (AttributeError, "has no setter",
     "it can't be set: a law returns its command, and keeps things in robot.memory"),
    (ValueError, "read-only",
     "a law can't change the world: it returns its command. Calculate with a copy: pose.copy()"),
    (TypeError, "to Python scalars",
     "it is an array: write np.cos in place of math.cos, and so on"),
    (TypeError, "'builtin_function_or_method'", "it is called with brackets, as x.min()"),
    (EOFError, "",
     "nobody answers while a simulation runs: make it a parameter of scenario(...)"),
]  # fmt: skip
"""The class of an exception, a part of its text, and the hint."""

_PARTS = {
    "pose": "a pose is three numbers: x, y, theta = robot.pose, or pose[0] to pose[2]",
    "position": "a position is (x, y); the angle is pose[2]",
}
"""What there is in arrays of the views, by their names."""


def described(error: BaseException) -> str:
    """Return the message of an exception in the user's code, with a hint at the correction."""
    name, said = type(error).__name__, str(error)
    if isinstance(error, InputError) and said:
        return said
    if isinstance(error, ImportError):
        said = said.partition(" (")[0]  # the path of the module helps nobody
    if "truth value" in said:
        said = said.partition(". ")[0]  # what numpy advises is not what is meant
    text = f"{name}: {said}" if said else name
    for kind, part, hint in _FIXED:
        if isinstance(error, kind) and part in said:
            return f"{text}; {hint}"
    if isinstance(error, NameError):
        return text + _of_name(error)
    if isinstance(error, AttributeError):
        near = likely(error.name, {n for n in dir(error.obj) if not n.startswith("_")})
        return text + (near or _of_values(error))
    if isinstance(error, ImportError):
        return text + _of_import(error)
    if isinstance(error, FileNotFoundError):
        beside = "a file beside this one is Path(__file__).with_name('NAME')"
        return f"{text}; relative names begin in the current folder, {Path.cwd()}; {beside}"
    if isinstance(error, (TypeError, ValueError, IndexError)):
        return text + _of_values(error)
    return text


def _of_values(error: BaseException) -> str:
    return next(filter(None, (_of_value(error, *each) for each in _failed(error))), "")


def _failed(error: BaseException) -> Iterator[tuple[ast.AST, ast.expr, Any]]:
    """Yield what an expression that failed was made of, with its value, and what is done with it.

    What stands in it furthest out comes first. Only names, attributes and items are evaluated
    again: they were evaluated there just before.
    """
    frames = [*traceback.walk_tb(error.__traceback__)]
    steps = traceback.extract_tb(error.__traceback__)
    step = steps[-1] if steps else None
    if step is None or step.lineno is None:
        return
    lines = linecache.getlines(step.filename)[step.lineno - 1 : step.end_lineno] or [""]
    if "to unpack" not in str(error):
        lines[-1] = lines[-1].encode()[: step.end_colno].decode()
        lines[0] = lines[0].encode()[step.colno or 0 :].decode()
    code = " ".join(map(str.strip, lines)).removeprefix("el")
    with suppress(SyntaxError, ValueError):
        tree = ast.parse(code + " pass" if code.endswith(":") else code)
        for parent in ast.walk(tree):
            for node in ast.iter_child_nodes(parent):
                if isinstance(node, (ast.Name, ast.Attribute, ast.Subscript)):
                    value = None
                    if not any(isinstance(each, ast.Call) for each in ast.walk(node)):
                        frame, asked = frames[-1][0], compile(ast.unparse(node), "", "eval")
                        with suppress(Exception):
                            value = eval(asked, frame.f_globals, frame.f_locals)
                    yield parent, node, value


def _of_value(error: BaseException, parent: ast.AST, node: ast.expr, value: Any) -> str:
    """Return what to write in place of what was done with a value, or ""."""
    said, what, last = str(error), ast.unparse(node), getattr(node, "attr", "")
    size = len(value) if hasattr(value, "__len__") and np.shape(value) else 0
    if "truth value" in said and isinstance(value, np.ndarray) and value.size != 1:
        if value.dtype.names:
            return f"; {what} has a row for each: write len({what}) > 0"
        if isinstance(parent, ast.Compare) and isinstance(parent.ops[0], (ast.Eq, ast.NotEq)):
            sides = f"{ast.unparse(parent.left)}, {ast.unparse(parent.comparators[0])}"
            return f"; whether they are near says np.linalg.norm(np.subtract({sides})) < 0.01"
        if value.dtype == bool:
            return f"; {what} has {size} of them: write any({what})"
        least = f", or the least, min({what}) < 0.5" if np.ndim(value) == 1 else ""
        return f"; {what} has {size} numbers: compare one of them, as {what}[0] < 0.5{least}"
    parts = "broadcast" in said or isinstance(error, AttributeError)
    if last in _PARTS and ("unpack" in said or (parts and np.ndim(value) == 1)):
        return f"; {_PARTS[last]}"
    if isinstance(error, IndexError) and isinstance(parent, ast.Subscript) and parent.value is node:
        if last in _PARTS and np.ndim(value) == 1:
            return f"; {_PARTS[last]}"
        if isinstance(parent.slice, ast.Tuple):
            ends = ", ".join(str(count - 1) for count in np.shape(value))
            return f"; its shape is {np.shape(value)}: the last one is {what}[{ends}]"
        return f"; there are {what}[0] to {what}[{size - 1}]" if size else f"; {what} is empty"
    if "indices must be" in said and size and hasattr(value[0], "name"):
        names = ", ".join(f"{what}[{i}]: {each.name}" for i, each in enumerate(value[:4]))
        return f"; they have numbers, not names: {names}"
    if not isinstance(parent, ast.Call) or parent.func is not node:
        return ""
    if "not callable" in said and last == "drive":
        return "; a law returns its command, such as `return v, omega`"
    if "not callable" in said and value is not None:
        return f"; write it without the brackets: {what}"
    if "missing 1 required" not in said or _quoted(error) not in ("robot", "world"):
        return ""
    given = ", ".join(map(ast.unparse, (*parent.args, *parent.keywords)))
    law = f"functools.partial({what}, {given})" if given else what
    return f"; a law is given without brackets: {law}"


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
