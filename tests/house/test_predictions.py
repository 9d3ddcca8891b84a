"""Each prediction of an example can fail: some wrong run makes it say NOT OK."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import mars2d
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment
from mars2d.world.record import Record
from tests.worlds import predicted

pytestmark = [pytest.mark.slow, pytest.mark.nightly]

WORSE = {
    "capture_the_flag": {"guard": "(100, 0)", "attacker": "-robot.position - (4, 0)"},
    "homicidal_chauffeur": {"pedestrian": "(-100 * there) if there @ there < 1 else (0, 0)"},
    "lion_and_man": {"lion": "0, 0"},
    "straight_chase": {"pursuer": "there / 40", "evader": "-100 * there"},
}
"""Theory of these applies only to who moves as it says, so that a wrong way makes it silent; these
laws move so, and play worse. there: the way to the nearest other robot."""


def moved(record: Record, shift: np.ndarray) -> Record:
    """Return a record whose robots and props went another way; shift: (T,)."""
    rng = np.random.default_rng(1)

    def off(pose: np.ndarray) -> np.ndarray:
        return pose + shift[:, None, None] * rng.normal(size=pose.shape[1:])

    return replace(record, pose=off(record.pose), prop_pose=off(record.prop_pose))


def drifted(record: Record) -> Record:
    return moved(record, 0.3 * record.time)


def noisy(record: Record) -> Record:
    return moved(record, 0.3 * np.random.default_rng(2).normal(size=len(record)))


def slower(record: Record) -> Record:
    rows = (0.7 * np.arange(len(record))).astype(int)
    sensors = {name: values[rows] for name, values in record.sensors.items()}
    columns = {name: getattr(record, name)[rows] for name in ("pose", "prop_pose", "command")}
    return replace(record, **columns, sensors=sensors)


def gathered(record: Record) -> Record:
    pose = record.pose.copy()
    middle = pose[:, :2].mean(axis=2, keepdims=True)
    pose[:, :2] = middle + 0.05 * (pose[:, :2] - middle)
    return replace(record, pose=pose)


def exchanged(record: Record) -> Record:
    back = {name: getattr(record, name)[:, :, ::-1] for name in ("pose", "prop_pose", "command")}
    return replace(record, **back)


def commanded(record: Record) -> Record:
    command = record.command * np.array([1.5, 1.0])[:, None]
    sensors = {
        name: values + 1 if values.dtype.kind == "f" else ~values
        for name, values in record.sensors.items()
        if values.dtype.kind in "fb"
    }
    return replace(record, command=command, sensors=dict(record.sensors) | sensors)


def turned(record: Record) -> Record:
    """Poses turn and commands turn more, and each robot's commands are those of another time."""
    pose, command = record.pose * np.array([0.9, 0.9, 1.3])[:, None], record.command.copy()
    for robot in range(command.shape[2]):
        command[:, :, robot] = np.roll(command[:, :, robot], 7 * robot, axis=0)
    return replace(record, pose=pose, command=command * np.array([1.0, 0.7])[:, None])


def nearer(record: Record) -> Record:
    """All come to the last robot, in the course of time."""
    pose, share = record.pose.copy(), (record.time / record.time[-1])[:, None, None]
    pose[:, :2] += share * (pose[:, :2, -1:] - pose[:, :2])
    return replace(record, pose=pose)


def harder(record: Record) -> Record:
    contacts = record.contacts.copy()
    contacts["tangential_impulse"] += contacts["normal_impulse"]
    contacts["normal_impulse"] *= 1.5
    return replace(record, contacts=contacts)


def touched(record: Record) -> Record:
    contact = np.zeros(1, dtype=record.contacts.dtype)
    contact["time"], contact["b"], contact["began"] = record.time[-1], 1, True
    return replace(record, contacts=np.concatenate([record.contacts, contact]))


def heard(record: Record) -> Record:
    messages = record.messages.copy()
    messages["arrival"] = messages["time"]
    return replace(record, messages=messages)


def shorter(record: Record) -> Record:
    half = len(record) // 2
    columns = {
        name: getattr(record, name)[:half]
        for name in ("time", "pose", "command", "command_time", "prop_pose", "effort", "velocity",
                     "prop_velocity", "work")
    }  # fmt: skip
    sensors = {name: values[:half] for name, values in record.sensors.items()}
    end = columns["time"][-1]
    contacts = record.contacts[record.contacts["time"] < end]
    messages = record.messages[record.messages["time"] < end]
    return replace(record, **columns, sensors=sensors, contacts=contacts, messages=messages)


WRONG = (
    drifted,
    noisy,
    slower,
    gathered,
    exchanged,
    commanded,
    turned,
    nearer,
    harder,
    touched,
    heard,
    shorter,
)


@pytest.mark.parametrize("name", sorted(set(examples()) - WORSE.keys()))
def test_a_prediction_can_fail(name):
    experiment = open_experiment(name)
    if experiment.source.checks is None:
        pytest.skip("it predicts nothing")
    record = mars2d.run(name)
    right = {p.name for p in experiment.predictions(record)}
    wrong = set()
    for change in WRONG:
        found, _ = experiment.predictions_so_far(change(record))
        wrong |= {p.name for p in found if p.ok is False}
    assert right <= wrong


@pytest.mark.parametrize("name", WORSE)
def test_a_prediction_fails_for_who_plays_worse_than_theory_says(name, tmp_path):
    laws = {role: tmp_path / f"{role}.py" for role in WORSE[name]}
    for role, law in laws.items():
        way = "there = robot.neighbours[0].position - robot.position"
        law.write_text(f"def control(robot):\n    {way}\n    return {WORSE[name][role]}\n")
    _, found = predicted(name, **{role: str(law) for role, law in laws.items()})
    assert False in [prediction.ok for prediction in found.values()]
