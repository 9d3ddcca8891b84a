"""The user's code: errors that it raises name its line."""

from __future__ import annotations

import dis
import functools
import inspect
import io
import os
import sys
import sysconfig
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from types import BuiltinFunctionType, CodeType, FunctionType, ModuleType
from typing import Any

from mars2d.core.errors import InputError, Late, LawError
from mars2d.core.hints import described

_PACKAGE = Path(__file__).parents[1]
_STANDARD_LIBRARY = Path(sysconfig.get_path("stdlib"))


class called:  # noqa: N801 - used like a function, as contextlib's are
    """Run the user's code, and turn an exception that it raises into a LawError with file and line.

    An InputError that one of MARS2D's own parts raises as a run starts is passed on unchanged: the
    user's code is not at fault.

    What is called at each control step catches exceptions and calls `blame`, which costs nothing.
    """

    def __init__(self, name: str, function: Callable[..., Any], robot: str = "") -> None:
        """Take the name for messages, the function that is called, and the robot whose it is."""
        self._name, self._function, self._robot = name, function, robot

    def __enter__(self) -> None:
        pass

    def __exit__(self, _kind: object, error: BaseException | None, _tb: object) -> None:
        if error is not None:
            self.blame(error)

    def blame(self, error: BaseException) -> None:
        """Raise the LawError for an exception that was caught, unless it is to be passed on."""
        late = error.why if isinstance(error, Late) else ""
        if not (late or isinstance(error, (Exception, SystemExit))):  # such as Ctrl-C
            return
        where = users_line(traceback.extract_tb(error.__traceback__)) or definition(self._function)
        if isinstance(error, LawError):
            error.where, error.robot = error.where or where, error.robot or self._robot
            return
        at_start = getattr(self._function, "__name__", "") == "on_start"
        if isinstance(error, InputError) and where is None and at_start:
            return
        what = late or f"raised {described(error)}"
        wrapped = LawError(f"{self._name} {what}")
        wrapped.where, wrapped.robot = where, self._robot
        raise wrapped from error


LIBRARIES = {"mars2d", "numpy", "scipy", *sys.stdlib_module_names}
FIXED = type(None), bool, int, float, complex, str, bytes


def keeps_nothing(law: Any) -> bool:
    """Return whether a law is a function that can't keep anything in the variables around it.

    Copies of a world share these. What can't be told counts as kept: a list, a class, a closure.
    """
    reached, functions = [law], set()
    for value in reached:  # which grows
        if isinstance(value, functools.partial):
            reached += [value.func, *value.args, *value.keywords.values()]
        elif isinstance(value, tuple):
            reached += value
        elif isinstance(value, FIXED) or _is_of_a_library(value):
            continue
        elif not isinstance(value, FunctionType) or value.__closure__:
            return False
        elif value not in functions:
            functions.add(value)
            steps = _steps_of(value.__code__)
            if any(step.opname in ("STORE_GLOBAL", "IMPORT_NAME") for step in steps):
                return False
            names = {step.argval for step in steps if step.opname == "LOAD_GLOBAL"}
            reached += [value.__globals__[name] for name in names if name in value.__globals__]
            reached += [*(value.__defaults__ or ()), *(value.__kwdefaults__ or {}).values()]
    return True


def _is_of_a_library(value: Any) -> bool:
    """Return whether a value is a module, class or function of MARS2D or another library."""
    if isinstance(value, ModuleType):
        return value.__name__.partition(".")[0] in LIBRARIES
    if not isinstance(value, (type, FunctionType, BuiltinFunctionType)):
        return False
    module = sys.modules.get(value.__module__ or "")
    return module is not None and _is_of_a_library(module)


def _steps_of(code: CodeType) -> list[dis.Instruction]:
    """Return the instructions of a function, and of those within it."""
    inner = [each for each in code.co_consts if isinstance(each, CodeType)]
    return [*dis.get_instructions(code), *(step for each in inner for step in _steps_of(each))]


def users_line(stack: traceback.StackSummary) -> str | None:
    """Return file and line of the innermost step of a stack in the user's own code, if any."""
    steps = [step for step in stack if _is_users(Path(step.filename))]
    return f"{Path(steps[-1].filename).name}, line {steps[-1].lineno}" if steps else None


def _is_users(path: Path) -> bool:
    compiled = path.suffix == ".pyx"  # for example numpy's random generators
    others = compiled or _is_ours(path) or path.is_relative_to(_STANDARD_LIBRARY)
    return not (others or "site-packages" in path.parts or _is_no_file(path))


def _is_no_file(path: Path) -> bool:
    """Return whether this is the name of code that was made by `eval` or `exec`."""
    return str(path).startswith("<") or not path.name


def _is_ours(path: Path) -> bool:
    ours = path.is_relative_to(_PACKAGE) and not path.is_relative_to(_PACKAGE / "examples")
    return ours or path.name == "mars2d"  # the file in bin/ that starts the command line


def name_of(function: Callable[..., Any]) -> str:
    """Return the name of a function, also within a functools.partial, or of an object's class."""
    while isinstance(function, functools.partial):
        function = function.func
    return str(getattr(function, "__name__", type(function).__name__))


def definition(function: Callable[..., Any]) -> str | None:
    """Return file and line of a function's definition, or of that of an object that is called.

    None if it is compiled, MARS2D's own, or made by `eval` or `exec`.
    """
    code = None if (found := written(function)) is None else found.__code__
    if code is None or _is_ours(path := Path(code.co_filename)) or _is_no_file(path):
        return None
    return f"{path.name}, line {code.co_firstlineno}"


def written(function: Any) -> FunctionType | None:
    """Return the function that is called: within a partial, or of an object; None: compiled."""
    while isinstance(function, functools.partial):
        function = function.func
    for called in (inspect.unwrap(function), type(function).__call__):
        if isinstance(found := getattr(called, "__func__", called), FunctionType):
            return found
    return None


@contextmanager
def quiet() -> Iterator[None]:
    """Let nothing be printed twice, and nobody be asked for input again."""
    with Path(os.devnull).open("w", encoding="utf-8") as nothing:
        stdin, sys.stdin = sys.stdin, io.StringIO()
        try:
            with redirect_stdout(nothing), redirect_stderr(nothing):
                yield
        finally:
            sys.stdin = stdin
