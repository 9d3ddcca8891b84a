"""Random starts: robots and props are placed by chance, clear of each other and of all else."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.rigid import Rigid, Triple
from mars2d.core import checks
from mars2d.core.arithmetic import norm, norms
from mars2d.core.description import Description, entry, number
from mars2d.core.errors import InputError, nearest
from mars2d.core.plane import (
    Outline,
    bounds_of,
    distance_to_ring,
    inside_polygon,
    lines_and_areas,
    outside_polygon,
)  # fmt: skip
from mars2d.core.streams import stream
from mars2d.scenario.starts import footprint

if TYPE_CHECKING:
    import shapely

    from mars2d.scenario.scenario import Scenario

BATCH = 64
"""How many places are tried at once."""

BATCHES, ROUNDS = 16, 20
"""Batches for each body, and how often all bodies are placed again, before there is no place."""

MARGIN = 1e-9
"""How far bodies start from each other and from walls at least, metres: rounding is less."""


class RandomStarts(Description):
    """Where robots and props start at random: in an area, at a least distance, never overlapping.

    The poses follow from the seed of the run. They replace those of the bodies.

    >>> from mars2d import Robot, Scenario
    >>> two = [Robot(name="red"), Robot(name="blue")]
    >>> scenario = Scenario(robots=two, random_starts=[RandomStarts(least_distance=4)])
    >>> red, blue = scenario.started(seed=7).initial_pose[:2].T
    >>> bool(np.hypot(*(red - blue)) >= 4)
    True
    """

    bodies: Sequence[str] = entry(
        default=(),
        check=checks.names("names of robots and props, such as ['red', 'box0']", 0),
        kw_only=False,
        doc="the names of the robots and props; empty: all robots",
        names="body",
    )
    area: Outline | None = entry(
        default=None, check=checks.optional(checks.outline, 3), unit="m",
        doc="the polygon in which their poses lie; None: the workspace",
    )  # fmt: skip
    least_distance: float = number(
        default=0.0,
        low=0,
        high=1e6,
        unit="m",
        doc="the least distance between any two of their poses",
    )
    heading: float | None = number(
        default=None, low=-1e6, high=1e6, unit="rad", optional=True,
        doc="the heading of all; None: random",
    )  # fmt: skip


class Room(NamedTuple):
    """What is the same for all seeds: who is placed, discs that stand, and what else is there."""

    to_place: list[tuple[int, Rigid]]
    discs: list[tuple[float, float, float, float]]
    solid: shapely.STRtree | None


def room_of(scenario: Scenario) -> Room:
    """Return the room for `random_starts`; InputError for names unknown, given twice, or tied."""
    known, before = {body.name: body for body in scenario.bodies}, dict[str, str]()
    joints = [*scenario.joints, *(joint for prop in scenario.props for joint in prop.joints())]
    tied = {name for joint in joints for name in (joint.a, joint.b)}
    to_place = []
    for index, each in enumerate(scenario.random_starts):
        where = f"Scenario.random_starts[{index}]"
        names = each.bodies or [str(robot.name) for robot in scenario.robots]
        for name in names:
            if name not in known:
                near = nearest(name, known)
                raise InputError(f"{where}: there is no robot or prop {name!r}{near}")
            if name in before:
                raise InputError(f"{where}: {name!r} is in {before[name]} already")
            if name in tied:
                raise InputError(f"{where}: a joint ties {name!r}; expected bodies without joints")
            before[name] = where
        if each.area is None and scenario.workspace is None:
            raise InputError(f"{where}: expected an area, since the scenario has no workspace")
        to_place += [(index, known[name]) for name in names]
    placed = {body.name for _, body in to_place}
    standing = [body for body in scenario.bodies if body.name not in placed]
    discs = [(*body.bound[0], body.bound[1], -1.0) for body in standing if body.is_disc]
    solid = lines_and_areas(scenario.obstacles)
    solid += [footprint(body) for body in standing if not body.is_disc]
    if solid:
        import shapely
    return Room(to_place, discs, shapely.STRtree(solid) if solid else None)


def poses_of(scenario: Scenario, room: Room, seed: int) -> dict[str, Triple]:
    """Return the poses that the bodies of `random_starts` start with, by name.

    A body that is no disc is kept as far away as the circle round its pose that holds it. Raises
    InputError where no place is found.
    """
    rng = stream(seed, "random starts")
    for _ in range(ROUNDS):
        taken, poses = [*room.discs], dict[str, Triple]()
        for which, body in room.to_place:
            reach = _reach(body) + MARGIN
            pose = _place(scenario, room.solid, which, reach, np.array(taken).reshape(-1, 4), rng)
            if pose is None:
                break
            taken.append((*pose[:2], reach, which))
            poses[body.name] = pose
        else:
            return poses
    why = f"found no place in {ROUNDS} rounds for {body.name!r}, which needs {_reach(body):.3g} m"
    hint = "expected a larger area, fewer bodies or a smaller least_distance"
    raise InputError(f"Scenario.random_starts[{which}]: {why} round its pose; {hint}")


def _place(
    scenario: Scenario, solid: shapely.STRtree | None, which: int, reach: float,
    taken: NDArray[np.float64], rng: np.random.Generator,
) -> Triple | None:  # fmt: skip
    """Return a pose at which no wall, obstacle or disc is within `reach` metres, or None.

    taken: (k, 4), x, y, radius of the discs and the index of their entry, -1 for none.
    """
    starts = scenario.random_starts[which]
    corners = np.array(starts.area or scenario.workspace)
    edge = None if scenario.on_exit == "ignore" else scenario.workspace
    xmin, xmax, ymin, ymax = bounds_of(corners)
    heading = rng.uniform(-pi, pi) if starts.heading is None else starts.heading
    apart = taken[:, 2] + reach
    apart[taken[:, 3] == which] = apart[taken[:, 3] == which].clip(starts.least_distance)
    for _ in range(BATCHES):
        u, v = rng.random((2, BATCH))
        x, y = xmin + (xmax - xmin) * u, ymin + (ymax - ymin) * v
        gaps = norms(x[:, None] - taken[:, 0], y[:, None] - taken[:, 1]) - apart
        free = inside_polygon(x, y, corners) & (gaps >= 0).all(axis=1)
        if edge is not None:
            free &= ~outside_polygon(x, y, np.array(edge))
            if scenario.on_exit == "wall":
                free &= distance_to_ring(x, y, np.array(edge)) >= reach
        if solid is not None:
            import shapely

            free[solid.query(shapely.points(x, y), "dwithin", reach)[0]] = False
        if free.any():
            k = int(np.argmax(free))
            return float(x[k]), float(y[k]), float(heading)
    return None


def _reach(body: Rigid) -> float:
    """Return the radius of the circle round a body's pose that holds it in any heading, metres."""
    middle, radius = body.shape.bound
    return norm(*middle) + radius
