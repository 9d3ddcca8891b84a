"""The verb ``list``."""

from __future__ import annotations

import argparse
from typing import Any

from mars2d.cli.runs import print_examples, print_table
from mars2d.scenario.registry import members, summary

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
        print_table(title, {name: summary(kind) for name, kind in members(family).items()})
