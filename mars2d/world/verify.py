"""Run a record again, and find where the numbers depart."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.map import Map
from mars2d.core.arithmetic import norms
from mars2d.core.errors import InputError
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

    row, time [s]: of the record. what: "pose", "effort" or "contact". bodies: the name of the one
    that departs most, or of the pair in touch. how: by how much, in words.
    """

    row: int
    time: float
    what: str
    bodies: tuple[str, ...]
    how: str

    def __str__(self) -> str:
        """Return it in words."""
        names = " and ".join(self.bodies)
        return f"row {self.row}, at {self.time:g} s: the {self.what} of {names} {self.how}"


def rerun(record: Record, progress: Callable[[int], None] | None = None) -> Departure | None:
    """Run the record's scenario again under its commands; None when all is the same to the bit.

    Poses, efforts and contacts are compared. progress: called with the number of rows done. Raises
    InputError for a record with a drive, joint or shape of the user's own, which a file does not
    hold.
    """
    needed = [part for part in record.missing if part.startswith(MOVING)]
    if needed:
        raise InputError(f"can't be run again: the file does not hold the {', '.join(needed)}")
    world = World(_in_motion(_as_long(record)), seed=record.seed)
    done: dict[int, list[Intervention]] = defaultdict(list)
    for each in record.interventions:
        done[each.row].append(_in_motion_of(each))
    departure, last = None, len(record) - 1
    for row, command in enumerate(record.command):
        for intervention in done[row]:
            world.operator.redo(intervention)
        departure = _departs(row, world, record)
        if departure is not None:
            last = row - 1
            break
        if row < len(record) - 1:
            world.step(command)
        if progress is not None:
            progress(row + 1)
    return _contacts_depart(record, world.record, last) or departure


def _as_long(record: Record) -> Scenario:
    """Return a scenario that is not over before the record.

    The workspace and the stop time have ended the run, or not: the record says how long it was.
    """
    scenario = record.scenario
    longer = (len(record) + 1) * scenario.sampling_time
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
    time, name = float(record.time[row]), record.scenario.body_name
    pose = np.hstack([world.pose, world.prop_pose])
    recorded = np.hstack([record.pose[row], record.prop_pose[row]])
    if pose.tobytes() != recorded.tobytes():
        off = np.abs(pose - recorded)
        metres = norms(off[0], off[1])
        most = int(np.argmax(np.nan_to_num(metres + off[2], nan=np.inf)))
        how = f"is off by {metres[most]:.3g} m and {off[2, most]:.3g} rad"
        return Departure(row, time, "pose", (name(most),), how)
    if world.effort.tobytes() != record.effort[row].tobytes():
        off = np.nan_to_num(np.abs(world.effort - record.effort[row]), nan=np.inf)
        i = int(np.argmax(off))
        return Departure(row, time, "effort", (name(i),), f"is off by {off[i]:.3g}")
    return None


def _contacts_depart(first: Record, second: Record, last: int) -> Departure | None:
    """Return the first difference between the contacts of two records up to a row, or None.

    A run that was broken off may have contacts of a control step that has no row.
    """
    mine, other = (_contacts_until(record, first, last) for record in (first, second))
    count = min(len(mine), len(other))
    differs = np.zeros(count, dtype=bool)
    for name in CONTACT.names or ():
        apart = mine[name][:count] != other[name][:count]
        differs |= apart if apart.ndim == 1 else apart.any(axis=1)
    if not differs.any() and len(mine) == len(other):
        return None
    k = int(np.argmax(differs)) if differs.any() else count
    found = [contacts[k : k + 1] for contacts in (mine, other) if k < len(contacts)]
    rows = [int(rows_of(each, first.time, first.scenario.sampling_time)[0]) for each in found]
    row = min(rows)
    contact = found[rows.index(row)][0]
    pair = tuple(first.scenario.body_name(int(contact[side])) for side in "ab")
    return Departure(row, float(first.time[row]), "contact", pair, "is not the same")


def _contacts_until(record: Record, first: Record, last: int) -> NDArray[np.void]:
    """Return the contacts of all control steps that led to a row or one before."""
    rows = rows_of(record.contacts, first.time, first.scenario.sampling_time)
    return record.contacts[rows <= last]
