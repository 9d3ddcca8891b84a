"""The suite's scenes as plain numbers, which any simulator can be given.

This file imports numpy alone: the scripts of other simulators load it without MARS2D.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]
Outline = list[tuple[float, float]]

RADIUS = 0.15
"""The radius of a robot, metres, unless a scene says otherwise."""

SPEED = 0.3
"""The speed of the robots, m/s."""

BOX = 0.4
"""The side of each obstacle and each crate, turned squares, metres."""

MASS = 1.0
"""The mass of each robot and each crate, kg."""

FORCE, TORQUE = 5.0, 0.5
"""What a robot can push [N] and turn [N m] with."""

FRICTION, WALL_FRICTION = 0.5, 1.0
"""The coefficients of robots and crates, of walls and obstacles; a contact has their product."""

FLOOR = 0.3
"""The coefficient of friction between the floor and a crate."""

GRAVITY = 9.81
"""Metres per second squared."""

LEVER = BOX * (2**0.5 + np.log(1 + 2**0.5)) / 6
"""The mean distance of a crate's points from its centre: its lever against the floor, metres."""

TOW = 0.7
"""How far a robot is from the crate that it tows at the start, metres; see `p3`."""

ROPE = 1.5
"""The length of a rope in distances of its ends at the start."""

MIN_GAP = 0.02
"""The smallest distance between things at the start, metres."""

MAX_ATTEMPTS = 100_000
"""The number of places drawn for a disc before giving up."""


@dataclass(frozen=True)
class Scene:
    """A square arena with walls, obstacles, robots, and crates that they can push.

    name, title: of the scene. sampling_time: seconds. side: of the arena round the origin, metres.
    poses: (n, 3) at the start. boxes: the obstacles' outlines. radius: of the robots, metres.
    beams, range: of each robot's scanner [m], 0 for none. proximity: the range of its proximity
    sensor [m], 0 for none. square: whether robots are squares, with the radius as half their side.
    crates: (p, 3) at the start. ropes: robot, crate and length [m] of each, between their centres.
    turning: the largest omega of the law `Turns`, rad/s.
    """

    name: str
    title: str
    sampling_time: float
    side: float
    poses: Float
    boxes: list[Outline]
    radius: float = RADIUS
    beams: int = 0
    range: float = 0.0
    proximity: float = 0.0
    square: bool = False
    crates: Float = field(default_factory=lambda: np.empty((0, 3)))
    ropes: tuple[tuple[int, int, float], ...] = ()
    turning: float = 1.0

    def law(self) -> Turns:
        """The law from its first control step, for scenes without proximity sensors."""
        return Turns(len(self.poses), self.sampling_time, self.turning)

    @property
    def half_sides(self) -> Float:
        """Half the sides of the squares of robots, 0 for discs, then of crates, (n + p,) metres."""
        of_robots = np.full(len(self.poses), self.radius if self.square else 0.0)
        return np.append(of_robots, np.full(len(self.crates), BOX / 2))

    @property
    def rims(self) -> Float:
        """The radii of discs, 0 for squares, of robots and crates, (n + p,) metres."""
        of_robots = np.full(len(self.poses), 0.0 if self.square else self.radius)
        return np.append(of_robots, np.zeros(len(self.crates)))

    @property
    def walls(self) -> Outline:
        """The outline of the arena."""
        h = self.side / 2
        return [(-h, -h), (-h, h), (h, h), (h, -h)]


class Turns:
    """The law of a scene without proximity sensors: `SPEED` ahead, a new random omega each second.

    It is called at each control step for the commands (2, n) of all robots.
    """

    def __init__(self, robots: int, sampling_time: float, turning: float = 1.0) -> None:
        """Take the number of robots, the sampling time [s] and the largest omega [rad/s]."""
        self._rng, self._turning = np.random.default_rng(1), turning
        self._every = round(1 / sampling_time)
        self._command = np.full((2, robots), SPEED)

    def __call__(self, iteration: int) -> Float:
        """Return the commands (2, n) of a control step: v [m/s] and omega [rad/s]."""
        if iteration % self._every == 0:
            turning = self._turning
            self._command[1] = self._rng.uniform(-turning, turning, self._command.shape[1])
        return self._command


def arena(
    name: str,
    title: str,
    robots: int,
    boxes: int,
    side: float,
    sampling_time: float,
    *,
    radius: float = RADIUS,
    beams: int = 0,
    reach: float = 0.0,
    proximity: float = 0.0,
) -> Scene:
    """Return a scene with obstacles and robots at random places, without contacts."""
    rng = np.random.default_rng(robots)
    places = _Places(side, rng)
    outlines = [
        _box(places.take(BOX / 2**0.5 + radius), rng.uniform(0, np.pi / 2)) for _ in range(boxes)
    ]
    poses = [(*places.take(radius + MIN_GAP), rng.uniform(-np.pi, np.pi)) for _ in range(robots)]
    return Scene(
        name, title, sampling_time, side, np.array(poses), outlines, radius, beams, reach, proximity
    )


class _Places:
    """Free places in a square round the origin."""

    def __init__(self, side: float, rng: np.random.Generator) -> None:
        self._half, self._rng = side / 2, rng
        self._taken = np.empty((16, 3))  # x, y, radius
        self._count = 0

    def take(self, radius: float) -> tuple[float, float]:
        """Return the centre of a free disc, which is taken from now on."""
        if self._count == len(self._taken):
            self._taken = np.concatenate([self._taken, np.empty_like(self._taken)])
        x, y, r = self._taken[: self._count].T
        far = self._half - radius
        for _ in range(MAX_ATTEMPTS):
            here = self._rng.uniform(-far, far, 2)
            if ((x - here[0]) ** 2 + (y - here[1]) ** 2 >= (r + radius) ** 2).all():
                self._taken[self._count] = *here, radius
                self._count += 1
                return float(here[0]), float(here[1])
        raise ValueError(f"no room for a disc of radius {radius:g} m")

    def turned(self, radius: float) -> tuple[float, float, float]:
        """Return a pose of any angle whose disc is free, and is taken from now on."""
        return (*self.take(radius), self.angle())

    def angle(self) -> float:
        """Return a random angle, rad."""
        return float(self._rng.uniform(-np.pi, np.pi))


def _box(center: tuple[float, float], angle: float) -> Outline:
    """Return the corners of a turned square round a point."""
    turns = angle + np.pi / 4 + np.pi / 2 * np.arange(4)
    x, y = center[0] + BOX / 2**0.5 * np.cos(turns), center[1] + BOX / 2**0.5 * np.sin(turns)
    return [(float(a), float(b)) for a, b in zip(x, y, strict=True)]


def side_for(robots: int, cover: float = 0.05) -> float:
    """Return the side of an arena of which robots cover the share `cover`, metres."""
    return float(np.sqrt(robots * np.pi * RADIUS**2 / cover))


def s1() -> Scene:
    """Return two robots, of the paper's size, that wander by its Algorithm 2."""
    return arena("S1", "2 robots, Algorithm 2", 2, 4, 5.0, 1.0, radius=0.09, proximity=0.3)


def s2() -> Scene:
    """Return a hundred robots among obstacles."""
    return arena("S2", "100 robots", 100, 20, side_for(100), 0.05)


def s3() -> Scene:
    """Return twenty robots with laser scanners."""
    return arena("S3", "20 robots, 180 beams", 20, 50, 15.0, 0.1, beams=180, reach=5.0)


def s4() -> Scene:
    """Return a thousand robots."""
    return team(1000, 0.05, "S4")


def team(robots: int, sampling_time: float, name: str = "team") -> Scene:
    """Return a scene of which robots cover 5 %, with one obstacle for each fifty."""
    title = f"{robots} robots"
    return arena(name, title, robots, robots // 50, side_for(robots), sampling_time)


def p1() -> Scene:
    """Return twenty robots among crates that they push."""
    return among_crates(20, 0.05, "P1")


def among_crates(robots: int, sampling_time: float, name: str = "crates") -> Scene:
    """Return robots among half as many crates again, of which the robots cover 2 %."""
    crates, side = 3 * robots // 2, 8.0 * float(np.sqrt(robots / 20))
    places = _Places(side, np.random.default_rng(robots))
    boxes = [places.turned(BOX / 2**0.5 + MIN_GAP) for _ in range(crates)]
    poses = [places.turned(RADIUS + MIN_GAP) for _ in range(robots)]
    return Scene(
        name, f"{robots} robots, {crates} crates", sampling_time, side, np.array(poses), [],
        crates=np.array(boxes), turning=2.0,
    )  # fmt: skip


def p2() -> Scene:
    """Return sixty square robots."""
    side = 10.0
    places = _Places(side, np.random.default_rng(60))
    poses = [places.turned(2**0.5 * RADIUS + MIN_GAP) for _ in range(60)]
    return Scene(
        "P2", "60 square robots", 0.05, side, np.array(poses), [], square=True, turning=2.0
    )


def p3() -> Scene:
    """Return five crates, each towed by two robots on either side of it."""
    side = 10.0
    places = _Places(side, np.random.default_rng(10))
    crates = [places.turned(TOW + RADIUS + MIN_GAP) for _ in range(5)]
    poses, ropes = [], []
    for k in range(10):
        x, y, theta = crates[k // 2]
        ahead = theta + np.pi * (k % 2)
        poses.append((x + TOW * np.cos(ahead), y + TOW * np.sin(ahead), places.angle()))
        ropes.append((k, k // 2, ROPE * TOW))
    return Scene(
        "P3", "10 robots tow 5 crates", 0.05, side, np.array(poses), [],
        crates=np.array(crates), ropes=tuple(ropes), turning=2.0,
    )  # fmt: skip


SCENES = {"S1": s1, "S2": s2, "S3": s3, "S4": s4, "P1": p1, "P2": p2, "P3": p3}
"""The scenes of the suite, by name."""
