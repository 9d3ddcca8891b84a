"""Paint scenes on pygame surfaces, anti-aliased; needs no display.

Shapes are drawn enlarged on a surface of their own, which `smoothscale` then averages: exact
coverage for any shape, width and opacity. Small shapes that recur (robots, marks) are kept as
sprites, at quarters of a pixel so that slow movement stays smooth.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from math import ceil, floor

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.core.scene import Arrow, Circle, Image, Line, Polygon, Shape, Text, split_wake_style
from mars2d.output.lines import DASHES, MARK_SPACING, arrow_outline, spaced
from mars2d.output.raster import brushes
from mars2d.output.raster.brushes import Draw, Enlarged, Rgba, rgba
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.fonts import Fonts
from mars2d.output.raster.strokes import clip_polygon, dashes
from mars2d.output.raster.theme import LIGHT, Theme

Float = NDArray[np.float64]
Layer = tuple[Rgba, Draw, int]
"""One colour of a sprite: its ink, what draws it, and the factor of enlargement or 0."""

PHASES = 4
MAX_SPRITE_SIDE = 160.0
MAX_UNCUT = 10_000.0
"""The largest coordinate of a hairline that is drawn without clipping, pixels."""
ARROW_EDGE = 0.4
"""The width of the edge round an arrow, in widths of its shaft."""
FAINT_OPACITY = 96
"""The opacity, of 255, below which a fill's edge needs no anti-aliasing when it is large."""
LARGE_AREA = 2_500
"""The area from which a fill counts as large, pixels."""

Sprite = tuple[pygame.Surface, int, int]
"""A small picture, and the offset of its corner from the whole pixel at which it is drawn."""


class Painter:
    """Paints shapes, and keeps sprites and texts from one picture to the next.

    theme: converts the colours of scenes. ui: pixels per point, the unit of line widths and text
    sizes. kept: the most pixels of sprites to keep, 0 for none.
    """

    def __init__(
        self, fonts: Fonts | None = None, kept: int = 6_000_000, theme: Theme = LIGHT
    ) -> None:
        """Start without sprites; `fonts` may be shared."""
        self.fonts = fonts or Fonts()
        self.ui = 1.0
        self.theme = theme
        self._shade: Callable[[str], str] = theme.shade
        self._sprites: dict[Hashable, Sprite] = {}
        self._most, self._kept = kept, 0

    def paint(
        self,
        surface: pygame.Surface,
        shapes: Iterable[Shape],
        camera: Camera,
        *,
        shaded: bool = True,
    ) -> None:
        """Paint shapes in their order on a surface, and above them the texts with a halo.

        Where two of these would overlap, the last one is written alone. shaded: whether the theme
        converts the colours, as for scenes; False for the theme's own.
        """
        self._shade = self.theme.shade if shaded else str
        draws: dict[type[Shape], Callable[..., None]] = {
            Circle: self._circle, Line: self._line, Polygon: self._polygon, Arrow: self._arrow,
            Image: self._image,
        }  # fmt: skip
        labels: list[Text] = []
        for shape in shapes:
            if isinstance(shape, Text) and shape.halo:
                labels.append(shape)
            elif isinstance(shape, Text):
                surface.fblits(self._text(shape, camera))
            else:
                draws[type(shape)](surface, shape, camera)
        taken: list[pygame.Rect] = []
        for label in reversed(labels):
            lines = self._text(label, camera)
            boxes = [image.get_rect(topleft=at).scale_by(1.0, 0.6) for image, at in lines]
            if all(box.collidelist(taken) < 0 for box in boxes):
                taken += boxes
                surface.fblits(lines)

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
        fill, stroke = self._ink(shape.fill), self._ink(shape.stroke)
        if reach > MAX_SPRITE_SIDE:
            ring = brushes.ring(x, y, radius)
            if fill:
                self._fill(surface, ring, fill)
            if stroke:
                brushes.stroke(surface, stroke, [ring], width)
            return
        self._stamp(
            surface, x, y, (fill, stroke, radius, width),
            lambda fx, fy: (
                brushes.box_round(fx, fy, reach),
                _disc_layers(fill, stroke, radius, width, fx, fy),
            ),
        )  # fmt: skip

    def _stamp(
        self, surface: pygame.Surface, x: float, y: float, key: Hashable,
        made: Callable[[float, float], tuple[pygame.Rect, Sequence[Layer]]],
    ) -> None:  # fmt: skip
        """Draw a sprite at a point; made: returns its box and layers, given quarters of a pixel."""
        (px, fx), (py, fy) = _phase(x), _phase(y)
        sprite = self._sprites.get((key, fx, fy)) or self._keep((key, fx, fy), *made(fx, fy))
        surface.blit(sprite[0], (px + sprite[1], py + sprite[2]))

    # -- polygons -----------------------------------------------------------------------------

    def _polygon(self, surface: pygame.Surface, shape: Polygon, camera: Camera) -> None:
        points = camera.to_pixels(shape.points)
        if len(points) == 0:
            return
        width, ring = shape.width * self.ui, np.vstack([points, points[:1]])
        fill, stroke = self._ink(shape.fill), self._ink(shape.stroke)
        if fill:
            self._fill(surface, points, fill)
        if stroke:
            brushes.stroke(surface, stroke, [ring], width)

    def _fill(self, surface: pygame.Surface, points: Float, color: Rgba) -> None:
        visible = clip_polygon(points, brushes.in_sight(surface))
        if len(visible) < 3:
            return
        box = brushes.extent_of(visible, 1.0)
        large = color[3] < FAINT_OPACITY and box.width * box.height > LARGE_AREA
        factor = 1 if large else 0
        brushes.cover(surface, color, box, lambda on: on.polygon(color, visible), factor)

    # -- lines --------------------------------------------------------------------------------

    def _line(self, surface: pygame.Surface, shape: Line, camera: Camera) -> None:
        if shape.style == "-" and len(shape.points) == 2:
            self._segment(surface, shape, camera)
            return
        marker, line = split_wake_style(shape.style)
        points = camera.to_pixels(shape.points)
        ink = self._shade(shape.stroke)
        color = rgba(ink)
        width = shape.width * self.ui
        if line in DASHES:  # dashed before clipping: else the dashes would crawl when panning
            pattern = tuple(self.ui * length for length in DASHES[line])
            brushes.stroke(surface, color, dashes(points, pattern), width)
        elif line:
            brushes.stroke(surface, color, [points], width)
        if marker:
            kept = spaced(points, MARK_SPACING * self.ui)
            self.marks(surface, points[kept], marker, ink, shape.width)

    def _segment(self, surface: pygame.Surface, shape: Line, camera: Camera) -> None:
        """Draw one straight line, from a sprite if it is short."""
        (ax, ay), (bx, by) = shape.points.tolist()
        x, y = camera.x + camera.scale * ax, camera.y - camera.scale * ay
        dx, dy = camera.scale * (bx - ax), camera.scale * (ay - by)
        # A short line stays a line: a small robot's heading must not become a blob.
        width = shape.width * self.ui
        if width > 1.0:
            width = min(width, max(1.0, (abs(dx) + abs(dy)) / 3.5))
        width = round(8 * width) / 8
        color = rgba(self._shade(shape.stroke))
        if width <= 1.0 and color[3] == 255 and max(map(abs, (x, y, dx, dy))) < MAX_UNCUT:
            pygame.draw.aaline(surface, color, (x - 0.5, y - 0.5), (x + dx - 0.5, y + dy - 0.5))
            return
        if max(abs(dx), abs(dy)) > MAX_SPRITE_SIDE / 2:
            brushes.stroke(surface, color, [np.array([(x, y), (x + dx, y + dy)])], width)
            return
        dx, dy = round(dx * PHASES) / PHASES, round(dy * PHASES) / PHASES

        def made(fx: float, fy: float) -> tuple[pygame.Rect, list[Layer]]:
            points = np.array([(fx, fy), (fx + dx, fy + dy)])
            box = brushes.extent_of(points, width / 2 + 1)
            return box, [(color, lambda on: on.lines(color, [points], width), 0)]

        self._stamp(surface, x, y, (color, width, dx, dy), made)

    def _arrow(self, surface: pygame.Surface, shape: Arrow, camera: Camera) -> None:
        """Draw an arrow, from a sprite unless it is long."""
        (ax, ay), (bx, by) = shape.tail, shape.tip
        x, y = camera.x + camera.scale * ax, camera.y - camera.scale * ay
        dx, dy = camera.scale * (bx - ax), camera.scale * (ay - by)
        width = shape.width * self.ui
        edge = ARROW_EDGE * width if shape.stroke else 0.0
        left, top = min(x, x + dx), min(y, y + dy)
        around = pygame.Rect(left - 20, top - 20, abs(dx) + 40, abs(dy) + 40)
        if not around.colliderect(surface.get_clip()):
            return
        fill, ink = (rgba(self._shade(color)) for color in (shape.fill, shape.stroke or shape.fill))

        def made(fx: float, fy: float) -> tuple[pygame.Rect, list[Layer]]:
            points = arrow_outline((fx, fy), (fx + dx, fy + dy), width)
            rim = [np.vstack([points, points[:1]])] if edge else []
            box = brushes.extent_of(points, edge + 1)

            def draw(on: Enlarged) -> None:
                on.lines(ink, rim, 2 * edge)
                on.polygon(fill, points)

            return box, [(ink, draw, 4)]

        if max(abs(dx), abs(dy)) > MAX_SPRITE_SIDE:
            box, ((_, draw, _),) = made(x, y)
            brushes.cover(surface, ink, box, draw)
            return
        dx, dy = round(dx * PHASES) / PHASES, round(dy * PHASES) / PHASES
        self._stamp(surface, x, y, ("arrow", fill, ink, edge, width, dx, dy), made)

    def marks(
        self, surface: pygame.Surface, points: Float, marker: str, color: str, width: float
    ) -> None:
        """Draw the marks ``. o x + * s`` at pixels (k, 2), in a colour that is not converted."""
        width *= self.ui
        quarters = np.rint(points.T * PHASES).astype(int)
        x, y = quarters % PHASES
        phases = PHASES * x + y
        listed = phases.tolist()
        stamps = {k: self._mark(marker, color, width, k) for k in set(listed)}
        corners = np.zeros((2, PHASES * PHASES), dtype=int)
        for k, stamp in stamps.items():
            corners[:, k] = stamp[1:]
        # Without a Python loop over the marks: there may be thousands.
        images = {k: stamp[0] for k, stamp in stamps.items()}
        places = (quarters // PHASES + corners[:, phases]).tolist()
        surface.fblits(zip(map(images.__getitem__, listed), zip(*places, strict=True), strict=True))

    def _mark(self, marker: str, color: str, width: float, phase: int) -> Sprite:
        """Return a mark's sprite; phase: of the quarters of a pixel across and down."""
        key = (marker, color, width, phase)
        sprite = self._sprites.get(key)
        if sprite is None:
            x, y = (quarter / PHASES for quarter in divmod(phase, PHASES))
            draw, reach = brushes.mark(marker, rgba(color), x, y, self.ui, width)
            sprite = self._keep(key, brushes.box_round(x, y, reach), [(rgba(color), draw, 0)])
        return sprite

    # -- text ---------------------------------------------------------------------------------

    def _text(self, shape: Text, camera: Camera) -> list[tuple[pygame.Surface, tuple[int, int]]]:
        """Return the images of a text's lines, and their places."""
        x = camera.x + camera.scale * shape.position[0]
        y = camera.y - camera.scale * shape.position[1]
        gap = 4 * self.ui
        reach = max(1, round(1.5 * self.ui)) if shape.halo else 0
        images = [self._label(text, shape, reach) for text in shape.text.split("\n")]
        height = sum([image.get_height() - 2 * reach for image in images])
        top = {"above": y - gap - height, "below": y + gap}.get(shape.anchor, y - height / 2)
        found = []
        for image in images:
            width = image.get_width() - 2 * reach
            # MARS's and matplotlib's sense: "left" puts the text's left end at the point
            left = {"left": x + gap, "right": x - gap - width}.get(shape.anchor, x - width / 2)
            found.append((image, (round(left) - reach, round(top) - reach)))
            top += image.get_height() - 2 * reach
        return found

    def _label(self, text: str, shape: Text, reach: int) -> pygame.Surface:
        """Return a line of a text, with a halo of `reach` pixels."""
        size, color = shape.size * self.ui, self._shade(shape.color)
        if not shape.halo:
            return self.fonts.render(text, size, color)
        halo = self._shade(shape.halo)
        key = text, size, color, halo
        sprite = self._sprites.get(key)
        if sprite is None:
            letters = self.fonts.render(text, size, color)
            box = letters.get_rect().inflate(2 * reach, 2 * reach)
            label = pygame.Surface(box.size, pygame.SRCALPHA)
            label.fill((*rgba(halo)[:3], 0))
            rim, steps = self.fonts.render(text, size, halo), (0, reach, 2 * reach)
            label.fblits((rim, (dx, dy)) for dx in steps for dy in steps)
            label.blit(letters, (reach, reach))
            sprite = self._store(key, (label, 0, 0))
        return sprite[0]

    # -- images -------------------------------------------------------------------------------

    def _image(self, surface: pygame.Surface, shape: Image, camera: Camera) -> None:
        """Draw the visible part of an image: large pixels sharp, small ones averaged."""
        xmin, xmax, ymin, ymax = shape.bounds
        rows, columns, _ = shape.pixels.shape
        sight = surface.get_clip()
        left, wide = camera.x + camera.scale * xmin, camera.scale * (xmax - xmin) / columns
        top, high = camera.y - camera.scale * ymax, camera.scale * (ymax - ymin) / rows
        first, last = _cells(left, wide, columns, sight.left, sight.right)
        upper, lower = _cells(top, high, rows, sight.top, sight.bottom)
        if first >= last or upper >= lower:
            return
        seen = shape.pixels[upper:lower, first:last].swapaxes(0, 1)
        place = round(left + wide * first), round(top + high * upper)
        size = round(left + wide * last) - place[0], round(top + high * lower) - place[1]
        scaled = pygame.transform.scale if min(wide, high) >= 1 else pygame.transform.smoothscale
        surface.blit(scaled(_surface_of(self.theme.shade_pixels(seen)), size), place)

    # -- words and plates of the window -------------------------------------------------------

    def write(
        self, surface: pygame.Surface, text: str, size: float, color: str, *, bold: bool = False,
        mono: bool = False, **place: tuple[float, float],
    ) -> pygame.Rect:  # fmt: skip
        """Write a line of text; return where. place: a point of its box, as of `get_rect`."""
        image = self.fonts.render(text, size, color, bold, mono)
        box = image.get_rect(**{name: (round(x), round(y)) for name, (x, y) in place.items()})
        surface.blit(image, box)
        return box

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
            within, outer, inner = box.inflate(-2, -2), rgba(stroke or fill), rgba(fill)
            layers: list[Layer] = [(outer, lambda on: on.box(outer, box, radius), 0)]
            if stroke:
                layers.append((inner, lambda on: on.box(inner, within, radius - 1), 0))
            sprite = self._keep(key, box, layers)
        surface.blit(sprite[0], rect.topleft)

    def _ink(self, color: str | None) -> Rgba | None:
        """Return a shape's colour in the theme, or None for none."""
        return rgba(self._shade(color)) if color else None

    def _keep(self, key: Hashable, box: pygame.Rect, layers: Sequence[Layer]) -> Sprite:
        """Draw a sprite from its layers, the first lowest, and keep it."""
        finer = 8 if box.width * box.height < 1600 else 4
        images = [
            brushes.layer(color, box, draw, factor or finer) for color, draw, factor in layers
        ]
        image = images[0]
        for above in images[1:]:
            image.blit(above, (0, 0))
        return self._store(key, (image, box.left, box.top))

    def _store(self, key: Hashable, sprite: Sprite) -> Sprite:
        """Keep a sprite; all others go where they would be too many pixels."""
        area = sprite[0].get_width() * sprite[0].get_height()
        if self._kept + area > self._most:
            self._sprites.clear()
            self._kept = 0
        if area <= self._most:
            self._sprites[key] = sprite
            self._kept += area
        return sprite


def _surface_of(pixels: NDArray[np.uint8]) -> pygame.Surface:
    """Return a surface of pixels (columns, rows, 3 or 4)."""
    opaque = pixels.shape[2] == 3
    surface = pygame.Surface(pixels.shape[:2], 0 if opaque else pygame.SRCALPHA, 32)
    pygame.surfarray.pixels3d(surface)[:] = pixels[..., :3]
    if not opaque:
        pygame.surfarray.pixels_alpha(surface)[:] = pixels[..., 3]
    return surface


def _cells(start: float, size: float, count: int, low: int, high: int) -> tuple[int, int]:
    """Return the first of an image's pixels that are in sight along one axis, and their end.

    start, size: of the image's first pixel on the screen, in screen pixels. count: of the image's
    pixels. low, high: the screen pixels in sight.
    """
    return max(floor((low - start) / size), 0), min(ceil((high - start) / size), count)


def _phase(value: float) -> tuple[int, float]:
    """Split a pixel coordinate into a whole number and a number of quarters."""
    quarters = round(value * PHASES)
    return quarters // PHASES, (quarters % PHASES) / PHASES


def _disc_layers(
    fill: Rgba | None, stroke: Rgba | None, radius: float, width: float, x: float, y: float
) -> list[Layer]:
    layers: list[Layer] = []
    if fill:
        layers.append((fill, lambda on: on.disc(fill, x, y, radius), 0))
    if stroke:
        layers.append((stroke, lambda on: on.disc(stroke, x, y, radius + width / 2, width), 0))
    return layers
