"""Any scenario is refused in words, or runs: finite, inside its walls, its overlaps in bounds.

Hypothesis puts whole scenarios together from all that the public constructors take, as plain data,
as files hold it.
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt
from typing import Any

import numpy as np
import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st

from mars2d import InputError, World
from mars2d.scenario.serialize import to_scenario
from tests.physics.test_crowd_fuzz import watched

TICKS = 100

Data = dict[str, Any]

# -- numbers ----------------------------------------------------------------------------------


def scaled(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers of all orders of magnitude from `low` to `high`."""
    return st.floats(np.log10(low), np.log10(high)).map(lambda power: float(f"{10**power:.6g}"))


angles = st.floats(-pi, pi).map(lambda angle: round(angle, 6))
shares = st.sampled_from([0.0, 0.1, 0.5, 1.0])


def some(draw: st.DrawFn, **fields: st.SearchStrategy[Any]) -> Data:
    """Draw some of these fields, each in one of three parts."""
    return {name: draw(field) for name, field in fields.items() if draw(st.integers(0, 2)) == 2}


# -- parts ------------------------------------------------------------------------------------


@st.composite
def shapes(draw: st.DrawFn, size: float) -> Data:
    """A shape about as large as `size` [m]: round, convex, concave or of several parts."""
    kind = draw(st.sampled_from(["Disc", "rectangle", "star", "ell", "Compound"]))
    if kind == "Disc":
        return {"type": "Disc", "diameter": size * draw(scaled(0.3, 1))}
    if kind == "Compound":
        x = size * draw(st.floats(0.1, 0.3))
        ends = [(-x, 0.0), (x, 0.0)]
        parts = [{"type": "Disc", "diameter": 0.4 * size, "center": list(c)} for c in ends]
        return {"type": "Compound", "parts": parts}
    if kind == "star":
        corners = draw(st.integers(3, 8))
        far = [size / 2 * draw(st.floats(0.4, 1)) for _ in range(corners)]
        turns = [2 * pi * k / corners for k in range(corners)]
        outline = [[r * cos(a), r * sin(a)] for r, a in zip(far, turns, strict=True)]
    else:
        x, y = size / 2 * draw(scaled(0.2, 1)), size / 2 * draw(scaled(0.05, 1))
        outline = [[-x, -y], [x, -y], [x, y], [-x, y]]
        if kind == "ell":
            outline[2:3] = [[x, 0.0], [0.0, 0.0], [0.0, y]]
    return {"type": "Polygon", "outline": outline}


@st.composite
def drives(draw: st.DrawFn, size: float, speed: float, mass: float) -> Data:
    """A drive of any kind."""
    kind = draw(st.sampled_from(["Unicycle", "Holonomic", "Differential", "Car"]))
    strong = draw(scaled(0.1, 100)) * speed**2 / size * mass
    drive = {"type": kind, "max_linear_speed": speed * draw(scaled(0.1, 1))}
    drive |= {"max_force": strong, "max_torque": strong * size * draw(scaled(0.01, 1))}
    if kind in ("Unicycle", "Differential"):
        drive["wheel_semiaxis"] = size * draw(scaled(0.2, 1))
    if kind == "Differential":
        drive |= some(draw, command=st.sampled_from(["wheels", "twist"]))
        drive["wheel_radius"] = size * 0.2
    if kind == "Car":
        drive |= {"wheelbase": size * draw(scaled(0.5, 2))}
        drive |= some(draw, max_steering=scaled(0.1, 1.2), max_steering_rate=scaled(0.1, 10))
    if kind != "Holonomic":
        drive |= some(draw, max_angular_speed=scaled(0.1, 10))
    drive |= some(draw, max_acceleration=scaled(0.01, 100), noise=shares)
    return drive


@st.composite
def joints(draw: st.DrawFn, bodies: list[Data], size: float) -> Data:
    """A joint between two of the bodies, or one of them and the world, as they stand."""
    a = draw(st.sampled_from(bodies))
    b = draw(st.sampled_from([*bodies, None]))
    kind = draw(st.sampled_from(["Rope", "Rod", "Spring", "Hinge"]))
    joint: Data = {"type": kind, "a": a["name"]}
    x, y = a["pose"][:2]
    if b is not None:
        joint["b"] = b["name"]
        if kind == "Hinge":  # at the middle of b
            turned = a["pose"][2]
            dx, dy = b["pose"][0] - x, b["pose"][1] - y
            joint["anchor_a"] = [
                cos(turned) * dx + sin(turned) * dy, cos(turned) * dy - sin(turned) * dx,
            ]  # fmt: skip
    else:
        off = 0.0 if kind == "Hinge" else size
        joint["anchor_b"] = [x + off, y]
    if kind == "Spring":
        joint |= {"stiffness": draw(scaled(0.01, 100)), "damping": draw(scaled(0.001, 10))}
    if kind == "Hinge":
        joint |= some(draw, limits=st.just([-1.0, 1.0]), damping=scaled(0.001, 1))
    return joint


def walls(draw: st.DrawFn, cells: list[tuple[float, float]], side: float) -> list[Any]:
    """Obstacles of any thickness: walls between cells, and solid things in some of them."""
    outlines = []
    for x, y in draw(st.lists(st.sampled_from(cells), max_size=3, unique=True)):
        thick = draw(st.sampled_from([0.0, 0.0, 1e-3, 0.02, 0.1])) * side
        reach = side * draw(st.floats(0.2, 1))
        left = x - 0.49 * side
        outline = [[left, y - reach / 2], [left, y + reach / 2]]
        if thick:
            outline += [[left - thick / 10, y + reach / 2], [left - thick / 10, y - reach / 2]]
        outlines.append(outline)
    return outlines


ROOMS = {"square": 4, "ell": 3, "none": 0}
"""Outlines of workspaces; an L is a square without a quarter."""


@st.composite
def scenarios(draw: st.DrawFn) -> Data:
    """A whole scenario as plain data, sound or nearly so."""
    size = draw(st.one_of(st.just(0.3), scaled(0.01, 100)))  # of a body, metres
    speed = draw(st.one_of(st.just(0.5), scaled(0.01, 50))) * min(1.0, max(size, 0.1))
    mass = draw(st.one_of(st.just(1.0), scaled(1e-5, 1e5)))
    side = 1.6 * size  # of a cell for one body
    across = draw(st.integers(2, 4))
    half = across * side / 2
    cells = [
        (side * (i + 0.5) - half, side * (j + 0.5) - half)
        for i in range(across)
        for j in range(across)
    ]
    room = draw(st.sampled_from([*ROOMS]))
    if room == "ell":
        middle = -half + side * (across // 2)
        cells = [(x, y) for x, y in cells if x < middle or y < middle]
    order = draw(st.permutations(cells))
    count = draw(st.integers(1, min(5, len(cells))))
    ratio = draw(st.sampled_from([1.0, 3.0, 10.0]))
    sampling_time, overlap = draw(sampling_times(size, speed, ratio))
    bodies: list[Data] = []
    for k in range(count):
        x, y = order[k]
        turned = draw(angles)
        own = {"pose": [x, y, turned], "mass": mass * ratio ** draw(st.sampled_from([0.0, 0.5, 1]))}
        own |= some(draw, friction=st.sampled_from([0.0, 1.0, 1000.0]), restitution=shares)
        if k == 0 or draw(st.booleans()):
            body = {"type": "Robot", "name": f"r{k}", **own}
            body["drive"] = draw(drives(size, speed, own["mass"]))
            if draw(st.booleans()):
                body["shape"] = draw(shapes(size))
            else:
                body["diameter"] = size * draw(scaled(0.2, 1))
                body |= some(draw, center_offset=st.just(0.1 * body["diameter"]))
        else:
            kind = draw(st.sampled_from(["Ball", "Puck", "Box", "Bar", "Solid"]))
            body = {"type": kind, "name": f"p{k}", **own}
            if kind == "Solid":
                body["shape"] = draw(shapes(size))
            elif kind in ("Ball", "Puck"):
                body["diameter"] = size * draw(scaled(0.2, 1))
            else:
                body["length"] = size * 0.7
                body["width" if kind == "Box" else "thickness"] = 0.7 * size * draw(scaled(0.05, 1))
            body |= some(draw, ground_friction=st.sampled_from([0.0, 0.5, 100.0]))
            going = st.tuples(*[st.floats(-speed, speed)] * 2, st.floats(-1, 1))
            body |= some(draw, velocity=going.map(lambda v: [*v[:2], v[2] * speed / size]))
        bodies.append(body)
    robots = [body for body in bodies if body["type"] == "Robot"]
    found: Data = {
        "type": "Scenario",
        "robots": robots,
        "props": [body for body in bodies if body["type"] != "Robot"],
        "joints": draw(st.lists(joints(bodies, size), max_size=draw(st.sampled_from([0, 0, 2])))),
        "sampling_time": sampling_time, "max_overlap": overlap, "stop_time": 1e3 * sampling_time,
        "physics": draw(st.sampled_from(["contact", "contact", "contact", "stop", "ideal"])),
        "on_exit": draw(st.sampled_from(["wall", "wall", "stop", "ignore"])),
        "workspace": {
            "square": [[-half, -half], [half, -half], [half, half], [-half, half]],
            "ell": [
                [-half, -half], [half, -half], [half, -half + side * (across // 2)],
                [-half + side * (across // 2), -half + side * (across // 2)],
                [-half + side * (across // 2), half], [-half, half],
            ],
            "none": None,
        }[room],
        "addons": [{"type": "Map", "outlines": walls(draw, cells, side)}],
        **some(draw, command_delay=st.sampled_from([0.4, 3.0]).map(lambda k: k * sampling_time)),
    }  # fmt: skip
    return found


@st.composite
def sampling_times(draw: st.DrawFn, size: float, speed: float, ratio: float) -> tuple[float, float]:
    """A sampling time and an overlap that need no more than some dozens of substeps.

    Without end would be what goes metres at overlaps of 10 um, or stays in contact for hours: the
    number of substeps grows with the way in overlaps, and with the time in contact.
    """
    overlap = draw(st.one_of(st.just(1e-3), scaled(1e-5, 1.0)))
    entry = min(0.75 * overlap, size / 100)
    way = entry * draw(scaled(0.1, 20))
    most = sqrt(2.0 * overlap * size / 100 / ratio) / speed * 10
    time = float(f"{min(way / speed, most):.6g}")
    return max(time, 1e-6), overlap


# -- trying them ------------------------------------------------------------------------------


def check(data: Data, rng_seed: int) -> None:
    """Build and run a scenario, unless it is refused."""
    try:
        scenario, _ = to_scenario(data)
        world = World(scenario)
    except InputError:
        return
    rng = np.random.default_rng(rng_seed)
    hard = scenario.physics != "ideal"
    inside = hard and scenario.on_exit == "wall" and scenario.workspace is not None
    allowed = scenario.max_overlap
    with watched(world) as watcher:
        watch = watcher.watch
        for _ in range(TICKS):
            scale = float(10 ** rng.uniform(-2, 2)) if rng.uniform() < 0.9 else 1e12
            watcher.tick(rng.uniform(-scale, scale, (2, len(scenario.robots))))
            for name in ("pose", "velocity", "prop_pose", "prop_velocity", "effort"):
                assert np.isfinite(getattr(world, name)).all(), f"{name} is not finite"
            if hard:
                assert not watch.escaped, f"{watch.escaped}, at control step {world.iteration}"
                assert watch.deepest <= allowed, f"overlap: {watch}"
                assert watch.surplus <= 0, f"substeps: {watch.surplus}, {watch.substeps}"
            if inside:
                assert watch.outside <= 3 * allowed, f"outside: {watch}"
            if world.over:
                break
    assert world.record.digest


@pytest.mark.slow
@pytest.mark.nightly
@pytest.mark.parametrize("batch", range(20))
def test_thousands_of_scenarios_are_refused_or_run(batch):
    @seed(batch)
    @settings(max_examples=250, derandomize=False)
    @given(scenarios(), st.integers(0, 99))
    def each(data, rng_seed):
        check(data, rng_seed)

    each()
