"""Arrows whose length is a quantity; longer ones than the longest are shortened by one rule."""

from __future__ import annotations

from collections.abc import Callable
from math import floor, log10, sqrt
from statistics import median
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Anchor, Scene
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]

EDGE = "#ffffff"
"""The colour of the thin edges that set arrows off from their background."""

LABEL_SIZE = 13.0
"""The height of the number beside an arrow, points."""

CUT_WIDTH = 2.0
"""The width of the strokes of a cut, points."""

MAX_ARROW = 72.0
"""The greatest length of an arrow, points; it means 1, 2, 5, 10 ... newtons or metres a second."""

FEW_ROBOTS = 6
"""With more robots, arrows are shorter and thinner."""

LONGEST = 2.5
"""The length of the longest arrow, as a multiple of that of the quantity's usual bound."""


def shortening(length: Float, longest: float) -> Float:
    """Return the factors by which arrows of these lengths are drawn shorter; 1 for most.

    The rule: an arrow longer than `longest` is drawn that long, with a cut through it.
    """
    return np.asarray(longest / np.maximum(length, longest))


def arrow(
    scene: Scene,
    start: Float,
    way: Float,
    *,
    fill: str,
    width: float,
    edge: str | None = EDGE,
    shortened: bool = False,
) -> None:
    """Draw an arrow from a point along `way`, both (2,) metres; a cut says that it is shortened."""
    scene.arrow(start, start + way, fill=fill, stroke=edge, width=width)
    slant = 0.06 * np.array([way[0] - way[1], way[0] + way[1]])
    for share in (0.42, 0.5) if shortened else ():
        middle = start + share * way
        scene.line([middle - slant, middle + slant], stroke=EDGE, width=CUT_WIDTH)


def beside(scene: Scene, point: Float, way: Float, words: str, color: str) -> None:
    """Write a number beside a point, along `way`: beyond the tip of an arrow, for example."""
    across = abs(way[0]) > abs(way[1])
    side: Anchor = ("left" if way[0] > 0 else "right") if across else "above"
    if not across and way[1] < 0:
        side = "below"
    scene.text(point, words, color=color, size=LABEL_SIZE, anchor=side, halo=EDGE)


def crowd_factor(scenario: Scenario) -> float:
    """Return how much smaller arrows are among many robots, where they pile up: 1 for few."""
    return max(1.0, sqrt(len(scenario.robots) / FEW_ROBOTS))


def usual_length(scenario: Scenario, diameters: float, share: float) -> float:
    """Return a length of arrows, metres: in diameters of a robot, or a share of the workspace."""
    xmin, xmax, ymin, ymax = scenario.bounds
    sizes = [2 * robot.radius for robot in scenario.robots]
    return max(diameters * median(sizes), share * max(xmax - xmin, ymax - ymin))


class Sign(NamedTuple):
    """A sign in a legend, and its name. scene: round (0, 0), in points. room: its width, points.

    length: of an arrow to scale, metres.
    """

    scene: Scene
    room: float
    name: str
    length: float = 0.0


class Ruler(NamedTuple):
    """An arrow whose length is a quantity.

    Its scale is the same in a whole experiment. width: points. unit: the metres that one unit is
    long. longest: metres; see `shortening`. in_words: formats a number of units. most: the number
    of units that is usual at most.
    """

    color: str
    width: float
    unit: float
    longest: float
    in_words: Callable[[float], str]
    most: float

    @property
    def lengths(self) -> list[tuple[float, str]]:
        """The arrows of round numbers that are not shortened: metres, and in words."""
        numbers = [digit * 10.0**power for power in range(-2, 6) for digit in (1, 2, 5)]
        kept = [k for k in numbers if k * self.unit <= self.longest * (1 + 1e-9)]
        return [(k * self.unit, self.in_words(k)) for k in kept or numbers[:1]]

    def sign(self, point: float, most: float = MAX_ARROW) -> Sign:
        """Return the longest arrow of a round number, at most so many points; point: metres."""
        number = round_force(min(most * point, self.longest) / self.unit)
        metres, scene = number * self.unit, Scene()
        start, way = np.array([-0.5, 0.0]) * metres / point, np.array([metres / point, 0.0])
        arrow(scene, start, way, fill=self.color, width=self.width)
        return Sign(scene, metres / point, self.in_words(number), metres)

    @property
    def limit(self) -> Sign:
        """The sign of an arrow that is drawn shorter than it is, as it stands for too much."""
        scene, way = Scene(), np.array([32.0, 0.0])
        arrow(scene, -way / 2, way, fill=self.color, width=self.width, shortened=True)
        return Sign(scene, 36.0, f"over {self.in_words(self.longest / self.unit)}")


def round_force(most: float) -> float:
    """Return the largest number of 1, 2 or 5 times a power of ten that is at most `most`."""
    power = 10.0 ** floor(log10(most) + 1e-9)
    return next(k * power for k in (5.0, 2.0, 1.0) if k * power <= most * (1 + 1e-9))


def as_read(number: float) -> str:
    """Return a number as it is read, with two digits from 1 on: 0.25, 4.9, 12."""
    return f"{number:.{2 if number < 0.995 else 1 if number < 9.95 else 0}f}"
