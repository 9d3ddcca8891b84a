"""The editor and the run look at the same place, and the run says what stands still."""

import pygame
import pytest

from mars2d.scenario.changes import carried
from mars2d.scenario.controllers import ByHand, FollowWaypoints, Wander
from mars2d.scenario.experiment import Experiment, Source
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.window.run.window import Window
from mars2d.world.timeline import Timeline
from tests.cases import each_case


def window_of(scenario, path=None):
    return Window(Timeline(Experiment(scenario, source=Source(path=path))))


def middle(viewpoint):
    return viewpoint.camera.to_world([viewpoint.layout.plot.center])[0].tolist()


def test_the_editor_opens_where_the_window_looked_and_the_window_where_the_editor_did():
    window = window_of(Scenario(robots=[Robot()]))
    window.viewpoint.zoom(6, (400, 300))
    seen = middle(window.viewpoint)
    window._open_editor()
    assert middle(window.editor.viewpoint) == pytest.approx(seen)
    window.editor.viewpoint.pan(50, -30)
    seen = middle(window.editor.viewpoint)
    window._close_editor(window.editor)
    assert middle(window.viewpoint) == pytest.approx(seen)


def test_a_drawing_that_takes_long_is_not_waited_for_by_another_one():
    window = window_of(Scenario(robots=[Robot()]))
    pygame.display.init()
    pygame.display.set_mode((640, 480))
    with window._screen:  # as while an add-on of the user draws
        assert window._answer("addon.py, line 3") == ""


@each_case(
    "robots, said",
    [
        ([Robot(), Robot(pose=(1, 0, 0), controller=ByHand())],
         "robot0 stands still: robot0 lacks a law"),
        ([Robot(controller=FollowWaypoints())], "robot0 stands still: robot0 lacks a waypoint"),
        ([Robot(), Robot(pose=(1, 0, 0)), Robot(pose=(2, 0, 0))],
         "robot0, and 2 more robots stand still: robot0 lacks a law"),
        ([Robot(controller=Wander(), sensors=Wander.needs)], None),
    ],
)  # fmt: skip
def test_the_run_of_a_drawing_says_what_stands_still(robots, said, tmp_path):
    window = window_of(Scenario(robots=robots), tmp_path / "room.toml")
    window.director.say_who_stands_still()
    assert [note.text for note in window.notes._notes] == ([] if said is None else [said])


def test_a_law_given_by_hand_holds_and_others_stay_those_of_the_file():
    fresh = Scenario(robots=[Robot(controller=ByHand()), Robot(pose=(1, 0, 0))])
    drawn = [r.replace(controller=Wander(), sensors=()) for r in fresh.robots]
    kept = carried(fresh, fresh.replace(robots=drawn), {"robot1"})
    assert [type(robot.controller) for robot in kept.robots] == [ByHand, Wander]
    again = Experiment(fresh).redrawn(fresh.replace(robots=drawn), {"robot1"})
    assert [type(robot.controller) for robot in again.scenario.robots] == [ByHand, Wander]
