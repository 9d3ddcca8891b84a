"""The panel of the editor: laws, drives, masses, colours, sensors and joints, by the mouse."""

import mars2d
from mars2d.bodies.joints import Rope
from mars2d.bodies.props import Box
from mars2d.scenario.controllers import Wander
from mars2d.scenario.registry import members
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from tests.window.drawing import team

ROPED = team((0, 0), (2, 0)).replace(joints=[Rope(a="robot0", b="robot1")])


def chosen(open_editor, scenario, x=0, y=0, **options):
    """Open an editor, and select what lies at a point."""
    hands = open_editor(scenario, **options)
    hands.click(x, y)
    hands.until(lambda s: len(s["selection"]) == 1)
    return hands


# -- laws ------------------------------------------------------------------------------------------


def test_a_law_is_chosen_from_the_list_with_the_sensors_that_it_needs(open_editor):
    hands, kind = chosen(open_editor, team((0, 0))), members("controllers")["FollowWall"]
    assert hands.state["idle"] == {"0": "a law"}
    hands.row("Law")
    hands.entry(kind.title)
    hands.until(lambda s: s["laws"] == ["FollowWall()"] and s["idle"] == {})
    assert hands.state["sensors"] == [[repr(sensor) for sensor in kind.needs]]
    hands.press("ctrl+z")
    hands.until(lambda s: s["laws"] == [None] and s["sensors"] == [[]])


def test_a_robot_along_its_waypoints_gets_them_by_the_next_clicks_and_then_it_runs(
    open_editor, tmp_path
):
    hands = chosen(open_editor, team((0, 0), stop_time=60))
    hands.press("F2", "Return", *"along", "space", *"its", "Return")
    hands.until(lambda s: s["tool"] == "waypoint" and s["idle"] == {"0": "a waypoint"})
    hands.click(2, 0)
    hands.click(2, 2)
    hands.until(lambda s: s["routes"] == [[[2, 0], [2, 2]]] and s["idle"] == {})
    hands.press("ctrl+s")
    hands.until(lambda s: not s["changed"])
    record = mars2d.run(tmp_path / "given.toml")
    assert record.scenario.addons[0].passed(record.pose[:, :2].swapaxes(1, 2)) == (2,)


def test_the_robot_to_follow_is_chosen_by_its_name(open_editor):
    hands = chosen(open_editor, team((0, 0), (3, 0)))
    hands.row("Law")
    hands.entry("after another robot")
    hands.until(lambda s: set(s["menu"]) == {"not set", "robot1"})
    hands.entry("robot1")
    hands.until(lambda s: s["laws"][0] == "FollowRobot(leader='robot1')")


def test_a_law_comes_from_a_file_and_is_saved_by_its_name(open_editor, tmp_path):
    (tmp_path / "walk.py").write_text("def walk(robot):\n    return 0.1, 0.0\n")
    hands = chosen(open_editor, team((0, 0)))
    hands.row("Law")
    hands.entry("from a file …")
    hands.fill("walk.py:wolk")
    assert "has no law 'wolk'; did you mean 'walk'?" in hands.state["error"]
    hands.fill("walk.py:walk")
    hands.until(lambda s: s["laws"] == ["walk"])
    hands.press("ctrl+s")
    hands.until(lambda s: not s["changed"])
    assert 'controller = "walk.py:walk"' in (tmp_path / "given.toml").read_text()


def test_the_fields_of_a_law_are_typed_and_chosen(open_editor):
    robot = Robot(diameter=0.6, controller=Wander(), sensors=Wander.needs)
    hands = chosen(open_editor, Scenario(robots=[robot]))
    hands.row("Law")
    hands.entry("Turn")
    hands.fill("-1")
    assert "Wander.turn = -1: expected a number > 0" in hands.state["error"]
    hands.fill("2.5")
    hands.until(lambda s: s["laws"] == ["Wander(turn=2.5)"])
    hands.row("Law")
    hands.entry("none: it stands still")
    hands.until(lambda s: s["laws"] == [None] and s["idle"] == {"0": "a law"})


# -- bodies ----------------------------------------------------------------------------------------


def test_mass_friction_and_colour_of_several_bodies_are_set_at_once(open_editor):
    scenario = team((-1, 0), (1, 0)).replace(props=[Box(pose=(0, 3))])
    hands = open_editor(scenario)
    hands.press("ctrl+a")
    hands.until(lambda s: len(s["selection"]) == 3 and ["Mass", "several"] in s["rows"])
    hands.row("Mass")
    hands.fill("2.5")
    hands.row("Friction")
    hands.fill("rubber")
    hands.row("Color")
    hands.entry("green")
    hands.until(lambda s: [m[::2] for m in s["members"]] == [[2.5, "#009e73"]] * 3)
    assert ["Friction", "rubber"] in hands.state["rows"]
    assert ["Color", "green"] in hands.state["rows"]
    hands.row("Color")
    hands.entry("another …")
    hands.fill("#123456")
    hands.until(lambda s: [c for _, _, c in s["members"]] == ["#123456"] * 3)
    hands.row("Color")
    hands.entry("not set")
    hands.until(lambda s: [c for _, _, c in s["members"]] == [None] * 3)


def test_a_drive_is_chosen_and_keeps_what_both_have_and_arrows_are_the_menus(open_editor):
    hands = chosen(open_editor, team((0, 0)))
    hands.row("Drive")
    first = hands.until(lambda s: s["menu"])["chosen"]
    hands.press("Down", "Right", "Left")
    assert hands.until(lambda s: s["menu"] and s["chosen"] != first)["robots"][0][:2] == [0, 0]
    hands.press("Escape")
    for titles in (["Max linear speed", "0.8"], ["Car"], ["Wheelbase", "0.3"], ["Force limited"]):
        hands.row("Drive")
        hands.entry(titles[0])
        for text in titles[1:]:
            hands.fill(text)
    drive = "Car(max_linear_speed=0.8, force_limited=True, wheelbase=0.3)"
    hands.until(lambda s: s["drives"] == [drive])


def test_sensors_are_added_changed_and_removed(open_editor):
    hands = chosen(open_editor, team((0, 0)))
    hands.row("Sensors")
    hands.entry("RangeFinder")
    hands.row("Sensors")
    hands.entry("Proximity")
    hands.row("Sensors")
    hands.entry("Proximity")
    hands.until(lambda s: len(s["sensors"][0]) == 3 and "proximity2" in s["panel"])
    hands.row("range_finder")
    hands.entry("Beams")
    hands.fill("36")
    hands.until(lambda s: s["sensors"][0][0] == "RangeFinder(beams=36)")
    hands.row("proximity2")
    hands.entry("Remove it")
    hands.until(lambda s: len(s["sensors"][0]) == 2)


def test_joints_tie_a_body_to_another_or_to_the_floor(open_editor):
    hands, name = chosen(open_editor, team((0, 0), (2, 0))), "Hinge"
    for place in ((2, 0), (0, 2)):
        hands.row("Joints")
        hands.entry(name)
        hands.click(-4, -4)
        hands.until(lambda s: "expected a point within" in s["notice"] and s["tool"] == "tie")
        hands.click(*place)
        hands.until(lambda s: s["tool"] == "select")
    tied = [[name, "robot0", "robot1", [0, 0]], [name, "robot0", None, [0, 2]]]
    hands.until(lambda s: s["joints"] == tied and s["fault"] == "")
    hands.row(f"{name} to the floor")
    hands.entry("Remove it")
    hands.until(lambda s: s["joints"] == tied[:1])


def test_escape_lets_the_tie_go_and_a_joint_is_changed_in_its_menu(open_editor):
    hands = chosen(open_editor, ROPED)
    hands.row("Joints")
    hands.entry("Spring")
    hands.until(lambda s: s["tool"] == "tie")
    hands.press("Escape")
    hands.until(lambda s: s["tool"] == "select" and len(s["joints"]) == 1)
    hands.click(0, 0)
    hands.row("Rope to robot1")
    hands.entry("Length")
    hands.fill("3")
    hands.press("ctrl+s")
    hands.until(lambda s: not s["changed"])


# -- the scenario, and what stands still -----------------------------------------------------------


def test_without_a_selection_the_panel_shows_the_scenario_and_who_stands_still(open_editor):
    hands = open_editor(team((0, 0), (2, 0)))
    hands.row("Stop time")
    hands.fill("30")
    hands.row("On exit")
    hands.entry("wall")
    for title in ("none", "1e3"):  # text, whatever it looks like
        hands.row("Title")
        hands.fill(title)
    hands.until(lambda s: s["base"] == ["1e3", 30, "wall"])
    hands.row("robot1 lacks a law")
    hands.until(lambda s: s["selection"] == [["robot", 1]])


def test_what_nobody_gave_reads_as_what_it_is_and_can_be_taken_back(open_editor):
    box = Box(pose=(0, 0), length=0.2, width=0.2, height=0.01, material="wood")
    hands = chosen(open_editor, Scenario(robots=[Robot(pose=(3, 3, 0))], props=[box]))
    assert ["Mass", "automatic (0.24 kg)"] in hands.state["rows"]
    assert ["Moment", "automatic (0.0016 kg m^2)"] in hands.state["rows"]
    assert ["Static ground friction", "not set"] in hands.state["rows"]
    rows = hands.shown.properties.rows()
    assert all(len(row.title) + len(row.value) <= 25 for row in rows)
    hands.row("Mass")
    hands.fill("1.5")
    hands.until(lambda s: ["Mass", "1.5 kg"] in s["rows"])
    hands.row("Mass")
    hands.fill("none")
    hands.until(lambda s: ["Mass", "automatic (0.24 kg)"] in s["rows"])
    hands.row("Material")
    hands.entry("steel")
    hands.until(lambda s: ["Friction", "automatic (steel)"] in s["rows"])


def test_a_body_gets_another_name_which_its_joints_use(open_editor):
    hands = chosen(open_editor, ROPED)
    hands.row("Name")
    hands.fill("robot1")
    assert "'robot1' is the name of another body" in hands.state["error"]
    hands.fill("Ada")
    hands.until(lambda s: s["joints"][0][:3] == ["Rope", "Ada", "robot1"])
    assert ["Name", "Ada"] in hands.state["rows"]


def test_without_a_mouse_everything_is_placed_selected_and_changed(open_editor):
    hands = open_editor()
    hands.press("r")
    typed(hands, "1 2 90")
    hands.press("u")
    typed(hands, "-1 2")
    hands.press("Tab", "F2")
    hands.until(lambda s: s["focused"] and s["chosen"] == "Law")
    hands.press("Return")
    assert hands.state["chosen"] == "none: it stands still"
    hands.press("Home", "Return")
    hands.until(lambda s: s["laws"] == ["ByHand()"])
    hands.press("m", "a", "s", "Return")
    hands.fill("2")
    hands.until(lambda s: s["members"][0][0] == 2 and s["focused"])
    hands.press("Right")  # the panel's
    assert hands.state["robots"][0][0] == 1
    hands.press("Escape", "Right")
    hands.until(lambda s: s["robots"][0][0] > 1)
    hands.press("Tab", "F2")
    hands.until(lambda s: s["selection"] == [["prop", 0]] and s["chosen"] == "Joints")  # the first


def typed(hands, *places):
    """Type places, each into a prompt of its own."""
    for place in places:
        hands.press("equal")
        hands.until(lambda s: s["prompt"] is not None)
        hands.type(place)
        hands.press("Return")
        hands.until(lambda s: s["prompt"] is None)


def test_without_a_mouse_areas_are_drawn_their_corners_changed_and_bodies_tied(open_editor):
    hands = open_editor()
    hands.press("m", "F2", "End", "Return")
    hands.type("-4 4")
    hands.press("Return", "Escape", "ctrl+d", "Down")
    hands.until(lambda s: s["workspace"][3] == [-4, 4] and len(s["workspace"]) == 5)
    hands.press("Delete")
    hands.until(lambda s: len(s["workspace"]) == 4)
    hands.press("w")
    typed(hands, "-1.234 0", "2 0.5")
    hands.press("Return", "k")
    typed(hands, "2.5 -2.5")
    hands.until(lambda s: s["outlines"] == [[[2, -3], [3, -3], [3, -2], [2, -2]]])
    assert hands.state["walls"] == [[[-1.234, 0], [2, 0.5]]]
    hands.press("r")
    typed(hands, "0 1", "2 1")
    hands.press("Escape", "Tab", "Tab", "Tab", "shift+Tab")
    hands.until(lambda s: s["selection"] == [["robot", 0], ["robot", 1]])
    for place in ("0.123 2", "robot1"):
        hands.press("F2", "j", "Return", "r", "o", "p", "Return")
        hands.until(lambda s: s["tool"] == "tie")
        typed(hands, place)
        hands.press("Escape", "Tab", "Tab", "Tab")
    assert hands.state["joints"] == [
        ["Rope", "robot0", None, [0.123, 2]],
        ["Rope", "robot1", None, [0.123, 2]],
        ["Rope", "robot0", "robot1", [0, 0]],
    ]


def test_an_unchanged_number_stays_exact(open_editor):
    hands = chosen(open_editor, team((0, 0)))
    hands.row("Mass")
    hands.fill("0.12345678901234567")
    hands.row("Mass")
    hands.press("Return")
    assert hands.until(lambda s: s["prompt"] is None)["members"][0][0] == 0.12345678901234567
