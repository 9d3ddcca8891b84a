"""The contact force on one body over time, read from the contacts of a run."""

from __future__ import annotations

from bisect import bisect_left
from math import floor
from typing import NamedTuple

import numpy as np

from mars2d.core.materials import GRAVITY
from mars2d.record.contact import net_forces, pair_forces, rows_of
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
        return scenario.robots[body].push
    prop = scenario.props[body - n]
    return prop.resting_friction * prop.inertia.mass * GRAVITY


def reading_of(frame: Frame, body: int) -> Reading:
    """Return the force on a body up to the control step that led to a frame."""
    steps, dt = len(frame.path), frame.scenario.sampling_time
    first = max(0, steps - 1 - floor(span_of(dt) / dt + 1e-6))
    log = frame.contact_log()
    # Rows are in order of their steps, but not within a step.
    log = log[bisect_left(log["time"], (first - 0.5) * dt) :]
    rows = rows_of(log, np.arange(steps + 1, dtype=float) * dt, dt)
    net = net_forces(pair_forces(log, rows, dt), [body], range(first + 1, steps + 1))[:, :, 0]
    effort = None
    if body < len(frame.scenario.robots) and len(frame.effort_path) == steps:
        effort = np.append(frame.effort_path[first + 1 :, body], frame.effort[body : body + 1])
        effort = effort[: steps - first]
    return Reading(first * dt, np.hypot(*net.T), effort)


def span_of(sampling_time: float) -> float:
    """Return the time that a reading covers, seconds."""
    return max(MIN_SECONDS, MIN_STEPS * sampling_time)
