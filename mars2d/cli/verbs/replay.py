"""The verb ``replay``."""

from __future__ import annotations

import argparse
from dataclasses import replace

from mars2d.cli.arguments import preferences_of, shared
from mars2d.cli.outputs import check_film, conclude, produced, save_film
from mars2d.cli.runs import require_display
from mars2d.window import show
from mars2d.world.record import load

NO_DISPLAY = (
    "there is no display for a window; make a film with --video OUT.gif, a page for any browser "
    "with --html OUT.html, or a figure with mars2d plot"
)

ARGUMENTS = shared("record speed theory video size from to html dark text")


def execute(arguments: argparse.Namespace) -> None:
    """Play a recorded run in the window, or make a film or a page of it."""
    record = load(arguments.record)
    animation = record.scenario.animation
    if arguments.theory:
        animation = animation.replace(theory=True)
        record = replace(record, scenario=record.scenario.replace(animation=animation))
    check_film(arguments, record.scenario, float(record.time[-1]) if len(record) else 0.0)
    makers = {
        "video": lambda: save_film(record, arguments),
        "html": lambda: record.save_html(arguments.html),
    }
    conclude(*produced(arguments, makers))
    if arguments.video is None and arguments.html is None:
        require_display(NO_DISPLAY)
        speed = animation.playback_speed if arguments.speed is None else arguments.speed
        show.show_record(record, speed, preferences_of(arguments))
