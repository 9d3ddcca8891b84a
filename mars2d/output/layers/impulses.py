"""The impulses of blows, normal and friction apart, with the cone that friction keeps them in."""

from __future__ import annotations

from bisect import bisect_left
from math import atan, hypot

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Scene, faded
from mars2d.output.layers.arrows import EDGE, Ruler, arrow, beside, shortening
from mars2d.output.layers.forces import force_scale
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]

NORMAL, FRICTION = "#4527a0", "#b34700"
"""The colours of the two parts of an impulse; the cone has that of friction."""

SHOWN = 1.0
"""For how long a blow is shown, seconds."""

FAINTEST = 0.05
"""Weaker blows, in shares of the largest momentum of a body, are not shown."""

MAX_BLOWS = 6
"""Of more blows, the strongest are shown."""

LEAST_FRICTION = 0.02
"""Less friction, in shares of the normal impulse, has no arrow."""

LONGER, ASIDE = 1.25, 0.65
"""The length of the largest momentum, and the distance of impulses from where they act, as
multiples of the length of the largest bound of a drive's force."""

CONE = 1.15
"""The length of the cone's sides, as a multiple of that of the impulse."""


def impulse_scale(scenario: Scenario) -> Ruler:
    """Return the scale of an experiment: the largest momentum is longer than the largest force.

    That is a momentum of robots at their drives' bounds, of props at the start.
    """
    force, count = force_scale(scenario), len(scenario.robots)
    fastest = [robot.drive.max_linear_speed for robot in scenario.robots]
    fastest += [hypot(*body.velocity[:2]) for body in scenario.bodies[count:]]
    strongest = max(
        body.inertia.mass * speed for body, speed in zip(scenario.bodies, fastest, strict=True)
    )
    unit = LONGER * force.unit * force.most / strongest
    return Ruler(NORMAL, force.width, unit, force.longest, in_newton_seconds, strongest)


def blows(frame: Frame) -> NDArray[np.void]:
    """Return the contacts that began in the last second up to a frame with a blow, (k,).

    Their dtype is `mars2d.record.CONTACT`; the strongest come last. Of a pair they are the newest.
    The impulse of a blow is that of the control step in which two bodies came to touch.
    """
    scenario, log = frame.scenario, frame.contact_log()
    since = frame.time - SHOWN
    # The log is in order from one control step to the next, though not within one.
    first = bisect_left(
        range(len(log)), since - scenario.sampling_time, key=lambda k: float(log[k]["time"])
    )
    recent = log[first:]
    now = (recent["time"] > since) & (recent["time"] <= frame.time + 1e-9)
    felt = recent["impulse"] >= FAINTEST * impulse_scale(scenario).most
    found = recent[recent["began"] & now & felt]
    _, pair = np.unique(np.column_stack([found["a"], found["b"]]), axis=0, return_inverse=True)
    newest = np.zeros(len(found))
    np.maximum.at(newest, pair.ravel(), found["time"])
    found = found[found["time"] == newest[pair.ravel()]]
    return np.asarray(found[np.argsort(found["impulse"], kind="stable")][-MAX_BLOWS:])


def impulses(frame: Frame) -> Scene:
    """Return the blows of the last second, each where it was, for as long.

    Of a pair the impulse on the second body is drawn, on an obstacle that on the other body. An
    arrow along the normal is the normal impulse; one across from its tip is that of friction. The
    sum ends within the cone, the angle of whose sides is atan(mu). All this stands a little beside
    the point of contact, where the arrows of forces are.
    """
    scene, scenario = Scene(), frame.scenario
    scale, force = impulse_scale(scenario), force_scale(scenario)
    aside = ASIDE * force.unit * force.most
    for blow in blows(frame):
        a, b = int(blow["a"]), int(blow["b"])
        normal = blow["normal"] * (1.0 if b >= 0 else -1.0)
        there = b >= -len(scenario.surfaces)  # an obstacle may have been removed since
        mu = scenario.friction_between(a, b) if there else 0.0
        press, rub = float(blow["normal_impulse"]), float(blow["tangential_impulse"])
        _diagram(scene, scale, aside, blow["point"], normal, press, rub, mu)
    return scene


def _diagram(
    scene: Scene, scale: Ruler, aside: float, point: Float, normal: Float, press: float, rub: float,
    mu: float,
) -> None:  # fmt: skip
    """Draw the two parts of an impulse, and the cone, `aside` metres beside a point.

    press, rub: N s.
    """
    tangent = np.array([-normal[1], normal[0]]) * (1.0 if rub >= 0 else -1.0)
    length = scale.unit * hypot(press, rub)
    shorter = float(shortening(np.array(length), scale.longest))
    unit, cut = scale.unit * shorter, shorter < 1
    apex = point - aside * tangent
    scene.line([point, apex], stroke=NORMAL, width=1.2, style=":")
    scene.circle(point, 0.0, fill=NORMAL, stroke=EDGE, pixels=3.5)
    if mu > 0:
        pose = (*apex, float(np.arctan2(normal[1], normal[0])))
        scene.sector(
            pose, CONE * shorter * length, 2 * atan(mu),
            fill=faded(FRICTION, 0.16), stroke=faded(FRICTION, 0.7), width=1.2,
        )  # fmt: skip
    ahead, across = unit * press * normal, unit * abs(rub) * tangent
    rubs = abs(rub) >= LEAST_FRICTION * press
    if rubs:
        arrow(scene, apex + ahead, across, fill=FRICTION, width=scale.width, shortened=cut)
    arrow(scene, apex, ahead, fill=NORMAL, width=scale.width, shortened=cut)
    if rubs:
        beside(scene, apex + ahead + across, normal, in_newton_seconds(abs(rub)), FRICTION)
        beside(scene, apex, -normal, in_newton_seconds(press), NORMAL)
    else:
        beside(scene, apex + ahead, normal, in_newton_seconds(press), NORMAL)


def in_newton_seconds(impulse: float) -> str:
    """Return an impulse as it is read, with two digits: 0.25 N s, 12 N s, 3.4 mN s."""
    size, unit = (impulse, "N s") if impulse >= 0.00995 else (1000 * impulse, "mN s")
    if size == 0:
        return "0 N s"
    decimals = max(0, 1 - int(f"{size:.1e}".partition("e")[2]))
    return f"{size:.{decimals}f} {unit}"
