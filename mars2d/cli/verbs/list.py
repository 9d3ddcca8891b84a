"""The verb ``list``."""

from __future__ import annotations

import argparse
from typing import Any

from mars2d.cli.runs import print_examples, print_table
from mars2d.scenario.registry import FAMILIES, members, summary

ARGUMENTS: dict[str, dict[str, Any]] = {}


def execute(_: argparse.Namespace) -> None:
    """List examples, drives, props, joints, sensors, laws and add-ons, one line each."""
    print_examples()
    for family, about in FAMILIES.items():
        print_table(about[-1], {name: summary(kind) for name, kind in members(family).items()})
