"""Options: other values for fields of a scenario, by dotted names."""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence
from typing import Any

from mars2d.core.description import Description
from mars2d.core.errors import InputError, nearest, one_line, shown
from mars2d.scenario.scenario import Scenario


def override(scenario: Scenario, options: Mapping[str, Any]) -> Scenario:
    """Return the scenario with all options set at once, so that they are checked together.

    options: values by dotted names, such as ``robots.*.diameter``. Raises InputError for unknown
    names.
    """
    found = _replaced(scenario, {str(name): value for name, value in options.items()}, "")
    assert isinstance(found, Scenario)
    return found


def _replaced(target: Any, options: Mapping[str, Any], path: str) -> Any:
    """Return a part with the options set, by names within it; ``*`` means all items of a list.

    path: its own name and a full stop; empty for the scenario.
    """
    option = path + next(iter(options), "")
    if "" in options:  # the part itself
        value = options[""]
        if len(options) > 1:
            raise InputError(f"the options set {path[:-1]!r}, and a field of it as well")
        if isinstance(target, Description) and isinstance(value, str):
            raise InputError(
                f"{path[:-1]} = {value!r}: an option is a number, a word or a tuple; write "
                f"{value} in the file, or set single fields, such as {path}FIELD=..."
            )
        return value
    inside: dict[str, dict[str, Any]] = {}
    for name, value in options.items():
        first, _, rest = name.partition(".")
        inside.setdefault(first, {})[rest] = value
    if isinstance(target, tuple):
        items = list(target)
        for name, given in inside.items():
            if name == "*" and not items:
                raise InputError(f"there is no option {option!r}: this scenario has no {path[:-1]}")
            for i in range(len(items)) if name == "*" else [_index(name, items, path)]:
                items[i] = _replaced(items[i], given, f"{path}{name}.")
        return tuple(items)
    if not isinstance(target, Description):
        raise InputError(f"there is no option {option!r}: {shown(target)} has no fields")
    for name in inside:
        if name not in target.__dataclass_fields__:
            raise InputError(
                f"there is no option {path + name!r}: {type(target).__name__} has "
                f"no field {name!r}{target.meant(name)}"
            )
    changes = {
        name: _replaced(getattr(target, name), given, f"{path}{name}.")
        for name, given in inside.items()
    }
    return target.replace(**changes) if changes else target


def _index(text: str, items: Sequence[Any], path: str) -> int:
    """Return the index of an item by its number or its name, the one that laws use."""
    names = [str(getattr(item, "key", None) or getattr(item, "name", "")) for item in items]
    if text in names:
        return names.index(text)
    if not text.isdigit() or int(text) >= len(items):
        named = f" or a name{nearest(text, filter(None, names))}" if any(names) else ""
        expected = f"expected * or 0 to {len(items) - 1}{named}"
        raise InputError(f"there is no option {path + text!r}: {expected}")
    return int(text)


def options_in_words(options: Mapping[str, Any]) -> str:
    """Return options in one line.

    >>> options_in_words({"mu": 0.3, "laws.follow.gain": 2})
    'mu = 0.3, laws.follow.gain = 2'
    """
    return one_line(", ".join(f"{name} = {shown(value)}" for name, value in options.items()))


def parse_option(text: str) -> tuple[str, Any]:
    """Return (name, value) of a setting ``name=value`` from the command line.

    The value is a Python literal, such as ``0.5`` or ``(1, 2)``, true or false, or else text.

    >>> parse_option("carry=true")
    ('carry', True)
    """
    name, equals, value = text.partition("=")
    value = {"true": "True", "false": "False"}.get(value.strip(), value)
    if not equals or not name.strip():
        raise InputError(f"--set {text}: expected NAME=VALUE, such as --set sampling_time=0.5")
    try:
        return name.strip(), ast.literal_eval(value.strip())
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        return name.strip(), value.strip()
