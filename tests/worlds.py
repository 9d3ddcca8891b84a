"""Worlds, runs and laws that many tests share."""

from __future__ import annotations

import re
from collections.abc import Sequence
from math import cos, sin, sqrt
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mars2d
from mars2d import Record, Robot, Scenario, World
from mars2d.addons import Map
from mars2d.geometry.shapes import Polygon
from mars2d.scenario.examples import GAME, examples
from mars2d.scenario.experiment import open_experiment

ELL = Polygon([(0, 0), (0.6, 0), (0.6, 0.2), (0.2, 0.2), (0.2, 0.6), (0, 0.6)])
"""A shape that is not convex, metres."""


def solution(name: str) -> Path:
    """Return the file of the model answer to an example's exercises."""
    file = examples()[name]
    if file.name == GAME:
        return file.with_name("solution.py")
    return file.parent / "solutions" / file.name


def ahead(robot: Any) -> tuple[float, float]:
    """Drive straight on at 0.2 m/s."""
    return 0.2, 0.0


def without_laws(scenario: Scenario) -> Scenario:
    """Return a scenario whose robots have no controllers."""
    return scenario.replace(robots=[robot.replace(controller=None) for robot in scenario.robots])


def endless(
    robots: Sequence[Any], props: Sequence[Any] = (), joints: Sequence[Any] = (), **fields: Any
) -> World:
    """Return a world without a workspace that lasts for long."""
    fields = {"workspace": None, "stop_time": 1e5} | fields
    return World(Scenario(robots=robots, props=props, joints=joints, **fields))


def observed(
    sensor: Any, robots: Sequence[Any] = (), outlines: Sequence[Any] = (), **fields: Any
) -> World:
    """Return a world in which a tiny robot has measured, among others and obstacles.

    fields: of the scenario, with `pose` that of the robot and `extra` more add-ons.
    """
    pose, addons = fields.pop("pose", (0, 0, 0)), [Map(list(outlines)), *fields.pop("extra", ())]
    carrier = Robot(pose=pose, diameter=0.01, sensors=[sensor], name="carrier")
    world = World(Scenario(robots=[carrier, *robots], addons=addons, workspace=None, **fields))
    world.observe()
    return world


def reading(sensor: Any, *arguments: Any, **fields: Any) -> Any:
    """Return what it has measured."""
    return getattr(observed(sensor, *arguments, **fields).robots[0].sense, sensor.key)


def crowd(
    count: int, command: Sequence[float], sampling_time: float, seed: int, **robot: Any
) -> World:
    """Return a world after 10 s in which robots far from each other have all done the same."""
    robots = [Robot(pose=(20.0 * (i % 50), 20.0 * (i // 50), 0), **robot) for i in range(count)]
    fields = {"sampling_time": sampling_time, "stop_time": 10.0, "physics": "ideal"}
    world = World(Scenario(robots=robots, workspace=None, **fields), seed=seed)
    while not world.over:
        world.step(np.tile(np.reshape(command, (-1, 1)), count))
    return world


def like(values: np.ndarray, mean: float, deviation: float) -> None:
    """Assert that values have this mean and standard deviation, to four of their own."""
    assert values.mean() == pytest.approx(mean, abs=4 * deviation / sqrt(values.size))
    assert values.std() == pytest.approx(deviation, rel=4 / sqrt(2 * values.size))


def drive(world: World, command: Any, seconds: float) -> np.ndarray:
    """Give the same command for some seconds; return poses of robots and props (T, 3, n + p)."""
    poses = []
    for _ in range(round(seconds / world.scenario.sampling_time)):
        world.step(command)
        poses.append(np.hstack([world.pose, world.prop_pose]))
    return np.array(poses)


def arc(pose: Sequence[float], v: float, omega: float, t: float) -> tuple[float, float, float]:
    """Where a unicycle gets from a pose: the integral of v (cos, sin)(theta + omega t)."""
    x, y, theta = pose
    if omega == 0:
        return x + v * t * cos(theta), y + v * t * sin(theta), theta
    end, radius = theta + omega * t, v / omega
    return x + radius * (sin(end) - sin(theta)), y - radius * (cos(end) - cos(theta)), end


def finished(scenario: Scenario, seed: int = 0) -> World:
    """Return the world of a scenario at the end of its run."""
    world = World(scenario, seed=seed)
    while not world.over:
        world.step()
    return world


def predicted(name: str | Path, seed: int = 0, **options: Any) -> tuple[Record, dict[str, Any]]:
    """Run an example or a file; return its record, and its predictions by their names."""
    experiment = open_experiment(name, options)
    record = mars2d.run(experiment.scenario, control=experiment.control, seed=seed)
    return record, {each.name: each for each in experiment.predictions(record)}


def played(name: str | Path, seed: int = 0, **options: Any) -> tuple[Record, Any, Sequence[Any]]:
    """Run a game; return its record, its outcome or None, and its predictions."""
    experiment = open_experiment(name, options, seed=seed)
    record = mars2d.run(experiment.scenario, control=experiment.control, seed=seed)
    game = next((addon for addon in record.scenario.addons if addon.key == "game"), None)
    return record, game and game.outcome(record), experiment.predictions(record)


def untimed(error: BaseException) -> str:
    """Return the message of an error without the robot and the time at its end."""
    return re.sub(r" \(([^()]*, )?at [-+.e\d]+ s\)$", "", str(error))
