"""An error is shown with the lines of code that it points at."""

import functools
import traceback

import pytest

from mars2d import Robot, Scenario, World
from mars2d.core.errors import InputError, LawError
from mars2d.core.usercode import users_line
from mars2d.output.excerpt import Excerpt, excerpt_of
from mars2d.scenario.experiment import load_law, open_experiment
from tests.cases import each_case

LAW = """\
import math

def control(world):
    far = world.time - 1.0
    return [[math.sqrt(far)], [0.0]]

"""

MISTAKEN = """\
from mars2d import Robot, Scenario

scenario = Scenario(robots=[Robot()])

def control(world):
    return 3
"""


def error_of(control):
    world = World(Scenario(robots=[Robot()]), control)
    with pytest.raises(LawError) as caught:
        world.step()
    return caught.value


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "walk.py").write_text(LAW)
    return tmp_path


def test_the_line_that_raised_and_what_is_round_it(folder):
    error = error_of(load_law(folder / "walk.py", "control"))
    excerpt = excerpt_of(error)
    assert excerpt.file == folder / "walk.py"
    assert (excerpt.line, excerpt.first) == (5, 3)
    assert excerpt.lines == tuple(LAW.splitlines()[2:5])  # without the empty line at the end


def test_a_law_that_returned_what_can_not_be_used_is_found_beside_the_experiment(tmp_path):
    path = tmp_path / "mistaken.py"
    path.write_text(MISTAKEN)
    error = error_of(open_experiment(path).control)
    assert excerpt_of(error, path).lines[-1].strip() == "return 3"
    assert excerpt_of(error, tmp_path / "other.py").line == excerpt_of(error, path).line
    assert excerpt_of(error, tmp_path / "elsewhere" / "other.py") is None


def test_a_line_that_is_no_python(folder):
    (folder / "walk.py").write_text("def control(world:\n    return 0, 0\n")
    with pytest.raises(InputError) as caught:
        load_law(folder / "walk.py", "control")
    assert excerpt_of(caught.value).line == 1
    assert excerpt_of(caught.value).lines[0] == "def control(world:"


def test_an_error_of_python_itself_has_the_users_innermost_line():
    with pytest.raises(ZeroDivisionError) as caught:
        functools.reduce(lambda a, b: a / b, [1, 0])
    assert "reduce" in excerpt_of(caught.value).lines[2]


def test_the_file_that_starts_the_command_line_is_no_code_of_the_user():
    outer = traceback.FrameSummary("/usr/local/bin/mars2d", 6, "<module>", lookup_line=False)
    law = traceback.FrameSummary("/home/ada/walk.py", 12, "control", lookup_line=False)
    assert users_line(traceback.StackSummary.from_list([outer])) is None
    assert users_line(traceback.StackSummary.from_list([outer, law])) == "walk.py, line 12"


@each_case("name", ["<string>", "", "<stdin>"])
def test_code_that_was_made_by_eval_has_no_place_in_a_file(name):
    made = {}
    exec(compile("def law(world):\n    return 1 / 0\n", name, "exec"), made)
    error = error_of(made["law"])
    assert str(error).startswith("law raised ZeroDivisionError")
    assert error.where is None


def test_without_a_place_there_is_no_excerpt():
    assert excerpt_of(InputError("range = -1: expected > 0")) is None
    gone = InputError("gone")
    gone.where = "nowhere.py, line 3"
    assert excerpt_of(gone) is None
    endless = InputError("its own cause")
    endless.__cause__ = endless
    assert excerpt_of(endless) is None


def test_a_line_beyond_the_end_of_a_file_that_has_changed(folder):
    error = error_of(load_law(folder / "walk.py", "control"))
    (folder / "walk.py").write_text("\n")
    assert excerpt_of(error) is None


@each_case("line, count, first", [(5, 1, 5), (5, 3, 4), (3, 3, 3), (7, 3, 5)])
def test_the_nearest_lines_hold_the_one_that_is_meant(folder, line, count, first):
    excerpt = Excerpt(folder / "walk.py", line, 3, tuple("abcde")).nearest(count)
    assert excerpt.first == first
    assert excerpt.lines == tuple("abcde")[first - 3 : first - 3 + count]
    assert excerpt.line == line
