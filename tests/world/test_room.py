"""A room notices every robot that leaves it, and looks closely at few."""

import numpy as np

from mars2d.core.plane import outside_polygon
from mars2d.world.room import Room
from tests.cases import each_case

SQUARE = [(-2, -2), (2, -2), (2, 2), (-2, 2)]
ANGLE = [(0, 0), (4, 0), (4, 2), (2, 2), (2, 4), (0, 4)]


@each_case("outline", [SQUARE, ANGLE])
@each_case("seed", range(5))
def test_it_says_at_each_step_what_a_close_look_at_all_says(outline, seed):
    rng = np.random.default_rng(seed)
    here = Room(outline, 8)
    position, velocity = rng.uniform(0.1, 1.9, (2, 8)), rng.normal(0, 0.1, (2, 8))
    seen = set()
    for _ in range(100):
        left = here.left(position)
        outside = outside_polygon(*position, np.array(outline, dtype=float))
        assert left == np.flatnonzero(outside).tolist()
        seen.update(left)
        velocity += rng.normal(0, 0.02, (2, 8))
        position = position + velocity
    assert seen


def test_a_robot_on_the_edge_is_inside_and_one_beyond_it_is_not():
    here = Room(SQUARE, 3)
    assert here.left(np.array([[2.0, 2.0 + 0.9e-9, 2.0 + 1e-6], [0.0, 0.0, 0.0]])) == [2]
    assert here.left(np.array([[2.0 + 1e-6, 2.0, 2.0], [0.0, 0.0, 0.0]])) == [0]


def test_a_robot_that_is_put_far_away_is_found_there():
    here = Room(SQUARE, 1)
    assert here.left(np.zeros((2, 1))) == []
    assert here.left(np.array([[1e6], [0.0]])) == [0]
    assert here.left(np.array([[1.0], [0.0]])) == []
