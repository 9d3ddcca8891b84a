"""How quickly a window answers: from a key to its picture, and pictures a second with many robots.

python benchmarks/answering.py [--presses 60] [--seconds 5]     (needs a display, or xvfb-run)

The key → is pressed at random moments, 0.1 to 1.2 s apart, in a paused window of `coverage_square`.
The second window has 1280 x 720 pixels, 100 robots in motion and three scopes of all of them. In
the third one, 98 robots press to the middle, with forces, impulses and velocities; there, what a
picture takes is the processor's time.
"""

from __future__ import annotations

import argparse
import random
import statistics
import threading
import time
from math import inf
from typing import Any

import pygame

from mars2d import Holonomic, Robot, Scenario
from mars2d.scenario.experiment import open_experiment
from mars2d.window.run.window import Window
from mars2d.world.timeline import Timeline


class Timed(Window):
    """A window that notes when a key was pressed and when its picture was on the screen."""

    pressed, row, wanted = inf, 0, 0

    def __init__(self, *arguments: object) -> None:
        super().__init__(*arguments)  # type: ignore[arg-type]
        self.taken: list[float] = []
        self.shown: list[float] = []
        self.costs: list[float] = []

    def press(self) -> None:
        """Press the key again and again, from another thread."""
        time.sleep(2)
        for _ in range(self.wanted):
            time.sleep(random.uniform(0.1, 1.2))
            self.pressed = time.perf_counter()
            key = {"key": pygame.K_RIGHT, "mod": 0, "unicode": "", "scancode": 79}
            pygame.event.post(pygame.Event(pygame.KEYDOWN, key))

    def _show_picture(self, screen: pygame.Surface) -> None:
        before = time.process_time()
        super()._show_picture(screen)
        self.costs.append(time.process_time() - before)
        now, row = time.perf_counter(), self.player.source.row
        self.shown.append(now)
        if row != self.row and self.pressed < now:
            self.taken.append(now - self.pressed)
            self.pressed = inf
        self.row = row
        self._open = self._open and (not self.wanted or len(self.taken) < self.wanted)


def crowd() -> Scenario:
    """Return 100 robots that circle."""

    def circle(_: object) -> tuple[float, float]:
        return 0.5, 0.8

    places = [(x, y) for x in range(-9, 11, 2) for y in range(-9, 11, 2)]
    return Scenario(
        robots=[Robot(controller=circle, pose=(x, y, x * y)) for x, y in places],
        workspace=[(-11, -11), (11, -11), (11, 11), (-11, 11)],
        on_exit="wall",
        sampling_time=0.05,
    )


def throng() -> Scenario:
    """Return 98 robots that press to the middle."""

    def inwards(robot: Any) -> tuple[float, float]:
        x, y, _ = robot.pose
        return -x, -y

    places = [(0.45 * (k % 14 - 6.5), 0.45 * (k // 14 - 3), 0.0) for k in range(98)]
    robot = Robot(drive=Holonomic(max_linear_speed=0.5), controller=inwards, sees="positions")
    return Scenario(
        robots=[robot.replace(pose=pose) for pose in places],
        workspace=[(-4, -3), (4, -3), (4, 3), (-4, 3)],
        sampling_time=0.05,
    )


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description="How quickly a window answers.")
    parser.add_argument("--presses", type=int, default=60)
    parser.add_argument("--seconds", type=float, default=5.0)
    arguments = parser.parse_args()

    window = Timed(Timeline(open_experiment("coverage_square")), 0.0)
    window.wanted = arguments.presses
    threading.Thread(target=window.press, daemon=True).start()
    window.run()
    taken = sorted(1000 * each for each in window.taken)
    ninth = taken[int(0.9 * len(taken))]
    print(f"key to picture: median {statistics.median(taken):.1f} ms, 90 % within {ninth:.1f} ms")

    many = Timed(Timeline(open_experiment(crowd())), 1.0, (1280, 720))
    robots = tuple(range(len(many.player.source.scenario.robots)))
    for what in ("speed", "force", "energy"):
        many.dock.scopes.switch(what, robots)
    threading.Timer(arguments.seconds + 2, lambda: setattr(many, "_open", False)).start()
    many.run()
    late = [each for each in many.shown if each > many.shown[0] + 2]
    rate = (len(late) - 1) / (late[-1] - late[0])
    print(f"{len(robots)} robots, three scopes: {rate:.0f} pictures a second")

    pressing = Timed(Timeline(open_experiment(throng())), 1.0, (1280, 720))
    pressing.layers = pressing.layers.switched(forces=True, impulses=True, velocities=True)
    threading.Timer(arguments.seconds + 4, lambda: setattr(pressing, "_open", False)).start()
    pressing.run()
    late = pressing.costs[len(pressing.costs) // 2 :]
    contacts = len(pressing.player.frame.contacts)
    each = 1000 * statistics.median(late)
    print(f"98 robots with {contacts} contacts and their forces: {each:.1f} ms a picture")


if __name__ == "__main__":
    main()
