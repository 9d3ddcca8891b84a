"""How long a picture takes at 1280 x 720: drawn, shown in a window, and written into a film.

    python benchmarks/drawing.py [--json OUT.json] [--rounds N] [--steps N]

100 robots (scene S2 of the suite) have driven for 500 control steps of 0.05 s, and all their paths
are seen. `paths` is that picture, `scans` the same where 20 of them see with 180 beams of 5 m.

`window`: `Window.draw`, with its bars, as in real time at 60 pictures a second: three for each
control step. `each step`: one picture a control step, so that nothing seen stays. Both on a screen
of SDL's dummy driver and, where Xvfb is installed, on a real window, for which `flip` is how long
it takes to get to the X server. `mp4`, `gif`: `save_film` of all frames at 25 a second, all in:
between the control steps, drawn, converted, encoded and written.

The window of `scans` is also seen with more on it: `overlays` are names, velocities and forces,
`inspector` a selected robot that scans, `all, dark` both in the dark theme. Of these, and of
`scans`, there are two rows: the pictures with a new control step, and those in between.
`following`: the camera follows a robot. `scopes`: three plots of all 100 robots follow the run, of
speed, force and energy. `scrubbing`: 20 robots have gone 10 000 steps; pictures of
rows at random, and of rows that are dragged through backwards; `first` is the picture before any.

The yardstick `bare` is what plain pygame takes for as many robots without paths: fill the picture,
a circle and a line for each. For films it is a film as long of one picture that is the same all the
time. All take turns in one process, so that the ratios hold on a noisy machine.

Drawing is measured in the processor's time, so that it does not count when the system lets others
run; flips and films, in which other threads and processes work, by the clock. `least` takes of each
picture the round in which it was quickest, and the mean of these; `median` is of the rounds.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import statistics
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pygame
from numpy.typing import NDArray
from scenes import s2

from mars2d import Robot, Scenario, World
from mars2d.addons import Map
from mars2d.output.films.film import save_film
from mars2d.output.films.mp4 import require_av
from mars2d.output.layers.table import Layers
from mars2d.output.raster.layout import Layout, fitted
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.stage import Stage
from mars2d.record.frame import Frame, between
from mars2d.record.rows import COLUMNS
from mars2d.sensors import RangeFinder
from mars2d.window.run.window import Window
from mars2d.window.screen.display import Preferences
from mars2d.world.record import Record

SIZE = (1280, 720)
SEEING = 20
FIRST = 500
STEPS = 200
ROUNDS = 5
PICTURES_A_SECOND, FPS = 60, 25
SCOPES = "speed", "force", "kinetic"
"""What the scopes plot, of all robots."""


Scene = tuple[list[Frame], Record]
"""The frames of a run, one a control step, and its record."""


def run(seeing: int, steps: int) -> Scene:
    """Run 500 control steps, and so many more that are seen; the first robots scan."""
    scene = s2()
    blind = Robot(diameter=2 * scene.radius)
    scanning = Robot(diameter=2 * scene.radius, sensors=[RangeFinder(beams=180, range=5.0)])
    scenario = Scenario(
        title=scene.title,
        robots=[
            (scanning if i < seeing else blind).at(*pose)
            for i, pose in enumerate(scene.poses.tolist())
        ],
        workspace=scene.walls,
        on_exit="wall",
        sampling_time=scene.sampling_time,
        stop_time=scene.sampling_time * (FIRST + steps),
        addons=[Map(scene.boxes)],
    )
    law = scene.law()
    world = World(scenario, lambda world: law(world.iteration))
    result = []
    while not world.over:
        if world.iteration >= FIRST:
            world.observe()
            result.append(world.frame)
        world.step()
    return result, world.record


def filmed(listed: list[Frame]) -> list[Frame]:
    """Return the frames of a film in real time."""
    step = listed[0].scenario.sampling_time
    at = [k / FPS / step for k in range(int((len(listed) - 1) * step * FPS))]
    return [between(listed[int(k)], listed[int(k) + 1], listed[0].time + k * step) for k in at]


class Reel:
    """Plays frames that are there already, for a window."""

    def __init__(self, scene: Scene) -> None:
        """Start with the first one."""
        (self._frames, self._record), self.row = scene, 0

    @property
    def scenario(self) -> Scenario:
        """What was simulated."""
        return self.frame.scenario

    @property
    def frame(self) -> Frame:
        """The present one."""
        return self._frames[self.row]

    @property
    def recorded(self) -> Record:
        """The record so far, as of a run that goes on."""
        rows = self.frame.iteration
        columns: dict[str, Any] = {name: getattr(self._record, name)[:rows] for name in COLUMNS}
        sensors = {name: values[:rows] for name, values in self._record.sensors.items()}
        return replace(self._record, **columns, sensors=sensors)

    @property
    def newest(self) -> int:
        """The last row."""
        return len(self._frames) - 1

    @property
    def contacts(self) -> NDArray[np.void]:
        """All contacts."""
        return self._frames[-1].contact_log()

    @property
    def over(self) -> bool:
        """Whether it is the last one."""
        return self.row == self.newest

    def advance(self) -> None:
        """Go on by one."""
        self.row += 1

    def go(self, row: int) -> None:
        """Go to a row."""
        self.row = row

    def restart(self) -> None:
        """Go back to the first one."""
        self.row = 0


class Watched:
    """A window on a screen of pygame's, and how long its pictures take.

    each_step: one picture for each control step, else as in real time. overlays, inspector, dark,
    following, scopes: what is seen of the window's choices.
    """

    def __init__(
        self,
        scene: Scene,
        *,
        each_step: bool = False,
        overlays: bool = False,
        inspector: bool = False,
        dark: bool = False,
        following: bool = False,
        scopes: bool = False,
    ) -> None:
        """Prepare the window."""
        look = Preferences(dark=dark)
        reel: Any = Reel(scene)  # as a record that is played
        window = self._window = Window(reel, 0 if each_step else 1.0, SIZE, look)
        window.layers = window.layers.switched(names=overlays, velocities=overlays, forces=overlays)
        if inspector:
            window.select(3)
        for what in SCOPES if scopes else ():
            window.dock.scopes.switch(what, tuple(range(len(scene[1].scenario.robots))))
        if following:
            window.viewpoint.follow(3)
        self._each_step = each_step

    def watch(self, screen: pygame.Surface) -> tuple[list[float], list[float], list[bool]]:
        """Play all; return the milliseconds to draw each picture, and to get it to the screen.

        And whether it is the first one of a control step. The first picture of all, with all that
        was driven before, is left out.
        """
        player = self._window.player
        player.restart()
        self._window.draw(screen)
        drawing, flipping, fresh = [], [], []
        while not player.over:
            row = player.source.row
            if self._each_step:
                player.step()
            else:
                player.pass_time(1 / PICTURES_A_SECOND)
            fresh.append(player.source.row != row)
            start = time.thread_time()
            self._window.viewpoint.step(player.frame, 1 / PICTURES_A_SECOND)
            self._window.draw(screen)
            drawing.append(1e3 * (time.thread_time() - start))
            start = time.perf_counter()
            pygame.display.flip()
            flipping.append(1e3 * (time.perf_counter() - start))
        return drawing, flipping, fresh


class Scrubbed:
    """A long run of 20 robots, of which one looks at this row and that."""

    def __init__(self, rows: int = 10_000, robots: int = 20) -> None:
        """Let robots wander about, without a simulation."""
        rng = np.random.default_rng(1)
        heading = np.cumsum(rng.normal(0.0, 0.08, (rows, robots)), axis=0)
        heading += rng.uniform(-np.pi, np.pi, robots)
        way = np.cumsum(0.03 * np.stack([np.cos(heading), np.sin(heading)], axis=1), axis=0)
        place = np.abs((way + rng.uniform(0.0, 18.0, (2, robots))) % 18.0 - 9.0) - 4.5  # folded
        self._pose = np.concatenate([place, heading[:, None]], axis=1)
        self._scenario = Scenario(
            robots=[Robot(pose=pose) for pose in self._pose[0].T.tolist()],
            workspace=[(-5, -5), (5, -5), (5, 5), (-5, 5)],
            sampling_time=0.1,
            stop_time=0.1 * rows,
            physics="ideal",
        )
        self._random = rng.integers(1, rows, 100).tolist()

    def scrub(self, screen: pygame.Surface) -> dict[str, list[float]]:
        """Return the milliseconds to draw pictures, of a new stage."""
        painter, layout = Painter(), Layout.of(SIZE, controls=True)
        stage, camera = Stage(painter), fitted(self._scenario.bounds, SIZE, layout)

        def drawn(row: int) -> float:
            frame = Frame(self._scenario, 0.1 * row, row, self._pose[row], self._pose[:row])
            start = time.thread_time()
            stage.draw(screen, frame, camera, Layers(), layout.plot)
            return 1e3 * (time.thread_time() - start)

        last = len(self._pose) - 1
        return {
            "first": [drawn(last)],
            "random": [drawn(row) for row in self._random],
            "backwards": [drawn(row) for row in range(last, 0, -37)],
        }


def bare(screen: pygame.Surface, frame: Frame, pictures: int = 100) -> list[float]:
    """Return the milliseconds of pictures of plain circles and lines, without anything else."""
    centers = [(640 + 45 * x, 360 - 45 * y) for x, y in frame.pose[:2].T.tolist()]
    taken = []
    for _ in range(pictures):
        start = time.thread_time()
        screen.fill("white")
        for x, y in centers:
            pygame.draw.circle(screen, "blue", (x, y), 7)
            pygame.draw.aaline(screen, "white", (x, y), (x + 5, y + 5))
        taken.append(1e3 * (time.thread_time() - start))
    return taken


def film(listed: list[Frame], target: Path) -> list[float]:
    """Return the milliseconds a frame of a film, all in: one number."""
    start = time.perf_counter()
    save_film(listed, target, fps=FPS, size=SIZE)
    return [1e3 * (time.perf_counter() - start) / len(listed)]


@contextmanager
def dummy_screen() -> Iterator[pygame.Surface]:
    """Open a screen that nobody sees."""
    with _screen(SDL_VIDEODRIVER="dummy") as screen:
        yield screen


@contextmanager
def real_screen() -> Iterator[pygame.Surface]:
    """Open a window on an X server of its own."""
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x720x24", "-noreset"]
    with subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL) as server:
        os.close(write)
        try:
            with os.fdopen(read) as pipe:
                display = ":" + pipe.readline().strip()
            with _screen(SDL_VIDEODRIVER="x11", DISPLAY=display) as screen:
                yield screen
        finally:
            server.terminate()


@contextmanager
def _screen(**environment: str) -> Iterator[pygame.Surface]:
    before = os.environ.copy()
    os.environ.update(environment)
    try:
        pygame.display.init()
        os.environ["SDL_FRAMEBUFFER_ACCELERATION"] = "0"
        yield pygame.display.set_mode(SIZE)
    finally:
        pygame.display.quit()
        os.environ.clear()
        os.environ.update(before)


def measure(rounds: int, steps: int) -> dict[str, list[list[float]]]:
    """Return what each took in each round, milliseconds of each picture, in turns."""
    scenes = {"paths": run(0, steps), "scans": run(SEEING, steps)}
    screens = {"dummy": dummy_screen}
    if shutil.which("Xvfb"):
        screens["window"] = real_screen
    watched = {
        (name, pace): Watched(scene, each_step=pace == "each step")
        for name, scene in scenes.items()
        for pace in ("real time", "each step")
    }
    more: dict[str, dict[str, bool]] = {
        "scans": {},
        "overlays": {"overlays": True},
        "inspector": {"inspector": True},
        "all, dark": {"overlays": True, "inspector": True, "dark": True},
        "following": {"following": True},
        "scopes": {"scopes": True},
        "scopes, inspector": {"scopes": True, "inspector": True},
    }
    dressed = {name: Watched(scenes["scans"], **options) for name, options in more.items()}
    scrubbed = Scrubbed()
    films = {name: filmed(listed) for name, (listed, _) in scenes.items()}
    films["still"] = [films["paths"][0]] * len(films["paths"])
    taken: dict[str, list[list[float]]] = {}

    def note(name: str, milliseconds: list[float]) -> None:
        taken.setdefault(name, []).append(milliseconds)

    with tempfile.TemporaryDirectory() as folder:
        for _ in range(rounds):
            for screen_name, opened in screens.items():
                with opened() as screen:
                    note(f"{screen_name}: bare", bare(screen, scenes["paths"][0][0]))
                    for (name, pace), window in watched.items():
                        drawing, flipping, _ = window.watch(screen)
                        note(f"{screen_name}: {name}, {pace}", drawing)
                        if screen_name == "window":
                            note(f"{screen_name}: flip, {name}, {pace}", flipping)
                    for name, window in dressed.items():
                        drawing, _, fresh = window.watch(screen)
                        new = [each for each, is_new in zip(drawing, fresh, strict=True) if is_new]
                        rest = [
                            each for each, is_new in zip(drawing, fresh, strict=True) if not is_new
                        ]
                        note(f"{screen_name}: {name}, new step", new)
                        note(f"{screen_name}: {name}, between", rest)
                    for name, drawing in scrubbed.scrub(screen).items():
                        note(f"{screen_name}: scrubbing, {name}", drawing)
            for suffix in ("mp4", "gif"):
                for name, listed in films.items():
                    note(f"{suffix}: {name}", film(listed, Path(folder, f"film.{suffix}")))
    return taken


def rows(taken: dict[str, list[list[float]]]) -> list[dict[str, Any]]:
    """Return the figures of each: least and median milliseconds, and its median ratio to bare."""
    result = []
    for name, rounds in taken.items():
        where = name.split(":")[0]
        yardstick = taken[f"{where}: still" if where in ("mp4", "gif") else f"{where}: bare"]
        means = [statistics.mean(pictures) for pictures in rounds]
        ratios = [a / statistics.mean(b) for a, b in zip(means, yardstick, strict=True)]
        least = [min(times) for times in zip(*rounds, strict=False)]
        result.append(
            {
                "what": name,
                "least_ms": round(statistics.mean(least), 3),
                "median_ms": round(statistics.median(means), 3),
                "ratio": round(statistics.median(ratios), 2),
            }
        )
    return result


def main() -> None:
    """Run the benchmark, print a table, and write JSON where it is asked for."""
    parser = argparse.ArgumentParser(description="How long pictures and films take.")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    parser.add_argument("--rounds", type=int, default=ROUNDS, help="how often all is timed")
    parser.add_argument("--steps", type=int, default=STEPS, help="how many control steps are shown")
    arguments = parser.parse_args()
    require_av(Path("film.mp4"))
    figures = rows(measure(arguments.rounds, arguments.steps))
    print(f"{'ms a picture':<32}{'least':>8}{'median':>8}{'ratio':>8}")
    for row in figures:
        print(f"{row['what']:<32}{row['least_ms']:8.2f}{row['median_ms']:8.2f}{row['ratio']:8.2f}")
    if arguments.json is not None:
        arguments.json.write_text(json.dumps({"drawing": figures}, indent=2) + "\n", "utf-8")


if __name__ == "__main__":
    main()
