"""Scenarios as Python files that make equal ones."""

from __future__ import annotations

import dataclasses
import sys
from collections import defaultdict
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from mars2d.core.description import Description
from mars2d.core.usercode import name_of
from mars2d.scenario import serialize
from mars2d.scenario.law_reference import Reference, seen_from
from mars2d.scenario.options import options_in_words
from mars2d.scenario.pretty import WIDTH, Brackets, Node, comment, laid_out, plain, quoted
from mars2d.scenario.registry import FAMILIES
from mars2d.scenario.scenario import Scenario

Law = Callable[[Any], Any]

MAX_TITLE = 90
"""The most characters of a title in a docstring."""


def as_python(
    scenario: Scenario,
    control: Law | None = None,
    folder: Path | str | None = None,
    options: Mapping[str, Any] | None = None,
) -> str:
    r"""Return the text of a Python file that makes a scenario, for `mars2d run`.

    Only values that differ from their defaults are written. Laws are loaded from their files, if
    they are functions at the top of these, or a functools.partial of one with plain values. Other
    code is left out, or replaced as in a loaded record, and named in a comment. control: the law of
    the team. folder: the folder of the file; laws near it get relative paths. options: the
    parameters that were set, for a comment.

    >>> print(as_python(Scenario(title="Alone", stop_time=5.0)).partition("\n\n")[2])
    from mars2d import Robot, Scenario
    <BLANKLINE>
    scenario = Scenario(title="Alone", robots=[Robot()], stop_time=5.0)
    <BLANKLINE>
    """
    kept, missing = serialize.without_code(scenario)
    lister = _Lister(None if folder is None else Path(folder))
    body = [laid_out(_named("scenario = ", lister.call(kept)))]
    if control is not None:
        body.append(laid_out(_named("control = ", lister.law(control))))
    lost = [*missing, *(f"law {name_of(law)}" for law in lister.lost)]
    notes = [comment(f"{serialize.LOST}: {name}") for name in dict.fromkeys(lost)]
    if options:
        notes.insert(0, comment(f"With {options_in_words(options)}"))
    title = comment(kept.title)[2:][:MAX_TITLE].replace("\\", "/").replace('"', "'").strip()
    head = [f'"""{title or "A scenario."}"""', "", *lister.imports(), ""]
    return "\n".join([*head, *notes, *body]) + "\n"


class _Lister:
    """Writes parts as calls of their classes, and collects the imports.

    lost: laws that can't be found by name.
    """

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder
        self.lost: list[Law] = []
        self._names: dict[str, tuple[str, str]] = {}  # by alias: module and name there

    def call(self, part: Description, index: int = 0) -> Brackets:
        """Return the call that makes a part; index: its place in its list."""
        kind = type(part)
        first = next((f.name for f in dataclasses.fields(kind) if not f.kw_only), None)
        values = serialize.changed(part, index)
        items = []
        for name in sorted(values, key=lambda name: (name != first, name != "name")):
            node = self._value(values[name])
            items.append(node if name == first else _named(f"{name}=", node))
        return Brackets(f"{self._class(kind)}(", items, ")")

    def _value(self, value: Any, index: int = 0) -> Node:
        """Return the value of a field; index: its place in its list."""
        if callable(value) and not serialize.is_ready_made(type(value)):
            return self.law(value)
        if isinstance(value, Description):
            return self.call(value, index)
        if not isinstance(value, (list, tuple)):
            return plain(value)
        items = [self._value(item, i) for i, item in enumerate(value)]
        if items and all(isinstance(item, (int, float)) for item in value):  # a point, a pose
            return Brackets("(", items, ",)" if len(items) == 1 else ")", filled=True)
        of_parts = any(isinstance(item, Description) for item in value)
        return Brackets("[", items, "]", filled=not of_parts)

    def law(self, law: Law) -> Node:
        """Return the call that loads a law; "None" if it can't be found by name."""
        function, args, values = law, (), {}
        if isinstance(law, partial):
            function, args, values = law.func, law.args, law.keywords
        found = Reference.of(function)
        plain = all(map(_is_plain, [*args, *values.values()])) and not {"path", "name"} & {*values}
        if found is None or not plain:
            self.lost.append(law)
            return "None"
        file = found.file if self.folder is None else seen_from(found.file, self.folder)
        items: list[Node] = [quoted(file)]
        if args or found.name != "control":
            items.append(quoted(found.name))
        items += map(self._value, args)
        items += [_named(f"{name}=", self._value(value)) for name, value in values.items()]
        self._names["load_law"] = "mars2d", "load_law"
        if not (args or values):
            return f"load_law({', '.join(map(str, items))})"
        return Brackets("load_law(", items, ")", filled=True)

    def _class(self, kind: type[Description]) -> str:
        """Return the name for a class; the later of two with one name gets its family's, too."""
        names = kind.__module__.split(".")
        above = (".".join(names[:depth]) for depth in range(1, len(names)))
        public = (p for p in above if getattr(sys.modules[p], kind.__name__, None) is kind)
        source = next(public, kind.__module__), kind.__name__  # the outermost that exports it
        name = kind.__name__
        if self._names.get(name, source) != source:
            bases = {base for _, base in FAMILIES.values()}
            name += next(base.__name__ for base in kind.__mro__ if base.__name__ in bases)
        self._names[name] = source
        return name

    def imports(self) -> list[str]:
        """Return the lines of imports."""
        modules = defaultdict(list)
        for alias, (module, name) in self._names.items():
            modules[module].append(name if alias == name else f"{name} as {alias}")
        lines = []
        for module, names in modules.items():
            line = f"from {module} import {', '.join(sorted(names))}"
            broken = Brackets(f"from {module} import (", sorted(names), ")", filled=True)
            lines.append(line if len(line) <= WIDTH else laid_out(broken))
        return sorted(lines)


def _is_plain(value: object) -> bool:
    """Return whether a value is a number, a word, or a tuple of these: it can be written down."""
    if isinstance(value, tuple):
        return all(map(_is_plain, value))
    return value is None or type(value) in (bool, int, float, str)


def _named(name: str, node: Node) -> Node:
    """Return a node with a name in front."""
    return name + node if isinstance(node, str) else node._replace(opening=name + node.opening)
