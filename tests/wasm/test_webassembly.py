"""MARS2D in WebAssembly: Pyodide, which is Python in a browser, run by node."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from mars2d.scenario.examples import examples
from tests.house.goldens import Golden

pytestmark = pytest.mark.nightly

CHECKOUT = Path(__file__).parents[2]

NEEDS_SHAPELY = {
    "coverage_circle", "coverage_square", "crowd", "herding", "hide_and_seek", "many_push_one",
    "material_pairs", "obstacle_avoidance", "path_planning", "plan_push", "pursuit_voronoi",
    "push_box",
    "random_walk", "round_a_pillar", "shove_and_spin", "stick_slip", "tug_of_war",
    "wall_follower", "wall_slide",
}  # fmt: skip
"""The examples that are left out where there is no shapely: `.ci/pyodide.py` has none."""

SAME_DIGEST = {
    "billiards", "capture_the_flag", "corner_game", "guard_the_line", "head_on", "lion_and_man",
    "rendezvous", "selfish_herd", "straight_chase",
}  # fmt: skip
"""The examples with the same digest as on Linux; the others call sines of another C library."""


@pytest.fixture(scope="module")
def said() -> list[dict[str, Any]]:
    """Return what was said in WebAssembly, a dict a line."""
    folder = os.environ.get("MARS2D_PYODIDE")
    if not folder:
        pytest.skip("needs a folder of Pyodide in MARS2D_PYODIDE: .ci/pyodide.py")
    node = shutil.which("node")
    if node is None:
        pytest.skip("needs node: apt-get install nodejs")
    here = Path(__file__).parent
    done = subprocess.run(
        [node, here / "run.mjs", folder, CHECKOUT, here / "inside.py"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-4000:]
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def test_the_core_works_with_numpy_and_pymunk_alone(said):
    core = said[0]
    assert core["kind"] == "core"
    assert core["digest"] == Golden.read("head_on").digest
    assert set(core["kept"].values()) == {core["digest"]}
    assert core["page"]
    assert core["svg"] == "<svg"
    assert core["absent"] == ["scipy", "shapely", "matplotlib", "pygame"]


def test_the_doctor_knows_a_browser(said):
    core = said[0]
    assert set(core["broken"]) <= {"scipy", "shapely", "matplotlib", "cloudpickle", "tqdm"}
    assert "pip install" not in " ".join(core["said"][name] for name in ("pygame-ce", "engine"))
    assert 'micropip.install("scipy")' in core["said"]["scipy"]


def test_the_examples_follow_their_golden_paths(said):
    told = {each["name"]: each for each in said if each["kind"] == "example"}
    assert set(told) == set(examples())
    left_out = {name for name, each in told.items() if "error" in each}
    assert all("shapely" in told[name]["error"] for name in left_out), told
    assert left_out in (set(), NEEDS_SHAPELY)
    off = {name: each["excess"] for name, each in told.items() if each.get("excess", 0) >= 1}
    assert off == {}


def test_some_digests_are_those_of_linux(said):
    told = {each["name"]: each["digest"] for each in said[1:] if "digest" in each}
    alike = {name for name, digest in told.items() if digest == Golden.read(name).digest}
    assert alike >= SAME_DIGEST
