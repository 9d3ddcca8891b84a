"""Run a record again, and find where the numbers depart."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.map import Map
from mars2d.core.arithmetic import norms
from mars2d.core.errors import InputError, counted
from mars2d.physics.versions import versions
from mars2d.record.contact import CONTACT, rows_of
from mars2d.record.interventions import Change, Intervention
from mars2d.scenario.scenario import Scenario
from mars2d.scenario.serialize import MOVING
from mars2d.world.record import Record
from mars2d.world.world import World


@dataclass(frozen=True)
class Departure:
    """A difference between a record and the same run again.

    row, time [s]: of the record. what: "pose", "effort" or "contact". bodies: the name of the
    one that departs most, or of the pair in touch. metres, radians: the error of its pose.
    how: the rest, in words.
    """

    row: int
    time: float
    what: str
    bodies: tuple[str, ...]
    metres: float = 0.0
    radians: float = 0.0
    how: str = ""

    def __str__(self) -> str:
        """Return it in words."""
        names = " and ".join(self.bodies)
        if self.what == "pose":
            told = f"{names} is off by {self.metres:.3g} m and {self.radians:.3g} rad{self.how}"
        else:
            told = f"the {self.what} of {names} {self.how}"
        return f"row {self.row}, at {self.time:g} s: {told}"


def rerun(record: Record, progress: Callable[[int], None] | None = None) -> Departure | None:
    """Run the record's scenario again under its commands; None when all is the same to the bit.

    Poses, efforts and contacts are compared. progress: called with the number of rows done. Raises
    InputError for a record with a drive, joint or shape of the user's own, which a file does not
    hold.
    """
    needed = [part for part in record.missing if part.startswith(MOVING)]
    if needed:
        raise InputError(f"can't be run again: the file does not hold the {', '.join(needed)}")
    scenario = _in_motion(_as_long(record.scenario, record))
    interventions = [_in_motion_of(each) for each in record.interventions]
    world = World(scenario, seed=record.seed)
    done: dict[int, list[Intervention]] = defaultdict(list)
    for intervention in interventions:
        done[intervention.row].append(intervention)
    last, departure = -1, None
    for row, command in enumerate(record.command):
        for intervention in done[row]:
            world.operator.redo(intervention)
        departure = _departs(row, world, record)
        if departure is not None:
            break
        last = row
        if row < len(record) - 1:
            world.step(command)
        if progress is not None:
            progress(row + 1)
    return _contacts_depart(record, world.record, last) or departure


def _as_long(scenario: Scenario, record: Record) -> Scenario:
    """Return a scenario that is not over before the record.

    The workspace and the stop time have ended the run, or not: the record says how long it was.
    """
    longer = (len(record) + 1) * record.scenario.sampling_time
    exit_ = "ignore" if scenario.on_exit == "stop" else scenario.on_exit
    return scenario.replace(stop_time=longer, on_exit=exit_)


def other_versions(record: Record) -> dict[str, tuple[str, str]]:
    """Return the versions that differ, by name: that of the record, and the one here."""
    here = versions()
    return {
        name: (record.versions[name], here[name])
        for name in here
        if record.versions.get(name, here[name]) != here[name]
    }


def _in_motion(scenario: Scenario) -> Scenario:
    """Return a scenario with only the parts that matter to motion: of add-ons, their obstacles.

    Other things that add-ons do may need laws, which are not there, and may end the experiment.
    """
    addons = [
        Map(
            addon.obstacles(),
            name=addon.key,
            friction=addon.friction,
            restitution=addon.restitution,
            static_friction=addon.static_friction,
        )
        for addon in scenario.addons
        if addon.obstacles()
    ]
    return scenario.replace(addons=addons, robots=[r.replace(sensors=()) for r in scenario.robots])


def _in_motion_of(intervention: Intervention) -> Intervention:
    """Return an intervention with only the parts that matter to motion."""
    if isinstance(intervention, Change):
        return replace(intervention, scenario=_in_motion(intervention.scenario), control=None)
    return intervention


def _departs(row: int, world: World, record: Record) -> Departure | None:
    """Return the difference between a world and a row of a record, or None."""
    time = float(record.time[row])
    recorded = np.hstack([record.pose[row], record.prop_pose[row]])
    pose = np.hstack([world.pose, world.prop_pose])
    if not _same(recorded, pose):
        off = np.abs(pose - recorded)
        metres = norms(off[0], off[1])
        departing = np.flatnonzero(off.any(axis=0))
        if not len(departing):
            how = ": a zero has another sign"
            return Departure(row, time, "pose", ("a body",), how=how)
        most = departing[np.argmax(np.nan_to_num(metres + off[2], nan=np.inf)[departing])]
        others = len(departing) - 1
        how = f", and {counted(others, 'other')} by less" if others else ""
        return Departure(
            row,
            time,
            "pose",
            (record.scenario.body_name(int(most)),),
            float(metres[most]),
            float(off[2, most]),
            how,
        )
    if not _same(record.effort[row], world.effort):
        off = np.nan_to_num(np.abs(world.effort - record.effort[row]), nan=np.inf)
        i = int(np.argmax(off))
        how = f"is {world.effort[i]:.6g}, not {record.effort[row, i]:.6g}: off by {off[i]:.3g}"
        return Departure(row, time, "effort", (record.scenario.body_name(i),), how=how)
    return None


def _contacts_depart(first: Record, second: Record, last: int) -> Departure | None:
    """Return the first difference between the contacts of two records up to a row, or None.

    A run that was broken off may have contacts of a control step that has no row.
    """
    mine, other = (_contacts_until(record, first, last) for record in (first, second))
    count = min(len(mine), len(other))
    fields = CONTACT.names or ()
    differs = np.zeros(count, dtype=bool)
    for name in fields:
        apart = mine[name][:count] != other[name][:count]
        differs |= apart if apart.ndim == 1 else apart.any(axis=1)
    if not differs.any() and len(mine) == len(other):
        return None
    k = int(np.argmax(differs)) if differs.any() else count
    pairs = [_pair(first, r[k]) if k < len(r) else None for r in (mine, other)]
    step = first.scenario.sampling_time
    rows = [int(rows_of(r[k : k + 1], first.time, step)[0]) for r in (mine, other) if k < len(r)]
    row = min(rows)
    time = float(first.time[row])
    if pairs[0] is not None and pairs[0] == pairs[1]:
        name = next(n for n in fields if np.any(mine[k][n] != other[k][n]))
        off = np.abs(np.subtract(other[k][name], mine[k][name], dtype=float)).max()
        how = f"has another {name.replace('_', ' ')}: off by {off:.3g}"
        return Departure(row, time, "contact", pairs[0], how=how)
    # Of two that do not belong together, the one that comes first has no counterpart.
    alone = pairs[1] if pairs[0] is None or rows[-1] < rows[0] else pairs[0]
    assert alone is not None
    how = "is in the record only" if alone is pairs[0] else "is not in the record"
    return Departure(row, time, "contact", alone, how=how)


def _contacts_until(record: Record, first: Record, last: int) -> NDArray[np.void]:
    """Return the contacts of all control steps that led to a row or one before."""
    rows = rows_of(record.contacts, first.time, first.scenario.sampling_time)
    return record.contacts[rows <= last]


def _pair(record: Record, contact: np.void) -> tuple[str, str]:
    name = record.scenario.body_name
    return name(int(contact["a"])), name(int(contact["b"]))


def _same(first: NDArray[np.float64], second: NDArray[np.float64]) -> bool:
    """Return whether two arrays are the same to the last bit."""
    return first.tobytes() == second.tobytes()
