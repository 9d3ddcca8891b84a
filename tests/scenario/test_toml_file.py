"""Scenario files: what is saved comes back, what is wrong is pointed at, nothing else is raised."""

import re
import tomllib
from pathlib import Path

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

import mars2d
from mars2d import Addon, InputError, Robot, Scenario, Sensor
from mars2d.addons import Density, Floor, Map
from mars2d.bodies.props import Box
from mars2d.scenario import load_scenario, save_scenario, serialize
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.schema import schema
from tests.cases import each_case
from tests.worlds import without_laws

CHECKER = jsonschema.Draft202012Validator(schema())

EVERYTHING = (Path(__file__).parent / "everything.toml").read_text(encoding="utf-8")

LAWS = """
def walk(robot):
    return 0.1, 0.0

def team(world):
    return 0.2, 0.0

def two(a, b):
    return 0.0, 0.0
"""


def saved(scenario, folder, control=None):
    """Save a scenario; return its text, what is missing of it, and the scenario read again."""
    path = folder / "scene.toml"
    missing = save_scenario(scenario, path, control)
    return path.read_text(encoding="utf-8"), missing, load_scenario(path)


def read(folder, text):
    path = folder / "scene.toml"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    (folder / "walk.py").write_text(LAWS)
    return load_scenario(path)


# -- what is saved comes back ------------------------------------------------------------------


def test_all_kinds_of_parts_come_back(tmp_path):
    scenario = read(tmp_path, EVERYTHING)
    text, missing, again = saved(scenario, tmp_path)
    assert missing == ()
    assert again == scenario
    assert saved(again, tmp_path)[0] == text
    for place in ("robots", "props", "joints", "material_pairs", "addons"):
        assert len(getattr(scenario, place)) == EVERYTHING.count(f"\n[[{place}]]\n") > 1


@pytest.mark.slow
@each_case("name", examples())
def test_an_example_is_written_but_for_its_code(name, tmp_path):
    experiment = open_experiment(name)
    text, missing, again = saved(experiment.scenario, tmp_path, experiment.control)
    CHECKER.validate(tomllib.loads(text))
    kept, lost = serialize.without_code(experiment.scenario)
    assert without_laws(again) == without_laws(kept)
    assert set(lost) <= set(missing)
    assert all(name in text for name in lost)


def test_the_file_of_all_kinds_is_laid_out_as_it_is_saved(tmp_path):
    text = saved(read(tmp_path, EVERYTHING), tmp_path)[0]
    assert text == EVERYTHING.replace("everything.toml", "scene.toml")


def test_a_long_list_has_a_line_for_each_item(tmp_path):
    scenario = Scenario(addons=[Map([[(k, 2), (k + 0.5, 3)] for k in range(4)])])
    text, _, again = saved(scenario, tmp_path)
    assert "\noutlines = [\n    [[0.0, 2.0], [0.5, 3.0]],\n    [[1.0," in text
    assert again == scenario


@each_case("name", ["go_to_point", "push_box"])
def test_a_run_of_the_file_is_that_of_the_experiment(name, tmp_path):
    experiment = open_experiment(name, {"addons": []})
    save_scenario(experiment.scenario, tmp_path / "scene.toml", experiment.control)
    before = mars2d.run(experiment.scenario, stop_time=2, control=experiment.control)
    after = mars2d.run(tmp_path / "scene.toml", stop_time=2)
    assert after.digest == before.digest
    assert after.filename == "scene.toml"


number = st.floats(allow_nan=False, allow_infinity=False, min_value=-5, max_value=5)


titles = st.text(st.characters(exclude_categories=["Cc", "Cs", "Zl", "Zp"]))


@given(number, number, st.floats(min_value=1e-3, max_value=1e3), titles)
def test_numbers_and_texts_come_back_exactly(tmp_path_factory, x, theta, mass, title):
    robot = Robot(pose=(x, 0.1 + 0.2, theta), mass=mass)
    scenario = Scenario(title=title, robots=[robot], workspace=None)
    again = saved(scenario, tmp_path_factory.mktemp("text"))[2]
    assert again == scenario
    assert repr(again.robots[0].pose) == repr(scenario.robots[0].pose)


def test_an_image_beside_the_file_is_found_and_named_relative_to_it(tmp_path, monkeypatch):
    (tmp_path / "floor.png").write_bytes(b"")
    monkeypatch.chdir("/")
    path, bounds = str(tmp_path / "floor.png"), (0, 1, 0, 1)
    scenario = Scenario(addons=[Floor(image=path, bounds=bounds)])
    text, _, again = saved(scenario, tmp_path)
    assert 'image = "floor.png"' in text
    assert again == scenario


# -- laws and other code ------------------------------------------------------------------------


def test_laws_are_named_by_their_place_and_loaded_anew_for_each_robot(tmp_path):
    (tmp_path / "laws").mkdir()
    count = "n = 0\ndef walk(robot):\n    global n\n    n += 1\n    return 0.1 * n, 0.0\n"
    (tmp_path / "laws" / "count.py").write_text(count)
    text = 'format = 1\n[[robots]]\ncontroller = "laws/count.py:walk"\n'
    scenario = read(
        tmp_path, text + '[[robots]]\npose = [0, 1]\ncontroller = "laws/count.py:walk"\n'
    )
    first, second = (robot.controller for robot in scenario.robots)
    assert [first(None), first(None), second(None)] == [(0.1, 0.0), (0.2, 0.0), (0.1, 0.0)]
    again, missing, _ = saved(scenario, tmp_path)
    assert again.count('controller = "laws/count.py:walk"') == 2
    assert missing == ()


def test_the_law_of_the_team_is_taken_from_the_file(tmp_path):
    read(tmp_path, 'format = 1\ncontrol = "walk.py:team"\nstop_time = 1.0\n')
    experiment = open_experiment(tmp_path / "scene.toml")
    assert experiment.control.__name__ == "team"
    assert experiment.source.path == tmp_path / "scene.toml"
    record = mars2d.run(tmp_path / "scene.toml")
    assert record.pose[-1, 0, 0] == pytest.approx(0.2)
    stands = mars2d.run(tmp_path / "scene.toml", control=lambda world: (0.0, 0.0))
    assert stands.pose[-1, 0, 0] == 0
    missing = save_scenario(experiment.scenario, tmp_path / "again.toml", experiment.control)
    assert missing == ()
    assert 'control = "walk.py:team"\n' in (tmp_path / "again.toml").read_text()


def test_laws_that_cannot_be_found_again_are_named(tmp_path):
    scenario = Scenario(robots=[Robot(controller=lambda robot: (0, 0))])
    text, missing, again = saved(scenario, tmp_path, lambda world: (0, 0))
    assert missing == ("law <lambda>",)
    assert text.count("# This is code, which is not written down: law <lambda>\n") == 1
    assert '# A law is named by its place: controller = "file.py:function"\n' in text
    assert again.robots[0].controller is None


class Nose(Sensor):
    """A sensor of one's own."""

    def read(self, robot, world, rng):
        return 0.0


class Lamps(Addon):
    """An add-on of one's own, with obstacles."""

    def obstacles(self):
        return [[(2, 2), (3, 3)]]


def test_parts_of_ones_own_are_named_and_their_obstacles_stay(tmp_path):
    scenario = Scenario(robots=[Robot(sensors=[Nose()])], addons=[Lamps(), Density(lambda x, y: x)])
    text, missing, again = saved(scenario, tmp_path)
    assert missing == ("sensor Nose", "add-on Lamps", "Density, with its function <lambda>")
    for name in missing:
        assert f"# This is code, which is not written down: {name}\n" in text
    assert again.addons == (Map([[(2, 2), (3, 3)]], name=None),)
    assert again.robots[0].sensors == ()


# -- what people write ----------------------------------------------------------------------------


def test_what_people_write_is_understood(tmp_path):
    scenario = read(
        tmp_path,
        "\ufeff# by hand\r\nformat = 1 # first\r\nrobots = 3\r\nneighbours = 'Delaunay'\r\n"
        "workspace = 'none'\r\nanimation = { grid = false }\r\n"
        "props = [{ type = 'Box', pose = [2, 2] }]\r\n",
    )
    assert len(scenario.robots) == 3
    assert scenario == Scenario(
        robots=3,
        neighbours=mars2d.Delaunay(),
        workspace=None,
        animation=mars2d.Animation(grid=False),
        props=[Box(pose=(2, 2, 0))],
    )


# -- what is wrong ------------------------------------------------------------------------------

ROBOT = "[[robots]]\n"

WRONG = [
    ("", "scene.toml: no scenario: the first line should be format = 1"),
    ("format = 2", "scene.toml, line 1: format = 2: expected 1, which this MARS2D reads"),
    ('\n\ntitle = "x', "scene.toml, line 3: "),
    ("\nx = " + "[" * 9999, "scene.toml: brackets stand in each other too deeply"),
    ("\ntitle = 'x", "scene.toml, at its end: Expected"),
    ("\ngrid = True", "line 2: Invalid value: grid = True; TOML writes true and false"),
    (
        "\npose = (1, 2)",
        "line 2: Invalid value: pose = (1, 2); a list has brackets and commas: [1, 2]",
    ),
    ("\ntitle = 'a'\ntitle = 'b'", "scene.toml, line 3: Cannot overwrite a value: title = 'b'"),
    ("\ntitel = 'x'", "line 2: Scenario has no field 'titel'; did you mean 'title'?"),
    ("\ncontroll = 'x'", "did you mean 'control'?"),
    ("\ntitle = 5", "scene.toml, line 2: Scenario.title = 5: expected text in quotes"),
    ("\nrobots = [5]", 'line 2: robots[0] = 5: expected a table, as { type = "Robot" }'),
    ("\n[robots]", "line 2: robots: expected a list of tables; write [[robots]] above each"),
    (
        f"\n{ROBOT}pose = [0,0]\n\n{ROBOT}pose = [1,1]\nposee = [1]",
        "scene.toml, line 7, robots[1]: Robot has no field 'posee'; did you mean 'pose'?",
    ),
    (
        f"\n{ROBOT}drive = 'Unicycl'",
        "type = 'Unicycl': no Drive is called so; did you mean 'Unicycle'",
    ),
    (
        f"\n{ROBOT}\n{ROBOT}pose = [1,1]\n[robots.drive]\nmax_force = -1",
        "scene.toml, line 7, robots[1].drive: Unicycle.max_force = -1: expected a number > 0",
    ),
    (
        f"\n{ROBOT}[[robots.sensors]]\ntype = 'Pose'\n[[robots.sensors]]\ntype = 'RangeFindr'",
        "line 6, robots[0].sensors[1]: type = 'RangeFindr': no Sensor is called so; did you mean",
    ),
    (
        f"\n{ROBOT}[[robots.sensors]]\nrange = 5",
        "robots[0].sensors[0]: its type is missing, as type",
    ),
    (
        f"\n{ROBOT}shape = {{ type = 'Compound', parts = ['Disc'] }}",
        "line 3, robots[0].shape.parts[0]: Disc.diameter is missing",
    ),
    (
        f"\n{ROBOT}controller = 'wlk.py:walk'",
        "line 3, robots[0]: wlk.py: there is no such file beside",
    ),
    (f"\n{ROBOT}controller = 'walk.py:wlak'", "walk.py: has no law 'wlak'; did you mean 'walk'?"),
    (
        f"\n{ROBOT}controller = 'walk.py:two'",
        "expected a function of exactly one argument, the robot",
    ),
    ("\n[[joints]]\ntype = 'Rope'\na = 'robt0'", "line 2: Scenario.joints[0].a = 'robt0'"),
    ("\n[[addons]]\ntype = 'Map'\noutlines = [[0, 0], [1, 1]]", "line 4, addons[0]: Map.outlines"),
    (
        "\n[[addons]]\ntype = 'Communication'\nburst = { bad = -7 }",
        "addons[0].burst: Burst.bad",
    ),
    ("\nneighbours = 'Wthin'", "line 2, neighbours: type = 'Wthin': no Neighbourhood is called so"),
    (
        "\n[animation]\nwake = 'yes'",
        "line 3, animation: Animation.wake = 'yes': expected true or false",
    ),
]


@each_case(("text", "expected"), WRONG)
def test_what_is_wrong_is_pointed_at(text, expected, tmp_path):
    with pytest.raises(InputError) as caught:
        read(tmp_path, text if text[:1] != "\n" else f"format = 1{text}\n")
    assert expected in str(caught.value)
    assert "scene.toml" in str(caught.value) or "walk.py" in str(caught.value)


@each_case(
    ("data", "expected"),
    [
        (b"format = 1\ntitle = '\xe9'", "scene.toml, line 2: expected text in UTF-8"),
        ("format = 1".encode("utf-16"), "scene.toml, line 1: expected text in UTF-8"),
        (b"#" * 5_000_001, "expected at most 5 MB, it is larger"),
    ],
)
def test_what_is_no_text_is_refused(data, expected, tmp_path):
    with pytest.raises(InputError, match=re.escape(expected)):
        read(tmp_path, data)


def test_what_is_no_file_is_refused(tmp_path):
    with pytest.raises(InputError, match="there is no such file"):
        load_scenario(tmp_path / "scene.toml")
    (tmp_path / "scene.py").write_text("")
    with pytest.raises(InputError, match=r"expected a scenario, a file that ends in \.toml"):
        load_scenario(tmp_path / "scene.py")
