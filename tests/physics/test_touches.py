"""Contacts as they are added up: what the solver tells of a substep, and rows of a control step."""

from __future__ import annotations

from array import array
from types import SimpleNamespace

import numpy as np
import pytest

from mars2d.physics.islands import island as islands
from mars2d.physics.islands.contacts import (
    Row,
    Touch,
    begin_touches_again,
    close_touches,
    keep_touches,
    note_row,
    part,
    take_touches,
)
from mars2d.physics.motion import WIDE
from mars2d.record.contact import CONTACT
from tests.islands import DISC, body_of, piece_of, place


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
    taken = take_touches(bodies)
    numbers = array("d", bytes(120 * len(taken)))
    for k, touch in enumerate(taken):
        touch.write(numbers, 15 * k)
        touch.begin()
    return np.frombuffer(numbers, dtype=WIDE).astype(CONTACT)


def test_the_substeps_of_a_pair_are_summed_as_vectors():
    bodies = log_of(0)
    note(bodies[0], {"impulse": (3.0, 0.0)}, time=0.1)
    note(bodies[0], {"impulse": (0.0, 4.0)}, time=0.2)
    [row] = take(bodies)
    assert row["time"] == 0.1
    assert row["duration"] == pytest.approx(0.1)  # from then to the end of the next substep
    assert (row["a"], row["b"]) == (0, -2)
    assert row["impulse"] == pytest.approx(5.0)
    assert row["normal_impulse"] == pytest.approx(3.0)
    assert row["tangential_impulse"] == pytest.approx(4.0)
    assert row["point"].tolist() == [0.1, 0.2]
    assert row["began"]
    assert not row["ended"]
    assert len(take(bodies)) == 0


def test_a_touch_lasts_from_the_substep_that_finds_it_and_nothing_in_between():
    bodies, touch = log_of(0), {"impulse": (1.0, 0.0)}
    note(bodies[0], touch, time=0.1, h=0.5)  # it came nearer during the 0.5 s
    note(bodies[0], touch, time=0.2, h=0.1)
    note(bodies[0], time=0.3, h=0.1)
    note(bodies[0], touch, time=0.4, h=0.1)
    note(bodies[0], touch, time=0.5, h=0.07)
    assert take(bodies)["duration"] == pytest.approx([0.17])
    note(bodies[0], touch, time=0.6, h=0.03)  # in the next control step it still touches
    assert take(bodies)["duration"] == pytest.approx([0.03])


def test_a_contact_at_two_points_lasts_as_long_as_one_at_one_point():
    bodies = log_of(0)
    for k in range(3):
        note(bodies[0], {"impulse": (1.0, 0)}, {"impulse": (2.0, 0)}, time=0.1 * k)
    [row] = take(bodies)
    assert row["duration"] == pytest.approx(0.2)
    assert row["normal_impulse"] == pytest.approx(9.0)


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
    assert step(False) == []
    assert step(True) == [(True, False)]


def test_speed_is_that_of_the_first_touch_and_0_in_the_steps_after():
    bodies = log_of(0)
    for time, speed in ((0.1, -0.5), (0.2, -0.3)):
        note(bodies[0], {"impulse": (1, 0), "velocity": (speed, 0.25)}, time=time)
    [row] = take(bodies)
    assert (row["speed"], row["slip"]) == (0.5, 0.25)
    note(bodies[0], {"impulse": (1, 0), "velocity": (-0.2, 0.125)}, time=0.3)
    [row] = take(bodies)
    assert (row["speed"], row["slip"]) == (0.0, 0.125)
    assert row["time"] == pytest.approx(0.2)  # what goes on began when the control step did


def test_the_first_contact_of_a_row_is_the_strongest_of_its_substep():
    rng = np.random.default_rng(0)
    listed = []
    for impulse, angle in ((0.25, 0.2), (7.0, 0.2), (0.75, 0.2)):
        normal = np.array([np.cos(angle), np.sin(angle)])
        listed.append({"impulse": impulse * normal, "normal": normal,
                       "point": rng.normal(size=2), "velocity": rng.normal(size=2)})  # fmt: skip
    results = []
    for order in ([0, 1, 2], [2, 1, 0], [1, 2, 0]):
        bodies = log_of(0)
        for time in (0.5, 0.6):
            note(bodies[0], *(listed[k] for k in order), b=-1, time=time)
        [row] = take(bodies)
        results.append((row["point"].tolist(), row["normal"].tolist(), row["speed"], row["slip"]))
    assert results[0] == results[1] == results[2]
    assert results[0][0] == listed[1]["point"].tolist()
    assert results[0][1] == listed[1]["normal"].tolist()


def test_rows_come_by_time_and_then_by_pair_and_what_has_parted_is_forgotten():
    bodies = log_of(0, 1, 2)
    touch = {"impulse": (1.0, 0)}
    note(bodies[2], touch, b=-1, time=0.1)
    note(bodies[0], touch, b=2, time=0.2)
    note(bodies[1], touch, b=2, time=0.1)
    assert [(r["time"], r["a"], r["b"]) for r in take(bodies)] == [
        (0.1, 1, 2), (0.1, 2, -1), (0.2, 0, 2),
    ]  # fmt: skip
    for body in bodies[:2]:
        part(body)
    take(bodies)
    assert [len(body.contacts) for body in bodies] == [0, 0, 1]


def test_what_begins_again_has_what_was_kept_alone():
    """As when a control step begins again: what was noted before it is all that counts."""
    body, other = log_of(0, 1)
    note(body, {"impulse": (1.0, 0), "point": (7, 7)}, time=0.1)
    keep_touches(body)
    note(body, {"impulse": (2.0, 3.0), "point": (8, 8)}, time=0.2)
    note(body, {"impulse": (4.0, 0)}, {"impulse": (5.0, 0)}, b=1, time=0.3)
    begin_touches_again(body)
    note(body, {"impulse": (8.0, 0), "point": (9, 9)}, time=0.15, h=0.05)
    [row] = take([body, other])
    assert (row["b"], row["normal_impulse"], row["tangential_impulse"]) == (-2, 9, 0)
    assert row["impulse"] == 9
    assert row["point"].tolist() == [7, 7]
    assert row["duration"] == pytest.approx(0.05)
    assert row["began"]


def test_what_had_touched_before_but_not_yet_since_begins_again_as_that():
    [body] = log_of(0)
    note(body, {"impulse": (1.0, 0)}, time=0.1)
    take([body])
    keep_touches(body)
    note(body, time=0.2)
    note(body, {"impulse": (2.0, 0), "point": (8, 8)}, time=0.3)
    begin_touches_again(body)
    note(body, {"impulse": (4.0, 0), "point": (9, 9)}, time=0.2, h=0.1)
    [row] = take([body])
    assert row["point"].tolist() == [9, 9]
    assert row["normal_impulse"] == 4
    assert (row["time"], row["duration"]) == (0.1, 0.1)
    assert not row["began"]
    assert not row["ended"]


def test_a_touch_keeps_its_numbers():
    assert (Touch(3, -2, Row()).a, Touch(3, -2, Row()).b) == (3, -2)


# -- what the solver tells of a contact -----------------------------------------------------------


@pytest.fixture
def told(monkeypatch):
    """An island of the bodies 0, 1 and 2, which takes what it is told for the solver's contacts."""
    ways = {
        "first_of": lambda one: one.bodies[0], "second_of": lambda one: one.bodies[1],
        "impulse_of": lambda one: one.impulse, "normal_of": lambda one: one.normal,
        "count_of": lambda one: len(one.on_first), "is_void": lambda one: False,
        "point_of": lambda one, k, second: (one.on_second if second else one.on_first)[k],
    }  # fmt: skip
    for name, way in ways.items():
        monkeypatch.setattr(islands, name, way)
    bodies = log_of(0, 1, 2)
    for k, body in enumerate(bodies):
        place(body, complex(k, 0))
    island = islands.Island(SimpleNamespace(iterations=1), None, bodies, [], [], None)
    island.bodies = bodies
    return island


def vector(pair) -> SimpleNamespace:
    return SimpleNamespace(x=float(pair[0]), y=float(pair[1]))


def contact(bodies, impulse, normal=(1.0, 0.0), first=((0.1, 0.2),), second=((0.3, 0.4),)):
    """A contact of the solver."""
    return SimpleNamespace(
        bodies=bodies, impulse=vector(impulse), normal=vector(normal),
        on_first=list(map(vector, first)), on_second=list(map(vector, second)),
    )  # fmt: skip


def let_touch(island, a: int, b: int) -> None:
    """Let the measured gaps say that a body touches another, or an obstacle."""
    body = island.numbers[a]
    body.first_touch = SimpleNamespace(other=b, is_wall=False, next_touch=body.first_touch)


@pytest.mark.parametrize("bodies", [(0, 1), (1, 0)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_impulse_is_that_on_b_whatever_the_solvers_sign_and_order(told, bodies, sign):
    let_touch(told, 0, 1)
    a, b = told.numbers[:2]
    (a.aim_x, a.aim_y), (b.aim_x, b.aim_y) = (0.1, 0.0), (-0.2, 0.2)
    turned = -1.0 if bodies == (1, 0) else 1.0
    told.note_one(contact(bodies, (sign * 2.0, sign * -1.0), (turned, 0.0)))
    told.close(0.1, 0.1)
    [found] = take(told.numbers)
    assert (found["a"], found["b"]) == (0, 1)
    assert found["normal"].tolist() == [1, 0]
    assert (found["normal_impulse"], found["tangential_impulse"]) == (2.0, -1.0)
    assert found["speed"] == pytest.approx(0.3)
    assert found["slip"] == pytest.approx(0.2)
    assert found["point"].tolist() == ([0.1, 0.2] if bodies == (0, 1) else [0.3, 0.4])  # on a


def test_pairs_that_neither_push_nor_touch_after_the_substep_are_left_out(told):
    let_touch(told, 1, 2)
    told.note_one(contact((2, 1), (0.0, 0.0)))
    told.note_one(contact((0, 1), (0.0, 0.0)))
    told.note_one(contact((-1, 2), (9.0, 0.0)))  # it has bounced
    told.close(0.1, 0.1)
    assert [(r["a"], r["b"], r["impulse"]) for r in take(told.numbers)] == [(1, 2, 0), (2, -1, 9)]


def test_an_obstacle_is_always_second_and_the_point_is_the_middle_of_two(told):
    let_touch(told, 2, -3)
    let_touch(told, 2, -1)
    points = {"first": ((9, 9), (9, 9)), "second": ((2.1, 0.0), (2.1, 0.4))}
    told.numbers[2].aim_x, told.numbers[2].aim_spin = 0.5, 2.0
    told.note_one(contact((-1, 2), (-4.0, 0.0), (-1.0, 0.0), **points))
    told.close(0.1, 0.1)
    [row] = take(told.numbers)
    assert (row["a"], row["b"]) == (2, -1)
    assert row["point"] == pytest.approx([2.1, 0.2])
    assert row["normal"].tolist() == [1, 0]
    assert row["normal_impulse"] == 4.0
    assert row["speed"] == pytest.approx(0.5 - 2.0 * 0.2)  # of its own point, which turns
    assert row["slip"] == pytest.approx(-2.0 * 0.1)
