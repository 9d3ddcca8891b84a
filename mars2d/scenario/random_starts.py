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
from mars2d.core.plane import Outline, lines_and_areas
from mars2d.core.streams import stream
from mars2d.scenario.starts import footprint

if TYPE_CHECKING:
    import shapely

    from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]

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
        default=None, check=checks.optional(checks.polygon), unit="m",
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
    """What is the same for all seeds: who is placed, where, and what else is there.

    to_place: the index of the entry, the body, and the radius of the circle round its pose that
    holds it in any heading, metres. areas: of each entry, its corners' lowest x and y and their
    spans (2, 1), metres, and the area less what lies outside of a workspace that robots can't
    leave. discs: (k, 4), x, y, radius of those that stand, and -1. solid: what else stands.
    """

    to_place: list[tuple[int, Rigid, float]]
    areas: list[tuple[Float, Float, shapely.Geometry]]
    discs: list[tuple[float, float, float, float]]
    solid: shapely.STRtree


def room_of(scenario: Scenario) -> Room:
    """Return the room for `random_starts`; InputError for names unknown, given twice, or tied."""
    import shapely

    known, before = {body.name: body for body in scenario.bodies}, dict[str, str]()
    joints = [*scenario.joints, *(joint for prop in scenario.props for joint in prop.joints())]
    tied = {name for joint in joints for name in (joint.a, joint.b)}
    edge = None if scenario.on_exit == "ignore" else scenario.workspace
    to_place, areas = [], []
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
            middle, radius = known[name].shape.bound
            to_place.append((index, known[name], norm(*middle) + radius))
        corners = each.area or scenario.workspace
        if corners is None:
            raise InputError(f"{where}: expected an area, since the scenario has no workspace")
        area = shapely.Polygon(corners)
        xmin, ymin, xmax, ymax = area.bounds
        if edge is not None and each.area:
            area = area.intersection(shapely.Polygon(edge))
        shapely.prepare(area)
        areas.append((np.array([[xmin], [ymin]]), np.array([[xmax - xmin], [ymax - ymin]]), area))
    standing = [body for body in scenario.bodies if body.name not in before]
    discs = [(*body.bound[0], body.bound[1], -1.0) for body in standing if body.is_disc]
    solid = lines_and_areas(scenario.obstacles)
    solid += [footprint(body) for body in standing if not body.is_disc]
    if edge is not None and scenario.on_exit == "wall":
        solid.append(shapely.LinearRing(edge))
    return Room(to_place, areas, discs, shapely.STRtree(solid))


def poses_of(scenario: Scenario, room: Room, seed: int) -> dict[str, Triple]:
    """Return the poses that the bodies of `random_starts` start with, by name.

    A body that is no disc is kept as far away as the circle round its pose that holds it. Raises
    InputError where no place is found.
    """
    rng = stream(seed, "random starts")
    for _ in range(ROUNDS):
        taken, poses = [*room.discs], dict[str, Triple]()
        for which, body, needed in room.to_place:
            starts, reach = scenario.random_starts[which], needed + MARGIN
            heading = rng.uniform(-pi, pi) if starts.heading is None else starts.heading
            x, y, radii, entries = np.array(taken).reshape(-1, 4).T
            apart = radii + reach
            apart[entries == which] = apart[entries == which].clip(starts.least_distance)
            place = _place(room, which, reach, np.array([x, y, apart]), rng)
            if place is None:
                break
            taken.append((*place, reach, which))
            poses[body.name] = (*place, float(heading))
        else:
            return poses
    why = f"found no place in {ROUNDS} rounds for {body.name!r}, which needs {needed:.3g} m"
    hint = "expected a larger area, fewer bodies or a smaller least_distance"
    raise InputError(f"Scenario.random_starts[{which}]: {why} round its pose; {hint}")


def _place(
    room: Room, which: int, reach: float, taken: Float, rng: np.random.Generator
) -> tuple[float, float] | None:
    """Return a place at which no wall or obstacle is within `reach` metres, or None.

    taken: (3, k), x, y of discs, and the least distance to each.
    """
    import shapely

    low, span, area = room.areas[which]
    for _ in range(BATCHES):
        x, y = low + span * rng.random((2, BATCH))
        free = shapely.contains_xy(area, x, y)
        free &= (norms(x[:, None] - taken[0], y[:, None] - taken[1]) >= taken[2]).all(axis=1)
        for place in zip(x[free].tolist(), y[free].tolist(), strict=True):
            if not room.solid.query(shapely.points(*place), "dwithin", reach).size:
                return place
    return None
