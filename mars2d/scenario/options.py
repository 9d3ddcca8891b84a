"""Options: other values for fields of a scenario, by dotted names."""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from mars2d.core.description import Description
from mars2d.core.errors import InputError, nearest, one_line, shown
from mars2d.scenario.scenario import Scenario


def override(scenario: Scenario, options: Mapping[str, Any]) -> Scenario:
    """Return the scenario with all options set at once, so that they are checked together.

    options: values by dotted names, such as ``robots.*.diameter``. Raises InputError for unknown
    names.
    """
    tree: dict[str, Any] = {}
    for name, value in options.items():
        *path, last = str(name).split(".")
        branch = tree
        for part in path:
            branch = branch.setdefault(part, {})
            if not isinstance(branch, dict):
                raise InputError(f"the options set {part!r} and a field of it, in {name!r}")
        branch[last] = _Leaf(value)
    return scenario if not tree else _replaced(scenario, tree, ())


class _Leaf(NamedTuple):
    """The value that an option sets, at the end of its path."""

    value: Any


def _replaced(target: Any, tree: Any, path: tuple[str, ...]) -> Any:
    """Return `target` with the fields of the tree set; ``*`` means all items of a list."""
    option = ".".join(path)
    if isinstance(tree, _Leaf):
        if isinstance(target, Description) and isinstance(tree.value, str):
            raise InputError(
                f"{option} = {tree.value!r}: an option is a number, a word or a tuple; write "
                f"{tree.value} in the file, or set single fields, such as {option}.FIELD=..."
            )
        return tree.value
    first = ".".join((*path, next(iter(tree))))
    if isinstance(target, tuple):
        items = list(target)
        for part, branch in tree.items():
            if part == "*" and not items:
                raise InputError(f"there is no option {first!r}: this scenario has no {path[-1]}")
            for i in range(len(items)) if part == "*" else [_index(part, items, path)]:
                items[i] = _replaced(items[i], branch, (*path, part))
        return tuple(items)
    if not isinstance(target, Description):
        raise InputError(f"there is no option {first!r}: {shown(target)} has no fields")
    changes = {}
    for part, branch in tree.items():
        if part not in target.__dataclass_fields__ and part not in target.twins:
            raise InputError(
                f"there is no option {'.'.join((*path, part))!r}: {type(target).__name__} has "
                f"no field {part!r}{target.meant(part)}"
            )
        changes[part] = _replaced(getattr(target, part), branch, (*path, part))
    return target.replace(**changes)


def _index(text: str, items: Sequence[Any], path: tuple[str, ...]) -> int:
    """Return the index of an item by its number or its name, the one that laws use."""
    names = [str(getattr(item, "key", None) or getattr(item, "name", "")) for item in items]
    if text in names:
        return names.index(text)
    if not text.isdigit() or int(text) >= len(items):
        option = ".".join((*path, text))
        named = f" or a name{nearest(text, filter(None, names))}" if any(names) else ""
        raise InputError(
            f"there is no option {option!r}: expected * or 0 to {len(items) - 1}{named}"
        )
    return int(text)


def options_in_words(options: Mapping[str, Any]) -> str:
    """Return options in one line.

    >>> options_in_words({"mu": 0.3, "laws.follow.gain": 2})
    'mu = 0.3, laws.follow.gain = 2'
    """
    return one_line(", ".join(f"{name} = {shown(value)}" for name, value in options.items()))


def parse_option(text: str) -> tuple[str, Any]:
    """Return (name, value) of a setting ``name=value`` from the command line.

    The value is a Python literal, such as ``0.5``, ``True`` or ``(1, 2)``; anything else is text.
    """
    name, equals, value = text.partition("=")
    if not equals or not name.strip():
        raise InputError(f"--set {text}: expected NAME=VALUE, such as --set sampling_time=0.5")
    try:
        return name.strip(), ast.literal_eval(value.strip())
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        return name.strip(), value.strip()
