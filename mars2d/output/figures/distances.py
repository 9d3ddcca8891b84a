"""Clearances, the distances of bodies to each other and to obstacles, and their figure."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import ordinal
from mars2d.core.plane import lines_and_areas
from mars2d.geometry.shapes import Piece
from mars2d.output.figures.contacts import pair_name
from mars2d.output.figures.extent import check_rows
from mars2d.output.figures.legend import Entry
from mars2d.output.figures.panels import (
    caption,
    curve,
    name_curves,
    panels,
    say,
    set_span,
    width_of,
)
from mars2d.output.figures.style import Style, style_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from mars2d.record.rows import Rows
    from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]

MAX_CURVES = 6
"""The most pairs with a curve each; for more, a band is drawn."""

MIN_SPAN = 0.05
"""The least end of the axis, metres: bodies that rest against each other overlap slightly."""

MAX_DISC_GAPS, MAX_PIECE_GAPS = 2e7, 1e6
"""The most distances to compute, between discs and between other shapes; beyond, rows are skipped.
One takes about 20 ns and 2 us."""


@dataclass(frozen=True, eq=False)
class Clearances:
    """The gaps between surfaces over time, metres: 0 in contact, negative in overlap.

    rows: (T',), the rows of the record at which they were computed. pairs: (p, 2), bodies, at least
    one of them a robot. pair: (T', p), the gaps of the pairs. obstacle: (T', n), the gap of each
    robot to the nearest obstacle or wall, or None if there are none.
    """

    rows: NDArray[np.intp]
    pairs: NDArray[np.intp]
    pair: Float
    obstacle: Float | None


def clearances(record: Rows) -> Clearances:
    """Return the clearances of a record: of robots to robots, props and obstacles.

    A clearance is the shortest distance between two outlines. For two discs that overlap, it is
    minus the depth of the overlap; for other shapes it is never less than minus the radii of their
    rounded pieces. Bodies joined by a hinge are left out, since they don't collide. If a run is so
    long that computing all rows would take minutes, only every k-th row is used.
    """
    scenario = record.scenario
    n, bodies = len(scenario.robots), scenario.bodies
    pairs = [
        (a, b)
        for a, b in combinations(range(len(bodies)), 2)
        if a < n and (a, b) not in scenario.joined
    ]
    is_disc = [all(len(p.vertices) == 1 for p in body.shape.pieces) for body in bodies]
    discs = sum(is_disc[a] and is_disc[b] for a, b in pairs)
    obstacles = bool(_surfaces(record))
    others = len(pairs) - discs + (n if obstacles else 0)
    stride = max(1.0, len(record) * discs / MAX_DISC_GAPS, len(record) * others / MAX_PIECE_GAPS)
    rows = np.arange(0, len(record), int(np.ceil(stride)))
    if rows[-1] != len(record) - 1:
        rows = np.append(rows, len(record) - 1)
    placed = _Placed(record, rows)
    gaps = np.empty((len(rows), len(pairs)))
    for k, (a, b) in enumerate(pairs):
        gaps[:, k] = placed.between(a, b)
    to_obstacles = _to_obstacles(record, placed, rows) if obstacles else None
    return Clearances(rows, np.array(pairs, dtype=np.intp).reshape(-1, 2), gaps, to_obstacles)


class _Placed:
    """The convex pieces of each body at its poses over time."""

    def __init__(self, record: Rows, rows: NDArray[np.intp]) -> None:
        """Take the bodies of a record, where they are at some rows."""
        self.pieces = [body.shape.pieces for body in record.scenario.bodies]
        self._poses = np.concatenate([record.pose[rows], record.prop_pose[rows]], axis=2)
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


def _surfaces(record: Rows) -> list[Scenario]:
    """Return the scenarios of a run, changes included, that have obstacles or a wall."""
    scenarios = [record.scenario, *(change.scenario for change in record.changes)]
    return [scenario for scenario in scenarios if scenario.surfaces]


def _to_obstacles(record: Rows, placed: _Placed, rows: NDArray[np.intp]) -> Float:
    """Return the clearance of each robot to its nearest obstacle, (T', n) metres; nan if none."""
    import shapely

    n = len(record.scenario.robots)
    result = np.full((len(rows), n), np.nan)
    changed = sorted({change.row for change in record.changes})
    edges = [0, *(row for row in changed if 0 < row < len(record)), len(record)]
    for begin, end in pairwise(edges):
        scenario = record.scenario_at(begin)
        which = np.flatnonzero((rows >= begin) & (rows < end))
        if not scenario.surfaces or not len(which):
            continue
        solid = lines_and_areas(scenario.obstacles)
        if len(scenario.surfaces) > len(scenario.obstacles):  # the wall stands round the robots
            solid.append(shapely.LinearRing(scenario.surfaces[-1].outline))
        everything = shapely.GeometryCollection(solid)
        shapely.prepare(everything)
        for robot in range(n):
            gaps = [
                shapely.distance(everything, placed.outlines(robot, k)[which]) - piece.radius
                for k, piece in enumerate(placed.pieces[robot])
            ]
            result[which, robot] = np.min(gaps, axis=0)
    return result


# -- the figure -----------------------------------------------------------------------------------


def plot_distances(record: Rows, ax: Axes | None = None, *, style: str = "screen") -> Axes:
    """Draw clearances over time: the distances between surfaces, 0 in contact.

    Up to six pairs (of robots, or a robot and a prop) have a curve each. For more, the figure shows
    the minimum, mean and maximum over the robots of the clearance to their nearest body. One more
    curve shows the clearance of the robot nearest to an obstacle or wall. For the definition see
    `clearances`.

    ax: matplotlib axes to draw on; by default those of a new figure. style: as in `Record.plot`.
    Returns the axes. Raises InputError for a record without rows.
    """
    look = style_of(style)
    check_rows(record)
    found = clearances(record)
    few, time = len(found.pairs) <= MAX_CURVES, record.time[found.rows]
    with look.fonts():
        (ax,) = panels(record, None if ax is None else [ax], ["clearance"], look, [2.2])
        caption(ax, "clearance", "m", look)
        curves = _pair_curves if few else _band
        entries, drawn = curves(ax, record, found, look)
        if found.obstacle is not None:
            drawn.append(_least(found.obstacle))
            whose = "nearest robot" if len(record.scenario.robots) > 1 else "robot"
            dash = "-." if few and look.greys else "--"
            grey = "#808080" if look.greys else look.muted
            entries.append(Entry(f"{whose} to an obstacle", grey, dash, width_of(1, look)))
        for entry, values in zip(entries[-len(drawn) :], drawn, strict=True):
            level = 3.0 if entry.dash == "-" else 3.1
            curve(ax, time, values, entry, many=len(drawn), level=level)
        if drawn:
            every = np.concatenate([np.ravel(each) for each in (*drawn, found.pair)])
            high = max(values[np.isfinite(values)].max(initial=MIN_SPAN) for values in drawn)
            set_span(ax, every[np.isfinite(every)].min(initial=0.0), high)
            ax.axhline(0.0, color=look.ink, linewidth=0.8 * look.stroke, zorder=2.5)
        else:
            say(ax, "no distances: there is one body and no obstacle", look)
        title = record.scenario.title
        if len(found.rows) > 1 and found.rows[1] > 1:
            title += f", every {ordinal(int(found.rows[1]))} row"
        name_curves(ax, title, entries, look)
    return ax


def _least(gaps: Float) -> Float:
    """Return the minimum of each row, nan for a row without numbers."""
    least = np.where(np.isnan(gaps), np.inf, gaps).min(axis=1)
    return np.where(np.isfinite(least), least, np.nan)


def _pair_curves(
    ax: Axes,  # noqa: ARG001
    record: Rows,
    found: Clearances,
    look: Style,
) -> tuple[list[Entry], list[Float]]:
    """Return a curve for each pair."""
    entries = []
    for k, (a, b) in enumerate(found.pairs.tolist()):
        color, dash = look.curve(k)
        if not look.greys and k % 2:  # so that curves that coincide can both be seen
            dash = "--"
        name = pair_name(record.scenario, a, b)
        entries.append(Entry(name, color, dash, width_of(1, look)))
    return entries, list(found.pair.T)


def nearest_body(found: Clearances, robots: int) -> Float:
    """Return the clearance of each robot to its nearest body, (T', n) metres."""
    nearest = np.full((len(found.rows), robots), np.inf)
    for k, (a, b) in enumerate(found.pairs.tolist()):
        for body in (a, b):
            if body < robots:
                np.minimum(nearest[:, body], found.pair[:, k], out=nearest[:, body])
    return np.where(np.isfinite(nearest), nearest, np.nan)


def _band(
    ax: Axes, record: Rows, found: Clearances, look: Style
) -> tuple[list[Entry], list[Float]]:
    """Draw a band from minimum to maximum; return the legend, and the minimum and the mean."""
    nearest = nearest_body(found, len(record.scenario.robots))
    low, mean, high = nearest.min(axis=1), nearest.mean(axis=1), nearest.max(axis=1)
    color = look.curve(0)[0]
    pale = "#e0e0e0" if look.greys else "#cfe3f1"
    ax.fill_between(record.time[found.rows], low, high, color=pale, linewidth=0, zorder=2)
    width = width_of(1, look)
    entries = [
        Entry("robots to their nearest body", pale, "-", 5 * look.stroke),
        Entry("least of them", color, "-", width),
        Entry("mean of them", color, ":", width),
    ]
    return entries, [low, mean]
