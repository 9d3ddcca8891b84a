"""The force on one body over time, read from the contacts so far."""

from __future__ import annotations

from bisect import bisect_left
from math import floor
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.output.layers.forces import mean_forces
from mars2d.physics.floor import GRAVITY
from mars2d.record.contact import CONTACT
from mars2d.record.frame import Float, Frame
from mars2d.scenario.scenario import Scenario

__all__ = ["Bound", "Meter", "Reading", "bound_of"]

STEPS, SECONDS = 100, 5.0
"""The last so many control steps are read, or seconds if that is more."""


class Reading(NamedTuple):
    """The last control steps of one body.

    start: seconds, where the first of them began. force: (k,) newtons, the length of the sum of the
    mean contact forces on it. effort: (k,) of its drive; None for a prop, or where it is not known.
    """

    start: float
    force: Float
    effort: Float | None


class Bound(NamedTuple):
    """A force [N] worth comparing with, and whose it is."""

    force: float
    name: str


def bound_of(frame: Frame, body: int) -> Bound | None:
    """Return what a robot's drive can push with, or what the floor holds a prop with."""
    scenario = frame.scenario
    n = len(scenario.robots)
    if body < n:
        return Bound(scenario.robots[body].drive.max_force, "drive's bound")
    prop = scenario.props[body - n]
    held = prop.ground_friction * prop.inertia.mass * GRAVITY
    return Bound(held, "floor's friction") if held > 0 else None


class Meter:
    """Reads the force on a body, once a control step.

    It keeps the contacts of the last control steps, so that step by step the long list of all
    contacts need not be asked for.
    """

    def __init__(self) -> None:
        """Start with nothing read."""
        self._scenario: Scenario | None = None
        self._steps = -1
        self._body = -1
        self._rows = np.empty(0, dtype=CONTACT)
        self._reading = Reading(0.0, np.empty(0), None)

    def read(self, frame: Frame, body: int) -> Reading:
        """Return the force on a body until the control step that led to a frame."""
        steps = len(frame.path)
        same = frame.scenario is self._scenario
        if same and (steps, body) == (self._steps, self._body):
            return self._reading
        dt = frame.scenario.sampling_time
        first = max(0, steps - 1 - floor(span_of(dt) / dt + 1e-6))
        if same and steps == self._steps + 1:
            rows = np.concatenate([self._rows, frame.contacts])
        elif same and steps == self._steps:
            rows = self._rows
        else:
            rows = frame.contact_log()
        # In order, but for those of one step.
        self._rows = rows[bisect_left(rows["time"], (first - 0.5) * dt) :]
        self._scenario, self._steps, self._body = frame.scenario, steps, body
        force = _net_force(self._rows, body, first, steps, dt)
        self._reading = Reading(first * dt, force, _effort(frame, body, first))
        return self._reading


def span_of(sampling_time: float) -> float:
    """Return how many seconds are read."""
    return max(SECONDS, STEPS * sampling_time)


def _net_force(rows: NDArray[np.void], body: int, first: int, last: int, dt: float) -> Float:
    """Return the net mean force on a body in each control step from first to last, newtons."""
    mine = rows[(rows["a"] == body) | (rows["b"] == body)]
    # What began at the very end of a step belongs to it; what began before it has its start's time.
    within = mine["time"] / dt + np.where(mine["began"], -1e-6, 1e-6)
    step = np.ceil(within).astype(int) - 1 - first
    seen = (step >= 0) & (step < last - first)
    mine, step = mine[seen], step[seen]
    force = mean_forces(mine, dt) * np.where(mine["b"] == body, 1.0, -1.0)[:, None]
    x, y = (np.bincount(step, force[:, k], last - first) for k in (0, 1))
    return np.hypot(x, y)


def _effort(frame: Frame, body: int, first: int) -> Float | None:
    """Return the efforts of a robot's drive in the control steps from the first one on."""
    if body >= len(frame.scenario.robots) or len(frame.effort_path) != len(frame.path):
        return None
    if len(frame.path) == 0:
        return np.empty(0)
    return np.append(frame.effort_path[first + 1 :, body], frame.effort[body])
