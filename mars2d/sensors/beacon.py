"""Range and bearing of beacons, by name."""

from __future__ import annotations

from math import inf, pi
from typing import Any, ClassVar, NoReturn

import numpy as np

from mars2d.core import checks
from mars2d.core.description import entry, flag, number
from mars2d.core.errors import InputError, UnknownNameError, nearest
from mars2d.core.interfaces import RobotLike
from mars2d.core.quantity import Quantity
from mars2d.core.scene import Scene, faded
from mars2d.core.streams import Random
from mars2d.geometry.bearings import BEARING, RANGE, draw_sighted, hold_missing, sighted
from mars2d.sensors.base import Float, Scanner, Sighting, sight_angle
from mars2d.sensors.surroundings import NOTHING, Surroundings

FAR = 50.0
"""A field of view that reaches further is not drawn to its end, metres."""


class Sightings(dict[str, Sighting]):
    """The sighting of each beacon by its name: range inf and bearing nan where it is not seen.

    Raises UnknownNameError for a name that no beacon has.
    """

    def __missing__(self, name: str) -> NoReturn:
        raise UnknownNameError(f"there is no beacon {name!r}{nearest(name, self)}")


class Beacon(Scanner):
    """Measures the range and bearing of the beacons that the add-on Beacon puts into the world.

    A law finds a mapping from each beacon's name to a `Sighting`; one that is not seen has range
    inf and bearing nan. The record has rows (range [m], bearing [rad]), (k, 2), in the order of
    `names` or else of the alphabet. Bearings are from straight ahead, counter-clockwise, in
    (-pi, pi].

    A beacon is seen unless an obstacle, a prop or another robot stands before it. One that is not
    seen has neither noise nor outliers.

    Source: Thrun, Burgard and Fox, Probabilistic Robotics (2005), section 6.6.
    """

    quantities: ClassVar[tuple[Quantity, ...]] = (RANGE, BEARING)

    range: float = number(default=100.0, above=0, high=1e6, unit="m", doc="its range")
    field_of_view: float = sight_angle(default=2 * pi, doc="the angle it sees, about its heading")
    through_walls: bool = flag(default=False, doc="whether it sees hidden beacons")
    names: tuple[str, ...] | None = entry(
        default=None,
        check=checks.names("a list of beacons' names, such as ['lamp'], or None"),
        optional=True,
        doc="the beacons that it looks for; None: all",
    )

    def on_start(self, robot: RobotLike, world: Surroundings, rng: np.random.Generator) -> None:  # noqa: ARG002
        """Look the beacons up. Raises InputError if there are none, or none of such a name."""
        known = sorted(world.beacons)
        if not known:
            raise InputError(
                f"{robot.name} looks for beacons and there are none: add "
                "mars2d.addons.Beacon(at=(x, y)) to Scenario.addons"
            )
        self._beacons: tuple[str, ...] = tuple(known) if self.names is None else self.names
        for name in self._beacons:
            if name not in known:
                raise InputError(
                    f"Beacon.names of {robot.name}: there is no beacon {name!r}"
                    f"{nearest(name, known)}"
                )

    def scan(self, poses: Float, robots: list[int], world: Surroundings) -> Float:
        """Return rows (m, k, 2) of range and bearing, (inf, nan) for a beacon that is not seen."""
        there, sight = world.beacons, None if self.through_walls else world  # some may be gone
        points = np.array([there.get(name, (inf, inf)) for name in self._beacons])
        nobody = np.full(len(points), NOTHING)
        return sighted(poses, points, self.range, self.field_of_view, nobody, robots, sight)

    def measured(self, reading: Float, rng: Random) -> Float:
        """Return perfect readings with errors; a beacon that is not seen stays unseen."""
        rows: Float = super().measured(reading, rng)
        return rows if self._imperfection.none else hold_missing(rows, reading)

    def shown(self, reading: Float) -> Sightings:
        """Return the sighting of each beacon, by name."""
        rows = zip(self._beacons, reading.tolist(), strict=True)
        return Sightings({name: Sighting(*row) for name, row in rows})

    def draw(self, scene: Scene, pose: Float, reading: Any, color: str) -> None:
        """Draw the field of view, and a line to each beacon where it is measured to be."""
        here = self.placed(pose)
        ranges = np.asarray(reading)[:, 0]
        seen = ranges[np.isfinite(ranges)]
        reach = self.range if self.range <= FAR else float(seen.max(initial=0.0))
        if reach and (self.range <= FAR or self.field_of_view < 2 * pi):
            fill, stroke = faded(color, 0.05), faded(color, 0.25)
            scene.sector(here, reach, self.field_of_view, fill=fill, stroke=stroke)
        draw_sighted(scene, here, reading, color)
