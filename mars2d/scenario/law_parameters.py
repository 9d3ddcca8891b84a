"""Parameters of laws: numbers in a functools.partial, and default arguments."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from mars2d.core.errors import InputError, nearest
from mars2d.core.usercode import name_of
from mars2d.scenario.parameters import Argument, Parameter, arguments_of, is_number, signature_of

Law = Callable[[Any], Any]

PREFIX = "laws."
"""The beginning of the names of laws' parameters: ``laws.follow.gain``."""


class _Numbers:
    """The numbers that can be set in a law, by name; none in an object or a compiled function."""

    def __init__(self, law: Law | None) -> None:
        self.values: dict[str, float] = {}
        self._law = law if isinstance(law, partial) else partial(law or print)
        function = self._law.func
        if law is None or not inspect.isroutine(function) or not (takes := signature_of(function)):
            return
        given = inspect.signature(function).bind_partial(*self._law.args, **self._law.keywords)
        self._places = [*given.arguments][: len(given.args)]
        self._arguments = arguments_of(function)
        found: dict[str, Any] = {name: each.default for name, each in self._arguments.items()}
        found |= {**given.arguments, **given.kwargs}
        subject = next((name for name in takes if name not in given.arguments), "")
        self.values = {k: v for k, v in found.items() if is_number(v) and k != subject}

    def argument(self, name: str) -> Argument:
        """Return what is known of an argument."""
        return self._arguments.get(name, Argument())

    def law_with(self, name: str, value: Any) -> Law:
        """Return the law with another value of an argument."""
        args, keywords = list(self._law.args), self._law.keywords
        if name not in self._places:
            return partial(self._law.func, *args, **{**keywords, name: value})
        args[self._places.index(name)] = value
        return partial(self._law.func, *args, **keywords)


def _named(laws: Sequence[Law | None]) -> Iterator[tuple[dict[str, str], _Numbers]]:
    """Yield the numbers of each law, and their names by those of the options that set them.

    A law `control` that is not the team's is called as its file.
    """
    for law in laws:
        name = "" if law is None else name_of(law)
        code = getattr(law.func if isinstance(law, partial) else law, "__code__", None)
        if name == "control" and law is not laws[0] and code is not None:
            name = Path(code.co_filename).stem
        found = _Numbers(law)
        yield {f"{PREFIX}{name}.{each}": each for each in found.values}, found


def same(law: Law | None, other: Law | None) -> bool:
    """Return whether two laws do the same, if all else in their files is the same.

    Only for functions and partials can that be told, without variables of an outer function.
    """
    if law is other or law is None or other is None:
        return law is other
    one, two = (each if isinstance(each, partial) else partial(each) for each in (law, other))
    codes = [getattr(each.func, "__code__", None) for each in (one, two)]
    closed = any(getattr(each.func, "__closure__", None) for each in (one, two))
    given = [*one.args, *one.keywords.values()]
    plain = all(each is None or isinstance(each, (bool, int, float, str)) for each in given)
    alike = codes[0] is not None and codes[0] == codes[1] and not closed and plain
    return alike and (one.args, one.keywords) == (two.args, two.keywords)


def of_laws(laws: Sequence[Law | None], plain: Sequence[Law | None]) -> Iterator[Parameter]:
    """Yield the parameters of laws: that of the team first, then those of the robots.

    plain: the same laws as their files have them. Arguments in which laws of one name differ have
    no one value, and are left out.
    """
    found: dict[str, tuple[Argument, set[float], set[float]]] = {}
    for (names, law), before in zip(_named(laws), map(_Numbers, plain), strict=True):
        for option, name in names.items():
            _, values, usuals = found.setdefault(option, (law.argument(name), set(), set()))
            values.add(law.values[name])
            usuals.add(before.values.get(name, law.values[name]))
    for option, (argument, values, usuals) in found.items():
        if len(values) == len(usuals) == 1:
            yield Parameter.of(option, values.pop(), argument, usuals.pop())


def laws_with(laws: Sequence[Law | None], options: Mapping[str, Any]) -> list[Law | None]:
    """Return laws with other values of their arguments; that of the team is the first.

    options: by names such as ``laws.follow.gain``. Robots that share a law share the new one.
    Raises InputError for names that no law has, and values beyond a Range.
    """
    made: dict[tuple[int, str], Law] = {}
    for option, value in options.items():
        changed, known = list(laws), list[str]()
        for i, (names, law) in enumerate(_named(laws)):
            known += names
            if option in names:
                name = names[option]
                law.argument(name).check(option, value)
                changed[i] = made.setdefault((id(laws[i]), option), law.law_with(name, value))
        if option not in known:
            raise InputError(f"there is no option {option!r}{nearest(option, known)}")
        laws = changed
    return list(laws)
