"""Random starts: robots and props are placed by chance, clear of each other and of all else."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from math import pi
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.rigid import Rigid, Triple
from mars2d.core import checks
from mars2d.core.arithmetic import norm, norms
from mars2d.core.description import Description, accepts, entry, number
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

Float = NDArray[np.float64]
Points = tuple[Float, Float]

BATCH = 64
"""How many places are tried at once."""

BATCHES, ROUNDS = 16, 20
"""Batches for each body, and how often all bodies are placed again, before there is no place."""

MARGIN = 1e-9
"""How far bodies start from each other and from walls at least, metres: rounding is less."""


@accepts({"type": "array", "items": {"type": "string"}})
def _names(name: str, value: object) -> tuple[str, ...]:
    """Check a list of names, which may be empty."""
    given = None if isinstance(value, (tuple, list)) and not value else value
    return checks.names(name, given, "names of robots and props, such as ['red', 'box0']") or ()


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
        default=(), check=_names, kw_only=False,
        doc="the names of the robots and props; empty: all robots",
    )  # fmt: skip
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


class Lottery:
    """Places bodies at random in the room that walls, obstacles and other bodies leave.

    field: the scenario's, for errors. starts: where which bodies start. bodies: all, the first of
    which are the `robots` robots. joined: the names of bodies that a joint ties. Raises InputError
    for a name that is not known, occurs twice, or is tied.
    """

    def __init__(
        self, field: str, starts: Sequence[RandomStarts], bodies: Sequence[Rigid], robots: int,
        joined: Collection[str], workspace: Outline | None, on_exit: str,
        obstacles: Sequence[Outline],
    ) -> None:  # fmt: skip
        known, before = {body.name: body for body in bodies}, dict[str, str]()
        self._groups: list[tuple[str, RandomStarts, list[Rigid]]] = []
        for index, each in enumerate(starts):
            where = f"{field}[{index}]"
            names = each.bodies or [body.name for body in bodies[:robots]]
            for name in names:
                if name not in known:
                    near = nearest(name, known)
                    raise InputError(f"{where}: there is no robot or prop {name!r}{near}")
                if name in before:
                    raise InputError(f"{where}: {name!r} is in {before[name]} already")
                if name in joined:
                    raise InputError(
                        f"{where}: a joint ties {name!r}; expected bodies without joints"
                    )
                before[name] = where
            if each.area is None and workspace is None:
                raise InputError(f"{where}: expected an area, since the scenario has no workspace")
            self._groups.append((where, each, [known[name] for name in names]))
        standing = [body for body in bodies if body.name not in before]
        self._workspace, self._walled = workspace, on_exit == "wall"
        bounded = workspace is not None and on_exit != "ignore"
        self._edge = np.array(workspace) if bounded else None
        solid = lines_and_areas(obstacles)
        solid += [footprint(body) for body in standing if not body.is_disc]
        self._solid: shapely.STRtree | None = None
        if solid:
            import shapely

            self._solid = shapely.STRtree(solid)
        discs = [body.bound for body in standing if body.is_disc]
        self._discs = [(*middle, radius) for middle, radius in discs]

    def poses(self, seed: int) -> dict[str, Triple]:
        """Return the poses that the bodies start with, by name.

        A body that is no disc is kept as far away as the circle round its pose that holds it.
        Raises InputError where no place is found.
        """
        rng = stream(seed, "random starts")
        for _ in range(ROUNDS):
            taken, poses = [*self._discs], dict[str, Triple]()
            for where, starts, bodies in self._groups:
                stuck = self._place(starts, bodies, taken, poses, rng)
                if stuck is not None:
                    why = f"{where}: found no place in {ROUNDS} rounds for {stuck.name!r}, which"
                    why += f" needs {_reach(stuck):.3g} m round its pose"
                    break
            else:
                return poses
        raise InputError(f"{why}; expected a larger area, fewer bodies or a smaller least_distance")

    def _place(
        self, starts: RandomStarts, bodies: list[Rigid], taken: list[tuple[float, float, float]],
        poses: dict[str, Triple], rng: np.random.Generator,
    ) -> Rigid | None:  # fmt: skip
        """Place bodies; return the one that finds no place, or None.

        taken: x, y, radius of what is there already; what is placed is added there and to `poses`.
        """
        area = starts.area or self._workspace
        assert area is not None
        corners, first = np.array(area), len(taken)
        xmin, xmax, ymin, ymax = bounds_of(area)
        for body in bodies:
            heading = rng.uniform(-pi, pi) if starts.heading is None else starts.heading
            reach = _reach(body) + MARGIN
            others = np.array(taken).reshape(-1, 3)
            apart = others[:, 2] + reach
            apart[first:] = np.maximum(apart[first:], starts.least_distance)
            for _ in range(BATCHES):
                u, v = rng.random((2, BATCH))
                x, y = places = xmin + (xmax - xmin) * u, ymin + (ymax - ymin) * v
                gaps = norms(x[:, None] - others[:, 0], y[:, None] - others[:, 1]) - apart
                free = inside_polygon(x, y, corners) & (gaps >= 0).all(axis=1)
                found = np.flatnonzero(free & self._free(places, reach))
                if len(found):
                    break
            else:
                return body
            place = float(x[found[0]]), float(y[found[0]])
            taken.append((*place, reach))
            poses[body.name] = (*place, float(heading))
        return None

    def _free(self, places: Points, reach: float) -> NDArray[np.bool_]:
        """Return at which places (k,) no wall, obstacle or corner is within `reach` metres."""
        x, y = places
        free = np.ones(x.shape, bool)
        if self._edge is not None:
            free &= ~outside_polygon(x, y, self._edge)
            if self._walled:
                free &= distance_to_ring(x, y, self._edge) >= reach
        if self._solid is not None:
            import shapely

            hit, _ = self._solid.query(shapely.points(x, y), "dwithin", reach)
            free[hit] = False
        return free


def _reach(body: Rigid) -> float:
    """Return the radius of the circle round a body's pose that holds it in any heading, metres."""
    middle, radius = body.shape.bound
    return norm(*middle) + radius
