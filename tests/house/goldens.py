"""The golden paths of the examples: poses that a run comes near to on any platform.

`python docs/make/example.py NAME` makes one.

Another platform rounds the last digits of sines and sums differently, and what is chaotic makes
much of it. So each example is also run from starts that are `NUDGE` beside its own, several orders
more than what rounding does: `MARGIN` times what this changes is the tolerance, up to where it
would be more than `LARGEST`, from where on a path says nothing.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d import Record
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.world.loop import simulate

FOLDER = Path(__file__).parent / "golden"
NUDGE, NUDGES = 1e-12, 4  # m and rad; how many nudged runs
MARGIN, SMALLEST, LARGEST = 100.0, 1e-8, 1e-2  # of tolerances, m and rad
ROWS = 20
DIGITS = 9

SETTINGS = {"flocking": {"noise": 0.0}}
"""How an example is run that rounding alone decides about.

A flock starts on a lattice: which of two robots that are equally far away is the nearer one, and
with it whose noise is whose, is in the last digit.
"""

Float = NDArray[np.float64]


class Golden(NamedTuple):
    """A path: at some rows the poses of robots and props, and how near to them a run has to be.

    digest: of a run on the platform where digests are pinned. rows: (r,). tolerances: (r,) metres
    and radians. poses: (r, 3, n + p).
    """

    digest: str
    rows: NDArray[np.int64]
    tolerances: Float
    poses: Float

    @classmethod
    def read(cls, name: str) -> Golden:
        """Return the path of an example."""
        told = json.loads((FOLDER / f"{name}.json").read_text())
        rows = told["rows"]
        poses = np.array([row["poses"] for row in rows])
        return cls(
            told["digest"],
            np.array([row["row"] for row in rows]),
            np.array([row["tolerance"] for row in rows]),
            poses.transpose(0, 2, 1),
        )

    def write(self, name: str) -> None:
        """Keep it as the path of an example, a line a row."""
        lines = [
            json.dumps({"row": int(row), "tolerance": float(f"{tolerance:.1e}"), "poses": poses})
            for row, tolerance, poses in zip(
                self.rows, self.tolerances, (self.poses.transpose(0, 2, 1)).round(DIGITS).tolist(),
                strict=True,
            )
        ]  # fmt: skip
        FOLDER.mkdir(exist_ok=True)
        (FOLDER / f"{name}.json").write_text(
            f'{{"digest": "{self.digest}", "rows": [\n' + ",\n".join(lines) + "]}\n"
        )

    def excess(self, record: Record) -> float:
        """Return how far a run is off, in shares of the tolerance, at the worst row; inf: ended."""
        if len(record) <= self.rows[-1]:
            return float("inf")
        off = np.abs(poses_of(record)[self.rows] - self.poses).max(axis=(1, 2))
        return float((off / self.tolerances).max())


def poses_of(record: Record) -> Float:
    """Return the poses of robots and props, (T, 3, n + p)."""
    return np.concatenate([record.pose, record.prop_pose], axis=2)


def nudged(experiment: Experiment, seed: int) -> Experiment:
    """Return an experiment whose robots start a little beside where they did."""
    rng = np.random.default_rng(seed)
    return experiment.redrawn(
        experiment.scenario.replace(
            robots=[
                robot.replace(pose=robot.pose + NUDGE * rng.uniform(-1, 1, 3))
                for robot in experiment.scenario.robots
            ]
        )
    )


def golden(name: str) -> Golden:
    """Run an example, and some more times from starts that are a little beside its own."""
    settings = SETTINGS.get(name)
    digest = simulate(open_experiment(name)).record.digest
    path = poses_of(simulate(open_experiment(name, settings)).record)
    apart = np.zeros(len(path))
    for seed in range(NUDGES):
        other = poses_of(simulate(nudged(open_experiment(name, settings), seed)).record)
        both = min(len(path), len(other))
        departure = np.abs(other[:both] - path[:both]).max(axis=(1, 2))
        apart[:both] = np.maximum(apart[:both], departure)
        apart[both:] = np.inf
    apart = np.maximum.accumulate(apart)
    tolerances = np.maximum(SMALLEST, MARGIN * apart)
    last = int(np.searchsorted(tolerances, LARGEST, side="right")) - 1
    rows = np.unique(np.linspace(0, last, ROWS + 1).round().astype(int))
    return Golden(digest, rows, tolerances[rows], path[rows])
