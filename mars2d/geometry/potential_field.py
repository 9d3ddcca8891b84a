"""Artificial potential fields: the goal attracts, obstacles repel."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property, lru_cache
from math import fsum, inf
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from mars2d.core import checks
from mars2d.core.arithmetic import norm, norms
from mars2d.core.description import Description, entry, number
from mars2d.core.plane import Outline, Point

Float = NDArray[np.float64]
Discs = Iterable[tuple[float, float, float]]

MIN_CLEARANCE = 1e-3
"""At smaller distances from an obstacle the repulsion grows no further, metres."""

GRID = 1e-6
"""Obstacles as near to each other as this touch, metres."""

STEP, MIN_STEP = 0.02, 1e-4
"""The first step of a descent, and the step at which it has come to rest, metres."""

MAX_STEPS = 100_000
"""The largest number of steps of a descent."""

STRIDE, MIN_PROGRESS = 25, 0.2
"""A descent circles if this number of steps leads less than this share of their length."""


@runtime_checkable
class Goals(Protocol):
    """Tells the goals of robots: the add-on Waypoints."""

    routes: Sequence[Sequence[Point]]
    tolerance: float

    @property
    def key(self) -> str:
        """The add-on's name in ``world.addons``."""

    def goal(self, robot: int, frame: Any = None) -> Point:
        """Return a robot's goal now, or at a frame."""


class Potential(Description):
    """The artificial potential of a point q among obstacles; each call gives the goal.

    >>> field = Potential([[(2, -1), (2, 1)]], reach=0.5)
    >>> field.force((0, 0), goal=(5, 0))
    (0.5, 0.0)

    Let d be the distance to the goal, and rho that from the robot's rim to an edge of the
    obstacles. U is attraction d^2 / 2, continued by its tangent from d = far on, plus repulsion
    (1/rho - 1/reach)^2 / 2 for each edge with rho < reach. The force is F = -grad U: attraction
    min(d, far) towards the goal, and repulsion (1/rho - 1/reach) / rho^2 away from the nearest
    point of each near edge. So the force has no jumps. The edges are those of the obstacles'
    union: overlapping obstacles, and those drawn in pieces, count once.

    Source: Khatib, Int. Journal of Robotics Research 5(1), 1986; with the attraction of constant
    length far away of Choset et al., Principles of Robot Motion (2005), section 4.1.
    """

    obstacles: Sequence[Outline] = entry(
        check=checks.outlines, unit="m", kw_only=False, doc="as `world.obstacles` has them"
    )
    attraction: float = number(default=1.0, above=0, high=1e6, unit="1/s", doc="k_p")
    far: float = number(
        default=0.5, above=0, high=1e6, unit="m", doc="d*: the attraction grows up to here"
    )
    repulsion: float = number(default=0.01, low=0, high=1e6, unit="m^4/s", doc="eta")
    reach: float = number(
        default=0.6, above=0, high=1e6, unit="m", doc="rho_0: what is farther does not repel"
    )
    radius: float = number(
        default=0.0, low=0, high=1e6, unit="m", doc="of the robot, as far as obstacles are nearer"
    )

    @cached_property
    def _area(self) -> Any:
        """The union of all solid obstacles, as a geometry of shapely."""
        import shapely

        solid = [shapely.Polygon(outline) for outline in self.obstacles if len(outline) > 2]
        area = shapely.union_all(solid, grid_size=GRID)
        shapely.prepare(area)
        return area

    @cached_property
    def _edges(self) -> Float:
        """The edges (5, m) outside of solid obstacles: x, y, along x, along y, length^2."""
        import shapely

        area = self._area
        walls = [shapely.LineString(outline) for outline in self.obstacles if len(outline) == 2]
        rims = shapely.simplify(shapely.normalize(area), 0.0).boundary
        free = shapely.line_merge(shapely.difference(shapely.union_all(walls), area))
        lines = [*shapely.get_parts(rims), *shapely.get_parts(shapely.simplify(free, 0.0))]
        pairs = [np.hstack([c[:-1], c[1:]]) for c in map(shapely.get_coordinates, lines)]
        x1, y1, x2, y2 = np.vstack([np.empty((0, 4)), *pairs]).T
        ex, ey = x2 - x1, y2 - y1
        return np.array([x1, y1, ex, ey, ex * ex + ey * ey])

    def _near(self, x: float, y: float, discs: Discs = ()) -> Discs:
        """Yield rho and the unit vector away from the nearest point, for near edges and discs."""
        x1, y1, ex, ey, square = self._edges
        along = np.clip(((x - x1) * ex + (y - y1) * ey) / square, 0.0, 1.0)
        dx, dy = x - x1 - along * ex, y - y1 - along * ey
        distance = norms(dx, dy)
        near = np.flatnonzero(distance < self.reach + self.radius)
        for d, ax, ay in np.array([distance, dx, dy])[:, near].T.tolist():
            away = (ax / d, ay / d) if d > 0 else (0.0, 0.0)
            yield max(d - self.radius, MIN_CLEARANCE), *away
        for cx, cy, radius in discs:
            d = norm(x - cx, y - cy)
            if 0 < d < self.reach + self.radius + radius:
                rho = max(d - self.radius - radius, MIN_CLEARANCE)
                yield rho, (x - cx) / d, (y - cy) / d

    def force(
        self, at: Sequence[float] | Float, goal: Sequence[float] | Float, discs: Discs = ()
    ) -> Point:
        """Return the force F = -grad U (Fx, Fy) at (x, y) [m], in m/s: a desired velocity.

        discs: (x, y, radius) [m] of what repels like an edge, such as the other robots.
        """
        (x, y), (gx, gy) = map(float, at), map(float, goal)
        distance = norm(gx - x, gy - y)
        pull = self.attraction * min(1.0, self.far / distance) if distance else 0.0
        fx, fy = [pull * (gx - x)], [pull * (gy - y)]
        for rho, ux, uy in self._near(x, y, discs):
            push = self.repulsion * (1 / rho - 1 / self.reach) / (rho * rho)
            fx.append(push * ux)
            fy.append(push * uy)
        return fsum(fx), fsum(fy)

    def potential(self, at: Sequence[float] | Float, goal: Sequence[float] | Float) -> float:
        """Return U [m^2/s] at (x, y) [m]; infinite where the robot would touch an obstacle."""
        (x, y), (gx, gy) = map(float, at), map(float, goal)
        if not self.free((x, y)):
            return inf
        distance, far = norm(gx - x, gy - y), self.far
        square = distance * distance if distance <= far else far * (2 * distance - far)
        gaps = (1 / rho - 1 / self.reach for rho, _, _ in self._near(x, y))
        terms = [self.repulsion * gap * gap for gap in gaps]
        return fsum([self.attraction * square, *terms]) / 2

    def free(self, at: Sequence[float] | Float) -> bool:
        """Return whether a robot at (x, y) neither touches an obstacle nor lies in one."""
        import shapely

        x, y = map(float, at)
        touched = any(rho <= MIN_CLEARANCE for rho, _, _ in self._near(x, y))
        return not (touched or shapely.contains_xy(self._area, x, y))

    @lru_cache(maxsize=8)  # noqa: B019 - a description is small, and the same for a whole film
    def arrows(
        self, goal: Point, bounds: tuple[float, float, float, float], spacing: float
    ) -> tuple[tuple[Point, Point], ...]:
        """Return points (x, y) of a grid, each with the force's direction there.

        goal: (x, y); bounds: (xmin, xmax, ymin, ymax) of the grid; spacing: between its points, all
        in metres. Points where a robot has no room or the force is zero are left out. The result
        is cached, since each frame of a film asks for it.
        """
        xmin, xmax, ymin, ymax = bounds
        found: list[tuple[Point, Point]] = []
        for x in np.arange(xmin + spacing / 2, xmax, spacing).tolist():
            for y in np.arange(ymin + spacing / 2, ymax, spacing).tolist():
                fx, fy = self.force((x, y), goal)
                size = norm(fx, fy)
                if size > 0 and self.free((x, y)):
                    found.append(((x, y), (fx / size, fy / size)))
        return tuple(found)

    def descend(self, start: Sequence[float], goal: Sequence[float], tolerance: float) -> Point:
        """Return the end of a descent along the force in small steps.

        This is a point nearer to the goal than `tolerance` [m], or a local minimum of the
        potential, where the force is zero; or a saddle, for a descent exactly along its ridge.
        Headings and speeds don't matter.
        """
        (x, y), (gx, gy) = map(float, start), map(float, goal)
        step, count, before = STEP, 0, (x, y)
        while norm(gx - x, gy - y) > tolerance and count < MAX_STEPS:
            fx, fy = self.force((x, y), (gx, gy))
            size = norm(fx, fy)
            if size == 0.0:
                break
            x, y = x + step * fx / size, y + step * fy / size
            count += 1
            if count % STRIDE == 0:
                if norm(x - before[0], y - before[1]) < MIN_PROGRESS * STRIDE * step:
                    step /= 2
                    if step < MIN_STEP:
                        return self.balance((x, y), (gx, gy))
                before = x, y
        return x, y

    def balance(self, near: Sequence[float], goal: Sequence[float]) -> Point:
        """Return the point near (x, y) at which the force is zero, by Powell's hybrid method.

        If there is no such point, for example at a kink of the potential, return (x, y) itself.
        """
        from scipy.optimize import root

        given = float(near[0]), float(near[1])

        def force(at: Any) -> Point:
            return self.force(at, goal)

        found = root(force, given, tol=1e-12)
        x, y = map(float, found.x)
        close = norm(x - given[0], y - given[1]) < STEP
        return (x, y) if close and norm(*force((x, y))) < 1e-6 else given

    @lru_cache(maxsize=64)  # noqa: B019 - see arrows
    def lead(self, start: Point, route: tuple[Point, ...], tolerance: float) -> tuple[int, Point]:
        """Return the number of points of a route reached by descending to one after the other.

        The second value is the end of the way: near the last point, or at a local minimum before.
        The result is cached.
        """
        for k, goal in enumerate(route):
            start = self.descend(start, goal, tolerance)
            if norm(goal[0] - start[0], goal[1] - start[1]) > tolerance:
                return k, start
        return len(route), start
