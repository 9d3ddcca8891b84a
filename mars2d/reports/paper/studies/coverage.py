"""Coverage: the cost over time, and the divergence of two runs of one law."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mars2d.addons import Voronoi
from mars2d.core.errors import counted
from mars2d.core.scene import THEORY
from mars2d.reports.paper.studies.base import (
    MEASURED,
    OTHERS,
    Study,
    addon,
    charts,
    from_zero,
    logarithmic,
    name,
    some_rows,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

    from mars2d.world.record import Record

Float = NDArray[np.float64]


def _costs(record: Record) -> tuple[Float, Float, Float]:
    """Return times [s], the cost H [m^4], and the largest distance to a robot's centroid [m]."""
    voronoi, rows = addon(record, Voronoi), some_rows(record)
    cells = [voronoi.of(record.frame(row)) for row in rows]
    cost = np.array([each.cost for each in cells])
    off = np.array([np.hypot(*(each.centroids - each.points)).max() for each in cells])
    return record.time[rows], cost, off


def coverage_cost(records: Sequence[Record]) -> Study:
    """Plot the cost H of a coverage, and the largest distance of a robot from its centroid."""
    (record,) = records
    time, cost, off = _costs(record)
    xmin, xmax, ymin, ymax = record.scenario.bounds
    count, area = len(record.scenario.robots), (xmax - xmin) * (ymax - ymin)
    hexagons = 5 * area**2 / (18 * sqrt(3) * count)
    at_60 = float(cost[np.searchsorted(time, min(60, time[-1]))])

    def draw() -> Drawing:
        figure, (left, right) = charts(2)
        left.plot(time, cost, color=MEASURED, linewidth=1.8, label="measured")
        left.axhline(hexagons, color=THEORY, linestyle="--", linewidth=1.8, label="hexagons")
        logarithmic(left.yaxis)
        name(left, "Cost H", "time [s]", "[m⁴]")
        right.plot(time, off, color=MEASURED, linewidth=1.8)
        logarithmic(right.yaxis)
        name(right, "Furthest from its centroid", "time [s]", "[m]")
        return figure

    return Study(
        title="Cost over time",
        shows=f"H only falls: it is {at_60:.3g} m⁴ at 60 s and {cost[-1]:.3g} m⁴ at the end. No "
        f"arrangement is better than {counted(count, 'hexagon')} of the same area in all.",
        alt="Two charts over time. The cost H falls, steeply at first, towards that of hexagons; "
        "the distance to the centroids falls to almost nothing.",
        draw=draw,
        columns={"time [s]": time.tolist(), "H [m^4]": cost.tolist(), "off [m]": off.tolist()},
    )


def two_ends(records: Sequence[Record]) -> Study:
    """Plot the costs of two runs of the same law, and the distance between the runs."""
    first, second = records
    (time, cost, _), (_, other, _) = _costs(first), _costs(second)
    rows = some_rows(first)
    apart = np.hypot(*(second.pose[rows, :2] - first.pose[rows, :2]).swapaxes(0, 1)).max(axis=1)

    def draw() -> Drawing:
        figure, (left, right) = charts(2)
        left.plot(time, cost, color=MEASURED, linewidth=1.8, label="A")
        left.plot(time, other, color=OTHERS[0], linewidth=1.8, label="B")
        name(left, "Cost H", "time [s]", "[m⁴]")
        from_zero(right, time, apart, "Furthest from where it is in the other run", "[m]")
        return figure

    return Study(
        title="Two ends of one law",
        shows=f"One start is moved by {apart[0]:.2g} m; at the end a robot is {apart[-1]:.2g} m "
        "from where it is in the other run. H falls in both, to minima of different arrangements.",
        alt="Two charts over time. The cost H of both runs falls; the distance between the runs "
        "grows from a little to much.",
        draw=draw,
        columns={
            "time [s]": time.tolist(),
            "H of A [m^4]": cost.tolist(),
            "H of B [m^4]": other.tolist(),
            "apart [m]": apart.tolist(),
        },
    )
