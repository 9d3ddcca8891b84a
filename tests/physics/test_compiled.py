"""What is compiled is used where it fits its sources and pymunk; numbers and signals end it."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterator
from pathlib import Path

import cffi
import pytest

import mars2d
from mars2d import Scenario, World
from mars2d.physics import islands
from mars2d.physics.islands import chipmunk, layout
from mars2d.physics.settings import versions
from tests.islands import plainly

KNOWN = islands.reason_without()
compiled = pytest.mark.skipif(bool(KNOWN), reason=f"the engine runs in Python: {KNOWN}")


def is_compiled(world: World) -> bool:
    return type(world.simulation.engine._mover).__module__.endswith("._compiled")


# -- when it is not used --------------------------------------------------------------------


@pytest.fixture
def again() -> Iterator[None]:
    """What is compiled is loaded again in this test, and after it."""
    islands._loaded.cache_clear()
    yield
    islands._loaded.cache_clear()


@compiled
def test_mars2d_plain_switches_it_off():
    with plainly():
        assert islands.reason_without() == "the environment variable MARS2D_PLAIN is 1"
        assert not is_compiled(World(Scenario(robots=2)))
    assert islands.reason_without() == ""
    assert is_compiled(World(Scenario(robots=2)))


def in_python_because(reason: str) -> bool:
    return islands.reason_without() == reason and not is_compiled(World(Scenario(robots=2)))


@compiled
@pytest.mark.usefixtures("again")
def test_it_is_not_used_after_a_change_of_its_sources(monkeypatch):
    monkeypatch.setattr(islands, "fingerprint", lambda: "of other sources")
    assert in_python_because("its sources have changed since it was compiled")


@compiled
@pytest.mark.usefixtures("again")
def test_it_is_not_used_with_a_pymunk_that_it_was_not_written_for(monkeypatch):
    monkeypatch.setattr(islands, "CONTACT_SIZE", islands.CONTACT_SIZE + 8)
    version = versions()["pymunk"]
    assert in_python_because(
        f"pymunk {version} is not as it was written for: its struct cpContact has "
        f"{islands.CONTACT_SIZE - 8} bytes"
    )


STATE = """
from mars2d import Robot, Scenario, World
from mars2d.physics.islands import reason_without
World(Scenario(robots=2)).step()
print(reason_without())
"""


@pytest.fixture
def copied(tmp_path: Path) -> Path:
    """The islands of a copy of the package, in which nothing is compiled."""
    ignored = shutil.ignore_patterns("*.so", "*.pyd", "__pycache__", "examples")
    shutil.copytree(Path(mars2d.__file__).parent, tmp_path / "mars2d", ignore=ignored)
    return tmp_path / "mars2d" / "physics" / "islands"


@pytest.mark.slow
def test_where_it_was_not_compiled_worlds_do_without(copied, child):
    done = child(STATE, PYTHONPATH=str(copied.parents[2]))
    assert done.stdout == "it was not compiled when mars2d was installed\n", done.stderr


def test_a_change_of_any_of_its_sources_is_noticed(copied, monkeypatch):
    before = islands.fingerprint()
    monkeypatch.setattr(islands.build, "HERE", copied)
    assert islands.fingerprint() == before
    names = [*islands.build.MODULES, "build", "chipmunk"]
    for source in [*(copied / f"{name}.py" for name in names), copied / "chipmunk.pxi"]:
        text = source.read_text(encoding="utf-8")
        source.write_text(text + "# changed\n", encoding="utf-8")
        assert islands.fingerprint() != before, source
        source.write_text(text, encoding="utf-8")


@compiled
@pytest.mark.slow
def test_a_file_that_is_damaged_is_not_used(copied, child):
    made = Path(islands._loaded()[0].__file__)
    (copied / made.name).write_bytes(made.read_bytes()[1000:])
    done = child(STATE, PYTHONPATH=str(copied.parents[2]))
    assert done.stdout.startswith("it can't be loaded ("), done.stderr


# -- what it relies on ----------------------------------------------------------------------

ARBITER = """
typedef struct { double x, y; } cpVect;
struct cpContact { float jnAcc; double other; };
struct cpArbiter { int other; int count; };
int cpSpaceStep(void *space, double h);
double hypot(double x, double y);
"""


def changes(declared: str) -> list[str]:
    """How an engine that is declared like this differs."""
    other = cffi.FFI()
    other.cdef(declared)
    return list(islands.changes(other, other.dlopen(None)))


@pytest.mark.skipif(os.name == "nt", reason="the C library is opened otherwise")
def test_an_engine_of_another_shape_is_noticed(monkeypatch):
    """As pymunk might be some day: functions gone, or of other types; fields likewise."""
    found = changes(ARBITER)
    for text in (
        "it has no function cpSpaceStep", "it has no function cpArbiterGetPointB",
        "its struct cpArbiter has no field contacts", "its struct cpContact has no field jtAcc",
        "the field jnAcc of its struct cpContact is a float at 0",
        "the field count of its struct cpArbiter is a int at 4",
        "its struct cpContact has 16 bytes",
    ):  # fmt: skip
        assert text in found
    found = changes("struct other;")
    assert "its struct cpArbiter has no field count" in found
    monkeypatch.setattr(islands, "functions", lambda: [("hypot", "double(*)(double, float)")])
    assert "its function hypot is a double(*)(double, double)" in changes(ARBITER)


def test_numbers_that_the_engine_has_elsewhere_are_noticed(monkeypatch):
    """Neither the compiled module nor Python could use such an engine."""
    assert layout.misplaced() == ""
    for what, names in {
        "its bodies have their poses elsewhere": ("LEAD", "CENTER", "FAST", "ANGLE", "TURN"),
        "its joints have their impulses elsewhere": (
            "PIVOT_IMPULSE", "GEAR_IMPULSE", "GROOVE_IMPULSE",
        ),
        "its springs have their damping elsewhere": (
            "REST", "LOST", "EFFECTIVE_MASS", "EFFECTIVE_MOMENT",
        ),
    }.items():  # fmt: skip
        for name in names:
            with monkeypatch.context() as patch:
                patch.setattr(chipmunk, name, getattr(chipmunk, name) + 1)
                assert layout.misplaced.__wrapped__() == what, name
    monkeypatch.setattr(layout, "misplaced", lambda: "its bodies have their poses elsewhere")
    with pytest.raises(ImportError, match="can't be used: its bodies"):
        islands.islands()


def test_only_what_is_pointed_to_may_differ():
    """The islands know no body from another thing of the engine."""
    ours = islands._plain("Vector(*)(void *, double)")
    assert ours == islands._plain("struct cpVect(*)(struct cpBody *, double)")
    for other in (
        "struct cpBB(*)(struct cpBody *, double)", "struct cpVect(*)(struct cpBody *, float)",
        "struct cpVect(*)(struct cpBody *)", "void *",
    ):  # fmt: skip
        assert ours != islands._plain(other)


def test_all_functions_that_it_calls_are_checked():
    """Each that stands in the C of chipmunk.pxi, in the order in which it takes addresses."""
    names = [name for name, _ in islands.functions()]
    assert len(names) == len(set(names)) > 60
    called = re.findall(r"\bengine\.(cp\w+)", islands.build.joined())
    assert set(called) == set(names)


# -- numbers and signals --------------------------------------------------------------------


LOST = """
import numpy as np
from mars2d import Robot, Scenario, World
from mars2d.addons import Map

robots = [Robot(pose=(0.4 * (i % 7), 0.4 * (i // 7), i)) for i in range({n})]
world = World(Scenario(robots=robots, addons=[Map([[(-1, -1), (3, -1.2)]])], on_exit="wall"))
for speed in (1e200, 1e300, np.inf, np.nan):
    twist = np.zeros((3, {n}))
    twist[:, ::3] = speed
    for _ in range(3):
        try:
            world.simulation.engine.drive(twist, 0.1, 0.0)
        except FloatingPointError:
            pass
print("over")
"""


def test_numbers_out_of_all_bounds_neither_hang_nor_crash_it(child):
    done = child(LOST.format(n=40))
    assert done.stdout == "over\n", done.stderr


LONG = """
import os, signal, threading, time
from mars2d import Robot, Scenario, World
from mars2d.addons import Map

walls = Map([[(0.2, -1), (0.2, 1)]])
scenario = Scenario(robots=[Robot()], addons=[walls], sampling_time=1e4, stop_time=1e6)
world = World(scenario, lambda world: [[0.1], [0.0]])
threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    world.step()
except KeyboardInterrupt:
    print(world.over_message)
"""


@pytest.mark.skipif(os.name == "nt", reason="signals are sent otherwise")
def test_ctrl_c_ends_a_control_step_of_ten_million_substeps(child):
    done = child(LONG)
    assert done.stdout == "Interrupted by Ctrl-C\n"
    assert done.stderr == ""
