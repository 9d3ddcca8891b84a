"""Paint scenes on pygame surfaces, anti-aliased; needs no display.

Shapes are drawn some times larger on a surface of their own, which `smoothscale` then averages:
exact coverage for any shape, width and opacity. Small shapes that recur (robots, marks) are kept as
sprites, at quarters of a pixel so that slow movement stays smooth.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from functools import cache
from math import ceil, floor

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.scene import Circle, Line, Polygon, Shape, Text, split_wake_style
from mars2d.view.camera import Camera
from mars2d.view.clip import clip_lines, clip_polygon
from mars2d.view.fonts import Fonts
from mars2d.view.strokes import DASHES, MARK_SPACING, arc_length, dashes, hairlines

__all__ = ["Painter", "rgba"]

Float = NDArray[np.float64]
Rgba = tuple[int, int, int, int]
Draw = Callable[[pygame.Surface, float, float, float, Rgba], None]
"""Draws on a surface `factor` times too large, whose corner lies at (left, top)."""
Layer = tuple[Rgba, Draw, int]
"""One colour of a sprite; the number tells how many times larger to draw it, 0 leaves it open."""

PHASES = 4
BROAD = 20.0
"""The radius in pixels from which a ring is drawn of hair lines."""
LARGEST_SPRITE = 160.0
LARGE = 40_000
"""The area in pixels beyond which a shape is not drawn larger and averaged, if that may be."""
FAINT = 96
"""The opacity, of 255, below which a fill's edge needs no anti-aliasing when it is large."""


@cache
def rgba(color: str) -> Rgba:
    """Return ``#rrggbb`` or ``#rrggbbaa`` as four numbers from 0 to 255."""
    digits = color[1:] + ("ff" if len(color) == 7 else "")
    return int(digits[:2], 16), int(digits[2:4], 16), int(digits[4:6], 16), int(digits[6:8], 16)


class Painter:
    """Paints shapes; keeps the sprites and the texts it made from one picture to the next.

    ui: pixels a point, the unit of line widths and text sizes.
    """

    KEPT_PIXELS = 6_000_000

    def __init__(self, fonts: Fonts | None = None) -> None:
        """Start without sprites; `fonts` may be shared."""
        self.fonts = fonts or Fonts()
        self.ui = 1.0
        self._sprites: dict[Hashable, tuple[pygame.Surface, int, int]] = {}
        self._kept = 0

    def paint(self, surface: pygame.Surface, shapes: Iterable[Shape], camera: Camera) -> None:
        """Paint shapes in their order on a surface."""
        for shape in shapes:
            if isinstance(shape, Circle):
                self._circle(surface, shape, camera)
            elif isinstance(shape, Line):
                self._line(surface, shape, camera)
            elif isinstance(shape, Polygon):
                self._polygon(surface, shape, camera)
            else:
                self._text(surface, shape, camera)

    # -- circles ------------------------------------------------------------------------------

    def _circle(self, surface: pygame.Surface, shape: Circle, camera: Camera) -> None:
        x = camera.x + camera.scale * shape.center[0]
        y = camera.y - camera.scale * shape.center[1]
        radius = camera.scale * shape.radius + shape.pixels * self.ui
        width = shape.width * self.ui if shape.stroke else 0.0
        reach = radius + width
        if not (-reach < x < surface.get_width() + reach):
            return
        if not (-reach < y < surface.get_height() + reach):
            return
        radius = round(8 * radius) / 8
        if reach > LARGEST_SPRITE:
            self._large_circle(surface, shape, x, y, radius)
            return
        px, fx = _phase(x)
        py, fy = _phase(y)
        key = (shape.fill, shape.stroke, radius, width, fx, fy)
        sprite = self._sprites.get(key)
        if sprite is None:
            layers = _disc_layers(shape, radius, width, fx, fy)
            sprite = self._keep(key, _box(fx, fy, reach), layers)
        surface.blit(sprite[0], (px + sprite[1], py + sprite[2]))

    def _large_circle(
        self, surface: pygame.Surface, shape: Circle, x: float, y: float, radius: float
    ) -> None:
        """Draw a circle as the polygon of many corners that it nearly is."""
        ring = _ring(x, y, radius)
        if shape.fill:
            self._fill(surface, ring, rgba(shape.fill))
        if shape.stroke:
            _stroke(surface, rgba(shape.stroke), [ring], shape.width * self.ui)

    # -- polygons -----------------------------------------------------------------------------

    def _polygon(self, surface: pygame.Surface, shape: Polygon, camera: Camera) -> None:
        points = camera.to_pixels(shape.points)
        if len(points) == 0:
            return
        width = shape.width * self.ui
        if shape.fill:
            self._fill(surface, points, rgba(shape.fill))
        if shape.stroke:
            ring = np.vstack([points, points[:1]])
            _stroke(surface, rgba(shape.stroke), [ring], width)

    def _fill(self, surface: pygame.Surface, points: Float, color: Rgba) -> None:
        visible = clip_polygon(points, _reach(surface))
        if len(visible) < 3:
            return
        box = _extent(visible, 1.0)
        large = box.width * box.height > LARGE
        factor = 1 if large and color[3] < FAINT else 0
        _cover(surface, color, box, _filled(visible), factor=factor)

    # -- lines --------------------------------------------------------------------------------

    def _line(self, surface: pygame.Surface, shape: Line, camera: Camera) -> None:
        marker, line = split_wake_style(shape.style)
        if line == "-" and len(shape.points) == 2:
            self._segment(surface, shape, camera)
            return
        points = camera.to_pixels(shape.points)
        color = rgba(shape.stroke)
        width = shape.width * self.ui
        if line in DASHES:  # dashed before it is cut, or the dashes would crawl when panning
            pattern = tuple(self.ui * length for length in DASHES[line])
            _stroke(surface, color, dashes(points, pattern), width)
        elif line:
            _stroke(surface, color, [points], width)
        if marker:
            buckets = np.floor(arc_length(points) / (MARK_SPACING * self.ui))
            kept = np.concatenate([[True], np.diff(buckets) > 0])
            self.marks(surface, points[kept], marker, shape.stroke, shape.width)

    def _segment(self, surface: pygame.Surface, shape: Line, camera: Camera) -> None:
        """Draw one straight line, from a sprite if it is short."""
        (ax, ay), (bx, by) = shape.points.tolist()
        x, y = camera.x + camera.scale * ax, camera.y - camera.scale * ay
        dx, dy = camera.scale * (bx - ax), camera.scale * (ay - by)
        # A short line stays a line: a small robot's heading must not become a blob.
        width = min(shape.width * self.ui, max(1.0, (abs(dx) + abs(dy)) / 3.5))
        width = round(8 * width) / 8
        color = rgba(shape.stroke)
        if max(abs(dx), abs(dy)) > LARGEST_SPRITE / 2:
            _stroke(surface, color, [np.array([(x, y), (x + dx, y + dy)])], width)
            return
        px, fx = _phase(x)
        py, fy = _phase(y)
        dx, dy = round(dx * PHASES) / PHASES, round(dy * PHASES) / PHASES
        key = (color, width, fx, fy, dx, dy)
        sprite = self._sprites.get(key)
        if sprite is None:
            points = np.array([(fx, fy), (fx + dx, fy + dy)])
            box = _extent(points, width / 2 + 1)
            sprite = self._keep(key, box, [(color, _stroked([points], width), 0)])
        surface.blit(sprite[0], (px + sprite[1], py + sprite[2]))

    def marks(
        self, surface: pygame.Surface, points: Float, marker: str, color: str, width: float
    ) -> None:
        """Draw the marks ``. o x + * s`` at pixels (k, 2)."""
        width *= self.ui
        for x, y in points.tolist():
            px, fx = _phase(x)
            py, fy = _phase(y)
            key = (marker, color, width, fx, fy)
            sprite = self._sprites.get(key)
            if sprite is None:
                draw, reach = _mark(marker, fx, fy, self.ui, width)
                sprite = self._keep(key, _box(fx, fy, reach), [(rgba(color), draw, 0)])
            surface.blit(sprite[0], (px + sprite[1], py + sprite[2]))

    # -- text ---------------------------------------------------------------------------------

    def _text(self, surface: pygame.Surface, shape: Text, camera: Camera) -> None:
        ((x, y),) = camera.to_pixels([shape.position]).tolist()
        gap = 4 * self.ui
        lines = shape.text.split("\n")
        images = [self.fonts.render(text, shape.size * self.ui, shape.color) for text in lines]
        height = sum(image.get_height() for image in images)
        top = {"above": y - gap - height, "below": y + gap}.get(shape.anchor, y - height / 2)
        for image in images:
            width = image.get_width()
            # MARS's and matplotlib's sense: "left" puts the text's left end at the point
            left = {"left": x + gap, "right": x - gap - width}.get(shape.anchor, x - width / 2)
            surface.blit(image, (round(left), round(top)))
            top += image.get_height()

    # -- what the window's own parts are made of ----------------------------------------------

    def panel(
        self,
        surface: pygame.Surface,
        rect: pygame.Rect,
        fill: str,
        radius: float,
        stroke: str | None = None,
    ) -> None:
        """Draw a box with round corners; `radius` in pixels."""
        key = ("panel", rect.size, fill, radius, stroke)
        sprite = self._sprites.get(key)
        if sprite is None:
            box = pygame.Rect(0, 0, *rect.size)
            layers = [(rgba(stroke or fill), _rounded(box, radius), 0)]
            if stroke:
                layers.append((rgba(fill), _rounded(box.inflate(-2, -2), radius - 1), 0))
            sprite = self._keep(key, box, layers)
        surface.blit(sprite[0], rect.topleft)

    def _keep(
        self, key: Hashable, box: pygame.Rect, layers: Sequence[Layer]
    ) -> tuple[pygame.Surface, int, int]:
        """Draw a sprite and remember it, forgetting the oldest when there are too many."""
        image = pygame.Surface(box.size, pygame.SRCALPHA, 32)
        for color, draw, factor in layers:
            larger = factor or _sprite_factor(box)
            _cover(image, color, image.get_rect(), draw, box.topleft, larger)
        area = box.width * box.height
        while self._sprites and self._kept + area > self.KEPT_PIXELS:
            old = self._sprites.pop(next(iter(self._sprites)))[0]
            self._kept -= old.get_width() * old.get_height()
        sprite = (image, box.left, box.top)
        self._sprites[key] = sprite
        self._kept += area
        return sprite


def _sprite_factor(box: pygame.Rect) -> int:
    return 8 if box.width * box.height < 1600 else 4


def _phase(value: float) -> tuple[int, float]:
    """Split a pixel coordinate into a whole number and a number of quarters."""
    quarters = round(value * PHASES)
    return quarters // PHASES, (quarters % PHASES) / PHASES


def _box(x: float, y: float, reach: float) -> pygame.Rect:
    """Return the rectangle of whole pixels that holds a circle and its soft edge."""
    left, top = floor(x - reach - 1), floor(y - reach - 1)
    return pygame.Rect(left, top, ceil(x + reach + 1) - left, ceil(y + reach + 1) - top)


FAR = 1e8


def _extent(points: Float, margin: float) -> pygame.Rect:
    low = np.clip(np.floor(points.min(axis=0) - margin), -FAR, FAR)
    high = np.clip(np.ceil(points.max(axis=0) + margin), -FAR, FAR)
    return pygame.Rect(*low.astype(int).tolist(), *(high - low).astype(int).tolist())


def _cover(
    surface: pygame.Surface,
    color: Rgba,
    box: pygame.Rect,
    draw: Draw,
    corner: tuple[int, int] = (0, 0),
    factor: int = 0,
) -> None:
    """Draw within `box` of a surface, whose own corner lies at `corner`, with smooth edges."""
    box = box.clip(surface.get_clip())
    if box.width <= 0 or box.height <= 0:
        return
    area = box.width * box.height
    if factor == 0:
        factor = 4 if area < 250_000 else 2
    if factor == 1:
        layer = pygame.Surface(box.size, pygame.SRCALPHA, 32)
        layer.fill((*color[:3], 0))
        draw(layer, box.left + corner[0], box.top + corner[1], 1, color)
        surface.blit(layer, box.topleft)
        return
    large = pygame.Surface((box.width * factor, box.height * factor), pygame.SRCALPHA, 32)
    # The colour without opacity, so that averaging changes the opacity alone.
    large.fill((*color[:3], 0))
    draw(large, box.left + corner[0], box.top + corner[1], factor, color)
    surface.blit(pygame.transform.smoothscale(large, box.size), box.topleft)


def _scaled(points: Float, left: float, top: float, factor: float) -> list[tuple[float, float]]:
    """Return the points as they lie on the large surface; pygame's pixel centres are whole."""
    large: list[tuple[float, float]] = ((points - (left, top)) * factor - 0.5).tolist()
    return large


def _reach(surface: pygame.Surface) -> tuple[float, float, float, float]:
    """Return the box of pixels beyond which nothing drawn reaches into the surface."""
    clip = surface.get_clip()
    return clip.left - 50.0, clip.top - 50.0, clip.right + 50.0, clip.bottom + 50.0


def _disc_layers(shape: Circle, radius: float, width: float, x: float, y: float) -> list[Layer]:
    layers: list[Layer] = []
    broad = radius > BROAD and shape.stroke is not None
    if shape.fill:
        color = rgba(shape.fill)
        # The ring will cover the edge.
        factor = 0 if not broad else 1 if color[3] < FAINT else 2
        layers.append((color, _disc(x, y, radius), factor))
    if shape.stroke:
        draw = _disc(x, y, radius + width / 2, width)
        if broad:
            draw = _drawn_finely([_ring(x, y, radius)], width)
        layers.append((rgba(shape.stroke), draw, 1 if broad else 0))
    return layers


def _ring(x: float, y: float, radius: float) -> Float:
    """Return the corners of the polygon that a circle nearly is, closed, (k, 2)."""
    angles = np.linspace(0, 2 * np.pi, int(min(max(radius, 60), 1500)))
    return np.column_stack([x + radius * np.cos(angles), y + radius * np.sin(angles)])


def _disc(x: float, y: float, radius: float, width: float = 0.0) -> Draw:
    def draw(large: pygame.Surface, left: float, top: float, factor: float, color: Rgba) -> None:
        # Unlike lines and polygons, circles are centred on the corners between pixels.
        center = (round((x - left) * factor), round((y - top) * factor))
        # A width of 0 would fill the ring.
        thick = max(1, round(width * factor)) if width > 0 else 0
        pygame.draw.circle(large, color, center, max(radius * factor, 0.5), thick)

    return draw


def _filled(points: Float) -> Draw:
    def draw(large: pygame.Surface, left: float, top: float, factor: float, color: Rgba) -> None:
        outline = _scaled(points, left, top, factor)
        if len(outline) > 2:
            pygame.draw.polygon(large, color, outline)

    return draw


def _rounded(box: pygame.Rect, radius: float) -> Draw:
    def draw(large: pygame.Surface, left: float, top: float, factor: float, color: Rgba) -> None:
        place = pygame.Rect(
            (box.left - left) * factor, (box.top - top) * factor,
            box.width * factor, box.height * factor,
        )  # fmt: skip
        pygame.draw.rect(large, color, place, border_radius=round(radius * factor))

    return draw


def _stroke(surface: pygame.Surface, color: Rgba, pieces: list[Float], width: float) -> None:
    """Draw polylines as one shape: where they cross, their opacity does not add up."""
    box = _reach(surface)
    pieces = [part for piece in pieces for part in clip_lines(piece, box) if len(part)]
    if pieces:
        extent = _extent(np.vstack(pieces), width / 2 + 1)
        large = extent.width * extent.height > LARGE
        draw = _drawn_finely(pieces, width) if large else _stroked(pieces, width)
        _cover(surface, color, extent, draw, factor=1 if large else 0)


def _stroked(pieces: list[Float], width: float) -> Draw:
    def draw(large: pygame.Surface, left: float, top: float, factor: float, color: Rgba) -> None:
        thick = max(1, round(width * factor))
        for piece in pieces:
            points = _scaled(piece, left, top, factor)
            if len(points) > 1:
                pygame.draw.lines(large, color, False, points, thick)
            if thick > 2:
                for x, y in points:  # round joints and ends
                    pygame.draw.circle(large, color, (round(x + 0.5), round(y + 0.5)), thick / 2)

    return draw


def _drawn_finely(pieces: list[Float], width: float) -> Draw:
    """Return how to draw polylines at their true size: for those that span much of the picture."""

    def draw(large: pygame.Surface, left: float, top: float, factor: float, color: Rgba) -> None:
        for piece in pieces:
            hairlines(large, color, (piece - (left, top)) * factor - 0.5, width)

    return draw


def _mark(marker: str, x: float, y: float, ui: float, width: float) -> tuple[Draw, float]:
    """Return how to draw one of the marks ``. o x + * s`` and how far it reaches, pixels."""
    if marker == ".":
        return _disc(x, y, 2.2 * ui), 2.2 * ui
    if marker == "o":
        return _disc(x, y, 3.2 * ui + width / 2, width), 3.2 * ui + width
    r = 3.2 * ui
    spokes = {
        "x": [(-r, -r, r, r), (-r, r, r, -r)],
        "+": [(-r, 0, r, 0), (0, -r, 0, r)],
        "*": [(0, -r, 0, r), (-0.87 * r, -r / 2, 0.87 * r, r / 2),
              (-0.87 * r, r / 2, 0.87 * r, -r / 2)],
        "s": [(-r, -r, r, -r), (r, -r, r, r), (r, r, -r, r), (-r, r, -r, -r)],
    }[marker]  # fmt: skip
    pieces = [np.array([(x + a, y + b), (x + c, y + d)]) for a, b, c, d in spokes]
    return _stroked(pieces, width), r + width
