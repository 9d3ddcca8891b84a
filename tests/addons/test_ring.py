"""The add-on Ring: who has left it, who has won; and the sumo that is finished in it."""

import numpy as np
import pytest

from mars2d import Holonomic, InputError, Robot, Scenario, World
from mars2d.addons import Ring
from tests.cases import each_case
from tests.worlds import finished

ROLES = {"red": ["r1", "r2"], "blue": ["b1", "b2"]}


def going(vx):
    return lambda _: (vx, 0.0)


def bout(speeds, *, starts=(0.0, 0.0, 0.0, 0.0), stop_time=10.0, ring=None, **fields):
    """Four robots side by side go to the right [m/s], or left, in a ring of 1.93 m."""
    robot = Robot(drive=Holonomic(max_linear_speed=2.0), diameter=0.2)
    names = [name for team in ROLES.values() for name in team]
    robots = [
        robot.replace(name=name, controller=going(speed)).at(x, 0.3 * k)
        for k, (name, speed, x) in enumerate(zip(names, speeds, starts, strict=True))
    ]
    ring = ring or Ring(ROLES, radius=1.93)
    return Scenario(robots=robots, addons=[ring], workspace=None, stop_time=stop_time, **fields)


# -- who is out ---------------------------------------------------------------------------------


def test_a_role_has_lost_when_all_of_its_robots_are_out():
    world = finished(bout([1.0, 0.5, 0.6, 0.0]))
    ring = world.addons.ring
    assert ring.out == (0, 2, 1)  # r1, b1, then r2: so red has lost
    assert (ring.winner, ring.score) == ("blue", {"red": 0, "blue": 1})
    assert world.over_message == "blue wins: all 2 of red have left the ring after 3.90 s"


def test_who_is_out_stands_still_and_stays_out_while_the_others_go_on():
    world = finished(bout([1.0, 0.5, 0.0, 0.0]))
    x, command = world.record.pose[:, 0, 0], world.record.command[:, 0, 0]
    left = int(np.argmax(x > 1.93))
    assert (command[:left] == 1.0).all()
    assert (command[left:] == 0.0).all()
    assert (x[left:] == x[left]).all()


def test_a_robot_is_in_the_ring_as_long_as_its_middle_is():
    for x, out in ((1.93, ()), (1.93 + 1e-9, (0,)), (-2.0, (0,))):
        world = World(bout([0.0] * 4, starts=(x, 0.0, 0.0, 0.0)))
        world.step()
        assert world.addons.ring.out == out


@each_case(
    ("speeds", "stop_time", "score"),
    [
        ([0.0, 0.0, 0.0, 0.0], 1.0, {"red": 2, "blue": 2}),  # time is over
        ([1.0, 0.0, 0.0, 0.0], 3.0, {"red": 1, "blue": 2}),  # with more robots it is no win
        ([1.0, 1.0, 1.0, -0.86], 5.0, {"red": 0, "blue": 0}),  # the last ones at once
    ],
)
def test_it_is_a_draw_when_time_is_over_or_the_last_ones_leave_at_once(speeds, stop_time, score):
    world = finished(bout(speeds, stop_time=stop_time, physics="ideal"))
    assert world.over_message == "a draw"
    assert (world.addons.ring.winner, world.addons.ring.score) == (None, score)
    assert world.addons.ring.outcome(world.record)[:3] == ((), score, None)


# -- what is refused ----------------------------------------------------------------------------


@each_case(
    ("fields", "words"),
    [
        ({"radius": 0}, "Ring.radius = 0: expected a number > 0"),
        ({"center": (0, np.nan)}, "Ring.center"),
        ({"roles": {"red": ["r1"], "blue": []}}, "nobody has this role"),
    ],
)
def test_rings_that_can_not_be_are_refused_in_words(fields, words):
    with pytest.raises(InputError, match=words):
        Ring(**({"roles": ROLES} | fields))
