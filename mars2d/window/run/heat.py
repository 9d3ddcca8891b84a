"""Forces in a crowd: how hard each body is squeezed, as a colour, where arrows would be a mat."""

from __future__ import annotations

from math import ceil

import numpy as np

from mars2d.core.scene import Scene, faded
from mars2d.output.layers.bodies import bounding_circle
from mars2d.output.layers.forces import FORCE, force_scale, in_newtons, slip_marks
from mars2d.record.contact import mean_forces
from mars2d.record.frame import Float, Frame

MOST, AGAIN = 30, 20
"""The most contacts of a picture that are drawn as arrows, and how few it takes until they are
again."""
HOTTEST = 10.0
"""The squeeze that has the full colour, in multiples of the strongest drive's force."""
SHADES = 10
"""How many colours there are."""
LABELED = 5
"""How many of the hardest squeezed bodies have a number; others have one under the pointer."""


def squeezes(frame: Frame) -> Float:
    """Return the sums of the magnitudes of all contact forces on each body, (n + p,) N."""
    total = np.zeros(len(frame.scenario.bodies))
    contacts = frame.contacts
    size = np.hypot(*mean_forces(contacts, frame.scenario.sampling_time).T)
    for side in ("a", "b"):
        moved = contacts[side] >= 0  # not an obstacle
        np.add.at(total, contacts[side][moved], size[moved])
    return total


def heat(scene: Scene, frame: Frame) -> None:
    """Draw a disc over each body, the redder the harder it is squeezed, and who slips."""
    total = squeezes(frame)
    slip_marks(scene, frame)
    hottest = HOTTEST * force_scale(frame.scenario).most
    order = [body for body in np.argsort(total).tolist() if total[body] > 0.01 * hottest]
    for body in order:
        shape, pose = frame.scenario.bodies[body].shape, np.array(frame.body_pose(body))
        center, radius = bounding_circle(shape, pose)
        share = min(ceil(SHADES * total[body] / hottest), SHADES) / SHADES  # few, to be kept
        scene.circle(center, radius, fill=faded(FORCE, 0.15 + 0.8 * share))
    for body in order[-LABELED:]:
        words, place = in_newtons(float(total[body])), frame.body_pose(body)[:2]
        scene.text(place, words, color=FORCE, size=12, anchor="above", halo="#ffffff")
