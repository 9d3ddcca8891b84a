"""What the scripts of all peers share: the law, the clock, and the checks that a run is a real one.

A script derives its class from `Peer` and ends with `main(TheClass)`. It then runs a scene by
itself, or, with ``--serve``, is told by ``run.py`` what to do, a line of JSON at a time. It runs
where MARS2D is not installed: this file needs numpy alone, and takes the scenes, and what measures
gaps, from the folder above.
"""

from __future__ import annotations

import argparse
import dataclasses
import hashlib
import json
import sys
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

sys.path.append(str(Path(__file__).parents[1]))
import gaps
import scenes

__all__ = ["SCENES", "Engine", "Geometry", "Peer", "Simulator", "gaps", "main", "scenes"]

Float = NDArray[np.float64]

TOLERANCE = 2e-3
"""How far a peer's readings may be from geometry, metres: peers count in 32 bits, or draw a circle
as a polygon."""

SLACK = 0.02
"""By what part of it a free robot may miss the way that it is told to go."""

LOST = 0.2
"""What part of the bodies may end outside the walls or deep in boxes."""

SETTLED = 3
"""So many steps a peer may take to reach the speed that it is told."""


SCENES: dict[str, Callable[[], Any]] = scenes.SCENES


class Simulator(ABC):
    """A simulator with a scene in it, that is stepped.

    scene: a Scene of `scenes`. setting: one of the class's `SETTINGS`.
    command: the last command of its robots (2, n), v [m/s] and omega [rad/s].

    episode: the number of steps after which the scene starts again. The law of S1 has final states,
    in which little is left to simulate: it backs off for as long as anything is near, for example
    into a corner, and where robots are shifted in steps of 0.2 m some end outside the walls.
    """

    SETTINGS: ClassVar[tuple[str, ...]] = ("",)
    """The names of the ways to run it; the first is the usual one."""

    ROUND: ClassVar[bool] = True
    """Whether its robots are discs; the rays that meet those of another shape are not checked."""

    def __init__(self, scene: Any, setting: str) -> None:
        self.scene, self.setting = scene, setting
        self.episode = 200 if scene.proximity else sys.maxsize
        self.command: Float = np.zeros((2, len(scene.poses)))
        self.build()

    @abstractmethod
    def build(self) -> None:
        """Put the scene into the simulator."""

    @abstractmethod
    def advance(self) -> None:
        """Do one control step: sense, ask the law, command, move."""

    @abstractmethod
    def poses(self) -> Float:
        """Return the poses (n + p, 3) of robots, then crates: x, y [m], theta [rad]."""

    @abstractmethod
    def near(self) -> Sequence[bool]:
        """Return, for each robot, whether anything is within the scene's `proximity`."""

    @abstractmethod
    def ranges(self) -> Sequence[Any]:
        """Return the ranges (beams,) of each robot, metres: those that its law would read.

        A beam that meets nothing has the scene's `range`, or more.
        """


class Peer(Simulator):
    """A simulator that is given the commands of its robots at each step, and knows no laws."""

    def __init__(self, scene: Any, setting: str) -> None:
        robots = len(scene.poses)
        self._streams = [stream(0, f"robot robot{k}") for k in range(robots)]
        self._law = scene.law()
        self._iteration = 0
        super().__init__(scene, setting)

    @abstractmethod
    def move(self, command: Float) -> None:
        """Give the robots their commands (2, n), v [m/s] and omega [rad/s], and do one step."""

    def advance(self) -> None:
        if self.scene.proximity:
            command = self._wander(self.near())
        else:
            if self.scene.beams:
                self.ranges()
            command = self._law(self._iteration)
        self.move(command)
        self.command = command
        self._iteration += 1

    def _wander(self, near: Sequence[bool]) -> Float:
        """Return what Algorithm 2 commands. Source: Casini & Garulli (2016), section 4."""
        command = np.empty_like(self.command)
        for i, (close, rng) in enumerate(zip(near, self._streams, strict=True)):
            if close:
                command[:, i] = -0.2, 0.0
            elif self.command[0, i] < 0:
                command[:, i] = 0.0, rng.uniform(np.pi / 2, 3 * np.pi / 2)
            else:
                command[:, i] = 0.2, 0.0
        return command


class Engine(Peer):
    """An engine of rigid bodies alone, which does some equal substeps in each control step.

    At "1 mm" they are as many as a scene needs for it, see `substeps.py`.
    """

    SETTINGS: ClassVar[tuple[str, ...]] = ("1 mm", "15 substeps")

    SUBSTEPS: ClassVar[dict[str, int]]
    """The number of substeps at "1 mm" of each scene."""

    def __init__(self, scene: Any, setting: str) -> None:
        self.substeps = 15 if setting == "15 substeps" else self.SUBSTEPS[scene.name]
        super().__init__(scene, setting)


def stream(seed: int, name: str) -> np.random.Generator:
    """Return the random stream that MARS2D gives to what is called so: the same numbers."""
    key = np.frombuffer(hashlib.sha256(name.encode()).digest()[:16], dtype=np.uint32)
    return np.random.Generator(np.random.PCG64([seed, *key.tolist()]))


class Geometry:
    """What a scene looks like from given poses, worked out by numpy alone."""

    def __init__(self, scene: Any) -> None:
        self._scene = scene
        self._boxes = np.array(scene.boxes, dtype=float).reshape(-1, 4, 2)
        outlines = [np.array(scene.walls, dtype=float)[None], self._boxes]
        self._start = np.concatenate([o.reshape(-1, 2) for o in outlines])
        self._end = np.concatenate([np.roll(o, -1, axis=1).reshape(-1, 2) for o in outlines])

    def off(self, points: Float) -> Float:
        """Return how far points (n, 2) are from walls and boxes, (n,) metres; < 0 inside them."""
        along = self._end - self._start
        offset = points[:, None] - self._start
        part = (offset * along).sum(axis=2) / (along**2).sum(axis=1)
        gap = offset - np.clip(part, 0, 1)[..., None] * along
        distance = np.sqrt((gap**2).sum(axis=2))
        inside = self._inside(points)
        wall, boxes = distance[:, :4].min(axis=1), distance[:, 4:].reshape(*inside.shape, 4)
        outside = np.abs(points).max(axis=1) > self._scene.side / 2
        nearest = np.where(outside, -wall, wall)
        to_box = np.where(inside, -boxes.min(axis=2), boxes.min(axis=2))
        return np.asarray(np.minimum(nearest, to_box.min(axis=1, initial=np.inf)))

    def _inside(self, points: Float) -> NDArray[np.bool_]:
        """Return whether each point is in each box, (n, boxes); corners are in CCW order."""
        side = np.roll(self._boxes, -1, axis=1) - self._boxes
        offset = points[:, None, None] - self._boxes
        left = side[..., 0] * offset[..., 1] - side[..., 1] * offset[..., 0] >= 0
        return np.asarray(left.all(axis=2))

    def apart(self, points: Float) -> Float:
        """Return how far the surface of the nearest robot is from each robot's centre, (n,)."""
        distance = np.sqrt(((points[:, None] - points) ** 2).sum(axis=2))
        np.fill_diagonal(distance, np.inf)
        return np.asarray(distance.min(axis=1) - self._scene.radius)

    def ranges(self, poses: Float) -> tuple[Float, NDArray[np.bool_]]:
        """Return the ranges (n, beams), metres, and whether it is a robot that is seen."""
        beams, reach = self._scene.beams, self._scene.range
        angle = poses[:, 2:] - np.pi + 2 * np.pi / beams * np.arange(beams)
        ray = np.stack([np.cos(angle), np.sin(angle)], axis=2)[:, :, None]
        along = self._end - self._start
        offset = (self._start - poses[:, None, :2])[:, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            across = ray[..., 0] * along[:, 1] - ray[..., 1] * along[:, 0]
            far = (offset[..., 0] * along[:, 1] - offset[..., 1] * along[:, 0]) / across
            part = (offset[..., 0] * ray[..., 1] - offset[..., 1] * ray[..., 0]) / across
            solid = np.where((far >= 0) & (part >= 0) & (part <= 1), far, np.inf).min(axis=2)
            between = (poses[:, :2] - poses[:, None, :2])[:, None]
            ahead = (between * ray).sum(axis=3)
            square = self._scene.radius**2 - (between**2).sum(axis=3) + ahead**2
            disc = np.where((square >= 0) & (ahead > 0), ahead - np.sqrt(square), np.inf)
        index = np.arange(len(poses))
        disc[index, :, index] = np.inf
        robot = disc.min(axis=2)
        return np.minimum(np.minimum(solid, robot), reach), robot < solid


class Run:
    """A simulator that runs a scene: timed, or looked at.

    The clock stands still while a scene starts again.
    """

    def __init__(self, kind: type[Simulator], scene: Any, setting: str) -> None:
        self._build: Callable[[], Simulator] = lambda: kind(scene, setting)
        self._start()
        peer = self.peer
        self._geometry = Geometry(peer.scene)
        self._gaps = gaps.Gaps(peer.scene)
        wide = peer.scene.radius * (1.0 if peer.ROUND else 1.5)
        self._wide = Geometry(dataclasses.replace(peer.scene, radius=wide))
        self._alone = np.zeros(len(peer.scene.poses), dtype=bool)

    def timed(self, steps: int, seconds: float) -> dict[str, float]:
        """Do so many steps, or fewer if the time is up, and say how many and how long it took.

        Also said is how far robots, and crates, are from where they were at the start, on average.
        """
        done, took = 0, 0.0
        while done < steps and (done == 0 or took < seconds):
            if self._count >= self.peer.episode:
                self._start()
            more = min(steps - done, self.peer.episode - self._count)
            count, spent = self._stretch(more, seconds - took)
            done, took = done + count, took + spent
        start = np.concatenate([self.peer.scene.poses, self.peer.scene.crates])
        way = np.hypot(*(self.peer.poses() - start)[:, :2].T)
        robots, crates = np.split(way, [len(self.peer.scene.poses)])
        moved = {
            "robots": float(robots.mean()),
            "crates": float(crates.sum()) / max(1, len(crates)),
        }
        return {"steps": done, "seconds": took, **moved}

    def _start(self) -> None:
        """Build the scene."""
        self.peer = self._build()
        self._count = 0

    def _stretch(self, steps: int, seconds: float) -> tuple[int, float]:
        """Do steps without a new start; return how many, and how long it took."""
        advance, clock = self.peer.advance, time.perf_counter
        done = 0
        start = now = clock()
        while done < steps and (done == 0 or now - start < seconds):
            advance()
            done += 1
            now = clock()
        self._count += done
        self._lost(self.peer.poses()[:, :2])
        return done, now - start

    def _lost(self, points: Float) -> NDArray[np.bool_]:
        """Return who is deep in a box or outside the walls. Raises ValueError if they are many."""
        lost = self._geometry.off(points) < -self.peer.scene.radius
        if lost.mean() > LOST:
            raise ValueError(
                f"{lost.sum()} of {len(lost)} bodies are outside the walls or deep in boxes after "
                f"{self._count} steps"
            )
        return np.asarray(lost)

    def looked_at(self, steps: int, seconds: float) -> dict[str, float]:
        """Do steps, check after each what is said of the run, and return what was seen.

        Returns the deepest overlaps of bodies with each other and with walls and boxes, metres; how
        many were lost, outside the walls or deep in a box; and the number of steps. Raises
        ValueError for a run that is not what it seems.
        """
        deep = {"bodies": 0.0, "walls": 0.0}
        if self.peer.episode < sys.maxsize:
            self._start()
            steps = min(steps, self.peer.episode)
        start = time.perf_counter()
        done, free, left = 0, 0, 0
        after = self.peer.poses()
        while done < steps and (done == 0 or time.perf_counter() - start < seconds):
            before = after
            self._check_senses(before)
            self.peer.advance()
            after = self.peer.poses()
            done += 1
            self._count += 1
            if self._count > SETTLED:
                free += self._check_way(before, after)
            lost = self._lost(after[:, :2])
            left = max(left, int(lost.sum()))
            for what, gap in zip(deep, self._gaps(after), strict=True):
                deep[what] = max(deep[what], -float(gap[~lost].min()))
        if done > 1 and self._count > SETTLED and not free:  # in the first, nobody is known to be
            raise ValueError("no robot was ever free to move as it was told")
        return {"steps": done, "lost": left, **deep}

    def _check_way(self, before: Float, after: Float) -> int:
        """Check that robots which nothing was near went as told; return how many these are."""
        scene = self.peer.scene
        v, omega = self.peer.command
        way = np.abs(v) * scene.sampling_time
        room = 2 * scene.sampling_time * scenes.SPEED + 0.01
        if not self.peer.ROUND:
            room += scene.radius
        apart = np.minimum(*self._gaps(before, 2 * room)) > room
        alone = apart[: len(way)]
        felt = {
            k for i, k, length in scene.ropes
            if np.hypot(*(before[i] - before[len(way) + k])[:2]) > length - room
            or not apart[len(way) + k]
        }  # fmt: skip
        alone[[i for i, k, _ in scene.ropes if k in felt]] = False  # all that tow it feel that
        # Who was thrown off its command has a step to come back to it.
        free, self._alone = alone & self._alone, alone
        before, after = before[: len(way)], after[: len(way)]
        went = after - before
        moved = np.hypot(went[:, 0], went[:, 1])
        turn = (went[:, 2] - omega * scene.sampling_time + np.pi) % (2 * np.pi) - np.pi
        miss = np.maximum(np.abs(moved - way) - 1e-4, 0) > SLACK * way
        miss |= np.abs(turn) > 1e-3
        heading = before[:, 2] + np.where(v < 0, np.pi, 0)
        aside = (np.arctan2(went[:, 1], went[:, 0]) - heading + np.pi) % (2 * np.pi) - np.pi
        miss |= (np.abs(aside) > np.abs(omega) * scene.sampling_time + 0.01) & (way > 0)
        for i in np.flatnonzero(free & miss)[:1]:
            raise ValueError(
                f"robot {i}, which nothing is near, was told to go {way[i]:.4f} m and to turn by "
                f"{omega[i] * scene.sampling_time:.4f} rad; it went {moved[i]:.4f} m, "
                f"{aside[i]:.3f} rad off its heading, and {turn[i]:.4f} rad too far round"
            )
        return int(np.count_nonzero(free))

    def _check_senses(self, poses: Float) -> None:
        """Check what the peer's sensors say against geometry."""
        scene = self.peer.scene
        if scene.proximity:
            points = poses[:, :2]
            distance = np.minimum(self._geometry.off(points), self._geometry.apart(points))
            wrong = np.asarray(self.peer.near()) != (distance < scene.proximity)
            for i in np.flatnonzero(wrong & (np.abs(distance - scene.proximity) > TOLERANCE))[:1]:
                raise ValueError(f"robot {i}: is what is {distance[i]:.4f} m away near?")
        if scene.beams:
            read = np.minimum(np.asarray(self.peer.ranges(), dtype=float), scene.range)
            true, _ = self._geometry.ranges(poses)
            if read.shape != true.shape:
                raise ValueError(f"ranges have the shape {read.shape}, not {true.shape}")
            off = np.abs(read - true)
            if not self.peer.ROUND:
                off[self._wide.ranges(poses)[1]] = 0
            # At an edge a beam that is off by a rounding error sees what is behind.
            if np.mean(off > TOLERANCE) > 0.005:
                raise ValueError(f"{np.mean(off > TOLERANCE):.1%} of the ranges are not right")


def serve(kind: type[Simulator]) -> None:
    """Do what is asked for, a line of JSON at a time, until there are no more lines."""
    run: Run | None = None
    for line in sys.stdin:
        ask = json.loads(line)
        answer: dict[str, float]
        try:
            if run is None:
                run = Run(kind, SCENES[ask["scene"]](), ask["setting"])
                answer = {}
            elif ask["do"] == "time":
                answer = run.timed(ask["steps"], ask["seconds"])
            else:
                answer = run.looked_at(ask["steps"], ask["seconds"])
        except ValueError as error:
            print(json.dumps({"error": str(error)}), flush=True)
            return
        print(json.dumps(answer), flush=True)


def main(kind: type[Simulator]) -> None:
    """Run a scene: check it while it is looked at, then time it and print the steps a second."""
    text = (sys.modules[kind.__module__].__doc__ or "").partition("\n")[0]
    parser = argparse.ArgumentParser(description=text)
    parser.add_argument("--serve", action="store_true", help="take orders from run.py")
    parser.add_argument("--scene", choices=SCENES, default="S2", help="which (default S2)")
    parser.add_argument("--setting", choices=kind.SETTINGS, default=kind.SETTINGS[0])
    parser.add_argument("--steps", type=int, default=200, help="how many (default 200)")
    parser.add_argument("--seconds", type=float, default=20.0, help="at most this long (20)")
    arguments = parser.parse_args()
    if arguments.serve:
        serve(kind)
        return
    run = Run(kind, SCENES[arguments.scene](), arguments.setting)
    try:
        seen = run.looked_at(arguments.steps, arguments.seconds)
    except ValueError as error:
        sys.exit(f"not a run to be timed: {error}")
    print(
        f"deepest overlap in {seen['steps']} steps: bodies {1e3 * seen['bodies']:.2f} mm, "
        f"walls and boxes {1e3 * seen['walls']:.2f} mm; {seen['lost']} lost"
    )
    took = run.timed(arguments.steps, arguments.seconds)
    print(f"{took['steps'] / took['seconds']:.4g} steps/s")
