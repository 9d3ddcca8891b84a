"""The comparison with other simulators runs, checks what it runs, and says what is wrong."""

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from tests.cases import each_case

pytestmark = pytest.mark.nightly

FOLDER = Path(__file__).parents[2] / "benchmarks" / "peers"
SCRIPTS = {
    "pymunk": "pymunk_peer.py",
    "Box2D": "box2d_peer.py",
    "navground": "navground_peer.py",
    "ir-sim": "irsim_peer.py",
    "vmas": "vmas_peer.py",
    "aitk.robots": "aitk_peer.py",
}


def variable(peer):
    """The environment variable that names the interpreter which has a peer."""
    return "MARS2D_PEER_" + peer.upper().replace("-", "_").replace(".", "_")


def run(*arguments, cwd):
    command = [sys.executable, str(FOLDER / "run.py"), *map(str, arguments)]
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def peer():
    """The module that all scripts share."""
    spec = importlib.util.spec_from_file_location("peer", FOLDER / "peer.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules["peer"] = module
    spec.loader.exec_module(module)
    yield module
    del sys.modules["peer"]


def test_without_peers_both_settings_of_mars2d_are_compared(tmp_path):
    (tmp_path / "page.md").write_text(
        "before\n<!-- robots: start -->\nold\n<!-- robots: end -->\nafter\n"
    )
    done = run(
        *("--scenes", "S1", "S2", "--steps", 8, "--rounds", 2),
        *("--json", "out.json", "--markdown", "page.md"),
        cwd=tmp_path,
    )
    assert done.returncode == 0, done.stderr
    result = json.loads((tmp_path / "out.json").read_text())
    assert list(result["scenes"]) == ["S1", "S2"]
    for rows in result["scenes"].values():
        assert list(rows) == ["MARS2D, default", "MARS2D, loose"]
        for row in rows.values():
            assert row["steps_per_s"] > 0
            assert row["steps"] == 16
            assert row["lost"] == 0
        middle, least, most = rows["MARS2D, default"]["ratios"]["MARS2D, loose"]
        assert 0 < least <= middle <= most
        assert rows["MARS2D, default"]["overlap_mm"]["bodies"] < 1.0
        assert rows["MARS2D, default"]["warm_up"]["steps"] == 8
    page = (tmp_path / "page.md").read_text()
    assert page.startswith("before\n")
    assert page.endswith("after\n")
    assert "| S2 | MARS2D, loose |" in page
    assert "old" not in page


def drawn(peer, **wrong):
    """A simulator that draws the motion by the formula, alone, but for what is to be wrong."""

    class Drawn(peer.Peer):
        def build(self):
            self._at = self.scene.poses.copy()
            self._crates = self.scene.crates
            self._geometry = peer.Geometry(self.scene)

        def move(self, command):
            h = self.scene.sampling_time
            v, omega = command * wrong.get("pace", 1.0)
            now = self._at[:, 2] + omega * h / 2
            way = v * h * np.sinc(omega * h / 2 / np.pi)
            self._at += np.column_stack([way * np.cos(now), way * np.sin(now), omega * h])
            for i, k, length in self.scene.ropes:
                rope = (self._at[i] - self._crates[k])[:2]
                self._at[i, :2] = self._crates[k, :2] + rope * min(1, length / np.hypot(*rope))

        def poses(self):
            return np.concatenate([self._at, self._crates])

        def near(self):
            points = self._at[:, :2]
            distance = np.minimum(self._geometry.off(points), self._geometry.apart(points))
            return distance < self.scene.proximity + wrong.get("blind", 0.0)

        def ranges(self):
            return self._geometry.ranges(self._at)[0] + wrong.get("far", 0.0)

    return Drawn


@each_case("scene", ["S1", "S2", "S3", "P1", "P2", "P3"])
def test_a_run_that_does_as_it_is_told_is_fit_to_be_timed(scene, peer):
    run = peer.Run(drawn(peer), peer.SCENES[scene](), "")
    assert run.looked_at(8, 60.0)["steps"] == 8
    assert run.timed(5, 60.0)["steps"] == 5


@each_case(
    "scene, wrong, says",
    [
        ("S2", {"pace": 0.0}, "which nothing is near, was told to go 0.0150 m"),
        ("S2", {"pace": 1.1}, "it went 0.0165 m"),
        ("S1", {"blind": -0.3}, "is what is 0.[0-2].* m away near?"),
        ("S3", {"far": -0.1}, "of the ranges are not right"),
    ],
)
def test_a_run_that_is_not_what_it_seems_is_not_timed(scene, wrong, says, peer):
    run = peer.Run(drawn(peer, **wrong), peer.SCENES[scene](), "")
    with pytest.raises(ValueError, match=says):
        run.looked_at(200, 60.0)


def test_distances_and_ranges_are_those_worked_out_by_hand(peer):
    scene = SimpleNamespace(
        walls=[(-2, -2), (-2, 2), (2, 2), (2, -2)],
        boxes=[[(1, -0.5), (2, -0.5), (2, 0.5), (1, 0.5)]],
        side=4.0,
        radius=0.25,
        beams=4,
        range=1.5,
    )
    geometry = peer.Geometry(scene)
    points = np.array([(0.0, 0.0), (0.0, 1.0), (1.1, 0.0), (0.0, 2.5), (-1.5, -1.75)])
    assert geometry.off(points) == pytest.approx([1.0, 1.0, -0.1, -0.5, 0.25])
    assert geometry.apart(points[:3]) == pytest.approx([0.75, 0.75, 0.85])
    # The first beam looks back, the second to the right, the third ahead.
    ranges, robot = geometry.ranges(np.array([(0.0, 0.0, 0.0), (0.0, 1.0, np.pi / 2)]))
    assert ranges == pytest.approx(np.array([(1.5, 1.5, 1.0, 0.75), (0.75, 1.5, 1.0, 1.5)]))
    assert robot.tolist() == [[False, False, False, True], [True, False, False, False]]


@pytest.mark.parametrize("name", SCRIPTS)
def test_a_peer_runs_a_scene_as_it_should(name, tmp_path):
    python = os.environ.get(variable(name), sys.executable if name == "pymunk" else None)
    if python is None:
        pytest.skip(f"{name} is not here: {variable(name)} names the interpreter that has it")
    done = run(
        *("--peer", f"{name}={python}", "--scenes", "S1", "S2", "P1", "--steps", 8, "--rounds", 1),
        *("--json", "out.json"),
        cwd=tmp_path,
    )
    assert done.returncode == 0, done.stderr
    result = json.loads((tmp_path / "out.json").read_text())
    assert name in result["versions"]
    for scene, rows in result["scenes"].items():
        left_out = f"{scene}  {name} " in done.stdout and "left out" in done.stdout
        assert left_out != any(label.startswith(name) for label in rows)
    assert any(label.startswith(name) for label in result["scenes"]["S2"])
