"""Traces: the signals of a run that goes on."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import LawError, shown
from mars2d.core.usercode import called, name_of
from mars2d.output.signals import Signal, signals_of_bodies
from mars2d.record.frame import Frame
from mars2d.record.rows import COLUMNS
from mars2d.world.record import Record

Float = NDArray[np.float64]

What = str | Callable[[Any], Any]
"""The name of a column, as `Record.plot_signals` has it, or a function of the record."""

MIN_STEPS, MIN_SECONDS = 100, 5.0
"""Plots over time cover at least this many control steps, and this many seconds."""
FEW = 6
"""The most numbers of a body's reading that are drawn as curves."""


def read(what: What, bodies: tuple[int, ...], record: Record, frame: Frame) -> list[Signal]:
    """Return the signals of a column or a function in all rows of a record, of curves (T, k) each.

    If the frame is the row after the last one, as while a run goes on, it is the last row here.
    bodies: indices of `Scenario.bodies`. Raises InputError for an unknown column, and LawError for
    readings of many numbers, and for an error of the function, whose line it names.
    """
    if not isinstance(what, str):
        return [_own(name_of(what), what, record)] if len(record) else []
    whole = with_present(record, frame)
    found = signals_of_bodies(whole, what, bodies) if len(whole) else []
    for signal in found:
        if signal.values.ndim > 2 and signal.values[0, 0].size > FEW:
            many = signal.values[0, 0].size
            raise LawError(f"{signal.name} has {many} numbers: too many for curves")
    flat = (each.values.reshape(len(each.values), -1).astype(float) for each in found)
    return [replace(each, values=values) for each, values in zip(found, flat, strict=True)]


def with_present(record: Record, frame: Frame) -> Record:
    """Return a record with the row of a frame behind it, if it is the one that comes next.

    What is not known of it yet, such as the command, is as in the row before.
    """
    dt = record.scenario.sampling_time
    if frame.iteration != len(record) or abs(frame.time - len(record) * dt) >= 1e-6 * dt:
        return record
    n, velocity = frame.pose.shape[1], frame.exact_velocity
    known = {
        "time": frame.time, "pose": frame.pose, "prop_pose": frame.prop_pose,
        "effort": frame.effort, "velocity": velocity[:, :n], "prop_velocity": velocity[:, n:],
        "work": frame.work,
    }  # fmt: skip
    columns: Any = {each: _longer(getattr(record, each), known.get(each)) for each in COLUMNS}
    sensors = {}
    for name, values in record.sensors.items():
        sensors[name], read = _longer(values), dict(frame.readings.get(name, ()))
        for k, robot in enumerate(record.sensor_robots[name]):
            sensors[name][-1, k] = read.get(robot, sensors[name][-1, k])
    return replace(record, **columns, sensors=sensors)


def _longer(values: NDArray[Any], last: Any = None) -> NDArray[Any]:
    """Return a column with a last row, or with its own once more; unknown where there is none."""
    if np.shape(last) != values.shape[1:]:
        unknown = np.nan if values.dtype.kind == "f" else 0
        last = values[-1] if len(values) else np.full(values.shape[1:], unknown)
    return np.concatenate([values, np.asarray(last, dtype=values.dtype)[None]])


def _own(name: str, function: Callable[[Any], Any], record: Record) -> Signal:
    """Return the signal of a function of the user's own. Raises LawError, which names its line."""
    with called(name, function):
        made = function(record)
        named = made if isinstance(made, Mapping) else {name: made}
        try:
            curves = [np.asarray(values, dtype=float) for values in named.values()]
        except (TypeError, ValueError):
            curves = []
        if not curves or any(curve.shape != (len(record),) for curve in curves):
            expected = f"a number for each of the {len(record)} rows, or a dict of such arrays"
            raise LawError(f"{name} returned {shown(made)}: expected {expected}")
    return Signal(name, "", np.stack(curves, axis=1), (), curves=tuple(map(str, named)))


def span_of(sampling_time: float) -> float:
    """Return the time that a plot over time covers at least, seconds."""
    return max(MIN_SECONDS, MIN_STEPS * sampling_time)
