"""Impacts: what a blow did to the velocities, the energies and the momenta of two bodies."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.rigid import Rigid
from mars2d.core.arithmetic import norm
from mars2d.core.materials import GRAVITY
from mars2d.record.contact import mean_forces, met
from mars2d.scenario.scenario import Scenario

if TYPE_CHECKING:
    from mars2d.record.rows import Rows

Float = NDArray[np.float64]

IMPACT = np.dtype(
    [
        ("time", "f8"),  # s, when they met
        ("a", "i4"),  # index of a body: robots first, then props
        ("b", "i4"),  # index of another body, a < b; or -1 - k for obstacle k
        ("normal", "f8", (2,)),  # unit vector from a to b
        ("before", "f8", (2, 2)),  # m/s, of a and of b: along the normal, and across, to its left
        ("after", "f8", (2, 2)),
        ("spin_before", "f8", (2,)),  # rad/s, of a and of b
        ("spin_after", "f8", (2,)),
        ("impulse", "f8", (2,)),  # N s, on b: along the normal, and across
        ("restitution", "f8"),  # speed of parting / speed of approach, where they touched
        ("lost", "f8", (2,)),  # J, kinetic energy that a and b have lost; < 0: gained
        ("momentum_before", "f8", (2,)),  # N s, of both: x, y
        ("momentum_after", "f8", (2,)),
    ]
)
"""A row for each time that a pair came to touch. Velocities are those of the centres of mass."""


BRIEF = 1e-3
"""Seconds of a touch in which drives and floors do nothing worth mentioning."""

MORE, STILL = 1.01, 1e-3
"""How much faster bodies part than they should that have touched at two corners: as a factor, and
in m/s."""

TURNED = 0.1
"""The share of a speed that may be missing since a normal is the mean of a control step's."""


class _State(NamedTuple):
    """A body at an instant: the place and velocity of its centre of mass, and its spin."""

    time: float
    center: Float
    velocity: Float
    spin: float

    def at(self, point: Float) -> Float:
        """Return the velocity of its point (2,), m/s."""
        arm = point - self.center
        return self.velocity + self.spin * np.array([-arm[1], arm[0]])

    def later(self, time: float, slowing: float) -> _State:
        """Return the state at a later time, where the floor takes `slowing` m/s^2 from it."""
        spent, speed = time - self.time, norm(*self.velocity)
        share = max(0.0, 1.0 - slowing * spent / speed) if speed else 1.0
        way = spent * (1.0 + share) / 2 * self.velocity
        return _State(time, self.center + way, share * self.velocity, self.spin)

    def changed(self, velocity: Float) -> _State:
        """Return the state with more velocity (2,), m/s."""
        return self._replace(velocity=self.velocity + velocity)

    def pushed(self, body: Rigid, index: int, contacts: NDArray[np.void]) -> _State:
        """Return the state of the body of this index after the impulses of its contacts."""
        contacts = contacts[_of(contacts, index)]
        signs = np.where(contacts["a"] == index, -1.0, 1.0)
        impulses = signs[:, None] * mean_forces(contacts, 1.0)  # over 1 s
        arms = contacts["point"] - self.center
        turned = float((arms[:, 0] * impulses[:, 1] - arms[:, 1] * impulses[:, 0]).sum())
        pushed = self.changed(impulses.sum(axis=0) / body.inertia.mass)
        return pushed._replace(spin=self.spin + turned / body.inertia.moment)

    def energy(self, body: Rigid) -> float:
        """Return its kinetic energy, J."""
        mass, moment = body.inertia
        return float(mass * self.velocity @ self.velocity + moment * self.spin**2) / 2


_FIXED = _State(0.0, np.zeros(2), np.zeros(2), 0.0)


def impacts(record: Rows, row: int | None = None) -> NDArray[np.void]:
    """Return what each touch of two bodies did, a row (dtype IMPACT) each, in order of time.

    row: of the record, for those in the control step that led to it alone; negative numbers count
    from the end. None: all of them.

    `before` is at the touch: the velocity at the control step's start, less what the floor takes
    from a prop until then; the contact's speed and slip say how fast a robot came by its drive. A
    short touch that is over within its control step changes velocities by its impulses alone.
    Where bodies stay together, or bounce again in the same control step, which shows where they
    part faster than their restitution allows, `after` is at its end: drives and the floor have a
    share in it. Bodies that rest against each other from the start, without an impulse, have none.

    Raises IndexError if the record has no such row.
    """
    contacts, ends, found = record.contacts, record.contact_rows, []
    if row is not None:
        row = range(len(record))[row]
        contacts, ends = contacts[ends == row], ends[ends == row]
    after: dict[int, tuple[int, _State]] = {}  # each body's last control step with a touch
    for k in np.flatnonzero(met(contacts) & (contacts["speed"] + contacts["impulse"] > 0)):
        first, end = contacts[k], int(ends[k])
        if 0 < end < len(record):
            step = contacts[slice(*np.searchsorted(ends, [end, end + 1]))]
            found.append(_impact(record, end - 1, step, first, after))
    return np.array(found, dtype=IMPACT)


def card(scenario: Scenario, impact: np.void) -> list[tuple[str, str, str, str]]:
    """Return an impact as a table: labels, the numbers of a and of b, and those of both.

    Its first row has the names of the bodies.
    """
    names = [scenario.body_name(int(impact[side])) for side in "ab"]
    known = 2 if impact["b"] >= 0 else 1

    def number(value: float) -> str:
        return "-" if np.isnan(value) else f"{round(float(value), 9) + 0.0:.3g}"

    def each(name: str, column: int | None = None) -> list[str]:
        values = impact[name] if column is None else impact[name][:, column]
        return [number(value) for value in values[:known]] + ["-"] * (2 - known)

    def pair(name: str) -> str:
        return f"({', '.join(map(number, impact[name]))})"

    nearer, apart = impact["before"][:, 0] @ (1, -1), impact["after"][:, 0] @ (-1, 1)
    rows = [
        ("", *names, "both"),
        ("before, along [m/s]", *each("before", 0), f"{number(nearer)} nearer"),
        ("after, along", *each("after", 0), f"{number(apart)} apart"),
        ("before, across", *each("before", 1), ""),
        ("after, across", *each("after", 1), ""),
        ("spin before [rad/s]", *each("spin_before"), ""),
        ("spin after", *each("spin_after"), ""),
        ("energy lost [J]", *each("lost"), number(impact["lost"].sum())),
        ("momentum before [N s]", "", "", pair("momentum_before")),
        ("momentum after", "", "", pair("momentum_after")),
        ("impulse [N s]", "", "", pair("impulse")),
        ("restitution", "", "", number(impact["restitution"])),
    ]
    return [(label, a, b, both) for label, a, b, both in rows]


def _impact(
    record: Rows,
    row: int,
    step: NDArray[np.void],
    first: np.void,
    touched: dict[int, tuple[int, _State]],
) -> tuple[Any, ...]:
    """Return one impact. step: the contacts from row on. first: that with which two bodies met."""
    scenario, n = record.scenario_at(row), len(record.scenario.robots)
    sides, normal = [int(first["a"]), int(first["b"])], first["normal"]
    bodies = [scenario.bodies[i] if i >= 0 else None for i in sides]
    axes = np.array([normal, [-normal[1], normal[0]]])
    before, unknown, slowed = [], [], []
    for i in sides:
        known, state = touched.get(i, (-1, _FIXED))
        hit = _of(step, i) & (step["time"] < first["time"])
        unknown.append(0 <= i < n or (i >= 0 and known != row and bool(hit.any())))
        if i >= 0:
            state = state if known == row else _in_row(record, row, i)
            slowing = scenario.props[i - n].ground_friction * GRAVITY if i >= n else 0.0
            state = state.later(float(first["time"]), slowing)
        slowed.append(i >= n and slowing > 0 and bool(state.velocity.any()))
        before.append(state)
    _meet(before, unknown if any(unknown) else slowed, first, axes)
    rows = step[(step["a"] == first["a"]) & (step["b"] == first["b"])]
    ends = step["time"] + step["duration"]
    near = step[(step["time"] <= first["time"] + BRIEF) & (ends >= first["time"])]
    near = near[(near["a"] >= n) | (near["duration"] <= BRIEF)]  # without what robots push
    most = MORE * scenario.restitution_between(*sides) * first["speed"] + STILL
    for pushing in (rows, near) if rows["duration"].max() <= BRIEF else ():
        after = [
            state.pushed(body, i, pushing) if body else _FIXED
            for body, state, i in zip(bodies, before, sides, strict=True)
        ]
        parting = _parting(after, first)
        if parting <= most:
            touched |= {i: (row, end) for i, end in zip(sides, after, strict=True)}
            break
    else:
        after = [
            _in_row(record, row + 1, i)._replace(center=state.center) if i >= 0 else _FIXED
            for i, state in zip(sides, before, strict=True)
        ]
        parting = _parting(after, first) if rows["ended"].all() else 0.0
    restitution = max(0.0, parting) / first["speed"] if first["speed"] else np.nan
    mass = [body.inertia.mass if body else 0.0 for body in bodies]
    lost = [
        one.energy(body) - other.energy(body) if body else 0.0
        for body, one, other in zip(bodies, before, after, strict=True)
    ]
    return (
        first["time"], *sides, normal,
        [axes @ state.velocity for state in before], [axes @ state.velocity for state in after],
        [state.spin for state in before], [state.spin for state in after],
        axes @ mean_forces(rows, 1.0).sum(axis=0), restitution, lost,
        mass[0] * before[0].velocity + mass[1] * before[1].velocity,
        mass[0] * after[0].velocity + mass[1] * after[1].velocity,
    )  # fmt: skip


def _of(contacts: NDArray[np.void], body: int) -> NDArray[np.bool_]:
    """Return which of contacts (c,) are of a body."""
    return np.asarray((contacts["a"] == body) | (contacts["b"] == body))


def _parting(states: list[_State], first: np.void) -> float:
    """Return how fast two bodies part where they touched, m/s."""
    a, b = (state.at(first["point"]) for state in states)
    return float((b - a) @ first["normal"])


def _in_row(record: Rows, row: int, body: int) -> _State:
    """Return the state of a body in a row."""
    scenario = record.scenario_at(row)
    at = body - len(scenario.robots)
    x, y, theta = record.pose[row, :, body] if at < 0 else record.prop_pose[row, :, at]
    vx, vy, spin = record.velocity[row, :, body] if at < 0 else record.prop_velocity[row, :, at]
    ahead, left = scenario.bodies[body].lead * np.array([np.cos(theta), np.sin(theta)])
    velocity = np.array([vx - spin * left, vy + spin * ahead])
    return _State(float(record.time[row]), np.array([x + ahead, y + left]), velocity, float(spin))


def _meet(before: list[_State], changed: list[bool], first: np.void, axes: Float) -> None:
    """Correct the velocities of two bodies, so that they approach and slip as the contact says.

    What is missing is that of the bodies that were `changed` since the row, by a drive, another
    body or the floor; else that of the faster one, as by a joint, if it is more than rounding.
    """
    a, b = (state.at(first["point"]) for state in before)
    missing = axes.T @ (np.array([-first["speed"], first["slip"]]) - axes @ (b - a))
    speeds = [norm(*state.velocity) for state in before]
    if not any(changed) and norm(*missing) > TURNED * norm(*(b - a)):
        changed = [speeds[0] >= speeds[1], speeds[1] > speeds[0]]
    for side, sign in ((0, -1.0), (1, 1.0)):
        if changed[side]:
            before[side] = before[side].changed(sign / sum(changed) * missing)
