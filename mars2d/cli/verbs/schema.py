"""The verb ``schema``."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from mars2d.core.files import atomic_write
from mars2d.core.terminal import tell
from mars2d.scenario.schema import schema


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the file to write."""
    parser.add_argument("out", metavar="OUT", nargs="?", help="write it to this file instead")


def execute(arguments: argparse.Namespace) -> None:
    """Print the JSON Schema of scenario files, for editors and other programs, or write it."""
    text = json.dumps(schema(), indent=1) + "\n"
    if arguments.out is None:
        tell(text, end="")
        return
    with atomic_write(Path(arguments.out)) as file:
        file.write(text.encode())
