"""What to draw, not how: shapes in world coordinates, from the lowest to the topmost.

The window, films, figures and pages all paint the same `Scene`. Positions and sizes are in metres,
line widths and text heights in points of the screen or page. Colours are ``#rrggbb`` or, with
opacity, ``#rrggbbaa``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.arithmetic import cosines_sines
from mars2d.core.description import accepts
from mars2d.core.errors import InputError, nearest, shown
from mars2d.core.plane import Outline

Anchor = Literal["center", "left", "right", "above", "below"]

LARGEST_IMAGE = 4096
"""The largest number of rows and of columns of an image."""

# Okabe & Ito's colours, distinguishable with every common colour vision deficiency (2008).
PALETTE = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#5f4b8b", "#444444")

INK = "#3d4852"
"""The colour of outlines."""

THEORY = "#7b3294"
"""The colour of theoretical predictions."""

NAMED = {
    "black": "#000000", "white": "#ffffff", "gray": "#808080", "grey": "#808080",
    "red": "#d62728", "green": "#2ca02c", "blue": "#1f77b4", "orange": "#ff7f0e",
    "purple": "#9467bd", "brown": "#8c564b", "pink": "#e377c2", "cyan": "#17becf",
    "magenta": "#c2187f", "yellow": "#e8c500",
    # Matlab's one-letter colours, as MARS's Base_colors uses them
    "k": "#000000", "r": "#d62728", "g": "#2ca02c", "b": "#1f77b4", "m": "#c2187f",
    "c": "#17becf", "y": "#e8c500", "w": "#ffffff",
}  # fmt: skip
"""Colours by their words."""

WAKE_LINES = ("--", "-.", "-", ":")
WAKE_MARKERS = (".", "o", "x", "+", "*", "s")
WAKE_STYLES = [*WAKE_LINES, *(mark + line for mark in WAKE_MARKERS for line in ("", *WAKE_LINES))]


_WORDS = "|".join("".join(f"[{c}{c.upper()}]" for c in word) for word in NAMED)
_HEX = "#([0-9A-Fa-f]{3}|[0-9A-Fa-f]{6}|[0-9A-Fa-f]{8})"
_COLOR = {"type": "string", "pattern": rf"^\s*({_HEX}|{_WORDS})\s*$"}


@accepts(_COLOR)
def color(name: str, value: object) -> str:
    """Return a colour as ``#rrggbb`` or ``#rrggbbaa``; field `name` is for the error message."""
    if isinstance(value, str):
        lower = value.strip().lower()
        if lower in NAMED:
            return NAMED[lower]
        if re.fullmatch(_HEX, lower):
            return lower if len(lower) > 4 else "#" + "".join(2 * c for c in lower[1:])
    hint = nearest(value, [k for k in NAMED if len(k) > 1]) if isinstance(value, str) else ""
    raise InputError(f"{name} = {value!r}: expected a colour, '#rrggbb' or a name{hint}")


@lru_cache(maxsize=1024)
def _checked(name: str, value: str) -> str:
    return color(name, value)


def _look(style: dict[str, Any]) -> dict[str, Any]:
    """Return how a shape looks, its colours and its line style checked; None paints nothing."""
    for name in style.keys() & {"fill", "stroke", "color", "halo"}:
        if style[name] is not None:
            style[name] = _checked(name, style[name])
    if "style" in style:
        wake_style("style", style["style"])
    return style


def _point(point: ArrayLike) -> tuple[float, float]:
    x, y = np.asarray(point, dtype=float)[:2].tolist()
    return x, y


def faded(value: str, opacity: float) -> str:
    """Return the colour ``#rrggbb`` at an opacity from 0 to 1."""
    return f"{value[:7]}{round(255 * opacity):02x}"


@lru_cache(maxsize=1024)
def rgb(color: str) -> tuple[float, float, float]:
    """Return red, green and blue, from 0 to 1, of a colour ``#rrggbb``.

    >>> rgb("#ff0033")
    (1.0, 0.0, 0.2)
    """
    red, green, blue = (int(color[k : k + 2], 16) / 255 for k in (1, 3, 5))
    return red, green, blue


def color_of(values: Iterable[float]) -> str:
    """Return the colour ``#rrggbb`` of red, green and blue, clipped to 0 to 1.

    >>> color_of((1.0, -0.5, 0.2))
    '#ff0033'
    """
    return "#" + "".join(f"{round(255 * min(max(value, 0.0), 1.0)):02x}" for value in values)


@accepts({"enum": WAKE_STYLES})
def wake_style(name: str, value: object) -> str:
    """Check a wake style: a line style of Matlab's plot, a marker, or both, such as ``o--``."""
    if isinstance(value, str) and value in WAKE_STYLES:
        return value
    raise InputError(
        f"{name} = {value!r}: expected a line style ({' '.join(WAKE_LINES)}), "
        f"a marker ({' '.join(WAKE_MARKERS)}), or a marker and a line style, such as 'o--'"
    )


def split_wake_style(style: str) -> tuple[str, str]:
    """Return (marker, line) of a checked wake style; either may be empty."""
    if style in WAKE_LINES:
        return "", style
    return style[0], style[1:]


@dataclass(frozen=True, slots=True)
class Circle:
    """A disc or ring: centre (x, y) and radius in metres; `pixels` is added to the radius."""

    center: tuple[float, float]
    radius: float
    fill: str | None = None
    stroke: str | None = None
    width: float = 1.0
    pixels: float = 0.0


@dataclass(frozen=True, slots=True)
class Polygon:
    """A closed outline, not necessarily convex: vertices (k, 2) in metres."""

    points: NDArray[np.float64]
    fill: str | None = None
    stroke: str | None = None
    width: float = 1.0


@dataclass(frozen=True, slots=True)
class Line:
    """A polyline through points (k, 2) in metres. `style`: a wake style, such as ``o--``."""

    points: NDArray[np.float64]
    stroke: str
    width: float = 1.0
    style: str = "-"


@dataclass(frozen=True, slots=True)
class Text:
    """A label at a point (x, y) in metres; `size` is its height in points.

    halo: the colour of a rim round the letters, which sets them off from the background.
    """

    position: tuple[float, float]
    text: str
    color: str = "#333333"
    size: float = 12.0
    anchor: Anchor = "center"
    halo: str | None = None


@dataclass(frozen=True, slots=True)
class Arrow:
    """An arrow from `tail` to `tip`, (x, y) in metres; `width` is that of its shaft, in points.

    A short arrow is drawn smaller as a whole. stroke: the colour of a thin edge round it, which
    sets it off from the background.
    """

    tail: tuple[float, float]
    tip: tuple[float, float]
    fill: str
    stroke: str | None = None
    width: float = 3.0


@dataclass(frozen=True, slots=True)
class Image:
    """Pixels (rows, columns, 3), red, green and blue to 255, over (xmin, xmax, ymin, ymax) [m].

    The first row is the top one. A fourth number per pixel is its opacity, up to 255.
    """

    pixels: NDArray[np.uint8]
    bounds: tuple[float, float, float, float]


Shape = Circle | Polygon | Line | Text | Arrow | Image


@dataclass(slots=True)
class Scene:
    """A list of shapes, the lowest first. Each method adds one."""

    shapes: list[Shape] = field(default_factory=list)

    def circle(self, center: ArrayLike, radius: float, **look: Any) -> None:
        """Add a disc (`fill`), a ring (`stroke`), or both; look: fields of `Circle`."""
        self.shapes.append(Circle(_point(center), float(radius), **_look(look)))

    def polygon(self, points: ArrayLike | Outline, **look: Any) -> None:
        """Add a closed outline through points (k, 2); look: fields of `Polygon`."""
        self.shapes.append(Polygon(_points(points), **_look(look)))

    def line(self, points: ArrayLike | Outline, **look: Any) -> None:
        """Add a polyline through points (k, 2); look: fields of `Line`, `stroke` among them."""
        self.shapes.append(Line(_points(points), **_look(look)))

    def text(self, position: ArrayLike, text: str, **look: Any) -> None:
        """Add a label; look: fields of `Text`."""
        self.shapes.append(Text(_point(position), str(text), **_look(look)))

    def arrow(self, tail: ArrayLike, tip: ArrayLike, **look: Any) -> None:
        """Add an arrow; look: fields of `Arrow`, `fill` among them."""
        self.shapes.append(Arrow(_point(tail), _point(tip), **_look(look)))

    def cross(self, center: ArrayLike, arm: float, **look: Any) -> None:
        """Add a diagonal cross of two lines, twice its `arm` [m] wide and high."""
        x, y = _point(center)
        for up in (arm, -arm):
            self.line([(x - arm, y - up), (x + arm, y + up)], **look)

    def image(self, pixels: ArrayLike, bounds: Sequence[float]) -> None:
        """Add an image: pixels (rows, columns, 3) from 0 to 255, the top row first.

        bounds: (xmin, xmax, ymin, ymax) in metres. An image has at most 4096 rows and columns.
        Pixels (rows, columns, 4) have an opacity as well.
        """
        given = np.asarray(pixels)
        fits = given.ndim == 3 and given.shape[2] in (3, 4) and min(given.shape) > 0
        if not fits or max(given.shape) > LARGEST_IMAGE or given.dtype != np.uint8:
            raise InputError(
                f"pixels of shape {given.shape}, {given.dtype}: expected (rows, columns, 3 or "
                f"4) of uint8, up to {LARGEST_IMAGE} rows and columns"
            )
        xmin, xmax, ymin, ymax = np.asarray(bounds, dtype=float).tolist()
        if not (xmin < xmax and ymin < ymax):
            raise InputError(f"bounds = {shown(bounds)}: expected (xmin, xmax, ymin, ymax) [m]")
        self.shapes.append(Image(given, (xmin, xmax, ymin, ymax)))

    def sector(self, pose: ArrayLike, radius: float, angle: float, **look: Any) -> None:
        """Add a sector of `angle` radians about the heading of a pose (3,): a field of view."""
        if angle >= 2 * np.pi:
            self.circle(pose, radius, **look)
            return
        tip = np.asarray(pose, dtype=float)[:2]
        self.polygon(np.vstack([tip, arc(pose, radius, angle)]), **look)

    def extend(self, shapes: Iterable[Shape]) -> None:
        """Add the shapes of another scene."""
        self.shapes.extend(shapes)


def arc(pose: ArrayLike, radius: float, angle: float) -> NDArray[np.float64]:
    """Return points (k, 2) of an arc about the heading of a pose (3,)."""
    x, y, theta = np.asarray(pose, dtype=float).tolist()
    steps = theta + np.linspace(-angle / 2, angle / 2, max(2, int(angle / 0.1) + 2))
    c, s = cosines_sines(steps)
    return np.column_stack([x + radius * c, y + radius * s])


def _points(points: ArrayLike | Outline) -> NDArray[np.float64]:
    return np.asarray(points, dtype=float).reshape(-1, 2)
