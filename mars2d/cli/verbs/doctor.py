"""The verb ``doctor``."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from mars2d.cli.arguments import option
from mars2d.cli.verbs import VERBS
from mars2d.core.errors import InputError, Mars2dError, nearest
from mars2d.core.extras import extra
from mars2d.core.files import atomic_write
from mars2d.core.terminal import tell
from mars2d.reports.doctor import examine
from mars2d.scenario.examples import examples
from mars2d.scenario.schema import schema

MARKS = {True: "ok", None: "--", False: "NO"}

_SHELL = "print the script by which bash, zsh, tcsh, fish or powershell completes commands"
_SCHEMA = "print the JSON Schema of scenario files, for editors, or write it to a file"

ARGUMENTS = {
    "--completion": option("SHELL", _SHELL),
    "--schema": option("OUT", _SCHEMA, Path, nargs="?", const=Path("-")),
}


def execute(arguments: argparse.Namespace) -> None:
    """Show the libraries and devices of this machine, and test the installation."""
    if arguments.completion is not None:
        tell(_completion(arguments.completion))
        return
    if arguments.schema is not None:
        text = json.dumps(schema(), indent=1) + "\n"
        if arguments.schema == Path("-"):
            tell(text, end="")
            return
        with atomic_write(arguments.schema) as file:
            file.write(text.encode())
        return
    findings = [*examine()]
    for finding in findings:
        tell(f"{MARKS[finding.ok]}  {finding.name:<12}{finding.text}")
    if broken := [finding.name for finding in findings if finding.ok is False]:
        raise Mars2dError(f"the installation does not work: {', '.join(broken)}")


def _completion(shell: str) -> str:
    """Return the script by which a shell completes commands, options and files."""
    from mars2d.cli.command_line import parser_of

    with extra("completion", "completion needs shtab"):
        import shtab
    if shell not in shtab.SUPPORTED_SHELLS:
        hint = nearest(shell, shtab.SUPPORTED_SHELLS)
        raise InputError(f"--completion {shell}: shtab has no script for it{hint}")
    root = argparse.ArgumentParser(prog="mars2d")
    verbs = root.add_subparsers()
    for name, line in VERBS.items():
        verb = verbs.add_parser(name, help=line, parents=[parser_of(name)], add_help=False)
        for action in verb._actions:
            if action.metavar in ("EXAMPLE", "GAME") and not action.option_strings:
                action.choices = [*examples()]
            elif action.type is Path or action.metavar in ("EXPERIMENT", "FILE"):
                action.complete = shtab.FILE  # type: ignore[attr-defined]
    return str(shtab.complete(root, shell))
