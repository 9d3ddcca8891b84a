"""What theory says of a straight chase, and whether a run agrees."""

from math import cos, sin, sqrt, tan

import numpy as np
from scipy.optimize import brentq

from mars2d import Prediction


def duration(r, phi, d, g, v, pure):
    """How long it takes from r to d, by pure pursuit or constant bearing [s]."""
    if not pure:
        return (r - d) / v / (sqrt(1 - (g * sin(phi)) ** 2) - g * cos(phi))
    last = phi
    if sin(phi) > 1e-6:  # else a tail chase, or head-on
        bent = r * sin(phi) / tan(phi / 2) ** (1 / g)
        last = brentq(lambda at: bent / sin(at) * tan(at / 2) ** (1 / g) - d, 1e-12, phi)
    return (r * (1 + g * cos(phi)) - d * (1 + g * cos(last))) / (1 - g**2) / v


def touch(record):
    """At which distance the evader is caught [m]."""
    (red, blue), capture = record.scenario.robots, record.scenario.addons[0].capture
    return red.radius + blue.radius if capture == "contact" else capture


def checks(record):
    (red, blue), path = record.scenario.robots, record.pose[:-1, :2]
    v, g = red.drive.max_linear_speed, blue.drive.max_linear_speed / red.drive.max_linear_speed
    step, sight = np.diff(path, axis=0), path[:-1, :, 1] - path[:-1, :, 0]
    r, moved = np.hypot(*sight.T), np.hypot(*step.transpose(1, 0, 2))
    pure = ((sight * step[:, :, 0]).sum(axis=1) > 0.99 * r * moved[:, 0]).all()
    bearing = (sight[1:-1] @ sight[0] > 0.995 * r[0] * r[1:-1]).all()
    run = step[:, :, 1].sum(axis=0)
    textbook = np.hypot(*run) > 0.999 * moved[:, 1].sum() and (pure or bearing)
    if record.scenario.props or not textbook or g >= 1:
        yield Prediction.silent("capture", "for a slower evader that runs straight on")
        return
    ahead = run / np.hypot(*run)
    phi = np.arccos(np.clip(sight[0] @ ahead / r[0], -1, 1))
    time = duration(r[0], phi, touch(record), g, v, pure)
    there = path[0, :, 1] + g * v * time * ahead
    if np.abs(there).max() > record.scenario.workspace[2][0] - blue.radius:
        yield Prediction.silent("capture", "a wall is nearer than the meeting point")
        return
    if time > record.scenario.stop_time:
        yield Prediction.silent("capture", f"the game is over before {time:.1f} s")
        return
    captures = record.scenario.addons[0].outcome(record).captures
    late = (1 + g / (1 - g) / 2) * record.scenario.sampling_time  # a law looks once a step
    yield Prediction("capture", time, captures[0].time if captures else np.nan, late, "s")
