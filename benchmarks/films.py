"""How long films take: milliseconds a frame at 1280 x 720, drawing and encoding told apart.

    python benchmarks/films.py [--json OUT.json] [--rounds N] [--frames N] [--scenes "NAME; NAME"]

Each scene is run and filmed at a speed at which each frame is a new control step, except `scans,
real time`: there a reading of 0.1 s is seen for two or three frames. Names of examples are those
examples; in `scans` 20 robots see with 180 beams each, in `trails` 100 robots draw their paths.
`live` is made of the frames of the run, with what add-ons draw; all others of its record.

`draw`: the pictures alone, in the processor's time of the thread that draws. `mp4`, `gif`: the
whole film, by the clock; `(all)`: in the processor's time of all threads, which other programs on
the machine do not lengthen as much. Of each the least of some rounds; the scenes take turns.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pygame
from scenes import Turns, s2

from mars2d import Robot, Scenario
from mars2d.addons import Map
from mars2d.output.films.film import save_film
from mars2d.output.films.footage import Cut, shots
from mars2d.output.films.mp4 import require_av
from mars2d.output.raster.picture import Artist
from mars2d.record.frame import Frame
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.sensors import RangeFinder
from mars2d.world.loop import simulate
from mars2d.world.record import Record

SIZE = (1280, 720)
FPS = 25
FRAMES = 1000
ROUNDS = 3
SEEING = 20
COLUMNS = ("draw_ms", "mp4_ms", "mp4_busy_ms", "mp4_kb", "gif_ms", "gif_busy_ms", "gif_kb")


def example(name: str, frames: int) -> Experiment:
    """Return an example of which each control step is a frame."""
    step = open_experiment(name).scenario.sampling_time
    return open_experiment(name, {"stop_time": step * frames})


def team(frames: int, *, seeing: bool, step: float = 0.05) -> Experiment:
    """Return 20 robots that see, or 100 that do not, wandering among boxes in a walled square."""
    scene = s2()
    sensors = [RangeFinder(beams=180, range=5.0)] if seeing else []
    robot = Robot(diameter=2 * scene.radius, sensors=sensors)
    poses = scene.poses[:SEEING] if seeing else scene.poses
    scenario = Scenario(
        title="Twenty scanners" if seeing else "A hundred paths",
        robots=[robot.at(*pose) for pose in poses.tolist()],
        workspace=scene.walls,
        on_exit="wall",
        sampling_time=step,
        stop_time=step * frames,
        addons=[Map(scene.boxes)],
    )
    law = Turns(len(poses), step)
    return Experiment(scenario, lambda world: law(world.iteration))


@dataclass
class Reel:
    """What is filmed: a record, and how fast."""

    record: Record
    speed: float

    def frames(self) -> Iterator[Frame]:
        """Yield the frames again."""
        cut = Cut.of(float(self.record.time[-1]), self.speed, FPS)
        step = self.record.scenario.sampling_time
        return shots(cut, step, len(self.record) - 1, self.record.frame)


def reel(experiment: Experiment, speed: float | None = None) -> Reel:
    """Run an experiment; by default each control step becomes a frame."""
    scenario = experiment.scenario
    world = simulate(experiment)
    pace = scenario.sampling_time * FPS if speed is None else speed
    return Reel(world.record, pace)


SCENES: Mapping[str, Callable[[int], Reel]] = {
    "random_walk": lambda n: reel(example("random_walk", n)),
    "coverage_square": lambda n: reel(example("coverage_square", n)),
    "cyclic_pursuit": lambda n: reel(example("cyclic_pursuit", n)),
    "push_box": lambda n: reel(example("push_box", n)),
    "crowd": lambda n: reel(example("crowd", n)),
    "trails": lambda n: reel(team(n, seeing=False)),
    "scans": lambda n: reel(team(n, seeing=True)),
    "scans, real time": lambda n: reel(team(n * 2 // 5, seeing=True, step=0.1), 1.0),
}


def drawn(frames: Iterator[Frame]) -> float:
    """Return the milliseconds a frame to draw, in the processor's time."""
    artist, surface = Artist(SIZE, sensors=True, status="1x"), pygame.Surface(SIZE, 0, 32)
    start, count = time.thread_time(), 0
    for frame in frames:
        artist.paint(frame, surface)
        count += 1
    return 1e3 * (time.thread_time() - start) / count


def filmed(frames: Iterator[Frame], target: Path) -> tuple[float, float, float]:
    """Return the milliseconds a frame of a film, by the clock and of all threads; and its bytes."""
    counts: list[int] = []
    start, busy = time.perf_counter(), time.process_time()
    save_film(frames, target, fps=FPS, size=SIZE, status="1x", progress=counts.append)
    wall, busy = time.perf_counter() - start, time.process_time() - busy
    return 1e3 * wall / counts[-1], 1e3 * busy / counts[-1], target.stat().st_size / counts[-1]


def measure(names: list[str], rounds: int, frames: int) -> list[dict[str, Any]]:
    """Return the figures of each scene, the least of the rounds."""
    reels = {name: SCENES[name](frames) for name in names}
    rows: dict[str, dict[str, Any]] = {name: {"scene": name} for name in names}

    def note(name: str, what: str, value: float) -> None:
        rows[name][what] = round(min(value, rows[name].get(what, value)), 3)

    with tempfile.TemporaryDirectory() as folder:
        for _ in range(rounds):
            for name, each in reels.items():
                note(name, "draw_ms", drawn(each.frames()))
                for suffix in ("mp4", "gif"):
                    wall, busy, size = filmed(each.frames(), Path(folder, f"film.{suffix}"))
                    note(name, f"{suffix}_ms", wall)
                    note(name, f"{suffix}_busy_ms", busy)
                    note(name, f"{suffix}_kb", size / 1e3)
    return list(rows.values())


def main() -> None:
    """Run the benchmark, print a table, and write JSON where it is asked for."""
    parser = argparse.ArgumentParser(description="How long films take.")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    parser.add_argument("--rounds", type=int, default=ROUNDS, help="how often all is timed")
    parser.add_argument("--frames", type=int, default=FRAMES, help="how long the films are")
    parser.add_argument("--scenes", default="; ".join(SCENES), help="of these, with ; between")
    arguments = parser.parse_args()
    require_av(Path("film.mp4"))
    names = [name.strip() for name in arguments.scenes.split(";")]
    figures = measure(names, arguments.rounds, arguments.frames)
    heads = ("draw", "mp4", "(all)", "kB", "gif", "(all)", "kB")
    print(f"{'ms a frame':<24}" + "".join(f"{head:>8}" for head in heads))
    for row in figures:
        print(f"{row['scene']:<24}" + "".join(f"{row[name]:8.1f}" for name in COLUMNS))
    if arguments.json is not None:
        arguments.json.write_text(json.dumps({"films": figures}, indent=2) + "\n", "utf-8")


if __name__ == "__main__":
    main()
