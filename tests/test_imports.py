"""Imports point downwards only, and importing MARS2D is quick and has no side effects."""

from __future__ import annotations

import ast
import statistics
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

import mars2d

PACKAGE = Path(mars2d.__file__).parent

LAYERS = [
    {"errors", "beginning"},
    {"geometry", "description"},
    {
        "contact",
        "delay",
        "motion",
        "clearance",
        "convex",
        "progress",
        "streams",
        "live",
        "rays",
        "fans",
        "message",
        "burst",
        "pixels",
        "quadrature",
        "brackets",
        "reference",
        "replacing",
        "storage",
        "interrupt",
        "terminal",
    },
    {
        "registry",
        "scene",
        "checks",
        "materials",
        "prediction",
        "usercode",
        "quantity",
        "neighbours",
    },
    {
        "shapes",
        "bearings",
        "imperfection",
        "reckoning",
        "kernel",
        "maps",
        "picture",
        "excerpt",
        "potential",
        "tessellation",
    },
    {"bodies", "sensors", "addons", "animation", "joints", "rigid"},
    {"props", "robot", "tie", "starts", "encounter", "sensing"},
    {"looks", "limits", "floor", "tethers"},
    {"scenario"},
    {"options", "placement", "teleop"},
    {"map_option"},
    {"frame", "plain", "files", "pace", "space", "changes"},
    {"interventions", "reopening"},
    {
        "clutches",
        "grips",
        "record",
        "control",
        "forces",
        "surroundings",
        "views",
        "links",
        "channel",
        "scenario_file",
        "listing",
    },
    {"engine", "recorder", "names", "velocities"},
    {"formats"},
    {"kinematics"},
    {"hands"},
    {"world"},
    {"loop", "rerun", "testing", "bench"},
    {"timeline"},
    {"view"},
    {"output"},
    {"session", "doctor"},
    {"study"},
    {"paper"},
    {"commands"},
    {"cli"},
    {"__main__"},
]
"""The modules and folders of the package, low to high: each imports from below only."""

LAZY_UPWARDS = {
    ("record", "output"),
    ("record", "formats"),
    ("scenario", "output"),
    ("world", "output"),
    ("scenario", "scenario_file"),
    ("files", "scenario_file"),
    ("view", "output"),
}
"""Imported when they are called: figures, films and pages by Record.plot and the like, files by
Record.save; scenario_file by Scenario.from_file, Scenario.save and open_experiment, since what
reads a scenario loads laws as experiments are; output.filming by the window that is filmed.
"""

HEAVY = {"pygame", "matplotlib", "scipy", "shapely", "ezdxf", "svgelements", "yaml"}

FILES = sorted(path for path in PACKAGE.rglob("*.py") if "examples" not in path.parts)


def _level(part: str) -> int:
    return next(i for i, layer in enumerate(LAYERS) if part in layer)


def _imports(tree: ast.AST, *, in_function: bool = False) -> Iterator[tuple[str, bool]]:
    """Yield each module that is imported at run time, and whether a function does it."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            continue
        if isinstance(node, ast.Import):
            yield from ((alias.name, in_function) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "imports are absolute"
            assert node.module is not None
            for alias in node.names:
                module = node.module
                folder = PACKAGE.parent / module.replace(".", "/")
                is_module = any(
                    (folder / place).exists()
                    for place in (f"{alias.name}.py", f"{alias.name}/__init__.py")
                )
                yield (f"{module}.{alias.name}" if is_module else module), in_function
        else:
            inside = isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda))
            yield from _imports(node, in_function=in_function or inside)


@cache
def _own_imports(path: Path) -> list[tuple[str, bool]]:
    return list(_imports(ast.parse(path.read_text(encoding="utf-8"))))


def _part(module: str) -> str:
    """Return the layer's name of ``mars2d.view.window``: ``view``."""
    parts = module.split(".")
    return parts[1] if len(parts) > 1 else "__init__"


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_a_module_imports_only_from_layers_below(path: Path) -> None:
    relative = path.relative_to(PACKAGE).with_suffix("")
    part = relative.parts[0]
    if part == "__init__":
        return  # the public names may come from anywhere
    for module, in_function in _own_imports(path):
        if not module.startswith("mars2d"):
            continue
        target = _part(module)
        if target == "__init__":
            top = in_function or part in ("cli", "commands")
            assert top, f"{relative} imports mars2d itself: a circle"
            continue
        if target == part:
            continue
        if in_function and (part, target) in LAZY_UPWARDS:
            continue
        assert _level(target) < _level(part), f"{relative} imports {module}, which is not below it"


BASES = {"addons": ("base", "contest")}
"""What siblings may import, where it is not the base alone."""


@pytest.mark.parametrize("folder", ["bodies", "sensors", "addons", "props", "joints"])
def test_siblings_in_a_folder_import_only_their_base(folder: str) -> None:
    for path in (PACKAGE / folder).glob("*.py"):
        if path.stem in ("__init__", "base"):
            continue
        mine = [m for m, _ in _own_imports(path) if m.startswith(f"mars2d.{folder}")]
        bases = {f"mars2d.{folder}.{base}" for base in BASES.get(folder, ("base",))}
        assert set(mine) <= bases, path


@pytest.mark.parametrize(
    "part", ["view", "output", "sensors", "addons", "record", "scene", "frame", "looks"]
)
def test_who_draws_senses_or_reports_never_touches_the_engine(part: str) -> None:
    files = [p for p in FILES if p.relative_to(PACKAGE).with_suffix("").parts[0] == part]
    assert files
    for path in files:
        modules = {module for module, _ in _own_imports(path)}
        inside = {
            f"mars2d.{name}"
            for name in ("clutches", "engine", "grips", "kinematics", "rays", "space")
        }
        assert not {m for m in modules if m in inside or m.split(".")[0] == "pymunk"}, path


def test_few_modules_alone_know_the_engine_library() -> None:
    knows = {path.name for path in FILES for m, _ in _own_imports(path) if m.startswith("pymunk")}
    assert knows == {"rays.py", "space.py", "chipmunk.py", "yardstick.py"}


def test_no_module_imports_anything_heavy_when_it_is_imported() -> None:
    for path in FILES:
        if path.relative_to(PACKAGE).parts[0] in ("view", "output"):
            continue
        at_once = {module.split(".")[0] for module, lazy in _own_imports(path) if not lazy}
        assert not at_once & HEAVY, path


def test_every_module_has_its_layer() -> None:
    parts = {path.relative_to(PACKAGE).with_suffix("").parts[0] for path in FILES}
    assert parts - {"__init__"} <= set().union(*LAYERS)


def test_the_import_test_sees_imports_in_functions_and_skips_those_for_types() -> None:
    code = (
        "if TYPE_CHECKING:\n    from mars2d.world import World\n"
        "def f():\n    from mars2d.output.figure import plot\n"
        "try:\n    import mars2d.engine\nexcept ImportError:\n    pass\n"
    )
    assert list(_imports(ast.parse(code))) == [
        ("mars2d.output.figure", True),
        ("mars2d.engine", False),
    ]


def test_importing_the_package_loads_nothing_heavy(child) -> None:
    code = f"import mars2d, sys; print(sorted({HEAVY!r} & set(sys.modules)))"
    assert child(code).stdout.strip() == "[]"


def test_running_a_small_experiment_loads_no_display(child) -> None:
    code = (
        "import mars2d, sys; mars2d.run(mars2d.Scenario(), stop_time=1);"
        "print(sorted({'pygame', 'matplotlib'} & set(sys.modules)))"
    )
    assert child(code).stdout.strip() == "[]"


def test_importing_the_package_has_no_side_effects(child, tmp_path) -> None:
    code = (
        "import os, random, sys, warnings, signal\n"
        "import numpy as np\n"
        f"os.chdir({str(tmp_path)!r})\n"
        "def state():\n"
        "    legacy = np.random.get_state()\n"
        "    return (random.getstate(), legacy[1].tolist(), legacy[2:], np.geterr(),\n"
        "            np.get_printoptions(), dict(os.environ), os.getcwd(),\n"
        "            list(warnings.filters), signal.getsignal(signal.SIGINT))\n"
        "before = state()\n"
        "import mars2d\n"
        "assert state() == before\n"
        "print('same')"
    )
    result = child(code)
    assert result.stdout.strip() == "same", result.stderr
    assert result.stderr == ""
    assert list(tmp_path.iterdir()) == []


def test_importing_mars2d_takes_less_than_one_and_a_half_times_numpy_and_pymunk(
    child, tmp_path
) -> None:
    """The processor's time of both in one process: machines, and how busy they are, differ.

    Modules are compiled by the first run, as those of an installed package are.
    """
    code = (
        "import time; start = time.process_time()\n"
        "import numpy, pymunk, pymunk.batch; middle = time.process_time()\n"
        "import mars2d; print(middle - start, time.process_time() - middle)"
    )
    # Other tests' libraries may leave numpy one thread, without which it starts quicker.
    threads = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "")
    written = {"PYTHONDONTWRITEBYTECODE": "", "PYTHONPYCACHEPREFIX": str(tmp_path)}
    times = [
        [float(each) for each in child(code, **threads, **written).stdout.split()] for _ in range(6)
    ]
    ratios = [ours / theirs for theirs, ours in times[1:]]  # one right after the other: the clock
    assert statistics.median(ratios) < 1.5  # of a processor changes within seconds
