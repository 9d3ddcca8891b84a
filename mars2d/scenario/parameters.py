"""Parameters: numbers of a scenario function, of laws and of bodies that can be set, by name."""

from __future__ import annotations

import dataclasses
import inspect
import numbers
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from math import floor, isfinite, log10
from pathlib import Path
from typing import Annotated, Any, get_origin

from mars2d.bodies.props.base import Prop
from mars2d.core.description import Description, bounded, number, text, wrong
from mars2d.core.errors import InputError, nearest
from mars2d.core.hints import described
from mars2d.core.usercode import name_of
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario

Law = Callable[[Any], Any]

PREFIX = "laws."
"""The beginning of the names of laws' parameters: ``laws.follow.gain``."""

STEPS = 100
"""A slider has at least as many steps, unless its numbers are whole."""

BOUNDS = frozenset({"no_load_speed", "grip", "side_grip"})
"""The bounds of drives whose names don't begin with ``max_``."""


class Range(Description):
    """The bounds of a parameter, in its annotation; values beyond them are refused.

    >>> from typing import Annotated
    >>> def scenario(mu: Annotated[float, Range(0.5, 1.5)] = 0.9): ...
    >>> arguments_of(scenario)["mu"].bounds
    Range(low=0.5, high=1.5)
    """

    low: float = number(kw_only=False, doc="the lowest value")
    high: float = number(kw_only=False, doc="the highest value")
    unit: str = text(default="", doc="the unit, for example m/s")

    def _validate(self) -> None:
        if not self.low < self.high:
            raise wrong("Range.high", self.high, f"a number > low, {self.low:g}")

    def check(self, name: str, value: Any) -> None:
        """Raise InputError, which begins with `name`, for a value beyond the bounds."""
        unit = f" [{self.unit}]" if self.unit else ""
        expected = f"a number >= {self.low:g} and <= {self.high:g}{unit}, as its Range says"
        bounded(expected, self.low, high=self.high)(name, value)


@dataclass(frozen=True, slots=True)
class Argument:
    """A numeric argument of a function.

    default: or None. whole: whether it is a whole number. bounds: those of its annotation, or None.
    """

    default: float | None = None
    whole: bool = False
    bounds: Range | None = None

    def check(self, name: str, value: Any) -> None:
        """Raise InputError, which begins with `name`, for a value that it can't have."""
        if isinstance(value, bool) or not isinstance(value, numbers.Real):
            usual = "" if self.default is None else f"; its default is {self.default}"
            raise wrong(name, value, f"a number{usual}")
        if self.whole and self.bounds and not isinstance(value, numbers.Integral):
            raise wrong(name, value, "a whole number")
        if self.bounds is not None:
            self.bounds.check(name, value)


@dataclass(frozen=True, slots=True)
class Parameter:
    """A number that can be set, as a slider shows it.

    name: as ``--set`` knows it. value: now. default: as the file has it. low, high: the ends of its
    slider. whole: whether it is a whole number.
    """

    name: str
    value: float
    default: float
    low: float
    high: float
    unit: str = ""
    whole: bool = False

    @property
    def step(self) -> float:
        """The step of a slider: a power of ten, at most a hundredth of the way from low to high."""
        return 1.0 if self.whole else 10.0 ** floor(log10((self.high - self.low) / STEPS))

    def nearest(self, value: float) -> float:
        """Return the value nearest to a number that a slider can have, between low and high."""
        value = min(max(value, self.low), self.high)
        if self.whole:
            return round(value)
        stepped = round(value, -round(log10(self.step)))
        return stepped if self.low <= stepped <= self.high else value

    @classmethod
    def of(cls, name: str, value: float, argument: Argument, default: float) -> Parameter:
        """Return the parameter of an argument; without a Range, its slider's ends are a guess.

        They are 0 and twice the default, or -1 and 1; a whole number >= 0 goes to 10 at least.
        """
        bounds, whole = argument.bounds, argument.whole
        if bounds is not None:
            return cls(name, value, default, bounds.low, bounds.high, bounds.unit, whole)
        low, high = sorted((0.0, 2.0 * default)) if default or whole else (-1.0, 1.0)
        if whole and default >= 0:
            high = max(high, 10.0)
        return cls(name, value, default, min(low, value), max(high, value), "", whole)


def arguments_of(function: Callable[..., Any]) -> dict[str, Argument]:
    """Return the numeric arguments of a function by name: with a number as default, or a Range.

    Raises InputError for a Range in an annotation that can't be read, and for a default beyond it.
    """
    found = {}
    for name, argument in signature_of(function).items():
        default, kind, bounds = argument.default, argument.annotation, None
        if get_origin(kind) is Annotated:
            bounds = next((each for each in kind.__metadata__ if isinstance(each, Range)), None)
            kind = kind.__origin__
        if is_number(default):
            if bounds is not None:
                bounds.check(f"the default of {_of(function, name)}", default)
            whole = isinstance(default, numbers.Integral) and kind in (int, argument.empty)
            found[name] = Argument(default, whole, bounds)
        elif bounds is not None:
            found[name] = Argument(None, kind is int, bounds)
    return found


def is_number(value: object) -> bool:
    """Return whether a value is a finite real number, and no truth value."""
    return (
        isinstance(value, numbers.Real) and not isinstance(value, bool) and isfinite(float(value))
    )


def _of(function: Callable[..., Any], name: str) -> str:
    return f"{getattr(function, '__name__', 'scenario')}({name})"


def signature_of(function: Callable[..., Any]) -> dict[str, inspect.Parameter]:
    """Return the parameters of a function, none of a compiled one; those in quotes are evaluated.

    Raises InputError for a Range that can't be read; other annotations are the user's business.
    """
    try:
        found = dict(inspect.signature(function).parameters)
    except (TypeError, ValueError):
        return {}
    for name, each in found.items():
        if isinstance(each.annotation, str):
            try:
                kind = eval(each.annotation, getattr(function, "__globals__", {}))
            except Exception as error:
                if "Range" in each.annotation:
                    problem = f"its annotation can't be read: {described(error)}"
                    raise InputError(f"{_of(function, name)}: {problem}") from error
                kind = None
            found[name] = each.replace(annotation=kind)
    return found


def of_arguments(
    function: Callable[..., Any], given: Mapping[str, Any], seed: int | None
) -> Iterator[Parameter]:
    """Yield the parameters of a scenario function.

    given: the values that are set, by name. seed: of the run, the default of a parameter ``seed``.
    """
    for name, argument in arguments_of(function).items():
        default = seed if name == "seed" and seed is not None else argument.default
        value = given.get(name, default)
        if is_number(value):
            usual = value if default is None else default
            yield Parameter.of(name, value, argument, usual)


def of_body(scenario: Scenario, plain: Scenario, body: int) -> Iterator[Parameter]:
    """Yield the parameters of a robot or prop: mass, friction, restitution, bounds of its drive.

    scenario, plain: as it is now, and as its file has it. body: an index of `Scenario.bodies`.
    """
    both: list[list[Robot | Prop]] = [[*each.robots, *each.props] for each in (scenario, plain)]
    part, usual = (bodies[body] for bodies in both)
    index = body - len(scenario.robots)
    family, index = ("robots", body) if index < 0 else ("props", index)
    key = str(index) if set(str(part.name)) & set(".*") else part.name
    defaults = {name: value for name, value, _ in _numbers_of(usual)}
    for name, value, unit in _numbers_of(part):
        default = defaults.get(name, value)
        low, high = (0.0, 1.0) if name == "restitution" else (0.0, 2 * default)
        if "friction" in name:
            high = max(high, 1.0)
        elif name != "restitution":
            low = high / STEPS  # they can't be 0
        bounds = min(low, value), max(high, value)
        yield Parameter(f"{family}.{key}.{name}", value, default, *bounds, unit)


def _numbers_of(part: Robot | Prop) -> Iterator[tuple[str, float, str]]:
    """Yield name, value and unit of the fields of a body that sliders set, if they are numbers."""
    units = {f.name: str(f.metadata.get("unit", "")) for f in dataclasses.fields(part)}
    yield "mass", part.inertia.mass, units["mass"]
    yield "friction", float(part.surface.friction), units["friction"]
    yield "restitution", float(part.surface.restitution), units["restitution"]
    if isinstance(part, Prop):
        yield "ground_friction", part.ground_friction, units["ground_friction"]
        return
    for f in dataclasses.fields(part.drive):
        value = getattr(part.drive, f.name)
        if (f.name.startswith("max_") or f.name in BOUNDS) and is_number(value):
            yield f"drive.{f.name}", value, str(f.metadata.get("unit", ""))


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
