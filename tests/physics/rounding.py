"""Runs under constant commands, whose digests `test_other_processors.py` compares.

Commands are drawn by numpy, not worked out by laws: these would use the sines of a C library.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator

import numpy as np

from mars2d import Scenario, World
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment
from tests.physics import test_crowd_fuzz as fuzz
from tests.physics.bustle.bustle import scenario as bustle
from tests.physics.test_same_bits import crowd, dampers

STEPS = int(sys.argv[1]) if sys.argv[1:] else 60

SENSITIVE, DAMPED = (10, 13), 400
"""Seeds of `dampers`, and steps, in which the exponential of the C library would be noticed."""


def scenarios() -> Iterator[tuple[str, Scenario]]:
    """Yield all examples, crowds of many shapes, and the bustle: all sensors, noise."""
    for name in examples():
        yield name, open_experiment(name).scenario
    for seed in range(6):
        yield f"crowd {seed}", _rounded(crowd(seed, 24, gap=0.0, things=True, faults=True))
        yield f"mixed {seed}", fuzz.crowd(seed, "everything", 10.0, 0.05, ties=True)
        yield f"bustle {seed}", bustle(seed=seed)


def _rounded(scenario: Scenario) -> Scenario:
    """Return a scenario whose round obstacle was not drawn by the C library's sines."""
    (chart,) = scenario.addons
    outlines = [np.round(outline, 9).tolist() for outline in chart.outlines]
    return scenario.replace(addons=[chart.replace(outlines=outlines)])


def digest(scenario: Scenario, steps: int = STEPS) -> str:
    """Return the digest of a run under commands that change now and then."""
    world, rng = World(scenario, seed=1), np.random.default_rng(1)
    while not world.over and world.iteration < steps:
        if world.iteration % 10 == 0:
            command = rng.uniform(-0.5, 0.5, world.command.shape)
        world.step(command)
    return world.record.digest


if __name__ == "__main__":
    digests = {name: digest(each) for name, each in scenarios()}
    digests |= {f"dampers {seed}": digest(dampers(seed), DAMPED) for seed in SENSITIVE}
    print(json.dumps(digests))
