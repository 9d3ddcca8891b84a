"""Pursuit: the ratio of speeds at which capture begins, and the evader's cell over time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mars2d.addons import Game, Voronoi
from mars2d.core.scene import THEORY
from mars2d.reports.paper.studies.base import (
    BAD,
    MEASURED,
    OTHERS,
    Study,
    addon,
    charts,
    from_zero,
    name,
    run,
    some_rows,
    top_speed,
)
from mars2d.scenario.prediction import Prediction

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

    from mars2d.world.record import Record

Float = NDArray[np.float64]


RATIOS = (0.8, 0.9, 0.94, 0.945, 0.95, 0.955, 0.96, 0.98, 1.0, 1.1)
STARTS = ((-2.0, 2.0, 0.0), (0.0, 0.0, 0.0), (3.0, -3.0, 0.0))
"""Initial poses of the pursuer: metres and radians."""


def speed_ratio(records: Sequence[Record]) -> Study:
    """Sweep the ratio of the two speeds; plot the least distance and the time of capture."""
    side = 2 * abs(float(records[0].scenario.robots[1].pose[0]))  # between two corner points
    touch = records[0].scenario.robots[0].diameter
    stop, speed = records[0].scenario.stop_time, top_speed(records[0], 1)
    lap = int(4 * side / speed / records[0].scenario.sampling_time)

    def least(ratio: Float) -> Float:
        lead = np.sqrt(1 - ratio**2) * ((1 - ratio) / (1 + ratio)) ** (ratio / 2)
        return np.asarray(lead * side)

    near, time = np.empty((2, len(RATIOS), len(STARTS)))
    for i, ratio in enumerate(RATIOS):
        for j, start in enumerate(STARTS):
            record = run("pursuit_corners", {"mu": ratio, "robots.0.pose": start}, records[0].seed)
            apart = np.diff(record.pose[-lap:, :2])[..., 0]
            near[i, j] = np.hypot(apart[:, 0], apart[:, 1]).min()
            time[i, j] = record.time[-1]
    escaped = [ratio for ratio, ends in zip(RATIOS, time, strict=True) if min(ends) >= stop]
    caught = [ratio for ratio, ends in zip(RATIOS, time, strict=True) if max(ends) < stop]
    last, first = max(escaped, default=np.nan), min(caught, default=np.nan)
    fine = np.linspace(0.8, 1.0, 20_001)[:-1]
    begins = float(fine[least(fine) > touch][-1])

    def draw() -> Drawing:
        figure, (left, right) = charts(2)
        left.plot(fine, least(fine), "--", color=THEORY, linewidth=1.8, label="theory")
        left.axhline(touch, color=BAD, linewidth=1, label="touch")
        left.plot(RATIOS, near, "o", color=MEASURED, markersize=4.5, markeredgewidth=0)
        left.plot([], [], "o", color=MEASURED, markersize=4.5, label="measured")
        left.set_ylim(0, None)
        name(left, "Least distance in a round", "pursuer's speed / evader's", "[m]")
        for j, (mark, color) in enumerate(zip("osD", OTHERS, strict=True)):
            kept = time[:, j] < stop
            x, y, _ = STARTS[j]
            right.plot(
                np.array(RATIOS)[kept], time[kept, j], mark, color=color, markersize=4.5,
                markeredgewidth=0, label=f"from ({x:g}, {y:g})",
            )  # fmt: skip
            right.plot(
                np.array(RATIOS)[~kept], time[~kept, j], mark, color="white", markersize=4.5,
                markeredgecolor=color, markeredgewidth=1,
            )  # fmt: skip
        right.axvline(begins, color=THEORY, linestyle="--", linewidth=1.8)
        right.set_ylim(0, 1.08 * stop)
        right.set_xlim(left.get_xlim())
        name(right, "Time of capture; hollow: escaped", "pursuer's speed / evader's", "[s]")
        return figure

    return Study(
        title="Where capture begins",
        shows=f"Up to {last:g} of the evader's speed the pursuer never comes near enough, from "
        f"{first:g} on it always does, wherever it starts. The violet line is the formula's.",
        alt="Two charts over the ratio of the speeds. The least distance falls along the formula's "
        "curve until it is a touch; there capture begins, the sooner the faster the pursuer.",
        draw=draw,
        predictions=(
            Prediction("ratio from which it is caught", begins, (last + first) / 2, 0.01),
        ),
        columns={
            "ratio": RATIOS,
            **{f"least_distance_{j} [m]": near[:, j].tolist() for j in range(len(STARTS))},
            **{f"end_{j} [s]": time[:, j].tolist() for j in range(len(STARTS))},
        },
    )


def cell_area(records: Sequence[Record]) -> Study:
    """Plot the area of the evader's cell, and the distance between pursuer and evader."""
    (record,) = records
    game, voronoi, rows = addon(record, Game), addon(record, Voronoi), some_rows(record)
    (hunter, *_), (prey, *_) = game.teams(record.scenario)
    area = np.array([voronoi.of(record.frame(row)).areas[prey] for row in rows])
    apart = record.pose[rows, :2, hunter] - record.pose[rows, :2, prey]
    distance, time = np.hypot(apart[:, 0], apart[:, 1]), record.time[rows]

    def draw() -> Drawing:
        figure, (left, right) = charts(2)
        from_zero(left, time, area, "Area of the evader's cell", "[m²]")
        from_zero(right, time, distance, "Distance of the two", "[m]")
        return figure

    return Study(
        title="The evader's cell over time",
        shows=f"The cell has {area[0]:.3g} m² at first and {area[-1]:.3g} m² at the end.",
        alt="Two charts over time: the area of the evader's cell, and the distance of the two.",
        draw=draw,
        columns={
            "time [s]": time.tolist(),
            "area [m^2]": area.tolist(),
            "distance [m]": distance.tolist(),
        },
    )
