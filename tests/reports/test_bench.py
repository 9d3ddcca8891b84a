"""`mars2d bench`: what it measures, keeps and compares, and what it says when it can not."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mars2d.cli import command_line as cli
from mars2d.reports.bench.gaps import Gaps
from mars2d.reports.bench.report import ALIKE, Change, Figures, Report, Row, load_report
from mars2d.reports.bench.scenes import FORCE, LEVER, SCENES, TORQUE, Scene
from mars2d.reports.bench.worlds import SETTINGS, deepest, world_of
from mars2d.reports.bench.yardstick import Bare
from tests.cases import each_case

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"

STEADY = tuple(1e-4 * (1 + 0.01 * np.sin(range(9))))
"""What a step of the bare loop takes on a quiet machine, in each of some rounds."""


def row(seconds, bare=STEADY, name="S2 default"):
    times = np.broadcast_to(seconds, len(bare)).tolist()
    return Row(name, "100 robots", tuple(zip(bare, times, strict=True)))


def bench(capsys, *arguments):
    """Run the command and return its exit code, and what it prints."""
    code = cli.main(["bench", *map(str, arguments)])
    printed = capsys.readouterr()
    return code, printed.out, printed.err


def refused(capsys, *arguments):
    """Return the one line by which the command refuses its arguments."""
    code, out, err = bench(capsys, *arguments)
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    return err


# -- scenes ---------------------------------------------------------------------------------------


@each_case("name", SCENES)
def test_a_scene_is_the_same_each_time_and_nothing_touches_in_it(name):
    scene, again = SCENES[name](), SCENES[name]()
    assert scene.name == name
    assert np.array_equal(scene.poses, again.poses)
    assert np.array_equal(scene.crates, again.crates)
    assert (scene.boxes, scene.ropes) == (again.boxes, again.ropes)
    starts = np.concatenate([scene.poses, scene.crates])
    assert deepest(scene, starts.T[None]) == 0
    assert np.abs(starts[:, :2]).max() < scene.side / 2 - scene.radius


def test_a_world_of_a_scene_has_its_robots_sensors_obstacles_and_settings():
    world = world_of(SCENES["S3"](), SETTINGS["loose"])
    assert world.scenario.max_overlap == 0.02
    assert world.scenario.sampling_time == 0.1
    assert len(world.obstacles) == 51  # and the wall
    world.step()
    assert world.record.sensors["range_finder"].shape == (1, 20, 180)


@each_case("name, robots, crates", [("P1", 20, 30), ("P2", 60, 0), ("P3", 10, 5)])
def test_a_world_of_contacts_has_its_robots_crates_and_ropes(name, robots, crates):
    scene = SCENES[name]()
    world = world_of(scene)
    assert (len(world.robots), len(world.props)) == (robots, crates)
    assert set(scene.half_sides[:robots]) == {0.15 if name == "P2" else 0}
    drives = {(robot.drive.max_force, robot.drive.max_torque) for robot in world.scenario.robots}
    assert drives == {(FORCE, TORQUE)}
    for crate in world.scenario.props:
        assert crate.side_lengths == (0.4, 0.4)
        assert crate.inertia.mass == 1
        lever = crate.shape.plate.lever
        assert lever == pytest.approx(LEVER)  # by which other engines hold it
    world.step()
    assert np.abs(world.command[1]).max() > 1.5
    for i, k, length in scene.ropes:
        apart = np.hypot(*(scene.poses[i] - scene.crates[k])[:2])
        assert length == pytest.approx(1.5 * apart)
        rope = world.scenario.joints[i]
        assert (rope.a, rope.b, rope.length) == (f"robot{i}", f"box{k}", length)
    assert len(scene.ropes) == len(world.scenario.joints)


# -- the yardstick --------------------------------------------------------------------------------


def test_the_bare_loop_moves_free_robots_as_a_world_does():
    scene = Scene("free", "", 0.05, 50.0, np.array([[-5.0, 0, 1], [5, 3, 2]]), [])
    world, bare = world_of(scene), Bare(scene, 3)
    for _ in range(40):
        world.step()
        bare()
    assert np.abs(world.pose - scene.poses.T).max() > 0.3
    assert bare.pose == pytest.approx(world.pose, abs=1e-9)


def test_the_robots_of_the_bare_loop_get_less_deep_into_each_other_with_more_substeps():
    scene = SCENES["S2"]()
    overlaps = []
    for substeps in (1, 15):
        bare, poses = Bare(scene, substeps), []
        for _ in range(100):
            bare()
            poses.append(bare.pose)
        overlaps.append(deepest(scene, np.array(poses)))
    assert 0.005 < overlaps[0] < 0.04
    assert overlaps[1] < overlaps[0] / 4


# -- overlaps -------------------------------------------------------------------------------------

BOX = [(1.0, -0.5), (1.0, 0.5), (2.0, 0.5), (2.0, -0.5)]


@each_case(
    "places, expected",
    [
        ([(0, 0), (0, 1)], 0.0),
        ([(0, 0), (0, 0.28)], 0.02),  # each other
        ([(0.87, 0), (0, 1)], 0.02),  # the box
        ([(1.0, 0), (0, 1)], 0.15),
        ([(0, 0), (-2.9, 2.86)], 0.05),  # a wall, and another
    ],
)
def test_the_deepest_overlap_is_that_which_one_works_out(places, expected):
    scene = Scene("", "", 0.1, 6.0, np.zeros((2, 3)), [BOX])
    pose = np.array([(*place, 0.3) for place in places]).T
    apart = np.array([(-1.0, 0, 0), (-2, 0, 0)]).T
    assert deepest(scene, np.array([apart, pose, apart])) == pytest.approx(expected, abs=1e-12)


SQUARES = Scene("", "", 0.1, 6.0, np.zeros((1, 3)), [BOX], square=True, crates=np.zeros((1, 3)))
"""A robot of 0.3 m and a crate of 0.4 m, both squares."""


@each_case(
    "robot, crate, expected",
    [
        ((0, 0, 0), (0.36, 0, 0), (0.01, 0.85)),  # apart by a face
        ((0, 0, 0), (0.34, 0.1, np.pi / 2), (-0.01, 0.85)),
        ((-1, 0, np.pi / 4), (-1, 0.45, np.pi / 4), (0.45 * 0.5**0.5 - 0.35, 1)),
        ((-1, 0, 0), (-1, 0.42, np.pi / 4), (0.42 - 0.15 - 0.08**0.5, 1)),  # by a corner
        ((-2.9, 0, 0), (0, 0, 0), (1, -0.05)),  # in a wall
        ((-2.8, 0, np.pi / 4), (0, 0, 0), (1, 0.2 - 0.15 * 2**0.5)),
        ((0.9, 0.2, 0), (-1, 0, 0), (1, -0.05)),  # in the box
    ],
)
def test_gaps_of_squares_are_those_which_one_works_out(robot, crate, expected):
    among, fixed = Gaps(SQUARES)(np.array([robot, crate], float), within=1.0)
    assert among == pytest.approx([expected[0]] * 2)
    assert fixed[0] == pytest.approx(expected[1])


# -- one run against another ----------------------------------------------------------------------

RESTLESS = tuple(1e-4 * (1 + 0.5 * np.array([0, 1, 0, 1, 0, 1, 0, 1, 0])))
WORK = 1e-3 * np.array([1, 40, 3, 60, 2, 70, 5, 50, 4])


@each_case(
    "old, new, times_as_fast, noise",
    [
        (row(2e-3), row(1e-3), 2, False),
        (row(1e-3), row(2e-3, bare=tuple(2 * np.array(STEADY))), 1, True),  # a slower machine
        (row(1e-3), row(1e-3 * (1 + 0.8 * ALIKE)), 1 / (1 + 0.8 * ALIKE), True),
        (row(1e-3), row(1.2e-3), 1 / 1.2, False),
        (row(1e-3), row(13 * np.array(RESTLESS), RESTLESS), 0.77, True),
        (row(WORK), row(WORK / 1.5), 1.5, False),  # round by round: each does other work
    ],
)
def test_how_many_times_as_fast_and_whether_it_is_noise(old, new, times_as_fast, noise):
    change = Change.between(old, new)
    assert change.times_as_fast == pytest.approx(times_as_fast, rel=0.03)
    assert change.noise == noise


# -- files ----------------------------------------------------------------------------------------


def test_a_saved_report_is_the_same_when_it_is_read(tmp_path):
    figures = Figures(sampling_time=0.05, max_overlap=1e-3, deepest=7e-4, bytes=48.2)
    scene = Row("S2 default", "100 robots", ((1e-4, 1e-3), (1.5e-4, 1e-3)), figures)
    report = Report((scene, row(0.3, name="import mars2d")))
    report.save(tmp_path / "a.json")
    assert load_report(tmp_path / "a.json") == report


@pytest.mark.slow
def test_the_command_prints_one_line_of_json(tmp_path, capsys):
    saved = tmp_path / "old.json"
    Report((row(1e-3, name="S1 default"), row(1e-3, name="S4 default"))).save(saved)
    code, out, _ = bench(capsys, "S1", "--quick", "--json", "--compare", saved)
    assert code == 0
    assert out.count("\n") == 1
    data = json.loads(out)
    assert [made["name"] for made in data["rows"]] == ["S1 default", "S1 loose"]
    assert data["rows"][0]["seconds"] > 0
    assert list(data["compared"]) == ["S1 default"]  # what both runs have
    assert set(data["compared"]["S1 default"]) == {"times_as_fast", "noise"}


# -- what it can't do -----------------------------------------------------------------------------


def test_an_unknown_scene_is_answered_with_the_nearest(capsys):
    assert "bench S22: the suite has no such scene; did you mean 'S2'?" in refused(capsys, "S22")
    assert "known: P1, P2, P3, S1, S2, S3, S4, start" in refused(capsys, "crowd")


def test_what_can_not_be_written_is_refused_before_the_suite_is_run(tmp_path, capsys):
    assert "ends in .json" in refused(capsys, "--save", tmp_path / "a.npz")
    assert "there is no folder" in refused(capsys, "--save", tmp_path / "gone" / "a.json")
    (tmp_path / "b.json").mkdir()
    assert "this is a folder" in refused(capsys, "--save", tmp_path / "b.json")


# -- the scripts in benchmarks/ -------------------------------------------------------------------


def script(name, *arguments, cwd):
    """Run a script of the benchmarks, and return what it prints."""
    command = [sys.executable, BENCHMARKS / name, *map(str, arguments)]
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.nightly
def test_the_growth_is_measured_fitted_and_drawn(tmp_path):
    arguments = ("--sizes", 4, 16, "--time", 0, "--json", "a.json", "--figure", "a.png")
    printed = script("growth.py", *arguments, cwd=tmp_path)
    assert "default: time grows with n to the power " in printed
    result = json.loads((tmp_path / "a.json").read_text())
    rows = result["rows"]
    assert [(row["n"], row["setting"]) for row in rows] == [
        (4, "default"), (16, "default"), (4, "loose"), (16, "loose"), (4, "crates"), (16, "crates"),
    ]  # fmt: skip
    slope = np.log(rows[1]["tick_s"] / rows[0]["tick_s"]) / np.log(4)
    assert result["exponents"]["default"] == pytest.approx(slope)
    for row in rows:
        assert row["real_time"] == pytest.approx(0.1 / row["tick_s"])
        crates = 24 * 1.5 if row["setting"] == "crates" else 0
        needed = 48 + 16 / row["n"] + crates + row["bytes_of_contacts"]
        assert row["bytes_needed"] == pytest.approx(needed)
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size == (1210, 462)
        assert len(picture.getcolors()) <= 128
