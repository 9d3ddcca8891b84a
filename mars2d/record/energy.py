"""Energy and momentum: of each body, and the work that has changed them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.core.description import wrong
from mars2d.core.errors import InputError, nearest
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]

WORK = ("drives", "floor", "friction", "impacts", "joints", "hands")
"""What works on bodies: the robots' drives; the floor under props; the friction of contacts, and
what they do along their normals; ropes, rods, hinges and springs; and pulls from outside."""


class Energy(NamedTuple):
    """Kinetic energies and works, J, at one instant, or at T of them with an axis in front.

    kinetic: (N,), of robots, then of props. work: (6,), what `WORK` names has done on all bodies
    since the start: what takes energy is negative. Springs give back what they took.
    """

    kinetic: Float
    work: Float

    @property
    def total(self) -> Float:
        """The kinetic energy of all bodies, J."""
        return np.asarray(self.kinetic.sum(axis=-1))

    @property
    def missing(self) -> Float:
        """What all works together do not account for, (T,) J: 0, but for rounding.

        It is the change of `total` since the first of T instants, less the work since then.
        """
        if not self.total.ndim:
            raise InputError("Energy.missing is of several instants: expected that of a record")
        unmoved = self.total - self.work.sum(axis=-1)
        return np.asarray(unmoved - unmoved[:1])

    def by(self, what: str) -> Float:
        """Return the work of one of `WORK` since the start, J. Raises InputError for others."""
        return np.asarray(self.work[..., WORK.index(_known(what))])


class Momentum(NamedTuple):
    """Momenta at one instant, or at T of them with an axis in front.

    linear: (2, N), x and y [N s], of robots, then of props. angular: that of all bodies about the
    origin, N m s.
    """

    linear: Float
    angular: Float

    @property
    def total(self) -> Float:
        """The momentum of all bodies (2,), N s."""
        return np.asarray(self.linear.sum(axis=-1))


def energy_of(scenario: Scenario, pose: Float, velocity: Float, work: Float) -> Energy:
    """Return the energy of bodies at poses and velocities (..., 3, N), given the work."""
    mass, moment = _inertia(scenario)
    vx, vy, spin = _of_centers(scenario, pose, velocity)
    return Energy((mass * (vx * vx + vy * vy) + moment * spin * spin) / 2, work)


def momentum_of(scenario: Scenario, pose: Float, velocity: Float) -> Momentum:
    """Return the momentum of bodies at poses and velocities (..., 3, N)."""
    mass, moment = _inertia(scenario)
    vx, vy, spin = _of_centers(scenario, pose, velocity)
    lead = _leads(scenario)
    x = pose[..., 0, :] + lead * np.cos(pose[..., 2, :])
    y = pose[..., 1, :] + lead * np.sin(pose[..., 2, :])
    angular = (mass * (x * vy - y * vx) + moment * spin).sum(axis=-1)
    return Momentum(np.stack([mass * vx, mass * vy], axis=-2), np.asarray(angular))


def _known(what: str) -> str:
    if what not in WORK:
        raise wrong("what", what, f"one of {', '.join(WORK)}{nearest(what, WORK, most=0)}")
    return what


def _inertia(scenario: Scenario) -> tuple[Float, Float]:
    """Return the masses and the moments about the centres of mass, (N,) each."""
    mass, moment = np.array([body.inertia for body in scenario.bodies], dtype=float).T
    return mass, moment


def _leads(scenario: Scenario) -> Float:
    """Return how far ahead of the poses the centres of mass lie, (N,) metres."""
    return np.array([body.lead for body in scenario.bodies], dtype=float)


def _of_centers(scenario: Scenario, pose: Float, velocity: Float) -> tuple[Float, Float, Float]:
    """Return the velocities of the centres of mass, and the spins, (..., N) each."""
    heading, spin, lead = pose[..., 2, :], velocity[..., 2, :], _leads(scenario)
    vx = velocity[..., 0, :] - lead * spin * np.sin(heading)
    vy = velocity[..., 1, :] + lead * spin * np.cos(heading)
    return vx, vy, spin
