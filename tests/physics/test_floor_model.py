"""The floor's ellipsoid beside a floor that presses evenly, which is integrated here."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mars2d import Robot
from mars2d.bodies.props import Box, Prop, Puck
from mars2d.core.materials import GRAVITY
from tests.cases import each_case
from tests.worlds import drive, endless

MU = 0.4


def base(prop: Prop, n: int = 40) -> np.ndarray:
    """Points (2, n^2) of a prop's base, each of which bears as much."""
    part = (np.arange(n) + 0.5) / n
    if isinstance(prop, Puck):
        r, angle = np.meshgrid(prop.diameter / 2 * np.sqrt(part), 2 * np.pi * part)
        return np.stack([(r * np.cos(angle)).ravel(), (r * np.sin(angle)).ravel()])
    assert isinstance(prop, Box)
    x, y = np.meshgrid(prop.length * (part - 0.5), prop.width * (part - 0.5))
    return np.stack([x.ravel(), y.ravel()])


def evenly(prop: Prop, speed: float, spin: float) -> tuple[float, float]:
    """How far a prop goes [m] and turns [rad] until it rests, under even pressure."""
    points = base(prop)
    per_mass = prop.inertia.moment / prop.inertia.mass

    def rates(_: float, state: np.ndarray) -> list[float]:
        c, s = np.cos(state[2]), np.sin(state[2])
        x, y = c * points[0] - s * points[1], s * points[0] + c * points[1]
        vx, vy = state[3] - state[5] * y, state[4] + state[5] * x
        pull = -MU * GRAVITY / np.maximum(np.hypot(vx, vy), 1e-12)
        torque = (x * pull * vy - y * pull * vx).mean()
        return [*state[3:], (pull * vx).mean(), (pull * vy).mean(), torque / per_mass]

    def rests(_: float, state: np.ndarray) -> float:
        return float(np.hypot(state[3], state[4]) + 0.05 * abs(state[5]) - 1e-4)

    rests.terminal = True
    found = solve_ivp(
        rates, (0, 10), [0, 0, 0, speed, 0, spin], events=rests, rtol=1e-6, max_step=0.02
    )
    x, y, angle = found.y[:3, -1]
    return float(np.hypot(x, y)), float(angle)


def here(prop: Prop, speed: float, spin: float) -> tuple[float, float]:
    """The same on the floor of a world."""
    world = endless([Robot(pose=(50, 0, 0))], [prop.replace(velocity=(speed, 0, spin))])
    x, y, angle = drive(world, np.zeros((2, 1)), 6)[-1][:, 1]
    return float(np.hypot(x, y)), float(angle)


PROPS = {
    "puck": Puck(diameter=0.2, ground_friction=MU),
    "square": Box(length=0.3, width=0.3, ground_friction=MU),
    "oblong": Box(length=0.4, width=0.1, ground_friction=MU),
}


@each_case(("speed", "spin"), [(1.0, 0.0), (1.0, 2.0), (1.0, 10.0), (1.0, 40.0), (0.0, 9.0)])
@each_case("name", PROPS)
def test_the_floor_is_as_near_to_even_pressure_as_the_page_says(name, speed, spin):
    """What only slides or only spins goes as under even pressure."""
    way, angle = evenly(PROPS[name], speed, spin)
    our_way, our_angle = here(PROPS[name], speed, spin)
    if not (speed and spin):
        assert (our_way, our_angle) == pytest.approx((way, angle), rel=5e-3, abs=1e-9)
        return
    assert 0.8 < our_way / way < 1.01
    assert 0.79 < our_angle / angle < 1.08
    if name == "puck":
        told = {2.0: (0.0, 0.20), 10.0: (0.04, 0.10), 40.0: (0.16, 0.001)}[spin]
        assert 1 - our_way / way == pytest.approx(told[0], abs=0.006)
        assert 1 - our_angle / angle == pytest.approx(told[1], abs=0.006)
