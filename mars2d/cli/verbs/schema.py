"""The verb ``schema``."""

from __future__ import annotations

import argparse
import json

from mars2d.core.terminal import tell
from mars2d.scenario.schema import schema


def add_arguments(_: argparse.ArgumentParser) -> None:
    """Add nothing: the verb has no arguments."""


def execute(_: argparse.Namespace) -> None:
    """Print the JSON Schema of scenario files, for editors and other programs."""
    tell(json.dumps(schema(), indent=1))
