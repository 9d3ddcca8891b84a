"""Whether a body may be put somewhere: off obstacles, walls and other bodies."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.rigid import Rigid
from mars2d.core.plane import Outline, lines_and_areas, outside_polygon
from mars2d.scenario.scenario import Scenario
from mars2d.scenario.starts import footprint

__all__ = ["obstruction"]

Float = NDArray[np.float64]


def obstruction(scenario: Scenario, poses: Float, body: int) -> str:
    """Return what forbids a body to be at its place, such as "overlap red"; "" if nothing does.

    poses: (3, N) of all bodies; only that body is checked. With physics="ideal" nothing is in the
    way.
    """
    bodies = [
        rigid._replace(pose=tuple(pose))
        for rigid, pose in zip(scenario.bodies, poses.T.tolist(), strict=True)
    ]
    here = bodies[body]
    if body < len(scenario.robots) and scenario.workspace and scenario.on_exit != "ignore":
        x, y, _ = np.array([here.pose]).T
        if outside_polygon(x, y, np.array(scenario.workspace))[0]:
            return "be outside of the workspace"
    if scenario.physics == "ideal":
        return ""
    allowed = min(scenario.max_overlap, min(rigid.shape.thickness for rigid in bodies) / 8)
    core = _core(here, allowed)
    if scenario.on_exit == "wall" and scenario.workspace:
        import shapely

        if not shapely.Polygon(scenario.workspace).contains(core):
            return "be in the workspace's wall"
    found = _tree(scenario.obstacles).query(core, "intersects") if scenario.obstacles else ()
    if len(found):
        return f"be in obstacle {min(found)}"
    for k in _near(bodies, body):
        pair = (min(k, body), max(k, body))
        if pair not in scenario.joined and core.intersects(_core(bodies[k], 0.0)):
            return f"overlap {bodies[k].name}"
    return ""


def _near(bodies: list[Rigid], body: int) -> list[int]:
    """Return the other bodies that may touch a body, the nearest first."""
    centers = np.array([rigid.bound[0] for rigid in bodies])
    radii = np.array([rigid.bound[1] for rigid in bodies])
    gaps = np.hypot(*(centers - centers[body]).T) - radii - radii[body]
    gaps[body] = np.inf
    return [int(k) for k in np.argsort(gaps) if gaps[k] < 0]


def _core(body: Rigid, less: float) -> Any:
    """Return the ground that a body covers, less a rim of `less` metres."""
    import shapely

    if body.is_disc:
        center, radius = body.bound
        return shapely.Point(center).buffer(radius - less, quad_segs=64)
    ground = footprint(body)
    return ground.buffer(-less, join_style="mitre") if less else ground


@lru_cache(maxsize=4)
def _tree(outlines: tuple[Outline, ...]) -> Any:
    import shapely

    return shapely.STRtree(lines_and_areas(outlines))
