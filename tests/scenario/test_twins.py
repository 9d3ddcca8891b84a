"""The items of lists are named by number or by name."""

import pytest

from mars2d import InputError, Robot, Scenario
from mars2d.addons import Map
from mars2d.bodies import Box
from mars2d.scenario.experiment import open_experiment
from tests.cases import each_case


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
        "robots.red.diameter": 0.4,
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
        ("robots.red.radius", r"no field 'radius'; write diameter=2 \* radius"),
        ("robots.red.colour", "Robot has no field 'colour'; did you mean 'color'"),
    ],
)
def test_a_name_that_is_not_there_is_refused_with_the_nearest(scenario, name, message):
    with pytest.raises(InputError, match=message):
        open_experiment(scenario, {name: 1.0})
