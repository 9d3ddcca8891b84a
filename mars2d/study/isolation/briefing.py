"""What a law's process is told once: its file, its robots, and what of the scenario it may see."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mars2d.addons.communication import Communication
from mars2d.core.plane import Outline
from mars2d.core.streams import stream
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.scenario.serialize import without_code
from mars2d.study.isolation.limits import Limits

__all__ = ["Briefing", "Cast", "brief"]


@dataclass(frozen=True)
class Cast:
    """Of a scenario, what laws see that do not see the whole world.

    robots: their own as they are, but for where they start; of the others the names.
    """

    robots: tuple[Robot, ...]
    sampling_time: float
    props: tuple[Any, ...] = ()


@dataclass(frozen=True)
class Briefing:
    """What a law's process is told once.

    robots: the indices of those that the law is asked for. sees: what each of them may see.
    scenario: without code, or what of it may be seen. obstacles: their outlines, where the whole
    world is seen. streams: the state of each robot's random numbers. sensors: each robot's, by
    name. talks: whether there is something to send messages by. folder: the current one. chance:
    seeds what is drawn elsewhere than from a robot's stream, so that a match can be played again.
    """

    file: Path
    robots: tuple[int, ...]
    sees: tuple[str, ...]
    scenario: Scenario | Cast
    obstacles: tuple[Outline, ...]
    streams: tuple[Mapping[str, Any], ...]
    sensors: tuple[tuple[str, ...], ...]
    talks: bool
    limits: Limits
    folder: str
    chance: int


def brief(
    scenario: Scenario, laws: Mapping[str, tuple[Path, Sequence[int]]], seed: int, limits: Limits
) -> dict[str, Briefing]:
    """Return the briefing of each role: laws holds its file and the indices of its robots.

    What a law's process is told fits what the law may see: the seed is not among it.
    """
    lawless = [robot.replace(controller=None) for robot in scenario.robots]
    bare, _ = without_code(scenario.replace(robots=lawless))
    return {
        role: _briefing(scenario, bare, file, robots, stream(seed, f"law of {role}"), seed, limits)
        for role, (file, robots) in laws.items()
    }


def _briefing(
    scenario: Scenario,
    bare: Scenario,
    file: Path,
    robots: Sequence[int],
    chance: np.random.Generator,
    seed: int,
    limits: Limits,
) -> Briefing:
    mine = [scenario.robots[i] for i in robots]
    whole = any(robot.sees == "full" for robot in mine)
    names = [f"robot {robot.name}" for robot in mine]
    return Briefing(
        file=file,
        robots=tuple(robots),
        sees=tuple(robot.sees for robot in mine),
        scenario=bare if whole else _cast(bare, robots),
        obstacles=tuple(each.outline for each in scenario.surfaces) if whole else (),
        streams=tuple(dict(stream(seed, name).bit_generator.state) for name in names),
        sensors=tuple(tuple(sensor.key for sensor in robot.sensors) for robot in mine),
        talks=any(isinstance(addon, Communication) for addon in scenario.addons),
        limits=limits,
        folder=os.getcwd(),  # noqa: PTH109 - as text
        chance=int(chance.integers(2**32)),
    )


def _cast(bare: Scenario, robots: Sequence[int]) -> Cast:
    somewhere = (0.0, 0.0, 0.0)
    known = [
        robot.replace(pose=somewhere) if i in robots else Robot(name=robot.name)
        for i, robot in enumerate(bare.robots)
    ]
    return Cast(tuple(known), bare.sampling_time)
