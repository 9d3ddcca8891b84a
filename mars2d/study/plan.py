"""Plans: the runs of a study, which are each point of a grid of settings with each seed."""

from __future__ import annotations

import ast
import itertools
import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from mars2d.core.checks import items_of
from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError, shown
from mars2d.core.streams import check_seed
from mars2d.study.table import key_of, value_in

MAX_RUNS = 1_000_000
"""The largest number of runs in a study."""

NUMBER = r"\s*[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?\s*"
RANGE = re.compile(f"({NUMBER}):({NUMBER}):({NUMBER})")


@dataclass(frozen=True)
class Plan:
    """All runs of a study: each point of the grid of settings with each seed.

    settings: the values of each setting, by name. seeds: the same ones for each point, so that
    points can be compared seed by seed. Raises InputError for more than `MAX_RUNS` runs.
    """

    settings: Mapping[str, tuple[Any, ...]]
    seeds: tuple[int, ...]

    def __post_init__(self) -> None:
        if len(self) > MAX_RUNS:
            sizes = [f"{len(values)} of {name}" for name, values in self.settings.items()]
            grid = " x ".join([*sizes, f"{len(self.seeds)} seeds"])
            raise InputError(f"{grid} are {len(self):,} runs: {MAX_RUNS:,} at most")

    def __len__(self) -> int:
        return math.prod(map(len, self.settings.values())) * len(self.seeds)

    def points(self) -> Iterator[dict[str, Any]]:
        """Yield the options of each point in grid order; the last setting varies fastest."""
        for values in itertools.product(*self.settings.values()):
            yield dict(zip(self.settings, values, strict=True))

    def runs(self) -> Iterator[tuple[dict[str, Any], int]]:
        """Return the options and the seed of each run: all seeds of a point, then the next."""
        return ((point, seed) for point in self.points() for seed in self.seeds)

    def probes(self) -> Iterator[dict[str, Any]]:
        """Yield points that cover each value of each setting, others at their first value."""
        first = {name: values[0] for name, values in self.settings.items()}
        yield first
        for name, values in self.settings.items():
            for value in values[1:]:
                yield {**first, name: value}


# -- settings and seeds that were given ------------------------------------------------------------


def settings_of(given: Mapping[str, Any] | None) -> dict[str, tuple[Any, ...]]:
    """Return the values of each setting: the items of a list, range or array, or else one value.

    Raises InputError for values that a table can't hold, for no values, and for duplicates.
    """
    if given is not None and not isinstance(given, Mapping):
        raise wrong("settings", given, "a dict, such as {'gain': [0.1, 0.2]}")
    settings: dict[str, tuple[Any, ...]] = {}
    for name, value in (given or {}).items():
        if not isinstance(name, str):
            raise wrong("settings", name, "names as the keys, such as {'gain': [0.1, 0.2]}")
        array = isinstance(value, np.ndarray) and value.ndim > 0
        several = value if array or isinstance(value, (list, range)) else [value]
        listed = items_of(f"settings[{name!r}]", several, "values", MAX_RUNS)
        values = tuple(_plain(name, each) for each in listed)
        if not values:
            raise wrong(f"settings[{name!r}]", value, "at least one value")
        known: set[Any] = set()
        for each in values:
            if key_of(each) in known:
                raise InputError(f"{name}: {shown(each)} is there twice")
            known.add(key_of(each))
        settings[name] = values
    return settings


def _plain(name: str, value: Any) -> Any:
    """Return a value as a plain Python object; raise InputError if a table can't hold it."""
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


def seeds_of(seeds: int | Iterable[int], first: int = 0) -> tuple[int, ...]:
    """Return the seeds of a study: a number of them from `first` on, or a list as it is."""
    if isinstance(seeds, (int, np.integer)) and not isinstance(seeds, bool):
        if not 1 <= seeds <= MAX_RUNS:
            raise wrong("seeds", seeds, f"how many, 1 to {MAX_RUNS:,}, or a list of them")
        start = check_seed(first)
        check_seed(start + int(seeds) - 1)
        return tuple(range(start, start + int(seeds)))
    given = items_of("seeds", seeds, "how many, or a list of them", MAX_RUNS)
    listed = tuple(check_seed(seed) for seed in given)
    if not listed or len({*listed}) < len(listed):
        raise wrong("seeds", seeds, "at least one, and each once")
    return listed


def parse_values(text: str) -> tuple[str, list[Any]]:
    """Return (name, values) of ``name=values`` from the command line.

    ``a:b:k`` stands for k evenly spaced values from a to b, both included. Commas separate values.
    Each is a Python literal, or else a word; where there are brackets or quotes, all are literals.

    >>> parse_values("gain=0.1:0.3:3")
    ('gain', [0.1, 0.2, 0.3])
    >>> parse_values("n=4,8,16")
    ('n', [4, 8, 16])
    """
    name, equals, given = text.partition("=")
    name = name.strip()
    if not equals or not name or not given.strip():
        expected = "expected NAME=VALUES, such as --set n=4,8 or --set k=0.1:1:10"
        raise InputError(f"--set {text}: {expected}")
    values: list[Any] = []
    for item in _split(text, given):
        spaced = RANGE.fullmatch(item)
        values += _spaced(text, *spaced.groups()) if spaced else [value_in(item)]
    return name, values


def parse_all(texts: Iterable[str]) -> dict[str, Any]:
    """Return the values of all settings NAME=VALUES by name; InputError if one is given twice."""
    settings: dict[str, Any] = {}
    for text in texts:
        name, values = parse_values(text)
        if name in settings:
            raise InputError(f"--set {name}: is given twice; give all its values at once")
        settings[name] = values
    return settings


def _split(text: str, given: str) -> list[str]:
    """Split text at the commas; with brackets or quotes it is a list in Python, without its own."""
    if re.search(r"[(\[{]|(^|,)\s*['\"]", given):
        try:
            return [repr(value) for value in ast.literal_eval(f"[{given}]")]
        except (ValueError, SyntaxError, MemoryError, RecursionError):
            expected = "with brackets or quotes all values are as in Python, words in quotes"
            raise InputError(f"--set {text}: {expected}") from None
    items = [item.strip() for item in given.split(",")]
    if "" in items:
        raise InputError(f"--set {text}: there is nothing between two commas, or at an end")
    return items


def _spaced(text: str, first: str, last: str, count: str) -> list[float]:
    """Return evenly spaced values, each the float nearest to the exact value."""
    number = int(count) if count.strip().isdecimal() else 0
    if not 2 <= number <= MAX_RUNS:
        expected = f"FIRST:LAST:COUNT with a count of 2 to {MAX_RUNS:,}"
        raise InputError(f"--set {text}: expected {expected}")
    start, end = (Fraction(str(real(f"--set {text}", float(part)))) for part in (first, last))
    if start == end:
        raise InputError(f"--set {text}: all {number} values would be the same")
    values = [start + (end - start) * k / (number - 1) for k in range(number)]
    whole = re.fullmatch(r"\s*[+-]?\d+\s*:\s*[+-]?\d+\s*", f"{first}:{last}")
    if whole and all(value.denominator == 1 for value in values):
        return [int(value) for value in values]
    return [float(value) for value in values]
