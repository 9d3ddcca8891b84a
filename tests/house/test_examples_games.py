"""The examples in which things are shoved, towed, wrestled with and squeezed through a door."""

import numpy as np
import pytest

import mars2d
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_module

pytestmark = [pytest.mark.slow, pytest.mark.nightly]

PURSUERS, EVADERS = ("straight", "ahead", "inside"), ("away", "corners", "round")


def bout(red, blue, seed=0):
    """Let two players wrestle and return who wins, or "a draw"."""
    laws = {"red": f"players/{red}.py", "blue": f"players/{blue}.py"}
    return mars2d.run("sumo", seed=seed, options=laws).over_message.partition(" wins")[0]


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


# -- corner_game --------------------------------------------------------------------------------


def hunt(pursuer, evader, mu, seed=0, **options):
    """Let two laws play corner_game; return the outcome and the record."""
    laws = {"pursuer": f"pursuers/{pursuer}.py", "evader": f"evaders/{evader}.py"}
    record = mars2d.run("corner_game", seed=seed, options={**laws, "mu": mu, **options})
    return record.scenario.addons[0].outcome(record), record


def claimed():
    """What the example says it measured: captures of 10 by pursuer, evader, at each mu."""
    doc = (open_module(examples()["corner_game"]).__doc__ or "").splitlines()
    rows = {
        line.split()[0]: [int(n) for n in line.split()[1:]] for line in doc if line[-2:] == "10"
    }
    assert set(rows) == set(PURSUERS)
    return {(p, e): n[5 * k : 5 * k + 5] for p, n in rows.items() for k, e in enumerate(EVADERS)}


def test_all_matches_of_the_corner_game_end_as_the_example_says():
    for (pursuer, evader), counts in claimed().items():
        for mu, count in zip([0.8, 0.85, 0.9, 0.95, 1.0], counts, strict=True):
            played = [len(hunt(pursuer, evader, mu, seed)[0].captures) for seed in range(10)]
            assert sum(played) == count, (pursuer, evader, mu)


def test_starts_of_the_corner_game_are_drawn_from_the_seed_apart_from_each_other():
    starts = [mars2d.run("corner_game", 0, seed=seed).pose[0, :2] for seed in (*range(30), 7)]
    assert min(np.hypot(*(at[:, 0] - at[:, 1])) for at in starts) > 4.0
    assert np.abs(starts).max() <= 4.0
    assert len({at.tobytes() for at in starts}) == 30
    assert (starts[7] == starts[-1]).all()


def test_no_law_of_the_corner_game_goes_faster_than_the_rules_allow(tmp_path):
    cheat = tmp_path / "cheat.py"
    cheat.write_text("def control(robot):\n    return 1e6, 1e6\n")
    laws = {"pursuer": str(cheat), "evader": str(cheat)}
    record = mars2d.run("corner_game", 20, options={**laws, "mu": 0.8})
    speed = np.hypot(*np.diff(record.pose[:, :2], axis=0).transpose(1, 0, 2)) / 0.1
    assert speed[:20].max(axis=0) == pytest.approx([0.4, 0.5])
    assert np.abs(record.pose[:, :2]).max() < 5.0  # the walls hold them
