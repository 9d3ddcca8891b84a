"""The names of C types, which mean nothing to Python, and the decorator of classes.

The modules of this package import it as ``cython``. Where there is a compiler, `build` puts Cython
in its place: then a `double` is C's, and a `cclass` is a struct.
"""

from __future__ import annotations

import builtins
from array import array
from typing import Any, TypeAlias, TypeVar

T = TypeVar("T")

double: TypeAlias = float
int: TypeAlias = builtins.int  # noqa: A001
longlong: TypeAlias = builtins.int
bint: TypeAlias = bool
void: TypeAlias = None
p_double: TypeAlias = Any
Doubles: TypeAlias = "array[float]"
"""Numbers in a row, shared with numpy."""


NULL: Any = None


def cclass(kind: type[T]) -> type[T]:
    """Return the class, whose attributes are zero, or None, until they are set, as in C."""
    zeros = {"cython.double": 0.0, "cython.int": 0, "cython.bint": False}
    for name, declared in kind.__annotations__.items():
        setattr(kind, name, zeros.get(declared))
    return kind
