"""The legends of layers, in a corner of the picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import pygame

from mars2d.core.scene import Scene, faded
from mars2d.output.layers.legend import MAX_ARROW, Legend
from mars2d.output.raster.camera import PIXELS, Camera
from mars2d.output.raster.painter import Painter

LEAST = 300.0
"""The least width and height of a picture with a legend, points."""
MAX_SHARE = 0.25
"""The largest share of the picture's height for legends; those beyond are left out."""

GAP, PAD, ROW_HEIGHT, TEXT_SIZE = 8.0, 10.0, 24.0, 13.0
"""The room around a plate and within it, the heights of a row and of text, points."""


def draw_legends(
    surface: pygame.Surface,
    painter: Painter,
    camera: Camera,
    plot: pygame.Rect,
    legends: Sequence[Legend],
) -> None:
    """Draw legends side by side, in rows from the bottom up, if the picture has room for them."""
    if min(plot.size) < LEAST * painter.ui:
        return
    corner, top = plot.bottomleft, plot.bottom
    for legend in legends:
        plate = _measured(painter, legend, camera)
        if corner[0] + plate.size[0] > plot.right and corner[0] > plot.left:
            corner = plot.left, top
        if plot.bottom - corner[1] + plate.size[1] > MAX_SHARE * plot.height:
            break
        area = _draw(surface, painter, legend, plate, corner)
        corner, top = (area.right, corner[1]), min(top, area.top)


class _Plate(NamedTuple):
    """A legend's words, the width of its column of signs, the length of its arrow, and its size."""

    words: list[str]
    column: float
    length: float
    size: tuple[int, int]


def _measured(painter: Painter, legend: Legend, camera: Camera) -> _Plate:
    """Return the measures of a legend, pixels."""
    ui, words = painter.ui, [sign.meaning for sign in legend.signs]
    column = max((sign.room * ui for sign in legend.signs), default=0.0)
    length = 0.0
    if legend.ruler is not None:
        metres, said = legend.ruler.within(MAX_ARROW * ui / camera.scale)
        length = metres * camera.scale
        column, words = max(length, column), [said, *words]
    text = max(painter.fonts.width(word, TEXT_SIZE * ui) for word in words)
    width = round((2 * PAD + GAP) * ui + column + text)
    return _Plate(words, column, length, (width, round((len(words) * ROW_HEIGHT + GAP) * ui)))


def _draw(
    surface: pygame.Surface,
    painter: Painter,
    legend: Legend,
    measured: _Plate,
    corner: tuple[int, int],
) -> pygame.Rect:
    """Draw a legend on a plate to the upper right of a corner; return the plate."""
    ui, theme, fonts = painter.ui, painter.theme, painter.fonts
    row, gap, column = ROW_HEIGHT * ui, GAP * ui, measured.column
    plate = pygame.Rect((0, 0), measured.size)
    plate.bottomleft = (corner[0] + round(gap), corner[1] - round(gap))
    painter.panel(surface, plate, faded(theme.plate, 0.9), gap, theme.edge)
    left, middle = plate.left + PAD * ui, plate.top + 4 * ui + row / 2
    for k, word in enumerate(measured.words):
        image = fonts.render(word, TEXT_SIZE * ui, theme.text)
        place = image.get_rect(midleft=(round(left + column + gap), round(middle + k * row)))
        surface.blit(image, place)
    if legend.ruler is not None:
        scene, ends = Scene(), ((left, -middle), (left + measured.length, -middle))
        scene.arrow(*ends, fill=legend.ruler.color, width=legend.ruler.width)
        painter.paint(surface, scene.shapes, PIXELS)
        middle += row
    for k, sign in enumerate(legend.signs):
        at = Camera(ui, left + column / 2, middle + k * row)
        painter.paint(surface, sign.scene.shapes, at)
    return plate
