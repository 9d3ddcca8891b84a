"""The other branches are seen where they were at the same time, and their rows are marked."""

import numpy as np
import pytest

from mars2d import LawError, Robot, Scenario
from mars2d.addons import Map
from mars2d.core.scene import Circle, Line, Text
from mars2d.scenario.experiment import Experiment
from mars2d.window.run.ghosts import ghosts
from mars2d.window.run.timebar import TimeBar
from mars2d.window.screen.player import Player
from mars2d.window.screen.source import Playback
from mars2d.world.timeline import Timeline
from tests.worlds import ahead


def run_to(timeline, row):
    while timeline.newest < row and not timeline.world.over:
        timeline.advance()
    timeline.go(row)


def timeline_of(robots=2, law=ahead, **changes):
    team = [Robot(controller=law).at(0, 1.5 * i, 0) for i in range(robots)]
    scenario = Scenario(robots=team, sampling_time=0.5, stop_time=500, workspace=None, **changes)
    return Timeline(Experiment(scenario))


def branched(row=20, newest=40):
    """Return a timeline whose robot 0 was put 2 m lower at a row, in a branch."""
    timeline = timeline_of()
    run_to(timeline, newest)
    timeline.go(row)
    timeline.change(lambda w: w.operator.place(0, (w.pose[0, 0], -2.0, 0.0)))
    run_to(timeline, newest)
    return timeline


def centers(scene):
    return {shape.center for shape in scene.shapes if isinstance(shape, Circle)}


def test_a_body_is_seen_where_it_was_and_how_it_got_there():
    timeline = branched()
    scene = ghosts(timeline, timeline.frame)
    ((x, y),) = centers(scene)
    assert (x, y) == pytest.approx((4.0, 0.0))
    lines = [shape for shape in scene.shapes if isinstance(shape, Line)]
    (way,) = [shape.points for shape in lines if shape.style == "--"]
    assert way[0].tolist() == pytest.approx([2.0, 0.0])  # where the branches part
    assert way[-1].tolist() == pytest.approx([4.0, 0.0])
    assert [shape.text for shape in scene.shapes if isinstance(shape, Text)] == ["branch from 10 s"]


def test_before_the_branches_part_there_are_none():
    timeline = branched()
    timeline.go(19)
    assert ghosts(timeline, timeline.frame).shapes == []
    timeline.go(20)
    assert len(centers(ghosts(timeline, timeline.frame))) == 1


def test_from_the_other_branch_this_one_is_seen():
    timeline = branched()
    timeline.show(timeline.others[0])
    ((_, y),) = centers(ghosts(timeline, timeline.frame))
    assert y == -2.0


def test_after_its_end_a_branch_stays_there_and_says_so():
    timeline = branched(newest=25)
    timeline.branches[0].world.stop("enough")
    run_to(timeline, 60)
    scene = ghosts(timeline, timeline.frame)
    assert [x for x, _ in centers(scene)] == pytest.approx([2.5, 2.5])
    (text,) = [shape.text for shape in scene.shapes if isinstance(shape, Text)]
    assert text == "branch from 10 s, over at 12.5 s"


def marks(source):
    return TimeBar(Player(source, 1.0), source).marks()


def test_marks_of_hands_branches_and_collisions():
    timeline = timeline_of(addons=[Map([[(1.0, -1.0), (1.0, 1.0)]])])
    assert marks(timeline) == {"collision": [], "hand": [], "branch": [], "error": []}
    run_to(timeline, 40)
    record = timeline.record
    touched = record.contacts["time"][record.contacts["began"]]
    assert len(touched) == 1
    timeline.go(30)
    timeline.change(lambda w: w.operator.place(1, (3.0, 3.0, 0.0)))
    rows = marks(timeline)
    assert rows["collision"] == [int(np.ceil(touched[0] / 0.5))]
    assert rows["hand"] == [30]
    assert rows["branch"] == [30]


def test_a_recording_has_the_marks_that_its_run_had():
    timeline = timeline_of(addons=[Map([[(1.0, -1.0), (1.0, 1.0)]])])
    run_to(timeline, 30)
    timeline.change(lambda w: w.operator.place(1, (3.0, 3.0, 0.0)))
    run_to(timeline, 40)
    ran = marks(timeline)
    player = Player(Playback(timeline.record), 1.0)
    player.go(20)
    bar = TimeBar(player, player.source)
    found = bar.marks()
    assert {kind: [*rows] for kind, rows in found.items()} == {kind: [*ran[kind]] for kind in found}
    assert found["collision"]
    assert found["hand"] == [30]
    assert (bar.extent, player.past) == (len(timeline.record) - 1, False)
    assert player.status() == ("paused", "waiting"), "a recording has no present to be behind"


def test_the_row_at_which_a_law_failed_is_marked():
    def law(robot):
        return 0.2 / (robot.time < 5), 0.0

    timeline = timeline_of(law=law)
    with pytest.raises(LawError):
        run_to(timeline, 40)
    assert marks(timeline)["error"] == [10]
