"""Moments within a control step: what a record, with a row for each step, does not have."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from mars2d.core.usercode import quiet
from mars2d.physics.engine import Engine, Kinematics
from mars2d.record.frame import Frame
from mars2d.world.world import World

PARTS = 8
"""How many equal parts of a control step are looked at."""
ROUNDING = 1e-6
"""Contacts that begin so near to the ends of a step, in parts of it, begin there."""
SUMS = ("impulse", "normal_impulse", "tangential_impulse")
"""The fields of contacts that add up over a step."""


def moments_of(world: World, before: Frame, command: Any = None) -> list[Frame]:
    """Let a world do its next control step; return frames at moments within it.

    They are at equal parts of the step, and where contacts begin; the last one is at its end, and
    has all bits of the next row. Each is as if the step ended there. Its `contact_log` has the
    impulses of the step so far, and its `contacts` are scaled so that they give the mean force so
    far. before: the frame of now. command: as for `World.step`.
    """
    simulation, engine = world.simulation, world.simulation.engine.fork()
    with quiet():
        world.step(command)
    span = sum(part for part, _ in simulation.driven)
    begun = (simulation.contacts["time"] - before.time).tolist()
    within = {span * k / PARTS for k in range(1, PARTS)}
    within |= {t for t in begun if ROUNDING < t / span < 1 - ROUNDING}
    return [_moment(world, before, engine.fork(), t, t / span) for t in [*sorted(within), span]]


def _moment(
    world: World, before: Frame, engine: Engine | Kinematics, since: float, share: float
) -> Frame:
    """Return the frame at a time [s] since a step began, which an engine has not done yet.

    share: of the step.
    """
    time, left, n = before.time, since, len(before.scenario.robots)
    for part, twist in world.simulation.driven:
        now = part if share == 1.0 else min(part, left)  # to the bit
        if now > 0:
            world.operator.drive(engine, twist, now, time)
        time, left = time + part, left - part
    contacts, velocity = engine.take_contacts(), engine.velocity
    log, mean = np.concatenate([before.contact_log(), contacts]), contacts.copy()
    for name in SUMS:
        mean[name] /= share
    return replace(
        before,
        time=before.time + since,
        pose=engine.pose[:, :n],
        prop_pose=engine.pose[:, n:],
        sensed=before.pose,
        contacts=mean,
        contact_log=lambda: log,
        exact_velocity=velocity,
        work=engine.seen_work.copy(),
        effort=engine.take_effort(),
    )
