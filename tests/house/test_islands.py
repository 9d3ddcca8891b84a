"""The islands' modules can be joined into one, and each has what the others take from it."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from mars2d.physics import islands
from mars2d.physics.islands import build
from tests.cases import each_case

FOLDER = Path(islands.__file__).parent
IMPORTS = "mars2d.physics.islands."


def text_of(name: str) -> str:
    return (FOLDER / name).read_text(encoding="utf-8")


@cache
def tree_of(name: str) -> ast.Module:
    return ast.parse(text_of(f"{name}.py"))


def defined(name: str) -> Iterator[str]:
    """Yield the names that a module defines at its top level, once for each definition."""
    for node in tree_of(name).body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            yield node.name
        elif isinstance(node, (ast.Assign, ast.AnnAssign)):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            for target in targets:
                yield from (each.id for each in ast.walk(target) if isinstance(each, ast.Name))


def taken() -> set[str]:
    """The names of library that the joined modules use."""
    every = [pair for name in build.MODULES for pair in imports(name)]
    named = {each for module, names in every if module == "library" for each in names}
    texts = [text_of(f"{name}.py") for name in build.MODULES]
    return named | {each for text in texts for each in re.findall(r"\blibrary\.(\w+)\b", text)}


def offered() -> list[str]:
    """The names that library.pxi defines, once for each definition."""
    own = text_of("library.pxi")
    found = re.findall(
        r"^(?:cdef (?!enum)[^(=\n]*?|ctypedef [^(\n]*?\(?\*|def )(\w+)[(:)\n]", own, flags=re.M
    )
    [kinds] = re.findall(r"^cdef enum:\n +(.*)$", own, flags=re.M)
    [numbers] = re.findall(r"^cdef enum: .*\n((?: +.*\n)*)", own, flags=re.M)
    return [*found, *kinds.split(", "), *re.findall(r"(\w+) =", numbers)]


def imports(name: str) -> Iterator[tuple[str, set[str]]]:
    """Yield the modules that a module imports from, but for types alone, and the names."""
    for node in tree_of(name).body:
        if isinstance(node, ast.ImportFrom) and str(node.module).startswith(IMPORTS):
            yield node.module.removeprefix(IMPORTS), {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            yield str(node.module), {alias.name for alias in node.names}


def test_no_name_is_defined_twice_in_all_modules_together():
    names = Counter(offered())
    for name in build.MODULES:
        names.update(defined(name))
    assert len(names) > 90
    assert {name: count for name, count in names.items() if count > 1} == {}


def test_the_library_is_the_same_in_python_and_in_c():
    """What is in C alone is for itself: it hands functions' addresses over, and takes them."""
    alone = {"connect", "Found", "note_arbiter", "Engine", "engine", "Before", "corners"}
    alone |= {name for name in offered() if name.startswith("cp")}
    in_python = set(defined("library"))
    assert set(offered()) - alone <= in_python
    assert len(taken()) > 30
    assert taken() - {"callback"} <= set(offered())  # in C a decorator takes its place
    assert set(build.in_c()) <= set(defined("chipmunk"))


def test_numbers_with_names_are_divided_in_c_as_in_python():
    found = re.findall(r"^cdef (?:int|double) [A-Z_]+ = (.*)$", build.joined(), flags=re.M)
    assert len(found) > 40
    assert [each for each in found if re.search(r"\d/|/ *\d+(?![\d.])", each)] == []


@each_case("name", build.MODULES)
def test_a_module_imports_only_what_is_there_when_they_are_joined(name):
    """Of those before it in the list, by their own names; of C's mathematics; of typing."""
    before = build.MODULES[: build.MODULES.index(name)]
    known = {each: set(defined(each)) for each in ("library", *before)}
    known |= {"array": {"array"}, "math": {"ceil", "floor", "fmod", "sqrt"}}
    known |= {
        "typing": {"Any", "TYPE_CHECKING"},
        "__future__": {"annotations"},
        "mars2d.physics.islands": {"chipmunk", "library", "settings", "shadow"},
        "pymunk._chipmunk_cffi": {"lib"},
    }
    for module, names in imports(name):
        assert names <= known.get(module, set()), f"{names} of {module}"
