"""The artificial potential field of an experiment: waypoints attract, all else repels."""

from __future__ import annotations

from functools import cached_property, lru_cache

from mars2d.addons.base import Addon
from mars2d.core.description import number
from mars2d.core.errors import InputError
from mars2d.core.interfaces import FrameLike, ScenarioLike, WorldLike
from mars2d.core.plane import Point
from mars2d.core.scene import THEORY, Scene, faded
from mars2d.geometry.potential_field import Goals, Potential

CROSS = 0.4
"""Half the width of a cross at a local minimum, metres."""


class PotentialField(Addon):
    """A potential in which each robot's next waypoint attracts it; obstacles and robots repel.

    >>> PotentialField(reach=0.5).reach
    0.5

    Laws ask ``world.addons.potential_field.force(robot)``. Obstacles are those of the scenario,
    goals those of the add-on Waypoints; `of` returns their `Potential`, `plan` predicts where it
    leads a robot that meets no other. The theory that is drawn is the direction of the force on the
    robot of the last route, and crosses at the local minima in which robots are caught.

    Source: Khatib, Int. Journal of Robotics Research 5(1), 1986.
    """

    attraction: float = number(
        default=1.0, above=0, high=1e6, unit="1/s", doc="k_p, the gain of the attraction"
    )
    far: float = number(
        default=0.5, above=0, high=1e6, unit="m", doc="d*: attraction grows up to this distance"
    )
    repulsion: float = number(
        default=0.01, low=0, high=1e6, unit="m^4/s", doc="eta, of each edge of an obstacle"
    )
    reach: float = number(
        default=0.6, above=0, high=1e6, unit="m", doc="rho_0: edges nearer to a robot's rim repel"
    )
    spacing: float = number(
        default=1.0, low=0.1, high=1e6, unit="m", doc="the spacing of the drawn grid"
    )

    def of(self, scenario: ScenarioLike) -> Potential:
        """Return the potential of a scenario, for robots as large as its largest."""
        radius = max(robot.radius for robot in scenario.robots)
        gains = {name: getattr(self, name) for name in ("attraction", "far", "repulsion", "reach")}
        return _potential(scenario.obstacles, radius=radius, **gains)

    def plan(self, scenario: ScenarioLike) -> tuple[tuple[int, Point], ...]:
        """Return for each route the number of its points that the field leads to, and its end.

        The end is the last point, or a local minimum before it, (x, y) [m]. See `Potential.lead`.
        """
        field, goals = self.of(scenario), _goals(scenario)
        starts = [robot.pose[:2] for robot in scenario.robots]
        return tuple(
            field.lead(start, tuple(route), goals.tolerance)
            for start, route in zip(starts, goals.routes, strict=False)
        )

    def force(self, robot: int) -> Point:
        """Return the force (Fx, Fy) [m/s] on a robot, by its index, where it and the others are.

        Raises InputError where there is no add-on Waypoints, LawError for one without a waypoint.
        """
        world = self.__dict__.get("_world")
        if world is None:
            raise InputError(
                "PotentialField.force is that of a world: world.addons.potential_field"
            )
        radii = [each.radius for each in world.scenario.robots]
        discs = list(zip(*world.position.tolist(), radii, strict=True))
        x, y, _ = discs.pop(robot)
        return self._field.force((x, y), self._live_goals.goal(robot), discs)

    def on_start(self, world: WorldLike) -> None:
        """Take the world and its obstacles."""
        self._world, self._field = world, self.of(world.scenario)

    @cached_property
    def _live_goals(self) -> Goals:
        goals: Goals = getattr(self._world.addons, _goals(self._world.scenario).key)
        return goals

    def theory(self, scene: Scene, frame: FrameLike) -> None:
        """Draw the direction of the force on one robot, and crosses where robots will be caught."""
        scenario = frame.scenario
        if not any(isinstance(addon, Goals) for addon in scenario.addons):
            return
        goals = _goals(scenario)
        last, arrow = len(goals.routes) - 1, 0.3 * self.spacing
        field, goal = self.of(scenario), goals.goal(last, frame) if goals.routes[last] else None
        for (x, y), (ux, uy) in field.arrows(goal, scenario.bounds, self.spacing) if goal else ():
            tail, tip = (x - arrow * ux, y - arrow * uy), (x + arrow * ux, y + arrow * uy)
            scene.arrow(tail, tip, fill=faded(THEORY, 0.45), width=1.0)
        for route, (reached, end) in zip(goals.routes, self.plan(scenario), strict=True):
            if reached < len(route):
                scene.cross(end, CROSS, stroke="#ffffff", width=4.5)
                scene.cross(end, CROSS, stroke=THEORY, width=2.5)


_potential = lru_cache(maxsize=8)(Potential)
"""The same potential for the same scenario, since it caches its arrows."""


def _goals(scenario: ScenarioLike) -> Goals:
    """Return the add-on that holds the goals."""
    found = next((addon for addon in scenario.addons if isinstance(addon, Goals)), None)
    if found is None:
        raise InputError("PotentialField needs goals: add Waypoints([...]) to Scenario.addons")
    return found
