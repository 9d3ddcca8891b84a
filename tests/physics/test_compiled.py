"""What is compiled is used where it fits its sources and pymunk; numbers and signals end it."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from pymunk._chipmunk_cffi import ffi, lib

import mars2d
from mars2d import Scenario, World
from mars2d.core.errors import InputError
from mars2d.physics import islands
from mars2d.physics.islands import library
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
    names = [*islands.build.MODULES, "build"]
    for source in [*(copied / f"{name}.py" for name in names), copied / "library.pxi"]:
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


FIELDS: dict[str, dict[str, tuple[int, str]]] = {
    "struct cpArbiter": {
        "a": (40, "struct cpShape *"),
        "b": (48, "struct cpShape *"),
        "body_a": (56, "struct cpBody *"),
        "body_b": (64, "struct cpBody *"),
        "count": (104, "int"),
        "contacts": (112, "struct cpContact *"),
        "n": (120, "struct cpVect"),
    },
    "struct cpContact": {
        "r1": (0, "struct cpVect"),
        "r2": (16, "struct cpVect"),
        "bounce": (48, "double"),
        "jnAcc": (56, "double"),
        "jtAcc": (64, "double"),
    },
    "struct cpCollisionHandler": {
        "preSolveFunc": (24, "void(*)(struct cpArbiter *, struct cpSpace *, void *)"),
        "userData": (48, "void *"),
    },
}
"""Fields of the engine's structs that are used directly: where they are, and their types."""

CONTACT_SIZE = 96
"""The size of the engine's struct of a contact."""


def test_the_engine_s_structs_have_their_numbers_where_they_are_looked_for():
    """Those that are told of; if numbers of bodies and joints are elsewhere, nothing goes right."""
    for name, wanted in FIELDS.items():
        fields = dict(ffi.typeof(name).fields)
        found = {each: (fields[each].offset, fields[each].type.cname) for each in wanted}
        assert found == wanted, name
    assert ffi.sizeof("struct cpContact") == CONTACT_SIZE


def test_a_space_has_the_number_of_its_next_shape_where_it_is_looked_for():
    space, body = lib.cpSpaceNew(), lib.cpBodyNew(1.0, 1.0)
    lib.cpSpaceAddBody(space, body)
    number = ffi.cast("uintptr_t *", space) + library.SHAPES
    shapes = [lib.cpCircleShapeNew(body, 1.0, (0.0, 0.0)) for _ in range(3)]
    for k, shape in enumerate(shapes):
        assert number[0] == k
        lib.cpSpaceAddShape(space, shape)
    library.number_shapes_again(space)
    assert number[0] == 0
    for shape in shapes:
        lib.cpSpaceRemoveShape(space, shape)
        lib.cpShapeFree(shape)
    lib.cpSpaceRemoveBody(space, body)
    lib.cpSpaceFree(space)
    lib.cpBodyFree(body)


def plain(kind: str) -> str:
    """Return a function's type with all pointers alike, and vectors by our name."""
    kind = kind.replace(" noexcept", "").replace("Vector *", "void *")
    kind = kind.replace("struct cpVect *", "void *").replace("struct cpVect", "Vector")
    return re.sub(r"struct \w+ \*", "void *", kind).replace("void)", ")").replace(" ", "")


def test_its_functions_have_the_types_by_which_they_are_called():
    for name, kind in islands.functions():
        found = ffi.typeof(ffi.addressof(lib, name)).cname
        assert plain(found) == plain(kind), name


def test_a_pymunk_whose_structs_are_unknown_is_refused(monkeypatch):
    for unknown in ("7.0.1", "7.99.0", "8.0.0"):
        monkeypatch.setattr("pymunk.version", unknown)
        with pytest.raises(InputError, match=rf"{unknown} .* pip install 'pymunk>=7.1,<7.\d'"):
            islands.islands()
    project = Path(__file__).parents[2] / "pyproject.toml"
    assert f"pymunk>=7.1,<7.{islands.NEWEST[1] + 1}" in project.read_text(encoding="utf-8")


def test_all_functions_that_it_calls_are_checked():
    """Each that stands in the C, in the order in which it takes addresses; `owned` counts kinds."""
    names = [name for name, _ in islands.functions()]
    assert len(names) == len(set(names)) > 60
    called = re.findall(r"\bengine\.(cp\w+)", islands.build.joined())
    first = names.index("cpPivotJointAlloc")
    assert len(library._KINDS) - 1 == library.ROTARY_SPRING
    made = names[first : first + len(library._KINDS)]
    assert made == [f"cp{kind}Alloc" for kind in library._KINDS]
    assert {*called, *made} == set(names)


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


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="signals are sent otherwise")
def test_ctrl_c_ends_a_control_step_of_ten_million_substeps(child):
    done = child(LONG)
    assert done.stdout == "Interrupted by Ctrl-C\n"
    assert done.stderr == ""
