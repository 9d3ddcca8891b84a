"""A record run again: where it departs, by how much, and what may be the reason."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

import mars2d
from mars2d import Robot, Scenario, World
from mars2d.bodies.props import Box
from mars2d.cli import command_line as cli
from mars2d.core.errors import InputError
from mars2d.record.rows import COLUMNS
from mars2d.world.verify import rerun
from tests.cases import each_case


def scenario(**changes):
    """Two robots that meet at about 1.9 s, one of which pushes a box before that."""
    fields = {
        "title": "Two meet",
        "robots": [Robot(name="red", pose=(-1, 0, 0)), Robot(name="blue", pose=(0.6, 0, pi))],
        "props": [Box(name="crate", pose=(-1, 1, 0))],
        "sampling_time": 0.1,
        "stop_time": 4.0,
    }
    return Scenario(**(fields | changes))


def meet(world):
    return np.array([[0.3, 0.3], [0.0, 0.1]])


@pytest.fixture(scope="module")
def record():
    return mars2d.run(scenario(), control=meet)


def altered(record, name, place, change):
    """Return a record with one number of a column changed."""
    values = np.array(getattr(record, name))
    values[place] = change(values[place])
    return replace(record, **{name: values})


def one_ulp(value):
    return np.nextafter(value, np.inf)


@each_case("physics", ["contact", "stop", "ideal"])
@each_case("on_exit", ["ignore", "stop"])
def test_a_run_is_the_same_again_with_each_physics(physics, on_exit):
    assert rerun(mars2d.run(scenario(physics=physics, on_exit=on_exit), control=meet)) is None


def test_one_ulp_of_a_robots_place_is_found_where_it_is(record):
    found = rerun(altered(record, "pose", (7, 0, 1), one_ulp))
    assert (found.row, found.what, found.bodies) == (7, "pose", ("blue",))
    assert found.time == record.time[7]
    told = str(found)
    assert told.startswith("row 7, at 0.7 s: the pose of blue is off by ")
    assert told.endswith(("e-17 m and 0 rad", "e-16 m and 0 rad"))


def test_the_body_that_is_off_most_is_named(record):
    off = altered(record, "pose", (3, 0), lambda x: x + np.array([1e-3, 2e-3]))
    assert str(rerun(off)).endswith("blue is off by 0.002 m and 0 rad")


def test_a_prop_is_found_by_its_name(record):
    found = rerun(altered(record, "prop_pose", (5, 1, 0), one_ulp))
    assert (found.row, found.bodies) == (5, ("crate",))


def test_the_sign_of_a_zero_counts_since_it_is_a_bit(record):
    assert record.pose[2, 2, 0] == 0
    found = rerun(altered(record, "pose", (2, 2, 0), lambda zero: -zero))
    assert found.row == 2


def test_an_effort_is_found(record):
    found = rerun(altered(record, "effort", (9, 0), lambda effort: effort + 0.5))
    assert (found.row, found.what, found.bodies) == (9, "effort", ("red",))
    assert "off by 0.5" in found.how


def test_a_contact_departs_at_its_own_row_not_at_the_last(record):
    contacts = record.contacts.copy()
    contacts["impulse"][2] += 0.125
    found = rerun(replace(record, contacts=contacts))
    assert (found.what, found.bodies) == ("contact", ("red", "blue"))
    assert record.time[found.row - 1] <= contacts["time"][2] <= record.time[found.row]
    assert found.row < len(record) - 1


@each_case("first", [True, False])
def test_a_contact_that_is_missing_or_too_many_is_told(record, first):
    kept = record.contacts[1:] if first else record.contacts[:-1]
    found = rerun(replace(record, contacts=kept))
    gone = record.contacts["time"][0 if first else -1]
    assert found.what == "contact"
    assert found.time - 0.1 - 1e-9 <= gone <= found.time


def test_what_departs_first_is_told(record):
    contacts = record.contacts.copy()
    contacts["speed"][0] += 1.0
    early = rerun(replace(record, contacts=contacts)).row
    both = altered(replace(record, contacts=contacts), "pose", (early + 3, 0, 0), one_ulp)
    assert rerun(both).what == "contact"
    both = altered(replace(record, contacts=contacts), "pose", (early - 3, 0, 0), one_ulp)
    assert rerun(both).what == "pose"


def test_a_run_that_was_broken_off_is_the_same_again(record):
    for rows in (1, 20, 30):
        cut = {name: getattr(record, name)[:rows] for name in COLUMNS}
        assert rerun(replace(record, **cut, finished=False)) is None


def test_a_run_with_a_hand_in_it_is_the_same_again():
    world = World(scenario(), meet)
    for k in range(30):
        if k == 5:
            world.operator.place("crate", (0.3, 1.2, 0.4))
        if 10 <= k < 20:
            world.operator.steer("red", (0.0, 0.1 * (k - 10)))
        world.step()
    world.break_off("enough")
    assert rerun(world.record) is None


def test_a_drive_of_the_users_own_is_asked_for(record):
    with pytest.raises(InputError, match="does not hold the drive Sideways"):
        rerun(replace(record, missing=("drive Sideways",)))


# -- the command ----------------------------------------------------------------------------------


def check(record, path, capsys):
    code = cli.main(["check", str(record.save(path))])
    return code, *capsys.readouterr()


def test_check_says_that_a_record_is_the_same(record, tmp_path, capsys):
    code, shown, _ = check(record, tmp_path / "a.npz", capsys)
    assert code == 0
    assert shown.endswith("run again   from its recorded commands: bit-identical\n")


def test_check_says_where_and_by_how_much_and_with_what_it_was_made(record, tmp_path, capsys):
    off = altered(record, "pose", (7, 0, 1), lambda x: x + 0.5)
    old = replace(off, versions={**record.versions, "numpy": "1.2.3"})
    code, _, told = check(old, tmp_path / "a.npz", capsys)
    assert code == 1
    assert "a.npz: run again from its recorded commands, it departs at row 7, at 0.7 s: " in told
    assert "the pose of blue is off by 0.5 m and 0 rad" in told
    assert f"it was made with numpy 1.2.3, here {np.__version__}" in told
    assert told.count("\n") == 1
