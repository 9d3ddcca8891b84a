"""Facts about a body in words: its state, command, contacts and messages."""

from __future__ import annotations

import re
from itertools import pairwise
from math import degrees
from typing import Any

import numpy as np

from mars2d.bodies.drives.base import Drive
from mars2d.core.description import snake_case
from mars2d.core.materials import GRAVITY
from mars2d.core.plane import wrap
from mars2d.core.quantity import Quantity
from mars2d.output.layers.forces import SLIPPING, in_newtons
from mars2d.record.contact import net_forces, pair_forces
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario
from mars2d.window.widgets.rows import minus

MAX_MESSAGES = 3
"""How many messages of the inbox are listed."""

LONG_NUMBER = re.compile(r"(?<![\w.])-?\d+\.\d{3,}(e[+-]?\d+)?")

Row = tuple[str, list[tuple[str, str]]]
"""A label, and the names and values of up to three numbers."""


def kind_of(frame: Frame, body: int) -> str:
    """Return the kind of a body: its drive, or the kind of prop."""
    things = *(robot.drive for robot in frame.scenario.robots), *frame.scenario.props
    return snake_case(type(things[body]).__name__).replace("_", " ")


def state_of(frame: Frame, body: int) -> list[Row]:
    """Return a body's rows of numbers."""
    n = len(frame.scenario.robots)
    x, y, theta = frame.body_pose(body)
    vx, vy, omega = frame.velocity[:, body].tolist()
    place = [("x", _number(x, "m")), ("y", _number(y, "m"))]
    heading = [("θ", _degrees(theta)), ("", _number(float(wrap(theta)), "rad"))]
    pose: list[Row] = [("pose", place), ("heading", heading)]
    moves = [("v", _number(float(np.hypot(vx, vy)), "m/s")), ("ω", _number(omega, "rad/s"))]
    if body >= n:
        return [*pose, ("moves", moves)]
    drive = frame.scenario.robots[body].drive
    count, path = len(drive.inputs), frame.command_path
    command = path[-1][:count, body] if len(path) else np.zeros(count)
    rows: list[Row] = [*pose, ("command", command_words(drive, command)), ("moves", moves)]
    if drive.wheel_names is not None:
        speeds = drive.actuators(command[:, None])[:, 0].tolist()
        pairs = zip(drive.wheel_names, speeds, ("", "m/s"), strict=True)
        rows.append(("wheels", [(name, _number(speed, unit)) for name, speed, unit in pairs]))
    radius = drive.turning_radius(float(np.hypot(vx, vy)))
    if radius:
        rows.append(("turns", [("least radius", _number(radius, "m"))]))
    if body < len(frame.effort):
        effort = float(frame.effort[body])
        rows.append(("effort", [("", "slips" if effort >= SLIPPING else f"{100 * effort:.0f} %")]))
    return rows


def dynamics_of(frame: Frame, body: int) -> list[Row]:
    """Return a body's energy and momentum beside those of all bodies, where they are known."""
    energy, momentum = frame.energy, frame.momentum
    if energy is None or momentum is None:
        return []
    own, whole = float(energy.kinetic[body]), float(energy.total)
    p, total = np.hypot(*momentum.linear[:, body]), np.hypot(*momentum.total)
    return [
        ("energy", [("E", _digits(own, "J")), ("of all", _digits(whole, "J"))]),
        ("momentum", [("p", _digits(float(p), "N s")), ("of all", _digits(float(total), "N s"))]),
    ]


def force_of(frame: Frame, body: int) -> list[Row]:
    """Return the net mean contact force on a body in the last control step, and what holds it."""
    rows, dt = frame.contacts, frame.scenario.sampling_time
    pairs = pair_forces(rows, np.zeros(len(rows), dtype=int), dt)
    net = float(np.hypot(*net_forces(pairs, [body], range(1))[0, :, 0]))
    bound = holding_force(frame.scenario, body)
    holds = "drive" if body < len(frame.scenario.robots) else "floor"
    more = [(holds, in_newtons(bound))] if bound > 0 else []
    return [("force", [("net", in_newtons(net)), *more])]


def holding_force(scenario: Scenario, body: int) -> float:
    """Return the largest force with which a drive, or the floor, holds a body, newtons."""
    n = len(scenario.robots)
    if body < n:
        return scenario.robots[body].push
    prop = scenario.props[body - n]
    return prop.resting_friction * prop.inertia.mass * GRAVITY


def command_words(drive: Drive, command: Any) -> list[tuple[str, str]]:
    """Return the names and values of a command (m,); units that follow each other are said once."""
    units = [each.unit for each in drive.inputs] + [""]
    return [
        (each.symbol, _degrees(value) if each.kind == "angle" else _number(value, unit))
        for each, value, unit in zip(
            drive.inputs,
            np.asarray(command).tolist(),
            (own if own != after else "" for own, after in pairwise(units)),
            strict=True,
        )
    ]


def _number(value: float, unit: str = "") -> str:
    """Return a number in words, with its unit."""
    text = f"{value:z.2f}" if abs(value) < 1000 else f"{value:.3g}"
    return minus(f"{text} {unit}".strip())


def _digits(value: float, unit: str) -> str:
    """Return a number of three digits, with its unit; below a millionth it is 0."""
    return minus(f"{value if value >= 1e-6 else 0.0:.3g} {unit}")


def _degrees(angle: float) -> str:
    return minus(f"{round(degrees(wrap(angle))):d}°")


def in_both_units(angle: float) -> str:
    """Return a heading in degrees, and in radians as laws have it: ``90° (1.571 rad)``."""
    return minus(f"{np.degrees(angle):z.4g}° ({angle:z.4g} rad)")


def in_words(value: float, quantity: Quantity) -> str:
    """Return what a sensor reads in words, with its unit; angles in degrees."""
    if not np.isfinite(value):
        return "nothing" if np.isnan(value) or value > 0 else str(value)
    if quantity.kind == "angle":
        return minus(f"{round(degrees(value)):d}°")
    text = f"{value:.3f}" if abs(value) < 10 else f"{value:.4g}"
    return minus(f"{text} {quantity.unit.replace('^2', '²')}".strip())


def touching(frame: Frame, body: int) -> frozenset[int]:
    """Return the things that a body touches: indices of bodies, or -1 - k for obstacle k."""
    rows = frame.contacts
    others = np.where(rows["a"] == body, rows["b"], rows["a"])
    return frozenset(others[(rows["a"] == body) | (rows["b"] == body)].tolist())


def contacts_of(frame: Frame, body: int) -> list[str]:
    """Return the names and forces of a body's contacts, the strongest first."""
    rows = frame.contacts
    mine = rows[(rows["a"] == body) | (rows["b"] == body)]
    mine = pair_forces(mine, np.zeros(len(mine), dtype=int), frame.scenario.sampling_time)
    size, others = np.hypot(*mine["force"].T), mine["a"] + mine["b"] - body
    return [
        f"{frame.scenario.body_name(int(others[k]))}  {in_newtons(float(size[k]))}"
        for k in np.argsort(-size, kind="stable")
    ]


def rounded(text: str) -> str:
    """Return a message with its numbers rounded to three digits.

    >>> rounded('[0.1558127,-12.5,{"a": 1e-17}]')
    '[0.156,-12.5,{"a": 1e-17}]'
    """
    return LONG_NUMBER.sub(lambda found: f"{float(found[0]):.3g}", text)


def inbox(frame: Frame, robot: int, most: int = MAX_MESSAGES) -> list[tuple[str, float, str]]:
    """Return a robot's last messages: the sender's name, the time of sending [s], the content."""
    rows, contents = frame.message_log()
    now = frame.time + 1e-6 * frame.scenario.sampling_time
    heard = np.flatnonzero((rows["receiver"] == robot) & (rows["arrival"] <= now))[-most:][::-1]
    return [
        (
            str(frame.scenario.robots[int(row["sender"])].name),
            float(row["time"]),
            contents[int(row["content"])],
        )
        for row in rows[heard]
    ]
