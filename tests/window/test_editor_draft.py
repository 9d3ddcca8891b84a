"""What is drawn in the editor, without a window."""

from math import pi
from pathlib import Path

import pygame
import pytest

from mars2d.addons import Addon, Beacon, Estimate, Game, Map, Voronoi, Waypoints
from mars2d.bodies.joints import Hinge, Rope
from mars2d.bodies.props import Ball, Box
from mars2d.core.errors import InputError
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.layout import Layout
from mars2d.scenario.controllers import FollowRobot
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.random_starts import RandomStarts
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.window.editor import Editor
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.draft import Draft, Item, Motion
from mars2d.window.editor.grips import spanned
from mars2d.window.screen.looks import Looks
from mars2d.window.screen.viewpoint import Viewpoint
from mars2d.window.widgets.actions import action_of
from tests.cases import each_case

pytestmark = pytest.mark.usefixtures("keyboard")

SQUARE = ((1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0))


def furnished():
    return Scenario(
        robots=[Robot(pose=(-3, 0, 0)), Robot(pose=(-3, 2, 0), name="second")],
        props=[Box(pose=(0, -2, 0)), Ball(pose=(0, -3, 0))],
        joints=[Rope(a="second", b="box0", length=6)],
        addons=[
            Voronoi(),
            Map([SQUARE], walls=[[(3, 3), (4, 3), (4, 4)]], name="furniture", friction=0.3),
            Waypoints([[], [(-3, 3), (-2, 3)]], tolerance=0.2),
            Beacon((4, -4)),
        ],
    )


def renamed(draft, robot, name):
    return draft.with_parts([Item("robot", robot)], lambda part: part.replace(name=name))


def test_a_draft_keeps_the_order_and_the_fields_of_add_ons():
    scenario = furnished()
    draft = Draft(scenario).added({Item("outline"): ((-1, -1), (0, -1), (0, 0))})
    changed = draft.base.replace()
    assert [addon.key for addon in changed.addons] == [addon.key for addon in scenario.addons]
    chart = changed.addons[1]
    assert (chart.friction, len(chart.outlines), chart.walls) == (0.3, 2, scenario.addons[1].walls)
    assert changed.addons[2].tolerance == 0.2
    bare = draft.without([i for i in draft.items() if i.kind not in ("robot", "prop")])
    assert [addon.key for addon in bare.base.replace().addons] == ["voronoi"]


def test_with_a_robot_go_its_route_and_its_joints():
    draft = Draft(furnished()).without([Item("robot", 1)])
    scenario = draft.base.replace()
    assert scenario.joints == ()
    assert renamed(draft.added({Item("robot"): Robot()}), 1, "second").base.joints == ()
    assert not any(isinstance(addon, Waypoints) for addon in scenario.addons)
    first = Draft(furnished()).without([Item("robot", 0)])
    (route,) = first.listed["route"]
    assert route == ((-3, 3), (-2, 3))  # robot 1 is robot 0 now, and so is its route


def test_new_things_get_names_that_are_free():
    before = Draft(furnished())
    models = {Item("robot"): Robot(), Item("prop"): Box(), Item("beacon"): Beacon((0, 0))}
    draft = before.added(models)
    names = [draft.name(item) for item in draft.new_since(before)]
    assert names == ["box1", "robot1", "beacon0"]


def tied(*joints):
    """Return the draft of two boxes, one at (0, 0), the other at (2, 0), and of a robot."""
    boxes = [Box(pose=(0, 0, 0)), Box(pose=(2, 0, pi / 2))]
    return Draft(Scenario(robots=[Robot(pose=(-3, 3, 0))], props=boxes, joints=joints))


def test_copies_are_tied_as_their_models_are():
    draft = tied(Rope(a="box0", b="box1"), Rope(a="box1", anchor_b=(2, 3)))
    both = draft.copied([Item("prop", 0), Item("prop", 1)], Motion(by=(0.0, -3.0)))
    assert [(j.a, j.b, j.anchor_b) for j in both.base.joints[2:]] == [
        ("box2", "box3", (0, 0)),
        ("box3", None, (2, 0)),
    ]
    assert both.verdict.text == ""
    one = draft.copied([Item("prop", 0)], Motion(by=(0.0, -3.0)))
    assert len(one.base.joints) == 2
    copy = Draft(furnished()).copied([Item("route", 1), Item("robot", 1)], Motion(by=(0.0, 1.0)))
    assert copy.listed["route"] == ((), ((-3, 3), (-2, 3)), ((-3, 4), (-2, 4)))


def test_the_pin_of_a_hinge_stays_one_point_when_a_body_moves():
    hinges = Hinge(a="box0", b="box1", anchor_a=(1, 0), anchor_b=(0, 1)), Hinge(a="box0")
    draft = tied(*hinges).moved([Item("prop", 1)], Motion(pi / 2, (2.0, 0.0), (0.0, 0.5)))
    assert draft.base.joints[0].anchor_b == (0, 1)
    assert draft.base.joints[0].anchor_a == pytest.approx((2, -0.5))
    assert draft.verdict.text == ""
    both = draft.moved([Item("prop", 0), Item("prop", 1)], Motion(by=(0.0, 1.0)))
    assert both.base.joints[1].anchor_b == (0, 1)
    assert both.verdict.text == ""


def test_a_body_that_is_moved_starts_there_and_no_longer_at_random():
    robots = [Robot(name="red"), Robot(name="blue")]
    draft = Draft(Scenario(robots=robots, random_starts=[RandomStarts()]))
    red, blue = Item("robot", 0), Item("robot", 1)
    x, y = draft.place(red)
    moved = draft.moved([red], Motion(by=(3 - x, 3 - y)))
    assert (draft.starts_at_random(red), moved.starts_at_random(red)) == (True, False)
    assert moved.base.replace().started(seed=9).robots[0].pose[:2] == (3, 3)
    assert moved.base.replace().started(seed=9).robots[1].pose != moved.base.robots[1].pose
    assert moved.without([blue]).base.replace().random_starts == ()
    assert not draft.added({Item("joint"): Rope(a="red", b="blue")}).starts_at_random(red)


def test_a_new_name_holds_wherever_the_body_is_mentioned():
    follow = Robot(pose=(-3, -4, 0), controller=FollowRobot(leader="robot0"))
    mentions = [
        Game({"robot0": ["robot0"], "hunted": ["second", 2]}, hunted=["second"]),
        Estimate(robot="robot0"),
    ]
    scenario = furnished()
    scenario = scenario.replace(
        robots=[*scenario.robots, follow],
        addons=[*scenario.addons, *mentions],
        random_starts=[RandomStarts(["robot0"])],
        stop_on=[("robot0", "box0")],
    )
    draft = Draft(scenario)
    draft = renamed(renamed(draft, 0, "Ada"), 1, "Bo")
    assert [robot.name for robot in draft.base.robots] == ["Ada", "Bo", "robot2"]
    assert draft.base.robots[2].controller.leader == "Ada"
    assert draft.base.joints[0].a == "Bo"
    found = draft.base.replace()
    game, estimate = found.addons[-2:]
    assert game.roles == (("robot0", ("Ada",)), ("hunted", ("Bo", 2)))
    assert (game.hunted, estimate.robot) == (("Bo",), "Ada")
    assert (found.random_starts[0].bodies, found.stop_on) == (("Ada",), (("Ada", "box0"),))
    with pytest.raises(InputError, match="'Bo' is the name of another body"):
        renamed(draft, 0, "Bo")


def test_things_turn_about_a_point_and_come_back():
    draft = Draft(furnished())
    items = draft.items()
    quarter = Motion(pi / 2, (1.0, 2.0), (0.5, -0.5))
    turned = draft.moved(items, quarter)
    assert turned.base.robots[0].pose == pytest.approx((3.5, -2.5, pi / 2))
    assert turned.listed["outline"][0][0] == pytest.approx((2.5, 1.5))
    back = turned.moved(items, Motion(by=(-0.5, 0.5))).moved(items, Motion(-pi / 2, (1.0, 2.0)))
    assert back.base.replace() == draft.base.replace()


# -- faults ---------------------------------------------------------------------------------------


@each_case(
    "by, words, other",
    [
        ((0.0, 1.8), "robot0 and second overlap by 0.1 m", Item("robot", 1)),
        ((-5.0, 0.0), "robot0 starts outside the workspace", None),
        ((4.5, 1.5), "robot0 starts inside obstacle 0; if it is a room,", Item("outline", 0)),
        ((6.5, 2.9), "robot0 starts in contact with wall 0", Item("wall", 0)),
        ((3.0, -2.0), "robot0 and box0 overlap by ", Item("prop", 0)),
    ],
)
def test_a_robot_that_can_not_stand_where_it_is(by, words, other):
    draft = Draft(furnished()).moved([Item("robot", 0)], Motion(by=by))
    scenario, text, culprits = draft.verdict
    assert scenario is None
    assert text.startswith(words)
    assert culprits == {Item("robot", 0), other or Item("robot", 0)}


def test_outlines_that_are_none():
    words = r"obstacle 1: the polygon crosses or touches itself at \(0.5, 0.5\)"
    with pytest.raises(InputError, match=words):
        Draft(furnished()).added({Item("outline"): [(0, 0), (1, 1), (1, 0), (0, 1)]})


# -- history, sketch, targets, prompts -------------------------------------------------------------


def seen_by(camera):
    viewpoint = Viewpoint(furnished(), Layout.of((1280, 720)))
    viewpoint.camera = camera
    return Desk(Draft(furnished()), viewpoint)


def test_what_lies_uppermost_is_hit():
    desk = seen_by(Camera(50.0, 400.0, 300.0))
    for point, item in {
        (-3.0, 0.1): Item("robot", 0),
        (0.1, -2.1): Item("prop", 0),
        (1.5, 1.5): Item("outline", 0),
        (3.5, 3.05): Item("wall", 0),
        (-2.05, 3.05): Item("route", 1),
        (4.1, -4.0): Item("beacon", 0),
        (0.0, 4.0): None,
    }.items():
        assert desk.item_at(point) == item
    found = desk.items_within((-4.0, 4.0), (-1.5, -1.0))
    assert found == [Item("robot", 0), Item("robot", 1), Item("route", 1)]


def test_the_grid_follows_the_zoom_and_points_are_tidy():
    desk = seen_by(Camera(50.0, 400.0, 300.0))
    assert desk.step == 0.2
    assert desk.snapped((0.31, -0.29)) == (0.4, -0.2)
    assert desk.snapped((0.6000001, 1e-9)) == (0.6, 0.0)
    desk.snaps = False
    assert desk.snapped((0.3141592, -0.2718281)) == (0.31, -0.27)
    desk.viewpoint.camera = Camera(5000.0, 0.0, 0.0)
    desk.snaps = True
    assert desk.step == 0.002


def test_a_box_spans_two_corners_whichever_way():
    for end in ((2, 1), (-2, 1), (-2, -1), (2, -1)):
        box = spanned(Box(pose=(9, 9, pi / 2)), (0.0, 0.0), end)
        assert (box.length, box.width) == (1, 2)
        assert box.pose == pytest.approx((end[0] / 2, end[1] / 2, pi / 2))


def test_a_file_gets_a_name_that_is_free_and_never_that_of_a_py(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "walk.toml").write_text("")
    for given, path, proposal, new in (
        (Path("walk.py"), None, "walk_2.toml", True),
        (Path("walk.toml"), Path("walk.toml"), "walk_2.toml", False),
        (Path("room.toml"), Path("room.toml"), "room.toml", True),
        (None, None, "scenario.toml", True),
    ):
        dialogs = Editor(Scenario(robots=1), Looks(), path=given).dialogs
        assert (dialogs.path, dialogs.proposal, dialogs.new) == (path, proposal, new)
        if given == Path("room.toml"):
            given.write_text("somebody else's")
            dialogs.save()
            assert dialogs.prompt.label == "room.toml is there already."
            assert given.read_text() == "somebody else's"


# -- the editor on a surface ----------------------------------------------------------------------


@each_case("name", sorted(examples()))
def test_a_draft_of_an_example_is_that_scenario_again_and_can_be_emptied(name):
    scenario = open_experiment(name).scenario
    draft = Draft(scenario)
    assert draft.base.replace() == scenario
    assert draft.verdict.text == ""
    editor = Editor(scenario, Looks(), live=True)
    surface = pygame.Surface((320, 240), 0, 32)
    editor.draw(surface)
    assert editor.desk.notice == ""
    editor.desk.put(editor.desk.draft.without(editor.desk.draft.items()))
    editor.draw(surface)
    assert "no robot" in editor.desk.settled.verdict.text


def test_what_can_not_be_drawn_can_be_edited():
    broken = type("Broken", (Addon,), {"draw": None})
    editor = Editor(Scenario(addons=[broken()]), Looks())
    for _ in range(2):
        editor.draw(pygame.Surface((320, 240), 0, 32))
        assert "Add-ons are not drawn: " in editor.desk.notice


def test_the_keys_in_the_document_and_the_help_are_those_that_work():
    text = (Path(__file__).parents[2] / "docs" / "editor.md").read_text(encoding="utf-8")
    told = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ")]
    listed = []
    for live in (False, True):
        editor = Editor(Scenario(), Looks(), live=live)
        actions = [action for group in editor.groups.values() for action in group]
        listed += [[" ".join(action.labels), action.help] for action in actions]
        labels = [label for action in actions for label in (*action.labels, *action.also)]
        assert len(labels) == len(set(labels))
    rows = told[told.index(["Key", "What it does"]) + 1 :]
    unique = [list(row) for row in dict.fromkeys(map(tuple, listed))]
    assert sorted(rows[: len(unique)]) == sorted(unique)


def test_a_sign_is_the_key_that_types_it():
    shift = {"key": pygame.K_0, "unicode": "=", "mod": pygame.KMOD_SHIFT}  # a German keyboard
    event = pygame.Event(pygame.KEYDOWN, shift)
    groups = Editor(Scenario(), Looks()).groups
    found = action_of(event, [action for group in groups.values() for action in group])
    assert found.name == "pose"
