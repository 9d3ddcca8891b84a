"""Scenes over time as columns: a table of styles, and the numbers that change."""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Arrow, Circle, Image, Line, Polygon, Scene, Shape, Text
from mars2d.output.pages.replay.columns import Columns, Int, rounded

Float = NDArray[np.float64]

Style = tuple[Any, ...]
"""The kind of a shape and its properties that are no lengths: colours, widths, texts."""

MAX_PIXELS = 512
"""The most rows and columns of an image; larger ones are thinned."""


class Flat(NamedTuple):
    """A scene: the styles of its shapes, the count of numbers of each, and all numbers, metres.

    images: those in the styles, by a hash of their pixels.
    """

    styles: tuple[Style, ...]
    counts: tuple[int, ...]
    numbers: Float
    images: dict[int, NDArray[np.uint8]]


def flat(shapes: Iterable[Shape]) -> Flat:
    """Return shapes as styles and numbers."""
    styles: list[Style] = []
    numbers: list[Float] = []
    images: dict[int, NDArray[np.uint8]] = {}
    for shape in shapes:
        style, values = _split(shape)
        if isinstance(shape, Image):
            pixels = _thinned(shape.pixels)
            key = hash((pixels.tobytes(), pixels.shape))
            images[key] = pixels
            style = ("image", key)
        styles.append(style)
        numbers.append(values)
    joined = np.concatenate(numbers) if numbers else np.empty(0)
    return Flat(tuple(styles), tuple(map(len, numbers)), joined, images)


def shapes_of(scene: Scene) -> list[list[Any]]:
    """Return the shapes of a scene that stands still, each as its style and its numbers."""
    pairs = [_split(shape) for shape in scene.shapes]
    return [[list(style), np.round(numbers, 3).tolist()] for style, numbers in pairs]


def _split(shape: Shape) -> tuple[Style, Float]:
    if isinstance(shape, Circle):
        style: Style = ("circle", shape.fill, shape.stroke, shape.width, shape.pixels)
        return style, np.array([*shape.center, shape.radius])
    if isinstance(shape, Polygon):
        return ("polygon", shape.fill, shape.stroke, shape.width), shape.points.ravel()
    if isinstance(shape, Line):
        return ("line", shape.stroke, shape.width, shape.style), shape.points.ravel()
    if isinstance(shape, Text):
        style = ("text", shape.text, shape.color, shape.size, shape.anchor, shape.halo)
        return style, np.array(shape.position)
    if isinstance(shape, Arrow):
        style = ("arrow", shape.fill, shape.stroke, shape.width)
        return style, np.array([*shape.tail, *shape.tip])
    return ("image",), np.array(shape.bounds)


def _thinned(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return pixels with opacity, (rows, columns, 4), thinned to at most `MAX_PIXELS` a side."""
    stride = -(-max(pixels.shape[:2]) // MAX_PIXELS)
    pixels = pixels[::stride, ::stride]
    if pixels.shape[2] == 3:
        opaque = np.full((*pixels.shape[:2], 1), 255, dtype=np.uint8)
        pixels = np.concatenate([pixels, opaque], axis=2)
    return np.ascontiguousarray(pixels)


@dataclass(frozen=True)
class Drawing:
    """Scenes over time: `scenes[k]` is seen from row `rows[k]` on.

    body: the index of the body in whose frame they are; None: in the world. upright: whether they
    move with the body but do not turn.
    """

    rows: Sequence[int]
    scenes: Sequence[Flat]
    body: int | None = None
    upright: bool = False


@dataclass
class Book:
    """The styles and orders of shapes that several scenes share."""

    styles: dict[Style, int] = field(default_factory=dict)
    orders: dict[tuple[int, ...], int] = field(default_factory=dict)
    images: dict[int, str] = field(default_factory=dict)

    def order_of(self, scene: Flat, columns: Columns, name: str) -> int:
        """Return the number of a scene's order of shapes; its images become columns."""
        for key, pixels in scene.images.items():
            if key not in self.images:
                self.images[key] = f"{name}:image{len(self.images)}"
                columns.add(self.images[key], pixels, order=1)
        listed: list[int] = []
        for style, count in zip(scene.styles, scene.counts, strict=True):
            own = ("image", self.images[style[1]]) if style[0] == "image" else style
            listed += [self.styles.setdefault(own, len(self.styles)), count]
        return self.orders.setdefault(tuple(listed), len(self.orders))


def pack(name: str, drawings: Sequence[Drawing], step: float) -> tuple[Columns, dict[str, Any]]:
    """Return drawings as columns, and their header; step: metres.

    A shape is written as the difference from the last one at its place with as many numbers.
    """
    columns, book = Columns(), Book()
    rows: list[int] = []
    orders: list[int] = []
    numbers: list[Int] = []
    heads: list[dict[str, Any]] = []
    for drawing in drawings:
        before: tuple[int, bytes] | None = None
        last: dict[tuple[int, int], Int] = {}
        first = len(rows)
        for row, scene in zip(drawing.rows, drawing.scenes, strict=True):
            values = rounded(scene.numbers, step)
            now = book.order_of(scene, columns, name), values.tobytes()
            if now == before:
                continue
            before = now
            start = 0
            for k, count in enumerate(scene.counts):
                part = values[start : start + count]
                numbers.append(part - last.get((k, count), 0))
                last[k, count] = part
                start += count
            rows.append(row)
            orders.append(now[0])
        head = {"scenes": len(rows) - first, "body": drawing.body, "upright": drawing.upright}
        heads.append(head)
    columns.add(f"{name}:rows", np.array(rows, dtype=int), order=1)
    columns.add(f"{name}:orders", np.array(orders, dtype=int))
    joined = np.concatenate(numbers) if numbers else np.empty(0, dtype=int)
    columns.add(f"{name}:numbers", joined)
    header = {
        "name": name,
        "step": step,
        "drawings": heads,
        "styles": [list(style) for style in book.styles],
        "orders": [list(order) for order in book.orders],
    }
    columns.beside = len(zlib.compress(json.dumps(header).encode()))
    return columns, header
