"""A part is one file and one line: by the recipes of CONTRIBUTING, and one of the user's own."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d import Holonomic, Robot, Scenario
from mars2d.bodies import Ball, Joint
from mars2d.bodies.constraints import MaxDistance, SpringDamper
from mars2d.core.description import number

PACKAGE = Path(mars2d.__file__).parent
ROOT = Path(__file__).parents[2]
GUIDE = ROOT / "CONTRIBUTING.md"

RECIPE = re.compile(r"```python\n# (mars2d/\S+?\.py)(?:, in (\w+))?\n(.*?)```", re.S)
"""A block of code of the guide: the file it belongs to, and the table there, if it is a line."""


# -- the recipes of CONTRIBUTING, in a copy of the package ----------------------------------------


def follow(recipes: list[tuple[str, str, str]], folder: Path) -> None:
    """Do as the recipes say in a folder with a copy of the package."""
    for name, table, code in recipes:
        file = folder / name
        if table:
            imports, _, lines = code.rpartition("\n\n")
            text = file.read_text(encoding="utf-8").replace(
                "\nfrom mars2d", f"\n{imports}\nfrom mars2d", 1
            )
            changed = re.sub(rf"^({table}\b.*[\[{{(]\n)", rf"\g<1>{lines}", text, flags=re.M)
            assert changed != text, f"{name} has no {table}"
        elif file.exists():
            part = code.rpartition(" ")[2].strip()
            text = file.read_text(encoding="utf-8")
            changed = re.sub(r"\n__all__ = \[(\n?)", rf'\n{code}\n__all__ = [\1"{part}", ', text)
            assert changed != text, f"{name} has no __all__"
        else:
            changed = code
        file.write_text(changed, encoding="utf-8")


@pytest.fixture(scope="module")
def extended(tmp_path_factory) -> Path:
    """A folder with a copy of the package to which all recipes were applied."""
    folder = tmp_path_factory.mktemp("extended")
    shutil.copytree(PACKAGE, folder / "mars2d", ignore=shutil.ignore_patterns("__pycache__"))
    for recipes in sections().values():
        follow(recipes, folder)
    return folder


def sections() -> dict[str, list[tuple[str, str, str]]]:
    """The recipes by the headings they stand under."""
    found = {}
    for section in re.split(r"^### ", GUIDE.read_text(encoding="utf-8"), flags=re.M)[1:]:
        title = section.partition("\n")[0]
        found[title] = RECIPE.findall(section.partition("\n## ")[0])
    return found


def test_a_recipe_touches_two_files_of_code_and_a_page():
    text = GUIDE.read_text(encoding="utf-8")
    for title, recipes in sections().items():
        assert len({name for name, _, _ in recipes}) == 2, title
        section = text.partition(f"### {title}\n")[2].partition("\n### ")[0]
        numbered = re.findall(r"^(\d)\. \*\*([^*]+)\*\*", section, flags=re.M)
        assert [number for number, _ in numbered] == ["1", "2", "3"], title
        assert [name for _, name in numbered[:2]] == [name for name, _, _ in recipes], title


RUN = """
import json, sys
import mars2d
from mars2d import Robot, Scenario, load_scenario, save_scenario
from mars2d.cli import command_line
from mars2d.sensors import Compass

assert mars2d.__file__.startswith(sys.argv[1]), mars2d.__file__
scenario = Scenario(robots=[Robot(sensors=[Compass()])], stop_time=3.0)
record = mars2d.run(scenario, control=lambda world: (0.3, 0.2))
assert save_scenario(scenario, "room.toml") == ()
again = load_scenario("room.toml")
assert again == scenario, again
assert mars2d.run(again, control=lambda world: (0.3, 0.2)).digest == record.digest
record.save("run.npz")
loaded = mars2d.load("run.npz")
assert (loaded.digest, loaded.missing, loaded.scenario) == (record.digest, (), scenario)
record.save_html("run.html")
assert "#d55e00" in scenario._repr_svg_(), "the layer is not drawn"
print(json.dumps([record.digest, record.sensors["compass"][-1].tolist()]))
assert command_line.main(["digest", "run.npz"]) == 0
"""


@pytest.mark.slow
def test_what_the_recipes_add_runs_and_is_saved_recorded_and_replayed(child, extended, tmp_path):
    code = f"import os, sys; os.chdir({str(tmp_path)!r}); sys.argv = ['', {str(extended)!r}]\n{RUN}"
    done = child(code, PYTHONPATH=str(extended))
    assert done.returncode == 0, done.stderr
    said, printed = done.stdout.splitlines()[-2:]
    digest, heading = json.loads(said)
    assert printed == digest
    assert np.ravel(heading)[0] == pytest.approx(3.0 * 0.2, abs=0.01)
    assert (tmp_path / "run.html").stat().st_size > 10_000


# -- a joint of the user's own, in this file ----------------------------------------------------


class Cord(Joint):
    """A joint of the user's own: a spring that a rope keeps from being overstretched."""

    slack: float = number(default=2.0, above=1, high=100, doc="its longest stretch, in parts of it")

    def constraints(self, apart):
        return MaxDistance(self.slack * apart), SpringDamper(apart, stiffness=4.0, damping=1.0)

    def draw(self, scene, start, end, length):
        scene.line([start, end], stroke="#123456")


def stretched(speed: float, **cord) -> np.ndarray:
    """How far apart a robot and the ball that it hauls by a cord are, m, in each row."""
    robot, ball = Robot(drive=Holonomic(max_force=50.0)), Ball(pose=(0, -1, 0))
    joints = [Cord(a="robot0", b="ball0", **cord)]
    scenario = Scenario(robots=[robot], props=[ball], joints=joints, workspace=None, stop_time=20)
    record = mars2d.run(scenario, control=lambda world: (0.0, speed))
    return record.pose[:, 1, 0] - record.prop_pose[:, 1, 0]


def test_a_joint_of_ones_own_holds_as_its_constraints_say():
    apart = stretched(0.2)
    assert apart[0] == 1.0
    assert 1.0 < apart.max() < 2.0  # the spring pulls
    assert apart[-1] == pytest.approx(1.0, abs=0.01)  # all go at one speed at last
    assert stretched(0.5, slack=1.05).max() < 1.05 + 1e-3  # and the rope holds
