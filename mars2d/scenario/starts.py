"""Starts: bodies must start within the workspace, off obstacles, and apart."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from mars2d.bodies.rigid import Rigid
from mars2d.core.arithmetic import norm, norms
from mars2d.core.errors import InputError, shown
from mars2d.core.plane import Outline, distance_to_ring, lines_and_areas, outside_polygon

if TYPE_CHECKING:
    import shapely

SMOOTH = 64
"""Corners per quarter of a circle, for a disc that is compared with a polygon."""


def check_in_workspace(robots: Sequence[Rigid], workspace: Outline) -> None:
    """Refuse robots whose pose lies outside the workspace."""
    x, y, _ = np.array([robot.pose for robot in robots]).T
    for i in np.flatnonzero(outside_polygon(x, y, np.array(workspace))).tolist():
        raise InputError(
            f"{_pose(robots[i])}: starts outside the workspace"
            " (Scenario.workspace, or on_exit='ignore' to let it)"
        )


def check_off_walls(bodies: Sequence[Rigid], workspace: Outline, overlap: float) -> None:
    """Refuse bodies that start in or beyond the wall round the workspace."""
    corners = np.array(workspace)
    x, y = np.array([body.bound[0] for body in bodies]).T
    gaps, outside = distance_to_ring(x, y, corners), outside_polygon(x, y, corners)
    for body, gap, out in zip(bodies, gaps.tolist(), outside.tolist(), strict=True):
        if body.is_disc:
            free = not out and gap >= body.bound[1] - _allowed(body, overlap)
        else:
            import shapely

            free = shapely.Polygon(workspace).contains(_core(body, overlap))
        if not free:
            size = f"; its radius is {body.bound[1]:g} m" if body.is_disc else ""
            raise InputError(f"{_pose(body)}: starts in the workspace's wall, or outside{size}")


def check_off_obstacles(
    bodies: Sequence[Rigid], outlines: Sequence[Outline], overlap: float
) -> None:
    """Refuse bodies that start inside an obstacle, or cut into one."""
    for body in bodies:
        for k in cut_by(body, tuple(outlines), overlap):
            x, y = np.array([body.bound[0]]).T
            solid = len(outlines[k]) > 2 and not outside_polygon(x, y, np.array(outlines[k]))[0]
            hint = " (if it is a room, draw it as walls of two points)" if solid else ""
            raise InputError(
                f"{_pose(body)}: starts {'inside' if solid else 'in contact with'} obstacle {k}, "
                f"{shown(outlines[k], 80)}{hint}"
            )


def cut_by(body: Rigid, outlines: tuple[Outline, ...], overlap: float) -> list[int]:
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


def check_apart(
    bodies: Sequence[Rigid], overlap: float, joined: Collection[tuple[int, int]] = ()
) -> None:
    """Refuse bodies that start inside each other, unless they share a hinge.

    joined: pairs (i, j), i < j, of bodies that may overlap.
    """
    centers = np.array([body.bound[0] for body in bodies])
    radii = np.array([body.bound[1] for body in bodies])
    # Sweep along the longer side: who comes later than the reach is too far away.
    along = centers[:, np.argmax(np.ptp(centers, axis=0))]
    order = np.argsort(along, kind="stable")
    ends = np.searchsorted(along[order], along[order] + 2 * radii.max(), side="right")
    for place, i in enumerate(order):
        others = order[place + 1 : ends[place]]
        gaps = norms(*(centers[others] - centers[i]).T) - radii[others] - radii[i]
        for k in np.flatnonzero(gaps < 0):
            a, b = sorted((int(i), int(others[k])))
            if (a, b) not in joined and (deep := depth(bodies[a], bodies[b], overlap)):
                raise InputError(
                    f"{_pose(bodies[a])} and of {bodies[b].name} = {bodies[b].pose}: "
                    f"they start {deep:.3g} m inside each other"
                )


def depth(a: Rigid, b: Rigid, overlap: float) -> float:
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


def _pose(body: Rigid) -> str:
    return f"{body.kind}.pose of {body.name} = {body.pose}"
