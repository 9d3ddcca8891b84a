"""Workers that die: their task alone is lost, and said to be."""

from __future__ import annotations

import sys

import pytest

import mars2d

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX"),
]

STUDY = """
import os, signal
from mars2d import Scenario

scenario = Scenario(stop_time=2)

def end(record):
    if record.seed == 2:
        os.kill(os.getpid(), signal.SIGKILL)
    return record.time[-1]
"""

GAME = """
import os, signal
from mars2d import Addon, Robot, Scenario, load_law
from mars2d.addons import Game

class Deadly(Addon):
    def on_step(self, world):
        if world.seed == 1 and world.iteration == 5:
            os.kill(os.getpid(), signal.SIGKILL)

def scenario(pursuer="one.py", evader="two.py"):
    red = Robot(name="red", pose=(-2, 0, 0), controller=load_law(pursuer))
    blue = Robot(name="blue", pose=(2, 0, 0), controller=load_law(evader))
    game = Game({"pursuer": ["red"], "evader": ["blue"]})
    return Scenario(robots=[red, blue], stop_time=1, addons=[game, Deadly()])
"""


def test_a_worker_that_dies_costs_a_study_one_row(tmp_path, monkeypatch) -> None:
    (tmp_path / "study.py").write_text(STUDY)
    monkeypatch.chdir(tmp_path)
    table = mars2d.sweep("study.py", seeds=4, measures="end", workers=2, out="rows.csv")
    errors = [result.error for result in table.results]
    assert [bool(error) for error in errors] == [False, False, True, False]
    assert "the process that ran it ended" in errors[2]
    assert [result.measures.get("end") for result in table.results] == [2.0, 2.0, None, 2.0]


@pytest.mark.nightly
def test_a_worker_that_dies_costs_a_tournament_one_match(tmp_path, monkeypatch) -> None:
    (tmp_path / "game.py").write_text(GAME)
    for name in ("one.py", "two.py"):
        (tmp_path / name).write_text("def control(robot):\n    return 0.1, 0.1\n")
    monkeypatch.chdir(tmp_path)
    result = mars2d.tournament(
        "game.py", {"pursuer": "one.py", "evader": "two.py"}, seeds=3, workers=2, out="league"
    )
    assert [bool(played.error) for played in result.matches] == [False, True, False]
    assert "the process that ran it ended" in result.matches[1].error
    assert not any(played.verdicts for played in result.matches)
