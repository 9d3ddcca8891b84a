"""Clearances, the distances of bodies to each other and to obstacles, and their figure."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.plane import lines_and_areas
from mars2d.geometry.shapes import Piece
from mars2d.output.figures.contacts import pair_name
from mars2d.output.figures.extent import check_rows
from mars2d.output.figures.panels import name_curves, panels, say
from mars2d.output.figures.signals import draw_signals
from mars2d.output.figures.style import INK
from mars2d.output.signals import Signal

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from mars2d.record.rows import Rows

Float = NDArray[np.float64]

MAX_CURVES = 6
"""The most pairs with a curve each; for more, a band is drawn."""


@dataclass(frozen=True, eq=False)
class Clearances:
    """The gaps between surfaces over time, metres: 0 in contact, negative in overlap.

    pairs: (p, 2), bodies, at least one of them a robot. pair: (T, p), their gaps. obstacle: (T, n),
    the gap of each robot to the nearest obstacle or wall, or None if there are none.
    """

    pairs: NDArray[np.intp]
    pair: Float
    obstacle: Float | None


def clearances(record: Rows) -> Clearances:
    """Return the clearances of a record: of robots to robots, props and obstacles.

    A clearance is the shortest distance between two outlines. For two discs that overlap, it is
    minus the depth of the overlap; for other shapes it is never less than minus the radii of their
    rounded pieces. Bodies joined by a hinge are left out, since they don't collide. A gap takes
    about 20 ns between discs and 2 us between other shapes.
    """
    n, bodies = len(record.scenario.robots), record.scenario.bodies
    pairs = [
        (a, b)
        for a, b in combinations(range(len(bodies)), 2)
        if a < n and (a, b) not in record.scenario.joined
    ]
    scenarios = [record.scenario, *(change.scenario for change in record.changes)]
    obstacles = any(scenario.surfaces for scenario in scenarios)
    placed = _Placed(record)
    gaps = np.empty((len(record), len(pairs)))
    for k, (a, b) in enumerate(pairs):
        gaps[:, k] = placed.between(a, b)
    to_obstacles = _to_obstacles(record, placed) if obstacles else None
    return Clearances(np.array(pairs, dtype=np.intp).reshape(-1, 2), gaps, to_obstacles)


class _Placed:
    """The convex pieces of each body at its poses over time."""

    def __init__(self, record: Rows) -> None:
        """Take the bodies of a record."""
        self.pieces = [body.shape.pieces for body in record.scenario.bodies]
        self._poses = record.all_poses
        self._outlines: dict[tuple[int, int], Any] = {}

    def _points(self, body: int, piece: Piece) -> Float:
        """Return the positions of a piece's vertices, (T, v, 2) metres."""
        x, y, theta = self._poses[:, :, body, None].swapaxes(0, 1)
        c, s = np.cos(theta), np.sin(theta)
        ahead, left = np.array(piece.vertices).T
        return np.stack([x + c * ahead - s * left, y + s * ahead + c * left], axis=2)

    def outlines(self, body: int, k: int) -> Any:
        """Return a piece of a body as shapely geometries, (T,), without its radius."""
        import shapely

        if (body, k) not in self._outlines:
            points = self._points(body, self.pieces[body][k])
            disc = points.shape[1] == 1
            made = shapely.points(points[:, 0]) if disc else shapely.polygons(points)
            self._outlines[body, k] = made
        return self._outlines[body, k]

    def between(self, a: int, b: int) -> Float:
        """Return the clearance of two bodies, (T,) metres."""
        import shapely

        gaps = []
        for i, one in enumerate(self.pieces[a]):
            for j, other in enumerate(self.pieces[b]):
                if len(one.vertices) == len(other.vertices) == 1:  # a hundred times as fast
                    apart = (self._points(a, one) - self._points(b, other))[:, 0]
                    far = np.hypot(apart[:, 0], apart[:, 1])
                else:
                    far = shapely.distance(self.outlines(a, i), self.outlines(b, j))
                gaps.append(far - one.radius - other.radius)
        return np.asarray(np.min(gaps, axis=0))


def _to_obstacles(record: Rows, placed: _Placed) -> Float:
    """Return the clearance of each robot to its nearest obstacle, (T, n) metres; nan if none."""
    import shapely

    n = len(record.scenario.robots)
    result = np.full((len(record), n), np.nan)
    changed = sorted({change.row for change in record.changes})
    edges = [0, *(row for row in changed if 0 < row < len(record)), len(record)]
    for begin, end in pairwise(edges):
        scenario = record.scenario_at(begin)
        if not scenario.surfaces:
            continue
        solid = lines_and_areas(scenario.obstacles)
        if len(scenario.surfaces) > len(scenario.obstacles):  # the wall stands round the robots
            solid.append(shapely.LinearRing(scenario.surfaces[-1].outline))
        everything = shapely.GeometryCollection(solid)
        shapely.prepare(everything)
        for robot in range(n):
            gaps = [
                shapely.distance(everything, placed.outlines(robot, k)[begin:end]) - piece.radius
                for k, piece in enumerate(placed.pieces[robot])
            ]
            result[begin:end, robot] = np.min(gaps, axis=0)
    return result


# -- the figure -----------------------------------------------------------------------------------


def plot_distances(record: Rows, ax: Axes | None = None) -> Axes:
    """Draw clearances over time: the distances between surfaces, 0 in contact.

    Up to six pairs (of robots, or a robot and a prop) have a curve each. For more, the figure shows
    the least, mean and greatest over the robots of the clearance to their nearest body. One more
    curve shows the clearance of the robot nearest to an obstacle or wall. For the definition see
    `clearances`.

    ax: matplotlib axes to draw on; by default those of a new figure.
    Returns the axes. Raises InputError for a record without rows.
    """
    check_rows(record)
    found, scenario = clearances(record), record.scenario
    drawn: dict[str, Float] = {}
    if 0 < len(found.pairs) <= MAX_CURVES:
        names = [pair_name(scenario, a, b) for a, b in found.pairs.tolist()]
        drawn = dict(zip(names, found.pair.T, strict=True))
    elif len(found.pairs):
        nearest = nearest_body(found, len(scenario.robots))
        for word, of in (("least", np.min), ("mean", np.mean), ("most", np.max)):
            drawn[f"to the nearest body, {word}"] = of(nearest, axis=1)
    if found.obstacle is not None:
        whose = "nearest robot" if len(scenario.robots) > 1 else "robot"
        drawn[f"{whose} to an obstacle"] = np.fmin.reduce(found.obstacle, axis=1)
    (ax,) = panels(record, None if ax is None else [ax], ["clearance"], [2.2])
    if drawn:
        values = np.stack(list(drawn.values()), axis=1)
        signal = Signal("clearance", "m", values, (), curves=tuple(drawn))
        draw_signals(record, [signal], [ax])
        ax.axhline(0.0, color=INK, linewidth=0.8, zorder=2.5)
    else:
        say(ax, "no distances: there is one body and no obstacle")
        name_curves(ax, scenario.title, [])
    return ax


def nearest_body(found: Clearances, robots: int) -> Float:
    """Return the clearance of each robot to its nearest body, (T, n) metres."""
    nearest = np.full((len(found.pair), robots), np.inf)
    for k, (a, b) in enumerate(found.pairs.tolist()):
        for body in (a, b):
            if body < robots:
                np.minimum(nearest[:, body], found.pair[:, k], out=nearest[:, body])
    return np.where(np.isfinite(nearest), nearest, np.nan)
