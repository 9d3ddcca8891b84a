"""The force on one body over time, read from the contacts so far."""

from __future__ import annotations

from bisect import bisect_left
from math import floor
from typing import NamedTuple

import numpy as np

from mars2d.floor import GRAVITY
from mars2d.forces import mean_forces
from mars2d.frame import Float, Frame

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
    """Reads the force on a body, once a control step."""

    def __init__(self) -> None:
        """Start with nothing read."""
        self._key: object = None
        self._reading = Reading(0.0, np.empty(0), None)

    def read(self, frame: Frame, body: int) -> Reading:
        """Return the force on a body until the control step that led to a frame."""
        key = (id(frame.scenario), body, len(frame.path))
        if key != self._key:
            self._key, self._reading = key, _read(frame, body)
        return self._reading


def span_of(sampling_time: float) -> float:
    """Return how many seconds are read."""
    return max(SECONDS, STEPS * sampling_time)


def _read(frame: Frame, body: int) -> Reading:
    dt = frame.scenario.sampling_time
    last = len(frame.path)
    first = max(0, last - 1 - floor(span_of(dt) / dt + 1e-6))
    log = frame.contact_log()
    log = log[bisect_left(log["time"], (first - 0.5) * dt) :]  # in order but for those of a step
    mine = log[(log["a"] == body) | (log["b"] == body)]
    step = np.ceil(mine["time"] / dt - 1e-6).astype(int) - 1 - first
    within = (step >= 0) & (step < last - first)
    mine, step = mine[within], step[within]
    force = mean_forces(mine, dt) * np.where(mine["b"] == body, 1.0, -1.0)[:, None]
    net = [np.bincount(step, force[:, k], last - first) for k in (0, 1)]
    return Reading(first * dt, np.hypot(*net), _effort(frame, body, first))


def _effort(frame: Frame, body: int, first: int) -> Float | None:
    """Return the efforts of a robot's drive in the control steps from the first one on."""
    if body >= len(frame.scenario.robots) or len(frame.effort_path) != len(frame.path):
        return None
    if len(frame.path) == 0:
        return np.empty(0)
    before: Float = frame.effort_path[first + 1 :, body]
    return np.append(before, frame.effort[body])
