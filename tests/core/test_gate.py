"""Nothing that ends the process, hangs it or lies gets through to the engine.

Each test runs its inputs in a child process without Python's own asserts: an abort would take the
tests with it. All inputs go through the public constructors.
"""

from __future__ import annotations

import itertools
import json

PRELUDE = """
import json, sys, warnings
import numpy as np
warnings.simplefilter("error")
from mars2d import *
from mars2d.addons import Addon, Map
from mars2d.bodies import *
from mars2d.bodies.joints import *
from mars2d.bodies.props import *
from mars2d.sensors import Proximity, Sensor
from mars2d.geometry.shapes import *
nan, inf, huge = float("nan"), float("inf"), 10**400

def go(*robots, law=None, commands=None, steps=5, **fields):
    '''Run an experiment in which everything meets everything.'''
    fields = {"workspace": [(-2, -2), (2, -2), (2, 2), (-2, 2)], "on_exit": "wall",
              "sampling_time": 0.5, "stop_time": 100} | fields
    fields.setdefault("robots", list(robots) or 1)
    world = World(Scenario(**fields), control=law)
    for _ in range(steps):
        world.step(commands)
    assert np.isfinite(world.pose).all(), "not finite"
    assert np.isfinite(world.prop_pose).all(), "not finite"
    return world

def push(*props, **fields):
    '''A robot and props round it.'''
    return go(Robot(), props=props, **fields)

def tie(joint, **fields):
    '''Two robots and two boxes, and something between them.'''
    robots = [Robot(), Robot(pose=(1, 0, 0))]
    props = [Box(pose=(0, 1, 0)), Box(pose=(1, 1, 0), name="load")]
    return go(*robots, props=props, joints=[joint], **fields)

SQUARE = [(-0.1, -0.1), (0.1, -0.1), (0.1, 0.1), (-0.1, 0.1)]
BOW = [(0, 0), (1, 1), (1, 0), (0, 1)]
FAR = (1, 1, 0)

def attempt(code):
    try:
        eval(code)
    except InputError as error:
        assert str(error)
        return "InputError"
    except BaseException as error:
        return f"{type(error).__name__}: {error}"
    return "passed"
"""


def outcomes(child, cases: list[str], *flags: str) -> dict:
    """Return what became of each case; ends with the case at which the process died, if it did."""
    code = PRELUDE + f"\nfor case in {cases!r}:\n"
    result = child(code + "    print(json.dumps([case, attempt(case)]), flush=True)", *flags)
    found = dict(json.loads(line) for line in result.stdout.splitlines())
    assert result.returncode == 0, (result.returncode, [*found][-1:], result.stderr[-500:])
    return found


BAD = ["nan", "inf", "-1.0", "'1'", "None", "True", "[1.0]"]


def fields(pattern: str, *more: str, without: tuple[str, ...] = ()) -> list[str]:
    """Write the bad values, and some more, into a pattern of code."""
    return [pattern.replace("@", value) for value in [*BAD, *more] if value not in without]


ROWS = {
    "sizes, forces and times that do not go together": [
        "go(Robot(center_offset=0.16))",
        "go(Robot(center_offset=-0.16))",
        "go(Robot(mass=1e-6, drive=Unicycle(max_force=1e6)))",
        "go(sampling_time=1e-6, stop_time=1e12)",
        "go(sampling_time=1e-6, command_delay=1e6)",
        "go(Robot(drive=Unicycle(dead_time=1e300)))",
    ],
    "positions and angles": [
        *fields("go(Robot(pose=(@, 0, 0)))", "1e7", without=("-1.0",)),
        *fields("go(Robot(pose=(0, 0, @)))", "1e300", without=("-1.0",)),
        "go(Robot(pose=None))",
    ],
    "geometry": [
        *fields("go(addons=[Map([[(1, 1), (@, 0)]])])", "1e7", without=("-1.0",)),
        *fields("go(workspace=[(0, 0), (1, @), (0, 1)])", without=()),
        "go(addons=[Map([[(1, 1), (1, 1)]])])",  # a wall of no length
        "go(addons=[Map([[(1, 1), (1.5, 1), (2, 1)]])])",  # collinear
        "go(addons=[Map([[(1, 1), (1.5, 1), (1.5, 1), (1, 2)]])])",  # repeated
        "go(addons=[Map([[(1, 1), (2, 2), (2, 1), (1, 2)]])])",  # crossing itself
        "go(addons=[Map(None)])",
        "go(addons=Map([[(1, 1), (1, 0)]]))",
        "go(workspace=[(0, 0), (1, 1)])",
        "go(workspace=[(-2, -2), (2, 2), (2, -2), (-2, 2)])",
    ],
    "shapes": [
        *fields("Disc(0.2, center=(@, 0))", "1e7", without=("-1.0",)),
        *fields("Polygon([(0, 0), (1, 0), (@, 1)])", "1e7", without=("-1.0",)),
        *fields("Polygon(@)", "[]", "BOW", "SQUARE[:2]", "[(0, 0)] * 5",
                "[(0, 0), (1, 0), (2, 0)]", "[(0, 0), (1, 0), (1, 1e-5)]",
                "[(0, 0), (1, 0), (0.5, 1e-300)]", "[(0, 0), (2, 0), (2, 2), (1, 0), (0, 2)]",
                "[(np.cos(t), np.sin(t)) for t in np.linspace(0, 6, 65)]",
                "SQUARE + SQUARE[:1] * 2", "[(0, 0), (1, 0), (1, 0), (0, 1)]"),
        *fields("Compound(@)", "[]", "Disc(0.2)", "[Disc]", "[Disc(0.1)] * 65"),
        *fields("go(Robot(shape=@))", "Disc", "SQUARE", "Shape()", without=("None",)),
        "go(Robot(shape=Compound([Disc(1e-3), Disc(1e-3).moved(1e6, 0)])), workspace=None)",
        "go(Robot(shape=Polygon(SQUARE).moved(1, 1)), Robot(pose=FAR, mass=11))",
        "Polygon(SQUARE).moved(1e7, 0)", "Disc(1).moved(nan, 0)",
    ],
    "moments": [
        *(f"go(Robot(moment={moment}))" for moment in ("1e-300", "1", "1e-6")),
        *(f"push(Box(pose=FAR, moment={moment}))" for moment in ("1e-300", "1", "1e-6")),
    ],
    "props": [
        *(f"push(Box(pose=FAR, mass={mass}))" for mass in ("1e-7", "1e7", "0.05", "11")),
        *fields("push(Box(pose=FAR, velocity=@))", "(nan, 0)", "(0, inf, 0)", "(0, 0, nan)", "(1,)",
                "(1, 2, 3, 4)", "('1', 0)", "(101, 0)", "(0, 0, 1e3)", "(99, 0, 9)", "()"),
        "push(Bar(pose=(0, 0, 0), length=1e3, velocity=(0, 0, 100)), workspace=None)",
        "push(Puck(pose=FAR, velocity=(20, 0)), max_overlap=1e-5)",
        *fields("push(Box(pose=@))", "(0, 0)", "(nan, 0)", "(0, 0, inf)", "(9, 9)"),
        *fields("push(Gate(pose=FAR, limits=@))", "(1, 2)", "(-2, -1)", "(1, -1)", "(nan, 1)",
                "(0, inf)", "(-1,)", "(-1e6, 1)", without=("None",)),
        "push(Gate(pose=FAR, stiffness=1e6))",
        *fields("push(Solid(@, pose=FAR))", "SQUARE", "Polygon(BOW)", "Polygon", "Box()",
                "Shape()"),
        "go(Robot(), physics='contacts', props=[Box(pose=FAR)])",
    ],
    "joints": [
        *fields("tie(Rope(a='robot0', b='box0', length=@))", "0", "1e-300", "0.5", "1e9",
                without=("None",)),
        *fields("tie(Rod(a='robot0', b='box0', length=@))", "0", "0.5", "1.5", without=("None",)),
        *fields("tie(Spring(a='robot0', b='box0', rest_length=@))", "1e7", "1e5",
                without=("None",)),
        *fields("tie(Spring(a='robot0', b='box0', stiffness=@))", "0", "1e7", "1e6"),
        *fields("tie(Hinge(a='robot0', stiffness=@))", "1e7", "1e5"),
        *fields("tie(Hinge(a='robot0', limits=@))", "(1, 2)", "(nan, 1)", "(0, 0, 0)", "(1e9, 2)",
                without=("None",)),
        *fields("tie(Rope(a=@, b='box0'))", "'nobody'", "'box0'", "'world'", "''", "0"),
        *fields("tie(Rope(a='robot0', b=@))", "'nobody'", "'robot0'", "''", "1",
                without=("None",)),
        *fields("tie(Rope(a='robot0', b='box0', anchor_a=(0, @)))", "1e7", "100",
                without=("-1.0",)),
        *fields("tie(Rope(a='robot0', b='box0', anchor_b=@))", "(1,)", "(1, 2, 3)", "(1e5, 0)"),
        "tie(Rope(a='robot0', anchor_b=(0, 0)))",  # both ends at one point
        "tie(Rod(a='robot0', b='robot1', anchor_a=(1, 0)))",
        "tie(Hinge(a='robot0', b='box0'))", "tie(Hinge(a='robot0', anchor_b=(0.1, 0)))",
        # what light bodies would need no end of substeps for
        ("go(Robot(mass=1e-6, drive=Unicycle(max_force=0.01)), joints=[Spring(a='robot0',"
        " anchor_b=(1, 0), stiffness=1e6)])"),
        ("go(Robot(mass=1e-6, drive=Unicycle(max_force=0.01)), joints=[Spring(a='robot0',"
        " anchor_a=(0.1, 0), anchor_b=(1, 0), stiffness=2)])"),
    ],
    "what would need no end of substeps": [
        "go(Robot(drive=Unicycle(max_force=1e5)), max_overlap=1e-5)",
        "go(Robot(shape=Polygon(SQUARE), drive=Unicycle(max_linear_speed=1e3)))",
        ("tie(Rod(a='robot0', anchor_a=(1, 0), anchor_b=(1.5, 0)), robots=[Robot(drive=Unicycle("
        "max_linear_speed=50)), Robot(pose=(-1, 0, 0))])"),
        "go(Robot(center_offset=0.1, drive=Unicycle(max_linear_speed=1e3, wheel_semiaxis=1e-3)))",
    ],
}  # fmt: skip
"""The rows of the table of what aborts, lies or hangs, with inputs that would do it."""


def test_what_would_abort_lie_or_hang_is_an_input_error(child):
    cases = [*itertools.chain(*ROWS.values())]
    passed = {k: v for k, v in outcomes(child, cases, "-O").items() if v != "InputError"}
    assert passed == {}
