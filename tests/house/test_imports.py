"""Imports point downwards only, and importing MARS2D is quick and has no side effects."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import mars2d
from tests.cases import each_case

PACKAGE = Path(mars2d.__file__).parent

LAYERS = [
    {"core"},
    {"geometry"},
    {"bodies", "sensors", "addons"},
    {"scenario"},
    {"record"},
    {"physics", "output"},
    {"world"},
    {"window", "study", "testing", "rl"},
    {"reports", "tournaments"},
    {"cli"},
]
"""The rooms of the house, low to high: each imports from below only, for types and late as well."""

DERIVED = {"recorder.py"}
"""Modules whose classes derive from those of a heavy library: they are imported where used."""

HEAVY = {"pygame", "matplotlib", "scipy", "shapely", "ezdxf", "wasmtime", "yaml"}

FILES = sorted(path for path in PACKAGE.rglob("*.py") if "examples" not in path.parts)


MODULES = {
    ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts).removesuffix(".__init__")
    for path in FILES
}

ROOMS = sorted({room for layer in LAYERS for room in layer})


def _level(room: str) -> int:
    return next(i for i, layer in enumerate(LAYERS) if room in layer)


def _imports(tree: ast.AST, kind: str = "module") -> Iterator[tuple[str, str]]:
    """Yield each module that is imported, and its kind: "module", "typing" or "lazy"."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.Import):
            yield from ((alias.name, kind) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "imports are absolute"
            assert node.module is not None
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                yield (whole if whole in MODULES else node.module), kind
        elif isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            yield from _imports(node, "typing")
        elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield from _imports(node, "lazy")
        elif isinstance(node, (ast.stmt, ast.excepthandler)):  # expressions import nothing
            yield from _imports(node, kind)


@cache
def _own_imports(path: Path) -> list[tuple[str, str]]:
    return list(_imports(ast.parse(path.read_text(encoding="utf-8"))))


def _room(path: Path) -> str:
    return path.relative_to(PACKAGE).with_suffix("").parts[0]


def test_the_top_of_the_package_shows_its_rooms_and_nothing_else() -> None:
    there = {_room(path) for path in FILES} - {"__init__", "__main__"}
    assert there == set(ROOMS)
    assert len(there) <= 17


@each_case("path", FILES)
def test_a_module_imports_only_from_rooms_below(path: Path) -> None:
    room = _room(path)
    if room in ("__init__", "__main__"):
        return  # the public names may come from anywhere
    for module, kind in _own_imports(path):
        names = module.split(".")
        if names[0] != "mars2d" or names[1:2] == [room]:
            continue
        if len(names) == 1:
            assert kind == "lazy" or room == "cli", f"{path} imports mars2d itself: a circle"
            continue
        assert _level(names[1]) < _level(room), f"{path} imports {module}, which is not below it"


@each_case("room", ["core", "geometry", "sensors", "addons", "record", "output"])
def test_who_draws_senses_or_reports_never_touches_the_engine(room: str) -> None:
    for path in (path for path in FILES if _room(path) == room):
        modules = {module for module, _ in _own_imports(path)}
        assert not {m for m in modules if m.startswith(("mars2d.physics", "pymunk"))}, path


def test_physics_alone_knows_the_engine_library() -> None:
    knows = {path for path in FILES for m, _ in _own_imports(path) if m.startswith("pymunk")}
    assert {path.relative_to(PACKAGE).as_posix() for path in knows} == {
        "physics/islands/__init__.py", "physics/islands/chipmunk.py",
        "physics/islands/library.py",
    }  # fmt: skip


def test_no_module_imports_anything_heavy_when_it_is_imported() -> None:
    for path in FILES:
        if _room(path) in ("window", "output") or path.name in DERIVED:
            continue
        at_once = {module.split(".")[0] for module, kind in _own_imports(path) if kind == "module"}
        assert not at_once & HEAVY, path


def test_importing_the_package_loads_nothing_heavy(child) -> None:
    code = f"import mars2d, sys; print(sorted({HEAVY!r} & set(sys.modules)))"
    assert child(code).stdout.strip() == "[]"
