"""Parts that other packages ship by an entry point: used like MARS2D's own, and never its end."""

from __future__ import annotations

import importlib
import re
import sys
import tomllib
from pathlib import Path
from textwrap import dedent

import pytest

import mars2d
from mars2d.cli.command_line import main
from mars2d.scenario import registry, serialize
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.registry import BASES, members
from tests.cases import each_case

LIDAR = '''
from mars2d import Addon, Drive, Sensor
from mars2d.addons import Map
from mars2d.core.description import number
from mars2d.sensors import DISTANCE


class Lidar(Sensor):
    """One beam, straight ahead."""

    quantities = (DISTANCE,)
    range: float = number(default=2.0, above=0, unit="m", doc="how far it sees")

    def read(self, robot, world, rng):
        x, y, theta = robot.pose
        return world.ray((x, y), theta, self.range, robot.index)


class Fence(Addon):
    """A fence with a gap."""

    def obstacles(self):
        return [[(2, -1), (2, 1)]]

    def on_step(self, world):
        world.robots[0].memory.told  # what only a law sets


class Crab(Drive):
    """Goes sideways."""

    gain: float = 1.0

    def twist(self, command):
        import numpy as np

        return np.array([0 * command[0], self.gain * command[0], command[1]])
'''

SCENARIO = """
import acme
from mars2d import Robot, Scenario

def law(robot):
    return 0.3, 0.1

def scenario(addons=()):
    sensors = [acme.Lidar(range=3.0)]
    robot = Robot(sensors=sensors, drive=acme.Crab(gain=0.5), controller=law)
    return Scenario(robots=[robot], addons=list(addons), stop_time=2)
"""


def forget() -> None:
    """Look for packages again when a part is asked for."""
    importlib.invalidate_caches()
    registry.plugins.cache_clear()
    serialize._kinds.cache_clear()
    for name in [name for name in sys.modules if name.startswith(("acme", "alpha", "beta"))]:
        del sys.modules[name]


@pytest.fixture
def site(tmp_path: Path, monkeypatch):
    """Installs packages by hand, as pip lays them out, into a folder of the search path."""
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def install(name: str, version: str, entry_points: str, **modules: str) -> None:
        info = tmp_path / f"{name.replace('-', '_')}-{version}.dist-info"
        info.mkdir(exist_ok=True)
        metadata = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n"
        (info / "METADATA").write_text(metadata, encoding="utf-8")
        (info / "entry_points.txt").write_text(dedent(entry_points), encoding="utf-8")
        for module, code in modules.items():
            (tmp_path / f"{module}.py").write_text(dedent(code), encoding="utf-8")
        forget()

    yield install
    forget()


@pytest.fixture
def acme(site):
    """A package with a sensor, an add-on and a drive."""
    entry_points = """
    [mars2d.sensors]
    lidar = acme:Lidar
    [mars2d.addons]
    fence = acme:Fence
    [mars2d.bodies]
    crab = acme:Crab
    """
    site("acme-robots", "1.2", entry_points, acme=LIDAR)
    return importlib.import_module("acme")


@pytest.fixture
def record(acme, tmp_path: Path) -> Path:
    """The file of a run with parts of the package."""
    (tmp_path / "with_acme.py").write_text(SCENARIO)
    return mars2d.run(tmp_path / "with_acme.py").save(tmp_path / "run.npz")


def told(capsys, *words: object) -> str:
    """What a command prints."""
    main([str(word) for word in words])
    return "".join(capsys.readouterr())


def test_a_part_of_another_package_is_a_member_of_its_family(acme, capsys):
    assert members("sensors")["Lidar"] is acme.Lidar
    assert members("addons")["Fence"] is acme.Fence
    assert members("bodies")["Crab"] is acme.Crab
    assert "Proximity" in members("sensors")
    assert "Lidar" not in members("props")
    lines = told(capsys, "list").splitlines()
    [line] = [line for line in lines if line.split()[:1] == ["Lidar"]]
    assert line.endswith("One beam, straight ahead. (acme-robots 1.2)")
    assert [line for line in lines if line.split()[:1] == ["Map"] and "acme" not in line]
    assert "not usable" not in "\n".join(lines)


def test_nothing_of_another_package_is_loaded_by_importing_mars2d_or_by_a_run(
    child, acme, tmp_path
):
    code = """
    import sys, mars2d
    mars2d.run(mars2d.Scenario(), stop_time=1)
    print("acme" in sys.modules)
    """
    assert child(dedent(code), PYTHONPATH=str(tmp_path)).stdout == "False\n"


def test_a_record_brings_the_parts_of_installed_packages_back(acme, record, capsys):
    loaded = mars2d.load(record)
    [robot] = loaded.scenario.robots
    assert robot.sensors == (acme.Lidar(range=3.0),)
    assert robot.drive == acme.Crab(gain=0.5)
    assert loaded.missing == ()
    assert "bit-identical" in told(capsys, "check", record)


def test_without_the_package_the_record_says_what_it_lacks_and_of_which_package(
    record, tmp_path, capsys
):
    (tmp_path / "acme_robots-1.2.dist-info" / "entry_points.txt").unlink()
    forget()
    said = told(capsys, "check", record)
    assert "drive Crab (of the package acme-robots)" in said
    assert "sensor Lidar (of the package acme-robots)" in said


def test_a_record_of_another_version_of_the_package_is_read_without_its_parts(record, tmp_path):
    (tmp_path / "acme.py").write_text(LIDAR.replace("above=0", "above=0, high=1"))
    forget()
    assert mars2d.load(record).missing == ("sensor Lidar (of the package acme-robots)",)


def test_a_record_can_be_run_again_without_the_laws_that_an_addon_needs(acme, tmp_path, capsys):
    def law(robot):
        robot.memory.told = 1
        return 0.3, 0.1

    (tmp_path / "with_acme.py").write_text(SCENARIO)
    scenario = open_experiment(tmp_path / "with_acme.py").scenario.with_laws([law])
    world = mars2d.World(scenario.replace(addons=[acme.Fence()]))
    world.robots[0].memory.told = 0
    while not world.over:
        world.step()
    assert "bit-identical" in told(capsys, "check", world.record.save(tmp_path / "run.npz"))


BROKEN = {
    "raises": ("x = acme_bad:Lost", "raise OSError('no device')", "can't be loaded: OSError: no"),
    "leaves": ("x = acme_bad:Lost", "import sys; sys.exit(3)", "can't be loaded: SystemExit: 3"),
    "is missing": ("x = acme_bad:Lots", "Lost = 1", "AttributeError"),
    "is no class": ("x = acme_bad:Lost", "Lost = 1", "is 1: expected a class derived from Sensor"),
    "is of another family": (
        "x = acme_bad:Lost",
        "from mars2d import Addon\nclass Lost(Addon): pass",
        "expected a class derived from Sensor",
    ),
    "has no module": ("x = acme_gone:Lost", "", "No module named 'acme_gone'"),
}


@each_case("fault", BROKEN)
def test_a_broken_part_has_its_error_and_breaks_nothing(site, acme, fault):
    entry, code, problem = BROKEN[fault]
    site("acme-bad", "0.1", f"[mars2d.sensors]\n{entry}\n", acme_bad=code)
    [part] = [part for part in registry.plugins("sensors") if part.package == "acme-bad"]
    assert problem in part.problem
    assert "Lidar" in members("sensors")  # what works still does


def test_a_broken_part_and_a_misspelt_group_are_listed(site, capsys):
    site("acme-bad", "0.1", "[mars2d.sensors]\nx = acme_gone:X\n[mars2d.sensor]\ny = acme_gone:Y")
    for verb in ("list", "doctor"):
        said = told(capsys, verb)
        assert "No module named 'acme_gone'" in said
        assert "acme-bad 0.1" in said
        assert "did you mean 'mars2d.sensors'?" in said


def test_a_name_of_mars2ds_own_wins_and_that_is_said(site):
    code = "from mars2d import Sensor\nclass Proximity(Sensor): pass"
    site("acme-near", "2.0", "[mars2d.sensors]\nnear = acme_near:Proximity", acme_near=code)
    assert members("sensors")["Proximity"].__module__ == "mars2d.sensors.proximity"
    problems = [part.problem for part in registry.plugins("sensors")]
    assert "MARS2D itself has a Proximity, which is used in its place" in problems


def test_the_groups_in_the_documents_are_those_that_are_looked_up():
    text = (Path(__file__).parents[2] / "docs" / "own_sensor_and_addon.md").read_text("utf-8")
    project = tomllib.loads("[build-system]" + text.partition("[build-system]")[2].split("```")[0])
    assert set(project["project"]["entry-points"]) == {"mars2d.sensors"}
    assert set(re.findall(r"`mars2d\.(\w+)`", text)) == set(BASES)


def test_a_class_of_the_same_name_in_a_file_of_ones_own_is_not_taken_for_the_packages(
    acme, tmp_path
):
    class Lidar(mars2d.Sensor):
        def read(self, robot, world, rng):
            return 1.0

    scenario = mars2d.Scenario(robots=[mars2d.Robot(sensors=[Lidar()])], stop_time=1)
    path = mars2d.run(scenario).save(tmp_path / "run.npz")
    assert mars2d.load(path).missing == ("sensor Lidar",)
