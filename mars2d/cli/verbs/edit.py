"""The verb ``edit``."""

from __future__ import annotations

import argparse
from pathlib import Path

from mars2d.cli.arguments import option, options_of, preferences_of, shared
from mars2d.cli.runs import require_display
from mars2d.core.errors import InputError
from mars2d.core.terminal import warn
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.scenario import Scenario

NO_DISPLAY = (
    "there is no display to draw on; a scenario file is text, and any text editor will do: "
    "see docs/scenario_files.md"
)

ARGUMENTS = {
    "scenario": option("SCENARIO", "a .toml or .py file, or an example", nargs="?"),
    **shared("set dark text"),
}


def execute(arguments: argparse.Namespace) -> None:
    """Draw a scenario with the mouse, a new one or that of a file, and save it as a file."""
    options = options_of(arguments)
    path = None if arguments.scenario is None else Path(arguments.scenario)
    new = path is None or (path.suffix.lower() == ".toml" and not path.exists())
    if new and path is not None and not path.parent.is_dir():
        raise InputError(f"{path}: there is no folder {path.parent}")
    experiment = open_experiment(Scenario() if new else arguments.scenario, options)
    if path and not new and not path.is_file() and arguments.scenario in examples():
        path = Path(f"{arguments.scenario}.toml")  # the drawing of a shipped example goes here
    elif not new:
        path = experiment.source.path or path
    require_display(NO_DISPLAY)
    from mars2d.window.editor import Editor
    from mars2d.window.editor_window import play, show_editor
    from mars2d.window.screen.looks import Looks

    editor = Editor(
        experiment.scenario,
        Looks(preferences_of(arguments)),
        path=path,
        control=experiment.control,
        empty=new and not any(name.partition(".")[0] == "robots" for name in options),
        changed=bool(options),
        play=play,
    )
    try:
        show_editor(editor)
    except BaseException:  # Ctrl-C, a lost display, a fault: too late to ask for a name
        kept = editor.dialogs.rescue()
        if kept is not None:
            warn(f"what was drawn and not saved is in {kept}")
        raise
