"""Run a record again, and find where the numbers depart."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from operator import itemgetter

import numpy as np

from mars2d.addons.map import Map
from mars2d.core.arithmetic import norms
from mars2d.core.errors import InputError
from mars2d.physics.versions import versions
from mars2d.record.contact import rows_of
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
    # The workspace and the stop time have ended the run, or not: the record says how long it was.
    longer = (len(record) + 1) * record.scenario.sampling_time
    on_exit = "ignore" if record.scenario.on_exit == "stop" else record.scenario.on_exit
    scenario = _in_motion(record.scenario).replace(stop_time=longer, on_exit=on_exit)
    world = World(scenario, seed=record.seed)
    departure, last = None, len(record) - 1
    for row, command in enumerate(record.command):
        world.operator.redo(record.interventions, lambda change: _in_motion(change.scenario))
        departure = _departs(row, world, record)
        if departure is not None:
            last = row - 1
            break
        if row < len(record) - 1:
            world.step(command)
        if progress is not None:
            progress(row + 1)
    return _contacts_depart(record, world.record, last) or departure


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


def _departs(row: int, world: World, record: Record) -> Departure | None:
    """Return the difference between a world and a row of a record, or None."""
    time, name = float(record.time[row]), record.scenario.body_name
    pose = np.hstack([world.pose, world.prop_pose])
    recorded = np.hstack([record.pose[row], record.prop_pose[row]])
    if pose.tobytes() != recorded.tobytes():
        off = np.nan_to_num(np.abs(pose - recorded), nan=np.inf)
        metres = norms(off[0], off[1])
        most = int(np.argmax(metres + off[2]))
        how = f"is off by {metres[most]:.3g} m and {off[2, most]:.3g} rad"
        return Departure(row, time, "pose", (name(most),), how)
    if world.effort.tobytes() != record.effort[row].tobytes():
        shares = np.nan_to_num(np.abs(world.effort - record.effort[row]), nan=np.inf)
        most = int(np.argmax(shares))
        return Departure(row, time, "effort", (name(most),), f"is off by {shares[most]:.3g}")
    return None


def _contacts_depart(first: Record, second: Record, last: int) -> Departure | None:
    """Return the first difference between the contacts of two records up to a row, or None.

    A run that was broken off may have contacts of a control step that has no row.
    """
    every = [
        (rows_of(each.contacts, first.time, first.scenario.sampling_time), each.contacts)
        for each in (first, second)
    ]
    (_, mine), (_, other) = found = [(r[r <= last], contacts[r <= last]) for r, contacts in every]
    count = min(len(mine), len(other))
    differs = np.append(mine[:count] != other[:count], len(mine) != len(other))
    if not differs.any():
        return None
    k = int(np.argmax(differs))
    there = [(int(r[k]), contacts[k]) for r, contacts in found if k < len(contacts)]
    row, contact = min(there, key=itemgetter(0))
    pair = tuple(first.scenario.body_name(int(contact[side])) for side in "ab")
    return Departure(row, float(first.time[row]), "contact", pair, "is not the same")
