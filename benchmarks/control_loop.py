"""How much the whole control step costs, against a bare pymunk loop that does the same physics.

    python benchmarks/control_loop.py [--json OUT.json] [--sizes N ...] [--rounds N]

Teams of unicycles (radius 0.15 m, 5 % of the area covered, 0.3 m/s, a new random omega each second,
sampling time 0.05 s) in a walled square. `mars2d`: `World.step` with a law and recording, at the
default accuracy. `bare`: a loop over pymunk alone that drives the same robots by primed joints,
with batch access and as many substeps as keep overlaps within the same millimetre (15), without
laws, checks or recording. Both run in turns in one process, so that the ratio holds on a noisy
machine.
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pymunk
from numpy.typing import NDArray
from pymunk import batch

import mars2d
from mars2d import Robot, Scenario, World

Float = NDArray[np.float64]

SPEED, DT, RADIUS, COVER = 0.3, 0.05, 0.15, 0.05
MAX_OVERLAP = 1e-3
SUBSTEPS = round(SPEED * DT / MAX_OVERLAP)
SIZES = (2, 20, 100, 1000)
ROUNDS = 7


def starts(n: int) -> tuple[Float, float]:
    """Return poses (n, 3) on a square grid, and half the side of the square."""
    side = float(np.sqrt(n * np.pi * RADIUS**2 / COVER))
    per_row = int(np.ceil(np.sqrt(n)))
    k = np.arange(n)
    cell = side / per_row
    x, y = (k % per_row + 0.5) * cell - side / 2, (k // per_row + 0.5) * cell - side / 2
    return np.column_stack([x, y, np.random.default_rng(0).uniform(-np.pi, np.pi, n)]), side / 2


class Commands:
    """The law of both loops: full speed ahead, a new random omega each second."""

    def __init__(self, n: int) -> None:
        self._rng = np.random.default_rng(1)
        self._command = np.full((2, n), SPEED)

    def __call__(self, iteration: int) -> Float:
        if iteration % round(1 / DT) == 0:
            self._command[1] = self._rng.uniform(-1, 1, self._command.shape[1])
        return self._command


def mars2d_step(n: int) -> Callable[[], None]:
    """Return a function that does one control step of a World with n robots."""
    poses, half = starts(n)
    law = Commands(n)
    scenario = Scenario(
        robots=[Robot(pose=pose, diameter=2 * RADIUS) for pose in poses.tolist()],
        workspace=[(-half, -half), (-half, half), (half, half), (half, -half)],
        on_exit="wall",
        sampling_time=DT,
        stop_time=1e6,
        max_overlap=MAX_OVERLAP,
    )
    return World(scenario, lambda world: law(world.iteration)).step


class Bare:
    """Robots on pymunk alone: primed joints, batch access, a fixed number of substeps."""

    def __init__(self, n: int) -> None:
        poses, half = starts(n)
        self._law, self._n, self._iteration = Commands(n), n, 0
        self._space = space = pymunk.Space()
        space.collision_slop, space.iterations = 1e-4, 15
        bodies = [self._robot(pose) for pose in poses.tolist()]
        for body in bodies:
            control = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
            pivot = pymunk.PivotJoint(control, body, (0, 0), (0, 0))
            gear = pymunk.GearJoint(control, body, 0, 1)
            pivot.max_bias = gear.max_bias = 0
            pivot.max_force, gear.max_force = 5.0, 0.5
            space.add(control, pivot, gear)
        corners = [(-half, -half), (-half, half), (half, half), (half, -half)]
        walls = pymunk.Body(body_type=pymunk.Body.STATIC)
        space.add(walls)
        for k, corner in enumerate(corners):
            wall = pymunk.Segment(walls, corner, corners[k - 1], 0)
            wall.friction = wall.elasticity = 1.0
            space.add(wall)
        self._index = {body.id: i for i, body in enumerate(bodies)}
        self._state, self._arbiters, self._out = batch.Buffer(), batch.Buffer(), batch.Buffer()
        self._velocity = np.zeros((2 * n + 1, 3))
        self._out.set_float_buf(self._velocity)

    def _robot(self, pose: list[float]) -> pymunk.Body:
        body = pymunk.Body(1.0, RADIUS**2 / 2)
        body.position, body.angle = (pose[0], pose[1]), pose[2]
        disc = pymunk.Circle(body, RADIUS)
        disc.friction = 0.5
        self._space.add(body, disc)
        return body

    def __call__(self) -> None:
        v, omega = self._law(self._iteration)
        self._iteration += 1
        h = DT / SUBSTEPS
        length = v * np.sinc(omega * h / 2 / np.pi)
        for _ in range(SUBSTEPS):
            self._substep(length, omega, h)

    def _substep(self, length: Float, omega: Float, h: float) -> None:
        n = self._n
        fields = batch.BodyFields
        self._state.clear()
        everything = fields.POSITION | fields.ANGLE | fields.VELOCITY | fields.ANGULAR_VELOCITY
        batch.get_space_bodies(self._space, everything, self._state)
        state = np.frombuffer(self._state.float_buf())[: 6 * n].reshape(n, 6)
        theta, spin = state[:, 2], omega.copy()
        now = theta + omega * (h / 2)
        velocity = self._velocity
        velocity[:n, 0], velocity[:n, 1] = length * np.cos(now), length * np.sin(now)
        velocity[:n, 2] = omega
        self._arbiters.clear()
        ids = batch.ArbiterFields.BODY_A_ID | batch.ArbiterFields.BODY_B_ID
        batch.get_space_arbiters(self._space, ids, self._arbiters)
        for address in np.frombuffer(self._arbiters.int_buf(), dtype=np.int64).tolist():
            i = self._index.get(address)
            if i is not None:  # what touches keeps the velocity that the solver found
                velocity[i] = state[i, 3:]
                spin[i] = state[i, 5]
        then = theta + spin * h + omega * (h / 2)
        velocity[n : 2 * n, 0], velocity[n : 2 * n, 1] = (
            length * np.cos(then),
            length * np.sin(then),
        )
        velocity[n : 2 * n, 2] = omega
        batch.set_space_bodies(self._space, fields.VELOCITY | fields.ANGULAR_VELOCITY, self._out)
        self._space.step(h)


def seconds(step: Callable[[], None], steps: int) -> float:
    """Return how long `steps` calls take."""
    start = time.perf_counter()
    for _ in range(steps):
        step()
    return time.perf_counter() - start


def compare(n: int, rounds: int) -> dict[str, Any]:
    """Run both loops in turns and return steps per second and the ratio of their times."""
    ours, bare = mars2d_step(n), Bare(n)
    steps = max(20, min(2000, 40_000 // n))
    seconds(ours, steps), seconds(bare, steps)  # robots leave their grid, caches fill
    pairs = [(seconds(ours, steps), seconds(bare, steps)) for _ in range(rounds)]
    return {
        "n": n,
        "mars2d_steps_per_s": round(steps / statistics.median(a for a, _ in pairs)),
        "bare_steps_per_s": round(steps / statistics.median(b for _, b in pairs)),
        "time_ratio": round(statistics.median(a / b for a, b in pairs), 3),
        "time_ratio_range": [round(f(a / b for a, b in pairs), 3) for f in (min, max)],
    }


def random_walk(rounds: int) -> dict[str, Any]:
    """Return how long the paper's Algorithm 2 takes, 1000 control steps."""
    mars2d.run("random_walk", stop_time=10)
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        mars2d.run("random_walk")
        times.append(time.perf_counter() - start)
    return {"ticks": 1000, "seconds": round(statistics.median(times), 4)}


def main() -> None:
    """Run the benchmark, print a table, and write JSON where it is asked for."""
    parser = argparse.ArgumentParser(description="The control step against bare pymunk.")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    parser.add_argument("--sizes", type=int, nargs="*", default=SIZES, help="numbers of robots")
    parser.add_argument("--rounds", type=int, default=ROUNDS, help="how often both are timed")
    arguments = parser.parse_args()
    print(f"{'n':>5} {'mars2d':>10} {'bare':>10}  steps/s;  time ratio mars2d / bare")
    rows = []
    for n in arguments.sizes:
        row = compare(n, arguments.rounds)
        low, high = row["time_ratio_range"]
        print(
            f"{n:>5} {row['mars2d_steps_per_s']:>10,} {row['bare_steps_per_s']:>10,}"
            f"  {row['time_ratio']:.2f} ({low:.2f} to {high:.2f})"
        )
        rows.append(row)
    walk = random_walk(arguments.rounds)
    print(f"random_walk: {walk['ticks']} ticks in {walk['seconds']:.3f} s")
    result = {"substeps_of_bare": SUBSTEPS, "teams": rows, "random_walk": walk}
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")
    else:
        json.dump(result, sys.stdout)
        print()


if __name__ == "__main__":
    main()
