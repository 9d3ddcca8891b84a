"""Tournaments with real laws in real processes."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
from dataclasses import replace
from itertools import product
from pathlib import Path
from textwrap import dedent
from types import SimpleNamespace

import pytest

import mars2d
from mars2d.cli import command_line as cli
from mars2d.core.errors import InputError
from mars2d.tournaments.folder import PLAYED, Folder, played_before
from mars2d.tournaments.isolation.limits import Limits
from mars2d.tournaments.schedule import schedule
from mars2d.tournaments.tournament import missing
from tests.cases import each_case
from tests.processes import PATIENCE, wait_until

CHASE = """
import numpy as np
from mars2d import Holonomic, Robot, Scenario, load_law
from mars2d.addons import Game

def scenario(pursuer: str = "pursuers/quick.py", evader: str = "evaders/still.py",
             speed: float = 1.0, broken: int = -1, seed: int = 0):
    if seed == broken:
        raise ValueError("no such start")
    x = np.random.default_rng(seed).uniform(1, 2)
    red = Robot(name="red", drive=Holonomic(max_linear_speed=speed), controller=load_law(pursuer))
    blue = red.replace(name="blue", controller=load_law(evader))
    return Scenario(title="Chase", robots=[red.at(0, 0), blue.at(x, 0)], stop_time=2.5,
                    addons=[Game({"pursuer": ["red"], "evader": ["blue"]})])
"""

LAWS = {
    "pursuers/quick.py": """
        def control(robot):
            print("here I am")
            return robot.neighbours[0].position - robot.position + robot.rng.normal(0, 0.1, 2)
        """,
    "pursuers/loop.py": """
        def control(robot):
            while robot.time > 0.25:
                pass
            return 0, 0
        """,
    "evaders/still.py": "def control(robot): return 0, 0",
    "evaders/nan.py": "def control(robot): return float('nan'), 0",
    "evaders/crash.py": """
        def control(robot):
            return 0, 1 / (robot.time < 0.25)
        """,
}

SEEDS = 2


@pytest.fixture(scope="module")
def evening(tmp_path_factory):
    """A folder with an experiment and laws, and the tournament of all of them that was played."""
    folder = tmp_path_factory.mktemp("evening")
    (folder / "chase.py").write_text(CHASE)
    for name, text in LAWS.items():
        path = folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(dedent(text).strip("\n") + "\n")
    result = mars2d.tournament(
        folder / "chase.py",
        {"pursuer": "pursuers", "evader": "evaders/*.py"},
        seeds=SEEDS,
        workers=2,
        out=folder / "out",
    )
    return SimpleNamespace(folder=folder, result=result, out=folder / "out")


@pytest.fixture
def command(evening, monkeypatch, capsys):
    """The verb, in the folder; it gives the exit code and what was printed."""
    monkeypatch.chdir(evening.folder)

    def run(*words: str) -> tuple[int, str, str]:
        code = cli.main(["tournament", *words])
        return code, *capsys.readouterr()

    return run


ALL = ("--role", "pursuer=pursuers", "--role", "evader=evaders", "--seeds", str(SEEDS))
SAME = ("--role", "pursuer=pursuers/loop.py", "pursuers/quick.py", "evader=evaders/*.py", "--seeds", str(SEEDS))  # fmt: skip  # noqa: E501
"""What a shell may have made of patterns."""


def rows_of(path):
    with path.open(newline="") as file:
        return [*csv.DictReader(file)]


@pytest.mark.slow
def test_everybody_meets_everybody_from_the_same_seeds(evening):
    met = [(*m.match.laws.values(), m.match.seed) for m in evening.result.matches]
    assert met == [*product(("loop", "quick"), ("crash", "nan", "still"), (0, 1))]
    assert [m.match.number for m in evening.result.matches] == list(range(1, 13))
    assert not any(m.error for m in evening.result.matches)


@pytest.mark.slow
def test_a_law_that_fails_forfeits_with_a_verdict_and_the_rest_goes_on(evening):
    verdicts = {
        tuple(m.match.laws.values()): {r: (v.kind, v.text) for r, v in m.verdicts.items()}
        for m in evening.result.matches
    }
    slow = {"pursuer": ("slow", "loop.py, line 2: no command after 1 s")}
    late = {"pursuer": ("late", "ran out of time in 2 matches before, and forfeits the rest")}
    raised = "control raised ZeroDivisionError: division by zero"
    crash = {"evader": ("error", f"crash.py, line 2: {raised}")}
    returned = "control returned (nan, 0.0): a command must be finite"
    nan = {"evader": ("command", f"nan.py, line 1: {returned}")}
    assert verdicts == {
        ("quick", "still"): {},
        ("quick", "crash"): crash,
        ("quick", "nan"): nan,
        ("loop", "crash"): {**slow, **crash},
        ("loop", "nan"): late,  # after two matches that took a second each
        ("loop", "still"): late,
    }
    winners = {tuple(m.match.laws.values()): m.winner for m in evening.result.matches}
    assert winners["loop", "still"] == winners["loop", "nan"] == "evader"
    assert winners["quick", "crash"] == "pursuer"
    assert winners["loop", "crash"] is None  # both failed in the same step
    lines = (evening.out / PLAYED).read_bytes().count(b"\n")
    assert 8 <= lines <= 8 + 3  # those that a second process had begun meanwhile


def test_the_game_says_who_won_and_when(evening):
    for played in evening.result.matches[-SEEDS:]:
        assert (played.winner, dict(played.score)) == ("pursuer", {"pursuer": 1.0, "evader": 0.0})
        assert 0.1 * (played.steps - 1) <= played.payoff <= 0.1 * played.steps
        assert played.message.startswith("red catches blue after")
        assert played.output["pursuer"].startswith("here I am\nhere I am")
        assert played.replay


def test_a_match_is_the_run_with_the_same_laws_and_seed(evening):
    played = evening.result.matches[-1]
    laws = {"pursuer": "pursuers/quick.py", "evader": "evaders/still.py"}
    record = mars2d.run(evening.folder / "chase.py", options=laws, seed=played.match.seed)
    assert played.digest == record.digest
    assert played.digest != evening.result.matches[-2].digest  # another start


@pytest.mark.slow
def test_the_league_depends_on_no_number_of_workers(evening):
    laws = {"pursuer": evening.folder / "pursuers/quick.py", "evader": evening.folder / "evaders"}
    alone = mars2d.tournament(evening.folder / "chase.py", laws, seeds=SEEDS, workers=1).matches
    before = evening.result.matches[-3 * SEEDS :]
    assert [replace(m, match=None) for m in alone] == [replace(m, match=None) for m in before]


def test_laws_stand_by_their_points(evening):
    points = {(s.role, s.law): (s.points, s.forfeits) for s in evening.result.standings}
    assert points == {
        ("pursuer", "quick"): (6.0, 0),
        ("pursuer", "loop"): (0.0, 6),
        ("evader", "still"): (2.0, 0),
        ("evader", "nan"): (2.0, 2),
        ("evader", "crash"): (0.0, 4),
    }


def test_the_folder_has_a_row_for_each_match_and_law_and_a_page(evening):
    rows = rows_of(evening.out / "matches.csv")
    assert [row["match"] for row in rows] == [str(k) for k in range(1, 13)]
    row = rows[2]
    found = [row[name] for name in ("pursuer", "evader", "seed", "winner", "verdict")]
    assert found == ["loop", "nan", "0", "evader", "pursuer: late"]
    assert row["payoff"] == ""
    assert rows[-1]["digest"] == evening.result.matches[-1].digest
    assert float(rows[-1]["payoff"]) == evening.result.matches[-1].payoff
    league = [
        [row["role"], row["place"], row["law"]] for row in rows_of(evening.out / "league.csv")
    ]
    assert league[:2] == [["pursuer", "1", "quick"], ["pursuer", "2", "loop"]]
    rated = rows_of(evening.out / "grades.csv")
    elo = {row["group"]: int(row.pop("elo")) for row in rated}
    assert elo["quick"] > elo["nan"] > elo["loop"]
    grades = [[*row.values()] for row in rated]
    slow = "slow in 2 matches, first in match 1: loop.py, line 2: no command after 1 s"
    told = "ran out of time in 2 matches before, and forfeits the rest"
    out = f"late in 4 matches, first in match 3: {told}"
    assert grades[1] == ["loop", "6", "0.0", "6", f"{slow}; {out}"]
    assert [row[:4] for row in grades] == [
        ["crash", "4", "0.0", "4"],
        ["loop", "6", "0.0", "6"],
        ["nan", "4", "2.0", "2"],
        ["quick", "6", "6.0", "0"],
        ["still", "4", "2.0", "0"],
    ]
    page = (evening.out / "league.html").read_text()
    assert evening.result.matches[0].replay in page
    assert "no command after 1 s" in page


# -- going on --------------------------------------------------------------------------------------


@each_case("words", [ALL, SAME])
def test_the_same_command_plays_nothing_twice(evening, command, words):
    before = (evening.out / PLAYED).read_bytes()
    code, printed, said = command("chase.py", *words, "--out", "out")
    assert (code, said) == (0, "")
    assert printed.startswith("Chase: 2 as pursuer, 3 as evader: 12 matches, 12 of them played")
    assert "nan forfeits: command in 2 matches, first in match 9: nan.py, line 1:" in printed
    assert printed.endswith(f"page: {Path('out/league.html')}\n")
    assert (evening.out / PLAYED).read_bytes() == before


def planned_as_before(evening, **more):
    folder = evening.folder
    laws = {"pursuer": folder / "pursuers", "evader": folder / "evaders"}
    return schedule(folder / "chase.py", laws, seeds=SEEDS, **more)


def test_matches_of_a_law_that_has_changed_are_played_again(evening):
    path = evening.folder / "evaders" / "nan.py"
    text = path.read_text()
    try:
        path.write_text(text + "# better now\n")
        found = played_before(evening.out, planned_as_before(evening))
    finally:
        path.write_text(text)
    assert {m.match.laws["evader"] for m in found} == {"crash", "still"}
    planned = planned_as_before(evening)
    assert not missing(planned, played_before(evening.out, planned))


def test_with_other_limits_seeds_or_options_matches_are_others(evening):
    options = {"speed": 2.0}
    for other in ({"limits": Limits(tick=0.5)}, {"first_seed": 2}, {"options": options}):
        assert not played_before(evening.out, planned_as_before(evening, **other))


def started(evening, out, seeds, **options):
    words = ["tournament", str(evening.folder / "chase.py"), "--role", "pursuer=pursuers/quick.py"]
    words += ["--role", "evader=evaders", "--seeds", str(seeds), "--out", str(out)]
    return subprocess.Popen(
        [sys.executable, "-P", "-m", "mars2d", *words],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
        cwd=evening.folder, **options,
    )  # fmt: skip


def lines_in(out):
    kept = out / PLAYED
    return kept.read_bytes().count(b"\n") if kept.exists() else 0


@pytest.mark.slow
def test_after_ctrl_c_what_was_played_is_there_and_the_same_command_goes_on(evening, tmp_path):
    out = tmp_path / "out"
    process = started(evening, out, 200)
    wait_until(lambda: lines_in(out) > 2, process)
    os.killpg(process.pid, signal.SIGINT)
    printed, said = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130, said
    rows = (out / "matches.csv").read_text().splitlines()
    assert said.endswith(f"mars2d: {len(rows) - 1} of 600 matches are in {out}; the same command goes on\n")  # fmt: skip  # noqa: E501
    assert "1  quick" in printed
    laws = {"pursuer": "pursuers/quick.py", "evader": "evaders"}
    planned = schedule(evening.folder / "chase.py", laws, seeds=200)
    assert len(played_before(out, planned)) == len(rows) - 1 > 1


@pytest.mark.nightly
@pytest.mark.slow
def test_killed_at_any_moment_it_goes_on_to_the_same_bytes(evening, tmp_path):
    killed, whole = tmp_path / "killed", tmp_path / "whole"
    for lines in (1, 2, 4, 8):
        with started(evening, killed, 4) as process:
            wait_until(lambda lines=lines: lines_in(killed) >= lines, process)
            process.kill()
    for out in (killed, whole):
        with started(evening, out, 4) as process:
            process.communicate(timeout=PATIENCE)
    assert process.returncode == 0
    for name in ("matches.csv", "league.csv", "grades.csv", "league.html"):
        assert (killed / name).read_bytes() == (whole / name).read_bytes()


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="closes a descriptor in a shell")
def test_without_a_result_the_exit_code_is_1_and_nobody_need_read_what_is_printed(
    evening, tmp_path
):
    words = (
        "--role pursuer=pursuers/quick.py --role evader=evaders/still.py --set broken=1 --seeds 2"
    )
    line = f"exec {sys.executable} -P -m mars2d tournament chase.py {words} --out {tmp_path} >&-"
    done = subprocess.run(
        line, shell=True, check=False, cwd=evening.folder, capture_output=True, text=True
    )
    assert done.returncode == 1
    assert done.stderr == "mars2d: 1 match without a result: play again by the same command\n"
    assert [row["winner"] for row in rows_of(tmp_path / "matches.csv")] == ["pursuer", ""]


CHANGES = {
    "a forged winner": lambda row: row.update(winner="evader"),
    "a forged score": lambda row: row["score"].update(pursuer=100.0),
    "another match": lambda row: row.update(print="0" * 64),
    "no checksum": lambda row: row.pop("sum"),
    "no error": lambda row: row.pop("error"),
    "no more than a name": lambda row: (row.clear(), row.update(winner="evader")),
}


@each_case("change", CHANGES.values())
def test_a_match_that_was_changed_in_the_file_is_refused(evening, tmp_path, change):
    lines = (evening.out / PLAYED).read_bytes().splitlines(keepends=True)
    row = json.loads(lines[3])
    change(row)
    lines[3] = json.dumps(row).encode() + b"\n"
    forged = b"".join(lines)
    (tmp_path / PLAYED).write_bytes(forged)
    with pytest.raises(
        InputError, match=r"played\.jsonl, line 4: was changed after it was written"
    ):
        Folder(tmp_path, planned_as_before(evening))
    assert (tmp_path / PLAYED).read_bytes() == forged


# -- players, matches without a result -------------------------------------------------------------


@pytest.mark.nightly
@pytest.mark.slow
def test_players_play_both_roles_and_an_experiment_that_fails_costs_one_match(evening, tmp_path):
    for law in ("pursuers/quick.py", "evaders/still.py"):
        (tmp_path / Path(law).name).write_text((evening.folder / law).read_text())
    result = mars2d.tournament(
        evening.folder / "chase.py",
        players=tmp_path,
        seeds=[4, 6],
        options={"speed": 0.8, "broken": 6},
        stop_time=2.0,
        limits=Limits(tick=5.0),
        workers=2,
    )
    met = [(*m.match.laws.values(),) for m in result.matches[::2]]
    assert met == [("quick", "still"), ("still", "quick")]
    assert {m.match.options["stop_time"] for m in result.matches} == {2.0}
    for sound, broken in zip(result.matches[::2], result.matches[1::2], strict=True):
        assert (sound.error, sound.winner is not None) == ("", True)
        assert "ValueError: no such start" in broken.error
        assert broken.message == f"no result: {broken.error}"
    assert {(s.law, s.role, s.played) for s in result.standings} == {("quick", "", 2), ("still", "", 2)}  # fmt: skip  # noqa: E501
    path = result.save_csv(tmp_path / "matches.csv")
    header = path.read_text().splitlines()[0]
    assert header.startswith("match,seed,pursuer,evader,winner,pursuer_score")


# -- what can't be played --------------------------------------------------------------------------


WRONG = {
    "random_walk --players evaders":
        "random_walk: a game needs one add-on that says who has won, such as Game(",
    "chase.py --role pursuer":
        "--role pursuer: expected ROLE=FILES, such as --role pursuer=laws/*.py",
    "chase.py --role hunter=pursuers": "there is no role 'hunter'; known: evader, pursuer",
    "chase.py --role pursuer=pursuers":
        "no laws for the role 'evader': name them by --role evader=FILES",
    "chase.py --players pursuers/quick.py":
        "there is nobody to play against: a law does not play itself",
    "chase.py ALL --set seed=1": "option 'seed': say how many there are, with --seeds N",
    "chase.py ALL --set evader=evaders/nan.py":
        "option 'evader': this is a role; name its laws by --role evader=FILES",
    "chase.py ALL --tick-limit 0": "Limits.tick = 0.0: expected a number > 0, and below 1e9",
    "chase.py ALL --out evaders":
        "evaders: holds crash.py, which is not of a tournament; nothing was changed",
    "sumo --players players --out out":
        "out: is of a tournament of chase.py; name another folder by --out",
    "chase.py ALL --out chase.py": "chase.py: this is a file; expected a folder",
    "chase.py ALL --out no/where": "no/where: there is no folder no",
}  # fmt: skip
"""Commands, and what each is told."""


@each_case("words, message", WRONG.items())
def test_what_can_not_be_played_is_said_in_one_line(command, words, message):
    code, _, said = command(*words.replace("ALL", " ".join(ALL)).split())
    assert (code, said.count("\n")) == (2, 1)
    assert said.startswith(f"mars2d: {message}")


@pytest.mark.slow
def test_a_law_that_is_called_as_a_module_of_python_runs_in_no_process_but_its_own(tmp_path):
    told = "open('told', 'w').write('it ran')\nraise ImportError\n"
    for name in ("numpy.py", "selectors.py", "cloudpickle.py"):
        (tmp_path / name).write_text(told)
    (tmp_path / "quick.py").write_text("def control(robot):\n    return 1.0, 0.0\n")
    command = [
        sys.executable, "-P", "-m", "mars2d", "tournament", "corner_game", "--role",
        "pursuer=quick.py", "evader=evaders", "--seeds", "1", "--stop-time", "1",
    ]  # fmt: skip
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert not (tmp_path / "told").exists()
