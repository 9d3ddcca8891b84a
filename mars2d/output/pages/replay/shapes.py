"""Scenes as styles, which recur, and numbers, which change."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Arrow, Circle, Image, Line, Polygon, Shape, Text

__all__ = ["Flat", "Style", "flat", "moved", "plain_shapes"]

Float = NDArray[np.float64]

Style = tuple[Any, ...]
"""The kind of a shape, and all of it that is no length: colours, widths, words."""

MOST_PIXELS = 512
"""Images are thinned to so many rows and columns."""


class Flat(NamedTuple):
    """A scene: the styles of its shapes, how many numbers each has, and all numbers, metres.

    images: those that styles refer to, by what is in them.
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
    """Return pixels with opacity, (rows, columns, 4), few enough."""
    stride = -(-max(pixels.shape[:2]) // MOST_PIXELS)
    pixels = pixels[::stride, ::stride]
    if pixels.shape[2] == 3:
        opaque = np.full((*pixels.shape[:2], 1), 255, dtype=np.uint8)
        pixels = np.concatenate([pixels, opaque], axis=2)
    return np.ascontiguousarray(pixels)


def moved(scene: Flat, pose: Float) -> Float:
    """Return the numbers of a scene that is put at a pose (3,)."""
    c, s = np.cos(pose[2]), np.sin(pose[2])
    result, start = scene.numbers.copy(), 0
    for style, count in zip(scene.styles, scene.counts, strict=True):
        end = start + (2 if style[0] == "circle" else count)
        x, y = scene.numbers[start:end].reshape(-1, 2).T
        result[start:end] = np.column_stack([
            pose[0] + c * x - s * y, pose[1] + s * x + c * y
        ]).ravel()  # fmt: skip
        start += count
    return result


def plain_shapes(scene: Flat, step: float) -> list[list[Any]]:
    """Return the shapes as pairs of style and numbers [metres], rounded to a step."""
    digits = max(0, int(np.ceil(-np.log10(step))))
    parts = np.split(scene.numbers, np.cumsum(scene.counts, dtype=np.intp))[:-1]
    pairs = zip(scene.styles, parts, strict=True)
    return [[list(style), np.round(part, digits).tolist()] for style, part in pairs]
