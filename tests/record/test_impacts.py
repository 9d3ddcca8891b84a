"""Impacts against the closed forms of rigid bodies, at sampling times from 0.5 to 0.005 s."""

from math import sqrt

import numpy as np
import pytest

import mars2d
from mars2d import InputError, Robot, Scenario
from mars2d.addons import Map
from mars2d.bodies import Ball, Box
from mars2d.core.materials import GRAVITY
from tests.cases import each_case

STEPS = (0.5, 0.1, 0.02, 0.005)
WALL = Map([[(1, -2), (1, 2)]], friction=1.0, restitution=1.0)
FAR = Robot(pose=(0, 4, 0))


def record_of(step, props=(), robots=(FAR,), addons=(), stop_time=2.0):
    return mars2d.run(
        Scenario(
            robots=robots, props=props, addons=addons, workspace=None, sampling_time=step,
            stop_time=stop_time,
        )
    )  # fmt: skip


@each_case(
    "offset, friction, ground",
    [(0.0, 0.0, 0.0), (0.05, 0.0, 0.0), (0.05, 0.2, 0.0), (0.12, 0.9, 0.0), (0.05, 0.5, 0.1)],
)
def test_two_discs_part_by_restitution_and_coulombs_friction(offset, friction, ground):
    a = Ball(name="a", pose=(-0.6, 0, 0), velocity=(1, 0, 0), restitution=sqrt(0.8), mass=1.0,
             friction=sqrt(friction), ground_friction=ground)  # fmt: skip
    b = a.replace(name="b", pose=(0, offset, 0), velocity=(0, 0, 0), mass=2.0)
    for step in STEPS:
        record = record_of(step, [a, b])
        (found,) = record.impacts()
        speed = sqrt(1 - 2 * ground * GRAVITY * (0.6 - sqrt(0.2**2 - offset**2)))
        sine = offset / 0.2
        normal, slip = speed * sqrt(1 - sine**2), speed * sine
        pushed = (1 + 0.8) * normal / (1 / 1.0 + 1 / 2.0)
        rubbed = min(friction * pushed, slip / (3 * (1 / 1.0 + 1 / 2.0)))  # r^2 / I = 2 / m
        near = {"abs": 5e-4}
        assert found["normal"] == pytest.approx([sqrt(1 - sine**2), sine], **near)
        assert found["before"] == pytest.approx(np.array([[normal, -slip], [0, 0]]), **near)
        assert found["impulse"] == pytest.approx([pushed, -rubbed], **near)
        after = [[normal - pushed, -slip + rubbed], [pushed / 2, -rubbed / 2]]
        assert found["after"] == pytest.approx(np.array(after), **near)
        assert found["spin_after"] == pytest.approx([rubbed * 20, rubbed * 10], abs=4e-3)
        assert found["restitution"] == pytest.approx(0.8, abs=1e-6)
        assert found["momentum_after"] == pytest.approx(found["momentum_before"], abs=1e-12)
        works = record.energy.by("impacts")[-1] + record.energy.by("friction")[-1]
        assert found["lost"].sum() == pytest.approx(-works, abs=1e-5)


@each_case("angle, friction", [(0.5, 0.0), (-0.5, 0.0), (0.5, 0.05)])
def test_a_box_that_meets_a_wall_with_a_corner_turns_as_its_moment_says(angle, friction):
    box = Box(pose=(0, 0, angle), velocity=(1, 0, 0), length=0.4, width=0.2, mass=2.0,
              restitution=0.6, friction=friction, ground_friction=0)  # fmt: skip
    moment = 2.0 * (0.4**2 + 0.2**2) / 12
    lever = -0.2 * np.sin(angle) - np.copysign(0.1, -angle) * np.cos(angle)  # of the fore corner
    for step in STEPS:
        record = record_of(step, [box], addons=[WALL], stop_time=1.5)
        found = record.impacts()[0]
        if friction == 0:
            pushed = (1 + 0.6) / (1 / 2.0 + lever**2 / moment)
            assert abs(found["impulse"][0]) == pytest.approx(pushed, rel=1e-3)
            turned = -pushed * lever / moment
            assert found["spin_after"][0] == pytest.approx(turned, rel=2e-3)
            assert found["restitution"] == pytest.approx(0.6, abs=1e-6)
        assert abs(found["impulse"][1]) <= friction * abs(found["impulse"][0]) * (1 + 1e-9)
        works = record.energy.work[int(found["time"] / step) + 1, [2, 3]].sum()
        if step < 0.1:
            assert found["lost"].sum() == pytest.approx(-works, abs=1e-6)


def test_a_robot_meets_with_the_speed_of_its_drive_and_stays_with_what_it_pushes():
    red = Robot(pose=(-1, 0, 0), controller=lambda robot: (0.4, 0.0), restitution=1.0)
    for step in STEPS:
        (bounced, *_) = record_of(step, [Ball(mass=1.0)], [red], stop_time=3).impacts()
        assert bounced["before"] == pytest.approx(np.array([[0.4, 0], [0, 0]]), abs=1e-6)
        if step < 0.5:
            assert bounced["after"] == pytest.approx(np.array([[0, 0], [0.4, 0]]), abs=1e-2)
        (pushed, *_) = record_of(step, [Box()], [red], stop_time=3).impacts()
        assert pushed["before"][0] == pytest.approx([0.4, 0], abs=1e-6)
        assert pushed["restitution"] == pytest.approx(0, abs=1e-3)


def test_blows_that_follow_each_other_in_one_control_step_are_told_apart():
    row = [
        Ball(pose=(0, 0, 0), velocity=(1, 0, 0)),
        Ball(pose=(0.4, 0, 0)),
        Ball(pose=(0.65, 0, 0)),
    ]
    for step in STEPS:
        first, second = record_of(step, row, stop_time=1.0).impacts()
        for found in (first, second):
            assert found["after"] == pytest.approx(found["before"][::-1], abs=1e-9)
            assert found["lost"] == pytest.approx([0.5, -0.5], abs=1e-9)
        assert second["time"] - first["time"] == pytest.approx(0.05, abs=1e-3)
        assert (first["a"], first["b"], second["b"]) == (1, 2, 3)


def test_a_blow_at_the_end_of_a_control_step_is_the_same_as_within_it():
    red = Robot(pose=(0, 0, 0.3), controller=lambda robot: (0.5, 0), restitution=0.7, friction=0.3)
    for step in (0.1, 0.02, 0.005):
        found = record_of(step, robots=[red], addons=[WALL]).impacts()[0]
        speed = 0.5 * np.cos(0.3)
        assert found["before"][0, 0] == pytest.approx(speed, abs=1e-6)
        assert found["after"][0, 0] == pytest.approx(-0.7 * speed, abs=1e-6)
        assert found["restitution"] == pytest.approx(0.7, abs=1e-6)


def test_a_body_between_two_others_keeps_the_velocity_that_the_first_gave_it():
    look = {"diameter": 0.2, "restitution": 0.5}
    balls = [
        Ball(pose=(-0.5, 0, 0), velocity=(1, 0, 0), **look), Ball(**look),
        Ball(pose=(0.52, 0, 0), velocity=(-1, 0, 0), **look),
    ]  # fmt: skip
    for step in STEPS:
        first, second, *_ = record_of(step, balls).impacts()
        assert first["before"][:, 0] == pytest.approx([1, 0], abs=1e-9)
        assert second["before"][:, 0] == pytest.approx([0.625, -1], abs=1e-9)
        assert 0 < second["lost"].sum() < 0.9


def test_a_ball_bounces_off_another_that_rests_at_a_wall():
    look = {"diameter": 0.2, "restitution": 1.0}
    balls = [Ball(pose=(0.1, 0, 0), velocity=(1, 0, 0), **look), Ball(pose=(0.9, 0, 0), **look)]
    for step in STEPS:
        (found,) = record_of(step, balls, addons=[WALL]).impacts()  # none of the ball and the wall
        assert found["after"] == pytest.approx(np.array([[-1, 0], [0, 0]]), abs=1e-3)
        assert found["restitution"] == pytest.approx(1, abs=1e-3)


def test_two_blows_that_are_one_row_add_no_momentum():
    box = Box(length=0.3, width=0.3, restitution=sqrt(0.5), friction=0, ground_friction=0)
    moving = box.replace(pose=(-0.6, 0, 0.3), velocity=(1, 0, 0), mass=1.0)
    for step in STEPS:
        record = record_of(step, [moving, box.replace(pose=(0.3, 0, 0), length=0.4, width=0.8)])
        for found in record.impacts():
            assert found["momentum_after"] == pytest.approx(found["momentum_before"], abs=1e-9)


def test_a_record_without_touches_has_none():
    assert len(record_of(0.1).impacts()) == 0
    with pytest.raises(IndexError):
        record_of(0.1).impacts(99)
    with pytest.raises(InputError, match="the record has no impacts: nothing came to touch"):
        record_of(0.1).plot_impacts()


def test_a_figure_has_a_panel_for_each_of_the_hardest_with_its_table():
    row = [Ball(pose=(x, 0, 0)) for x in (0.0, 0.4, 0.65, 0.9, 1.15, 1.4)]
    record = record_of(0.1, [row[0].replace(velocity=(1, 0, 0)), *row[1:]])
    assert len(record.impacts()) == 5
    axes = record.plot_impacts()
    assert len(axes) == len(axes[0].figure.axes) == 4
    cells = axes[0].tables[0].get_celld()
    assert cells[1, 0].get_text().get_text() == "before, along [m/s]"
    assert cells[1, 3].get_text().get_text() == "1 nearer"
    with pytest.raises(InputError, match="axes: 1 of them, for 4 panels of impacts"):
        record.plot_impacts(axes[:1])
