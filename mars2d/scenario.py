"""The frozen description of an experiment: robots, workspace, timing, physics, looks."""

from __future__ import annotations

import numbers
from collections.abc import Sequence
from functools import cached_property
from math import cos, floor, pi, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d import checks
from mars2d.addons.base import Addon
from mars2d.animation import Animation
from mars2d.description import Description, choice, entry, number, text, wrong
from mars2d.errors import InputError, shown
from mars2d.geometry import Outline, bounds_of, distance_to_ring, outside_polygon
from mars2d.robot import Robot
from mars2d.usercode import called

__all__ = ["Obstacle", "Scenario"]

MASS_RATIO = 10.0
"""The largest ratio of masses that contacts hold; at 100, crowds push robots through walls."""

ROW_LIMIT = 100_000_000


def _outlines(addon: Addon) -> tuple[Outline, ...]:
    """Return an add-on's obstacles, checked: it may be of the user's own."""
    with called(f"add-on {addon.key!r}", addon.obstacles):
        found = addon.obstacles()
    return checks.outlines(f"{type(addon).__name__}.obstacles()", found)


class Obstacle(NamedTuple):
    """Something fixed: its outline [m], coefficient of friction and restitution."""

    outline: Outline
    friction: float
    restitution: float


def _robots(name: str, value: object) -> object:
    """Check a list of robots; a number n stands for n default robots, placed by the scenario."""
    if isinstance(value, numbers.Integral) and not isinstance(value, bool):
        if not 1 <= int(value) <= 10_000:
            raise wrong(name, value, "a list of robots, or how many")
        return int(value)
    robots = checks.listing(Robot, "Robot(pose=(0, 0, 0))")(name, value)
    if not robots:
        raise wrong(name, value, "at least one robot, as [Robot(pose=(0, 0, 0))]")
    return robots


def _workspace(name: str, value: object) -> Outline | None:
    return None if value is None else checks.outline(name, value, least=3)


class Scenario(Description):
    """Everything about an experiment but its laws: frozen, validated, in SI units.

    >>> Scenario(robots=[Robot(pose=(0, 0, 0))]).bounds
    (-5.0, 5.0, -5.0, 5.0)

    Raises InputError for whatever the engine could not simulate truthfully: robots that start
    inside an obstacle, inside each other or outside the workspace, polygons that cross themselves,
    numbers out of range.
    """

    title: str = text(default="[Simulation]", doc="the title shown")
    robots: Sequence[Robot] = entry(
        default=1, check=_robots, doc="the team, or how many default robots"
    )
    workspace: Outline | None = entry(
        default=((-5.0, -5.0), (-5.0, 5.0), (5.0, 5.0), (5.0, -5.0)),
        check=_workspace, unit="m", doc="the polygon in which the robots move; None: no limits",
    )  # fmt: skip
    on_exit: str = choice(
        default="stop", of=("stop", "wall", "ignore"),
        doc="at the workspace's edge: the experiment is over, a wall stands there, or nothing",
    )  # fmt: skip
    sampling_time: float = number(
        default=0.1, low=1e-6, high=1e4, unit="s", doc="time between commands"
    )
    stop_time: float = number(
        default=100.0,
        low=0,
        high=1e12,
        unit="s",
        doc="the longest duration; the last step is the last multiple of the sampling time",
    )
    command_delay: float = number(
        default=0.0, low=0, high=1e6, unit="s", doc="from a command's issue to its effect"
    )
    physics: str = choice(default="contact", of=("contact",), doc="what happens when things touch")
    max_overlap: float = number(
        default=1e-3, low=1e-5, high=1.0, unit="m", doc="how deep bodies may overlap for an instant"
    )
    addons: Sequence[Addon] = entry(
        default=(), check=checks.listing(Addon, "Map([...])"), doc="maps, measures, games"
    )
    animation: Animation = entry(
        check=checks.instance(Animation, "Animation()"), factory=Animation, doc="how it is drawn"
    )

    def _validate(self) -> None:
        if isinstance(self.robots, int):
            object.__setattr__(self, "robots", self._circle_of_robots(self.robots))
        taken = {robot.name for robot in self.robots}
        named = tuple(
            robot if robot.name is not None else robot.replace(name=_free_name(i, taken))
            for i, robot in enumerate(self.robots)
        )
        object.__setattr__(self, "robots", named)
        checks.unique("Scenario.robots", [str(robot.name) for robot in named])
        checks.unique("Scenario.addons", [addon.key for addon in self.addons])
        if self.stop_time / self.sampling_time > ROW_LIMIT:
            raise wrong(
                "Scenario.stop_time", self.stop_time,
                f"at most {ROW_LIMIT:g} sampling times of {self.sampling_time:g} s",
            )  # fmt: skip
        if self.command_delay / self.sampling_time > 1e6:
            raise wrong(
                "Scenario.command_delay", self.command_delay,
                f"at most a million sampling times of {self.sampling_time:g} s",
            )  # fmt: skip
        self._check_masses()
        self._check_starts()

    def _circle_of_robots(self, count: int) -> tuple[Robot, ...]:
        """Place robots round a circle, facing its centre, as MARS does without an Initial_pose."""
        xmin, xmax, ymin, ymax = self.bounds
        x, y = (xmin + xmax) / 2, (ymin + ymax) / 2
        radius = 0.7 * min(xmax - xmin, ymax - ymin) / 2 if count > 1 else 0.0
        angles = [2 * pi * i / count for i in range(count)]
        return tuple(
            Robot(pose=(x + radius * cos(a), y + radius * sin(a), a + pi if count > 1 else 0.0))
            for a in angles
        )

    def _check_masses(self) -> None:
        lightest = min(self.robots, key=lambda robot: robot.mass)
        heaviest = max(self.robots, key=lambda robot: robot.mass)
        if heaviest.mass > MASS_RATIO * lightest.mass:
            raise InputError(
                f"Robot.mass: {heaviest.name} has {heaviest.mass:g} kg and {lightest.name} "
                f"{lightest.mass:g} kg; contacts hold a ratio of at most {MASS_RATIO:g}"
            )

    def _check_starts(self) -> None:
        """Refuse robots that start outside the workspace, in an obstacle or in each other."""
        outlines = self.obstacles
        if self.workspace is not None and self.on_exit != "ignore":
            self._check_in_workspace(self.workspace)
        if outlines:
            self._check_off_obstacles(outlines)
        self._check_apart()

    def _check_in_workspace(self, workspace: Outline) -> None:
        corners = np.array(workspace)
        x, y, _ = self.initial_pose
        for i in np.flatnonzero(outside_polygon(x, y, corners)).tolist():
            robot = self.robots[i]
            raise InputError(
                f"Robot.pose of {robot.name} = {robot.pose}: starts outside the workspace"
                " (Scenario.workspace, or on_exit='ignore' to let it)"
            )
        if self.on_exit != "wall":
            return
        x, y = np.array([robot.center for robot in self.robots]).T
        gaps = distance_to_ring(x, y, corners)
        for robot, gap in zip(self.robots, gaps.tolist(), strict=True):
            if gap < robot.radius - self._overlap(robot):
                raise InputError(
                    f"Robot.pose of {robot.name} = {robot.pose}: starts in the workspace's wall, "
                    f"{gap:.3g} m from its centre; its radius is {robot.radius:g} m"
                )

    def _check_off_obstacles(self, outlines: Sequence[Outline]) -> None:
        import shapely

        shapes = [shapely.LineString(o) if len(o) == 2 else shapely.Polygon(o) for o in outlines]
        tree = shapely.STRtree(shapes)
        for robot in self.robots:
            center = shapely.Point(robot.center)
            reach = robot.radius - self._overlap(robot)
            for k in sorted(tree.query(center, "dwithin", reach)):
                where = "inside" if shapes[k].contains(center) else "in contact with"
                hint = (
                    " (if it is a room, draw it as walls of two points)"
                    if where == "inside"
                    else ""
                )
                raise InputError(
                    f"Robot.pose of {robot.name} = {robot.pose}: starts {where} obstacle {k}, "
                    f"{shown(outlines[k], 80)}{hint}"
                )

    def _check_apart(self) -> None:
        centers = np.array([robot.center for robot in self.robots])
        radii = np.array([robot.radius for robot in self.robots])
        allowed = min(self._overlap(robot) for robot in self.robots)
        # Sweep along the longer side: who comes later than the reach is too far away.
        along = centers[:, np.argmax(np.ptp(centers, axis=0))]
        order = np.argsort(along, kind="stable")
        ends = np.searchsorted(along[order], along[order] + 2 * radii.max(), side="right")
        for place, i in enumerate(order):
            others = order[place + 1 : ends[place]]
            gaps = np.hypot(*(centers[others] - centers[i]).T) - radii[others] - radii[i]
            if (gaps < -allowed).any():
                k = int(np.argmin(gaps))
                a, b = sorted((int(i), int(others[k])))
                raise InputError(
                    f"Robot.pose of {self.robots[a].name} = {self.robots[a].pose} and of "
                    f"{self.robots[b].name} = {self.robots[b].pose}: they start {-gaps[k]:.3g} m "
                    "inside each other"
                )

    def _overlap(self, robot: Robot) -> float:
        """Return how deep a robot may start in something, metres."""
        return min(self.max_overlap, robot.radius / 4)

    @cached_property
    def surfaces(self) -> tuple[Obstacle, ...]:
        """What stands in the way: the add-ons' obstacles, then the workspace where it is a wall."""
        found = [
            Obstacle(outline, addon.friction, addon.restitution)
            for addon in self.addons
            for outline in _outlines(addon)
        ]
        if self.on_exit == "wall" and self.workspace is not None:
            found.append(Obstacle(self.workspace, 1.0, 1.0))
        return tuple(found)

    @property
    def obstacles(self) -> tuple[Outline, ...]:
        """The outlines of the add-ons' obstacles, in order."""
        walled = self.on_exit == "wall" and self.workspace is not None
        found = self.surfaces[:-1] if walled else self.surfaces
        return tuple(obstacle.outline for obstacle in found)

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """(xmin, xmax, ymin, ymax) of the workspace [m]; without one, of robots and obstacles."""
        if self.workspace is not None:
            return bounds_of(self.workspace)
        if isinstance(self.robots, int):
            return -5.0, 5.0, -5.0, 5.0
        points = [robot.center for robot in self.robots]
        points += [vertex for outline in self.obstacles for vertex in outline]
        xmin, xmax, ymin, ymax = bounds_of(points)
        return xmin - 1, xmax + 1, ymin - 1, ymax + 1

    @property
    def initial_pose(self) -> NDArray[np.float64]:
        """The poses at the start, (3, n)."""
        return np.array([robot.pose for robot in self.robots]).T

    @property
    def last_iteration(self) -> int:
        """The iteration at the stop time: the run has this many sampling times."""
        return floor(self.stop_time / self.sampling_time * (1 + 1e-12) + 1e-9)

    @property
    def colors(self) -> tuple[str, ...]:
        """The robots' colours, each its own or the next of the animation's base colours."""
        base = self.animation.base_colors
        return tuple(robot.color or base[i % len(base)] for i, robot in enumerate(self.robots))


def _free_name(index: int, taken: set[str | None]) -> str:
    name = f"robot{index}"
    while name in taken:
        name += "_"
    return name
