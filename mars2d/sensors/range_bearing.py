"""Range and bearing of the other robots in view."""

from __future__ import annotations

from math import pi
from typing import Any, ClassVar

import numpy as np

from mars2d.core.description import flag, number
from mars2d.core.quantity import Quantity
from mars2d.core.scene import Scene, faded
from mars2d.core.streams import Random
from mars2d.geometry.bearings import BEARING, RANGE, draw_sighted, hold_missing, sighted
from mars2d.sensors.base import Float, Scanner, Sighting, sight_angle
from mars2d.sensors.surroundings import Surroundings


class RangeBearing(Scanner):
    """Measures the range and bearing of the other robots in view, from the sensor to their poses.

    A law finds a tuple of `Sighting`, nearest first, of the robots that are seen. The record has
    rows (range [m], bearing [rad]), (inf, nan) for a robot that is not seen: with identity (n, 2),
    row i for robot i, its own always missing; without it (n - 1, 2), nearest first. Bearings are
    from straight ahead, counter-clockwise, in (-pi, pi].

    A robot is seen unless an obstacle, a prop or a third robot lies on the line to its pose. One
    that is not seen has neither noise nor outliers.

    Sources: Casini & Garulli (2016), section 6.4; Ceccarelli et al. (2008).
    """

    quantities: ClassVar[tuple[Quantity, ...]] = (RANGE, BEARING)

    range: float = number(default=5.0, above=0, high=1e6, unit="m", doc="its range")
    field_of_view: float = sight_angle(default=2 * pi, doc="the angle it sees, about its heading")
    through_walls: bool = flag(default=False, doc="whether it sees hidden robots")
    identity: bool = flag(default=True, doc="whether readings name the robot")

    def scan(self, poses: Float, robots: list[int], world: Surroundings) -> Float:
        """Return rows of range and bearing: of robot i, or without identity nearest first."""
        others, everyone = world.pose[:2].T, np.arange(world.pose.shape[1])
        sight = None if self.through_walls else world
        rows = sighted(poses, others, self.range, self.field_of_view, everyone, robots, sight)
        return rows if self.identity else _nearest_first(rows)[:, :-1]  # not itself, never seen

    def measured(self, reading: Float, rng: Random) -> Float:
        """Return perfect readings with errors; a robot that is not seen stays unseen."""
        rows: Float = super().measured(reading, rng)
        if self._imperfection.none:
            return rows
        rows = hold_missing(rows, reading)
        return rows if self.identity else _nearest_first(rows)

    def shown(self, reading: Float) -> tuple[Sighting, ...]:
        """Return the sightings, nearest first."""
        robots = np.flatnonzero(np.isfinite(reading[:, 0]))
        near = zip(reading[robots].tolist(), robots.tolist(), strict=True)
        if not self.identity:  # its rows are in order
            return tuple([Sighting(*row) for row, _ in near])
        return tuple(sorted([Sighting(apart, bearing, i) for (apart, bearing), i in near]))

    def draw(self, scene: Scene, pose: Float, reading: Any, color: str) -> None:
        """Draw the field of view, and a line to each robot where it is measured to be."""
        here = self.placed(pose)
        full = self.field_of_view >= 2 * pi  # a crowd's full circles would pile up
        fill, stroke = None if full else faded(color, 0.05), faded(color, 0.25)
        scene.sector(here, self.range, self.field_of_view, fill=fill, stroke=stroke)
        draw_sighted(scene, here, reading, color)


def _nearest_first(rows: Float) -> Float:
    """Return rows (..., k, 2) in the order of range, then bearing; missing ones last."""
    order = np.lexsort((rows[..., 1], rows[..., 0]))
    return np.take_along_axis(rows, order[..., None], axis=-2)
