"""The verb ``completion``."""

from __future__ import annotations

import argparse

from mars2d.core.extras import extra
from mars2d.core.terminal import tell
from mars2d.scenario.examples import examples

SHELLS = ("bash", "zsh", "tcsh")

PREAMBLE = {
    "bash": """\
_mars2d_experiments() {{
  compgen -W "{names}" -- "$1"
  compgen -f -X '!*.py' -- "$1"
  compgen -f -X '!*.toml' -- "$1"
  compgen -d -S / -- "$1"
}}
""",
    "zsh": """\
_mars2d_experiments() {{
  compadd {names}
  _files -g '*.(py|toml)'
}}
""",
}
"""A function of the shell that completes the names of examples, and files."""

EXPERIMENTS = {"bash": "_mars2d_experiments", "zsh": "_mars2d_experiments"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the shell."""
    parser.add_argument("shell", metavar="SHELL", choices=SHELLS, help="bash, zsh or tcsh")


def execute(arguments: argparse.Namespace) -> None:
    """Print the script by which a shell completes commands, options and examples."""
    from mars2d.cli.command_line import parser

    with extra("completion", "completion needs shtab"):
        import shtab
    root = parser()
    for action in _actions(root):
        if action.metavar in ("EXPERIMENT", "EXAMPLE", "GAME") and not action.option_strings:
            action.complete = EXPERIMENTS  # type: ignore[attr-defined]
        elif action.metavar in ("FILE", "OUT", "RECORD", "OUT.npz", "PNG"):
            action.complete = shtab.FILE  # type: ignore[attr-defined]
    names = " ".join(examples())
    preamble = {shell: text.format(names=names) for shell, text in PREAMBLE.items()}
    tell(shtab.complete(root, arguments.shell, preamble=preamble))  # type: ignore[arg-type]


def _actions(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    """Return the arguments of a parser and of its verbs."""
    found: list[argparse.Action] = []
    for action in parser._actions:
        found.append(action)
        if isinstance(action, argparse._SubParsersAction):
            for sub in action.choices.values():
                found += _actions(sub)
    return found
