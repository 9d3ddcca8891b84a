"""Pictures of scenarios, worlds and records for notebooks.

Pictures are SVG without scripts or styles, which all notebooks and their viewers on the web show. A
record is shown as a replay in a frame; the picture of its end lies below, for viewers that remove
frames.
"""

from __future__ import annotations

import base64
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from mars2d.core.errors import counted
from mars2d.core.hints import described
from mars2d.output.pages.drawing import draw, say
from mars2d.output.pages.svg import text_of
from mars2d.record.frame import Frame

if TYPE_CHECKING:
    from mars2d.record.rows import Rows
    from mars2d.scenario.scenario import Scenario

REPLAY_HEIGHT = 480
"""The height of a replay, pixels."""

MAX_CHARACTERS = 4_000_000
"""The most characters of a replay in a notebook; beyond, it shows the picture of the end."""


def scenario_svg(scenario: Scenario) -> str:
    """Return a picture of a scenario at its start; it never raises."""
    return _picture(lambda: (_start(scenario), _described(scenario)), scenario.title)


def world_svg(world: Any) -> str:
    """Return a picture of a `World` as it is, with the paths so far; it never raises."""

    def picture() -> tuple[Frame, str]:
        frame, last = world.frame, world.scenario.stop_time
        when = f"t = {world.time:.10g} s of {last:g} s"
        return frame, f"{world.scenario.title}: {when}" + (
            f"; {world.over_message}" if world.over else ""
        )

    return _picture(picture, world.scenario.title)


def record_svg(record: Rows) -> str:
    """Return a picture of the end of a record, with the paths; it never raises."""

    def picture() -> tuple[Frame, str]:
        if not len(record):
            return _start(record.scenario), f"{record.scenario.title}: no rows, nothing ran"
        return record.frame(-1), _outcome(record)

    return _picture(picture, record.scenario.title)


def record_html(record: Rows) -> str:
    """Return a replay in a frame, above the picture of its end; it never raises.

    If there is no replay, or one too large for a notebook, a text below the picture says so.
    """
    picture = base64.b64encode(record_svg(record).encode()).decode()
    title = text_of(f"Replay of {record.scenario.title}")
    image = (
        f'<img alt="{title}, its end" src="data:image/svg+xml;base64,{picture}" '
        'style="max-width:100%;max-height:100%">'
    )
    if not len(record):
        return image
    try:
        from mars2d.output.pages.replay import page

        replay = page(record)
    except Exception as error:  # of parts of the user's that are drawn
        return f"{image}<p>There is no replay: {text_of(described(error))}</p>"
    if len(replay) > MAX_CHARACTERS:
        return (
            f"{image}<p>The replay is too large for a notebook, {len(replay) / 1e6:.1f} MB: "
            '<code>record.save_html("replay.html")</code> writes it to a file.</p>'
        )
    return (
        f'<div style="position:relative;height:{REPLAY_HEIGHT}px;overflow:hidden">{image}'
        f'<iframe title="{title}" sandbox="allow-scripts" srcdoc="{text_of(replay)}" '
        'style="position:absolute;left:0;top:0;width:100%;height:100%;border:0"></iframe></div>'
    )


def _picture(made: Callable[[], tuple[Frame, str]], title: str) -> str:
    """Return the picture of a frame with its caption, or a picture of the error message."""
    try:
        return draw(*made())
    except Exception as error:  # any of it may call code of the user's
        return say(f"{title}: can't be drawn. {described(error)}")


def _start(scenario: Scenario) -> Frame:
    """Return the frame of a scenario before anything has moved."""
    poses = [prop.pose for prop in scenario.props]
    return Frame(
        scenario=scenario,
        time=0.0,
        iteration=0,
        pose=scenario.initial_pose,
        path=np.empty((0, 3, len(scenario.robots))),
        prop_pose=np.array(poses).reshape(-1, 3).T,
        effort=np.zeros(len(scenario.robots)),
    )


def _described(scenario: Scenario) -> str:
    """Return the contents of a scenario, in words."""
    counts = {
        "robot": len(scenario.robots),
        "prop": len(scenario.props),
        "joint": len(scenario.ties),
        "obstacle": len(scenario.obstacles),
    }
    parts = ", ".join(counted(count, thing) for thing, count in counts.items() if count)
    return (
        f"{scenario.title}: {parts}; {scenario.sampling_time:g} s a control step, "
        f"{scenario.stop_time:g} s at most, physics {scenario.physics!r}"
    )


def _outcome(record: Rows) -> str:
    """Return the outcome of a run, in words."""
    rows = f"{counted(len(record), 'row')} to t = {record.time[-1]:.10g} s"
    touches = counted(record.collisions, "collision")
    return f"{record.scenario.title}: {rows}, {touches}; {record.over_message}"
