"""The inspector's plot of the force on a body, its bound, and the effort of its drive."""

from __future__ import annotations

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.core.scene import Scene, faded
from mars2d.output.layers.forces import FORCE, SLIP, SLIPPING, in_newtons
from mars2d.output.raster.camera import PIXELS
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Float, Frame
from mars2d.window.panels.forcemeter import Bound, Reading, bound_of, span_of
from mars2d.window.widgets.plot import Limits, draw_axes, draw_curve, polylines
from mars2d.window.widgets.words import Word, write_line

MAX_OVER_BOUND = 3.0
"""The upper end of the force axis, at most, as a multiple of the bound."""

LOW = 44.0
"""The height of the area of curves from which on words stand in it, points."""

HEAD, LEFT, FOOT = 22.0, 44.0, 17.0
"""The room for the title, the numbers of the force axis and those of the time axis, points."""


def draw_force(
    painter: Painter,
    frame: Frame,
    body: int,
    reading: Reading,
    surface: pygame.Surface,
    rect: pygame.Rect,
) -> None:
    """Draw a reading of the net contact force on a body within a rectangle."""
    ui, bound = painter.ui, bound_of(frame, body)
    _draw_title(surface, rect, painter, reading, bound)
    area = pygame.Rect(
        rect.left + round(LEFT * ui), rect.top + round(HEAD * ui) + 2,
        rect.width - round(LEFT * ui), rect.height - round((HEAD + FOOT) * ui) - 2,
    )  # fmt: skip
    span = span_of(frame.scenario.sampling_time)
    end = max(frame.time, span)
    limits = Limits(end - span, end, 0.0, _top(reading.force, bound))
    draw_axes(surface, area, painter, limits, "N")
    before = surface.get_clip()
    surface.set_clip(area.inflate(2, 4).clip(before))
    _draw_curves(surface, area, painter, frame, reading, bound, limits)
    surface.set_clip(before)


def _draw_title(
    surface: pygame.Surface,
    rect: pygame.Rect,
    painter: Painter,
    reading: Reading,
    bound: Bound | None,
) -> None:
    """Write the names of the curves, as far as there is room, and the present force."""
    theme = painter.theme
    line = pygame.Rect(rect.topleft, (rect.width, round(HEAD * painter.ui)))
    now = float(reading.force[-1]) if len(reading.force) else 0.0
    names = [Word("net contact force", theme.ink, 12, bold=True)]
    if reading.effort is not None and bound is not None:
        names.append(Word("effort", theme.effort, 12))
        if (reading.effort >= SLIPPING).any():
            names += [Word("■", SLIP, 12), Word("slips", theme.text, 12)]
    force = Word(in_newtons(now), theme.shade(FORCE), 14, bold=True)
    write_line(surface, line, painter, names, [force])


def _draw_curves(
    surface: pygame.Surface,
    area: pygame.Rect,
    painter: Painter,
    frame: Frame,
    reading: Reading,
    bound: Bound | None,
    limits: Limits,
) -> None:
    """Draw the force and the effort as steps, the stretches of slip, and the bound."""
    start, end, _, top = limits
    ui, theme, ink = painter.ui, painter.theme, painter.theme.shade(FORCE)
    ends = reading.start + frame.scenario.sampling_time * np.arange(1, len(reading.force) + 1)
    ends = np.minimum(ends, frame.time)  # of the control steps
    edges = np.append(reading.start, ends)
    if reading.effort is not None and len(reading.effort) and bound is not None:
        for a, b in stretches(reading.effort >= SLIPPING):
            left, right = limits.pixels(area, edges[[a, b]], np.zeros(2))[:, 0].round().tolist()
            band = pygame.Surface((max(1, int(right - left)), area.height))
            band.fill(SLIP)
            band.set_alpha(70)
            surface.blit(band, (left, area.top))
        lines = polylines(area, limits, ends, bound.force * reading.effort, held="pre")
        draw_curve(surface, painter, lines, theme.effort, 1.4)
    for points in polylines(area, limits, ends, np.minimum(reading.force, top), held="pre"):
        if reading.force.any():
            scene = Scene()
            foot = [(points[-1, 0], area.bottom), (points[0, 0], area.bottom)]
            scene.polygon(np.vstack([points, foot]) * (1, -1), fill=faded(ink, 0.18))
            painter.paint(surface, scene.shapes, PIXELS, shaded=False)
        draw_curve(surface, painter, [points], ink, 2.2)
    scene = Scene()
    if len(reading.force) and reading.force.max() > top:
        k = int(reading.force.argmax())
        word = f"peak {in_newtons(float(reading.force[k]))}"
        half = painter.fonts.width(word, 12 * ui) / 2 + 6 * ui
        left, right = limits.pixels(area, edges[[k, k + 1]], np.zeros(2))[:, 0].tolist()
        x = right + half if right + 2 * half <= area.right else left - half  # beside the peak
        scene.text((x, -area.top), word, color=ink, anchor="below", halo=theme.plate)
    if bound is not None:
        line = limits.pixels(area, np.array([start, end]), np.full(2, bound.force)) * (1, -1)
        scene.line(line, stroke=theme.ink, width=1.5, style="--")
        word = f"{bound.name} {in_newtons(bound.force)}" if area.height >= LOW * ui else ""
        width = painter.fonts.width(word, 12 * ui) + 8 * ui
        over = limits.pixels(area, edges[:-1], reading.force)[reading.force > bound.force, 0]
        lefts = (area.left, area.right - width)
        left = min(lefts, key=lambda x: np.count_nonzero((over > x) & (over < x + width)))
        place = (left + width / 2, line[0, 1] - 2 * ui)
        scene.text(place, word, color=theme.ink, anchor="above", halo=theme.plate)
    painter.paint(surface, scene.shapes, PIXELS, shaded=False)


def _top(force: Float, bound: Bound | None) -> float:
    """Return the upper end of the force axis, newtons."""
    peak = float(force.max(initial=0.0))
    if bound is None:
        return 1.15 * peak if peak > 0 else 1.0
    return max(1.45 * bound.force, min(1.1 * peak, MAX_OVER_BOUND * bound.force))


def stretches(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return the stretches of set flags, each as its start and its end."""
    changes = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    return list(zip(changes[::2].tolist(), changes[1::2].tolist(), strict=True))
