"""Collective circular motion: distances from the beacon, and how evenly robots surround it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mars2d.addons import Beacon
from mars2d.core.scene import THEORY
from mars2d.reports.paper.studies.base import (
    MEASURED,
    OTHERS,
    Study,
    addon,
    charts,
    name,
    some_rows,
)
from mars2d.scenario.experiment import open_experiment

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

    from mars2d.world.record import Record


def radius_and_gaps(records: Sequence[Record]) -> Study:
    """Plot the robots' distances from the beacon, and the gaps between them as seen from it."""
    (record,) = records
    beacon = addon(record, Beacon)
    lamp = np.array([beacon.where(moment) for moment in record.time.tolist()])  # (T, 2)
    x, y = (record.pose[:, :2] - lamp[:, :, None]).swapaxes(0, 1)  # (T, n) each
    radius = np.hypot(x, y)
    angles = np.sort(np.degrees(np.arctan2(y, x)), axis=1)
    gaps = np.diff(angles, axis=1, append=angles[:, :1] + 360)
    formulas = {p.name: p.predicted for p in open_experiment("circular_motion").predictions(record)}
    even = 360 / radius.shape[1]

    def draw() -> Drawing:
        figure, (left, right) = charts(2)
        left.plot(record.time, radius, color=MEASURED, linewidth=1.0, alpha=0.8)
        left.plot([], [], color=MEASURED, linewidth=1.8, label="each robot")
        if "radius" in formulas:
            rho = formulas["radius"]
            left.axhline(rho, color=THEORY, linestyle="--", linewidth=1.8, label="theory")
        left.set_ylim(0, None)
        name(left, "Distance from the beacon", "time [s]", "[m]")
        right.plot(record.time, gaps.max(axis=1), color=OTHERS[0], linewidth=1.5, label="largest")
        right.plot(record.time, gaps.min(axis=1), color=OTHERS[2], linewidth=1.5, label="smallest")
        right.axhline(even, color=THEORY, linestyle="--", linewidth=1.8, label="theory")
        right.set_yticks(range(0, 361, 90))
        right.set_ylim(0, 360)
        name(right, "Gaps as seen from the beacon", "time [s]", "[degrees]")
        return figure

    rows = some_rows(record)
    return Study(
        title="Radius and gaps over time",
        shows=f"At the end the robots are {radius[-1].min():.3g} to {radius[-1].max():.3g} m from "
        f"the beacon, with gaps of {gaps[-1].min():.4g} to {gaps[-1].max():.4g} degrees.",
        alt="Two charts over time. The distances from the beacon come to lie on the formula's "
        "line; the largest and the smallest gap between robots become equal.",
        draw=draw,
        columns={
            "time [s]": record.time[rows].tolist(),
            "nearest [m]": radius[rows].min(axis=1).tolist(),
            "farthest [m]": radius[rows].max(axis=1).tolist(),
            "smallest gap [degrees]": gaps[rows].min(axis=1).tolist(),
            "largest gap [degrees]": gaps[rows].max(axis=1).tolist(),
        },
    )
