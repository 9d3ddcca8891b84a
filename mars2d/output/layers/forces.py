"""The forces of contacts as arrows where they act, and the drives that slip."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Scene
from mars2d.output.layers.arrows import (
    LONGEST,
    Ruler,
    arrow,
    as_read,
    beside,
    crowd_factor,
    shortening,
    usual_length,
)
from mars2d.output.layers.bodies import bounding_circle
from mars2d.record.contact import mean_forces
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]

FORCE = "#a3003c"
SLIP, SLIP_EDGE = "#ffc20a", "#3d2f00"
ARROW_WIDTH = 3.5

SLIPPING = 0.999
"""The effort from which on a drive is said to slip."""

FAINTEST = 0.01
"""Weaker forces, in shares of the strongest drive's, are not drawn."""

MAX_CONTACTS = 60
"""Of more contacts in a frame, the strongest are drawn."""

LABELED, MAX_LABELS = 0.15, 6
"""The share of the strongest drive's force from which on an arrow has a number, and how many of
the longest arrows have one."""


def force_scale(scenario: Scenario) -> Ruler:
    """Return the scale of an experiment; what is usual at most is the largest bound of a drive.

    Among few robots that is as long as a robot and a half, or as a part of the workspace where
    robots are small in it.
    """
    length, crowd = usual_length(scenario, 1.5, 0.06), crowd_factor(scenario)
    strongest = max(robot.drive.max_force for robot in scenario.robots)
    width, unit = ARROW_WIDTH / crowd**0.25, length / strongest / crowd
    return Ruler(FORCE, width, unit, LONGEST * length / crowd, in_newtons, strongest)


def forces(frame: Frame) -> Scene:
    """Return the mean forces of the control step that led to a frame, and which drives slip.

    Each contact has two opposite arrows from where it is, one on either body; on an obstacle there
    is none. A pair that touches by two normals has two contacts. In a crowd only the strongest are
    drawn.
    """
    scene = Scene()
    slip_marks(scene, frame)
    scenario, contacts = frame.scenario, frame.contacts
    if not len(contacts):
        return scene
    force = mean_forces(contacts, scenario.sampling_time)
    size = np.hypot(force[:, 0], force[:, 1])
    scale = force_scale(scenario)
    drawn = np.flatnonzero(size >= FAINTEST * scale.most)
    drawn = drawn[np.argsort(size[drawn], kind="stable")][-MAX_CONTACTS:]  # the strongest on top
    # A row says where its pair first touched; that point has moved with a since.
    since = np.clip(frame.time - contacts["time"], 0.0, scenario.sampling_time)
    at = contacts["point"] + frame.velocity[:2, contacts["a"]].T * since[:, None]
    shorter = shortening(scale.unit * size[drawn], scale.longest)
    reach = scale.unit * shorter[:, None] * force[drawn]
    for start, way, factor, solid in zip(
        at[drawn], reach, shorter, contacts["b"][drawn] >= 0, strict=True
    ):
        for each in (way, -way) if solid else (-way,):
            arrow(scene, start, each, fill=FORCE, width=scale.width, shortened=factor < 1)
    for k, row in list(enumerate(drawn.tolist()))[-MAX_LABELS:]:
        if size[row] >= LABELED * scale.most:
            way = reach[k] if contacts["b"][row] >= 0 else -reach[k]
            beside(scene, at[row] + way, way, in_newtons(float(size[row])), FORCE)
    return scene


def slip_marks(scene: Scene, frame: Frame) -> None:
    """Draw a ring of the warning colour round each robot whose drive is at its bound."""
    slipping = np.flatnonzero(frame.effort >= SLIPPING).tolist()
    share = crowd_factor(frame.scenario) ** -0.5
    for i in slipping:
        center, radius = bounding_circle(frame.scenario.robots[i].chassis, frame.pose[:, i])
        for color, width in ((SLIP_EDGE, 4.5), (SLIP, 2.7)):
            scene.circle(center, radius, stroke=color, width=share * width, pixels=1.5)


def in_newtons(force: float) -> str:
    """Return a force as it is read: 0.25 N, 4.9 N, 12 N, 2.4 kN."""
    return f"{force / 1000:.3g} kN" if force >= 999.5 else f"{as_read(force)} N"
