"""Names, settings and variables that are odd: each works, or is one named error."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d import Scenario
from mars2d.cli.command_line import main
from mars2d.output.formats import SUFFIXES
from tests.processes import PATIENCE, bare_environment, mars

WALK = (
    "from mars2d import Robot, Scenario\n"
    "scenario = Scenario(robots=[Robot(controller=lambda robot: (0.1, 0))], stop_time=0.3)\n"
)

NAMES = [
    "a b", "-a", "--set", "a;b", "$HOME", "a'b", 'a"b', "a*b", "[a]", "{0}", "~", "a,b", "a=b",
    "a:b", "%s", "a\\b", "#a", "\u4e2d\u6587", "e\u0301", "\U0001f916", ".hidden", "a.csv.npz",
    "x" * 200,
]  # fmt: skip


def test_a_record_is_found_again_under_any_name(tmp_path):
    record = mars2d.run(Scenario(robots=2, stop_time=0.3), control=lambda world: np.zeros((2, 2)))
    lost = []
    for suffix in SUFFIXES:
        for name in NAMES:
            saved = record.save(tmp_path / (name + suffix))
            if mars2d.load(saved).digest != record.digest:
                lost.append(saved)
    assert lost == []


FIELDS = [
    "sampling_time", "stop_time", "command_delay", "on_exit", "title", "robots", "robots.0.pose",
    "robots.*.diameter", "robots.0.drive.max_linear_speed", "workspace", "neighbours", "seed", "",
]  # fmt: skip

VALUES = ["nan", "-1", "True", "None", "[]", "(1, 2, 3)", "lambda: 0"]


def test_no_setting_breaks_a_run(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("walk.py").write_text(WALK)
    for field in FIELDS:
        for value in VALUES:
            setting = f"{field}={value}"
            code = main(["run", "walk.py", "--headless", "--set", setting, "--stop-time", "0.3"])
            told = capsys.readouterr().err
            assert code in (0, 2), (setting, told)
            assert "Traceback" not in told, setting
            assert code == 0 or told.count("mars2d: ") == 1, (setting, told)


VARIABLES = {
    "LC_ALL": "C",
    "PYTHONOPTIMIZE": "2",
    "HOME": "/nowhere",
    "MPLBACKEND": "TkAgg",
    "OMP_NUM_THREADS": "1",
}


@pytest.mark.slow
@pytest.mark.nightly
def test_no_variable_changes_a_run(tmp_path):
    (tmp_path / "walk.py").write_text(WALK)
    digests = set()
    for variable, value in VARIABLES.items():
        words = ["run", "walk.py", "--headless", "--record", "a.npz"]
        done = subprocess.run(
            [sys.executable, "-m", "mars2d", *words], cwd=tmp_path, timeout=PATIENCE,
            check=False, capture_output=True, env=bare_environment(**{variable: value}),
        )  # fmt: skip
        assert done.returncode == 0, (variable, value, done.stderr)
        digests.add(mars2d.load(tmp_path / "a.npz").digest)
    assert len(digests) == 1


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes of POSIX")
def test_a_pipe_that_nobody_writes_to_is_not_waited_for(tmp_path):
    for line in ("run law.py --headless", "check law.npz", "replay law.csv"):
        words = line.split()
        os.mkfifo(tmp_path / words[1])
        done = mars(*words, cwd=tmp_path)
        assert done.returncode == 2
        assert ": not a file; expected a" in done.stderr
