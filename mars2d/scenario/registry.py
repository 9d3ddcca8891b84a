"""Families of parts by name: drives, sensors, laws, add-ons; MARS2D's own and others'.

A package ships a part by an entry point of the group ``mars2d.<family>``, such as
``mars2d.sensors``. Entry points are looked up when parts are asked for by name, never on import.
"""

from __future__ import annotations

import importlib
import pkgutil
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from mars2d.core.description import Description
from mars2d.core.errors import nearest, shown
from mars2d.core.hints import described

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

FAMILIES = {
    "bodies": "mars2d.bodies.drives",
    "props": "mars2d.bodies.props",
    "joints": "mars2d.bodies.joints",
    "sensors": "mars2d.sensors",
    "controllers": "mars2d.scenario.controllers",
    "addons": "mars2d.addons",
}
"""The families of parts, and the package that holds the parts of each."""

BASES = {
    "bodies": "Drive",
    "props": "Prop",
    "joints": "Joint",
    "sensors": "Sensor",
    "controllers": "Controller",
    "addons": "Addon",
}
"""The base class of each family."""


@dataclass(frozen=True)
class Plugin:
    """A part that another package ships by an entry point, or the reason why it can't be used.

    name: of the class, or of the entry point if there is no class. package, version: those of
    `pip`. kind: the class, None if it can't be used. problem: the reason, or empty.
    """

    family: str
    name: str
    package: str
    version: str
    kind: type[Description] | None = None
    problem: str = ""


def members(family: str) -> dict[str, type[Description]]:
    """Return the public classes of a family (``"sensors"``, ``"addons"``, ``"bodies"``) by name.

    Those of MARS2D come first, then the usable ones of other packages; see `plugins`.
    """
    return _own(family) | {p.name: p.kind for p in plugins(family) if p.kind is not None}


@cache
def plugins(family: str) -> tuple[Plugin, ...]:
    """Return the parts that other packages ship for a family, unusable ones with their problem.

    A name that MARS2D itself or an earlier package in the alphabet has is a problem.
    """
    from importlib.metadata import entry_points  # takes a tenth of the package's import time

    taken = dict.fromkeys(_own(family), "MARS2D itself")
    found = []
    for entry in sorted(entry_points(group=f"mars2d.{family}"), key=lambda e: (_package(e), e)):
        part = _load(family, entry)
        if part.kind is not None and part.name in taken:
            problem = f"{taken[part.name]} has a {part.name}, which is used in its place"
            part = Plugin(family, part.name, part.package, part.version, problem=problem)
        if part.kind is not None:
            taken[part.name] = part.package
        found.append(part)
    return tuple(found)


def plugin(family: str, name: str, package: str) -> type[Description] | None:
    """Return the class that a package ships under a name, None if it is not installed."""
    kinds = (p.kind for p in plugins(family) if (p.name, p.package) == (name, package))
    return next(kinds, None)


def family_of(kind: type[Description]) -> str | None:
    """Return the family of one of MARS2D's own parts, None for any other class."""
    return next((f for f, package in FAMILIES.items() if kind.__module__.startswith(package)), None)


def package_of(family: str, kind: type[Description]) -> str | None:
    """Return the package that ships a class by an entry point, or None."""
    return next((p.package for p in plugins(family) if p.kind is kind), None)


def _load(family: str, entry: EntryPoint) -> Plugin:
    package, version = _package(entry), entry.dist.version if entry.dist else ""
    base = getattr(importlib.import_module(FAMILIES[family]), BASES[family])
    try:
        kind = entry.load()
    except (Exception, SystemExit) as error:  # raised by the other package's code
        problem = f"{entry.value} can't be loaded: {described(error)}"
        return Plugin(family, entry.name, package, version, problem=problem)
    if not (isinstance(kind, type) and issubclass(kind, base)):
        problem = f"{entry.value} is {shown(kind)}: expected a class derived from {base.__name__}"
        return Plugin(family, entry.name, package, version, problem=problem)
    return Plugin(family, kind.__name__, package, version, kind)


def _package(entry: EntryPoint) -> str:
    return entry.dist.name if entry.dist else "an unknown package"


def _own(family: str) -> dict[str, type[Description]]:
    """Return MARS2D's own classes of a family by name."""
    package, found = importlib.import_module(FAMILIES[family]), {}
    base = getattr(package, BASES[family])
    for info in sorted(pkgutil.iter_modules(package.__path__), key=lambda m: m.name):
        module = importlib.import_module(f"{FAMILIES[family]}.{info.name}")
        for name, kind in vars(module).items():
            is_part = isinstance(kind, type) and issubclass(kind, base)
            own = is_part and kind.__module__ == module.__name__ and name[0] != "_"
            methods = (getattr(kind, name, None) for name in dir(kind))  # abstract in a Contest
            abstract = any(getattr(method, "__isabstractmethod__", False) for method in methods)
            if own and info.name != "base" and not abstract:
                found[name] = kind
    return found


def misspelt_groups() -> list[str]:
    """Return groups of entry points that begin with ``mars2d.`` but are no family, with hints."""
    from importlib.metadata import entry_points

    groups = {group for group in entry_points().groups if group.startswith("mars2d.")}
    known = [f"mars2d.{family}" for family in BASES]
    return [f"{group}{nearest(group, known)}" for group in sorted(groups - {*known})]


def summary(kind: type) -> str:
    """Return the first line of a class's docstring."""
    return (kind.__doc__ or "").strip().partition("\n")[0]
