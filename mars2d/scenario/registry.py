"""Families of parts by name: drives, props, joints, sensors, laws and add-ons."""

from __future__ import annotations

import importlib

from mars2d.core.description import Description

FAMILIES = {
    "bodies": ("mars2d.bodies.drives", "Drive", "Drives"),
    "props": ("mars2d.bodies.props", "Prop", "Props"),
    "joints": ("mars2d.bodies.joints", "Joint", "Joints"),
    "sensors": ("mars2d.sensors", "Sensor", "Sensors"),
    "controllers": ("mars2d.scenario.controllers", "Controller", "Ready-made laws"),
    "addons": ("mars2d.addons", "Addon", "Add-ons"),
}
"""The families of parts: the package that holds them, their base class, and their title."""


def members(family: str) -> dict[str, type[Description]]:
    """Return the classes of a family (``"sensors"``, ``"addons"``, ``"bodies"``) by name."""
    name, base_name, _ = FAMILIES[family]
    package = importlib.import_module(name)
    base = getattr(package, base_name)
    parts = {name: getattr(package, name) for name in package.__all__}
    return {
        name: kind for name, kind in parts.items()
        if isinstance(kind, type) and issubclass(kind, base) and kind is not base
    }  # fmt: skip


def family_of(kind: type[Description]) -> str | None:
    """Return the family of one of MARS2D's own parts, None for any other class."""
    packages = ((family, package) for family, (package, *_) in FAMILIES.items())
    return next((f for f, package in packages if kind.__module__.startswith(package)), None)


def summary(kind: type) -> str:
    """Return the first line of a class's docstring."""
    return (kind.__doc__ or "").strip().partition("\n")[0]
