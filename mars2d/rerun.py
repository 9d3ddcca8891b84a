"""Run a record again, and see whether the numbers are the same."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mars2d.addons.map import Map
from mars2d.contact import CONTACT
from mars2d.errors import InputError
from mars2d.interventions import Change, Intervention
from mars2d.plain import MOVING
from mars2d.record import Record
from mars2d.scenario import Scenario
from mars2d.world import World

__all__ = ["Departure", "rerun"]


@dataclass(frozen=True)
class Departure:
    """Where a record and itself run again part: the row, and by how much (metres or radians)."""

    row: int
    distance: float


def rerun(record: Record) -> Departure | None:
    """Run the record's scenario again under its commands; None when all is the same to the bit.

    Poses, efforts and contacts are compared. Raises InputError for a record with a drive, joint or
    shape of the user's own, which a file does not hold.
    """
    needed = [part for part in record.missing if part.startswith(MOVING)]
    if needed:
        raise InputError(f"can't be run again: the file does not hold the {', '.join(needed)}")
    # The workspace and the stop time have ended the run, or not: the record says how long it was.
    longer = (len(record) + 1) * record.scenario.sampling_time
    scenario = _in_motion(record.scenario).replace(stop_time=longer)
    if scenario.on_exit == "stop":
        scenario = scenario.replace(on_exit="ignore")
    world = World(scenario, seed=record.seed)
    for row, command in enumerate(record.command):
        for intervention in record.interventions:
            if intervention.row == row:
                world.hands.redo(_in_motion_of(intervention))
        departure = _departs(row, world, record)
        if departure is not None:
            return departure
        if row < len(record) - 1:
            world.step(command)
    return _contacts_depart(record, world.record)


def _in_motion(scenario: Scenario) -> Scenario:
    """Return a scenario with all that matters to motion: of add-ons that is their obstacles.

    What add-ons do else may need laws, which are not there, and end the experiment.
    """
    addons = [
        Map(
            addon.obstacles(),
            name=addon.key,
            friction=addon.friction,
            restitution=addon.restitution,
        )
        for addon in scenario.addons
        if addon.obstacles()
    ]
    return scenario.replace(addons=addons, robots=[r.replace(sensors=()) for r in scenario.robots])


def _in_motion_of(intervention: Intervention) -> Intervention:
    """Return an intervention with all that matters to motion."""
    if isinstance(intervention, Change):
        return replace(intervention, scenario=_in_motion(intervention.scenario), control=None)
    return intervention


def _departs(row: int, world: World, record: Record) -> Departure | None:
    """Return where a world and a row of a record part, if they do."""
    for mine, other in ((record.pose, world.pose), (record.prop_pose, world.prop_pose)):
        if not np.array_equal(mine[row], other):
            return Departure(row, float(np.abs(mine[row] - other).max()))
    return None if np.array_equal(record.effort[row], world.effort) else Departure(row, 0.0)


def _contacts_depart(first: Record, second: Record) -> Departure | None:
    """Return where the contacts of two records with the same poses part.

    A run that was broken off may have contacts of a control step that its rows do not tell of: what
    went on touching has its start as their time, the end of the rows.
    """
    end = first.time[-1] if len(first) else 0.0
    mine, other = (
        r.contacts[(r.contacts["time"] < end) | ((r.contacts["time"] == end) & r.contacts["began"])]
        for r in (first, second)
    )
    same = len(mine) == len(other) and all(
        np.array_equal(mine[name], other[name]) for name in CONTACT.names or ()
    )
    return None if same else Departure(len(first) - 1, 0.0)
