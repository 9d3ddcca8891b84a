"""Pictures of scenarios, worlds and records for notebooks.

They are the drawings of figures as SVG, which all notebooks and their viewers on the web show. A
record is shown as a replay in a frame; the picture of its end lies below, for viewers that remove
frames.
"""

from __future__ import annotations

import base64
import textwrap
from collections.abc import Callable
from html import escape
from io import BytesIO, StringIO
from typing import TYPE_CHECKING, Any

import numpy as np

from mars2d.core.errors import counted
from mars2d.core.hints import described
from mars2d.output.figures.extent import View
from mars2d.output.figures.figure import (
    LEGEND_LIMIT,
    dress,
    label,
    layers_of,
    new_axes,
    new_figure,
    paint_frame,
    robots_of,
)
from mars2d.output.figures.legend import BESIDE, add_legend, legend_width
from mars2d.output.figures.style import INK, SMALL, points
from mars2d.output.raster.theme import LIGHT
from mars2d.record.frame import Frame

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from mars2d.output.layers.table import Layers
    from mars2d.record.rows import Rows
    from mars2d.scenario.scenario import Scenario

LETTERS = 95
"""About the letters of a line below a picture."""

REPLAY_HEIGHT = 480
"""The height of a replay, pixels."""

MAX_CHARACTERS = 4_000_000
"""The most characters of a replay in a notebook; beyond, it shows the picture of the end."""


def scenario_svg(scenario: Scenario) -> str:
    """Return a picture of a scenario at its start; it never raises."""
    return svg_of(_picture(lambda: (_start(scenario), _described(scenario)), scenario.title))


def world_svg(world: Any) -> str:
    """Return a picture of a `World` as it is, with the paths so far; it never raises."""

    def picture() -> tuple[Frame, str]:
        frame, last = world.frame, world.scenario.stop_time
        when = f"t = {world.time:.10g} s of {last:g} s"
        return frame, f"{world.scenario.title}: {when}" + (
            f"; {world.over_message}" if world.over else ""
        )

    return svg_of(_picture(picture, world.scenario.title))


def record_svg(record: Rows) -> str:
    """Return a picture of the end of a record, with the paths; it never raises."""
    return svg_of(_end(record))


def _end(record: Rows) -> Figure:
    def picture() -> tuple[Frame, str]:
        if not len(record):
            return _start(record.scenario), f"{record.scenario.title}: no rows, nothing ran"
        return record.frame(-1), _outcome(record)

    return _picture(picture, record.scenario.title)


def record_html(record: Rows) -> str:
    """Return a replay in a frame, above the picture of its end; it never raises.

    If there is no replay, or one too large for a notebook, a text below the picture says so.
    """
    picture = BytesIO()
    _end(record).savefig(picture, format="png", dpi=96, bbox_inches="tight")
    title = escape(f"Replay of {record.scenario.title}")
    image = (
        f'<img alt="{title}, its end" '
        f'src="data:image/png;base64,{base64.b64encode(picture.getbuffer()).decode()}" '
        'style="max-width:100%;max-height:100%">'
    )
    if not len(record):
        return image
    try:
        from mars2d.output.pages.replay import page

        replay = page(record)
    except Exception as error:  # of parts of the user's that are drawn
        return f"{image}<p>There is no replay: {escape(described(error))}</p>"
    if len(replay) > MAX_CHARACTERS:
        return (
            f"{image}<p>The replay is too large for a notebook, {len(replay) / 1e6:.1f} MB: "
            '<code>record.save_html("replay.html")</code> writes it to a file.</p>'
        )
    return (
        f'<div style="position:relative;height:{REPLAY_HEIGHT}px;overflow:hidden">{image}'
        f'<iframe title="{title}" sandbox="allow-scripts" srcdoc="{escape(replay)}" '
        'style="position:absolute;left:0;top:0;width:100%;height:100%;border:0"></iframe></div>'
    )


def _picture(made: Callable[[], tuple[Frame, str]], title: str) -> Figure:
    """Return the picture of a frame with its caption, or a picture of the error message."""
    try:
        return drawn(*made())
    except Exception as error:  # any of it may call code of the user's
        figure = new_figure(5.8, 0.1, layout=None)
        _write(figure, [(f"{title}: can't be drawn. {described(error)}", LIGHT.failed)])
        return figure


def drawn(frame: Frame, caption: str, layers: Layers | None = None) -> Figure:
    """Return a figure of a frame with a caption below it.

    layers: the switches; by default those of figures, with names for few bodies. A layer that can't
    be drawn because a sensor or an add-on raises is left out, and a line below the caption says so.
    """
    scenario = frame.scenario
    layers = layers or layers_of(scenario).switched(names=len(scenario.bodies) <= LEGEND_LIMIT)
    words = [(caption, INK)]
    for layer in layers.seen(scenario.animation):
        try:
            if layer.shapes:
                layer.shapes(frame)
        except Exception as error:
            layers = layers.switched(**{layer.name: False})
            words.append((f"Not drawn: {layer.title.lower()}. {described(error)}", LIGHT.failed))
    paths = (frame.path, frame.pose), (frame.prop_path, frame.prop_pose)
    view = View.around(scenario, *(np.concatenate([path, pose[None]]) for path, pose in paths))
    entries = robots_of(scenario)
    (ax,) = new_axes(view, beside=legend_width(entries))
    dress(ax, scenario, view, layers)
    label(ax)
    add_legend(ax, entries, **BESIDE)
    paint_frame(ax, frame, layers)
    figure: Any = ax.figure
    _write(figure, words)
    return figure  # type: ignore[no-any-return]


def _write(figure: Figure, words: list[tuple[str, str]]) -> None:
    """Write texts in their colours below a figure."""
    figure.set_label(" ".join(text for text, _ in words))  # for people who can't see it
    below = 0.0
    for text, color in words:
        lines = textwrap.wrap(text, LETTERS, max_lines=3, placeholder=" …")
        figure.text(
            0.01, -below / figure.get_figheight(), "\n".join(lines), color=color, va="top",
            fontsize=points(SMALL), parse_math=False,
        )  # fmt: skip
        below += 1.25 * len(lines) * points(SMALL) / 72


def svg_of(figure: Figure) -> str:
    """Return a figure as SVG, titled by its label; the same figure gives the same text."""
    import matplotlib as mpl

    file, told = StringIO(), {"Date": None, "Title": str(figure.get_label())}
    with mpl.rc_context({"svg.hashsalt": "mars2d", "svg.fonttype": "none"}):
        figure.savefig(file, format="svg", bbox_inches="tight", metadata=told)
    picture = " ".join(file.getvalue().partition("<svg ")[2].split())
    return f'<svg style="max-width:100%;height:auto" {picture}'


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
        prop_path=np.empty((0, 3, len(scenario.props))),
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
