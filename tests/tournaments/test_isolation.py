"""Isolated laws: the same runs as in one process, and a named verdict for whatever a law does."""

from __future__ import annotations

import dataclasses
import os
import sys
import threading
from math import pi
from pathlib import Path

import pytest

from mars2d import Holonomic, InputError, LawError, Robot, Scenario, load_law
from mars2d.addons import Addon, Communication, Game, Map
from mars2d.bodies.props import Puck
from mars2d.scenario.experiment import Experiment
from mars2d.scenario.neighbours import Neighbourhood, Within
from mars2d.sensors import Bumper, Proximity, RangeFinder
from mars2d.tournaments.isolation import Isolated, Limits, run_isolated
from mars2d.tournaments.isolation.jail import is_protected
from mars2d.tournaments.isolation.source import law_code
from mars2d.world.loop import simulate
from tests.cases import each_case
from tests.processes import wait_until

needs_proc = pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")

LIMITS = Limits(tick=4.0, match=20.0, memory=200, output=0.1, start=20.0)

GOOD = """
def control(robot):
    return 0.1, 0.2
"""


def law(folder: Path, text: str, name: str = "law.py") -> Path:
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return file


def pair(**fields) -> Scenario:
    robot = Robot(**fields)
    return Scenario(robots=[robot.at(-2, 0), robot.at(2, 0, pi)], stop_time=2.0)


def played(scenario: Scenario, laws: dict, seed: int = 1, limits: Limits = LIMITS) -> Isolated:
    """Run a match to its end or its failure."""
    return run_isolated(Experiment(scenario, seed=seed), laws, limits)


# -- determinism ---------------------------------------------------------------------------------


PURSUE = """
from math import atan2
from mars2d.core.plane import wrap

def control(robot):
    x, y = robot.neighbours[0].position - robot.position
    return 0.3, wrap(atan2(y, x) - robot.pose[2]) + robot.rng.normal()
"""

FLEE = """
import numpy as np

def control(robot):
    robot.memory.steps = 0
    while True:
        robot.memory.steps += 1
        away = robot.position - robot.neighbours[0].position
        yield away * (1 + 0.01 * robot.memory.steps) + 0.01 * robot.velocity[:2]
"""

PUSHER = """
import numpy as np

def control(robot):
    world = robot.world
    other = world.robots[1 - robot.index]
    bearing = np.arctan2(*(other.position - robot.position)[::-1]) - robot.pose[2]
    touched = len(robot.contacts) + len(world.contacts) + world.props[0].velocity[0]
    drawn = robot.rng.normal() * world.effort.sum() + world.velocity[0, 1 - robot.index]
    return 1.0 + 0.01 * touched, 6 * np.arctan2(np.sin(bearing), np.cos(bearing)) + drawn
"""

SENSING = """
def control(robot):
    near = robot.sense.proximity
    scan = robot.sense.range_finder
    assert not scan.flags.writeable
    if robot.sense.bumper.any() or near:
        yield -0.3, robot.rng.uniform(1, 2)
    while True:
        yield 0.3, min(1, robot.sense.range_finder.min()) + robot.effort
"""

TALKING = """
def control(robot):
    heard = {m.name: m.content["x"] for m in robot.inbox if isinstance(m.content, dict)}
    robot.send({"x": float(robot.pose[0]), "t": (robot.time, None)})
    if heard:
        robot.send([1, float("inf")], to=sorted(heard)[0])
    near = [n.pose[2] for n in robot.neighbours]
    return 0.2, 0.1 * sum(heard.values()) + sum(near) + robot.command[0]
"""


class Rim(Neighbourhood):
    """A rule of the user's own, which a law's process does not know."""

    def of(self, position):
        return [[1], [0], [0, 1]]


def pursuit() -> Scenario:
    red = Robot(name="red", sees="positions")
    blue = red.replace(name="blue", drive=Holonomic(max_linear_speed=0.2))
    game = Game({"pursuer": ["red"], "evader": ["blue"]})
    return Scenario(robots=[red.at(-2, 2), blue.at(1, 1)], stop_time=8, addons=[game])


def sumo() -> Scenario:
    robot = Robot(friction="rubber")
    puck = Puck(pose=(0, 0.3, 0))
    robots = [robot.at(-0.8, 0), robot.at(0.8, 0, pi)]
    return Scenario(robots=robots, props=[puck], stop_time=2, sampling_time=0.02, on_exit="wall")


def maze() -> Scenario:
    sensors = [
        Proximity(range=0.4),
        RangeFinder(beams=9, noise=0.01, recorded=False),
        Bumper(),
    ]
    robot = Robot(sees="sensors", sensors=sensors)
    walls = Map([[(1, -1), (1, 1)], [(-1, -2), (2, -2)]])
    return Scenario(robots=[robot.at(-2, 0), robot.at(0, -1, 1)], stop_time=10, addons=[walls])


def talk() -> Scenario:
    robot = Robot(sees="partial")
    channel = Communication(loss=0.3, range=4.0, delay=0.15)
    return Scenario(
        robots=[robot.at(-2, 0), robot.at(0, -1, 1), robot.at(1, 1)],
        neighbours=Within(3.0),
        stop_time=5,
        addons=[channel],
    )


MATCHES = {
    "positions, generators, memory, velocity": (pursuit, {"red": [0], "blue": [1]}, PURSUE, FLEE),
    "full, contacts, props": (sumo, {"red": [0], "blue": [1]}, PUSHER, PUSHER),
    "sensors only": (maze, {"red": [0], "blue": [1]}, SENSING, SENSING),
    "messages": (talk, {"red": [0, 2], "blue": [1]}, TALKING, TALKING),
    "a rule of the user's own": (
        lambda: talk().replace(neighbours=Rim()), {"red": [0, 2], "blue": [1]}, TALKING, TALKING,
    ),
}  # fmt: skip


@pytest.mark.slow
@each_case("match", MATCHES)
def test_an_isolated_match_has_the_digest_of_one_in_this_process(match, tmp_path) -> None:
    make, roles, *texts = MATCHES[match]
    files = [law(tmp_path, text, f"law{k}.py") for k, text in enumerate(texts)]
    laws = dict(zip(roles, zip(files, roles.values(), strict=True), strict=True))
    scenario = make()
    robots = list(scenario.robots)
    for file, indices in laws.values():
        for i in indices:
            robots[i] = robots[i].replace(controller=load_law(file))
    for seed in (3, 4):
        here = simulate(Experiment(scenario.replace(robots=robots), seed=seed)).record
        there, verdicts, _ = played(scenario, laws, seed, Limits())
        assert verdicts == {}
        assert len(there) == len(here) > 20
        assert there.digest == here.digest
        assert there.messages.tobytes() == here.messages.tobytes()


# -- what a law may see --------------------------------------------------------------------------


@each_case(
    "sees, expression, words",
    [
        ("positions", "robot.neighbours[0].pose", "sees positions only: a neighbour's pose"),
        ("positions", "robot.world", "sees itself and its neighbours' positions only"),
        ("sensors", "robot.sense.sonar", "robot0 has no sensor 'sonar'; it carries none"),
        ("partial", "robot.send(1)", "robots can't talk: add Communication()"),
        ("full", "robot.world.addons", "robot.world.addons is not available to an isolated law"),
        ("full", "robot.world.rng", "available to an isolated law; there is robot.rng"),
        ("full", "robot.world.robots[1].memory", "another robot's memory is not available"),
    ],
)
def test_what_an_isolated_law_may_not_see_is_refused_in_words(
    sees, expression, words, tmp_path
) -> None:
    file = law(tmp_path, f"def control(robot):\n    {expression}\n    return 0, 0\n")
    record, verdicts, _ = played(pair(sees=sees), {"red": (file, [0])})
    verdict = verdicts["red"]
    assert verdict.kind == "error"
    assert verdict.text.startswith("law.py, line 2: ")
    assert words in verdict.text
    assert f"red: {verdict.text}" in record.over_message


# -- faults and verdicts -------------------------------------------------------------------------

MISTAKES = {
    "a loop in C": ("slow", "law.py, line 2: no command after 0.5 s", """
        def control(robot): return sum(range(10**12)), 0"""),
    "an endless loop while it is loaded": ("slow", "line 2: not loaded after 0.5 s", """
        while True: pass"""),
    "a syntax error": ("start", "law.py, line 2: invalid syntax: 1 +* 1", """
        1 +* 1"""),
    "slow steps": ("clock", "line 3: its commands took more than 0.7 s in all", """
        import time
        def control(robot): return time.sleep(0.15) or 0.0, 0.0"""),
}  # fmt: skip
"""What `test_cheats` does not have."""


@pytest.mark.slow
@each_case("fault", MISTAKES)
def test_a_law_with_a_mistake_has_a_verdict_and_the_other_goes_on(fault, tmp_path) -> None:
    kind, words, text = MISTAKES[fault]
    limits = dataclasses.replace(
        LIMITS, tick=0.5, start=0.5 if "loaded" in fault else 20, match=0.7
    )
    lines = (line.removeprefix("        ") for line in text.splitlines())
    nasty = law(tmp_path, "\n".join(lines))
    good = law(tmp_path, GOOD, "good.py")
    laws = {"bad": (nasty, [0]), "good": (good, [1])}
    record, verdicts, _ = played(pair(), laws, 1, limits)
    verdict = verdicts.pop("bad")
    assert verdict.kind == kind, verdict
    assert words in verdict.text, verdict
    assert "\n" not in verdict.text
    assert verdicts == {}  # nobody else is to blame
    assert record.over_message.startswith("Error: ")
    assert f"bad: {verdict.text}" in record.over_message


def test_what_a_law_prints_is_kept_in_order_however_it_is_printed(tmp_path) -> None:
    text = """
import os, sys
print("loaded", end=" ")
def control(robot):
    print(round(10 * robot.time), end="")
    os.write(1, b"/")
    if robot.time == 0:
        print("\\u00e4\\ud800", file=sys.stderr)
    return 0, 0
"""
    _, verdicts, output = played(pair(), {"a": (law(tmp_path, text), [0])})
    assert verdicts == {}
    assert output["a"].startswith("loaded 0/\u00e4\\ud800\n1/2/3/")


def test_a_law_is_what_was_read_and_reads_what_is_beside_it_and_what_is_allowed(tmp_path) -> None:
    (tmp_path / "other").mkdir()
    (tmp_path / "laws").mkdir()
    table = law(tmp_path / "other", "0.3", "table.txt")
    law(tmp_path / "laws", "SPEED = 0.1", "helper.py")
    law(tmp_path / "laws", "0.2", "beside.txt")
    text = f"""
from pathlib import Path
from helper import SPEED
def control(robot):
    beside = Path(__file__).with_name("beside.txt").read_text()
    return SPEED + float(beside), float(Path({str(table)!r}).read_text())
"""
    file = law(tmp_path / "laws", text)
    code = {"a": law_code(file)}
    file.write_text("1 +* 1")
    law(tmp_path / "laws", "SPEED = 99", "helper.py")
    for reads, verdicts in (([], ["a"] * is_protected()), ([table], [])):
        limits = dataclasses.replace(LIMITS, reads=reads)
        ran = run_isolated(Experiment(pair(), seed=1), {"a": (file, [0])}, limits, code)
        assert [*ran.verdicts] == verdicts, ran.verdicts
        assert all("which read what is beside" in v.text for v in ran.verdicts.values())
    assert ran.record.command[0, :, 0].tolist() == pytest.approx([0.3, 0.3])


# -- nothing is left behind ----------------------------------------------------------------------


def descendants() -> set[int]:
    """All processes that have come of this one, but for the fork server."""
    parents = {}
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit():
            try:
                stat = (folder / "stat").read_text()
            except OSError:
                continue
            parents[int(folder.name)] = int(stat.rpartition(")")[2].split()[1])
    found = {os.getpid()}
    while more := {child for child, parent in parents.items() if parent in found} - found:
        found |= more
    return found - {os.getpid()}


def held() -> tuple[int, int]:
    return len([*Path("/proc/self/fd").iterdir()]), threading.active_count()


def gained(before: tuple[int, int]) -> list[int]:
    """Files and threads that there are more than before; those of other tests may have ended."""
    return [now - then for now, then in zip(held(), before, strict=True) if now > then]


class Broken(Addon):
    """Fails in the first control step."""

    def on_step(self, world):
        raise RuntimeError("no fault of a law")


@needs_proc
def test_matches_leave_no_process_thread_or_file_behind(tmp_path) -> None:
    bad = "def control(robot):\n    return 0, 1 / (robot.index + robot.time - 0.1)\n"
    laws = {"a": (law(tmp_path, bad), [0]), "b": (law(tmp_path, GOOD, "good.py"), [1])}
    scenario = pair().replace(stop_time=0.2)
    broken = scenario.replace(addons=[Broken()])
    played(scenario, laws)
    before, others = held(), descendants()
    for k in range(10):
        if k % 2:
            assert played(scenario, laws).verdicts["a"].kind == "error"
        else:
            with pytest.raises(LawError, match="no fault of a law"):
                played(broken, laws)
    wait_until(lambda: not gained(before))
    wait_until(lambda: descendants() <= others)


# -- what can't be isolated ----------------------------------------------------------------------


def test_wrong_robots_and_limits_are_errors(tmp_path) -> None:
    file = law(tmp_path, GOOD)
    with pytest.raises(InputError, match=r"laws\['a'\]: there is no robot 2; they are 0 to 1"):
        played(pair(), {"a": (file, [2])})
    with pytest.raises(InputError, match=r"laws: robot1 has two"):
        played(pair(), {"a": (file, [1]), "b": (file, [1])})
    with pytest.raises(InputError, match=r"Limits.tick = 0: expected a number > 0"):
        Limits(tick=0)
