"""The verb ``doctor``."""

from __future__ import annotations

import argparse

from mars2d.core.errors import Mars2dError
from mars2d.core.terminal import tell
from mars2d.reports.doctor import examine

MARKS = {True: "ok", None: "--", False: "NO"}


def add_arguments(_: argparse.ArgumentParser) -> None:
    """Add nothing: the verb has no arguments."""


def execute(_: argparse.Namespace) -> None:
    """Show the libraries and devices of this machine, and test the installation."""
    broken = []
    for finding in examine():
        tell(f"{MARKS[finding.ok]}  {finding.name:<12}{finding.text}")
        if finding.ok is False:
            broken.append(finding.name)
    if broken:
        raise Mars2dError(f"the installation does not work: {', '.join(broken)}")
