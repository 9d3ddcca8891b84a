"""Contacts as data: who touched whom, when, where, how hard, and for how long."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["CONTACT", "EPISODE", "ContactLog", "Solved", "episodes", "rows_of"]

Float = NDArray[np.float64]
Int = NDArray[np.int64]

CONTACT = np.dtype(
    [
        ("time", "f8"),  # s, when the bodies were first in touch during the control step
        ("duration", "f8"),  # s, for how long they touched during the control step
        ("a", "i4"),  # index of a body: robots first, then props
        ("b", "i4"),  # index of another body, a < b; or -1 - k for obstacle k
        ("point", "f8", (2,)),  # m, on the surface of a
        ("normal", "f8", (2,)),  # unit vector from a to b
        ("impulse", "f8"),  # N s, over the control step: the length of its sum
        ("normal_impulse", "f8"),  # N s, that part of it along the normal
        ("tangential_impulse", "f8"),  # N s, on b, along the normal turned by +90 degrees
        ("speed", "f8"),  # m/s, at which they approached when they came to touch; 0 if they did
        ("slip", "f8"),  # m/s, of b along a then, along the normal turned by +90 degrees
        ("began", "?"),  # whether they did not touch in the control step before
        ("ended", "?"),  # whether they had parted by the end of the control step
    ]
)
"""A row for each pair and control step in which the pair touched."""

EPISODE = np.dtype(
    [
        ("began", "f8"),  # s
        ("ended", "f8"),  # s; when they last touched, if they had not parted at the end
        ("a", "i4"),
        ("b", "i4"),
        ("speed", "f8"),  # m/s, at which they met
        ("normal_impulse", "f8"),  # N s, over all of it
        ("tangential_impulse", "f8"),  # N s, on b
    ]
)
"""A row for each time that a pair touched until it parted."""


class Solved(NamedTuple):
    """The solver's results of one substep, a row for each contact of two shapes.

    bodies: (k, 2), robots and props as 0, 1, ..., obstacles as -1, -2, ... impulse: (k, 2) N s, its
    sign undefined. normal: (k, 2) from the first body to the second. on_first, on_second: (k, 2) m,
    the points on their surfaces. velocity: (k, 2) m/s, of the second body's point relative to the
    first's, before the substep.
    """

    bodies: Int
    impulse: Float
    normal: Float
    on_first: Float
    on_second: Float
    velocity: Float


class ContactLog:
    """Collects the contacts of a control step's substeps, and adds them up by pairs."""

    def __init__(self) -> None:
        """Start without contacts."""
        self._notes: list[tuple[float, float, bool]] = []  # time, length, whether contacts go on
        self._solved: list[Solved] = []
        self._touching: list[tuple[Int, Int]] = []
        self._goes_on = True  # whether something touched after the last substep
        self._before: set[int] = set()  # the pairs that touched at the last call of `take`

    def add(self, time: float, h: float, solved: Solved, touching: tuple[Int, Int]) -> None:
        """Add the solver's results after a substep of h seconds, and the pairs that touch.

        touching: two arrays of bodies, (a, b); b is negative for obstacles.
        """
        self._notes.append((time, h, self._goes_on))
        self._solved.append(solved)
        self._touching.append(touching)
        self._goes_on = True

    def add_nothing(self) -> None:
        """Add a substep after which nothing touches."""
        self._goes_on = False

    def take(self) -> NDArray[np.void]:
        """Return the contacts since the last call, by time: a row (dtype CONTACT) for each pair."""
        notes, solved, touching = self._notes, self._solved, self._touching
        before, ongoing = self._before, self._goes_on
        self._notes, self._solved, self._touching, self._goes_on = [], [], [], True
        if not notes:
            self._before = before if ongoing else set()
            return np.empty(0, dtype=CONTACT)
        times, lengths, follows = np.array(notes).T
        bodies, impulse, normal, first, second, velocity = _joined(solved)
        a, b = _ordered(*bodies.T)
        key, substep = _key(a, b), _repeated([len(one.bodies) for one in solved])
        # Of the contacts in a substep those that touch after it; the others have just parted.
        touched = _repeated([len(one) for one, _ in touching]).tolist()
        touch = set(zip(touched, _key(*_ordered(*_joined(touching))).tolist(), strict=True))
        listed = zip(substep.tolist(), key.tolist(), strict=True)
        rows = np.flatnonzero(np.array([pair in touch for pair in listed], dtype=bool))

        swap = (a != bodies[:, 0])[rows, None]
        key, substep, impulse = key[rows], substep[rows], impulse[rows]
        normal = np.where(swap, -normal[rows], normal[rows])
        velocity = np.where(swap, -velocity[rows], velocity[rows])
        point = np.where(swap, second[rows], first[rows])
        # On b, and away from a: the solver's sign depends on the order of the shapes.
        away = (impulse * normal).sum(axis=1)
        impulse = np.where(away[:, None] < 0, -impulse, impulse)
        # The solver lists contacts in the order of addresses in memory. Put them in an order that
        # is always the same, with the strongest of a pair and substep first.
        strength = np.hypot(impulse[:, 0], impulse[:, 1])
        order = np.lexsort((*normal.T[::-1], *point.T[::-1], -strength, key, substep))
        key, substep, impulse, normal = key[order], substep[order], impulse[order], normal[order]
        pairs, row, group = np.unique(key, return_index=True, return_inverse=True)
        there = np.zeros((len(notes) + 1, len(pairs)), dtype=bool)  # at the start, after substeps
        there[0] = [pair in before for pair in pairs.tolist()]
        there[substep + 1, group] = True
        stayed, who = np.nonzero(there[1:] & there[:-1] & (follows > 0)[:, None])

        def total(which: Int, what: Float) -> Float:
            return np.asarray(np.bincount(which, what, len(pairs)), dtype=np.float64)

        result = np.zeros(len(pairs), dtype=CONTACT)
        result["a"], result["b"] = a[rows][order][row], b[rows][order][row]
        result["normal"], result["point"] = normal[row], point[order][row]
        result["impulse"] = np.hypot(total(group, impulse[:, 0]), total(group, impulse[:, 1]))
        result["normal_impulse"] = total(group, (impulse * normal).sum(axis=1))
        result["tangential_impulse"] = total(group, _across(impulse, normal))
        result["duration"] = total(who, lengths[stayed])
        fresh, met = ~there[0], velocity[order][row]
        result["began"], result["ended"] = fresh, ~there[-1] | (not ongoing)
        # Contacts that go on begin at the start of the control step.
        start = np.where(fresh, 0.0, lengths[substep[row]])
        result["time"] = times[substep[row]] - start
        result["speed"] = np.where(fresh, -(met * normal[row]).sum(axis=1), 0.0)
        result["slip"] = _across(met, normal[row])
        self._before = set(pairs[~result["ended"]].tolist())
        return result[np.argsort(result["time"], kind="stable")]


def episodes(contacts: NDArray[np.void]) -> NDArray[np.void]:
    """Return the episodes of contacts, each from touch to parting: a row (dtype EPISODE) each.

    contacts: rows of dtype CONTACT, in the order of time, such as ``record.contacts``.
    """
    key = _key(contacts["a"], contacts["b"])
    order = np.lexsort((contacts["time"], key))
    rows = contacts[order]
    group = np.cumsum(rows["began"] | (np.diff(key[order], prepend=-1) != 0)) - 1
    count = int(group[-1]) + 1 if len(rows) else 0
    first = np.searchsorted(group, np.arange(count))
    last = np.searchsorted(group, np.arange(count), side="right") - 1
    result = np.zeros(count, dtype=EPISODE)
    result["began"] = rows["time"][first]
    result["ended"] = rows["time"][last] + rows["duration"][last]
    for name in ("a", "b", "speed"):
        result[name] = rows[name][first]
    for name in ("normal_impulse", "tangential_impulse"):
        result[name] = np.bincount(group, rows[name], count)
    return result[np.argsort(result["began"], kind="stable")]


def rows_of(contacts: NDArray[np.void], time: Float, sampling_time: float) -> NDArray[np.intp]:
    """Return the row of a record at the end of each contact's control step, (c,).

    contacts: (c,) of dtype CONTACT. time: (T,) seconds, of the rows; contacts after the last row
    get T. A contact that begins at the very end of a control step belongs to it, and so does one
    that went on from before, whose time is the step's start.
    """
    rounding = 1e-6 * sampling_time
    within = contacts["time"] + np.where(contacts["began"], -rounding, rounding)
    return np.searchsorted(time, within, side="left")


def _ordered(a: Int, b: Int) -> tuple[Int, Int]:
    """Return pairs with the lower index first, but obstacles second."""
    swap = (a < 0) | ((b >= 0) & (b < a))
    return np.where(swap, b, a), np.where(swap, a, b)


def _joined(parts: Sequence[tuple[NDArray[Any], ...]]) -> list[NDArray[Any]]:
    """Join the parts of each column."""
    return [np.concatenate(column) for column in zip(*parts, strict=True)]


def _repeated(counts: list[int]) -> Int:
    """Return 0 repeated counts[0] times, then 1 repeated counts[1] times, and so on."""
    return np.repeat(np.arange(len(counts)), counts)


def _across(vector: Float, normal: Float) -> Float:
    """Return the components of vectors (k, 2) along normals turned by +90 degrees."""
    return np.asarray(vector[:, 1] * normal[:, 0] - vector[:, 0] * normal[:, 1])


def _key(a: Int, b: Int) -> Int:
    """Return a number for each pair, which sorts pairs by a, then by b."""
    return (np.asarray(a, dtype=np.int64) << 32) + np.asarray(b, dtype=np.int64) + (1 << 31)
