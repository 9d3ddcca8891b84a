"""The engine's loop: bodies near each other form islands, and each is stepped by itself.

It is written once, in Python that Cython compiles. What was compiled when the package was installed
is used if it fits its sources and pymunk; else the same lines run as Python, more slowly, with the
same bits.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from typing import Any

from mars2d.physics.islands.build import fingerprint, functions

__all__ = ["difference", "islands", "reason_without", "version"]


def islands() -> Any:
    """Return the module that moves bodies: the compiled one, or `plain`.

    Raises ImportError with a pymunk in which neither finds its numbers.
    """
    from mars2d.physics.islands.layout import misplaced

    if misplaced():
        raise ImportError(f"pymunk {version()} can't be used: {misplaced()}")
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
    if difference():
        return None, difference()
    from pymunk._chipmunk_cffi import ffi, lib

    addresses = [ffi.addressof(lib, name) for name, _ in functions()]
    made.connect([int(ffi.cast("uintptr_t", address)) for address in addresses])
    return made, ""


def version() -> str:
    """Return the version of pymunk; to ask `importlib.metadata` takes a tenth of a start."""
    import pymunk

    return pymunk.version


def difference() -> str:
    """Return how pymunk differs from the supported versions; empty if it does not."""
    from pymunk._chipmunk_cffi import ffi, lib

    from mars2d.physics.islands.layout import misplaced

    what = next(changes(ffi, lib), "") or misplaced()
    return what and f"pymunk {version()} is not as it was written for: {what}"


FIELDS: dict[str, dict[str, tuple[int, str]]] = {
    "struct cpArbiter": {
        "a": (40, "struct cpShape *"),
        "b": (48, "struct cpShape *"),
        "body_a": (56, "struct cpBody *"),
        "body_b": (64, "struct cpBody *"),
        "count": (104, "int"),
        "contacts": (112, "struct cpContact *"),
        "n": (120, "struct cpVect"),
    },
    "struct cpContact": {
        "r1": (0, "struct cpVect"),
        "r2": (16, "struct cpVect"),
        "bounce": (48, "double"),
        "jnAcc": (56, "double"),
        "jtAcc": (64, "double"),
    },
    "struct cpCollisionHandler": {
        "preSolveFunc": (24, "void(*)(struct cpArbiter *, struct cpSpace *, void *)"),
        "userData": (48, "void *"),
    },
}
"""Fields of the engine's structs that are used directly: where they are, and their types."""

CONTACT_SIZE = 96
"""The size of the engine's struct of a contact."""


def changes(engine: Any, library: Any) -> Iterator[str]:
    """Yield the differences between an engine and that which the islands were written for.

    engine, library: its ffi, and its functions.
    """
    for name, kind in functions():
        try:
            found = engine.typeof(engine.addressof(library, name)).cname
        except AttributeError:
            yield f"it has no function {name}"
            continue
        if _plain(found) != _plain(kind):
            yield f"its function {name} is a {found}"
    for struct, wanted in FIELDS.items():
        fields = _fields(engine, struct)
        for field, (offset, kind) in wanted.items():
            if field not in fields:
                yield f"its {struct} has no field {field}"
            elif (fields[field].offset, fields[field].type.cname) != (offset, kind):
                found, at = fields[field].type.cname, fields[field].offset
                yield f"the field {field} of its {struct} is a {found} at {at}"
        if fields and struct == "struct cpContact" and engine.sizeof(struct) != CONTACT_SIZE:
            yield f"its {struct} has {engine.sizeof(struct)} bytes"


def _fields(engine: Any, struct: str) -> dict[str, Any]:
    """Return the fields of a struct of an engine; none if it has no such struct."""
    try:
        return dict(engine.typeof(struct).fields or ())
    except Exception:
        return {}


def _plain(kind: str) -> str:
    """Return a function's type with all pointers alike, and vectors by our name."""
    kind = kind.replace(" noexcept", "").replace("Vector *", "void *")
    kind = kind.replace("struct cpVect *", "void *")
    kind = kind.replace("struct cpVect", "Vector")
    kind = re.sub(r"struct \w+ \*", "void *", kind).replace("void)", ")")
    return kind.replace(" ", "")
