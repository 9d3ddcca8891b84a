"""Files of Python code: modules of their own, which hold experiments, laws and lessons."""

from __future__ import annotations

import ast
import importlib.util
import inspect
import itertools
import os
import re
import sys
import threading
import traceback
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from importlib.machinery import SourceFileLoader
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple, Self, cast

from mars2d.core import checks
from mars2d.core.description import wrong
from mars2d.core.errors import InputError, nearest, one_line
from mars2d.core.files import note_file
from mars2d.core.hints import described
from mars2d.core.usercode import definition
from mars2d.scenario.policy import SUFFIX, Policy

_counter = itertools.count()
_running = threading.RLock()  # modules and the path belong to all threads


def module_in(
    path: Path, what: str = "an experiment", loader: type[SourceFileLoader] = SourceFileLoader
) -> ModuleType:
    """Run a file as a module of its own, which no other module can see. loader: reads it."""
    if path.suffix != ".py":
        other = ".toml" if what == "an experiment" else SUFFIX
        raise InputError(f"{path}: expected {what}, a file that ends in .py or {other}")
    note_file(path)
    name = f"_mars2d_experiment_{next(_counter)}_{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path, loader=loader(name, str(path)))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    with _running:
        before = set(sys.modules)
        sys.modules[name] = module  # dataclasses look up a class's module by name
        folder = str(path.parent.absolute())
        sys.path.insert(0, folder)  # an experiment may import what lies beside it
        # Compiled code of a file that is saved twice within a second would be taken as new.
        keeps, sys.dont_write_bytecode = sys.dont_write_bytecode, True
        try:
            spec.loader.exec_module(module)
        except SyntaxError as error:
            line = one_line((error.text or "").strip(), 100)
            file = Path(error.filename or path)
            note_file(file)
            place = f"{file.name}, line {error.lineno}" if error.lineno else file.name
            raise located(place, ": ".join(filter(None, [error.msg, line]))) from error
        except (Exception, SystemExit) as error:
            raise located(line_in(error, path), described(error)) from error
        finally:
            sys.path.remove(folder)
            sys.dont_write_bytecode = keeps
            # What it imported goes, lest it is taken for what lies in another folder.
            for other in set(sys.modules) - before:
                source = getattr(sys.modules[other], "__file__", None)
                if source is not None and str(Path(source).parent) == folder:
                    note_file(Path(source))
                    del sys.modules[other]
    return module


def located(where: str, problem: str) -> InputError:
    """Return an error that points at a place, such as a line of a file."""
    error = InputError(problem)
    error.where = where
    return error


def line_in(error: BaseException, path: Path) -> str:
    """Return the line of `path` that an error passed through."""
    stack, file = traceback.extract_tb(error.__traceback__), path.absolute()
    lines = [step.lineno for step in stack if Path(step.filename).absolute() == file]
    return f"{path.name}, line {lines[-1]}" if lines else path.name


def law_in(
    file: Path,
    name: str,
    subject: str = "the robot",
    given: tuple[Sequence[Any], Mapping[str, Any]] = ((), {}),
    loader: type[SourceFileLoader] = SourceFileLoader,
) -> Callable[[Any], Any]:
    """Return the law called `name` in a file, which is run again.

    subject: the robot or world. given: the arguments of the function that are given. loader: reads
    the file.
    """
    if file.suffix == SUFFIX:
        if name != "control" or given != ((), {}):
            raise InputError(f"{file.name}: a learned law has no other names and no arguments")
        return Policy(file, loader(name, str(file)).get_data)
    module, (args, values) = module_in(file, "a law", loader), given
    law = getattr(module, name, None)
    if law is None:
        functions = [key for key, value in vars(module).items() if inspect.isfunction(value)]
        raise located(file.name, f"has no law {name!r}{nearest(name, functions)}")
    if (args or values) and callable(law):
        law = partial(law, *args, **values)
    try:
        checks.function(name, law, subject)
    except InputError as error:
        error.where = definition(law) or file.name
        raise
    return cast("Callable[[Any], Any]", law)


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


HEADINGS = re.compile(
    r"(?:^|(?<=[.?!)] ))(Question|Setting|Law(?: \([^)]*\))?|Prediction|Measured|Try|Play|Source): "
)
"""The words with which parts of a docstring begin."""


def lesson_of(path: Path | None) -> list[tuple[str, str]]:
    """Return the parts of the docstring of a Python file: headings and texts.

    >>> HEADINGS.split("Question: how far? Source: a book.")
    ['', 'Question', 'how far? ', 'Source', 'a book.']
    """
    if path is None or path.suffix != ".py":
        return []
    text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    first, *rest = HEADINGS.split(" ".join(text.split()))
    named = zip(rest[::2], rest[1::2], strict=True)
    parts = [(heading, text.strip()) for heading, text in (("", first), *named)]
    return [(heading, text[:1].upper() + text[1:]) for heading, text in parts]
