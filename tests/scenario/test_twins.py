"""Names that mean the same: radius and diameter, and the items of lists by number or name."""

import pytest

from mars2d import InputError, Robot, Scenario
from mars2d.addons import Map
from mars2d.bodies import Ball, Box, Puck
from mars2d.scenario.experiment import open_experiment
from tests.cases import each_case


@each_case("kind", [Robot, Ball, Puck])
def test_a_radius_is_half_a_diameter(kind):
    small = kind(radius=0.25)
    assert small == kind(diameter=0.5)
    assert (small.radius, small.diameter) == (0.25, 0.5)
    assert small.replace(radius=0.1).diameter == 0.2
    assert small.replace(diameter=0.1).radius == 0.05
    assert repr(small) == f"{kind.__name__}(diameter=0.5)"


@each_case("kind", [Robot, Ball, Puck])
def test_only_one_of_them_is_given(kind):
    with pytest.raises(InputError, match=f"{kind.__name__} has both radius and diameter"):
        kind(radius=0.1, diameter=0.2)
    with pytest.raises(InputError, match=f"{kind.__name__}.radius = 'a': expected a number"):
        kind(radius="a")
    with pytest.raises(InputError, match=f"{kind.__name__}.diameter = -2"):
        kind(radius=-1)


def test_a_file_may_have_a_radius(tmp_path):
    path = tmp_path / "room.toml"
    path.write_text("format = 1\n[[robots]]\nradius = 0.2\n")
    assert open_experiment(path).scenario.robots[0].diameter == 0.4
    path.write_text("format = 1\n[[robots]]\nradius = 0.2\ndiameter = 0.4\n")
    with pytest.raises(InputError, match=r"room.toml, line \d.*has both radius and diameter"):
        open_experiment(path)


@pytest.fixture
def scenario():
    return Scenario(
        robots=[Robot(name="red"), Robot(name="blue", pose=(1, 0, 0))],
        props=[Box(name="crate", pose=(0, 1, 0))],
        addons=[Map([[(2, 0), (2, 1)]], name="wall")],
    )


def test_settings_name_things_as_laws_do(scenario):
    given = {
        "robots.blue.mass": 2.0,
        "robots.red.radius": 0.2,
        "props.crate.mass": 1.5,
        "addons.wall.friction": 0.7,
    }
    changed = open_experiment(scenario, given).scenario
    assert [robot.mass for robot in changed.robots] == [scenario.robots[0].mass, 2.0]
    assert changed.robots[0].diameter == 0.4
    assert changed.props[0].mass == 1.5
    assert changed.addons[0].friction == 0.7
    by_number = {"robots.1.mass": 2.0, "robots.0.diameter": 0.4, "props.0.mass": 1.5}
    assert open_experiment(scenario, by_number | {"addons.0.friction": 0.7}).scenario == changed


@each_case(
    ("name", "message"),
    [
        ("robots.rde.mass", r"'robots.rde': expected \* or 0 to 1 or a name; did you mean 'red'"),
        ("robots.2.mass", r"expected \* or 0 to 1 or a name; known: blue, red"),
        ("addons.wal.friction", r"expected \* or 0 to 0 or a name; did you mean 'wall'"),
        ("robots.red.colour", "Robot has no field 'colour'; did you mean 'color'"),
    ],
)
def test_a_name_that_is_not_there_is_refused_with_the_nearest(scenario, name, message):
    with pytest.raises(InputError, match=message):
        open_experiment(scenario, {name: 1.0})
