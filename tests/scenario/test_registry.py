"""Parts that other packages ship by an entry point: used like MARS2D's own, and never its end."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from textwrap import dedent

import pytest

from mars2d.scenario.registry import BASES

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
import mars2d, acme
from mars2d import Robot, Scenario

def law(robot):
    return 0.3, 0.1

def scenario(addons=()):
    sensors = [acme.Lidar(range=3.0)]
    robot = Robot(sensors=sensors, drive=acme.Crab(gain=0.5), controller=law)
    return Scenario(robots=[robot], addons=list(addons), stop_time=2)
"""


@pytest.fixture
def site(tmp_path: Path):
    """A folder that packages are installed into by hand, as pip lays them out, offline."""

    def install(name: str, version: str, entry_points: str, **modules: str) -> Path:
        info = tmp_path / f"{name.replace('-', '_')}-{version}.dist-info"
        info.mkdir()
        metadata = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n"
        (info / "METADATA").write_text(metadata, encoding="utf-8")
        (info / "entry_points.txt").write_text(dedent(entry_points), encoding="utf-8")
        for module, code in modules.items():
            (tmp_path / f"{module}.py").write_text(dedent(code), encoding="utf-8")
        return tmp_path

    return install


@pytest.fixture
def acme(site) -> Path:
    """A package with a sensor, an add-on and a drive."""
    entry_points = """
    [mars2d.sensors]
    lidar = acme:Lidar
    [mars2d.addons]
    fence = acme:Fence
    [mars2d.bodies]
    crab = acme:Crab
    """
    return site("acme-robots", "1.2", entry_points, acme=LIDAR)


def ran(child, folder: Path, code: str) -> str:
    """What code prints that runs where the packages in a folder are installed."""
    done = child(dedent(code), PYTHONPATH=str(folder))
    assert done.returncode == 0, done.stderr
    return done.stdout


def command(child, folder: Path, *words: str):
    """A command of MARS2D where the packages in a folder are installed."""
    code = f"import sys; from mars2d.cli.command_line import main; sys.exit(main({list(words)!r}))"
    return child(code, PYTHONPATH=str(folder))


def test_a_part_of_another_package_is_a_member_of_its_family(child, acme):
    code = """
    import acme
    from mars2d.scenario.registry import members
    assert members("sensors")["Lidar"] is acme.Lidar
    assert members("addons")["Fence"] is acme.Fence
    assert members("bodies")["Crab"] is acme.Crab
    assert "Proximity" in members("sensors") and "Lidar" not in members("props")
    """
    ran(child, acme, code)


def test_the_list_names_the_package_of_a_part(child, acme):
    lines = command(child, acme, "list").stdout.splitlines()
    [line] = [line for line in lines if line.split()[:1] == ["Lidar"]]
    assert line.endswith("One beam, straight ahead. (acme-robots 1.2)")
    assert [line for line in lines if line.split()[:1] == ["Map"] and "acme" not in line]
    assert "not usable" not in "\n".join(lines)


def test_nothing_of_another_package_is_loaded_by_importing_mars2d_or_by_a_run(child, acme):
    code = """
    import sys, mars2d
    mars2d.run(mars2d.Scenario(), stop_time=1)
    print("acme" in sys.modules, "importlib.metadata" in sys.modules)
    """
    assert ran(child, acme, code).split()[0] == "False"


@pytest.mark.slow
def test_a_record_brings_the_parts_of_installed_packages_back(child, acme, tmp_path):
    made = f"{SCENARIO}\nmars2d.run(scenario()).save('run.npz')\n"
    ran(child, acme, f"import os; os.chdir({str(tmp_path)!r})\n{made}")
    read = f"""
    import acme, mars2d
    record = mars2d.load({str(tmp_path / "run.npz")!r})
    [robot] = record.scenario.robots
    assert robot.sensors == (acme.Lidar(range=3.0),), robot.sensors
    assert robot.drive == acme.Crab(gain=0.5), robot.drive
    print(record.missing)
    """
    assert ran(child, acme, read) == "()\n"
    checked = command(child, acme, "check", str(tmp_path / "run.npz"))
    assert checked.returncode == 0, checked.stderr
    assert "bit-identical" in checked.stdout


def test_without_the_package_the_record_says_what_it_lacks_and_of_which_package(
    child, acme, tmp_path
):
    made = f"{SCENARIO}\nmars2d.run(scenario()).save('run.npz')\n"
    ran(child, acme, f"import os; os.chdir({str(tmp_path)!r})\n{made}")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    done = command(child, elsewhere, "check", str(tmp_path / "run.npz"))
    assert done.returncode == 2
    assert "drive Crab (of the package acme-robots)" in done.stderr
    assert "sensor Lidar (of the package acme-robots)" in done.stdout


def test_a_record_of_another_version_of_the_package_is_read_without_its_parts(
    child, acme, tmp_path
):
    made = f"{SCENARIO}\nmars2d.run(scenario()).save('run.npz')\n"
    ran(child, acme, f"import os; os.chdir({str(tmp_path)!r})\n{made}")
    (acme / "acme.py").write_text(LIDAR.replace("above=0", "above=0, high=1"), encoding="utf-8")
    read = f"import mars2d; print(mars2d.load({str(tmp_path / 'run.npz')!r}).missing)"
    assert ran(child, acme, read) == "('sensor Lidar (of the package acme-robots)',)\n"


def test_a_record_can_be_run_again_without_the_laws_that_an_addon_needs(child, acme, tmp_path):
    made = f"""{SCENARIO}
def law(robot):
    robot.memory.told = 1
    return 0.3, 0.1

class World(mars2d.World):
    pass

s = scenario([acme.Fence()])
world = mars2d.World(s.replace(robots=[s.robots[0].replace(controller=law)]))
world.robots[0].memory.told = 0
while not world.over:
    world.step()
world.record.save('run.npz')
"""
    ran(child, acme, f"import os; os.chdir({str(tmp_path)!r})\n{made}")
    done = command(child, acme, "check", str(tmp_path / "run.npz"))
    assert done.returncode == 0, done.stderr
    assert "bit-identical" in done.stdout


BROKEN = {
    "raises": ("x = acme_bad:Lost", "raise OSError('no device')", "can't be loaded: OSError: no"),
    "whim": (
        "x = acme_bad:Lost",
        "import asyncio; raise asyncio.CancelledError",
        "can't be loaded: CancelledError",
    ),
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


@pytest.mark.slow
@pytest.mark.parametrize("fault", BROKEN)
def test_a_broken_part_is_named_with_its_error_and_breaks_nothing(child, site, acme, fault):
    entry, code, problem = BROKEN[fault]
    site("acme-bad", "0.1", f"[mars2d.sensors]\n{entry}\n", acme_bad=code)
    done = command(child, acme, "list")
    assert done.returncode == 0, done.stderr
    [line] = [line for line in done.stdout.splitlines() if "acme-bad 0.1" in line]
    assert problem in line
    assert "Lidar" in done.stdout  # what works still does
    doctor = command(child, acme, "doctor")
    assert doctor.returncode == 0, doctor.stderr
    [line] = [line for line in doctor.stdout.splitlines() if "acme-bad 0.1" in line]
    assert line.startswith("--")
    assert problem in line


def test_a_name_of_mars2ds_own_wins_and_that_is_said(child, site, tmp_path):
    code = "from mars2d import Sensor\nclass Proximity(Sensor): pass"
    site("acme-near", "2.0", "[mars2d.sensors]\nnear = acme_near:Proximity", acme_near=code)
    check = """
    import mars2d
    from mars2d.scenario.registry import members
    print(members("sensors")["Proximity"].__module__)
    """
    assert ran(child, tmp_path, check) == "mars2d.sensors.proximity\n"
    listed = command(child, tmp_path, "list").stdout
    assert "MARS2D itself has a Proximity, which is used in its place (acme-near 2.0)" in listed


def test_of_two_packages_with_one_name_the_first_in_the_alphabet_wins(child, site, tmp_path):
    for name in ("beta", "alpha"):
        code = f"from mars2d import Sensor\nclass Radar(Sensor):\n    '''Of {name}.'''\n"
        site(name, "1", f"[mars2d.sensors]\nradar = {name}:Radar", **{name: code})
    listed = command(child, tmp_path, "list").stdout
    assert "Of alpha. (alpha 1)" in listed
    assert "alpha has a Radar, which is used in its place (beta 1)" in listed


@pytest.mark.slow
def test_a_misspelt_group_does_not_go_unnoticed(child, site, tmp_path):
    site("acme", "1", "[mars2d.sensor]\nx = acme_x:X")
    for verb in ("list", "doctor"):
        assert "did you mean 'mars2d.sensors'?" in command(child, tmp_path, verb).stdout


def test_the_groups_in_the_documents_are_those_that_are_looked_up():
    text = (Path(__file__).parents[2] / "docs" / "own_sensor_and_addon.md").read_text("utf-8")
    project = tomllib.loads("[build-system]" + text.partition("[build-system]")[2].split("```")[0])
    assert set(project["project"]["entry-points"]) == {"mars2d.sensors"}
    assert set(re.findall(r"`mars2d\.(\w+)`", text)) == set(BASES)


def test_a_class_of_the_same_name_in_a_file_of_ones_own_is_not_taken_for_the_packages(
    child, acme, tmp_path
):
    code = f"""
    import mars2d
    from mars2d import Robot, Scenario, Sensor
    class Lidar(Sensor):
        def read(self, robot, world, rng):
            return 1.0
    path = {str(tmp_path / "run.npz")!r}
    mars2d.run(Scenario(robots=[Robot(sensors=[Lidar()])], stop_time=1)).save(path)
    print(mars2d.load(path).missing)
    """
    assert ran(child, acme, code) == "('sensor Lidar',)\n"
