"""What an environment costs a learner: its step against `World.step`, and beside other libraries.

    python benchmarks/learning.py [--json OUT.json] [--rounds N]

All are timed in turns, a hundred steps each, so that what other programs do befalls all; only the
processor's time counts. The game is one pursuer and one evader; both are commanded, and in
`Environment` the evader has a law. `World.step` keeps no record, as in an environment, and calls
`observe` after each step, as whoever wants to know of a capture has to. mpe2 and VMAS, with one
environment, are timed where they are installed: pip install mpe2 vmas. A step of a vector is one of
each of its worlds, by `VectorEnvironment` and by gymnasium's loop over environments. Resets of the
three tasks are timed, too.
"""

from __future__ import annotations

import argparse
import contextlib
import statistics
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import outcome

from mars2d import Holonomic, Robot, Scenario, World
from mars2d.addons import Game
from mars2d.rl import Environment, ParallelEnvironment, tasks

TURN = 100
"""Steps in a row."""

WORLDS = 64
"""The worlds of a vector."""

Step = Callable[[], object]


def chase() -> Scenario:
    """Return a game of two, far from each other, without an end."""
    robot = Robot(drive=Holonomic(), sees="positions")
    return Scenario(
        robots=[robot.at(-4, 0).replace(name="red"), robot.at(4, 0).replace(name="blue")],
        on_exit="ignore",
        stop_time=1e6,
        addons=[Game((("pursuer", ("red",)), ("evader", ("blue",))))],
    )


def flee(robot: Any) -> tuple[float, float]:  # noqa: ARG001
    """Go slowly to the right."""
    return 0.01, 0.0


def own() -> dict[str, Step]:
    """Return the steps of MARS2D: of a world, and of both environments."""
    world = World(chase(), record=False)
    red, blue = chase().robots
    hunted = chase().replace(robots=[red, blue.replace(controller=flee)])
    half = World(hunted, record=False)
    one = Environment(hunted, "pursuer")
    one.reset(seed=0)
    two = ParallelEnvironment(chase())
    two.reset(seed=0)
    action, actions = np.array([0.02, 0.01]), {name: np.array([0.02, 0.01]) for name in two.agents}

    def bare() -> None:
        world.step([[0.01, 0.01], [0.005, 0.005]])
        world.observe()

    def bare_one() -> None:
        half.step({0: (0.01, 0.005)})
        half.observe()

    return {
        "World.step": bare,
        "World.step, a law": bare_one,
        "Environment": lambda: one.step(action),
        "ParallelEnvironment": lambda: two.step(actions),
    }


def others() -> dict[str, Step]:
    """Return the steps of those other libraries that are installed."""
    found: dict[str, Step] = {}
    with contextlib.suppress(ImportError):
        from mpe2 import simple_tag_v3

        tag = simple_tag_v3.parallel_env(
            num_good=1, num_adversaries=1, num_obstacles=0, max_cycles=10**9,
            continuous_actions=True,
        )  # fmt: skip
        tag.reset(seed=0)
        moves = {name: np.full(5, 0.1, np.float32) for name in tag.agents}
        found["mpe2, simple_tag"] = lambda: tag.step(moves)
    with contextlib.suppress(ImportError):
        import torch
        import vmas

        torch.set_num_threads(1)
        many = vmas.make_env(
            "simple_tag", num_envs=1, num_good_agents=1, num_adversaries=1, num_landmarks=0
        )
        many.reset()
        acts = [torch.full((1, 2), 0.01) for _ in many.agents]
        found["VMAS, simple_tag"] = lambda: many.step(acts)
    return found


def vectors(rounds: int) -> dict[str, float]:
    """Return how many steps a second the worlds of vectors of the task pursuit make together."""
    task = "mars2d.rl:mars2d/Pursuit-v0"
    made = {
        mode: gymnasium.make_vec(task, num_envs=WORLDS, vectorization_mode=mode)
        for mode in ("vector_entry_point", "sync")
    }
    actions = np.random.default_rng(0).uniform(-1, 1, (rounds, WORLDS, 2)).astype(np.float32)
    times: dict[str, list[float]] = {mode: [] for mode in made}
    for many in made.values():
        many.reset(seed=0)
    for action in actions:
        for mode, many in made.items():
            began = time.process_time()
            many.step(action)
            times[mode].append((time.process_time() - began) / WORLDS)
    return {mode: 1 / statistics.median(each) for mode, each in times.items()}


def resets(rounds: int) -> dict[str, float]:
    """Return the median time of a reset of each task, ms."""
    found = {}
    for make in (tasks.pursuit, tasks.push, tasks.sumo):
        environment = make()
        times = []
        for seed in range(rounds):
            began = time.process_time()
            environment.reset(seed=seed)
            times.append(time.process_time() - began)
        found[make.__name__] = 1e3 * statistics.median(times)
    return found


def measure(rounds: int) -> dict[str, Any]:
    """Return steps a second of each, and the times of ours over `World.step`."""
    steps = own() | others()
    times: dict[str, list[float]] = {name: [] for name in steps}
    for _ in range(rounds):
        for name, step in steps.items():
            began = time.process_time()
            for _ in range(TURN):
                step()
            times[name].append((time.process_time() - began) / TURN)
    measured = {}
    for name, each in times.items():
        bare = times["World.step, a law" if name == "Environment" else "World.step"]
        ratio = statistics.median(a / b for a, b in zip(each, bare, strict=True))
        measured[name] = {
            "steps_per_second": 1 / statistics.median(each), "time_over_world_step": ratio,
        }  # fmt: skip
    return measured


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="what an environment costs a learner")
    parser.add_argument("--rounds", type=int, default=40)
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    arguments = parser.parse_args()
    measured = measure(arguments.rounds)
    for name, each in measured.items():
        print(
            f"{name:<20} {each['steps_per_second']:8.0f} steps/s, "
            f"{each['time_over_world_step']:5.2f} times World.step"
        )
    many = vectors(arguments.rounds)
    told = ", ".join(f"{each:.0f} steps/s by {mode}" for mode, each in many.items())
    print(f"{WORLDS} worlds of pursuit: {told}")
    took = resets(arguments.rounds)
    print("reset: " + ", ".join(f"{name} {each:.2f} ms" for name, each in took.items()))
    outcome.write(measured | {"vectors": many, "reset_ms": took}, arguments.json)


if __name__ == "__main__":
    main()
