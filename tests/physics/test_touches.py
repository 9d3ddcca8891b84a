"""Contacts as they are added up: what the solver tells of a substep, and rows of a control step."""

from __future__ import annotations

from math import cos, pi, radians, sin

import numpy as np
import pytest

from mars2d import Robot, Scenario, Unicycle, World
from mars2d.addons import Map
from mars2d.bodies.props import Box, Puck
from mars2d.physics.islands.contacts import (
    Row,
    close_touches,
    note_row,
    take_touches,
)
from mars2d.physics.motion import contacts_of
from tests.cases import each_case
from tests.islands import DISC, body_of, piece_of


def log_of(*numbers: int) -> list:
    """Bodies that have touched nothing yet, by number."""
    return [body_of(piece_of(DISC, 0.1), number=number) for number in numbers]


def note(body, *rows: dict, b: int = -2, time: float = 0.1, h: float = 0.1) -> None:
    """Let a body touch another during a substep; each row a dict of what differs from these."""
    usual = {"normal": (1.0, 0.0), "impulse": (0.0, 0.0), "point": (0.1, 0.2), "velocity": (0, 0)}
    for given in rows:
        told, row = usual | given, Row()
        (row.normal_x, row.normal_y), (row.x, row.y) = told["normal"], told["point"]
        (row.impulse_x, row.impulse_y), (row.vx, row.vy) = told["impulse"], told["velocity"]
        note_row(body, b, row)
    close_touches(body, time, h)


def take(bodies: list) -> np.ndarray:
    """The contacts since the last call, (dtype CONTACT)."""
    return contacts_of(take_touches(bodies))


def test_began_and_ended_go_by_the_last_substep_of_a_step():
    bodies = log_of(0)

    def step(*substeps: bool) -> list[tuple[bool, bool]]:
        for k, touches in enumerate(substeps):
            note(bodies[0], *[{"impulse": (1.0, 0)}] * touches, time=0.1 * k)
        return [(bool(row["began"]), bool(row["ended"])) for row in take(bodies)]

    assert step(False, True) == [(True, False)]
    assert step(True, True) == [(False, False)]
    assert step(True, False) == [(False, True)]
    assert step(True, False) == [(True, True)]
    assert step(True, True) == [(True, False)]
    assert step(False) == [(False, True)]  # it touched at the start
    assert step(False) == []
    assert step(True) == [(True, False)]


# -- normals ---------------------------------------------------------------------------------------


def at(angle: float, push: float, rub: float = 0.0, **more) -> dict:
    """A contact whose normal has an angle, degrees, with its impulses along and across, N s."""
    c, s = cos(radians(angle)), sin(radians(angle))
    return {"normal": (c, s), "impulse": (push * c - rub * s, push * s + rub * c)} | more


def test_two_walls_of_one_outline_are_two_rows_and_each_goes_on_by_itself():
    bodies = log_of(0)
    note(bodies[0], at(90, 2.0), at(0, 1.0), time=0.1)
    note(bodies[0], at(0, 4.0), time=0.2)
    first, second = take(bodies)
    assert (first["normal"].tolist(), second["normal"].tolist()) == (
        pytest.approx([0, 1]), [1, 0],
    )  # fmt: skip
    assert (first["normal_impulse"], second["normal_impulse"]) == pytest.approx((2.0, 5.0))
    assert (first["ended"], second["ended"]) == (True, False)
    note(bodies[0], at(0, 1.0), time=0.3)
    note(bodies[0], at(90, 2.0), time=0.4)
    assert [(round(r["normal"][0]), r["began"], r["ended"]) for r in take(bodies)] == [
        (1, False, True), (0, True, False),
    ]  # fmt: skip


def test_a_normal_that_turns_on_is_one_row_up_to_45_degrees_and_one_that_leaps_is_another():
    bodies = log_of(0)
    for k in range(10):
        note(bodies[0], at(9.0 * k, 1.0), time=0.1 * k)
    rows = take(bodies)
    assert [row["time"] for row in rows] == pytest.approx([0.0, 0.6])
    assert rows["began"].all()
    assert rows["ended"].tolist() == [True, False]
    assert rows["normal"][:, 1] == pytest.approx(np.sin(np.radians([22.5, 67.5])))
    note(bodies[0], at(81 + 16, 1.0), time=1.0)
    assert take(bodies)["began"].tolist() == [False, True]


def test_a_touch_that_another_normal_takes_over_lasts_until_then():
    """Even where that is at the beginning of a control step."""
    bodies = log_of(0)
    note(bodies[0], at(0, 1.0), time=0.1)
    take(bodies)
    note(bodies[0], at(50, 1.0), time=0.2, h=0.1)
    before, after = take(bodies)
    assert (before["time"], before["duration"], before["impulse"]) == pytest.approx((0.1, 0.1, 0))
    assert (before["began"], before["ended"]) == (False, True)
    assert before["normal"].tolist() == [1, 0]
    assert (after["time"], after["began"], after["ended"]) == (0.2, True, False)


def test_the_normal_is_the_mean_of_those_that_push_weighted_by_how_hard():
    bodies = log_of(0)
    note(bodies[0], at(7, 0.0), time=0.1)
    [row] = take(bodies)
    assert row["normal"].tolist() == list(at(7, 0.0)["normal"])  # nothing pushes: it is the first
    note(bodies[0], at(0, 0.0), time=0.2)
    note(bodies[0], at(10, 3.0), at(10, 0.1), time=0.3)
    [row] = take(bodies)
    assert row["normal"].tolist() == list(at(10, 3.0)["normal"])  # to the bit
    note(bodies[0], at(10, 3.0, 0.5), at(20, 1.0, 0.1), time=0.4)
    [row] = take(bodies)
    mean = (3 * np.exp(1j * radians(10)) + np.exp(1j * radians(20))) / 4
    assert row["normal"] @ [mean.real, mean.imag] == pytest.approx(abs(mean), rel=1e-12)


def test_a_row_is_in_the_cone_of_friction_of_its_normal_and_adds_up_as_a_vector():
    """Where normals turn, the sum of impulses at the edges of their cones may leave the mean's."""
    rng = np.random.default_rng(1)
    wrong = []
    for _ in range(200):
        bodies, total, mu = log_of(0), np.zeros(2), rng.choice([0.0, 0.1, 0.6])
        for k in range(rng.integers(1, 6)):
            push = rng.exponential()
            one = at(8.0 * k, push, mu * push * rng.choice([-1, 1, rng.uniform(-1, 1)]))
            total += one["impulse"]
            note(bodies[0], one, time=0.1 * k)
        [row] = take(bodies)
        found, rounding = sums(np.array([row])), 1e-14 * (1 + row["impulse"])
        inside = abs(row["tangential_impulse"]) <= mu * row["normal_impulse"] + rounding
        if not (
            inside
            and abs(row["normal"] @ row["normal"] - 1) < 1e-14
            and 0 <= row["normal_impulse"] <= row["impulse"]
            and abs(found[0] - total).max() <= rounding
        ):
            wrong.append((mu, row))
    assert wrong == []


# -- in worlds -------------------------------------------------------------------------------------


def sums(rows: np.ndarray) -> np.ndarray:
    """The impulses of rows (c, 2), N s, on their second bodies."""
    normal = rows["normal"]
    tangent = np.column_stack([-normal[:, 1], normal[:, 0]])
    return rows["normal_impulse"][:, None] * normal + rows["tangential_impulse"][:, None] * tangent


def momenta(world: World) -> np.ndarray:
    """The momenta of props (p, 2), N s."""
    masses = [prop.inertia.mass for prop in world.scenario.props]
    return np.array(masses)[:, None] * world.prop_velocity[:2].T


def faults_of(world: World, command: object, friction: float, seconds: float) -> list[str]:
    """What is wrong with rows in the control steps of some seconds; props feel contacts alone."""
    faults, n = [], len(world.scenario.robots)
    for _ in range(round(seconds / world.scenario.sampling_time)):
        before = momenta(world)
        world.step(command)
        rows, given = world.contacts, np.zeros((n + len(before), 2))
        impulse, solid = sums(rows), rows["b"] >= 0
        np.add.at(given, rows["a"], -impulse)
        np.add.at(given, rows["b"][solid], impulse[solid])
        off = np.abs(momenta(world) - before - given[n:]).max()
        beyond = np.abs(rows["tangential_impulse"]) - friction * rows["normal_impulse"]
        keys = list(zip(rows["time"], rows["a"], rows["b"], strict=True))
        faults += [f"{world.time}: momentum off by {off}"] * bool(off > 1e-11)
        faults += [f"{world.time}: out of the cone: {beyond}"] * bool((beyond > 1e-12).any())
        faults += ["part above whole"] * bool((rows["normal_impulse"] > rows["impulse"]).any())
        faults += [f"out of order: {keys}"] * (keys != sorted(keys))
    return faults


STAR = [
    (0.8 * s * cos(a), 0.8 * s * sin(a))
    for a, s in zip(np.linspace(0, 2 * pi, 10, endpoint=False), [1.0, 0.4] * 5, strict=True)
]
SLACK = Unicycle(max_force=1e-6)
"""A drive that gives no momentum."""


def gliding(kind: type, x: float, y: float, velocity: tuple, friction: float, **fields):
    """A prop of 1 kg that glides on without friction of the floor."""
    return kind(
        pose=(x, y, 0.3), velocity=velocity, mass=1.0, ground_friction=0.0, friction=friction,
        **fields,
    )  # fmt: skip


def room(robots: list, props: list, time: float, size: float = 2.0, **fields) -> World:
    """A world in four walls, which are one outline."""
    walls = [(-size, -size), (size, -size), (size, size), (-size, size)]
    fields |= {"sampling_time": time, "workspace": walls, "on_exit": "wall", "stop_time": 1e5}
    return World(Scenario(robots=robots, props=props, **fields))


def scenes(friction: float) -> list[tuple]:
    """Robots, props, an obstacle and a command, with corners, turns and hasty bodies."""
    still = Robot(pose=(1.7, 1.7, 0), diameter=0.1, friction=friction, drive=SLACK)
    strong = {"friction": friction, "drive": Unicycle(max_force=9.0)}
    pair = [Robot(pose=(-0.6, 0.05, 0), **strong), Robot(pose=(0.6, -0.05, pi), **strong)]
    spinning = [
        gliding(Box, x, y, (-2 * x, -1.5 * y, 9), friction, width=0.3, length=0.5)
        for x, y in ((1.4, 0.2), (-1.4, 0.3), (0.2, 1.4), (-0.3, -1.4))
    ]
    bouncing = gliding(Puck, 0.3, 0.1, (9, 4, 5), friction, diameter=0.2, restitution=0.9)
    pushed = [
        gliding(Box, 0.7, 0.65, (0, 0, 0), friction),
        gliding(Puck, 1.3, 1.4, (0, 0, 0), friction, diameter=0.4),
    ]
    rolled = gliding(Puck, -0.15, -0.1, (0, 0, 0), friction, diameter=0.4)
    edge, forward = [(0.1, 0), (0.1, -1), (1, -1), (1, 0)], [[0.3, 0.3], [0.2, 0.2]]
    return [
        ([still], [bouncing], None, [[0], [0]]),
        ([still], spinning, STAR, [[0], [0]]),
        ([Robot(pose=(0, 0, pi / 4), **strong)], pushed, None, [[0.4], [0.05]]),
        (pair, [gliding(Puck, 0, 0, (0, 0, 0), friction)], None, forward),  # it is turned
        (pair, [gliding(Box, 0, 0, (0, 0, 0), friction)], None, forward),
        ([Robot(pose=(-0.45, -0.45, 0.9), **strong)], [rolled], edge, [[0.3], [-0.1]]),
    ]


@each_case("time", [0.5, 0.1, 0.005])
@each_case("friction", [0.0, 0.6])
def test_rows_add_up_to_the_momentum_that_contacts_give_in_each_control_step(time, friction):
    """In corners, on turns, in crowds, and where two meet several times in a control step."""
    faults = []
    for robots, props, outline, command in scenes(friction):
        addons = [] if outline is None else [Map([outline], friction=friction)]
        world = room(robots, props, time, addons=addons)
        faults += faults_of(world, command, friction, 4 if time > 0.01 else 1)
    assert faults == []


def test_who_meets_two_walls_of_one_outline_in_a_control_step_has_two_rows_and_collisions():
    puck = gliding(Puck, 0.0, 0.0, (1.5, 0, 0), 0.0, diameter=0.2, restitution=1.0)
    world = room([Robot(pose=(0, 0.8, 0), diameter=0.1)], [puck], 2.0, 1.0)
    world.step([[0], [0]])
    first, second = world.contacts
    assert first["normal"] == pytest.approx([1, 0])
    assert second["normal"] == pytest.approx([-1, 0])
    assert (first["speed"], second["speed"]) == pytest.approx((1.5, 1.5))
    assert (first["normal_impulse"], second["normal_impulse"]) == pytest.approx((3.0, 3.0))
    assert world.contacts["ended"].all()
    world.step([[0], [0]])
    assert world.record.collisions == 3


def test_who_meets_one_wall_twice_in_a_control_step_has_one_row():
    """Thrown back to it by a heavier one, of which it has one row, too."""
    fields = {"diameter": 0.2, "restitution": 1.0}
    light = gliding(Puck, 0.85, 0.0, (1.0, 0, 0), 0.0, **fields)
    heavy = Puck(pose=(0.6, 0, 0), velocity=(0.2, 0, 0), mass=4.0, ground_friction=0.0, **fields)
    world = room([Robot(pose=(0, 0.8, 0), diameter=0.1)], [light, heavy], 1.0, 1.0)
    world.step([[0], [0]])
    of_wall = world.contacts[world.contacts["b"] < 0]
    assert [(row["a"], row["b"]) for row in of_wall] == [(1, -1)]
    assert of_wall["normal_impulse"] > 2.0 + 2e-3  # more than the first blow gave
    assert len(world.contacts) == 2
