"""Contacts as data: who touched whom, when, where, how hard, for how long."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["CONTACT", "EPISODE", "ContactLog", "Solved", "episodes"]

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
"""One row a pair and control step in which the pair touched."""

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
"""One row a pair and time that it stayed in touch."""


class Solved(NamedTuple):
    """What the solver found after one substep, a row a contact of two shapes.

    bodies: (k, 2), robots and props as 0, 1, ..., obstacles as -1, -2, ... impulse: (k, 2) N s, up
    to its sign. normal: (k, 2) from the first to the second. on_first, on_second: (k, 2) the points
    on their surfaces. velocity: (k, 2) m/s of the second's point against the first's, before.
    """

    bodies: Int
    impulse: Float
    normal: Float
    on_first: Float
    on_second: Float
    velocity: Float


class ContactLog:
    """Gathers the contacts of the substeps of a control step, and sums them up by pairs."""

    def __init__(self) -> None:
        """Start without contacts."""
        self._times: list[float] = []
        self._lengths: list[float] = []
        self._solved: list[Solved] = []
        self._touching: list[list[int]] = []
        self._held: list[list[int]] = []  # those that touched after the substep before, too
        self._latest: set[int] = set()
        self._before: set[int] = set()

    def add(self, time: float, h: float, solved: Solved, touching: tuple[Int, Int]) -> None:
        """Note what the solver lists after a substep of h seconds, and which pairs do touch.

        touching: bodies (a, b), b negative for obstacles.
        """
        listed = set(_key(*_ordered(*solved.bodies.T)).tolist())
        keys = listed.intersection(_key(*_ordered(*touching)).tolist())
        self._times.append(time)
        self._lengths.append(h)
        self._solved.append(solved)
        self._touching.append(sorted(keys))
        self._held.append(sorted(keys & self._latest))
        self._latest = keys

    def add_nothing(self) -> None:
        """Note that nothing touches after a substep."""
        self._latest = set()

    def take(self) -> NDArray[np.void]:
        """Return the contacts since the last call, by time, one row (dtype CONTACT) a pair."""
        if not self._times:
            self._before = self._latest
            return np.empty(0, dtype=CONTACT)
        count = [len(solved.bodies) for solved in self._solved]
        substep = np.repeat(np.arange(len(count)), count)
        bodies, impulse, normal, first, second, velocity = (
            np.concatenate(parts) for parts in zip(*self._solved, strict=True)
        )
        a, b = _ordered(*bodies.T)
        swap = a != bodies[:, 0]
        normal = np.where(swap[:, None], -normal, normal)
        velocity = np.where(swap[:, None], -velocity, velocity)
        point = np.where(swap[:, None], second, first)
        # On b, and away from a: the sign that the solver gives depends on the order of the shapes.
        away = (impulse * normal).sum(axis=1)
        impulse = np.where(away[:, None] < 0, -impulse, impulse)

        key = _key(a, b)
        # Those listed in a substep that touch after it; the others parted shortly before.
        touching = _numbers(self._touching)
        names, number = np.unique(np.concatenate([key, touching]), return_inverse=True)
        touch_count = [len(keys) for keys in self._touching]
        when = np.concatenate([substep, np.repeat(np.arange(len(count)), touch_count)])
        both = when * len(names) + number.ravel()
        live = np.isin(both[: len(key)], both[len(key) :])
        # The solver lists them in the order of addresses in memory: put them in one that is always
        # the same, the strongest of a pair and substep first.
        rows = np.flatnonzero(live)
        strength = np.hypot(impulse[rows, 0], impulse[rows, 1])
        x, y = point[rows].T
        nx, ny = normal[rows].T
        rows = rows[np.lexsort((ny, nx, y, x, -strength, key[rows], substep[rows]))]
        pairs, start, group = np.unique(key[rows], return_index=True, return_inverse=True)
        group = group.ravel()
        row = rows[start]

        result = np.zeros(len(pairs), dtype=CONTACT)
        result["a"], result["b"] = a[row], b[row]
        result["normal"], result["point"] = normal[row], point[row]
        total = [np.bincount(group, impulse[rows, k], len(pairs)) for k in (0, 1)]
        result["impulse"] = np.hypot(*total)
        along = (impulse * normal)[rows].sum(axis=1)
        across = impulse[rows, 1] * normal[rows, 0] - impulse[rows, 0] * normal[rows, 1]
        result["normal_impulse"] = np.bincount(group, along, len(pairs))
        result["tangential_impulse"] = np.bincount(group, across, len(pairs))
        result["began"] = [pair not in self._before for pair in pairs.tolist()]
        fresh = result["began"]
        # What touched before does so from the start of the control step.
        when, took = np.array(self._times), np.array(self._lengths)
        result["time"] = when[substep[row]] - np.where(fresh, 0.0, took[substep[row]])
        result["speed"] = np.where(fresh, -(velocity * normal)[row].sum(axis=1), 0.0)
        result["slip"] = velocity[row, 1] * normal[row, 0] - velocity[row, 0] * normal[row, 1]
        lengths = np.repeat(self._lengths, [len(held) for held in self._held])
        held = np.searchsorted(pairs, _numbers(self._held))
        result["duration"] = np.bincount(held, lengths, len(pairs))
        result["ended"] = [pair not in self._latest for pair in pairs.tolist()]
        self._before = self._latest
        for notes in (self._times, self._lengths, self._solved, self._touching, self._held):
            notes.clear()
        return result[np.argsort(result["time"], kind="stable")]


def episodes(contacts: NDArray[np.void]) -> NDArray[np.void]:
    """Return what stayed in touch from when to when, one row (dtype EPISODE) an episode.

    contacts: rows of dtype CONTACT, in the order of time, as ``record.contacts``.
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


def _ordered(a: Int, b: Int) -> tuple[Int, Int]:
    """Return pairs with the lower body first, an obstacle last."""
    swap = (a < 0) | ((b >= 0) & (b < a))
    return np.where(swap, b, a), np.where(swap, a, b)


def _numbers(lists: list[list[int]]) -> Int:
    """Return the keys of several lists in one array."""
    return np.array([key for keys in lists for key in keys], dtype=np.int64)


def _key(a: Int, b: Int) -> Int:
    """Return one number a pair (a, b); those of a come in order, then those of b."""
    return (np.asarray(a, dtype=np.int64) << 32) + np.asarray(b, dtype=np.int64) + (1 << 31)
