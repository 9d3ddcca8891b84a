"""Scenarios as plain data, without code, as files hold them."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, NamedTuple, get_args, get_origin, get_type_hints

from mars2d.addons.base import Addon
from mars2d.addons.communication import Burst
from mars2d.addons.map import Map
from mars2d.bodies.drives.base import Drive
from mars2d.bodies.drives.wheeled import Unicycle
from mars2d.bodies.joints.base import Joint
from mars2d.bodies.props.base import Prop
from mars2d.bodies.props.solid import Solid
from mars2d.core.description import Description, snake_case
from mars2d.core.errors import InputError
from mars2d.core.materials import Coefficient
from mars2d.geometry.shapes import Compound, Disc, Polygon, Shape
from mars2d.scenario.animation import Animation
from mars2d.scenario.controllers import Controller
from mars2d.scenario.material_pair import MaterialPair
from mars2d.scenario.neighbours import Delaunay, Everyone, Graph, Nearest, Neighbourhood, Within
from mars2d.scenario.random_starts import RandomStarts
from mars2d.scenario.registry import FAMILIES, family_of, members
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario


class Place(NamedTuple):
    """A field that holds parts derived from `base`: one of them or a list.

    default: the class that is meant if no type is given, which has fields; None: it must be given.
    """

    base: type[Description]
    many: bool = False
    default: type[Description] | None = None


def _parts_of(kind: type[Any]) -> dict[str, Place]:
    """Return the fields of a class, inherited ones included, that hold parts, as annotated."""
    hints, found = get_type_hints(kind), {}
    for field in dataclasses.fields(kind):
        hint = hints[field.name]
        for base in (hint, *get_args(hint)):
            if isinstance(base, type) and issubclass(base, Description):
                usual: tuple[Any, ...] = (base, field.default_factory)
                known = (each for each in usual if each in all_kinds().values())
                meant = next(filter(dataclasses.fields, known), None)
                found[field.name] = Place(base, get_origin(hint) is Sequence, meant)
    return found


parts_of: Callable[[type], dict[str, Place]] = cache(_parts_of)


def kinds_of(base: type[Description]) -> dict[str, type[Description]]:
    """Return all classes by name that a file may name where a `base` is expected."""
    return {kind.__name__: kind for kind in all_kinds().values() if issubclass(kind, base)}


def is_ready_made(kind: type | None) -> bool:
    """Return whether a class is one of the ready-made laws, which a file can name."""
    return kind in kinds_of(Controller).values()


def changed(part: Description, index: int = 0) -> dict[str, Any]:
    """Return the fields of a part that differ from their defaults, in order.

    index: its place in its list. The name that a scenario gives a robot or prop there by itself is
    left out.

    >>> changed(Robot(mass=2.0, diameter=0.3, name="robot0"))
    {'mass': 2.0}
    """
    kind = "robot" if isinstance(part, Robot) else snake_case(type(part).__name__)
    found = part._changed()
    if isinstance(part, (Robot, Prop)) and part.name == f"{kind}{index}":
        del found["name"]
    return found


def from_description(value: Any) -> Any:
    """Return a description as dicts, lists, text and numbers; a function becomes its name."""
    if isinstance(value, Description):
        kind = type(value)
        if kind.__module__.startswith("mars2d."):
            with_family = f"{family_of(kind)}.{kind.__name__}"  # where two have one name
            name = with_family if with_family in all_kinds() else kind.__name__
            return {"type": name, **_fields(value)}
        for base in (Scenario, Robot, Animation):  # a derived class counts as one of them
            if isinstance(value, base):
                return {"type": base.__name__, **_fields(value, base)}
        own = next(name for name, base in _OWN.items() if isinstance(value, base))
        return {"type": kind.__name__, "own": own, **_fields(value), **_moving(value)}
    if isinstance(value, (list, tuple)):
        return [from_description(item) for item in value]
    if isinstance(value, Coefficient):
        return value.material
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    return {"function": getattr(value, "__name__", type(value).__name__)}


def _fields(value: Description, kind: type[Description] | None = None) -> dict[str, Any]:
    """Return the fields of a description as plain data, or those of a class it derives from."""
    fields = dataclasses.fields(kind or type(value))
    return {f.name: from_description(getattr(value, f.name)) for f in fields}


def _moving(value: Description) -> dict[str, Any]:
    """Return the data of a part of the user's own that motion depends on; its code is lost."""
    if isinstance(value, Addon):
        return {"obstacles": from_description(value.obstacles())}
    if isinstance(value, Prop):
        mass, moment = value.inertia
        surface = value.surface
        return {
            "shape": from_description(value.shape), "mass": mass, "moment": moment,
            "friction": from_description(surface.friction),
            "restitution": from_description(surface.restitution),
            "static_friction": surface.static_friction,
            "joints": from_description(value.joints()),
        }  # fmt: skip
    if isinstance(value, Shape):
        parts = [
            Disc(2 * radius, center=points[0]) if radius else Polygon(points)
            for points, radius in value.rims
        ]
        return {"parts": from_description(parts)}
    return {}


_OWN: dict[str, type[Description]] = {
    "drive": Drive, "prop": Prop, "joint": Joint, "shape": Shape, "add-on": Addon,
    "neighbourhood": Neighbourhood, "controller": Controller, "sensor": Description,
}  # fmt: skip
"""The classes that parts of the user's own derive from, by their names in files."""

LOST = "This is code, which is not written down"
"""What files say about parts that they do not hold."""

MOVING = ("drive", "joint", "shape")
"""Families of which a part of the user's own is needed to move as recorded."""


def to_scenario(data: Any) -> tuple[Scenario, tuple[str, ...]]:
    """Return the scenario that `from_description` made plain, and the names of missing parts.

    Laws do not come back, except the ready-made ones, nor do parts that hold a function of the
    user's own. Of parts of the user's own, sensors and joints are left out, and add-ons keep their
    obstacles only. A prop is replaced by a Solid of its shape, mass and surface, a shape by the
    parts that were drawn of it, a drive by a Unicycle, a neighbourhood by Everyone. All are named
    in the second value, such as ``sensor Eyes``. Raises InputError for anything but a scenario.
    """
    missing: list[str] = []
    result = _to_description(data, missing)
    if not isinstance(result, Scenario):
        raise InputError(f"expected a scenario, found {type(result).__name__}")
    return result, tuple(dict.fromkeys(missing))


def without_code(scenario: Scenario) -> tuple[Scenario, tuple[str, ...]]:
    """Return a scenario without code of the user's own except laws, and the missing parts.

    Missing parts are replaced as by `to_scenario`.
    """
    kept, missing = to_scenario(from_description(scenario))
    return kept.with_laws([robot.controller for robot in scenario.robots]), missing


def _to_description(value: Any, missing: list[str]) -> Any:
    if isinstance(value, list):
        items = [_to_description(item, missing) for item in value]
        return [item for item in items if item is not _LEFT_OUT]
    if not isinstance(value, dict):
        return value
    if _is_function(value):
        return value["function"]
    unread = ("type", "own", "controller")
    read = {name: each for name, each in value.items() if name not in unread}
    lost = next((each["function"] for each in read.values() if _is_function(each)), "")
    if lost and "own" not in value:
        missing.append(f"{value['type']}, with its function {lost}")
        return _LEFT_OUT
    fields = {name: _to_description(each, missing) for name, each in read.items()}
    law = value.get("controller")
    if law and is_ready_made(all_kinds().get(law.get("type"))):
        fields["controller"] = _to_description(law, missing)
    if "own" in value:
        missing.append(f"{value['own']} {value['type']}")
        if value["own"] == "prop":
            missing.extend(f"joint {joint['type']} of {value['type']}" for joint in value["joints"])
        return _stand_in(value["own"], fields)
    kind = all_kinds()[value["type"]]
    known = kind.__dataclass_fields__  # a record from before may say of others that they are off
    return kind(**{name: each for name, each in fields.items() if each or name in known})


def _is_function(value: Any) -> bool:
    return isinstance(value, dict) and [*value] == ["function"]


@cache
def all_kinds() -> dict[str, type[Description]]:
    """Return all classes by the names that records give them."""
    kinds: dict[str, type[Description]] = {kind.__name__: kind for kind in _KNOWN}
    for family in FAMILIES:
        for name, kind in members(family).items():
            kinds[f"{family}.{name}" if name in kinds else name] = kind
    return kinds


_KNOWN = (
    Scenario, Robot, Animation, Disc, Polygon, Compound, Burst,
    Everyone, Within, Nearest, Delaunay, Graph, MaterialPair, RandomStarts,
)  # fmt: skip


def _stand_in(family: str, fields: dict[str, Any]) -> Any:
    """Return the replacement for a part of the user's own, or `_LEFT_OUT`."""
    if family == "drive":
        return Unicycle(**_common(Drive, fields))
    if family == "prop":
        return Solid(fields["shape"], **_common(Prop, fields))
    if family == "shape":
        return Compound(fields["parts"])
    if family == "add-on" and fields["obstacles"]:
        return Map(fields["obstacles"], **_common(Addon, fields))
    return Everyone() if family == "neighbourhood" else _LEFT_OUT


def _common(base: type[Description], fields: dict[str, Any]) -> dict[str, Any]:
    """Return the fields that all parts of a family have; older files lack the newer ones."""
    return {f.name: fields[f.name] for f in dataclasses.fields(base) if f.name in fields}


_LEFT_OUT = object()
