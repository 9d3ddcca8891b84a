"""A monkey before real windows for an hour: random keys, clicks, drags; errors and memory noted.

    python tests/window/monkey.py [--minutes 60] [--seed 1] [--windows live,replay] [--json OUT]

Each window has an X server and a process of its own, in which `mars2d run SCENE --record run.mcap`,
`mars2d replay` or `mars2d edit` is called, and called again whenever the monkey has left the window
by a key: so the memory is that of one process for the whole time. All windows are open at once. The
same seed gives the same acts, but not at the same instants of a run.

What must not grow is what stays from act to act: a window left leaves nothing, nor does a run that
was started again. So the scene ends after 30 s; the monkey starts it again by R, as any other key,
and the branches that it has made are forgotten then; the editor remembers 500 steps at most. All
that is bounded, but goes up and down by chance: so memory, the part that no file stands behind, is
told as the median of each tenth of the time. It counts as flat where those of the last third are
on average no more than 10 % above those of the third before. The first third is left out.

Exit code: 0 when nothing went wrong and memory is flat, else 1.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import random
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from tests.processes import bare_environment, x_server

ROOT = Path(__file__).parents[2]
SCREEN = 1000, 700
LOOK = 10.0
"""The seconds between two looks at memory."""
PAUSE = 0.04
"""The seconds between two acts, on average."""

SCENE = """
import numpy as np

from mars2d import Robot, Scenario
from mars2d.addons import Communication, Map, Trails
from mars2d.bodies.props import Ball, Box
from mars2d.sensors import Proximity, RangeFinder


def wander(robot):
    robot.send(robot.pose[0])
    if robot.sense.proximity:
        return 0.05, 1.5
    return 0.3, robot.rng.normal()


def circle(robot):
    return 0.2, 0.5


def scenario():
    sensors = [Proximity(range=0.8), RangeFinder(beams=9, rate=5.0)]
    robots = [
        Robot(pose=(k - 2, 1, k), sensors=sensors, controller=wander, color=color)
        for k, color in enumerate(("#d62728", "#1f77b4", "#2ca02c"))
    ]
    robots.append(Robot(name="round", pose=(0, -1, 0), controller=circle))
    return Scenario(
        title="A room for a monkey",
        robots=robots,
        props=[
            Box(name="crate", pose=(1.5, -1, 0), length=0.4, width=0.4, mass=1.0),
            Ball(name="ball", pose=(-1.5, -1, 0), velocity=(0.5, 0.2, 0)),
        ],
        workspace=[(-3, -2), (3, -2), (3, 2), (-3, 2)],
        on_exit="wall",
        addons=[
            Map([[(2, -0.5), (2.4, -0.5), (2.2, 0.5)]], walls=[[(-2.5, -1.5), (-2.5, -0.5)]]),
            Communication(range=2.0, loss=0.1, delay=0.1),
            Trails(duration=5.0),
        ],
        stop_time=30.0,
    )
"""

COMMANDS = {
    "live": ("run", "scene.py", "--record", "run.mcap"),
    "replay": ("replay", "past.npz"),
    "editor": ("edit", "drawing.toml"),
}

AGAIN = """
import sys
from pathlib import Path
from mars2d.cli.command_line import main
drawn, new = Path("drawing.toml"), Path("new.toml").read_text()
while True:
    drawn.write_text(new)
    for each in Path().glob("run*.mcap"):
        each.unlink()
    print("exit", main(sys.argv[1:]), flush=True)
"""
"""Calls a command again and again in one process, and tells how each ended."""

SPECIAL = """
space Left Right Up Down Next Prior Home End Tab Escape Return F1 F5 plus minus equal
Delete BackSpace shift+Return shift+Tab ctrl+s ctrl+z ctrl+y ctrl+a ctrl+d ctrl+r ctrl+shift+z
"""
KEYS = [*"abcdefghijklmnopqrstuvwxyz0123", *SPECIAL.split(), *["Escape", "Return"] * 6]
HELD = [*"wasd", "Up", "Left", "Right", "shift", "ctrl", "space"]
BUTTONS = (1, 1, 1, 1, 1, 2, 3, 3)
SIZES = ((900, 630), (900, 630), (800, 600), (320, 240), (500, 690), (1000, 300))


class Monkey:
    """Presses keys and moves the mouse on one screen, at random but the same for a seed."""

    def __init__(self, display: str, seed: str) -> None:
        """Take a screen; no key is pressed yet."""
        self.display, self.random = display, random.Random(seed)
        self.done: Counter[str] = Counter()
        self._hands = self._new_hands()
        self._down: set[str] = set()

    def act(self) -> None:
        """Do one thing."""
        kinds = (self._key, self._hold, self._click, self._drag, self._wheel, self._resize)
        (kind,) = self.random.choices(kinds, weights=(50, 6, 15, 18, 8, 1))
        self.done[kind.__name__.strip("_")] += 1
        self._do(kind())

    def let_go(self) -> None:
        """Release all that is held."""
        self._do("".join(f"keyup {key}\n" for key in sorted(self._down)))
        self._down.clear()

    def close(self) -> None:
        """Put the hands down, whatever they were still to do."""
        assert self._hands.stdin is not None
        self._hands.kill()
        self._hands.wait()
        with contextlib.suppress(OSError):
            self._hands.stdin.close()

    def _do(self, lines: str) -> None:
        """Do what lines of xdotool's language say."""
        try:
            assert self._hands.stdin is not None
            self._hands.stdin.write(lines)
            self._hands.stdin.flush()
        except BrokenPipeError:  # a window was gone that it looked for
            self.close()
            self._hands = self._new_hands()

    def _new_hands(self) -> subprocess.Popen[str]:
        environment = os.environ | {"DISPLAY": self.display}
        quiet = subprocess.DEVNULL
        return subprocess.Popen(
            ["xdotool", "-"], env=environment, stdin=subprocess.PIPE, stdout=quiet, stderr=quiet,
            text=True,
        )  # fmt: skip

    def _place(self) -> tuple[int, int]:
        width, height = SCREEN
        if self.random.random() < 0.6:  # there more is going on
            return self.random.randrange(150, 800), self.random.randrange(100, 520)
        return self.random.randrange(width), self.random.randrange(height)

    def _move(self) -> str:
        x, y = self._place()
        return f"mousemove {x} {y}\n"

    def _key(self) -> str:
        return f"key {self.random.choice(KEYS)}\n"

    def _hold(self) -> str:
        """Press a key and keep it down, or let go of it."""
        key = self.random.choice(HELD)
        down = key not in self._down
        self._down ^= {key}
        return f"key{'down' if down else 'up'} {key}\n"

    def _click(self) -> str:
        return f"{self._move()}click {self.random.choice(BUTTONS)}\n"

    def _drag(self) -> str:
        """Drag; at times something else comes first, before the button is let go of."""
        button = self.random.choice(BUTTONS)
        way = "".join(self._move() for _ in range(self.random.randrange(5)))
        between = self._key() if self.random.random() < 0.2 else ""
        return f"{self._move()}mousedown {button}\n{way}{between}mouseup {button}\n"

    def _wheel(self) -> str:
        times = self.random.randrange(1, 4)
        return f"{self._move()}click --repeat {times} {self.random.choice((4, 5))}\n"

    def _resize(self) -> str:
        width, height = self.random.choice(SIZES)
        return f"search --onlyvisible --class . windowsize {width} {height}\n"


class Window:
    """A window of one kind, the monkey before it, and what is noted of both."""

    def __init__(self, kind: str, folder: Path, display: str, seed: int) -> None:
        """Open the window, on a screen of its own. folder: where it finds and makes files."""
        self.kind, self.folder, self.display = kind, folder, display
        self.errors: list[str] = []
        self.exits: Counter[int] = Counter()
        self.memory: list[int] = []
        self.monkey = Monkey(display, f"{kind} {seed}")
        self._open()

    def spend(self, seconds: float) -> None:
        """Let the monkey play for some time, and note memory; begin again where a process dies."""
        start = time.monotonic()
        look = start + LOOK
        while (now := time.monotonic()) < start + seconds:
            if now >= look:
                look += LOOK
                self.monkey.let_go()
                self._note()
                if len(self.memory) % 30 == 0:
                    self._tell((now - start) / 60)
            self.monkey.act()
            time.sleep(self.monkey.random.uniform(0, 2 * PAUSE))
        self._end()

    def result(self) -> dict[str, Any]:
        """Return what is to be told of it."""
        tenths = [statistics.median(part) for part in _parts(self.memory, 10)]
        early = self.memory[min(round(300 / LOOK), len(self.memory) - 1)]
        return {
            "acts": dict(self.monkey.done),
            "left by a key, and opened again": self.exits[0],
            "files made by keys": dict(Counter(p.suffix for p in self.folder.glob("*_[0-9]*.*"))),
            "errors": self.errors,
            "memory at 5 minutes, most, last, MB": [
                round(kb / 1e3, 1) for kb in (early, max(self.memory), self.memory[-1])
            ],
            "memory, medians of each tenth, MB": [round(kb / 1e3, 1) for kb in tenths],
            "flat": statistics.mean(tenths[7:]) <= 1.1 * statistics.mean(tenths[4:7]),
        }

    def _open(self) -> None:
        environment = bare_environment()
        environment |= {"DISPLAY": self.display, "SDL_VIDEO_WINDOW_POS": "0,0"}
        self._process = subprocess.Popen(
            [sys.executable, "-c", AGAIN, *COMMANDS[self.kind]],
            cwd=self.folder,
            env=environment | {"PYTHONPATH": str(ROOT)},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self._readers = [
            threading.Thread(target=read, args=(self._process,), daemon=True)
            for read in (self._read_exits, self._read_errors)
        ]
        for reader in self._readers:
            reader.start()

    def _read_exits(self, process: subprocess.Popen[str]) -> None:
        assert process.stdout is not None
        for line in process.stdout:
            if line.startswith("exit "):
                code = int(line.split()[1])
                self.exits[code] += 1
                if code != 0:
                    self._error(f"exit code {code}")

    def _read_errors(self, process: subprocess.Popen[str]) -> None:
        assert process.stderr is not None
        for line in process.stderr:
            if not line.startswith("mars2d: another branch, "):  # which is as it should be
                self._error(line.rstrip())

    def _error(self, line: str) -> None:
        self.errors.append(line)
        print(f"{self.kind}: {line}", file=sys.stderr, flush=True)

    def _note(self) -> None:
        """Note the memory; open another window if this process has died."""
        code = self._process.poll()
        if code is None:
            self.memory.append(_memory(self._process.pid))
        else:
            self._error(f"the process ended with {code}")
            self._open()

    def _tell(self, minutes: float) -> None:
        """Say how far it has got."""
        done, memory = self.monkey.done.total(), self.memory[-1] / 1e3
        print(f"{self.kind}: {minutes:.0f} minutes, {done} acts, {memory:.0f} MB", flush=True)

    def _end(self) -> None:
        self.monkey.let_go()
        self.monkey.close()
        if self._process.poll() is not None:
            self._error(f"the process ended with {self._process.returncode}")
        self._process.kill()
        self._process.wait()
        for reader in self._readers:
            reader.join()
        for stream in (self._process.stdout, self._process.stderr):
            assert stream is not None
            stream.close()


def _memory(pid: int) -> int:
    """Return the memory of a process that no file stands behind, kB."""
    lines = Path(f"/proc/{pid}/status").read_text(encoding="utf-8").splitlines()
    return int(next(line for line in lines if line.startswith("RssAnon")).split()[1])


def _parts(values: list[int], count: int) -> Iterator[list[int]]:
    """Cut values into parts of about the same length, none empty."""
    for k in range(count):
        first, end = k * len(values) // count, (k + 1) * len(values) // count
        yield values[first : max(end, first + 1)]


@contextlib.contextmanager
def screens(count: int) -> Iterator[list[str]]:
    """Start X servers on free displays; yield their names."""
    with contextlib.ExitStack() as stack:
        yield [stack.enter_context(x_server(*SCREEN))[0] for _ in range(count)]


def prepare(folder: Path) -> None:
    """Write what a window needs: a scene, a record of it, a drawing."""
    (folder / "scene.py").write_text(SCENE, encoding="utf-8")
    command = [sys.executable, "-m", "mars2d", "run", "scene.py", "--headless"]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    subprocess.run(
        [*command, "--record", "past.npz"], cwd=folder, env=environment, check=True,
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    drawing = ["from mars2d import Robot, Scenario", "from mars2d.bodies.props import Box"]
    drawing += ["Scenario(robots=[Robot(), Robot(pose=(1, 0, 0))], stop_time=20.0,"]
    drawing += ["    props=[Box(pose=(0, 1, 0))]).save('new.toml')"]
    subprocess.run([sys.executable, "-c", "\n".join(drawing)], cwd=folder, env=environment,
                   check=True)  # fmt: skip


def run(kinds: list[str], minutes: float, seed: int) -> dict[str, Any]:
    """Let monkeys play before windows of these kinds, all at once; return what is to be told."""
    with tempfile.TemporaryDirectory() as made, screens(len(kinds)) as names:
        windows = []
        for kind, name in zip(kinds, names, strict=True):
            folder = Path(made) / kind
            folder.mkdir()
            prepare(folder)
            windows.append(Window(kind, folder, name, seed))
        start = time.monotonic()
        together([lambda window=window: window.spend(60 * minutes) for window in windows])
        spent = round((time.monotonic() - start) / 60, 1)
        results = {window.kind: window.result() for window in windows}
    return {"minutes": spent, "seed": seed, "windows": results}


def together(tasks: list[Callable[[], None]]) -> None:
    """Do all tasks at once, and wait for them."""
    threads = [threading.Thread(target=task) for task in tasks]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def main() -> int:
    """Print what was noted; return the exit code."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--windows", default=",".join(COMMANDS), help="which, with commas between")
    parser.add_argument("--json", type=Path, metavar="OUT")
    arguments = parser.parse_args()
    result = run(arguments.windows.split(","), arguments.minutes, arguments.seed)
    print(f"{result['minutes']} minutes, seed {result['seed']}")
    for kind, told in result["windows"].items():
        print(f"\n{kind}")
        for name, value in told.items():
            print(f"  {name:36}{value}")
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(result, indent=1), encoding="utf-8")
    return int(any(told["errors"] or not told["flat"] for told in result["windows"].values()))


if __name__ == "__main__":
    sys.exit(main())
