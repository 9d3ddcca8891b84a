"""The legends of layers, in a corner of the picture."""

from __future__ import annotations

from collections.abc import Sequence

import pygame

from mars2d.core.scene import faded
from mars2d.output.layers.arrows import Sign
from mars2d.output.layers.legend import Legend
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter

Placed = list[tuple[list[Sign], pygame.Rect]]
"""Legends, each with its plate."""

LEAST = 300.0
"""The least width and height of a picture with a legend, points."""
MAX_SHARE = 0.25
"""The largest share of the picture's height for legends; those beyond are left out."""
NEAR = 50.0
"""How much larger a plate is than what hides no middle of a body, points."""

GAP, PAD, ROW_HEIGHT, TEXT_SIZE = 8.0, 10.0, 24.0, 13.0
"""The room around a plate and within it, the heights of a row and of text, points."""


def draw_legends(
    surface: pygame.Surface,
    painter: Painter,
    camera: Camera,
    plot: pygame.Rect,
    legends: Sequence[Legend],
    beside: Sequence[pygame.Rect] = (),
    bodies: Sequence[Sequence[float]] = (),
    corner: int = 0,
) -> int:
    """Draw legends side by side, in rows from an edge, if the picture has room for them.

    beside: where they hide nothing; they lie in the first of these that has room for all. Else they
    lie in a corner, side by side or one above the other: where they lay last, or if they hide
    bodies there, where they hide the fewest. bodies: their middles, pixels. Return where, 0 to 7.
    """
    if min(plot.size) < LEAST * painter.ui:
        return corner
    rooms = [_placed(painter, camera, room, room.height, legends) for room in beside]
    best = max([Placed(), *rooms], key=len)
    inside = _placed(painter, camera, plot, MAX_SHARE * plot.height, legends)
    if len(inside) > len(best):
        column, near = plot.copy(), round(NEAR * painter.ui)
        column.width = max(plate.width for _, plate in inside) + round(GAP * painter.ui)
        above = _placed(painter, camera, column, plot.height / 2, legends)
        ways = [each for each in (inside, above) if len(each) == len(inside)]
        left, top = plot.left + plot.right, plot.top + plot.bottom
        corners = [
            [(signs, plate.move(k % 2 * (left - plate.left - plate.right),
                                k // 2 * (top - plate.top - plate.bottom)))
             for signs, plate in way]
            for way in ways for k in range(4)
        ]  # fmt: skip
        plates = [[plate.inflate(near, near) for _, plate in each] for each in corners]
        counts = [sum(rect.collidepoint(p) for rect in each for p in bodies) for each in plates]
        corner = corner if not counts[corner % len(corners)] else counts.index(min(counts))
        best = corners[corner % len(corners)]
    for signs, plate in best:
        _drawn(surface, painter, signs, plate)
    return corner


def _placed(
    painter: Painter, camera: Camera, room: pygame.Rect, high: float, legends: Sequence[Legend]
) -> Placed:
    """Return the legends for which a room has place up to a height, with their plates."""
    ui, gap = painter.ui, round(GAP * painter.ui)
    corner, top, placed = room.bottomleft, room.bottom, Placed()
    for legend in legends:
        ruler = [legend.ruler.sign(ui / camera.scale)] if legend.ruler else []
        signs = [*ruler, *legend.signs]
        text = max(painter.fonts.width(sign.name, TEXT_SIZE * ui) for sign in signs)
        column = max(sign.room for sign in signs)
        width = round((2 * PAD + GAP + column) * ui + text)
        height = round((len(signs) * ROW_HEIGHT + GAP) * ui)
        if corner[0] + gap + width > room.right and corner[0] > room.left:
            corner = room.left, top
        if room.bottom - corner[1] + gap + height > high or gap + width > room.width:
            break
        plate = pygame.Rect(corner[0] + gap, corner[1] - gap - height, width, height)
        placed.append((signs, plate))
        corner, top = (plate.right, corner[1]), min(top, plate.top)
    return placed


def _drawn(
    surface: pygame.Surface, painter: Painter, signs: Sequence[Sign], plate: pygame.Rect
) -> None:
    """Draw signs and their meanings on a plate."""
    ui, theme = painter.ui, painter.theme
    painter.panel(surface, plate, faded(theme.plate, 0.9), GAP * ui, theme.edge)
    column, row = max(sign.room for sign in signs) * ui, ROW_HEIGHT * ui
    left, middle = plate.left + PAD * ui, plate.top + 4 * ui + row / 2
    for k, sign in enumerate(signs):
        place = left + column + GAP * ui, middle + k * row
        painter.write(surface, sign.name, TEXT_SIZE * ui, theme.text, midleft=place)
        at = Camera(ui, left + column / 2, middle + k * row)
        painter.paint(surface, sign.scene.shapes, at)
