"""Checks of fields: points, poses, polygons, lists of parts, functions, names."""

from __future__ import annotations

import inspect
import keyword
from collections import Counter
from collections.abc import Iterable
from itertools import islice, pairwise
from types import GeneratorType
from typing import Any

import numpy as np

from mars2d.core.arithmetic import norms
from mars2d.core.description import Check, Schema, accepts, bounded, wrong
from mars2d.core.errors import InputError, shown
from mars2d.core.plane import Outline, Point, is_clearly_convex
from mars2d.core.usercode import definition

MAX_COORDINATE = 1e6
"""The largest coordinate, metres: beyond it a double can't resolve a nanometre."""


def items_of(name: str, value: object, expected: str, most: int = 1_000_000) -> list[Any]:
    """Return the items of a list, an array or anything that yields them; no more than `most`."""
    if isinstance(value, (str, bytes, dict)) or not isinstance(value, Iterable):
        raise wrong(name, value, expected)
    try:
        items = list(islice(value, most + 1))
    except TypeError:  # an array of no dimension
        raise wrong(name, value, expected) from None
    if len(items) > most:
        raise wrong(name, value, f"{expected}, at most {most:,}: it has more, or no end")
    return items


def several(low: float, high: float, count: int, expected: str, fewer: int = 0) -> Check:
    """Return a check for so many numbers from low to high, kept as a tuple.

    fewer: how many may be left out at the end; they are 0.
    """
    each = bounded(expected, low, high=high)
    item = vars(each)["schema"]

    @accepts({"type": "array", "items": item, "minItems": count - fewer, "maxItems": count})
    def check(name: str, value: object) -> tuple[float, ...]:
        items = items_of(name, value, expected)
        if not count - fewer <= len(items) <= count:
            commas = "; decimals have a point: 0.5" if len(items) > count else ""
            raise wrong(name, value, expected + commas)
        try:
            found = [each(name, item) for item in items]
        except InputError:
            raise wrong(name, value, expected) from None
        return (*found, *[0.0] * (count - len(found)))

    return check


_FAR = f"within +-{MAX_COORDINATE:g}"

point = several(-MAX_COORDINATE, MAX_COORDINATE, 2, f"a point (x, y) in metres, {_FAR}")
"""The check of a point (x, y) in metres."""

pose = several(
    -MAX_COORDINATE, MAX_COORDINATE, 3, f"a pose (x, y, theta) in metres and radians, {_FAR}", 1
)
"""The check of a pose (x [m], y [m], theta [rad]); a point (x, y) has theta 0."""

POINT: Schema = vars(point)["schema"]
OUTLINE: Schema = {"type": "array", "items": POINT, "minItems": 2}


@accepts(OUTLINE)
def outline(name: str, value: object, least: int = 2, *, closed: bool = True) -> Outline:
    """Check an outline: a wall of two vertices, or a closed polygon that does not cross itself.

    least: how many vertices it must have. closed: False for an open line of any number of them.
    """
    what = "two vertices for a wall or more for a polygon" if least == 2 else "a polygon's vertices"
    what = what if closed else "a line's vertices"
    expected = f"{what}, such as [(x, y), ...] in metres"
    items = items_of(name, value, expected)
    points = [point(f"{name}[{i}]", item) for i, item in enumerate(items)]
    if closed and len(points) > 2 and points[0] == points[-1]:
        points.pop()  # the ring was given closed
    if len(points) < least:
        raise wrong(name, value, f"{expected}, at least {least} different ones")
    ring = closed and len(points) > 2
    for i, (a, b) in enumerate(pairwise([*points, points[0]] if ring else points)):
        if norms(a[0] - b[0], a[1] - b[1]) < 1e-6:
            after = (i + 1) % len(points)
            raise InputError(f"{name}: vertices {i} and {after} are the same, {a}")
    if ring:
        _check_ring(name, points)
    return tuple(points)


@accepts(OUTLINE | {"minItems": 3})
def polygon(name: str, value: object) -> Outline:
    """Check the outline of an area: three vertices or more."""
    return outline(name, value, least=3)


@accepts(OUTLINE)
def line(name: str, value: object) -> Outline:
    """Check an open line of two or more vertices, which may cross itself."""
    return outline(name, value, closed=False)


def _check_ring(name: str, points: list[Point]) -> None:
    """Raise InputError for a polygon that crosses itself or has no area."""
    if is_clearly_convex(np.array(points)):
        return
    import shapely

    ring = shapely.Polygon(points)
    straight = np.linalg.matrix_rank(np.diff(np.array(points), axis=0), tol=1e-9) < 2
    if not ring.is_valid and not straight:
        reason = shapely.is_valid_reason(ring)  # for example "Self-intersection[1 1]"
        place = reason.partition("[")[2].rstrip("]").replace(" ", ", ")
        raise InputError(
            f"{name}: the polygon crosses or touches itself at ({place}): "
            "list its vertices in order round the outline"
        )
    if straight or ring.area < 1e-9:
        raise wrong(name, points, "a polygon with an area; its vertices lie on one line")


@accepts({"type": "array", "items": OUTLINE})
def polylines(name: str, value: object) -> tuple[Outline, ...]:
    """Check a list of open lines, each of two or more vertices."""
    return tuple(line(each, item) for each, item in lists_of(name, value, "walls"))


@accepts({"type": "array", "items": OUTLINE})
def outlines(name: str, value: object) -> tuple[Outline, ...]:
    """Check a list of outlines."""
    return tuple(outline(each, item) for each, item in lists_of(name, value, "outlines"))


def lists_of(name: str, value: object, what: str) -> list[tuple[str, Any]]:
    """Return the items of a list of lists of points, each with its name."""
    items = items_of(name, value, f"a list of {what}, each [(x, y), ...] in metres")
    first = items[0] if items else None
    if isinstance(first, (tuple, list, np.ndarray)) and len(first) and np.ndim(first[0]) == 0:
        raise wrong(name, value, f"a list of {what}: put one more pair of brackets round it")
    return [(f"{name}[{i}]", item) for i, item in enumerate(items)]


def instance(kind: type, example: str) -> Check:
    """Return a check for one object of a class."""

    def check(name: str, value: object) -> object:
        if isinstance(value, type) and issubclass(value, kind):
            raise InputError(
                f"{name} = {value.__name__}: expected an object; write {value.__name__}(...)"
            )
        if not isinstance(value, kind):
            article = "an" if kind.__name__[0] in "AEIOU" else "a"
            raise wrong(name, value, f"{article} {kind.__name__}, such as {example}")
        return value

    return check


def listing(kind: type, example: str) -> Check:
    """Return a check for a list of objects of a class, kept as a tuple."""

    def check(name: str, value: object) -> tuple[Any, ...]:
        if isinstance(value, kind):
            raise InputError(f"{name} = {shown(value)}: expected a list; write [{shown(value)}]")
        items = items_of(name, value, f"a list, such as [{example}]")
        each = instance(kind, example)
        return tuple(each(f"{name}[{i}]", item) for i, item in enumerate(items))

    return check


def names(expected: str, least: int = 1) -> Check:
    """Return a check for a list of at least so many different names."""

    @accepts({"type": "array", "items": {"type": "string"}, "minItems": least, "uniqueItems": True})
    def check(name: str, value: object) -> tuple[str, ...]:
        if not isinstance(value, (tuple, list)) or len(value) < least:
            raise wrong(name, value, expected)
        for item in value:
            if not isinstance(item, str):
                raise wrong(name, value, expected)
            if value.count(item) > 1:
                raise InputError(f"{name}: {item!r} stands there twice")
        return tuple(value)

    return check


def unique(name: str, keys: list[str]) -> None:
    """Raise InputError if a name occurs twice in a list."""
    for key, count in Counter(keys).items():
        if count > 1:
            raise InputError(f"{name}: two are called {key!r}; give one another name=...")


RESULTS = (tuple, list, np.ndarray, GeneratorType)
"""What laws return: where a function is expected, it was called."""

_OTHERWISE = {
    ("the world", "robot"): "it is called with the world, for the whole team: rename its parameter "
    "and take world.robots, or give it to a robot, Robot(controller=...)",
    ("the robot", "world"): "it is called with a robot: rename its parameter; robot.world is the "
    "world. The law of a team is a function control(world) of the file",
}
"""What to say of laws whose parameter has the other name."""


def function(name: str, value: object, *arguments: str) -> object:
    """Check a function of these arguments, which are described in words."""
    count = {1: "one argument", 2: "two arguments"}[len(arguments)]
    words = " and ".join(arguments)
    if not callable(value):
        hint = "; write its name without brackets ()" if isinstance(value, RESULTS) else ""
        hint = "; write its name without quotes" if isinstance(value, str) else hint
        raise wrong(name, value, f"a function of {count}, {words}{hint}")
    if isinstance(value, type):
        expected = f"an object of it, or a function of {count}, {words}"
        raise InputError(
            f"{name} = {value.__name__}: expected {expected}; write {value.__name__}(...)"
        )
    try:
        given = inspect.signature(value)
    except ValueError:
        return value  # a built-in without a signature: the first call will show
    called = f"{name} = {getattr(value, '__name__', type(value).__name__)}{given}"
    try:
        parameters = given.bind(*arguments).arguments
    except TypeError:
        raise InputError(f"{called}: expected a function of exactly {count}, {words}") from None
    if (meant := (words, next(iter(parameters)))) in _OTHERWISE:
        error = InputError(f"{called}: {_OTHERWISE[meant]}")
        error.where = definition(value) if words == "the world" else None
        raise error
    return value


NAME = r"[^\x00-@\[-`{-\u007f][^\x00-/:-@\[-^`{-\u007f]*"
"""The pattern of letters, digits and _, a letter first, whatever a pattern takes for a letter."""


def identifier(prefix: str) -> Check:
    """Return a check for a part's name, which follows the `prefix` in the code of laws."""
    expected = f"letters, digits and _, a letter first, as it follows {prefix}"

    @accepts({"type": "string", "pattern": f"^{NAME}$"})
    def check(name: str, value: object) -> str:
        known = isinstance(value, str) and value.isidentifier() and not keyword.iskeyword(value)
        if not known or str(value).startswith("_"):
            raise wrong(name, value, expected)
        return str(value)

    return check
