"""Cyclic pursuit: the radius for several teams, and the ratio at which they shrink or grow."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi, sin
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import THEORY
from mars2d.reports.paper.studies.base import OTHERS, Study, charts, logarithmic, name, run
from mars2d.scenario.prediction import Prediction

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

    from mars2d.world.record import Record

Float = NDArray[np.float64]


TEAMS = (
    *((n, 0.05) for n in (3, 4, 6)),
    *((n, 0.1) for n in (3, 4, 6, 8, 10)),
    *((n, 0.2) for n in (3, 4, 6, 8, 10)),
)
"""The number of robots, and the gain k_a [1/s]."""


def _middle_distance(record: Record) -> Float:
    """Return the mean distance from the middle of the team, (T,) metres."""
    off = record.pose[:, :2] - record.pose[:, :2].mean(axis=2, keepdims=True)
    return np.asarray(np.hypot(off[:, 0], off[:, 1]).mean(axis=1))


def cyclic_radius(records: Sequence[Record]) -> Study:
    """Compare the radius with the formula for several teams and gains."""
    speed = float(records[0].command[-1, 0, 0])
    predicted = [n * speed / (pi * gain) for n, gain in TEAMS]
    measured = []
    for n, gain in TEAMS:
        stop = 500.0 * max(1.0, (n / 6) ** 2 * 0.1 / gain)  # large circles take longer
        options = {"n": n, "gain": gain, "stop_time": stop}
        measured.append(
            float(_middle_distance(run("cyclic_pursuit", options, records[0].seed))[-1])
        )

    def draw() -> Drawing:
        figure, (left, right) = charts(2)
        ends = np.array([min(predicted), max(predicted)])
        left.plot(ends, ends, "--", color=THEORY, linewidth=1.8, label="n v / (π k_a)")
        marks = zip((0.05, 0.1, 0.2), "osD", OTHERS, strict=True)
        for gain, mark, color in marks:
            chosen = [k for k, (_, g) in enumerate(TEAMS) if g == gain]
            x, y = np.array(predicted)[chosen], np.array(measured)[chosen]
            style: dict[str, Any] = {
                "color": color,
                "markersize": 5,
                "markeredgewidth": 0,
                "linestyle": "none",
            }
            left.plot(x, y, marker=mark, label=f"{gain:g}/s", **style)
            teams = [TEAMS[k][0] for k in chosen]
            right.plot(teams, 1e6 * (y / x - 1), marker=mark, **style)
        logarithmic(left.xaxis)
        logarithmic(left.yaxis)
        right.axhline(0, color=THEORY, linestyle="--", linewidth=1.8)
        name(left, "Radius", "predicted [m]", "measured [m]")
        name(right, "Off the prediction", "robots", "[millionths]")
        return figure

    return Study(
        title="The radius for several teams and gains",
        shows=f"{len(TEAMS)} runs with 3 to 10 robots and gains of 0.05 to 0.2 1/s.",
        alt="Two charts: the measured radius over the predicted one lies on the diagonal; what it "
        "is off, over the number of robots, is next to nothing.",
        draw=draw,
        predictions=tuple(
            Prediction.within(f"radius, n = {n}, k_a = {gain:g}/s", p, m, 1, "m")
            for (n, gain), p, m in zip(TEAMS, predicted, measured, strict=True)
        ),
        columns={
            "robots": [n for n, _ in TEAMS],
            "gain [1/s]": [gain for _, gain in TEAMS],
            "predicted [m]": predicted,
            "measured [m]": measured,
        },
    )


def cyclic_growth(records: Sequence[Record]) -> Study:
    """Plot how a team shrinks, circles or grows, depending on the ratio of its two gains."""
    count = len(records[0].scenario.robots)
    limit = 2 * count / pi * sin(pi / count)
    shares, curves = (0.9, 1.0, 1.1), []
    for share in shares:
        options = {"ratio": share * limit, "speed": 9.0, "stop_time": 300.0, "sampling_time": 0.05}
        record = run("cyclic_pursuit", options, records[0].seed)
        curves.append(_middle_distance(record))
    time = record.time
    settled = int(np.searchsorted(time, 150))
    growth = [float(curve[-1] / curve[settled]) for curve in curves]

    def draw() -> Drawing:
        figure, (ax,) = charts(1, height=2.6)
        for share, curve, color in zip(shares, curves, OTHERS, strict=True):
            ax.plot(time, curve, color=color, linewidth=1.8, label=f"{share:g} of the limit")
        logarithmic(ax.yaxis)
        name(ax, "Mean distance from the middle", "time [s]", "[m]")
        return figure

    return Study(
        title="Below, at and above the limit",
        shows=f"With k_a / k_r at (2 n / π) sin(π / n) = {limit:.4g} they circle, at a radius that "
        "the start decides; below it they spread, above it they shrink to a point.",
        alt="A chart over time: three curves of the team's size, of which one grows, one stays, "
        "one falls.",
        draw=draw,
        predictions=(
            Prediction("size at 300 s / at 150 s, at the limit", 1.0, growth[1], 0.01),
            Prediction("below it: 1 for growing", 1.0, np.sign(growth[0] - 1), 0),
            Prediction("above it: -1 for shrinking", -1.0, np.sign(growth[2] - 1), 0),
        ),
        columns={
            "time [s]": time[::30].tolist(),
            **{
                f"{share:g} of the limit [m]": curve[::30].tolist()
                for share, curve in zip(shares, curves, strict=True)
            },
        },
    )
