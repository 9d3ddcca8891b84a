"""Interventions: changes that somebody made to a running world, such as moving or pulling bodies.

Each has its `row` in the record, and was made before the commands of that row took effect. A run
can be repeated to the bit from its commands and interventions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, fields
from typing import Any

from mars2d.core.plane import Point
from mars2d.scenario import serialize
from mars2d.scenario.scenario import Scenario

Triple = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Place:
    """A body was put at a pose (x, y [m], theta [rad]), at rest.

    body: its index in `Scenario.bodies`.
    """

    row: int
    body: int
    pose: Triple


@dataclass(frozen=True, slots=True)
class Pull:
    """A body was pulled by a spring of limited force, until the next `Pull` of that body.

    grip: the point of the body that is held [m], in its own frame. target: the point to which it is
    pulled [m]; None if it was let go. force: the spring's largest force [N]. speed: the largest
    speed at which it draws [m/s].
    """

    row: int
    body: int
    grip: Point
    target: Point | None
    force: float
    speed: float


@dataclass(frozen=True, slots=True)
class Push:
    """A constant force (x, y) [N] acted on a body for a duration [s]; a pull is one of a spring.

    grip: the point of the body at which it acted [m], in its own frame.
    """

    row: int
    body: int
    grip: Point
    force: Point
    duration: float


@dataclass(frozen=True, slots=True)
class Steer:
    """A robot was driven by hand from here on, or no longer; its commands are in the record.

    robot: its index.
    """

    row: int
    robot: int
    driven: bool


@dataclass(frozen=True, slots=True)
class Change:
    """The scenario was changed: obstacles, workspace, masses, friction, drives or laws.

    moved: bodies that were moved at the same time, by index in `Scenario.bodies`, and their poses.
    control: the law of the team from then on, which files do not keep. given: the names of robots
    that were given other laws by hand, not by their file; files do not keep these either. options:
    the parameters that were set, if that is what changed it, by their names for ``--set``, with
    their values.
    """

    row: int
    scenario: Scenario
    moved: tuple[tuple[int, Triple], ...] = ()
    control: Callable[[Any], Any] | None = field(default=None, compare=False)
    options: tuple[tuple[str, Any], ...] = ()
    given: frozenset[str | None] = field(default=frozenset(), compare=False)


Intervention = Place | Pull | Push | Steer | Change

Leap = tuple[int, int]
"""A row, and a body that was put elsewhere then: it went no way there from the row before."""


def leaps_of(done: Iterable[Intervention]) -> tuple[Leap, ...]:
    """Return where bodies were put elsewhere, in order: the rule for all paths that are drawn."""
    leaps: list[Leap] = []
    for each in done:
        if isinstance(each, Place):
            leaps.append((each.row, each.body))
        elif isinstance(each, Change):
            leaps += [(each.row, body) for body, _ in each.moved]
    return tuple(leaps)


def pushes_at(done: Iterable[Intervention], time: float, sampling_time: float) -> list[Push]:
    """Return the pushes that act at a time; both in seconds."""
    found = (each for each in done if isinstance(each, Push))
    return [each for each in found if 0 <= time - each.row * sampling_time < each.duration]


def to_plain(intervention: Intervention) -> dict[str, Any]:
    """Return an intervention as dicts, lists, text and numbers."""
    kept = [each.name for each in fields(intervention) if each.compare]  # not what is code
    values = {name: serialize.from_description(getattr(intervention, name)) for name in kept}
    if options := values.pop("options", None):
        values["settings"] = options  # as files have called them ever since
    return {"type": type(intervention).__name__, **values}


def of_plain(data: Any) -> Intervention:
    """Return the intervention that `to_plain` made plain. Raises various exceptions if it can't."""
    values = {n if n != "settings" else "options": _read(v) for n, v in data.items() if n != "type"}
    return _KINDS[data["type"]](**values)


def of_one_hand(before: Intervention, after: Intervention) -> bool:
    """Return whether two interventions in turn belong to one pull, one drive, or one slider."""
    if isinstance(before, Pull) and isinstance(after, Pull):
        return before.body == after.body and before.target is not None
    if isinstance(before, Steer) and isinstance(after, Steer):
        return before.robot == after.robot and before.driven
    if isinstance(before, Change) and isinstance(after, Change) and after.options:
        return [name for name, _ in before.options] == [name for name, _ in after.options]
    return False


def _read(value: Any) -> Any:
    if isinstance(value, dict):
        return serialize.to_scenario(value)[0]
    return tuple(map(_read, value)) if isinstance(value, list) else value


_KINDS: dict[str, type[Intervention]] = {
    kind.__name__: kind for kind in (Place, Pull, Push, Steer, Change)
}
