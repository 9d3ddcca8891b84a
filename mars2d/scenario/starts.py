"""Starts: bodies must start within the workspace, off obstacles, and apart."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.rigid import Rigid
from mars2d.core.arithmetic import norm, norms
from mars2d.core.errors import shown
from mars2d.core.plane import Outline, distance_to_ring, lines_and_areas, outside_polygon

if TYPE_CHECKING:
    import shapely

    from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]

SMOOTH = 64
"""Corners per quarter of a circle, for a disc that is compared with a polygon."""


class Fault(NamedTuple):
    """A body that can't start where it is.

    kind: it is "outside" the workspace, in its "wall", in an "obstacle", or it would "overlap"
    another. body: its index in `Scenario.bodies`. other: the index of the obstacle or of the other
    body. depth: of the overlap, about, metres. inside: whether its middle lies in the obstacle.
    """

    kind: Literal["outside", "wall", "obstacle", "overlap"]
    body: int
    other: int = -1
    depth: float = 0.0
    inside: bool = False

    def told(self, scenario: Scenario) -> str:
        """Return it in words, for who wrote the scenario."""
        body, outlines = scenario.bodies[self.body], scenario.obstacles
        where = f"{body.kind}.pose of {body.name} = {body.pose}"
        if self.kind == "outside":
            hint = "(Scenario.workspace, or on_exit='ignore' to let it)"
            return f"{where}: starts outside the workspace {hint}"
        if self.kind == "wall":
            size = f"; its radius is {body.bound[1]:g} m" if body.is_disc else ""
            return f"{where}: starts in the workspace's wall, or outside{size}"
        if self.kind == "obstacle":
            hint = " (if it is a room, draw it as walls of two points)" if self.inside else ""
            how = "inside" if self.inside else "in contact with"
            what = f"obstacle {self.other}, {shown(outlines[self.other], 80)}"
            return f"{where}: starts {how} {what}{hint}"
        other = scenario.bodies[self.other]
        both = f"{where} and of {other.name} = {other.pose}"
        return f"{both}: they start {self.depth:.3g} m inside each other"


def faults(
    scenario: Scenario, bodies: Sequence[Rigid], moved: int | None = None
) -> Iterator[Fault]:
    """Find the bodies that start outside the workspace, in an obstacle, or in each other.

    bodies: those of the scenario, perhaps at other poses. moved: the only one that is judged.
    """
    outlines, overlap = scenario.obstacles, scenario.max_overlap
    chosen = list(range(len(bodies))) if moved is None else [moved]
    if scenario.workspace is not None and scenario.on_exit != "ignore":
        corners = np.array(scenario.workspace)
        robots = [i for i in chosen if i < len(scenario.robots)]
        places = np.array([bodies[i].pose[:2] for i in robots]).reshape(-1, 2)
        for k in np.flatnonzero(outside_polygon(places[:, 0], places[:, 1], corners)).tolist():
            yield Fault("outside", robots[k])
        if scenario.on_exit == "wall" and scenario.physics != "ideal":
            yield from (Fault("wall", i) for i in _in_wall(bodies, chosen, corners, overlap))
    if scenario.physics == "ideal":  # bodies go through each other, and all else
        return
    for i in chosen:
        for k in _cut_by(bodies[i], outlines, overlap)[:1]:
            x, y = np.array([bodies[i].bound[0]]).T
            solid = len(outlines[k]) > 2 and not outside_polygon(x, y, np.array(outlines[k]))[0]
            yield Fault("obstacle", i, k, inside=bool(solid))
    for i, k in _near(bodies, moved):
        if (i, k) not in scenario.joined and (deep := _depth(bodies[i], bodies[k], overlap)):
            yield Fault("overlap", i, k, deep)


def _in_wall(
    bodies: Sequence[Rigid], chosen: Sequence[int], corners: Float, overlap: float
) -> Iterator[int]:
    """Yield the bodies that lie in or beyond the wall round the workspace."""
    x, y = np.array([bodies[i].bound[0] for i in chosen]).T
    gaps, outside = distance_to_ring(x, y, corners), outside_polygon(x, y, corners)
    for i, gap, out in zip(chosen, gaps.tolist(), outside.tolist(), strict=True):
        body = bodies[i]
        if body.is_disc:
            free = not out and gap >= body.bound[1] - _allowed(body, overlap)
        else:
            import shapely

            free = shapely.Polygon(corners).contains(_core(body, overlap))
        if not free:
            yield i


def _near(bodies: Sequence[Rigid], moved: int | None) -> Iterator[tuple[int, int]]:
    """Yield the pairs (i, k), i < k, of bodies whose circles overlap; moved: as for `faults`."""
    centers = np.array([body.bound[0] for body in bodies])
    radii = np.array([body.bound[1] for body in bodies])
    # Sweep along the longer side: who comes later than the reach is too far away.
    along = centers[:, np.argmax(np.ptp(centers, axis=0))]
    order = np.argsort(along, kind="stable")
    ends = np.searchsorted(along[order], along[order] + 2 * radii.max(), side="right")
    for place, i in enumerate(order) if moved is None else [(-1, moved)]:
        others = order[place + 1 : ends[place]] if moved is None else np.delete(order, order == i)
        gaps = norms(*(centers[others] - centers[i]).T) - radii[others] - radii[i]
        for k in np.flatnonzero(gaps < 0):
            yield min(int(i), int(others[k])), max(int(i), int(others[k]))


def _cut_by(body: Rigid, outlines: tuple[Outline, ...], overlap: float) -> list[int]:
    """Return the obstacles, by index, that a body cuts deeper than an overlap, metres."""
    if not outlines:
        return []
    import shapely

    middle, radius = body.bound
    if body.is_disc:
        room = radius - _allowed(body, overlap)
        found = _tree(outlines).query(shapely.Point(middle), "dwithin", room)
    else:
        found = _tree(outlines).query(_core(body, overlap), "intersects")
    return sorted(found.tolist())


def _depth(a: Rigid, b: Rigid, overlap: float) -> float:
    """Return about how deep two bodies overlap, metres; 0 if no deeper than is allowed."""
    if a.is_disc and b.is_disc:
        ((ax, ay), one), ((bx, by), other) = a.bound, b.bound
        deep = one + other - norm(bx - ax, by - ay)
        return deep if deep > min(_allowed(a, overlap), _allowed(b, overlap)) else 0.0
    import shapely

    common = shapely.intersection(_core(a, overlap), footprint(b))
    if common.is_empty:
        return 0.0
    return float(max(overlap, 2 * shapely.maximum_inscribed_circle(common).length))


def footprint(body: Rigid) -> shapely.Geometry:
    """Return the ground that a body covers at the start."""
    import shapely

    return shapely.union_all(
        [
            shapely.Point(body.to_world(points[0])).buffer(radius, quad_segs=SMOOTH)
            if len(points) == 1
            else shapely.Polygon([body.to_world(point) for point in points])
            for points, radius in body.shape.rims
        ]
    )


@lru_cache(maxsize=4)
def _tree(outlines: tuple[Outline, ...]) -> shapely.STRtree:
    import shapely

    return shapely.STRtree(lines_and_areas(outlines))


def _core(body: Rigid, overlap: float) -> shapely.Geometry:
    """Return a body's ground, less the rim that may overlap."""
    return footprint(body).buffer(-_allowed(body, overlap), join_style="mitre")


def _allowed(body: Rigid, overlap: float) -> float:
    """Return how deep a body may start in something, metres."""
    return min(overlap, body.shape.thickness / 8)
