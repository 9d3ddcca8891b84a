"""One instant as an SVG drawing: the layers, with metres at the sides and a caption."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from math import ceil, floor, log10

import numpy as np
from numpy.typing import NDArray

from mars2d.core.hints import described
from mars2d.core.plane import grid_step
from mars2d.core.scene import Anchor, Scene, Text
from mars2d.output.figures.extent import View
from mars2d.output.figures.style import SCREEN
from mars2d.output.layers.forces import forces as force_arrows
from mars2d.output.layers.legend import SIGNED, legends, sign_rows
from mars2d.output.layers.placement import Box, placed_names
from mars2d.output.layers.table import Layers
from mars2d.output.pages.svg import ScaledScene, svg
from mars2d.output.raster.theme import LIGHT
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]

WIDTH, HEIGHT = 560.0, 440.0
"""The room for the layers, which are drawn as large as fits, pixels."""
LEFT, RIGHT, ABOVE = 36.0, 10.0, 10.0
"""The room at its sides, pixels."""

MAX_CHARACTERS = 1_000_000
"""The most characters of a drawing with paths; beyond, they are left out."""

FEW_BODIES = 8
"""The most bodies with names; among more, paths are thinner."""

MIN_SPACING = 42.0  # pixels from one line of the grid to the next, at least
TEXT_SIZE, LINE_HEIGHT = 12.0, 16.0  # of the caption's words and lines, pixels
LETTER_WIDTH = 0.52 * TEXT_SIZE  # the width of a letter, about
NUMBER_SIZE = 11.0  # the size of the numbers at the sides, pixels

INK, MUTED, WARNING = LIGHT.ink, LIGHT.muted, LIGHT.failed
GRID, AXIS = SCREEN.grid, "#d0d6dd"


def draw(frame: Frame, caption: str, layers: Layers | None = None) -> str:
    """Return a frame as an SVG picture with a caption below it.

    layers: the switches; by default those of the animation, with names for few bodies. A layer
    that can't be drawn because a sensor or an add-on raises is left out, and a line below the
    caption says so. So are paths that would take more than a million characters.
    """
    view = View.around(
        frame.scenario,
        _with_end(frame.path, frame.pose),
        _with_end(frame.prop_path, frame.prop_pose),
    )
    notes: list[str] = []
    if layers is None:
        few = len(frame.scenario.bodies) <= FEW_BODIES
        layers = Layers.of(frame.scenario.animation, names=few)
    parts = _parts(frame, view, layers, notes)
    picture = _framed([part for _, part in parts], view, caption, notes)
    if len(picture) > MAX_CHARACTERS:
        notes.append("The paths are left out: they would take too much room in a notebook.")
        kept = [part for name, part in parts if name != "trails"]
        picture = _framed(kept, view, caption, notes)
    return picture


def say(words: str) -> str:
    """Return words as a picture."""
    lines = [(line, WARNING) for line in textwrap.wrap(words, int(WIDTH / LETTER_WIDTH))]
    view = View(0.0, WIDTH, -LINE_HEIGHT * len(lines), 0.0)
    return svg(
        [(_written(lines, (0.0, LINE_HEIGHT / 2), 1.0), 1.0)],
        view,
        (view.width, view.height),
        words,
    )


def _with_end(path: Float, pose: Float) -> Float:
    return np.concatenate([path, pose[None]]) if len(path) else pose[None]


def _parts(
    frame: Frame, view: View, layers: Layers, notes: list[str]
) -> list[tuple[str, ScaledScene]]:
    """Return the layers and their names, the lowest first; add errors to `notes`."""
    scales = _scales(frame.scenario, _ppm(view))
    found = []
    for layer in layers.seen(frame.scenario.animation):
        try:
            scene = layer.shapes(frame) if layer.shapes else _grid(frame.scenario, view)
            if layer.name == "names":
                scene = _names_apart(scene, frame, view, scales["names"], layers)
            found.append((layer.name, (scene, scales.get(layer.name, scales["bodies"]))))
        except Exception as error:
            notes.append(f"Not drawn: {layer.title.lower()}. {described(error)}")
    return [*found, ("legend", (_signs(frame, view, layers), 0.85))]


def _signs(frame: Frame, view: View, layers: Layers) -> Scene:
    """Return the legend of the layers' signs, in the lower left corner."""
    shown = [
        legend
        for legend in legends(frame.scenario)
        if legend.layer in SIGNED and getattr(layers, legend.layer)
    ]
    corner = view.xmin + 8 / _ppm(view), view.ymin + 14 / _ppm(view)
    return sign_rows(shown, corner, 0.85 / _ppm(view))


def _names_apart(names: Scene, frame: Frame, view: View, scale: float, layers: Layers) -> Scene:
    """Return the names of bodies, none over another or over a force that is drawn."""
    whole = Box(
        (view.xmin + view.xmax) / 2, (view.ymin + view.ymax) / 2, view.width / 2, view.height / 2
    )
    others = force_arrows(frame).shapes if layers.forces else ()
    return placed_names(names, frame, scale / _ppm(view), whole, others)


def _scales(scenario: Scenario, ppm: float) -> dict[str, float]:
    """Return the factor for the widths of lines, by layer; "bodies" stands for all others.

    Lines grow thinner with the robots, and in a crowd. ppm: the pixels of a metre.
    """
    few = len(scenario.bodies) <= FEW_BODIES
    robots = min(max(min(robot.radius for robot in scenario.robots) * ppm / 9, 0.1), 0.8)
    if not scenario.animation.show_real_shape:
        robots = 0.8 if few else 0.5
    return {
        "workspace": 0.8,
        "floor": 0.8,
        "grid": 1.0,
        "edge": 0.8,
        "obstacles": 0.7,
        "starts": min(1.3 * robots, 0.8),
        "trails": 0.75 if few else 0.5,
        "sensors": 0.7,
        "addons": 0.8,
        "theory": 0.8,
        "props": min(robots, 0.7),
        "rings": 0.8,
        "robots": robots,
        "names": 0.85,
        "bodies": max(0.4, robots),
    }


def _framed(layers: Sequence[ScaledScene], view: View, caption: str, notes: Sequence[str]) -> str:
    """Return layers with numbers at their sides, and words below."""
    ppm = _ppm(view)
    room = max(20, int((ppm * view.width + LEFT) / LETTER_WIDTH))
    words = [(line, INK) for line in textwrap.wrap(caption, room, max_lines=3, placeholder=" …")]
    for note in notes:
        lines = textwrap.wrap(note, room, max_lines=3, placeholder=" …")
        words += [(line, WARNING) for line in lines]
    below = 2 * LINE_HEIGHT + LINE_HEIGHT * len(words)
    whole = View(
        view.xmin - LEFT / ppm, view.xmax + RIGHT / ppm,
        view.ymin - below / ppm, view.ymax + ABOVE / ppm,
    )  # fmt: skip
    margin = [
        _around(view, whole),
        _numbers(view),
        _written(words, (whole.xmin, view.ymin - LINE_HEIGHT / ppm), ppm),
    ]
    size = (ppm * whole.width, ppm * whole.height)
    title = " ".join([caption, *notes])
    return svg([*layers, *((scene, 1.0) for scene in margin)], whole, size, title)


def _written(lines: Sequence[tuple[str, str]], corner: tuple[float, float], ppm: float) -> Scene:
    """Return lines of text, each with its colour, below a point."""
    scene = Scene()
    for k, (line, color) in enumerate(lines):
        place = (corner[0], corner[1] - (1 + k) * LINE_HEIGHT / ppm)
        scene.text(place, line, color=color, size=TEXT_SIZE, anchor="left")
    return scene


def _ppm(view: View) -> float:
    """Return the pixels of a metre."""
    return min(WIDTH / view.width, HEIGHT / view.height)


def _around(view: View, whole: View) -> Scene:
    """Return the ground below the text, which covers layers that reach beyond the view."""
    scene = Scene()
    for xmin, xmax, ymin, ymax in (
        (whole.xmin, view.xmin, whole.ymin, whole.ymax),
        (whole.xmin, whole.xmax, whole.ymin, view.ymin),
    ):
        corners = [(xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax)]
        scene.polygon(corners, fill="#ffffff")
    return scene


def _step(view: View) -> float:
    """Return the distance of grid lines, metres."""
    return grid_step(MIN_SPACING / _ppm(view))


def _ticks(low: float, high: float, step: float) -> list[float]:
    """Return the multiples of a step from `low` to `high`."""
    return [k * step for k in range(ceil(low / step - 1e-6), floor(high / step + 1e-6) + 1)]


def _grid(scenario: Scenario, view: View) -> Scene:
    """Return the lines of the grid, within the workspace."""
    import shapely

    step, scene = _step(view), Scene()
    across = [[(x, view.ymin), (x, view.ymax)] for x in _ticks(view.xmin, view.xmax, step)]
    upwards = [[(view.xmin, y), (view.xmax, y)] for y in _ticks(view.ymin, view.ymax, step)]
    for axis, lines in enumerate((across, upwards)):
        for line in lines:
            stretches = [np.array(line)]
            if scenario.workspace is not None:
                inside = shapely.intersection(
                    shapely.LineString(line), shapely.Polygon(scenario.workspace)
                )
                stretches = [shapely.get_coordinates(p) for p in shapely.get_parts(inside)]
            color = AXIS if abs(line[0][axis]) < step / 2 else GRID
            for stretch in stretches:
                if len(stretch) > 1:
                    scene.line(stretch, stroke=color)
    return scene


def _numbers(view: View) -> Scene:
    """Return the metres below and beside the layers; the last ones with their unit."""
    step, scene = _step(view), Scene()
    decimals = max(0, -floor(log10(step) + 1e-9))

    def add(place: tuple[float, float], value: float, anchor: Anchor, unit: str) -> None:
        text = f"{value + 0.0:.{decimals}f}".replace("-", "\N{MINUS SIGN}")
        scene.shapes.append(Text(place, text + unit, MUTED, NUMBER_SIZE, anchor))

    across = _ticks(view.xmin, view.xmax, step)
    for x in across:
        add((x, view.ymin), x, "below", " m" if x == across[-1] else "")
    for y in _ticks(view.ymin, view.ymax, step):
        add((view.xmin, y), y, "right", "")
    return scene
