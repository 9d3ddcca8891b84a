"""The rules of a game in words."""

from mars2d import Robot, Scenario
from mars2d.addons import Game
from tests.cases import each_case
from tests.tournaments.leagues import rules_of


def test_rules_are_those_of_the_games_file():
    rules = rules_of("corner_game", mu=0.8)
    hunter, evader = rules.roles["pursuer"], rules.roles["evader"]
    assert rules.game == "corner_game"
    assert rules.story.startswith("Corner pursuit as a game")
    assert (hunter.aim, evader.aim) == ("catch blue", "stay free for 200 s")
    assert (hunter.colors, evader.colors) == (("#d62728",), ("#1f77b4",))
    assert hunter.facts == {
        "Robots": "red",
        "Drive": "Holonomic, at most 0.4 m/s",
        "A law returns": "(vx [m/s], vy [m/s])",
        "It sees": "its own pose and velocity, and the positions of its neighbours",
    }
    facts = rules.facts
    assert facts["What is counted"].startswith("A capture is when the pursuer touches the evader.")
    assert facts["Arena"].startswith("x from -5 m to 5 m")
    assert "Walls stand round it." in facts["Arena"]
    assert facts["Time"] == "200 s at most; a law is asked every 0.1 s."


@each_case(
    "fields, hunter, evader, counted",
    [
        ({}, "catch b and c", "stay free for 100 s", "touches one of 2. Who is caught stands"),
        ({"capture": 0.4}, "catch b and c", "stay free for 100 s", "comes within 0.4 m of one of"),
        ({"capture": "sight"}, "see b and c", "stay out of sight", "sees one of 2, with no obst"),
        ({"wanted": 1}, "catch 1 of 2", "stay free", "wolf wins with the capture. If time"),
        (
            {"goal": [(4, 4), (5, 4), (5, 5)]},
            "catch b and c before 1 of 2 is in the goal",
            "reach the goal uncaught",
            "The sheep wins when 1 of 2 is in the goal uncaught. If time runs out before, the wolf",
        ),
    ],
)
def test_a_pursuit_says_what_is_counted(fields, hunter, evader, counted):
    robots = [Robot(name=name, pose=(k, 0, 0)) for k, name in enumerate("abc")]
    game = Game({"wolf": ["a"], "sheep": ["b", "c"]}, **fields)
    scenario = Scenario(robots=robots, addons=[game])
    assert game.aim("wolf", scenario) == hunter
    assert game.aim("sheep", scenario).startswith(evader)
    assert counted in game.counts
