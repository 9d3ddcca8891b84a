"""The verb ``list``."""

from __future__ import annotations

import argparse

from mars2d.commands.base import print_examples, print_table
from mars2d.registry import members, summary

NAME = "list"

FAMILIES = {
    "Drives": "bodies",
    "Props": "props",
    "Joints": "joints",
    "Sensors": "sensors",
    "Add-ons": "addons",
}


def add_arguments(_: argparse.ArgumentParser) -> None:
    """Add nothing: the verb has no arguments."""


def execute(_: argparse.Namespace) -> None:
    """List examples, drives, props, joints, sensors and add-ons, one line each."""
    print_examples()
    for title, family in FAMILIES.items():
        print_table(title, {name: summary(kind) for name, kind in members(family).items()})
