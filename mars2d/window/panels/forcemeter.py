"""The contact force on one body over time, read from the contacts of a run."""

from __future__ import annotations

from bisect import bisect_left
from math import floor
from typing import NamedTuple

import numpy as np

from mars2d.core.materials import GRAVITY
from mars2d.record.contact import CONTACT, net_forces, pair_forces, rows_of
from mars2d.record.frame import Float, Frame
from mars2d.scenario.scenario import Scenario

MIN_STEPS, MIN_SECONDS = 100, 5.0
"""A reading covers at least this many control steps, and this many seconds."""


class Reading(NamedTuple):
    """The forces of the last k control steps on one body.

    start: when the first of these steps began, seconds. force: (k,), the magnitude of the net mean
    contact force in each step, newtons. effort: (k,), of the drive; None for a prop, or if unknown.
    """

    start: float
    force: Float
    effort: Float | None


class Bound(NamedTuple):
    """A force [N] to compare a reading with, and its name."""

    force: float
    name: str


def bound_of(frame: Frame, body: int) -> Bound | None:
    """Return the largest force of a robot's drive or of the floor on a prop; None if that is 0."""
    force = holding_force(frame.scenario, body)
    if body < len(frame.scenario.robots):
        return Bound(force, "drive's bound")
    return Bound(force, "floor's friction") if force > 0 else None


def holding_force(scenario: Scenario, body: int) -> float:
    """Return the largest force with which a drive, or the floor, holds a body, newtons."""
    n = len(scenario.robots)
    if body < n:
        return scenario.robots[body].drive.max_force
    prop = scenario.props[body - n]
    return prop.resting_friction * prop.inertia.mass * GRAVITY


class Meter:
    """Reads the force on a body, once a control step.

    It keeps the contacts of the last control steps, so that it need not read the long log of all
    contacts at each step.
    """

    def __init__(self) -> None:
        """Start without a reading."""
        self._scenario: Scenario | None = None
        self._steps = -1
        self._body = -1
        self._rows = np.empty(0, dtype=CONTACT)
        self._reading = Reading(0.0, np.empty(0), None)

    def read(self, frame: Frame, body: int) -> Reading:
        """Return the force on a body up to the control step that led to a frame."""
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
        # Rows are in order of their steps, but not within a step.
        self._rows = rows[bisect_left(rows["time"], (first - 0.5) * dt) :]
        self._scenario, self._steps, self._body = frame.scenario, steps, body
        rows = rows_of(self._rows, np.arange(steps + 1, dtype=float) * dt, dt)
        pairs = pair_forces(self._rows, rows, dt)
        net = net_forces(pairs, [body], range(first + 1, steps + 1))[:, :, 0]
        self._reading = Reading(first * dt, np.hypot(*net.T), _effort(frame, body, first))
        return self._reading


def span_of(sampling_time: float) -> float:
    """Return the time that a reading covers, seconds."""
    return max(MIN_SECONDS, MIN_STEPS * sampling_time)


def _effort(frame: Frame, body: int, first: int) -> Float | None:
    """Return the efforts of a robot's drive from control step `first` on."""
    if body >= len(frame.scenario.robots) or len(frame.effort_path) != len(frame.path):
        return None
    if len(frame.path) == 0:
        return np.empty(0)
    return np.append(frame.effort_path[first + 1 :, body], frame.effort[body])
