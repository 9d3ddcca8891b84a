"""Games that people play: roles, the countdown, the end."""

import numpy as np
import pytest

from mars2d.scenario.experiment import open_experiment
from mars2d.window.run.play import COUNTDOWN
from mars2d.window.run.window import Window
from mars2d.world.timeline import Timeline
from tests.cases import each_case

CATCH = """
from mars2d import Holonomic, Robot, Scenario, load_law
from mars2d.addons import Game


def scenario(pursuer="hunts.py", stop_time=60.0):
    fast = Robot(name="red", pose=(-1, 0, 0), drive=Holonomic(max_linear_speed=1.0))
    slow = Robot(name="blue", pose=(1, 0, 0), drive=Holonomic(max_linear_speed=0.5))
    return Scenario(
        title="Catch",
        robots=[fast.replace(controller=load_law(pursuer), sees="positions"), slow],
        on_exit="wall",
        stop_time=stop_time,
        addons=[Game({"pursuer": ["red"], "evader": ["blue"]})],
    )
"""
HUNTS = "def control(robot):\n    return 5 * (robot.neighbours[0].position - robot.position)\n"
RESTS = "def control(robot):\n    return 0.0, 0.0\n"


@pytest.fixture
def catch(tmp_path):
    """Return a game's file: red catches blue after two seconds, where nobody drives."""
    (tmp_path / "hunts.py").write_text(HUNTS)
    (tmp_path / "rests.py").write_text(RESTS)
    path = tmp_path / "catch.py"
    path.write_text(CATCH)
    return path


def opened(source, people=(), **options):
    window = Window(Timeline(open_experiment(source, options)), 1.0)
    window.play(people)
    return window


def run_to_the_end(window):
    """Let the countdown and the game go by, without a clock."""
    for _ in range(40):
        window.game.pass_time(0.1)
    assert window.player.playing
    timeline = window.director.timeline
    while not timeline.over:
        window.director.steer(0.1)
        timeline.advance()
    window.player.settle()
    assert window.game.pass_time(0.1)


# -- the end of a game ----------------------------------------------------------------------------


def test_after_a_replay_the_next_start_is_drawn_from_the_next_seed():
    window = opened("round_a_pillar", [1], mu=2.0)
    run_to_the_end(window)
    window.player.pause_or_resume()  # watches it again
    while window.player.playing:
        window.game.pass_time(0.1)
        window.player.pass_time(0.1)
    window.game.pass_time(0.1)
    assert window.game.result is not None
    first = window.player.frame.scenario.initial_pose
    assert window.game.choose(0)
    assert window.director.timeline.experiment.seed == 1
    assert (window.player.frame.scenario.initial_pose != first).any()
    assert [seat.role for seat in window.game.seats] == ["evader"]


def test_a_file_that_is_broken_meanwhile_is_said_and_the_game_stays(catch):
    window = opened(catch, [1])
    run_to_the_end(window)
    catch.write_text("scenario = Scen(")
    assert window.game.choose(0)
    assert "catch.py, line 1" in [note.text for note in window.notes._notes][-1]
    assert window.director.timeline.over


def test_who_wins_plays_faster_and_who_loses_no_slower_than_at_first(catch):
    window = opened(catch, [1], pursuer="rests.py", stop_time=3.0)
    for games, speed in ((1, 1.25), (2, 1.5625)):
        assert (window.game.counting, window.player.playing) == (COUNTDOWN, False)
        run_to_the_end(window)
        assert window.game.result.words == "You win"
        assert window.game.tally == {"evader": [True] * games}
        window._restart()
        assert window.player.speed == speed
    window = opened(catch, [1])
    run_to_the_end(window)
    window._restart()
    assert window.player.speed == 1.0


@each_case(
    ("game", "robot", "keys", "distance"),
    [
        ("escort", 1, "↑←↓→", (0, 2)),  # the guard sees how near the hunter is to the prey
        ("two_cars", 1, "←→", (0, 1)),
    ],
)
def test_a_person_sees_the_keys_that_work_and_the_distance_that_counts(game, robot, keys, distance):
    play = opened(game, [robot]).game
    assert "".join(play.seats[0].keys) == keys
    frame = play._player.frame
    apart = np.hypot(*np.diff(frame.pose[:2, distance], axis=1)[:, 0])
    assert play.distance(frame) == pytest.approx(apart)


def test_a_game_that_hands_have_changed_does_not_count(catch):
    window = opened(catch, [1])
    window.director.change(lambda world: world.operator.place("red", (-2, 1, 0)))
    run_to_the_end(window)
    assert window.game.result is not None
    assert window.game.tally == {}


def test_two_people_have_keys_of_their_own(catch):
    window = opened(catch, [1, 0])  # the hunter's person does nothing
    assert [seat.role for seat in window.game.seats] == ["evader", "pursuer"]
    assert [seat.keys[0] for seat in window.game.seats] == ["↑", "W"]
    run_to_the_end(window)
    assert window.game.result.words == "Evader wins"
    assert window.game.tally == {"evader": [True], "pursuer": [False]}


def test_a_law_that_fails_ends_no_game(catch):
    (catch.parent / "hunts.py").write_text("def control(robot):\n    return 1 / robot.time, 0\n")
    window = opened(catch, [1])
    for _ in range(40):
        window.game.pass_time(0.1)
    window.player.pass_time(0.2)
    assert window.player.failed
    assert not window.game.pass_time(0.1)
    assert window.game.result is None


def test_a_draw_is_said():
    window = opened("sumo", [0, 1], stop_time=0.1)
    run_to_the_end(window)
    assert window.game.result.words == "A draw"


# -- what is seen ---------------------------------------------------------------------------------


def test_the_panel_says_how_it_stands():
    game = opened("corner_game", [1]).game
    assert game.played_by("pursuer") == "ahead"
    assert game.played_by("evader") == "you"
    assert game.score() == {}  # with one robot each it says nothing
    assert [(each.number, each.title) for each in game.choices] == [
        (1, "pursuer"), (2, "evader"), (3, "two people"),
    ]  # fmt: skip


def test_teams_have_scores(tmp_path):
    file = tmp_path / "teams.py"
    file.write_text(
        "from mars2d import Robot, Scenario\n"
        "from mars2d.addons import Game\n"
        "places = [('a', -2), ('b', -1.4), ('c', 2)]\n"
        "robots = [Robot(name=n, pose=(x, 0, 0)) for n, x in places]\n"
        "game = Game({'wolf': ['a'], 'sheep': ['b', 'c']}, capture=1.0)\n"
        "scenario = Scenario(robots=robots, addons=[game])\n"
    )
    window = opened(file, [0])
    assert window.game.score() == {"wolf": "1 caught", "sheep": "1 free"}
    assert window.game.distance(window.player.frame) == pytest.approx(4.0)  # who is out is not near


# -- in a window --------------------------------------------------------------------------------


@pytest.fixture
def play(open_window):
    """Return a function that opens a window with a game."""

    def start(speed, source, people=(), **options):
        return open_window(speed, experiment=str(source), people=people, **options)

    return start


@each_case("way", ["number", "click"])
def test_a_role_is_chosen_counted_down_and_driven(play, way):
    person = play(1.0, "corner_game")
    assert person.state["game"]["seats"] == []
    person.press("space", "n", "d", "e")  # keys are the menu's: they begin and open nothing
    state = person.settle()
    assert (state["time"], state["dark"], state["editor"]) == (0, False, None)
    assert state["chosen"] == "evader"
    if way == "number":
        person.press("2")
    else:
        person.do("mousemove", *person.state["menu"]["evader"], "click", 1)
    person.until(lambda s: s["game"]["seats"] == [1] and s["game"]["counting"])
    assert ("↑ ← ↓ →", "evader") in person.shown._hints, "also where the panel has no room"
    assert person.state["time"] == 0
    person.until(lambda s: not s["game"]["counting"] and s["time"] > 0)
    before = person.state["robots"][1]
    person.do("keydown", "Right")
    person.until(lambda s: s["robots"][1][0] > before[0] + 0.3)
    person.do("keyup", "Right")
    person.press("ctrl+z")  # who plays goes on playing
    person.until(lambda s: s["game"]["counting"] and s["driving"] == 1)


def test_space_starts_at_once_and_escape_pauses(play):
    person = play(1.0, "corner_game", [1])
    person.press("space")
    person.until(lambda s: s["time"] > 0)
    person.press("Escape")
    person.says("paused: Space goes on")
    person.press("space")
    person.until(lambda s: s["playing"])
    person.press("Escape")
    person.until(lambda s: not s["playing"])
    person.press("Escape")
    person.says("Ctrl Q closes the window")


def test_in_the_end_r_plays_again_and_a_number_another_role(play, catch):
    person = play(5.0, catch, [1])
    person.press("space")
    person.until(lambda s: s["game"]["result"] == "You lose")
    assert "R" in person.state["banner"] or "pursuer wins" in person.state["banner"]
    person.press("r")
    person.until(lambda s: s["game"]["counting"] and s["time"] == 0)
    person.press("space")
    person.until(lambda s: s["game"]["result"] == "You lose")
    person.press("1")  # the other role
    person.until(lambda s: s["game"]["seats"] == [0] and s["time"] == 0)
