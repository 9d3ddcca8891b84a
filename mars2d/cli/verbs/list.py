"""The verb ``list``."""

from __future__ import annotations

import argparse
from typing import Any

from mars2d.cli.runs import print_examples, print_table
from mars2d.scenario.registry import members, misspelt_groups, plugins, summary

FAMILIES = {
    "Drives": "bodies",
    "Props": "props",
    "Joints": "joints",
    "Sensors": "sensors",
    "Ready-made laws": "controllers",
    "Add-ons": "addons",
}

ARGUMENTS: dict[str, dict[str, Any]] = {}


def execute(_: argparse.Namespace) -> None:
    """List examples, drives, props, joints, sensors, laws and add-ons, one line each."""
    print_examples()
    for title, family in FAMILIES.items():
        print_table(title, {name: _line(family, name) for name in members(family)})
    unusable = [plugin for family in FAMILIES.values() for plugin in plugins(family)]
    lines = {p.name: f"{p.problem} ({p.package} {p.version})" for p in unusable if p.problem}
    lines |= dict.fromkeys(misspelt_groups(), "no family of parts")
    if lines:
        print_table("Of other packages, and not usable", lines)


def _line(family: str, name: str) -> str:
    """Return the first line of a part's docstring, with the package that ships it."""
    part = next((p for p in plugins(family) if p.kind is not None and p.name == name), None)
    if part is None or part.kind is None:
        return summary(members(family)[name])
    return f"{summary(part.kind)} ({part.package} {part.version})".strip()
