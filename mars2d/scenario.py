"""The frozen description of an experiment: robots, workspace, timing, physics, looks."""

from __future__ import annotations

import inspect
import numbers
from collections import Counter
from collections.abc import Callable, Sequence
from math import cos, floor, pi, sin
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from mars2d import checks
from mars2d.addons.base import Addon
from mars2d.bodies.base import Drive
from mars2d.bodies.unicycle import Unicycle
from mars2d.description import Description, choice, entry, flag, number, real, text, wrong
from mars2d.errors import InputError, shown
from mars2d.geometry import Outline, Point, bounds_of, edges_of
from mars2d.scene import PALETTE, color, wake_style
from mars2d.sensors.base import Sensor

__all__ = ["Animation", "Robot", "Scenario"]

MASS_RATIO = 10.0
"""The largest ratio of masses that contacts hold; at 100, crowds push robots through walls."""

ACCELERATION = 1e5
"""How strongly a drive may accelerate its robot, m/s^2; more needs ever more substeps."""

ROW_LIMIT = 100_000_000


def _controller(name: str, value: object) -> object:
    if value is not None and not callable(value):
        raise wrong(name, value, "a function of one argument, the robot: def law(robot): ...")
    if value is not None:
        try:
            inspect.signature(value).bind(None)
        except TypeError:
            raise wrong(name, value, "a function of exactly one argument, the robot") from None
        except ValueError:
            pass  # a built-in without a signature: the first call will tell
    return value


def _optional_color(name: str, value: object) -> str | None:
    return None if value is None else color(name, value)


class Robot(Description):
    """One robot: a disc that its drive moves, with sensors and perhaps a law of its own.

    >>> Robot(diameter=0.2).at(1, 2, 0).pose
    (1.0, 2.0, 0.0)
    """

    pose: tuple[float, float, float] = entry(
        default=(0.0, 0.0, 0.0),
        check=checks.pose,
        unit="m, m, rad",
        doc="initial pose (x, y, theta)",
    )
    drive: Drive = entry(
        check=checks.instance(Drive, "Unicycle()"), factory=Unicycle, doc="how it moves"
    )
    diameter: float = number(
        default=0.3, low=1e-3, high=1e3, unit="m", doc="diameter of the chassis"
    )
    mass: float = number(default=1.0, low=1e-6, high=1e6, unit="kg", doc="mass")
    friction: float = number(
        default=0.5,
        low=0,
        high=1e3,
        doc="coefficient of friction; a contact has the product of both",
    )
    restitution: float = number(
        default=0.0, low=0, high=1, doc="0 stops, 1 bounces back; a contact has the product of both"
    )
    center_offset: float = number(
        default=0.0, low=-1e3, high=1e3, unit="m",
        doc="how far the centre of rotation lies ahead of the geometric centre",
    )  # fmt: skip
    sensors: Sequence[Sensor] = entry(
        default=(),
        check=checks.listing(Sensor, "Proximity(range=0.3)"),
        doc="what it perceives with",
    )
    controller: Callable[[Any], Any] | None = entry(
        default=None, check=_controller, doc="its own law, a function or generator of the robot"
    )
    sees: str = choice(default="full", of=("full", "sensors"), doc="what its law may see")
    name: str | None = text(default=None, optional=True, doc="its name, else robot0, robot1, ...")
    color: str | None = entry(
        default=None, check=_optional_color, doc="its colour, else from base_colors"
    )

    def at(self, x: float, y: float, theta: float = 0.0) -> Self:
        """Return a copy of this robot at pose (x [m], y [m], theta [rad])."""
        return self.replace(pose=(x, y, theta))

    @property
    def radius(self) -> float:
        """Half the diameter, metres."""
        return self.diameter / 2

    @property
    def center(self) -> Point:
        """The geometric centre at the start: `center_offset` behind the centre of rotation."""
        x, y, theta = self.pose
        return x - self.center_offset * cos(theta), y - self.center_offset * sin(theta)

    def _validate(self) -> None:
        if self.drive.max_force > ACCELERATION * self.mass:
            raise wrong(
                "Robot.drive.max_force", self.drive.max_force,
                f"at most {ACCELERATION:g} m/s^2 times the mass, {self.mass:g} kg",
            )  # fmt: skip
        if abs(self.center_offset) > self.radius:
            raise wrong(
                "Robot.center_offset", self.center_offset, f"within the radius, {self.radius:g} m"
            )
        _check_unique("Robot.sensors", [sensor.key for sensor in self.sensors])


def _check_unique(name: str, keys: list[str]) -> None:
    for key, count in Counter(keys).items():
        if count > 1:
            raise InputError(f"{name}: two are called {key!r}; give one another name=...")


class Obstacle(NamedTuple):
    """Something fixed: its outline [m], coefficient of friction and restitution."""

    outline: Outline
    friction: float
    restitution: float


def playback_speed(name: str, value: object) -> float | str:
    """Check a playback speed: a factor of real time, 0 for one step a key press, or "max"."""
    expected = "a factor of real time (1 is real time), 0 for one step a key press, or 'max'"
    if isinstance(value, str) and value == "max":
        return "max"
    factor = real(name, value, expected)
    if not 0 <= factor <= 1e6:
        raise wrong(name, value, expected)
    return factor


def _colors(name: str, value: object) -> tuple[str, ...]:
    if isinstance(value, str) or not isinstance(value, (list, tuple)) or not value:
        raise wrong(name, value, "a list of colours, as ['#0072b2', 'orange']")
    return tuple(color(f"{name}[{i}]", item) for i, item in enumerate(value))


class Animation(Description):
    """How an experiment looks when it is drawn: the Animation fields of the paper's Table 1."""

    grid: bool = flag(default=True, doc="draw the grid")
    show_initial_pose: bool = flag(default=True, doc="draw where the robots started")
    show_real_shape: bool = flag(default=True, doc="draw robots to scale, else as points")
    wake: bool = flag(default=True, doc="draw the paths behind the robots")
    wake_style: str = entry(
        default="-", check=wake_style, doc="line style of the paths, as in Matlab's plot"
    )
    playback_speed: float | str = entry(
        default=1.0,
        check=playback_speed,
        doc="1 is real time, 0 one step a key press, 'max' as fast as it goes",
    )
    base_colors: Sequence[str] = entry(
        default=PALETTE,
        check=_colors,
        doc="the robots' colours, cycled",
    )


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
    stop_time: float = number(default=100.0, low=0, high=1e12, unit="s", doc="the longest duration")
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
        object.__setattr__(self, "_obstacles", self._check_obstacles())
        if isinstance(self.robots, int):
            object.__setattr__(self, "robots", self._circle_of_robots(self.robots))
        taken = {robot.name for robot in self.robots}
        named = tuple(
            robot if robot.name is not None else robot.replace(name=_free_name(i, taken))
            for i, robot in enumerate(self.robots)
        )
        object.__setattr__(self, "robots", named)
        _check_unique("Scenario.robots", [str(robot.name) for robot in named])
        _check_unique("Scenario.addons", [addon.key for addon in self.addons])
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
        from mars2d.geometry import inside_polygon, point_segment_distance

        edges = np.array([[*a, *b] for a, b in edges_of(workspace)])
        corners = np.array(workspace)
        for robot in self.robots:
            x, y = np.array([robot.center[0]]), np.array([robot.center[1]])
            gap = float(point_segment_distance(x[:, None], y[:, None], edges).min())
            inside = bool(inside_polygon(x, y, corners)[0])
            if not inside and gap > 1e-9:
                raise InputError(
                    f"Robot.pose of {robot.name} = {robot.pose}: starts outside the workspace"
                    " (Scenario.workspace, or on_exit='ignore' to let it)"
                )
            if self.on_exit == "wall" and gap < robot.radius - self._overlap(robot):
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

    def _check_obstacles(self) -> tuple[Obstacle, ...]:
        """Return all obstacles, those of the user's own add-ons checked as well."""
        found = [
            Obstacle(outline, addon.friction, addon.restitution)
            for addon in self.addons
            for outline in checks.outlines(f"{type(addon).__name__}.obstacles()", addon.obstacles())
        ]
        if self.on_exit == "wall" and self.workspace is not None:
            found.append(Obstacle(self.workspace, 1.0, 1.0))
        return tuple(found)

    @property
    def surfaces(self) -> tuple[Obstacle, ...]:
        """What stands in the way: the add-ons' obstacles, then the workspace where it is a wall."""
        return self.__dict__["_obstacles"]  # type: ignore[no-any-return]

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
