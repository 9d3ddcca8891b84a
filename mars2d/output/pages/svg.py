"""Scenes as SVG, for browsers, notebooks and documents, written without a library."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterable, Iterator
from html import escape
from io import BytesIO
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.maps.regions import simple_line
from mars2d.core.scene import (
    Arrow,
    Circle,
    Image,
    Line,
    Polygon,
    Scene,
    Text,
    split_wake_style,
)
from mars2d.output.figures.extent import View
from mars2d.output.lines import DASHES, MARK_SPACING, SHIFTS, TEXT_GAP, arrow_outline, spaced

Float = NDArray[np.float64]

ScaledScene = tuple[Scene, float]
"""A scene, and the factor for its line widths, marks and text heights."""

TOLERANCE = 0.3
"""The error allowed when a line is simplified, pixels."""

MAX_PIXEL = 1e6  # pixels: points farther out are moved to here

LINE_HEIGHT = 1.25  # of text, in its size
TEXT_RISE = 0.36  # from the middle of a line of text down to its base line, in its size
HALO_WIDTH = 2.5  # the width of the rim round letters, points
ARROW_EDGE = 0.8  # the width of the edge round an arrow, in widths of its shaft

# Characters that XML can't hold, such as the bell or half of a pair of surrogates.
UNREADABLE = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def svg(layers: Iterable[ScaledScene], view: View, size: tuple[float, float], title: str) -> str:
    """Return an SVG picture of scenes on white ground, the first one lowest.

    view: the part of the plane that is shown. size: (width, height) in pixels, in the proportions
    of the view; the picture shrinks with its page. title: a description for people who can't see
    it. A point of widths and texts is a pixel. The same scenes give the same text; there are no ids
    in it, so that pictures on one page do not affect each other. Lines lie within 0.3 pixels of
    their points; points that are not numbers are left out.

    >>> scene = Scene()
    >>> scene.circle((0, 0), 1.0, fill="#0072b2")
    >>> text = svg([(scene, 1.0)], View(-2, 2, -1, 1), (80, 40), "a disc")
    >>> text.splitlines()[1]
    '<circle cx="40" cy="20" r="20" fill="#0072b2"/>'
    """
    pen = _Pen(view, size[0] / view.width)
    shapes = [line for scene, scale in layers for line in pen.draw(scene, scale)]
    width, height, named = _number(size[0]), _number(size[1]), text_of(title)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'viewBox="0 0 {width} {height}" style="max-width:100%;height:auto" '
        f'font-family="Helvetica,Arial,sans-serif" role="img" aria-label="{named}">'
        f"<title>{named}</title>"
        f'<rect width="{width}" height="{height}" fill="#ffffff"/>'
    )
    return "\n".join([head, *shapes, "</svg>"])


def text_of(words: str) -> str:
    """Return text escaped for XML and HTML, in an element or between double quotes."""
    return escape(UNREADABLE.sub("\N{REPLACEMENT CHARACTER}", words))


class _Pen:
    """Draws shapes as lines of SVG."""

    def __init__(self, view: View, ppm: float) -> None:
        """Take the view and the pixels of a metre."""
        self.ppm = ppm
        self._corner = np.array([view.xmin, view.ymax])

    def draw(self, scene: Scene, scale: float) -> Iterator[str]:
        """Yield the elements of a scene's shapes; those without a place are left out."""
        for shape in scene.shapes:
            if isinstance(shape, Line):
                yield from self._line(shape, scale)
            elif isinstance(shape, Image):
                yield self._image(shape)
            elif isinstance(shape, Polygon):
                yield from self._polygon(shape, scale)
            elif isinstance(shape, Circle):
                yield from self._circle(shape, scale)
            elif isinstance(shape, Arrow):
                yield from self._arrow(shape, scale)
            else:
                yield from self._text(shape, scale)

    def _pixels(self, points: Float) -> Float:
        """Return the pixels (k, 2) of points (k, 2), metres; y points down."""
        pixels = (points - self._corner) * (self.ppm, -self.ppm)
        return np.asarray(np.clip(pixels, -MAX_PIXEL, MAX_PIXEL))

    def _place(self, point: tuple[float, float]) -> tuple[float, float] | None:
        """Return the pixel of a point, or None if it is nowhere."""
        x, y = self._pixels(np.array([point]))[0].tolist()
        return (x, y) if np.isfinite((x, y)).all() else None

    def _circle(self, shape: Circle, scale: float) -> Iterator[str]:
        place = self._place(shape.center)
        radius = self.ppm * shape.radius + shape.pixels * scale
        if place and 0 < radius <= MAX_PIXEL and (shape.fill or shape.stroke):
            ink = _ink(shape.fill, shape.stroke, shape.width * scale)
            x, y = map(_number, place)
            yield f'<circle cx="{x}" cy="{y}" r="{_number(radius)}"{ink}/>'

    def _polygon(self, shape: Polygon, scale: float) -> Iterator[str]:
        points = self._pixels(shape.points)
        if len(points) and np.isfinite(points).all() and (shape.fill or shape.stroke):
            ink = _ink(shape.fill, shape.stroke, shape.width * scale)
            yield f'<path d="{_path(points)}Z"{ink} stroke-linejoin="round"/>'

    def _line(self, shape: Line, scale: float) -> Iterator[str]:
        mark, style = split_wake_style(shape.style)
        pieces = list(_pieces(self._pixels(shape.points)))
        width = shape.width * scale
        if len(shape.points) == 2 and pieces:
            # A short line stays a line: a small robot's heading must not become a blob.
            width = min(width, max(1.0, float(np.abs(np.ptp(pieces[0], axis=0)).sum()) / 3.5))
        if style and max(map(len, pieces), default=0) > 1:
            cap = ' stroke-linecap="round"' if style == "-" and len(shape.points) > 2 else ""
            if style in DASHES:
                lengths = " ".join(_number(length * scale) for length in DASHES[style])
                cap = f' stroke-dasharray="{lengths}"'
            path = "".join(_path(_simple(piece)) for piece in pieces if len(piece) > 1)
            ink = _ink(None, shape.stroke, width)
            yield f'<path d="{path}"{ink}{cap} stroke-linejoin="round"/>'
        if mark and pieces:
            spots = np.concatenate([each[spaced(each, MARK_SPACING * scale)] for each in pieces])
            yield _marks(spots, mark, shape.stroke, width, scale)

    def _arrow(self, shape: Arrow, scale: float) -> Iterator[str]:
        tail, tip = self._place(shape.tail), self._place(shape.tip)
        if tail and tip and tail != tip:
            width = shape.width * scale
            ink = _ink(shape.fill, shape.stroke, ARROW_EDGE * width)
            path = _path(arrow_outline(tail, tip, width))
            yield f'<path d="{path}Z"{ink} stroke-linejoin="round" paint-order="stroke"/>'

    def _text(self, shape: Text, scale: float) -> Iterator[str]:
        place = self._place(shape.position)
        if place is None:
            return
        size = shape.size * scale
        dx, dy = SHIFTS.get(shape.anchor, (0, 0))
        lines = shape.text.split("\n")
        # The base line of the first one.
        middle = place[1] + TEXT_RISE * size - dy * TEXT_GAP * scale
        middle -= (1 + dy) / 2 * (len(lines) - 1) * LINE_HEIGHT * size + dy * size / 2
        anchor = {0: "middle", -1: "end"}.get(dx)
        ink = _ink(shape.color, shape.halo, HALO_WIDTH * scale)
        if shape.halo:
            ink += ' stroke-linejoin="round" paint-order="stroke"'
        if anchor:
            ink += f' text-anchor="{anchor}"'
        x = _number(place[0] + dx * TEXT_GAP * scale)
        for k, words in enumerate(lines):
            if not words.strip():
                continue
            y = _number(middle + k * LINE_HEIGHT * size)
            yield f'<text x="{x}" y="{y}" font-size="{_number(size)}"{ink}>{text_of(words)}</text>'

    def _image(self, shape: Image) -> str:
        xmin, xmax, ymin, ymax = shape.bounds
        corners = self._pixels(np.array([(xmin, ymax), (xmax, ymin)]))
        (left, top), (right, bottom) = corners.tolist()
        # Whether single pixels can be seen.
        sharp = right - left > 1.5 * shape.pixels.shape[1]
        data = _png(shape.pixels, 2 * (right - left), 2 * (bottom - top))
        return (
            f'<image x="{_number(left)}" y="{_number(top)}" width="{_number(right - left)}" '
            f'height="{_number(bottom - top)}" preserveAspectRatio="none" '
            f'image-rendering="{"pixelated" if sharp else "auto"}" '
            f'href="data:image/png;base64,{data}"/>'
        )


def _ink(fill: str | None, stroke: str | None, width: float) -> str:
    """Return the attributes of fill and stroke, in colours with or without opacity."""
    found = _paint("fill", fill)
    if stroke and width > 0:
        found += f'{_paint("stroke", stroke)} stroke-width="{_number(width)}"'
    return found


def _paint(name: str, color: str | None) -> str:
    if color is None:
        return f' {name}="none"'
    opacity = f' {name}-opacity="{int(color[7:], 16) / 255:.2g}"' if len(color) > 7 else ""
    return f' {name}="{color[:7]}"{opacity}'


def _number(value: float) -> str:
    """Return a number of pixels, to a hundredth, as short as it can be written."""
    return _hundredths(round(100 * value))


def _hundredths(count: int) -> str:
    text = repr(count / 100).removesuffix(".0")
    return text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text


def _path(points: Float) -> str:
    """Return the path through pixels (k, 2), written as steps from one to the next."""
    whole = np.rint(100 * points).astype(np.int64)
    steps = np.diff(whole, axis=0)
    numbers = steps[steps.any(axis=1)].ravel().tolist() or [0, 0]
    start = ",".join(map(_hundredths, whole[0].tolist()))
    return f"M{start}l{' '.join(map(_hundredths, numbers))}".replace(" -", "-")


def _pieces(points: Float) -> Iterator[Float]:
    """Yield the stretches of a polyline (k, 2) without nan or inf."""
    known = np.isfinite(points[:, 0]) & np.isfinite(points[:, 1])
    bounds = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]])))
    for start, end in pairwise(bounds.tolist()):
        if known[start]:
            yield points[start:end]


def _simple(points: Float) -> Float:
    """Return a polyline (k, 2) with fewer corners, no more than TOLERANCE off."""
    if len(points) > 2:
        # Thousands of rows of a robot that stands still are one corner.
        cells = np.rint(points * (4 / TOLERANCE))
        kept = np.concatenate([[True], (np.diff(cells, axis=0) != 0).any(axis=1)])
        kept[-1] = True
        points = points[kept]
    return simple_line(points, TOLERANCE / 2)


def _marks(points: Float, mark: str, color: str, width: float, scale: float) -> str:
    """Return marks ``. o x + * s`` at pixels (k, 2), all in one path."""
    r, cap = 3.2 * scale, ""
    if mark == ".":  # the round ends of lines without length
        width, cap = 4.4 * scale, ' stroke-linecap="round"'
        strokes = "h0"
    elif mark == "o":
        half = f"a{r:.2f} {r:.2f} 0 1 0"
        strokes = f"m{-r:.2f} 0{half} {2 * r:.2f} 0{half} {-2 * r:.2f} 0"
    elif mark == "s":
        strokes = f"m{-r:.2f} {-r:.2f}h{2 * r:.2f}v{2 * r:.2f}h{-2 * r:.2f}z"
    else:
        turns = {"x": (1, 3), "+": (0, 2), "*": (0, 4 / 3, 8 / 3)}[mark]
        strokes = ""
        for turn in turns:
            x, y = r * np.cos(turn * np.pi / 4), r * np.sin(turn * np.pi / 4)
            strokes += f"m{-x:.2f} {-y:.2f}l{2 * x:.2f} {2 * y:.2f}m{-x:.2f} {-y:.2f}"
    spots = np.rint(100 * points).astype(np.int64).tolist()
    path = "".join(f"M{_hundredths(x)} {_hundredths(y)}{strokes}" for x, y in spots)
    return f'<path d="{path}"{_ink(None, color, width)}{cap}/>'


def _png(pixels: NDArray[np.uint8], width: float, height: float) -> str:
    """Return an image as PNG in base64, averaged to at most a size in pixels."""
    from PIL import Image as Picture

    rows, columns, _ = pixels.shape
    size = min(columns, max(1, round(width))), min(rows, max(1, round(height)))
    picture = Picture.fromarray(pixels)
    if size != (columns, rows):
        picture = picture.resize(size, Picture.Resampling.BOX)
    file = BytesIO()
    picture.save(file, "PNG")
    return base64.b64encode(file.getvalue()).decode()
