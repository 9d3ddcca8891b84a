"""A scenario as Python: executing it gives an equal one."""

import tomllib
from pathlib import Path

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

import mars2d
from mars2d import Animation, Robot, Scenario, Sensor
from mars2d.scenario import load_scenario, save_scenario, serialize
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.python_file import as_python
from mars2d.scenario.schema import schema
from tests.cases import each_case
from tests.worlds import without_laws

CHECKER = jsonschema.Draft202012Validator(schema())
EVERYTHING = Path(__file__).parent / "everything.toml"


def executed(text):
    names = {}
    exec(compile(text, "listing.py", "exec"), names)
    return names["scenario"]


def test_all_kinds_of_parts_are_listed():
    scenario = load_scenario(EVERYTHING)
    text = as_python(scenario)
    assert executed(text) == scenario
    assert as_python(executed(text)) == text
    named = [line for line in text.splitlines() if ".py" not in line]  # a path is not broken
    assert max(map(len, named)) <= 100


@pytest.mark.slow
@each_case("name", examples())
def test_an_example_is_written_in_toml_and_python_but_for_its_code(name, tmp_path):
    experiment = open_experiment(name)
    missing = save_scenario(experiment.scenario, tmp_path / "scene.toml", experiment.control)
    toml = (tmp_path / "scene.toml").read_text(encoding="utf-8")
    CHECKER.validate(tomllib.loads(toml))
    text = as_python(experiment.scenario, experiment.control, tmp_path)
    (tmp_path / "listed.py").write_text(text, encoding="utf-8")
    again = open_experiment(tmp_path / "listed.py")
    kept, lost = serialize.without_code(experiment.scenario)
    assert without_laws(again.scenario) == without_laws(kept)
    assert without_laws(load_scenario(tmp_path / "scene.toml")) == without_laws(kept)
    assert set(lost) <= set(missing)
    assert all(name in text and name in toml for name in lost)
    named = [line for line in (text + toml).splitlines() if ".py" not in line]  # paths stay whole
    assert max(map(len, named)) <= 100
    assert (again.control is None) == (experiment.control is None)


def test_a_small_scenario_is_as_one_would_write_it():
    robots = [Robot(pose=(0, 1, 0), mass=2), Robot(pose=(-2, 1, 0), color="#123456", name="blue")]
    scenario = Scenario(
        title='The "small" one', robots=robots, animation=Animation(forces=True), stop_time=5
    )
    assert as_python(scenario) == (
        '"""The \'small\' one"""\n'
        "\n"
        "from mars2d import Animation, Robot, Scenario\n"
        "\n"
        "scenario = Scenario(\n"
        '    title="The \\"small\\" one",\n'
        "    robots=[\n"
        "        Robot(pose=(0.0, 1.0, 0.0), mass=2.0),\n"
        '        Robot(name="blue", pose=(-2.0, 1.0, 0.0), color="#123456"),\n'
        "    ],\n"
        "    stop_time=5.0,\n"
        "    animation=Animation(forces=True),\n"
        ")\n"
    )


def test_laws_are_loaded_from_beside_the_listing(tmp_path):
    (tmp_path / "walk.py").write_text(
        "def walk(robot):\n    return 0.1, 0.0\n"
        "def control(world):\n    return [[0.2] * 2, [0] * 2]\n"
    )
    walk = mars2d.load_law(tmp_path / "walk.py", "walk")
    team = mars2d.load_law(tmp_path / "walk.py")
    scenario = Scenario(robots=[Robot(controller=walk), Robot(pose=(0, 2, 0))], stop_time=1)
    text = as_python(scenario, team, tmp_path)
    assert 'controller=load_law("walk.py", "walk")' in text
    assert text.endswith('control = load_law("walk.py")\n')
    (tmp_path / "listed.py").write_text(text)
    before, after = (
        mars2d.run(scenario, control=team),
        mars2d.run(tmp_path / "listed.py"),
    )
    assert after.digest == before.digest
    assert str(tmp_path / "walk.py") in as_python(scenario)


class Nose(Sensor):
    """A sensor of one's own."""

    def read(self, robot, world, rng):
        return 0.0


def test_code_of_ones_own_is_named_in_comments():
    scenario = Scenario(robots=[Robot(controller=lambda robot: (0, 0), sensors=[Nose()])])
    text = as_python(scenario, lambda world: (0, 0))
    assert "# This is code, which is not written down: sensor Nose\n" in text
    assert text.count("# This is code, which is not written down: law <lambda>\n") == 1
    assert "controller=None" in text
    assert text.endswith("control = None\n")
    assert executed(text).robots[0].sensors == ()


@given(st.text(st.characters(exclude_categories=["Cc", "Cs", "Zl", "Zp"]), max_size=200))
def test_any_title_can_be_listed(title):
    text = as_python(Scenario(title=title))
    assert executed(text).title == title
