"""The benchmarks run, and write the figures that they promise."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.nightly

FOLDER = Path(__file__).parents[2] / "benchmarks"


def run(name, *arguments, cwd):
    command = [sys.executable, str(FOLDER / name), "--json", "out.json", *arguments]
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads((cwd / "out.json").read_text())


def test_scenes_are_timed_in_turns_with_a_bare_loop_and_compared_with_an_earlier_run(tmp_path):
    rows = run("suite.py", "S1", "--rounds", "2", cwd=tmp_path)
    assert list(rows) == ["S1 default", "S1 loose"]
    for row in rows.values():
        assert row["real_time"] == pytest.approx(1 / row["step_s"])
        assert len(row["yardsticks"]) == 2
    faster = {name: row | {"yardsticks": [2e9] * 2} for name, row in rows.items()}
    (tmp_path / "old.json").write_text(json.dumps(faster))
    command = [sys.executable, str(FOLDER / "suite.py"), "S1", "--rounds=2", "--compare=old.json"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
    assert len(re.findall(r" x \(\d{6,}\.\d\d to \d{6,}", done.stdout)) == 2


def test_the_start_is_timed(tmp_path):
    result = run("start.py", "--rounds", "1", cwd=tmp_path)
    assert result["import mars2d"] > result["bare python"]


def test_crowds_are_watched_and_a_run_does_not_depend_on_the_workers(tmp_path):
    result = run("crowds.py", "--robot-runs", "30", "--seed", "3", "--workers", "2", cwd=tmp_path)
    assert result["all"]["robot_runs"] >= 30
    assert result["all"]["escapes"] == 0
    worst = result["all"]["worst of two bodies"]
    assert 0 < worst["m"] <= 1e-3
    alone = run("crowds.py", "--seed", "3", "--run", str(worst["run"]), cwd=tmp_path)
    assert alone["deepest"]["bodies"] == worst["m"]


def test_rays_are_timed_and_are_those_of_the_public_method(tmp_path):
    result = run("rays.py", "--sizes", "20", "200", "--rounds", "1", cwd=tmp_path)
    assert [row["segments"] for row in result["rays"]] == [20, 200] * 2
    assert all(row["largest_difference"] < 1e-9 for row in result["rays"])
    assert result["team"]["readings"] == [201, 20, 180]


def test_drawing_and_films_are_timed(tmp_path):
    pytest.importorskip("av")
    rows = run("drawing.py", "--rounds", "1", "--steps", "4", cwd=tmp_path)["drawing"]
    figures = {row["what"]: row for row in rows}
    for what in ("paths, real time", "paths, each step", "scans, real time", "scans, each step"):
        assert figures[f"dummy: {what}"]["least_ms"] > 0
    assert all(figures[f"{suffix}: scans"]["ratio"] > 0 for suffix in ("mp4", "gif"))
    assert figures["dummy: bare"]["ratio"] == 1.0


def test_cells_are_timed(tmp_path):
    result = run("voronoi.py", "--sizes", "4", "--rounds", "1", cwd=tmp_path)
    assert [row["region"] for row in result["cells"]] == ["square", "circle", "hook"]
    assert all(row[way]["ms"] > 0 for row in result["cells"] for way in ("cells", "density"))
    assert result["drawing"][0]["painting"]["ms"] > 0


def test_scrubbing_and_branching_are_timed(tmp_path):
    result = run("scrubbing.py", "--rows", "60", "--robots", "3", cwd=tmp_path)
    for law in ("plain", "sensing"):
        assert 0 < result[law]["look"] < result[law]["branch from the start"][0]
        assert len(result[law]["branch"]) > 0


def test_studies_by_one_worker_and_by_two_are_timed(tmp_path):
    result = run("sweeps.py", "--runs", "3", "--rounds", "1", "--stop-time", "10", cwd=tmp_path)
    assert result["whole"][0] > 0
    assert len(result["whole_s"]) == 2
