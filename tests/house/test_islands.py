"""The islands' modules can be joined into one, and each has what the others take from it."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from mars2d.physics import islands
from mars2d.physics.islands import build
from tests.cases import each_case

FOLDER = Path(islands.__file__).parent
IMPORTS = "mars2d.physics.islands."


def text_of(name: str) -> str:
    return (FOLDER / name).read_text(encoding="utf-8")


def defined(text: str) -> Iterator[str]:
    """Yield the names that a module defines at its top level, once for each definition."""
    for node in ast.parse(text).body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            yield node.name
        elif isinstance(node, (ast.Assign, ast.AnnAssign)):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            for target in targets:
                yield from (each.id for each in ast.walk(target) if isinstance(each, ast.Name))


def taken() -> set[str]:
    """The names of chipmunk that the joined modules use."""
    every = [pair for name in build.MODULES for pair in imports(name)]
    named = {each for module, names in every if module == "chipmunk" for each in names}
    texts = [text_of(f"{name}.py") for name in build.MODULES]
    return named | {each for text in texts for each in re.findall(r"\bchipmunk\.(\w+)\b", text)}


def offered() -> list[str]:
    """The names that chipmunk.pxi defines, once for each definition."""
    own = text_of("chipmunk.pxi")
    found = re.findall(
        r"^(?:cdef (?!enum)[^(=\n]*?|ctypedef [^(\n]*?\(?\*|def )(\w+)[(:)\n]", own, flags=re.M
    )
    [kinds] = re.findall(r"^cdef enum:\n +(.*)$", own, flags=re.M)
    [numbers] = re.findall(r"^cdef enum: .*\n((?: +.*\n)*)", own, flags=re.M)
    return [*found, *kinds.split(", "), *re.findall(r"(\w+) =", numbers)]


def imports(name: str) -> Iterator[tuple[str, set[str]]]:
    """Yield the modules of the islands that a module imports from, and the names."""
    for node in ast.walk(ast.parse(text_of(f"{name}.py"))):
        if isinstance(node, ast.ImportFrom) and str(node.module).startswith(IMPORTS):
            yield node.module.removeprefix(IMPORTS), {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            yield str(node.module), {alias.name for alias in node.names}


def test_no_name_is_defined_twice_in_all_modules_together():
    names = Counter(offered())
    for name in build.MODULES:
        names.update(n for n in defined(text_of(f"{name}.py")))
    assert len(names) > 90
    assert {name: count for name, count in names.items() if count > 1} == {}


def test_chipmunk_is_the_same_in_python_and_in_c():
    """What is in C alone is for itself: it hands functions' addresses over, and takes them."""
    assert len(taken()) > 45
    alone = {"connect", "surfaced", "new_joint", "Found", "note_arbiter", "number_of", "Engine"}
    alone |= {"settle_contact", "correct_contact", "move", "pull", "engine", "vector", "damped"}
    alone |= {"twist_back", "straighten_contact", "Before", "set_handler", "turn_to"}
    alone |= {name for name in offered() if name.startswith("cp")}
    assert set(offered()) - alone <= set(defined(text_of("chipmunk.py")))
    assert taken() <= {*offered(), *build.in_c()}
    assert set(build.in_c()) <= set(defined(text_of("chipmunk.py")))


@each_case("name", build.MODULES)
def test_a_module_imports_only_what_is_there_when_they_are_joined(name):
    """Of those before it in the list, by their own names; of C's mathematics; of typing."""
    before = build.MODULES[: build.MODULES.index(name)]
    known = {each: set(defined(text_of(f"{each}.py"))) for each in ("chipmunk", *before)}
    known |= {"math": {"ceil", "floor", "fmod", "sqrt"}}
    known |= {
        "typing": {"Any"},
        "__future__": {"annotations"},
        "mars2d.physics.islands": {"chipmunk", "shadow"},
    }
    for module, names in imports(name):
        assert names <= known.get(module, set()), f"{names} of {module}"
