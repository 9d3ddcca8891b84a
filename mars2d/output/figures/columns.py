"""Columns of a record by name: x, speed, command.v, range_finder.90."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.description import wrong
from mars2d.core.errors import InputError, likely, nearest
from mars2d.core.quantity import Quantity
from mars2d.output.formats.columns import POSE_UNITS
from mars2d.record.energy import WORK
from mars2d.record.interventions import Change, Place

if TYPE_CHECKING:
    from mars2d.record.record import Record
    from mars2d.sensors import Sensor

__all__ = ["Signal", "chosen_robots", "known_columns", "signals"]

Float = NDArray[np.float64]

SPEED = "speed"

DRIVE_UNIT = "unit of the drive"
"""The unit of commands if drives state none, or different ones."""

COLOR_UNIT = "red, green, blue"
"""The unit of colours, which are drawn in their own colours."""

NOTHING = 1e-9
"""Work of less than this share of the largest energy is not drawn."""

MIN_IMAGE_NUMBERS = 6
"""The fewest numbers of one kind in a reading that is drawn as an image."""


@dataclass(frozen=True, eq=False)
class Signal:
    """A column over time.

    values: (T, k), one column for each of the `bodies`; (T, k, beams) for readings of many numbers,
    (T, k, pixels, 3) for colours. held: "post" if a value holds until the next row, "pre" if it has
    held since the row before, "" if it belongs to an instant. bearings: (beams,) degrees, if known.
    """

    name: str
    unit: str
    values: NDArray[Any]
    bodies: tuple[int, ...]
    held: str = ""
    bearings: Float | None = None
    nearest: bool = False
    """Whether an image that is thinned keeps the smallest numbers, as for distances."""
    wraps: bool = False
    """Whether the values are angles, which jump from pi to -pi."""
    curves: tuple[str, ...] = ()
    """The names of the curves, where the values are of no single bodies."""


def signals(
    record: Record, names: Sequence[str], robots: Sequence[str | int] | None
) -> list[Signal]:
    """Return the signals of some column names; a command gives two, one for each part.

    robots: names or indices; None: all. Raises InputError for an unknown column or robot, and for
    readings with too many axes to draw, of which a part must be chosen.
    """
    which = chosen_robots(record, robots)
    return [signal for name in names for signal in _named(record, name, which)]


def chosen_robots(record: Record, robots: Sequence[str | int] | None) -> tuple[int, ...]:
    """Return the indices of robots by name or index, all for None, each once."""
    scenario = record.scenario
    if robots is None:
        return tuple(range(len(scenario.robots)))
    given = [robots] if isinstance(robots, (str, int)) else list(robots)
    if not given:
        raise wrong("robots", robots, "names or indices of robots, as ['ann', 0]")
    found = []
    for robot in given:
        if isinstance(robot, bool) or not isinstance(robot, (str, int, np.integer)):
            raise wrong("robots", robot, "the name of a robot or its index")
        found.append(scenario.index_of("robots", robot))
    return tuple(dict.fromkeys(found))


def known_columns(record: Record) -> list[str]:
    """Return the names of all columns, without their parts."""
    names = [*POSE_UNITS, SPEED, "command", "effort", "energy", "kinetic", "momentum"]
    names += record.sensors
    if record.scenario.props:
        names += [f"prop.{part}" for part in (*POSE_UNITS, SPEED)]
    return names


def _named(record: Record, name: object, robots: tuple[int, ...]) -> list[Signal]:
    if not isinstance(name, str):
        raise wrong("columns", name, "names of columns, as 'x' or 'effort'")
    head, *parts = name.strip().split(".")
    makers: dict[str, Callable[..., list[Signal]]] = {
        **dict.fromkeys((*POSE_UNITS, SPEED), _motion),
        "command": _command,
        "effort": _effort,
        "energy": _energy,
        "kinetic": _kinetic,
        "momentum": _momentum,
    }
    if head in makers:
        return makers[head](record, name, head, parts, robots)
    if head == "prop":
        return _props(record, name, parts)
    head = head.removeprefix("sensor:")  # as `Record.columns` calls them
    if head in record.sensors:
        return _readings(record, name, head, parts, robots)
    known = nearest(name, known_columns(record), most=30)
    raise InputError(f"columns: there is no {name!r}{known}")


def _no_parts(name: str, head: str, parts: list[str]) -> None:
    if parts:
        raise InputError(f"columns: {name!r}: {head} has no parts; expected {head!r}")


def _motion(
    record: Record, name: str, head: str, parts: list[str], robots: tuple[int, ...]
) -> list[Signal]:
    _no_parts(name, head, parts)
    return [_of_poses(record, head, head, record.pose, robots, 0)]


def _of_poses(
    record: Record, name: str, what: str, pose: Float, which: Sequence[int], first: int
) -> Signal:
    """Return a coordinate or the speed of some poses; column k belongs to body `first + k`."""
    columns = list(which)
    numbers = tuple(first + k for k in columns)
    if what in POSE_UNITS:
        return Signal(
            name, POSE_UNITS[what], pose[:, list(POSE_UNITS).index(what), columns], numbers
        )
    speed = np.full((len(pose), len(columns)), np.nan)
    step = np.diff(pose[:, :2, columns], axis=0)
    speed[1:] = np.hypot(step[:, 0], step[:, 1]) / record.scenario.sampling_time
    for row, body in _put_elsewhere(record):
        if body in numbers and row < len(speed):  # it did not drive there
            speed[row, numbers.index(body)] = np.nan
    return Signal(name, "m/s", speed, numbers, "pre")


def _put_elsewhere(record: Record) -> Iterator[tuple[int, int]]:
    """Yield (row, body) for each body that was placed by hand, rather than driven."""
    for each in record.interventions:
        if isinstance(each, Place):
            yield each.row, each.body
        elif isinstance(each, Change):
            yield from ((each.row, body) for body, _ in each.moved)


def _command(
    record: Record, name: str, head: str, parts: list[str], robots: tuple[int, ...]
) -> list[Signal]:
    found = {record.scenario.robots[i].drive.quantities for i in robots}
    agreed = found.pop() if len(found) == 1 else ()
    kinds = agreed or (Quantity("0", DRIVE_UNIT), Quantity("1", DRIVE_UNIT))
    wanted = [0, 1]
    if parts:
        known = {"0": 0, "1": 1} | {kind.name: k for k, kind in enumerate(kinds)}
        part = ".".join(parts)
        if part not in known:
            raise InputError(f"columns: {name!r}: {head} has no {part!r}{nearest(part, known)}")
        wanted = [known[part]]
    return [
        Signal(
            f"command {kinds[k].name}" if agreed else f"command.{k}",
            kinds[k].unit, record.command[:, k, list(robots)], robots, "post",
        )
        for k in wanted
    ]  # fmt: skip


def _effort(
    record: Record, name: str, head: str, parts: list[str], robots: tuple[int, ...]
) -> list[Signal]:
    _no_parts(name, head, parts)
    return [Signal("effort", "", record.effort[:, list(robots)], robots, "pre")]


def _energy(
    record: Record,
    name: str,
    head: str,
    parts: list[str],
    robots: tuple[int, ...],  # noqa: ARG001
) -> list[Signal]:
    """Return the kinetic energy of all bodies, and the work of all that has done any."""
    _no_parts(name, head, parts)
    energy = record.energy
    known = not np.isnan(energy.work[:1]).any()
    values = {"kinetic, of all" if known else "kinetic, by mean velocities": energy.total}
    values |= {f"work of {what}": energy.by(what) for what in WORK}
    least = NOTHING * max(float(np.abs(each).max(initial=0)) for each in values.values())
    shown = {
        what: each
        for k, (what, each) in enumerate(values.items())
        if k == 0 or np.abs(each).max(initial=0) > least
    }
    curves = np.stack(list(shown.values()), axis=-1)
    return [Signal("energy", "J", curves, (), curves=tuple(shown))]


def _kinetic(
    record: Record, name: str, head: str, parts: list[str], robots: tuple[int, ...]
) -> list[Signal]:
    _no_parts(name, head, parts)
    bodies = (*robots, *range(len(record.scenario.robots), len(record.scenario.bodies)))
    return [Signal("kinetic energy", "J", record.energy.kinetic[:, list(bodies)], bodies)]


def _momentum(
    record: Record,
    name: str,
    head: str,
    parts: list[str],
    robots: tuple[int, ...],  # noqa: ARG001
) -> list[Signal]:
    """Return the momentum of all bodies: x, y, and the angular one about the origin."""
    _no_parts(name, head, parts)
    momentum = record.momentum
    return [
        Signal("momentum", "N s", momentum.total, (), curves=("x", "y")),
        Signal(
            "angular momentum", "N m s", momentum.angular[:, None], (), curves=("about the origin",)
        ),
    ]


def _props(record: Record, name: str, parts: list[str]) -> list[Signal]:
    known = (*POSE_UNITS, SPEED)
    if not record.scenario.props:
        raise InputError(f"columns: {name!r}: the record has no props")
    if len(parts) != 1 or parts[0] not in known:
        expected = ", ".join(f"'prop.{part}'" for part in known)
        hint = likely(".".join(parts), known)
        raise InputError(f"columns: there is no {name!r}: expected one of {expected}{hint}")
    which, first = range(len(record.scenario.props)), len(record.scenario.robots)
    return [_of_poses(record, name, parts[0], record.prop_pose, which, first)]


# -- readings of sensors --------------------------------------------------------------------------


def _readings(
    record: Record, name: str, key: str, parts: list[str], robots: tuple[int, ...]
) -> list[Signal]:
    carriers = record.sensor_robots[key]
    mine = [k for k, robot in enumerate(carriers) if robot in robots]
    if not mine:
        have = ", ".join(str(record.scenario.robots[i].name) for i in carriers[:8])
        raise InputError(f"columns: {name!r}: none of the robots chosen has it; {have} do")
    order = sorted(mine, key=lambda k: robots.index(carriers[k]))
    sensor = record.scenario.robots[carriers[order[0]]].sensor(key)
    whole = Signal(
        key, "", record.sensors[key][:, order], tuple(carriers[k] for k in order),
        bearings=_bearings(sensor, record.sensors[key].shape[2:]),
    )  # fmt: skip
    found = _by_quantity(whole, sensor, name, parts)
    for signal in found:
        if signal.values.ndim > 3 and signal.unit != COLOR_UNIT:
            shape = signal.values.shape[2:]
            raise InputError(
                f"columns: {signal.name!r} has readings of shape {shape}: choose a part of them, "
                f"as '{signal.name}.0'"
            )
    return found


def _bearings(sensor: Sensor | None, shape: tuple[int, ...]) -> Float | None:
    """Return the bearings of a reading's beams, degrees, if they are evenly spaced."""
    angles = np.asarray(getattr(sensor, "angles", ()))
    if angles.ndim != 1 or len(angles) < 2 or angles.shape != shape[:1]:
        return None
    even = np.linspace(angles[0], angles[-1], len(angles))
    return np.degrees(even) if np.allclose(angles, even, atol=1e-9) else None


def _by_quantity(whole: Signal, sensor: Sensor | None, name: str, parts: list[str]) -> list[Signal]:
    """Return a signal for each chosen quantity that a sensor measures.

    parts: an index for each axis of the reading in turn, and a quantity's name at the end.
    """
    quantities = sensor.quantities if sensor is not None else ()
    shape = whole.values.shape[2:]
    several = len(quantities) > 1 and shape[-1:] == (len(quantities),)
    if not parts and shape[-1:] == (3,) and len(shape) < 3 and _is_color(quantities):
        pixels = whole.values.reshape(*whole.values.shape[:2], -1, 3)
        return [replace(whole, unit=COLOR_UNIT, values=pixels)]
    names = [quantity.name for quantity in quantities] if several else []
    signal, wanted = whole, list(range(len(names)))
    for part in parts:
        axes = signal.values.ndim - 2 - bool(names)  # those that are still to be indexed
        size = signal.values.shape[2] if axes else len(names)
        if part in names:
            wanted = [names.index(part)]
        elif not (part.isdecimal() and int(part) < size):
            expected = [f"an index from 0 to {size - 1}"] if size else [f"{signal.name!r} alone"]
            raise InputError(
                f"columns: {name!r}: {part!r}: expected {' or '.join([*expected, *names])}"
            )
        elif axes:
            signal = _indexed(signal, int(part))
        else:
            wanted = [int(part)]
    if not names:
        return [_of_kind(signal, quantities[0])] if len(quantities) == 1 else [signal]
    return [
        replace(
            _of_kind(signal, quantities[k]), name=f"{signal.name} {names[k]}",
            values=signal.values[..., k],
        )
        for k in wanted
    ]  # fmt: skip


def _is_color(quantities: Sequence[Quantity]) -> bool:
    return bool(quantities) and all(quantity.kind == "color" for quantity in quantities)


def _of_kind(signal: Signal, quantity: Quantity) -> Signal:
    """Return a signal with the unit of a quantity, and drawn as its kind requires."""
    kind = quantity.kind
    return replace(signal, unit=quantity.unit, nearest=kind == "distance", wraps=kind == "angle")


def _indexed(signal: Signal, index: int) -> Signal:
    """Return one entry of a reading's first axis, for example one beam."""
    bearing = "" if signal.bearings is None else f" ({signal.bearings[index]:.4g}°)"
    return replace(
        signal, name=f"{signal.name}.{index}{bearing}", values=signal.values[:, :, index],
        bearings=None,
    )  # fmt: skip
