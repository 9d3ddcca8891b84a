"""The verb ``compare`` as it is typed: what it prints, what it writes, and its errors."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import mars2d

HEAD_ON = """
from math import pi
from mars2d import Robot, Scenario

scenario = Scenario(
    title="Head on",
    robots=[Robot(pose=(-1, 0, 0)), Robot(pose=(1, 0, pi))],
    sampling_time=0.1,
    stop_time=4.0,
)


def control(world):
    return [[0.5, 0.5], [0.0, 0.0]]
"""

FAILS_IN_IDEAL = """
from mars2d import Robot, Scenario

scenario = Scenario(robots=[Robot(pose=(0, 0, 0))], sampling_time=0.1, stop_time=1.0)


def control(world):
    if world.scenario.physics == "ideal" and world.time > 0.45:
        raise ValueError("too ideal")
    return [[0.1], [0.0]]
"""


def written(code, name="walk.py"):
    Path(name).write_text(code, encoding="utf-8")
    return name


@pytest.mark.slow
@pytest.mark.nightly
def test_without_more_it_makes_a_picture_and_a_film_and_says_where(typed):
    code, out, err = typed("compare", written(HEAD_ON))
    assert (code, err) == (0, "")
    paths = [line.split()[1] for line in out.splitlines() if "mars2d_compare" in line]
    assert len(paths) == 2
    with Image.open(paths[0]) as picture, Image.open(paths[1]) as film:
        assert picture.format == "PNG"
        assert picture.size[0] == 2200
        assert film.format == "GIF"
        assert film.size == (1280, 720)
        assert film.n_frames > 50


def test_it_prints_a_table_of_the_three_runs(typed):
    code, out, _ = typed("compare", written(HEAD_ON), "--figure", "a.png")
    assert code == 0
    title, head, *rows, last = out.splitlines()
    assert title == "Head on, seed 0"
    assert head.split("  ")[0] == "physics"
    assert [row.split()[0] for row in rows] == ["contact", "stop", "ideal"]
    assert rows[0].split()[1:5] == ["40", "1", "-", "-"]
    assert all(row.endswith("finished after 4 s") for row in rows)
    assert len({row.index("finished") for row in [*rows, head.replace("ended", "finished")]}) == 1
    assert last == "figure: a.png"
    assert not Path("mars2d_compare").exists()


def test_the_runs_are_those_of_each_physics_alone(typed):
    name = written(HEAD_ON)
    _, out, _ = typed("compare", name, "--seed", 7, "--figure", "a.png")
    _, _, *rows, _ = out.splitlines()
    modes = [row.split()[0] for row in rows]
    records = [mars2d.run(name, seed=7, options={"physics": mode}) for mode in modes]
    for row, record in zip(rows[1:], records[1:], strict=True):
        apart = np.hypot(*(record.pose[-1, :2] - records[0].pose[-1, :2]))
        assert row.split()[2] == f"{record.collisions}"
        assert f"{round(apart.max(), 6):.3g} m" in row
        assert f"{round(apart.mean(), 6):.3g} m" in row


def test_options_hold_for_all_runs(typed):
    code, out, _ = typed(
        "compare", "follow_the_leader", "--stop-time", 2, "--set", "followers=2",
        "--set", "sampling_time=0.5", "--figure", "a.svg", "--video", "a.gif", "--speed", 4,
    )  # fmt: skip
    assert code == 0
    assert [line.split()[1] for line in out.splitlines()[2:5]] == ["4", "4", "4"]
    assert b"<svg" in Path("a.svg").read_bytes()
    with Image.open("a.gif") as film:
        duration = 0
        for k in range(film.n_frames):
            film.seek(k)
            duration += film.info["duration"]
    assert duration == pytest.approx(500, abs=90)


def test_a_law_that_fails_says_with_which_physics(typed):
    code, out, err = typed("compare", written(FAILS_IN_IDEAL), "--figure", "a.png")
    assert (code, out) == (2, "")
    assert err.startswith("mars2d: physics = 'ideal': walk.py, line 9")
    assert "too ideal" in err
    assert err.count("\n") == 1
    assert not Path("a.png").exists()
