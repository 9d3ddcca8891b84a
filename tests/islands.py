"""The islands as Python runs them: their bodies and pairs, and a look at each of their substeps."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pymunk
import pytest

from mars2d import Scenario
from mars2d.core.plane import edges_of
from mars2d.physics import translation
from mars2d.physics.islands.body import Body
from mars2d.physics.islands.island import Island
from mars2d.physics.islands.mover import Mover
from mars2d.physics.islands.pair import Wall
from mars2d.physics.islands.piece import Piece

FIND_TESTS = f"import sys; sys.path.append({str(Path(__file__).parents[1])!r})\n"
"""Code by which a process of its own finds these tests, after the package that is installed."""

SQUARE = np.array([-0.5 - 0.5j, 0.5 - 0.5j, 0.5 + 0.5j, -0.5 + 0.5j])
"""A square of one metre, counter-clockwise, as complex numbers."""

DISC = np.array([0j])
"""The middle of a disc."""


@contextmanager
def plainly() -> Iterator[None]:
    """Let worlds that are made in this block do without what is compiled."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MARS2D_PLAIN", "1")
        yield


def mover_of(scenario: Scenario) -> Mover:
    """Return what moves the bodies of a scenario, in Python."""
    with plainly():
        mover: Mover = translation.mover_of(scenario)
    return mover


@contextmanager
def looked_at(look: Callable[[Island, float], None]) -> Iterator[None]:
    """Call look(island, h) after each substep of h seconds of an island in Python."""
    original = Island.close

    def close(island: Island, time: float, h: float) -> None:
        original(island, time, h)
        look(island, h)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Island, "close", close)
        yield


def piece_of(vertices: Any, radius: float = 0.0) -> Piece:
    """Return a piece: the hull of vertices (k,), counter-clockwise, and a radius round it."""
    corners = np.asarray(vertices, dtype=complex)
    edges = np.roll(corners, -1) - corners
    edges = edges[np.abs(edges) > 1e-100]
    return Piece(pairs_of(corners), pairs_of(-1j * edges / np.abs(edges)), radius)


def pairs_of(points: Any) -> list[tuple[float, float]]:
    """Return complex numbers as pairs of numbers."""
    return [(float(z.real), float(z.imag)) for z in np.asarray(points)]


def body_of(*pieces: Piece, number: int = 0, **what: float) -> Body:
    """Return a prop of some pieces, without friction on the floor; more of what it is, by name."""
    body = Body(number, False, list(pieces), (0.0, 0.0))
    reach = max(corner.lever + piece.radius for piece in pieces for corner in piece.corners)
    round_one = len(pieces) == 1 and len(pieces[0].corners) == 1 and not pieces[0].corners[0].lever
    usual = {"mass": 1.0, "moment": 1.0, "radius": reach, "offset_x": 0.0, "offset_y": 0.0}
    body.describe({**usual, "is_disc": round_one, **what})
    return body


def wall_of(start: complex, end: complex, number: int = 0) -> Wall:
    """Return a wall: the obstacle -1 - number."""
    ends = [start.real, start.imag, end.real, end.imag]
    return Wall(number, [(0.0, -1 - number)], -1 - number, ends, (0.0, 0.0), None, [])


def place(body: Body, position: complex, angle: float = 0.0) -> None:
    """Put a body somewhere."""
    body.x, body.y, body.angle = position.real, position.imag, angle
    body.locate()


def let_move(body: Body, velocity: complex, spin: float = 0.0, acceleration: float = 0.0) -> None:
    """Let a body have a velocity that changes by `acceleration` m/s^2 at most."""
    body.vx, body.vy, body.spin = velocity.real, velocity.imag, spin
    body.acceleration = acceleration


def states_of(bodies: Sequence[Body]) -> np.ndarray:
    """Return x, y, theta of bodies, (k, 3)."""
    return np.array([(body.x, body.y, body.angle) for body in bodies])


WALLS_ALONE = pymunk.ShapeFilter(mask=2)
"""What asks a space of pymunk for walls and nothing else."""


def pymunk_space(
    bodies: Sequence[Any], poses: np.ndarray, outlines: Sequence[Any]
) -> tuple[pymunk.Space, list[pymunk.Body]]:
    """Return a space of pymunk in which bodies (N,), as their pieces, are at poses (N, 3).

    Shapes of body i are of the group i + 1, and obstacles, edge by edge, of none.
    """
    space, movers = pymunk.Space(), []
    for i, (pieces, (x, y, theta)) in enumerate(zip(bodies, poses.tolist(), strict=True)):
        mover = pymunk.Body(1.0, 1.0)
        mover.position, mover.angle = (x, y), theta
        space.add(mover)
        movers.append(mover)
        for points, radius in pieces:
            disc = len(points) == 1
            shape = pymunk.Circle(mover, radius, points[0]) if disc else pymunk.Poly(mover, points)
            shape.filter = pymunk.ShapeFilter(i + 1, categories=1)
            space.add(shape)
    for outline in outlines:
        for edge in edges_of(outline):
            wall = pymunk.Segment(space.static_body, *edge, 0.0)
            wall.filter = pymunk.ShapeFilter(categories=2)
            space.add(wall)
    return space, movers
