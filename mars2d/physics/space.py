"""Space: the walls and bodies of a world, as its sensors see them, in pymunk.

Bodies are numbered robots first, then props; obstacles are -1, -2, ... Nothing here is stepped.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from math import inf

import numpy as np
import pymunk
from numpy.typing import NDArray
from pymunk import batch
from pymunk._chipmunk_cffi import ffi, lib

from mars2d.bodies.rigid import Rigid
from mars2d.core.arithmetic import cosines_sines
from mars2d.core.plane import WITHIN, Outline, Point, edges_of
from mars2d.physics.islands.chipmunk import frame_of
from mars2d.physics.rays import Rays
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]

_ALL = 0xFFFFFFFF

POSE = batch.BodyFields.POSITION | batch.BodyFields.ANGLE

GOLDEN = (5**0.5 - 1) / 2
"""The fractional parts of its multiples are scattered evenly from 0 to 1."""


class Space:
    """Robots, props and obstacles as pymunk shapes, made when they are first looked at."""

    def __init__(self, scenario: Scenario, state: Float) -> None:
        """Take the scenario, and the states (N, 6) of all bodies, which change as they move."""
        self.obstacles = tuple(surface.outline for surface in scenario.surfaces)
        self._rigids, self._robots = scenario.bodies, len(scenario.robots)
        self._state = state
        self._moved = self._rays_moved = True
        self._filter = ffi.new("cpShapeFilter *", (0, _ALL, _ALL))
        self._info = ffi.new("cpPointQueryInfo *")

    def moved(self) -> None:
        """Note that bodies have moved: the next query finds them where they are."""
        self._moved = self._rays_moved = True

    # -- building ---------------------------------------------------------------------------

    @cached_property
    def _space(self) -> pymunk.Space:
        """The space, with all shapes."""
        space = pymunk.Space()
        self._bodies = [self._body(space, i, rigid) for i, rigid in enumerate(self._rigids)]
        walls = [shape for outline in self.obstacles for shape in _walls(space, outline)]
        space.add(*_scattered(walls))
        self._poses = np.zeros((len(self._bodies) + 1 + len(self.obstacles), 3))
        self._buffer = batch.Buffer()
        self._frames = [np.frombuffer(frame_of(body._body)) for body in self._bodies]
        return space

    def _body(self, space: pymunk.Space, i: int, rigid: Rigid) -> pymunk.Body:
        """Return a body in the space, with its shapes."""
        body = pymunk.Body(1.0, 1.0)
        space.add(body)
        for vertices, radius in rigid.shape.pieces:
            shape: pymunk.Shape
            if len(vertices) == 1:
                shape = pymunk.Circle(body, radius, vertices[0])
            else:
                shape = pymunk.Poly(body, vertices)
            # A robot's sensors do not see itself.
            shape.filter = pymunk.ShapeFilter(i + 1 if i < self._robots else 0)
            space.add(shape)
        return body

    # -- what sensors ask -------------------------------------------------------------------

    @property
    def _seen(self) -> pymunk.Space:
        """The space, with all shapes where their bodies are."""
        space = self._space
        if self._moved:
            self._moved = False
            self._poses[: len(self._bodies)] = self._state[:, :3]
            self._buffer.set_float_buf(self._poses)
            batch.set_space_bodies(space, POSE, self._buffer)
            self._turn()
            for body in self._bodies:
                space.reindex_shapes_for_body(body)
        return space

    def _turn(self) -> None:
        """Turn bodies by sines that do not depend on the C library, as pymunk's do."""
        x, y, theta = self._poses[: len(self._bodies)].T
        c, s = cosines_sines(theta)
        rows = np.column_stack([c, s, -s, c, x, y])
        for frame, row in zip(self._frames, rows, strict=True):
            frame[:] = row

    @cached_property
    def _rays(self) -> Rays:
        return Rays([rigid.shape.pieces for rigid in self._rigids], self.obstacles)

    @property
    def rays(self) -> Rays:
        """What casts rays, with all bodies where they are."""
        if self._rays_moved:
            self._rays_moved = False
            self._rays.place(self._state[:, :3].T)
        return self._rays

    def distance(self, point: Point, limit: float, ignore: int) -> float:
        """Return the distance to the nearest surface, inf beyond `limit`; see Surroundings.

        It is pymunk's `Space.point_query_nearest` without the objects that this makes.
        """
        space = self._seen._space
        self._filter.group = ignore + 1
        info = self._info
        hit = lib.cpSpacePointQueryNearest(space, point, WITHIN * limit, self._filter[0], info)
        return min(info.distance, limit) if hit else inf

    def nearby(self, point: Point, limit: float, ignore: int) -> Iterator[Point]:
        """Yield the nearest point of each surface at most `limit` away; see Surroundings."""
        own = pymunk.ShapeFilter(group=ignore + 1)
        for info in self._seen.point_query(point, WITHIN * limit, own):
            yield info.point.x, info.point.y


def _walls(space: pymunk.Space, outline: Outline) -> list[pymunk.Shape]:
    """Return the shapes of an obstacle, on a body of its own in the space."""
    body = pymunk.Body(body_type=pymunk.Body.STATIC)
    space.add(body)
    return [pymunk.Segment(body, a, b, 0.0) for a, b in edges_of(outline)]


def _scattered(shapes: list[pymunk.Shape]) -> list[pymunk.Shape]:
    """Return shapes in a fixed order in which neighbours lie far apart.

    The engine sorts shapes into a tree as they come. If neighbours follow one another, the tree is
    lopsided, and queries of it are up to twice as slow.
    """
    order = sorted(range(len(shapes)), key=lambda k: k * GOLDEN % 1.0)
    return [shapes[k] for k in order]
