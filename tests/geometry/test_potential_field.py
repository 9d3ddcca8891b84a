"""Potential fields: the force is -grad U, its zeros are found, and pieces of a wall count once."""

from math import hypot, inf

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import brentq

from mars2d import InputError, Robot, Scenario, World
from mars2d.addons import Map, PotentialField, Waypoints
from mars2d.core.scene import Arrow, Line, Scene
from mars2d.geometry.potential_field import Potential

BOX = [(1.0, -0.5), (1.6, -0.5), (1.6, 0.9), (1.0, 0.9)]
WALL = [(-1.0, 1.5), (2.0, 1.5)]
ROOM = Potential([BOX, WALL], radius=0.1)
TRAP = [[(2, -1), (2, 1)], [(1, 1), (2, 1)], [(1, -1), (2, -1)]]


@given(x=st.floats(-0.5, 2.5), y=st.floats(-1.2, 1.4), gx=st.floats(-3, 3), gy=st.floats(-3, 3))
def test_the_force_is_minus_the_gradient_of_the_potential(x, y, gx, gy):
    h, goal = 1e-6, (gx, gy)
    around = [(x + h, y), (x - h, y), (x, y + h), (x, y - h)]
    right, left, above, below = (ROOM.potential(at, goal) for at in around)
    assume(max(right, left, above, below) < 50)  # too near to a wall for differences
    fx, fy = ROOM.force((x, y), goal)
    slopes = (left - right) / (2 * h), (below - above) / (2 * h)
    assert (fx, fy) == pytest.approx(slopes, rel=1e-3, abs=1e-3)


def test_the_force_has_no_jumps_on_a_way_round_a_box():
    goal, turns = (5.0, 3.0), np.linspace(0, 2 * np.pi, 5_001)
    way = np.column_stack([1.3 + 0.9 * np.cos(turns), 0.2 + 1.1 * np.sin(turns)])
    forces = np.array([ROOM.force(at, goal) for at in way])
    assert np.abs(np.diff(forces, axis=0)).max() < 0.08


def test_far_from_walls_the_goal_pulls_in_proportion_and_then_with_one_force():
    free = Potential([], attraction=2.0, far=0.5)
    assert free.force((0, 0), (0.25, 0)) == (0.5, 0.0)
    assert free.force((0, 0), (3, 4)) == pytest.approx((0.6, 0.8))
    assert free.force((3, 4), (3, 4)) == (0.0, 0.0)
    assert free.potential((0, 0), (0.5, 0)) == pytest.approx(0.25)
    assert free.potential((0, 0), (2.5, 0)) == pytest.approx(0.25 + 2.0)


def test_a_wall_repels_by_khatibs_formula_up_to_its_reach():
    wall = Potential([[(1, -9), (1, 9)]], repulsion=0.02, reach=0.6, radius=0.2, attraction=1e-9)
    for rho in (0.1, 0.3, 0.59):
        expected = 0.02 * (1 / rho - 1 / 0.6) / rho**2
        assert wall.force((0.8 - rho, 0), (9, 0))[0] == pytest.approx(-expected, abs=1e-8)
    assert wall.force((0.8 - 0.61, 0), (9, 0))[0] > 0


def test_a_wall_drawn_in_pieces_or_twice_repels_as_one():
    whole = Potential([[(0, 0), (4, 0), (4, 0.2), (0, 0.2)]])
    halves = [[(0, 0), (2, 0), (2, 0.2), (0, 0.2)], [(2, 0), (4, 0), (4, 0.2), (2, 0.2)]]
    inside = [(0.5, 0.1), (3.5, 0.1)]
    for at in [(2.0, 0.5), (1.9, -0.3), (4.2, 0.1)]:
        expected = pytest.approx(whole.force(at, (9, 9)))
        assert Potential(halves).force(at, (9, 9)) == expected
        assert Potential([*halves, halves[0], inside]).force(at, (9, 9)) == expected
    line = [[(0, 0), (1, 0)], [(1, 0), (4, 0)]]
    at = (1.0, 0.3)
    whole = Potential([[(0, 0), (4, 0)]])
    assert Potential(line).force(at, (9, 9)) == pytest.approx(whole.force(at, (9, 9)))


def test_where_a_robot_has_no_room_the_potential_is_infinite():
    assert ROOM.potential((1.3, 0.2), (5, 5)) == inf  # within the box
    assert ROOM.potential((0.95, 0.2), (5, 5)) == inf  # its rim in the box
    assert ROOM.potential((1.0, 0.2), (5, 5)) == inf  # on its edge
    assert ROOM.free((0.85, 0.2))
    assert not ROOM.free((0.0, 1.45))


def test_one_that_descends_arrives_or_ends_where_the_force_is_zero():
    field = Potential(TRAP, radius=0.1)
    assert hypot(*field.descend((0, 3), (5, 3), 0.2)) == pytest.approx(hypot(4.8, 3), abs=0.05)
    x, y = field.descend((0, 0.2), (5, 0.2), 0.2)
    assert hypot(*field.force((x, y), (5, 0.2))) < 1e-9
    assert 1 < x < 2
    assert -1 < y < 1


def test_the_minimum_before_a_wall_is_where_pull_and_push_are_equal():
    field = Potential([[(2, -9), (2, 9)]], radius=0.2)
    rho = brentq(lambda r: 0.01 * (1 / r - 1 / 0.6) / r**2 - 0.5, 0.05, 0.59, xtol=1e-12)
    x, y = field.descend((0, 0), (5, 0), 0.1)
    assert (x, y) == pytest.approx((2 - 0.2 - rho, 0), abs=1e-9)


def test_who_is_led_along_a_route_ends_at_the_last_point_or_at_the_first_trap():
    field = Potential(TRAP, radius=0.1)
    assert field.lead((0, 0), ((0, 2), (5, 2)), 0.2)[0] == 2
    reached, (x, y) = field.lead((0, 0), ((1, 0), (5, 0.3), (0, 0)), 0.2)
    assert reached == 1
    assert hypot(*field.force((x, y), (5, 0.3))) < 1e-9


def test_arrows_point_where_the_force_does_and_leave_out_obstacles():
    arrows = ROOM.arrows((5.0, 0.2), (-1, 3, -1, 2), 0.25)
    assert len(arrows) > 30
    for at, (ux, uy) in arrows:
        assert ROOM.free(at)
        fx, fy = ROOM.force(at, (5.0, 0.2))
        assert (ux * fy - uy * fx, hypot(ux, uy)) == pytest.approx((0, 1), abs=1e-9)


# -- the add-on -----------------------------------------------------------------------------------

WAYS = Waypoints([[(1, 0), (4, 0.2)]])


def world_of(*addons):
    addons = [Map(TRAP), *addons, PotentialField()]
    return World(Scenario(robots=[Robot(diameter=0.2)], addons=addons))


def drawn(world):
    """What the field shows of its theory."""
    scene = Scene()
    world.scenario.addons[-1].theory(scene, world.frame)
    return scene.shapes


def test_laws_ask_the_add_on_for_the_force_on_a_robot():
    world = world_of(WAYS)
    expected = Potential(world.obstacles, radius=0.1).force((0, 0), (1, 0))
    assert world.addons.potential_field.force(0) == expected


def test_it_needs_waypoints():
    world = world_of()
    with pytest.raises(InputError, match=r"PotentialField needs goals: add Waypoints"):
        world.addons.potential_field.force(0)
    assert not drawn(world)


def test_theory_shows_arrows_to_the_goal_of_now_and_a_cross_at_the_trap():
    world = world_of(WAYS)
    shapes = drawn(world)
    assert any(isinstance(shape, Arrow) for shape in shapes)
    lines = [shape for shape in shapes if isinstance(shape, Line)]
    (reached, end), *_ = world.scenario.addons[-1].plan(world.scenario)
    assert reached == 1
    assert all(line.points.mean(axis=0) == pytest.approx(end) for line in lines)
    assert len(lines) == 4  # two strokes, each with a rim
