"""Plans: which runs a study is made of, each point of a grid of settings with each seed."""

from __future__ import annotations

import ast
import itertools
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError, shown
from mars2d.core.streams import check_seed
from mars2d.scenario.options import parse_setting
from mars2d.study.table import key_of

__all__ = [
    "Plan",
    "cell",
    "cells_of",
    "parse_all",
    "parse_values",
    "seeds_of",
    "settings_of",
    "value_in",
    "word_cell",
    "word_in",
]

MOST = 1_000_000
"""The most runs of a study."""

NUMBER = r"\s*[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\s*"
RANGE = re.compile(f"({NUMBER}):({NUMBER}):({NUMBER})")
FORMULA = re.compile("'*[=+@-]")
"""How words begin that a spreadsheet takes for a formula, or that have a quote against that."""

BRACKETS = {"(": ")", "[": "]", "{": "}"}


@dataclass(frozen=True)
class Plan:
    """All runs of a study: each point of the grid of settings with each seed.

    settings: the values of each setting, by name. seeds: the same for each point, so that points
    differ by their settings alone and can be compared seed by seed. Raises InputError where there
    are too many.
    """

    settings: Mapping[str, tuple[Any, ...]]
    seeds: tuple[int, ...]

    def __post_init__(self) -> None:
        if len(self) > MOST:
            sizes = [f"{len(values)} of {name}" for name, values in self.settings.items()]
            grid = " x ".join([*sizes, f"{len(self.seeds)} seeds"])
            raise InputError(f"{grid} are {len(self):,} runs: {MOST:,} at most")

    def __len__(self) -> int:
        return math.prod(map(len, self.settings.values())) * len(self.seeds)

    def points(self) -> Iterator[dict[str, Any]]:
        """Return the options of each point, in the order of the grid: the last setting quickest."""
        for values in itertools.product(*self.settings.values()):
            yield dict(zip(self.settings, values, strict=True))

    def runs(self) -> Iterator[tuple[dict[str, Any], int]]:
        """Return the options and the seed of each run: point by point, seeds inside."""
        return ((point, seed) for point in self.points() for seed in self.seeds)

    def probes(self) -> Iterator[dict[str, Any]]:
        """Return points that have each value of each setting, the others at their first."""
        first = {name: values[0] for name, values in self.settings.items()}
        yield first
        for name, values in self.settings.items():
            for value in values[1:]:
                yield {**first, name: value}


# -- what is given ---------------------------------------------------------------------------------


def settings_of(given: Mapping[str, Any] | None) -> dict[str, tuple[Any, ...]]:
    """Return the values of each setting: the items of a list, range or array; anything else is one.

    Raises InputError for values that a table can't hold, for none, and for one that is there twice.
    """
    if given is not None and not isinstance(given, Mapping):
        raise wrong("settings", given, "a dict, as {'gain': [0.1, 0.2]}")
    settings: dict[str, tuple[Any, ...]] = {}
    for name, value in (given or {}).items():
        if not isinstance(name, str):
            raise wrong("settings", name, "names as the keys, as {'gain': [0.1, 0.2]}")
        several = value if isinstance(value, (list, range)) or _is_array(value) else [value]
        values = tuple(_plain(name, each) for each in several)
        if not values:
            raise wrong(f"settings[{name!r}]", value, "at least one value")
        _refuse_twice(name, values)
        settings[name] = values
    return settings


def _is_array(value: Any) -> bool:
    return isinstance(value, np.ndarray) and value.ndim > 0


def _plain(name: str, value: Any) -> Any:
    """Return a value as Python's own; raise InputError if a table can't hold it."""
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.tolist()
    if isinstance(value, str):
        return value
    try:
        same = bool(ast.literal_eval(repr(value)) == value)
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        same = False
    if not same:
        expected = "what a table can hold: finite numbers, words, tuples of these"
        raise wrong(f"settings[{name!r}]", value, expected)
    return value


def _refuse_twice(name: str, values: Sequence[Any]) -> None:
    known: set[Any] = set()
    for value in values:
        if key_of(value) in known:
            raise InputError(f"{name}: {shown(value)} is there twice")
        known.add(key_of(value))


def seeds_of(seeds: int | Iterable[int], first: int = 0) -> tuple[int, ...]:
    """Return the seeds of a study: so many from `first` on, or those that are listed."""
    if isinstance(seeds, (int, np.integer)) and not isinstance(seeds, bool):
        if not 1 <= seeds <= MOST:
            raise wrong("seeds", seeds, f"how many, 1 to {MOST:,}, or a list of them")
        start = check_seed(first)
        check_seed(start + int(seeds) - 1)
        return tuple(range(start, start + int(seeds)))
    if isinstance(seeds, (str, bytes, bool)) or not isinstance(seeds, Iterable):
        raise wrong("seeds", seeds, "how many, or a list of them")
    listed = tuple(check_seed(seed) for seed in seeds)
    if not listed or len({*listed}) < len(listed):
        raise wrong("seeds", seeds, "at least one, and each once")
    return listed


def parse_values(text: str) -> tuple[str, list[Any]]:
    """Return (name, values) of ``name=values`` from the command line.

    ``a:b:k`` are k evenly spaced values from a to b, both included; a comma stands between values,
    but for those in brackets or quotes. Each is a Python literal; anything else is a word.

    >>> parse_values("gain=0.1:0.3:3")
    ('gain', [0.1, 0.2, 0.3])
    >>> parse_values("n=4,8,16")
    ('n', [4, 8, 16])
    """
    name, equals, given = text.partition("=")
    name = name.strip()
    if not equals or not name or not given.strip():
        raise InputError(f"--set {text}: expected NAME=VALUES, as --set n=4,8 or --set k=0.1:1:10")
    values: list[Any] = []
    for item in _split(text, given):
        spaced = RANGE.fullmatch(item)
        values += _spaced(text, *spaced.groups()) if spaced else [value_in(item)]
    return name, values


def parse_all(texts: Iterable[str]) -> dict[str, Any]:
    """Return the values of all settings NAME=VALUES, by name, each of which is given once."""
    settings: dict[str, Any] = {}
    for text in texts:
        name, values = parse_values(text)
        if name in settings:
            raise InputError(f"--set {name}: is given twice; give all its values at once")
        settings[name] = values
    return settings


def _split(text: str, given: str) -> list[str]:
    """Return the items between the commas that stand in no brackets and no quotes."""
    items: list[str] = []
    closing: list[str] = []
    start, quote = 0, ""
    for k, letter in enumerate(given):
        if quote:
            quote = "" if letter == quote and given[k - 1] != "\\" else quote
        elif letter in "'\"" and (closing or not given[start:k].strip()):
            quote = letter
        elif letter in BRACKETS:
            closing.append(BRACKETS[letter])
        elif closing and letter == closing[-1]:
            closing.pop()
        elif letter == "," and not closing:
            items.append(given[start:k].strip())
            start = k + 1
    items.append(given[start:].strip())
    if quote or closing:
        raise InputError(f"--set {text}: {quote or closing[-1]} is missing at the end")
    if "" in items:
        raise InputError(f"--set {text}: there is nothing between two commas, or at an end")
    return items


def _spaced(text: str, first: str, last: str, count: str) -> list[float]:
    """Return evenly spaced values, each the float that is nearest to the exact one."""
    try:
        number = int(count)
    except ValueError:
        number = 0
    if not 2 <= number <= MOST:
        raise InputError(f"--set {text}: expected FIRST:LAST:COUNT with a count of 2 to {MOST:,}")
    for part in (first, last):
        real(f"--set {text}", float(part))
    # What is 0 as a float is 0: the exact value of 1e-99999999 would take for ever.
    start, end = (Fraction(part) if float(part) else Fraction(0) for part in (first, last))
    if start == end:
        raise InputError(f"--set {text}: all {number} values would be the same")
    values = [start + (end - start) * k / (number - 1) for k in range(number)]
    whole = all(re.fullmatch(r"\s*[+-]?\d+\s*", part) for part in (first, last))
    if whole and all(value.denominator == 1 for value in values):
        return [int(value) for value in values]
    return [float(value) for value in values]


# -- as cells of a table ---------------------------------------------------------------------------


def cell(value: Any) -> str:
    """Return a setting's value as the text of a cell, from which `value_in` makes the same again.

    >>> [cell(value) for value in (0.5, "a.py", "0.5", (1, 2))]
    ['0.5', 'a.py', "'0.5'", '(1, 2)']
    """
    if isinstance(value, str) and value_in(value) == value and value.isprintable():
        return value
    return repr(value)


def value_in(text: str) -> Any:
    """Return the value that a cell holds: a Python literal, or else a word."""
    return parse_setting(f"_={text}")[1]


def word_cell(text: str) -> str:
    """Return words as the text of a cell: a quote before what a spreadsheet takes for a formula.

    >>> [word_cell(text) for text in ("blue", "=1+1", "'=1+1", "-")]
    ['blue', "'=1+1", "''=1+1", "'-"]
    """
    return f"'{text}" if FORMULA.match(text) else text


def word_in(text: str) -> str:
    """Return the words that `word_cell` has made the text of a cell."""
    return text[1:] if text[:1] == "'" and FORMULA.match(text) else text


def cells_of(options: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the cells of a point, by which it is told apart from others."""
    return tuple(map(cell, options.values()))
