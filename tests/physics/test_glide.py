"""What the floor does to what slides and spins on it: against the textbook and an integrator."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from mars2d import Robot, Scenario
from mars2d.bodies.props import Ball, Bar, Box, Prop, Puck
from mars2d.core.materials import GRAVITY
from tests.cases import each_case
from tests.islands import mover_of

speeds = st.one_of(st.just(0.0), st.floats(-5, -1e-3), st.floats(1e-3, 5))
times = st.floats(1e-3, 3)
props = st.sampled_from(
    [
        Puck(ground_friction=0.1),
        Box(ground_friction=0.5, mass=3),
        Bar(ground_friction=0.02),
        Ball(),
        Puck(ground_friction=0.3, moment=0.008),
        Puck(ground_friction=0.3, moment=0.001),
    ]
)


def glide(prop: Prop, velocity, h: float) -> tuple[np.ndarray, np.ndarray]:
    """The way and turned angle within h s, and the velocity then."""
    prop = prop.replace(pose=(9, 9, 0), velocity=tuple(map(float, velocity)))
    mover = mover_of(Scenario(robots=[Robot()], props=[prop], workspace=None))
    body = mover.bodies[1]
    mover.glide.over(body, h)
    moved = np.array([body.aim_x, body.aim_y, body.aim_spin]) * h
    return moved, np.array([body.end_x, body.end_y, body.end_spin])


def integrated(prop: Prop, velocity, h: float) -> np.ndarray:
    """The same by small steps: way, turned angle, then speed and spin; both fall together."""
    mass, moment = prop.inertia
    force, lever = prop.ground_friction * mass * GRAVITY, prop.shape.plate.lever
    speed, spin = float(np.hypot(*velocity[:2])), abs(velocity[2])

    def rates(t, y):
        u, s = max(y[2], 0.0), lever * max(y[3], 0.0)
        d = np.hypot(u, s)
        if d < 1e-9:
            return [0, 0, 0, 0]
        return [u, s / lever, -force / mass * u / d, -force * lever / moment * s / d]

    done = solve_ivp(rates, (0, h), [0, 0, speed, spin], rtol=1e-9, atol=1e-11, max_step=h / 50)
    return done.y[:, -1]


@given(prop=props, vx=speeds, vy=speeds, spin=speeds, h=times)
def test_what_slides_and_spins_goes_as_an_integrator_says(prop, vx, vy, spin, h):
    moved, end = glide(prop, (vx, vy, spin), h)
    way, turned, speed, left = integrated(prop, (vx, vy, spin), h)
    assert np.hypot(*moved[:2]) == pytest.approx(way, abs=1e-6)
    assert abs(moved[2]) == pytest.approx(turned, abs=1e-5)
    assert np.hypot(*end[:2]) == pytest.approx(speed, abs=1e-5)
    assert abs(end[2]) == pytest.approx(left, abs=1e-4)
    assert (moved * np.array([vx, vy, spin]) >= 0).all()
    assert moved[0] * vy == pytest.approx(moved[1] * vx, abs=1e-9)  # straight on


@given(prop=props, vx=speeds, vy=speeds, spin=speeds, first=times, second=times)
def test_gliding_for_two_times_is_gliding_for_their_sum(prop, vx, vy, spin, first, second):
    moved, end = glide(prop, (vx, vy, spin), first + second)
    half, between = glide(prop, (vx, vy, spin), first)
    rest, after = glide(prop, between, second)
    assert half + rest == pytest.approx(moved, abs=1e-9)
    assert after == pytest.approx(end, abs=1e-9)


@each_case("mu", [0.01, 0.1, 1.0])
def test_what_slides_stops_after_its_square_of_speed_over_twice_mu_g(mu):
    moved, end = glide(Puck(ground_friction=mu), (3.0, 4.0, 0.0), 1e4)
    assert np.hypot(*moved[:2]) == pytest.approx(25 / (2 * mu * GRAVITY), rel=1e-12)
    assert not end.any()


def test_what_spins_stops_after_its_angular_momentum_over_the_torque():
    puck = Puck(diameter=0.3, mass=2, ground_friction=0.2)
    # torque mu m g 2/3 r against the moment m r^2 / 2
    slowing = 0.2 * GRAVITY * (2 / 3 * 0.15) / (0.15**2 / 2)
    moved, end = glide(puck, (0.0, 0.0, -10.0), 100.0)
    assert moved[2] == pytest.approx(-(10**2) / (2 * slowing), rel=1e-12)
    assert not end.any()


def test_what_rests_stays_at_rest_and_what_nothing_brakes_goes_on():
    moved, end = glide(Puck(), (0.0, 0.0, 0.0), 3.0)
    assert not moved.any()
    assert not end.any()
    moved, end = glide(Ball(), (1.0, -2.0, 3.0), 3.0)
    assert moved.tolist() == [3, -6, 9]
    assert end.tolist() == [1, -2, 3]
