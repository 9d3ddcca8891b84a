"""Parameters of laws: numbers in a functools.partial, and default arguments."""

from __future__ import annotations

import dataclasses
import inspect
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from mars2d.core.errors import InputError, nearest
from mars2d.core.usercode import name_of
from mars2d.scenario.parameters import Argument, Parameter, arguments_of, is_number

Law = Callable[[Any], Any]

PREFIX = "laws."
"""The beginning of the names of laws' parameters: ``laws.follow.gain``."""

ANY = Argument()
"""An argument of which nothing is known."""


@dataclasses.dataclass(frozen=True, slots=True)
class _Bound:
    """A law as the function that it calls, with the arguments that are given.

    subject: the name of the argument that is the robot or the world.
    """

    function: Callable[..., Any]
    args: tuple[Any, ...]
    keywords: Mapping[str, Any]
    places: Sequence[str]
    arguments: Mapping[str, Argument]
    subject: str

    @classmethod
    def of(cls, law: Law) -> _Bound | None:
        """Return a law's function and arguments; None for an object, or a compiled function."""
        function = law.func if isinstance(law, partial) else law
        args = law.args if isinstance(law, partial) else ()
        keywords = law.keywords if isinstance(law, partial) else {}
        if not inspect.isroutine(function):
            return None
        try:
            signature = inspect.signature(function).parameters
        except (TypeError, ValueError):
            return None
        positional = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
        places = [name for name, each in signature.items() if each.kind in positional]
        free = [name for name in places[len(args) :] if name not in keywords]
        return cls(function, args, keywords, places, arguments_of(function), next(iter(free), ""))

    @property
    def values(self) -> dict[str, float]:
        """The numbers that can be set, by name."""
        found: dict[str, Any] = {name: each.default for name, each in self.arguments.items()}
        found |= {**dict(zip(self.places, self.args, strict=False)), **self.keywords}
        return {k: v for k, v in found.items() if is_number(v) and k != self.subject}

    def set(self, name: str, value: Any) -> Law:
        """Return the law with another value of an argument."""
        place = self.places.index(name) if name in self.places else len(self.args)
        if place < len(self.args):
            args = (*self.args[:place], value, *self.args[place + 1 :])
            return partial(self.function, *args, **self.keywords)
        return partial(self.function, *self.args, **{**self.keywords, name: value})


def _key(law: Law, team: Law | None) -> str:
    """Return the name of a law in settings: its function's, or its file's for another `control`."""
    name = name_of(law)
    code = getattr(law.func if isinstance(law, partial) else law, "__code__", None)
    if name == "control" and law is not team and code is not None:
        return Path(code.co_filename).stem
    return name


def same(law: Law | None, other: Law | None) -> bool:
    """Return whether two laws do the same, if all else in their files is the same.

    Only for functions and partials can that be told, without variables of an outer function.
    """
    if law is other:
        return True
    one, two = (None if each is None else _Bound.of(each) for each in (law, other))
    if one is None or two is None:
        return False
    codes = [getattr(each.function, "__code__", None) for each in (one, two)]
    closed = any(getattr(each.function, "__closure__", None) for each in (one, two))
    plain = all(map(_is_plain, [*one.args, *one.keywords.values()]))
    given = (one.args, one.keywords) == (two.args, two.keywords) if plain else False
    return codes[0] is not None and codes[0] == codes[1] and not closed and given


def _is_plain(value: object) -> bool:
    return value is None or isinstance(value, (bool, int, float, str))


def of_laws(laws: Sequence[Law | None], plain: Sequence[Law | None]) -> Iterator[Parameter]:
    """Yield the parameters of laws: that of the team first, then those of the robots.

    plain: the same laws as their files have them. Arguments in which laws of one name differ have
    no one value, and are left out.
    """
    found: dict[str, tuple[Argument, set[float], set[float]]] = {}
    for law, usual in zip(laws, plain, strict=True):
        bound, before = (None if each is None else _Bound.of(each) for each in (law, usual))
        if law is None or bound is None:
            continue
        defaults = {} if before is None else before.values
        for name, value in bound.values.items():
            setting = f"{PREFIX}{_key(law, laws[0])}.{name}"
            argument = bound.arguments.get(name, ANY)
            _, values, usuals = found.setdefault(setting, (argument, set(), set()))
            values.add(value)
            usuals.add(defaults.get(name, value))
    for setting, (argument, values, usuals) in found.items():
        if len(values) == len(usuals) == 1:
            yield Parameter.of(setting, values.pop(), argument, usuals.pop())


def with_settings(laws: Sequence[Law | None], settings: Mapping[str, Any]) -> list[Law | None]:
    """Return laws with other values of their arguments; that of the team is the first.

    settings: by names such as ``laws.follow.gain``. Robots that share a law share the new one.
    Raises InputError for names that no law has, and values beyond a Range.
    """
    made: dict[tuple[int, str], Law] = {}
    for setting, value in settings.items():
        known: list[str] = []
        changed = list(laws)
        for i, law in enumerate(laws):
            bound = None if law is None else _Bound.of(law)
            if law is None or bound is None:
                continue
            names = {f"{PREFIX}{_key(law, laws[0])}.{name}": name for name in bound.values}
            known += names
            if setting in names:
                name = names[setting]
                bound.arguments.get(name, ANY).check(setting, value)
                changed[i] = made.setdefault((id(law), setting), bound.set(name, value))
        if setting not in known:
            raise InputError(f"there is no option {setting!r}{nearest(setting, known)}")
        laws = changed
    return list(laws)
