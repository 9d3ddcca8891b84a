"""Attributes of a view that are those of what is behind it: a table instead of a property each."""

from __future__ import annotations

from operator import attrgetter
from typing import Any


def through(path: str) -> Any:
    """Return a property that reads an attribute by its path, with dots in it.

    >>> class View:
    ...     real: float = through("_number.real")
    ...     def __init__(self, number: complex) -> None:
    ...         self._number = number
    >>> View(3 + 4j).real
    3.0
    """
    return property(attrgetter(path))
