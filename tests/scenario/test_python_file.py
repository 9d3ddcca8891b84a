"""A scenario as Python: executing it gives an equal one."""

from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

import mars2d
from mars2d import Animation, Robot, Scenario, Sensor, load_law
from mars2d.scenario import load_scenario, serialize
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.pretty import Brackets, laid_out
from mars2d.scenario.python_file import as_python
from tests.cases import each_case
from tests.worlds import without_laws

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


@each_case("name", examples())
def test_an_example_is_listed_but_for_its_code(name, tmp_path):
    experiment = open_experiment(name)
    text = as_python(experiment.scenario, experiment.control, tmp_path)
    (tmp_path / "listed.py").write_text(text, encoding="utf-8")
    again = open_experiment(tmp_path / "listed.py")
    kept, lost = serialize.without_code(experiment.scenario)
    assert without_laws(again.scenario) == without_laws(kept)
    assert all(name in text for name in lost)
    named = [line for line in text.splitlines() if ".py" not in line]  # a path is not broken
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


@each_case("width", range(12, 60))
def test_what_is_laid_out_keeps_its_items_and_its_width(width):
    inner = [Brackets("(", [f"{i}.0", "-1.5"], ")") for i in range(8)]
    node = Brackets("f(", [Brackets("a=[", inner, "]", filled=True), "b=2"], ")")
    text = laid_out(node, width=width)
    assert eval(text, {"f": lambda a, b: (a, b)}) == ([(float(i), -1.5) for i in range(8)], 2)
    assert max(map(len, text.splitlines())) <= max(width, 19)


def test_a_law_far_away_has_its_whole_path_and_a_near_one_a_relative_path(tmp_path):
    folder = tmp_path / "mine"
    folder.mkdir()
    laws = tmp_path / "laws"
    laws.mkdir()
    (laws / "go.py").write_text("def control(robot):\n    return 0.1, 0.0\n")
    law = load_law(laws / "go.py")
    scenario = Scenario(robots=[Robot(controller=law)])
    assert 'load_law("../laws/go.py")' in as_python(scenario, folder=folder)
    above = Path(tmp_path.anchor)
    for far in (above / "home", above / "home" / "me"):
        text = as_python(scenario, folder=far)
        assert f'load_law("{(laws / "go.py").as_posix()}")' in text
        assert executed(text).robots[0].controller is not None
