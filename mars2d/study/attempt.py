"""Attempts: a task is tried, here or in another process, and what it raises is told, not raised."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple, TypeVar

from mars2d.core.errors import InputError, described, shown

__all__ = ["Failure", "attempt", "attempt_packed", "packed", "unpacked"]

T = TypeVar("T")
R = TypeVar("R")


class Failure(NamedTuple):
    """What came of a task that failed: why, in one line."""

    error: str


class Unknown(NamedTuple):
    """The function was not found where the task was to be tried: why, in one line."""

    error: str


def attempt(function: Callable[[T], R], task: T) -> R | Failure:
    """Return what a function makes of a task, or why it failed."""
    try:
        return function(task)
    except (Exception, SystemExit) as error:
        return Failure(one_line(error))


def one_line(error: BaseException) -> str:
    """Return what an exception says, in one line."""
    return " ".join(described(error).split())


def packed(thing: Any, dumps: Callable[[Any], bytes] = pickle.dumps) -> bytes:
    """Return a function or a task as bytes for another process; InputError where it can't be.

    dumps: what makes the bytes; pickle.loads must read them.
    """
    try:
        return dumps(thing)
    except Exception as error:
        raise InputError(
            f"{shown(thing)}: can't be sent to another process ({one_line(error)}): give the "
            "experiment by its file and functions from a module, or run in this process, with "
            "executor=ThreadPoolExecutor()"
        ) from error


def attempt_packed(function: bytes, task: bytes) -> bytes:
    """Do what `attempt` does, where both were `packed`; `unpacked` reads what is returned."""
    return _returned(_attempt_packed(function, task))


def _attempt_packed(function: bytes, task: bytes) -> Any:
    try:
        known = _function(function)
    except Exception as error:
        return Unknown(one_line(error))
    try:
        given = pickle.loads(task)
    except Exception as error:
        return Failure(f"can't be read by the process that runs it: {one_line(error)}")
    return attempt(known, given)


_function = lru_cache(maxsize=4)(pickle.loads)
"""The function of a study, which is the same in all its tasks."""


def _returned(value: Any) -> bytes:
    try:
        return pickle.dumps(value)
    except Exception as error:
        failure = Failure(f"{shown(value)}: can't be sent back: {one_line(error)}")
        return pickle.dumps(failure)


def unpacked(returned: bytes) -> Any:
    """Return what `attempt_packed` has found; InputError where the function was unknown there."""
    try:
        value = pickle.loads(returned)
    except Exception as error:
        return Failure(f"what it returned can't be read: {one_line(error)}")
    if isinstance(value, Unknown):
        raise InputError(
            f"a worker process does not find the function ({value.error}): put it into a module"
        )
    return value
