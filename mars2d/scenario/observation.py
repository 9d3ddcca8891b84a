"""What a learner sees and does: a row of numbers with bounds, and shares of a drive's bounds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf, isfinite
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.drives.base import Drive
from mars2d.core.arithmetic import cosine_sine, norm
from mars2d.core.errors import InputError, shown
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]
Row = NDArray[np.float32]

SENSED = "sense."
"""The beginning of the names of parts that are readings of sensors."""

SEEN: dict[str, Callable[[Any], Any]] = {
    "pose": lambda view: view.pose,
    "positions": lambda view: [other.position for other in view.neighbours],
    "poses": lambda view: [other.pose for other in view.neighbours],
    "props": lambda view: view.world.prop_pose,
}
"""What a law would ask its robot for that sees the other parts, by their names."""


class Part(NamedTuple):
    """Some numbers of an observation: their name, and the least and largest value of each."""

    name: str
    low: tuple[float, ...]
    high: tuple[float, ...]


class Observation:
    """Turns the data that a robot's law may see into a row of numbers (k,), float32, within bounds.

    Its parts depend on `Robot.sees`:

    - "pose": x, y [m], cos and sin of the heading; not with "sensors";
    - "positions": of each other robot, by index, its position seen from the robot [m], in the
      frame of the drive's commands: ahead and left, or along x and y for a drive that moves in the
      world's frame. Zeros for one that is no neighbour now. Only with "positions";
    - "poses": the same, and cos and sin of its heading in that frame; with "partial" and "full";
    - "props": the same of each prop; with "full";
    - "sense.NAME": the reading of each sensor. A missing distance is the sensor's range, any other
      missing number 0.

    Positions are bounded by the workspace, readings by what the sensor can measure. Numbers beyond
    are clipped.
    """

    def __init__(self, parts: Sequence[Part]) -> None:
        """Take the parts, in order."""
        self.parts = tuple(parts)
        self.low: Float = np.array([x for part in parts for x in part.low])
        self.high: Float = np.array([x for part in parts for x in part.high])
        self._posed = any(not part.name.startswith(SENSED) for part in parts)
        self._least, self._most = self.low.astype(np.float32), self.high.astype(np.float32)
        self._missing: Float = np.where(np.isfinite(self.high), self.high, 0.0)

    @classmethod
    def of(cls, scenario: Scenario, robot: int, view: Any) -> Self:
        """Return the observation of a robot, by its index.

        view: the robot as its law sees it, with readings. Raises InputError where it sees nothing,
        and for a sensor whose readings are not a fixed number of numbers.
        """
        who = scenario.robots[robot]
        xmin, xmax, ymin, ymax = scenario.bounds
        extent = max(map(abs, scenario.bounds))
        across = norm(xmax - xmin, ymax - ymin)
        place, turn = (across, across), (1.0, 1.0)
        others, parts = len(scenario.robots) - 1, []

        def add(name: str, high: tuple[float, ...]) -> None:
            if high:
                parts.append(Part(name, tuple(-x for x in high), high))

        if who.sees != "sensors":
            parts.append(Part("pose", (xmin, ymin, -1.0, -1.0), (xmax, ymax, 1.0, 1.0)))
            headings = who.sees != "positions"
            add("poses" if headings else "positions", (place + turn * headings) * others)
        if who.sees == "full":
            add("props", (place + turn) * len(scenario.props))
        for sensor in who.sensors:
            reading = getattr(view.sense, sensor.key)
            low, high = sensor.limits(extent)
            count = _numbers_of(reading, f"{who.name}: sensor {sensor.key!r}").size
            times, rest = divmod(count, len(low))
            if rest:
                times, low, high = count, np.array([-inf]), np.array([inf])
            parts.append(
                Part(SENSED + sensor.key, tuple(low.tolist()) * times, tuple(high.tolist()) * times)
            )
        if not parts:
            raise InputError(
                f"{who.name} sees sensors only, and carries none: give it sensors, or another sees"
            )
        return cls(parts)

    def __call__(self, view: Any) -> Row:
        """Return a robot's present observation, (k,), float32, within the bounds.

        Raises InputError where a part is of another size. It does not ask whether the robot's law
        may see all parts: `check` does.
        """
        look = _look(view) if self._posed else None
        row: list[float] = []
        for name, low, _ in self.parts:
            values = look(name) if look and name in SEEN else _sensed(view, name)
            if len(values) != len(low):
                raise InputError(
                    f"{name} of {view.name} has {len(values)} numbers, expected {len(low)}"
                )
            row += values
        if not isfinite(sum(row)):
            numbers = np.nan_to_num(np.array(row), nan=0.0, posinf=inf, neginf=-inf)
            row = np.where(np.isposinf(numbers), self._missing, numbers).tolist()
        bounded = np.array(row, np.float32)
        np.maximum(bounded, self._least, out=bounded)
        return np.minimum(bounded, self._most, out=bounded)

    def check(self, view: Any) -> None:
        """Raise InputError or LawError for a robot that can't be observed so, or may not see it."""
        for part in self.parts:
            if part.name in SEEN:
                SEEN[part.name](view)
        self(view)


class Action(NamedTuple):
    """Turns shares, from -1 to 1, into a command (m,): from its least value to its largest one."""

    low: tuple[float, ...]
    high: tuple[float, ...]

    @classmethod
    def of(cls, drive: Drive, robot: str) -> Self:
        """Return the action of a robot's drive. Raises InputError if that has no bounds."""
        low, high = drive.bounds.tolist()
        if not isfinite(sum(low) + sum(high)):
            raise InputError(
                f"{robot}: its drive, {type(drive).__name__}, does not limit its commands: a "
                "learner needs bounds; give it a `saturate` that has some"
            )
        return cls(tuple(low), tuple(high))

    def __call__(self, shares: Sequence[float]) -> tuple[float, ...]:
        """Return the command for finite shares (m,); beyond -1 and 1 they are clipped."""
        return tuple(
            low + (high - low) * (min(max(share, -1.0), 1.0) + 1) / 2
            for low, high, share in zip(*self, shares, strict=True)
        )


def _numbers_of(reading: Any, name: str) -> Float:
    """Return a reading as numbers (k,). Raises InputError if it is anything else."""
    try:
        values = np.asarray(reading)
    except ValueError:
        values = np.empty(0, dtype=object)
    if values.dtype.kind not in "fiub" or not values.size:
        raise InputError(
            f"{name} reads {shown(reading)}, not a fixed number of numbers: a learner can't use it"
        )
    return values.ravel().astype(float)


def _look(view: Any) -> Callable[[str], list[float]]:
    """Return a function that reads the parts of one observation, besides sensors, by name."""
    world, me = view._world, view._index
    places = world.pose.T.tolist()
    x, y, heading = places[me]
    turn = 0.0 if world.scenario.robots[me].drive.frame == "world" else heading
    c, s = cosine_sine(turn)

    def seen(place: list[float], count: int = 4) -> list[float]:
        """Return a position in the frame of the commands [m], and perhaps cos and sin."""
        dx, dy = place[0] - x, place[1] - y
        there = [c * dx + s * dy, c * dy - s * dx]
        return there if count == 2 else [*there, *cosine_sine(place[2] - turn)]

    def look(name: str) -> list[float]:
        if name == "pose":
            return [x, y, *cosine_sine(heading)]
        if name == "props":
            return [number for place in world.prop_pose.T.tolist() for number in seen(place)]
        count = 4 if name == "poses" else 2
        row = [0.0] * (count * (len(places) - 1))  # zeros for those that are no neighbours
        for j in world.neighbour_indices(me):
            at = count * (j - (j > me))
            row[at : at + count] = seen(places[j], count)
        return row

    return look


def _sensed(view: Any, name: str) -> list[float]:
    key = name[len(SENSED) :]
    reading = getattr(view.sense, key)
    if isinstance(reading, (bool, int, float)):
        return [float(reading)]
    return _numbers_of(reading, f"{view.name}: sensor {key!r}").tolist()  # type: ignore[no-any-return]
