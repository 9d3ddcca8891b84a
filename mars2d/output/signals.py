"""Signals: columns of a record by name, such as x, speed, force, command.v, range_finder.90."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.description import wrong
from mars2d.core.errors import InputError, nearest
from mars2d.core.quantity import Quantity
from mars2d.output.formats.columns import POSE_UNITS
from mars2d.record.contact import net_forces
from mars2d.record.energy import WORK
from mars2d.record.interventions import leaps_of

if TYPE_CHECKING:
    from mars2d.record.rows import Rows
    from mars2d.sensors import Sensor

Float = NDArray[np.float64]
Index = NDArray[np.intp]

SPEED = "speed"

HEADS = (
    *POSE_UNITS, SPEED, "command", "effort", "force", "impulse", "energy", "kinetic", "momentum",
    "distance",
)  # fmt: skip
"""The first words of columns that each record has."""

DRIVE_UNIT = "unit of the drive"
"""The unit of commands if drives state none, or different ones."""

NOTHING = 1e-9
"""Curves of less than this share of the largest one are not drawn."""

MAX_NUMBERS = 12
"""The most numbers of one kind in a reading that are drawn as curves."""


@dataclass(frozen=True, eq=False)
class Signal:
    """A column over time.

    values: (T, k), one column for each of the `bodies`; (T, k, m) for readings of several numbers.
    held: "post" if a value holds until the next row, "pre" if it has
    held since the row before, "" if it belongs to an instant.
    """

    name: str
    unit: str
    values: NDArray[Any]
    bodies: tuple[int, ...]
    held: str = ""
    wraps: bool = False
    """Whether the values are angles, which jump from pi to -pi."""
    curves: tuple[str, ...] = ()
    """The names of the curves, where the values are of no single bodies."""


def signals(
    record: Rows, names: Sequence[str | Sequence[str]], robots: Sequence[str | int] | None
) -> list[Signal]:
    """Return the signals of some column names; a command gives two, one for each part.

    robots: names or indices; None: all. Raises InputError for an unknown column or robot, and for
    readings with too many axes to draw, of which a part must be chosen.
    """
    which = chosen_robots(record, robots)
    props = range(len(record.scenario.robots), len(record.scenario.bodies))
    return [
        signal
        for given in names
        for name in (given if isinstance(given, (list, tuple)) else [given])
        for signal in _named(record, name, (*which, *props) if name == "kinetic" else which)
    ]


def signals_of_bodies(record: Rows, name: str, bodies: Sequence[int]) -> list[Signal]:
    """Return the signals of a column name, of robots and props alike.

    bodies: indices of `Scenario.bodies`; what is of all bodies together does not depend on them.
    Raises InputError as `signals` does, and where none of the bodies has such a column.
    """
    return _named(record, name, tuple(bodies))


def chosen_robots(record: Rows, robots: Sequence[str | int] | None) -> tuple[int, ...]:
    """Return the indices of robots by name or index, all for None, each once."""
    scenario = record.scenario
    if robots is None:
        return tuple(range(len(scenario.robots)))
    given = [robots] if isinstance(robots, (str, int)) else list(robots)
    if not given:
        raise wrong("robots", robots, "names or indices of robots, such as ['ann', 0]")
    found = []
    for robot in given:
        if isinstance(robot, bool) or not isinstance(robot, (str, int, np.integer)):
            raise wrong("robots", robot, "the name of a robot or its index")
        found.append(scenario.index_of("robots", robot))
    return tuple(dict.fromkeys(found))


def known_columns(record: Rows) -> list[str]:
    """Return the names of all columns, without their parts."""
    names = [name for name in HEADS if name != "distance"] + ["momentum.each"]
    names += [f"distance.{body.name}" for body in record.scenario.bodies]
    names += record.sensors
    if record.scenario.props:
        names += [f"prop.{part}" for part in (*POSE_UNITS, SPEED)]
    return names


WITH_PARTS = ("command", "distance", "momentum")
"""Columns that may be followed by the name of a part."""


def _named(record: Rows, name: object, bodies: tuple[int, ...]) -> list[Signal]:
    if not isinstance(name, str):
        raise wrong("columns", name, "names of columns, such as 'x' or 'effort'")
    name = name.strip()
    head, _, part = name.partition(".")
    if head == "prop" and name in known_columns(record):
        props = range(len(record.scenario.robots), len(record.scenario.bodies))
        return [_of_poses(record, name, part, props)]
    key = head.removeprefix("sensor:")  # as `Record.columns` calls them
    if head not in HEADS and key in record.sensors:
        return _readings(record, name, key, part.split(".") if part else [], bodies)
    if head not in HEADS:
        known = nearest(name, known_columns(record), most=30)
        raise InputError(f"columns: there is no {name!r}{known}")
    each = head == "momentum" and part == "each"
    if part and (head not in WITH_PARTS or (head == "momentum" and not each)):
        raise InputError(f"columns: {name!r}: {head} has no parts; expected {head!r}")
    columns = list(bodies)
    if head in (*POSE_UNITS, SPEED):
        return [_of_poses(record, head, head, bodies)]
    if head == "command":
        return _command(record, name, part, _those_that_drive(record, name, bodies))
    if head == "effort":
        robots = _those_that_drive(record, name, bodies)
        return [Signal("effort", "", record.effort[:, list(robots)], robots, "pre")]
    if head in ("force", "impulse"):  # in the control step before
        net = net_forces(record.pair_forces, bodies, range(len(record)))
        force = np.hypot(net[:, 0], net[:, 1])
        if head == "force":
            return [Signal("contact force", "N", force, bodies, "pre")]
        impulse = force * record.scenario.sampling_time
        return [Signal("contact impulse", "N s", impulse, bodies, "pre")]
    if head == "distance":
        return [_distance(record, name, part, bodies)]
    if head == "energy":
        return [_energy(record)]
    if head == "kinetic":
        return [Signal("kinetic energy", "J", record.energy.kinetic[:, columns], bodies)]
    momentum = record.momentum
    if each:
        own = momentum.linear[:, :, columns]
        return [Signal("own momentum", "N s", np.hypot(own[:, 0], own[:, 1]), bodies)]
    whole, turning = momentum.total, momentum.angular[:, None]
    return [
        Signal("momentum", "N s", whole, (), curves=("x", "y")),
        Signal("angular momentum", "N m s", turning, (), curves=("about the origin",)),
    ]


def _those_that_drive(record: Rows, name: str, bodies: tuple[int, ...]) -> tuple[int, ...]:
    """Return the robots among bodies. Raises InputError if there is none."""
    robots = tuple(body for body in bodies if body < len(record.scenario.robots))
    if not robots:
        raise InputError(f"columns: {name!r} is of robots, not of props")
    return robots


def _of_poses(record: Rows, name: str, what: str, bodies: Sequence[int]) -> Signal:
    """Return a coordinate or the speed of some bodies."""
    pose, bodies = record.all_poses[:, :, list(bodies)], tuple(bodies)
    if what in POSE_UNITS:
        return Signal(name, POSE_UNITS[what], pose[:, list(POSE_UNITS).index(what)], bodies)
    speed = np.full((len(pose), len(bodies)), np.nan)
    step = np.diff(pose[:, :2], axis=0)
    speed[1:] = np.hypot(step[:, 0], step[:, 1]) / record.scenario.sampling_time
    for row, body in leaps_of(record.interventions):
        if body in bodies and row < len(speed):  # it did not drive there
            speed[row, bodies.index(body)] = np.nan
    return Signal(name, "m/s", speed, bodies, "pre")


def _command(record: Rows, name: str, part: str, robots: tuple[int, ...]) -> list[Signal]:
    """Return the commands of robots, or a part of them by its index or quantity."""
    found = {record.scenario.robots[i].drive.inputs for i in robots}
    agreed = found.pop() if len(found) == 1 else ()
    kinds = agreed or [Quantity(str(k), DRIVE_UNIT) for k in range(record.command.shape[1])]
    known = {name: k for k, kind in enumerate(kinds) for name in (str(k), kind.name)}
    if part and part not in known:
        raise InputError(f"columns: {name!r}: command has no {part!r}{nearest(part, known)}")
    return [
        Signal(
            f"command {kinds[k].name}" if agreed else f"command.{k}",
            kinds[k].unit, record.command[:, k, list(robots)], robots, "post",
        )
        for k in ([known[part]] if part else range(len(kinds)))
    ]  # fmt: skip


def _distance(record: Rows, name: str, other: str, bodies: tuple[int, ...]) -> Signal:
    """Return the distances of bodies to another one: of their poses, not of their outlines."""
    names = [str(body.name) for body in record.scenario.bodies]
    if other not in names:
        hint = nearest(f"distance.{other}", [f"distance.{each}" for each in names], most=12)
        raise InputError(f"columns: there is no {name!r}{hint}")
    to = names.index(other)
    bodies = tuple(body for body in bodies if body != to)
    if not bodies:
        raise InputError(f"columns: {name!r}: expected a body other than {other}")
    place = record.all_poses[:, :2]
    apart = place[:, :, list(bodies)] - place[:, :, [to]]
    return Signal(f"distance to {other}", "m", np.hypot(apart[:, 0], apart[:, 1]), bodies)


def _energy(record: Rows) -> Signal:
    """Return the kinetic energy of all bodies, and the work that has made it."""
    energy = record.energy
    values = {"kinetic, of all": energy.total}
    values |= {f"work of {what}": energy.by(what) for what in WORK}
    return Signal("energy", "J", np.stack(list(values.values()), axis=-1), (), curves=tuple(values))


# -- readings of sensors --------------------------------------------------------------------------


def _readings(
    record: Rows, name: str, key: str, parts: list[str], robots: tuple[int, ...]
) -> list[Signal]:
    carriers = record.sensor_robots[key]
    mine = [k for k, robot in enumerate(carriers) if robot in robots]
    if not mine:
        have = ", ".join(str(record.scenario.robots[i].name) for i in carriers[:8])
        raise InputError(f"columns: {name!r}: none of the robots chosen has it; {have} do")
    order = sorted(mine, key=lambda k: robots.index(carriers[k]))
    sensor = record.scenario.robots[carriers[order[0]]].sensor(key)
    whole = Signal(key, "", record.sensors[key][:, order], tuple(carriers[k] for k in order))
    found = _by_quantity(whole, sensor, name, parts)
    for signal in found:
        shape = signal.values.shape[2:]
        if len(shape) > 1 or (sum(shape) > MAX_NUMBERS and signal.values.dtype != np.bool_):
            raise InputError(
                f"columns: {signal.name!r} has readings of shape {shape}: choose a part of them, "
                f"as '{signal.name}.0'"
            )
    return found


def _by_quantity(whole: Signal, sensor: Sensor | None, name: str, parts: list[str]) -> list[Signal]:
    """Return a signal for each chosen quantity that a sensor measures.

    parts: an index for each axis of the reading in turn, and a quantity's name at the end.
    """
    quantities = sensor.quantities if sensor is not None else ()
    shape = whole.values.shape[2:]
    several = len(quantities) > 1 and shape[-1:] == (len(quantities),)
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
            values = signal.values[:, :, int(part)]
            signal = replace(signal, name=f"{signal.name}.{int(part)}", values=values)
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


def _of_kind(signal: Signal, quantity: Quantity) -> Signal:
    """Return a signal with the unit of a quantity, and drawn as its kind requires."""
    return replace(signal, unit=quantity.unit, wraps=quantity.kind == "angle")


def without_nothing(signal: Signal) -> Signal:
    """Return a signal of named curves without those that stay about 0, but for the first."""
    if not signal.curves:
        return signal
    size = np.fmax(np.fmax.reduce(signal.values, axis=0, initial=0.0), 0.0)
    size = np.fmax(size, -np.fmin.reduce(signal.values, axis=0, initial=0.0))
    kept = [k for k in range(len(size)) if k == 0 or size[k] > NOTHING * size.max()]
    curves = tuple(signal.curves[k] for k in kept)
    return replace(signal, values=signal.values[:, kept], curves=curves)


# -- thinning of long columns ----------------------------------------------------------------------


def thinned(values: Float, blocks: int) -> Index:
    """Return the indices of the values (T,) to draw so that the curve looks like the whole.

    The values are cut into `blocks` blocks. Each keeps its first and last value, its smallest and
    largest, so that no peak is lost, and its first that is not finite, so that gaps stay.

    >>> thinned(np.array([0.0, 1, 0, 0, 9, 0, 0, 0, -5, 0]), 1).tolist()
    [0, 4, 8, 9]
    """
    count = len(values)
    size = -(-count // blocks)
    if count <= 5 * blocks:
        return np.arange(count)
    whole = count // size * size
    parts = [_kept(values[:whole].reshape(-1, size), 0)]
    if whole < count:
        parts.append(_kept(values[None, whole:], whole))
    return np.unique(np.concatenate(parts))


def _kept(blocks: Float, start: int) -> Index:
    """Return the indices to keep of blocks (k, size), counted from `start`."""
    finite = np.isfinite(blocks)
    kept = [
        np.zeros(len(blocks), dtype=np.intp),
        np.where(finite, blocks, np.inf).argmin(axis=1),
        np.where(finite, blocks, -np.inf).argmax(axis=1),
        finite.argmin(axis=1),
        np.full(len(blocks), blocks.shape[1] - 1),
    ]
    first = start + np.arange(len(blocks)) * blocks.shape[1]
    return np.asarray(np.concatenate([first + each for each in kept]))
