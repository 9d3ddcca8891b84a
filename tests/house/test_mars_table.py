"""Every field of the paper's Table 1 has its home, as docs/from_mars.md says.

Source: Casini & Garulli (2016), Table 1.
"""

from __future__ import annotations

import ast
import re
import shlex
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mars2d import Animation, Holonomic, Robot, Scenario, Unicycle
from mars2d.scenario.experiment import open_experiment
from tests.cases import each_case

PAGE = Path(__file__).parents[2] / "docs" / "from_mars.md"

DESCRIPTIONS: dict[str, type] = {
    kind.__name__: kind for kind in (Scenario, Robot, Animation, Unicycle, Holonomic)
}


def rows() -> list[list[str]]:
    """The rows of the table: MARS's name, homes, meaning, default there, default here."""
    text = PAGE.read_text(encoding="utf-8").partition("## The fields of Table 1")[2]
    lines = [line for line in text.partition("\n## ")[0].splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[1:]]


def homes(row: list[str]) -> list[str]:
    return re.findall(r"`([^`]+)`", row[1])


def declared(kind: type, name: str) -> Any:
    """The dataclass field of a description, or None."""
    return next((field for field in fields(kind) if field.name == name), None)


def written(default: str) -> Any:
    """The value that stands in the column of defaults."""
    text = default.strip("`")
    made = {"Unicycle()": Unicycle(), "Holonomic()": Holonomic()}
    return made[text] if text in made else ast.literal_eval(text)


def test_the_table_has_each_field_of_the_paper_once():
    assert len({row[0] for row in rows()}) == len(rows()) == 34


@each_case("row", rows())
def test_each_default_is_the_one_stated(row):
    stated = []
    for home in homes(row):
        owner, _, name = home.partition(".")
        field = declared(DESCRIPTIONS[owner], name) if owner in DESCRIPTIONS else None
        if field is not None:
            default = field.default if field.default is not MISSING else field.default_factory()
            assert default == written(row[4]), home
            assert type(default) is type(written(row[4])), home
            stated.append(home)
    assert stated or row[4] == "-"


def test_one_command_of_the_page_restores_all_of_marss_values():
    (command,) = re.findall(r"^mars2d run random_walk (.*)$", PAGE.read_text("utf-8"), flags=re.M)
    arguments = [word for word in shlex.split(command) if "=" in word]
    settings = {name: ast.literal_eval(value) for name, value in (a.split("=") for a in arguments)}
    here = open_experiment("random_walk", settings).scenario
    robot = here.robots[1]
    marss = {row[0]: row[3].strip("()") for row in rows()}
    found = {
        "Sampling_time": here.sampling_time,
        "Robot.Max_linear_speed": robot.drive.max_linear_speed,
        "Robot.Wheels_semiaxis_length": robot.drive.wheel_semiaxis,
        "Robot.Diameter": robot.diameter,
        "Robot.Distance_center_barycenter": robot.center_offset,
    }
    assert found == {name: float(marss[name]) for name in found}
    assert (here.workspace, marss["Workspace"]) == (None, "open")
    assert len(settings) == 6
    # Algorithm 2 turns at up to 3 pi / 2 rad/s: MARS's wheels cut this at 4, those here do not
    fastest = np.array([[0.0], [3 * np.pi / 2]])
    assert robot.drive.saturate(fastest)[1, 0] == pytest.approx(4.0)
    assert np.array_equal(Unicycle().saturate(fastest), fastest)


def test_what_stands_beside_marss_words_works_as_written():
    text, matrix = PAGE.read_text(encoding="utf-8"), np.array([(1, 3, 0), (9, 7, np.pi)]).T
    names = {"Robot": Robot, "Animation": Animation, "P": matrix, "pi": np.pi}

    def made(code: str) -> Any:
        assert f"{code}`" in text
        return eval(code, names)

    for code in ("[Robot(pose=(1, 3, 0)), Robot(pose=(9, 7, pi))]", "[Robot(pose=p) for p in P.T]"):
        scenario = Scenario(robots=made(code), workspace=None)
        assert np.array_equal(scenario.initial_pose, matrix)
    red, blue = made('Animation(base_colors=["r", "b"])').base_colors
    assert (red, blue) == (made('Robot(color="r")').color, Robot(color="b").color)
    square = [(0, 0), (0, 1), (1, 1), (1, 0)]
    assert Scenario(workspace=[*square, (0, 0)]).workspace == Scenario(workspace=square).workspace
