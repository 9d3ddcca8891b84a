"""The command line: one module a verb."""

from mars2d.cli.command_line import main, parser

__all__ = ["main", "parser"]
