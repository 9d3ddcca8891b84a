"""An error is shown with the lines of code that it points at."""

import pytest

from mars2d import Robot, Scenario, World
from mars2d.core.errors import InputError, LawError
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


@each_case("line, count, first", [(5, 1, 5), (5, 3, 4), (3, 3, 3), (7, 3, 5)])
def test_the_nearest_lines_hold_the_one_that_is_meant(folder, line, count, first):
    excerpt = Excerpt(folder / "walk.py", line, 3, tuple("abcde")).nearest(count)
    assert excerpt.first == first
    assert excerpt.lines == tuple("abcde")[first - 3 : first - 3 + count]
    assert excerpt.line == line
