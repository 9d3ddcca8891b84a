"""Descriptions: frozen, keyword-only, validated objects, the gate in front of the engine.

A class that derives from `Description` becomes a frozen dataclass. Its fields are declared with
`number`, `choice`, `flag`, `text` or `entry`, which state bounds, unit and meaning; a plain
annotation (``noise: float = 0.1``) works too. All values of an object have passed these checks: no
NaN, no infinity, no wrong type, no unknown name.
"""

from __future__ import annotations

import copy
import dataclasses
import functools
import inspect
import math
import numbers
import operator
import re
from collections.abc import Callable, Sequence
from typing import Any, ClassVar, Self, TypeVar, dataclass_transform

import numpy as np

from mars2d.core.errors import CERTAIN, CONTROLS, InputError, likely, nearest, shown
from mars2d.core.words import instead

Check = Callable[[str, Any], Any]
"""Called with a field's full name and the value given; returns the value to keep, or raises
InputError."""


Schema = dict[str, Any]
"""A JSON Schema: the values that a check accepts, as far as a schema can say."""

C = TypeVar("C", bound=Check)


def accepts(schema: Schema) -> Callable[[C], C]:
    """Decorate a check with the schema of the values that it accepts, None aside."""

    def marked(check: C) -> C:
        vars(check)["schema"] = schema
        return check

    return marked


def wrong(name: str, value: object, expected: str) -> InputError:
    """Return the error for a field `name` that was given `value`, which is not as expected."""
    return InputError(f"{name} = {shown(value)}: expected {expected}")


@accepts({"type": "number"})
def real(name: str, value: object, expected: str = "a number") -> float:
    """Return `value` as a finite float. Raises InputError for a bool, NaN, an infinity or text."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise wrong(name, value, expected)
    try:
        result = float(value)
    except OverflowError:
        raise wrong(name, value, expected) from None
    if not math.isfinite(result):
        raise wrong(name, value, f"{expected}, and finite")
    return result


def bounded(
    expected: str, low: float | None = None, above: float | None = None, high: float | None = None
) -> Check:
    """Return a check for a finite number: ``low <= value``, ``above < value <= high``."""
    limits = {"minimum": low, "exclusiveMinimum": above, "maximum": high}

    @accepts({"type": "number"} | {name: x for name, x in limits.items() if x is not None})
    def check(name: str, value: object) -> float:
        result = real(name, value, expected)
        over = high is not None and result > high
        if over or (low is not None and result < low) or (above is not None and result <= above):
            raise wrong(name, value, expected)
        return result

    return check


def _bounds(low: float | None, above: float | None, high: float | None, unit: str) -> str:
    signs = ((">=", low), (">", above), ("<=", high))
    limits = [f"{sign} {limit:g}" for sign, limit in signs if limit is not None]
    return " ".join(filter(None, ["a number", " and ".join(limits), f"[{unit}]" if unit else ""]))


def number(
    *,
    low: float | None = None,
    above: float | None = None,
    high: float | None = None,
    unit: str = "",
    optional: bool = False,
    **more: Any,
) -> Any:
    """Declare a field that is a finite float: ``low <= value``, ``above < value <= high``.

    more: see `entry`, here and below.
    """
    expected = _bounds(low, above, high, unit) + (", or None" if optional else "")
    check = bounded(expected, low, above, high)
    return entry(check=check, unit=unit, optional=optional, **more)


def integer(*, low: int, high: int, optional: bool = False, **more: Any) -> Any:
    """Declare a field that is a whole number, ``low <= value <= high``."""
    expected = f"a whole number from {low} to {high}" + (", or None" if optional else "")

    @accepts({"type": "integer", "minimum": low, "maximum": high})
    def check(name: str, value: object) -> int:
        if not low <= (result := _check_int(name, value, expected)) <= high:
            raise wrong(name, value, expected)
        return result

    return entry(check=check, optional=optional, **more)


def choice(*, of: Sequence[str], **more: Any) -> Any:
    """Declare a field that is one of several words."""

    @accepts({"enum": list(of)})
    def check(name: str, value: object) -> str:
        if not isinstance(value, str) or value not in of:
            hint = instead(value, name) or likely(value, of) if isinstance(value, str) else ""
            raise wrong(name, value, "one of " + ", ".join(map(repr, of)) + hint)
        return value

    return entry(check=check, **more)


def flag(**more: Any) -> Any:
    """Declare a field that is True or False."""
    return entry(check=_check_bool, **more)


def text(**more: Any) -> Any:
    """Declare a field that is one line of text, such as a name or a title."""

    @accepts({"type": "string", "pattern": f"^[^{CONTROLS.pattern[1:]}*$"})
    def check(name: str, value: object) -> str:
        found = _check_str(name, value)
        if CONTROLS.search(found):
            raise wrong(name, value, "text in one line, without codes of a terminal")
        return found

    return entry(check=check, **more)


def entry(
    *,
    default: Any = dataclasses.MISSING,
    check: Check,
    unit: str = "",
    doc: str = "",
    factory: Any = dataclasses.MISSING,
    kw_only: bool = True,
    names: str = "",
    optional: bool = False,
) -> Any:
    """Declare a field with its own check, which returns the value to keep.

    optional: whether it may also be None, for which the check is not asked.
    names: what the field mentions by name, for example a "robot", a "body" or a "sensor".
    """
    return dataclasses.field(
        default=default,
        default_factory=factory,
        kw_only=kw_only,
        metadata={"check": check, "unit": unit, "doc": doc, "names": names, "optional": optional},
    )


def whole(text: str) -> str:
    """Return a text with a question mark for each lone surrogate, which UTF-8 can't encode.

    Python uses these for file names that are not valid UTF-8.
    """
    return text.encode(errors="replace").decode()


@accepts({"type": "boolean"})
def _check_bool(name: str, value: object) -> bool:
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    raise wrong(name, value, "True or False")


@accepts({"type": "string"})
def _check_str(name: str, value: object) -> str:
    if not isinstance(value, str):
        raise wrong(name, value, "text in quotes")
    if whole(value) != value:
        raise wrong(name, value, "text without half a character, which no file can hold")
    return value


@accepts({"type": "integer"})
def _check_int(name: str, value: object, expected: str = "a whole number") -> int:
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        raise wrong(name, value, expected)
    return int(value)


_PLAIN: dict[object, Check] = {
    "float": real,
    "int": _check_int,
    "bool": _check_bool,
    "str": _check_str,
}


def _check_of(field: dataclasses.Field[Any]) -> Check | None:
    """Return a field's check; a plain one by its annotation, a class or its name."""
    plain = _PLAIN.get(getattr(field.type, "__name__", field.type))
    check: Check | None = field.metadata.get("check") or plain
    return check


def schema_of(field: dataclasses.Field[Any]) -> Schema:
    """Return the schema of the values that a field accepts, None aside; {} if it says nothing."""
    check = _check_of(field)
    return {} if check is None else vars(check).get("schema", {})


@dataclass_transform(
    frozen_default=True,
    kw_only_default=True,
    field_specifiers=(number, integer, choice, flag, text, entry),
)
class Description:
    """The base of all descriptions. Raises InputError for a wrong, missing or unknown field."""

    __dataclass_fields__: ClassVar[dict[str, dataclasses.Field[Any]]]

    _computed: ClassVar[frozenset[str]] = frozenset()
    """The names of its cached properties."""

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if "__init__" in vars(cls):
            instead = "its fields stand in the class, as `n: int = 3`, and are given by name"
            raise InputError(f"{cls.__name__}.__init__ is not called: {instead}")
        _keep_checks(cls)
        dataclasses.dataclass(frozen=True, kw_only=True, repr=False)(cls)
        cls.__init__ = _gated(cls, cls.__init__)  # type: ignore[method-assign]
        attributes = [each for kind in cls.__mro__ for each in vars(kind).items()]
        cls._computed = frozenset(
            name for name, value in attributes if isinstance(value, functools.cached_property)
        )

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            check, value = _check_of(field), getattr(self, field.name)
            left_out = value is None and field.metadata.get("optional")
            if check is not None and not left_out:
                name = f"{type(self).__name__}.{field.name}"
                object.__setattr__(self, field.name, check(name, value))
        self._validate()

    def _validate(self) -> None:
        """Check conditions that concern several fields together."""

    @classmethod
    def meant(cls, name: str) -> str:
        """Return a hint at the field that an unknown name may mean."""
        known = [field.name for field in dataclasses.fields(cls) if field.init]
        kinds = [kind.__name__ for kind in cls.__mro__]
        certain = likely(name, known, CERTAIN)
        return certain or instead(name, *kinds) or nearest(name, known, most=40)

    def replace(self, **changes: Any) -> Self:
        """Return a copy with some fields changed, validated again."""
        current = {f.name: getattr(self, f.name) for f in dataclasses.fields(self)}
        return type(self)(**(current | changes))

    def renamed(self, old: str, new: str) -> Self:
        """Return a copy in which it, and each of its parts, mentions a robot or prop anew."""
        changes = self.mentions(old, new)
        return self.replace(**changes) if changes else self

    def mentions(self, old: str, new: str) -> dict[str, Any]:
        """Return the fields that mention a robot or prop by a name, with another one instead."""
        changes = {}
        for field in dataclasses.fields(self):
            known, names = getattr(self, field.name), field.metadata.get("names")
            value = _renamed(known, old, new, mentions=names in ("robot", "body"))
            if value is not known:
                changes[field.name] = value
        return changes

    def __getstate__(self) -> dict[str, Any]:
        """Return the state that is copied and pickled: everything but cached properties."""
        return {k: value for k, value in self.__dict__.items() if k not in self._computed}

    def _changed(self) -> dict[str, Any]:
        """Return the fields that differ from their defaults, in order."""
        found = {}
        for field in dataclasses.fields(self):
            value, made = getattr(self, field.name), field.default_factory
            if value != (field.default if made is dataclasses.MISSING else made()):
                found[field.name] = value
        return found

    def __repr__(self) -> str:
        changed = (f"{name}={shown(value, 200)}" for name, value in self._changed().items())
        return f"{type(self).__name__}({', '.join(changed)})"


def _renamed(value: Any, old: str, new: str, *, mentions: bool) -> Any:
    """Return a field's value with a new name of a body; mentions: whether words in it are names."""
    if isinstance(value, Description):
        return value.renamed(old, new)
    if isinstance(value, tuple):
        found = tuple(_renamed(each, old, new, mentions=mentions) for each in value)
        return value if all(map(operator.is_, found, value)) else found
    return new if mentions and value == old else value


def _keep_checks(cls: type[Description]) -> None:
    """Keep an inherited field's check when a subclass gives the field a new default."""
    inherited = getattr(super(cls, cls), "__dataclass_fields__", {})
    annotations = inspect.get_annotations(cls)
    for name, field in inherited.items():
        default = vars(cls).get(name, dataclasses.MISSING)
        declared = name in annotations or default is not dataclasses.MISSING
        if declared and "check" in field.metadata and not isinstance(default, dataclasses.Field):
            setattr(cls, name, entry(default=default, kw_only=field.kw_only, **field.metadata))
            annotations = {name: field.type} | annotations
    cls.__annotations__ = annotations


def _gated(cls: type, init: Callable[..., None]) -> Callable[..., None]:
    """Wrap a dataclass's __init__ so that unknown and missing names raise InputError."""
    known = {f.name: f for f in dataclasses.fields(cls) if f.init}
    positional = [name for name, f in known.items() if not f.kw_only]
    required = [
        f.name for f in known.values() if f.default is f.default_factory is dataclasses.MISSING
    ]

    @functools.wraps(init)
    def checked(self: Any, *args: Any, **kwargs: Any) -> None:
        if type(self) is cls:
            for name in kwargs:
                if name not in known:
                    raise InputError(f"{cls.__name__} has no field {name!r}{cls.meant(name)}")
            if len(args) > len(positional):
                first = next(iter([*required, *inspect.get_annotations(cls), *known]), "field")
                example = f"{cls.__name__}({first}=...)"
                raise InputError(f"{cls.__name__} takes its fields by name, as in {example}")
            given = {*positional[: len(args)], *kwargs}
            for name in required:
                if name not in given:
                    raise InputError(f"{cls.__name__}.{name} is missing")
        init(self, *args, **kwargs)

    return checked


class Stateful(Description):
    """The base of parts that keep state during a run: their methods may set attributes of self.

    The description itself is frozen like any other. Each run works on a copy that is not, made by
    `live`.
    """

    _live: ClassVar[bool] = False

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        frozen = cls.__setattr__

        def set_attribute(self: Stateful, attribute: str, value: Any) -> None:
            if self.__dict__.get("_live"):
                object.__setattr__(self, attribute, value)
            else:
                frozen(self, attribute, value)

        cls.__setattr__ = set_attribute  # type: ignore[method-assign, assignment]

    def live(self, **attributes: Any) -> Self:
        """Return a copy whose attributes may be set, some of them set already."""
        twin = copy.deepcopy(self)
        twin.__dict__.update(_live=True, **attributes)
        return twin


def snake_case(name: str) -> str:
    """Return a class name in lower case, its words joined by underscores.

    >>> snake_case("RangeFinder")
    'range_finder'
    """
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name).lower()
