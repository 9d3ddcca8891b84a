"""The command line: one module per verb, in `mars2d.cli.verbs`."""

from mars2d.cli.command_line import main, parse

__all__ = ["main", "parse"]
