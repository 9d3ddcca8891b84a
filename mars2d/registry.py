"""Families of parts by name: drives, sensors, add-ons."""

from __future__ import annotations

import importlib
import pkgutil
import re
from collections.abc import Iterator

from mars2d.description import Description

__all__ = ["members", "snake_case", "summary"]


def snake_case(name: str) -> str:
    """Return a class name as the name of a thing: ``RangeFinder`` -> ``range_finder``.

    >>> snake_case("RangeFinder")
    'range_finder'
    """
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name).lower()


def members(family: str) -> dict[str, type[Description]]:
    """Return the public classes of a family (``"sensors"``, ``"addons"``, ``"bodies"``) by name."""
    return {kind.__name__: kind for kind in _walk(family)}


def _walk(family: str) -> Iterator[type[Description]]:
    package = importlib.import_module(f"mars2d.{family}")
    for info in sorted(pkgutil.iter_modules(package.__path__), key=lambda m: m.name):
        module = importlib.import_module(f"mars2d.{family}.{info.name}")
        for name in getattr(module, "__all__", ()):
            kind = getattr(module, name)
            is_part = isinstance(kind, type) and issubclass(kind, Description)
            if is_part and info.name != "base":
                yield kind


def summary(kind: type) -> str:
    """Return the first line of a class's docstring."""
    return (kind.__doc__ or "").strip().partition("\n")[0]
