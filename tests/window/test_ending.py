"""What a window says where nothing follows."""

from mars2d.core.errors import LawError
from mars2d.scenario.experiment import open_experiment
from mars2d.window.run.ending import Ending
from mars2d.window.screen.player import Player
from mars2d.world.timeline import Timeline
from tests.window.circling import Circling

LAW = """
from mars2d import Robot, Scenario


def law(robot):
    raise ValueError("no way")


scenario = Scenario(robots=[Robot(controller=law)], stop_time=1)
"""


def test_the_lines_of_an_error_are_those_that_were_run(tmp_path):
    file = tmp_path / "fails.py"
    file.write_text(LAW)
    player = Player(Timeline(open_experiment(str(file))), "max")
    player.step()
    ending = Ending(player)
    first = ending.banner()
    assert "no way" in first.text
    assert first.excerpt.lines[first.excerpt.line - first.excerpt.first].strip().startswith("raise")
    file.write_text("# mended\n" * 3 + LAW.replace("no way", "another"))
    assert ending.banner() == first


def test_another_error_has_its_own_lines(tmp_path):
    player = Player(Circling(rows=5, fails_at=1), "max")
    player.step(4)
    ending = Ending(player)
    assert ending.banner().error
    player.error = LawError("something else")
    assert ending.banner().text == "something else"
    assert ending.banner().excerpt is None
