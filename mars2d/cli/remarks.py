"""Remarks on legal input that is hardly meant: degrees, commands cut off, flags as distances."""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Callable, Iterable, Iterator, Sequence
from math import pi
from types import FunctionType
from typing import Any

import numpy as np

from mars2d.core.errors import counted
from mars2d.core.materials import GRAVITY
from mars2d.core.plane import outside_polygon
from mars2d.core.usercode import definition, written
from mars2d.scenario.experiment import Experiment
from mars2d.scenario.robot import Robot
from mars2d.world.world import World

ORDERED = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)
"""The comparisons that a number is meant for."""

SENSED = re.compile(r".*\.sense\.(\w+)(\[.*\])?")
"""A reading in a law's code, or an item of it."""

RETURNED = re.compile(r"(?:np\.(?:as)?array\()?(\w+)\)?")
"""What a law returns as it is: a name, or its array."""

_SLEEP = "sleep has no meaning in simulated time; compare robot.time"
WAITING = {
    "time.sleep": _SLEEP,
    "sleep": _SLEEP,
    "plt.show": "nothing is shown while a simulation runs; use plt.savefig, or mars2d plot RECORD",
    "input": "nobody answers while a simulation runs; make it a parameter of scenario(...)",
}
"""Calls that would wait for somebody, and what to write instead."""

MOST = 0.5
"""The share of cut commands above which a run gets a remark."""

WHIRL = 30.0
"""Rad/s that no robot on wheels turns at, nor rad that it starts at; it steers by pi at most."""

LATE = 10.0
"""How many times longer than a control step laws may take it without a remark."""

STILL, SHIFTED = 1e-3, 0.02
"""How far a prop may go that is said not to move, and one that blows shifted only, metres."""


def before(experiment: Experiment) -> Iterator[str]:
    """Yield remarks on an experiment that has not been run."""
    for robot in experiment.scenario.robots:
        theta = robot.pose[2]
        if abs(theta) >= WHIRL and theta % 15 == 0:  # such as 45 or -180
            yield f"{robot.name} starts at theta = {theta:g} rad{_meant(theta)}"
    robots = experiment.scenario.robots
    laws = [*(robot.controller for robot in robots), experiment.control]
    yield from _of_laws(filter(None, laws), robots)
    if experiment.control is not None and len(robots) == experiment.scenario.inputs:
        yield from _of_rows(written(experiment.control), len(robots))


def after(world: World) -> Iterator[str]:
    """Yield remarks on the commands, the laws, the props and the end of a run so far."""
    if world.iteration:
        for remarks in (_of_commands, _of_time, _of_props, _of_end):
            yield from remarks(world)


def _of_commands(world: World) -> Iterator[str]:
    """Yield remarks on robots whose commands look like degrees, or are far beyond their bounds.

    Only wheels turn a robot otherwise where they are cut: other drives go as meant, but slower.
    """
    cuts, robots = world.simulation.drives.cuts, world.scenario.robots
    first_command = world.history.command[0]
    for i, robot in enumerate(robots):
        for row, quantity in enumerate(robot.drive.inputs):
            asked = cuts.asked[row, i] or first_command[row, i]
            steers = quantity.kind == "angle"
            spins = quantity.name == "omega" and (robot.drive.wheel_names or robot.drive.holonomic)
            if (steers and abs(asked) > pi) or (spins and abs(asked) >= WHIRL):
                given = f"{quantity.name} = {asked:g} {quantity.unit}"
                yield f"{robot.name} was given {given}{_meant(asked)}"
    shares = cuts.count / (world.iteration + 1)
    cut = [
        i for i in np.argsort(-shares, kind="stable")
        if shares[i] > MOST and robots[i].drive.wheel_names is not None
    ]  # fmt: skip
    if cut:
        others = counted(len(cut) - 1, "other robot")
        rest = f", and most of those of {others}" if len(cut) > 1 else ""
        first, asked = robots[cut[0]], cuts.asked[:, cut[0]]
        bounds = " and ".join(
            f"{each.name} [{each.unit}] from {low:.3g} to {high:.3g}"
            for each, low, high in zip(first.drive.inputs, *first.drive.bounds, strict=True)
        )
        last = ", ".join(f"{number:.3g}" for number in asked[: len(first.drive.inputs)])
        yield (
            f"{shares[cut[0]]:.0%} of the commands of {first.name}{rest} were cut by the drive's "
            f"bounds, {bounds}: the last was ({last})"
        )


def _of_time(world: World) -> Iterator[str]:
    """Yield a remark on laws that take much longer than the time that they have."""
    step, mean = world.sampling_time, world.simulation.seconds["laws"] / (world.iteration + 1)
    if mean > LATE * step:
        yield (
            f"the laws took {mean:.2g} s at each control step, {mean / step:.0f} times its "
            f"{step:g} s: a real robot would get its commands too late"
        )


def _of_props(world: World) -> Iterator[str]:
    """Yield remarks on props that robots pushed or pulled, and that something held."""
    record, scenario = world.record, world.scenario
    a, b = record.contacts["a"], record.contacts["b"]
    for index, prop in enumerate(scenario.props, len(scenario.robots)):
        way = np.ptp(record.prop_pose[:, :2, index - len(scenario.robots)], axis=0).max()
        touching = np.unique(np.concatenate([a[b == index], b[a == index]]))
        near = [scenario.body_name(int(body)) for body in touching]
        pushes = {robot.name: f" with {robot.push:.3g} N" for robot in scenario.robots}
        ends = [{joint.a, joint.b} for joint in scenario.joints]
        joined = set(near).union(*(each for each in ends if prop.name in each))
        pushing = [robot for robot in scenario.robots if robot.name in joined]
        held = prop.resting_friction * prop.inertia.mass * GRAVITY
        push = sum(robot.push for robot in pushing)
        moved = "did not move" if way < STILL else f"moved {1000 * way:.0f} mm only"
        if not pushing or way >= SHIFTED:
            continue
        if push < held:
            who = str(pushing[0].name) if len(pushing) == 1 else f"{len(pushing)} robots"
            yield (
                f"{prop.name} {moved}: the floor holds {held:.3g} N, and the drives of {who} "
                f"push {push:.3g} N; lower its ground_friction or mass, or raise their max_force"
            )
        elif len(near) > 1:
            *names, last = (f"{name}{pushes.get(name, '')}" for name in near)
            yield f"{prop.name} {moved}: it is between {', '.join(names)} and {last}"


def _of_end(world: World) -> Iterator[str]:
    """Yield a remark on a robot with sensors of distance that has left the workspace."""
    area, (x, y, _) = world.workspace, world.pose
    if area is None or world.scenario.on_exit != "stop":
        return
    for i in np.flatnonzero(outside_polygon(x, y, np.array(area))):
        robot = world.scenario.robots[int(i)]
        kinds = {sensor.key: {q.kind for q in sensor.quantities} for sensor in robot.sensors}
        ranging = [key for key, known in kinds.items() if known & {"distance", "flag"}]
        if ranging:
            yield (
                f"{robot.name} left the workspace, whose edge its {ranging[0]} does not see: "
                "Scenario(on_exit='wall') makes it a wall"
            )


def _meant(value: float) -> str:
    turns = abs(value) / (2 * pi)
    return f", {turns:.3g} turns; if degrees are meant, write np.radians({value:g})"


def _of_laws(laws: Iterable[Callable[..., Any]], robots: Sequence[Robot]) -> Iterator[str]:
    """Yield remarks on the code of laws, and of the functions that they name.

    They are on calls that would wait, and on sensors' flags that are compared with numbers.
    """
    flags = {
        sensor.key
        for robot in robots
        for sensor in robot.sensors
        if all(quantity.kind == "flag" for quantity in sensor.quantities)
    }
    functions: dict[Any, None] = {}
    for law in filter(None, map(written, laws)):
        named = (law.__globals__.get(name) for name in law.__code__.co_names)
        functions |= dict.fromkeys([law, *(f for f in named if isinstance(f, FunctionType))])
    for function in functions:
        kept: dict[str, str] = {}  # what is read, by the variable that keeps it
        for place, node in _nodes(function):
            sides: list[ast.expr] = []
            if isinstance(node, ast.Call) and (called := ast.unparse(node.func)) in WAITING:
                yield f"{place}: {called}(): {WAITING[called]}"
            elif isinstance(node, ast.Assign):
                kept[ast.unparse(node.targets[0])] = ast.unparse(node.value)
            elif isinstance(node, ast.Compare) and isinstance(node.ops[0], ORDERED):
                sides = [node.left, *node.comparators]
            for side in map(ast.unparse, sides):
                read = SENSED.fullmatch(kept.get(side, side))
                if read and read[1] in flags:
                    yield (
                        f"{place}: robot.sense.{read[1]} is True or False, "
                        "and is compared with a number; RangeFinder measures distances"
                    )


def _of_rows(law: FunctionType | None, robots: int) -> Iterator[str]:
    """Yield a remark on a law of as many robots as inputs that fills a row for each of them."""
    filled: dict[str, str] = {}  # where lists and arrays get their rows, by their names
    for place, node in _nodes(law):
        into, row = "", None
        if isinstance(node, ast.Call) and ast.unparse(node.func).endswith(".append"):
            into, row = ast.unparse(node.func).removesuffix(".append"), node.args[0]
        elif isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Subscript):
            into = ast.unparse(node.targets[0].value)
            row = node.value if isinstance(node.targets[0].slice, ast.Name) else None
        elif isinstance(node, (ast.Return, ast.Yield)) and node.value is not None:
            returned = RETURNED.fullmatch(ast.unparse(node.value))
            if returned and returned[1] in filled:
                yield (
                    f"{filled[returned[1]]}: this is a row for each robot, and a command has a "
                    f"column for each: with {robots} robots nothing else shows it; write "
                    f"np.transpose({returned[1]}) where it is returned"
                )
        if isinstance(row, (ast.Tuple, ast.List)) and len(row.elts) == robots:
            filled[into] = place


def _nodes(function: Any) -> Iterator[tuple[str, ast.AST]]:
    """Yield the file and line, and the node, of all in a function whose source is known."""
    file = (definition(function) or "").partition(",")[0]
    try:
        lines, first = inspect.getsourcelines(inspect.unwrap(function))
        tree = ast.parse(textwrap.dedent("".join(lines)))
    except (OSError, TypeError, SyntaxError):
        return
    nodes = sorted(ast.walk(tree), key=lambda node: getattr(node, "lineno", 0))
    for node in nodes if file else ():
        yield f"{file}, line {first + getattr(node, 'lineno', 1) - 1}", node
