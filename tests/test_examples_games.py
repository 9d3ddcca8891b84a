"""The examples in which things are shoved, towed, wrestled with and squeezed through a door."""

import dataclasses
import json
import re

import numpy as np
import pytest

import mars2d
from mars2d.cli import main
from mars2d.files import examples, open_experiment
from mars2d.session import run

PLAYERS = ("pusher", "flanker", "dodger")


def play(name, seed=0, **options):
    """Run an example; return its record and its predictions by name."""
    record = run(name, seed=seed, options=options)
    found = open_experiment(name, options).predictions(record)
    return record, {prediction.name: prediction for prediction in found}


def bout(red, blue, seed=0):
    """Let two players wrestle and return who wins, or "a draw"."""
    laws = {"red": f"sumo_players/{red}.py", "blue": f"sumo_players/{blue}.py"}
    return mars2d.run("sumo", seed=seed, options=laws).over_message.partition(" wins")[0]


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("shove_and_spin", {}),
        ("shove_and_spin", {"mu": 0.6, "lever": -0.1}),  # the discs' slip ends
        ("shove_and_spin", {"e": 1.0, "v": 0.4}),
        ("tug_of_war", {}),
        ("tug_of_war", {"blue": 6.3, "tow": 3.0}),
        ("sumo", {}),
        ("sumo", {"blue": "sumo_players/flanker.py"}),
        ("crowd", {}),
    ],
)
def test_a_game_agrees_with_its_predictions(name, options):
    _, predictions = play(name, **options)
    assert predictions
    assert [p for p in predictions.values() if not p.ok] == []


def test_a_blow_beside_the_middle_gives_less_speed_and_more_spin():
    record, _ = play("shove_and_spin")
    end = np.diff(record.prop_pose[-2:], axis=0)[0]
    assert end[0, 1] < end[0, 0]
    assert end[2, 1] > 0.0
    assert end[2, 0] == 0.0


@pytest.mark.parametrize(("blue", "winner"), [(5.0, "red"), (7.0, "blue")])
def test_the_stronger_team_wins_the_tug_of_war(blue, winner):
    record, _ = play("tug_of_war", blue=blue)
    assert record.over_message.startswith(f"{winner} wins")


def test_equal_teams_stand_still():
    record, predictions = play("tug_of_war", blue=6.0)
    assert predictions["end of the game"].ok
    assert np.abs(record.pose[-1, :, :3] - record.pose[0, :, :3]).max() < 1e-3


def test_no_player_beats_all_others():
    wins = {}
    for one, other in (("pusher", "flanker"), ("flanker", "dodger"), ("dodger", "pusher")):
        first = [bout(one, other, seed) for seed in range(8)]
        second = [bout(other, one, seed) for seed in range(8)]
        wins[one, other] = first.count("red") + second.count("blue")
        wins[other, one] = first.count("blue") + second.count("red")
    assert wins["pusher", "flanker"] > wins["flanker", "pusher"]
    assert wins["flanker", "dodger"] > wins["dodger", "flanker"]
    assert min(wins["dodger", "pusher"], wins["pusher", "dodger"]) >= 2


def test_luck_plays_a_part_and_a_seed_repeats_it():
    outcomes = {bout("pusher", "dodger", seed) for seed in range(12)}
    assert outcomes == {"red", "blue"}
    assert len({mars2d.run("sumo", seed=3).digest for _ in range(2)}) == 1


def test_equal_pushers_end_in_a_draw():
    assert bout("pusher", "pusher") == "a draw"


def test_a_class_plays_with_laws_from_the_current_folder(tmp_path, monkeypatch, capsys):
    (tmp_path / "coward.py").write_text("def control(robot):\n    return -1.0, 0.0\n")
    monkeypatch.chdir(tmp_path)
    assert main(["run", "sumo", "--headless", "--json", "--set", "red=coward.py"]) == 0
    outcome = json.loads(capsys.readouterr().out)
    assert re.match(r"blue wins: the other has left the ring after 0\.7\d s", outcome["message"])
    assert all(check["ok"] for check in outcome["checks"])


def test_a_player_that_is_not_there_is_named(capsys):
    assert main(["run", "sumo", "--headless", "--set", "red=sumo_players/pushr.py"]) == 2
    assert "pusher" in capsys.readouterr().err


def test_players_lie_beside_the_examples_and_are_none():
    folder = examples()["sumo"].parent / "sumo_players"
    assert {file.stem for file in folder.glob("*.py")} == set(PLAYERS)
    assert not set(PLAYERS) & set(examples())
    for file in folder.glob("*.py"):
        lines = file.read_text().splitlines()
        assert lines[0].startswith('"""')
        assert len(lines) <= 30


def test_the_crowds_checks_see_who_overlaps_or_comes_through_a_wall():
    record, _ = play("crowd", stop_time=12.0)
    experiment = open_experiment("crowd", {"stop_time": 12.0})
    pose = record.pose.copy()
    pose[-1, :2, 49] = pose[-1, :2, 48] + [0.298, 0.0]
    pose[-1, :2, 0] = 5.0, 2.0  # in the hall, from nowhere
    pose[-2, :2, 0] = -0.5, 2.0
    wrong = experiment.predictions(dataclasses.replace(record, pose=pose))
    assert {"deepest overlap", "robots in the hall"} <= {p.name for p in wrong if not p.ok}
