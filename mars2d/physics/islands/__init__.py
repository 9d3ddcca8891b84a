"""The engine's loop: bodies near each other form islands, and each is stepped by itself.

It is written once, in Python that Cython compiles. What was compiled when the package was installed
is used if it fits its sources and pymunk; else the same lines run as Python, more slowly, with the
same bits.
"""

from __future__ import annotations

import os
from functools import cache
from importlib import import_module
from typing import Any

from mars2d.core.errors import InputError
from mars2d.physics.islands.build import fingerprint, functions

__all__ = ["islands", "reason_without", "version"]

OLDEST, NEWEST = (7, 1), (7, 3)
"""The versions of pymunk whose structs are known to be as `chipmunk` uses them."""


def islands() -> Any:
    """Return the module that moves bodies: the compiled one, or `plain`.

    Raises InputError with a version of pymunk that may have its numbers elsewhere.
    """
    if not OLDEST <= tuple(map(int, version().split(".")[:2])) <= NEWEST:
        line = "pip install 'pymunk>={}.{},<{}.{}'".format(*OLDEST, NEWEST[0], NEWEST[1] + 1)
        raise InputError(f"pymunk {version()} was never tried with this MARS2D: {line}")
    return import_module("mars2d.physics.islands.plain") if reason_without() else _loaded()[0]


def reason_without() -> str:
    """Return why worlds do not use the compiled islands; empty if they do."""
    if os.environ.get("MARS2D_PLAIN") == "1":
        return "the environment variable MARS2D_PLAIN is 1"
    return _loaded()[1]


@cache
def _loaded() -> tuple[Any, str]:
    """Return the compiled module, or None and the reason why it can't be used."""
    try:
        made: Any = import_module("mars2d.physics.islands._compiled")
    except ModuleNotFoundError:
        return None, "it was not compiled when mars2d was installed"
    except ImportError as error:
        return None, f"it can't be loaded ({error})"
    if fingerprint() != getattr(made, "FINGERPRINT", ""):
        return None, "its sources have changed since it was compiled"
    from pymunk._chipmunk_cffi import ffi, lib

    addresses = [ffi.addressof(lib, name) for name, _ in functions()]
    made.connect([int(ffi.cast("uintptr_t", address)) for address in addresses])
    return made, ""


def version() -> str:
    """Return the version of pymunk; to ask `importlib.metadata` takes a tenth of a start."""
    import pymunk

    return pymunk.version
