"""The charts beside the pictures: numbers over time, and sweeps, compared with theory.

Each function takes the records of its figure's runs. figures.toml has the words.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import pi, sin, sqrt
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.addons import Beacon, Game, Voronoi
from mars2d.core.scene import THEORY
from mars2d.output.figures.figure import GRID, INK, MUTED, new_figure
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.prediction import Prediction
from mars2d.world.loop import simulate
from mars2d.world.record import Record

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

Float = NDArray[np.float64]
Records = Sequence[Record]

MEASURED, BAD = "#0072b2", "#b42318"
"""The colours of measurements, and of a limit."""

OTHERS, MARKS = ("#d55e00", "#0072b2", "#009e73"), "osD"
"""The colours of several measured curves, and their marks."""

FORMULA: dict[str, Any] = {"color": THEORY, "linestyle": "--", "linewidth": 1.8}
"""How theory is drawn."""

ROWS = 200
"""The number of points of a curve over time if each needs a Voronoi diagram."""


class Study(NamedTuple):
    """A chart, the numbers in it, those in its caption, and predictions about them."""

    drawing: Figure
    columns: dict[str, Any]
    says: dict[str, float]
    predictions: tuple[Prediction, ...] = ()


def charts(count: int = 1, height: float = 3.0) -> tuple[Figure, list[Axes]]:
    """Return a figure of several charts side by side, and their axes; height: inches."""
    figure = new_figure(7.6, height)
    axes = figure.subplots(1, count, squeeze=False).ravel().tolist()
    for ax in axes:
        ax.grid(visible=True, color=GRID, linewidth=0.6)
        ax.set_axisbelow(True)
        ax.tick_params(which="both", length=0, labelsize=9, labelcolor=MUTED)
        ax.spines[:].set(color="#c3cad2", linewidth=0.8)
        ax.spines[["top", "right"]].set_visible(False)
    return figure, axes


def curve(ax: Axes, x: Any, y: Any, label: str | None = None, **style: Any) -> None:
    """Draw measured values."""
    look: dict[str, Any] = {"color": MEASURED, "linewidth": 1.8, "label": label}
    ax.plot(x, y, **look | style)


def points(ax: Axes, x: Any, y: Any, mark: str, color: str, **style: Any) -> None:
    """Draw measured values that are not joined."""
    look: dict[str, Any] = {"color": color, "markersize": 4.5, "markeredgewidth": 0}
    ax.plot(x, y, mark, **look | style)


def name(ax: Axes, title: str, y: str, x: str = "time [s]") -> None:
    """Give a chart its title, labels of its axes, and a legend in a line above it."""
    ax.set_xlabel(x, color=INK, fontsize=10)
    ax.set_ylabel(y, color=INK, fontsize=10)
    ax.set_title(title, loc="left", fontsize=11, color=INK, pad=24)
    handles, labels = ax.get_legend_handles_labels()
    if handles:
        legend = ax.legend(
            handles, labels, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=len(labels),
            frameon=False, fontsize=8.5, labelcolor=INK, borderaxespad=0.2, handlelength=1.8,
            columnspacing=1.0, handletextpad=0.4, borderpad=0.0,
        )  # fmt: skip
        legend.set_in_layout(False)


def logarithmic(axis: Axis) -> None:
    """Make an axis logarithmic, labelled with plain numbers 1, 2 and 5 times powers of ten."""
    from matplotlib.ticker import LogLocator, NullLocator

    axis.axes.set(**{"xscale" if axis is axis.axes.xaxis else "yscale": "log"})
    low, high = axis.get_view_interval()
    axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 200 * low else (1,), numticks=12))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter("{x:g}")


def run(experiment: str, seed: int, **options: Any) -> Record:
    """Return the record of an example with other options."""
    return simulate(open_experiment(experiment, options, seed=seed)).record


def some_rows(record: Record) -> list[int]:
    """Return evenly spread rows of a record, including the first and the last."""
    rows: list[int] = np.unique(np.linspace(0, len(record) - 1, ROWS).round().astype(int)).tolist()
    return rows


def addon(record: Record, kind: type) -> Any:
    """Return the scenario's add-on of a class."""
    return next(each for each in record.scenario.addons if isinstance(each, kind))


def lengths(vectors: Float) -> Float:
    """Return the lengths (T, ...) of vectors (T, 2, ...)."""
    return np.asarray(np.hypot(vectors[:, 0], vectors[:, 1]))


# -- pursuit ---------------------------------------------------------------------------------------

RATIOS = np.array([0.8, 0.9, 0.94, 0.945, 0.95, 0.955, 0.96, 0.98, 1.0, 1.1])
STARTS = ((-2.0, 2.0, 0.0), (0.0, 0.0, 0.0), (3.0, -3.0, 0.0))
"""The pursuer's speed over the evader's, and its initial poses: metres and radians."""


def speed_ratio(records: Records) -> Study:
    """Sweep the ratio of the two speeds; plot the least distance and the time of capture."""
    scenario, seed = records[0].scenario, records[0].seed
    pursuer, evader = scenario.robots
    side = 2 * abs(float(evader.pose[0]))  # between two corner points
    speed: float = vars(evader.drive)["max_linear_speed"]
    lap = int(4 * side / speed / scenario.sampling_time)

    def least(ratio: Float) -> Float:
        lead = np.sqrt(1 - ratio**2) * ((1 - ratio) / (1 + ratio)) ** (ratio / 2)
        return np.asarray(lead * side)

    near, time = np.empty((2, len(RATIOS), len(STARTS)))
    for i, ratio in enumerate(RATIOS.tolist()):
        for j, start in enumerate(STARTS):
            record = run("pursuit_corners", seed, **{"mu": ratio, "robots.0.pose": start})
            near[i, j] = lengths(np.diff(record.pose[-lap:, :2])[..., 0]).min()
            time[i, j] = record.time[-1]
    free = time >= scenario.stop_time
    last, first = RATIOS[free.all(axis=1)].max(), RATIOS[~free.any(axis=1)].min()
    fine = np.linspace(0.8, 1.0, 20_001)[:-1]
    begins = float(fine[least(fine) > pursuer.diameter][-1])

    figure, (left, right) = charts(2)
    left.plot(fine, least(fine), label="theory", **FORMULA)
    left.axhline(pursuer.diameter, color=BAD, linewidth=1, label="touch")
    points(left, RATIOS, near, "o", MEASURED)
    points(left, [], [], "o", MEASURED, label="measured")
    left.set_ylim(0, None)
    name(left, "Least distance in a round", "[m]", "pursuer's speed / evader's")
    for j, (mark, color, (x, y, _)) in enumerate(zip(MARKS, OTHERS, STARTS, strict=True)):
        ends, escaped = time[:, j], free[:, j]
        label, edge = f"from ({x:g}, {y:g})", {"markeredgecolor": color, "markeredgewidth": 1}
        points(right, RATIOS[~escaped], ends[~escaped], mark, color, label=label)
        points(right, RATIOS[escaped], ends[escaped], mark, "white", **edge)
    right.axvline(begins, **FORMULA)
    right.set_ylim(0, 1.08 * scenario.stop_time)
    right.set_xlim(left.get_xlim())
    name(right, "Time of capture; hollow: escaped", "[s]", "pursuer's speed / evader's")
    columns = {"ratio": RATIOS}
    columns |= {f"least_distance_{j} [m]": near[:, j] for j in range(len(STARTS))}
    columns |= {f"end_{j} [s]": time[:, j] for j in range(len(STARTS))}
    caught = Prediction("ratio from which it is caught", begins, (last + first) / 2, 0.01)
    return Study(figure, columns, {"last": last, "first": first}, (caught,))


def cell_area(records: Records) -> Study:
    """Plot the area of the evader's cell, and the distance between pursuer and evader."""
    (record,) = records
    game, voronoi, rows = addon(record, Game), addon(record, Voronoi), some_rows(record)
    (hunter, *_), (prey, *_) = game.teams(record.scenario)
    area = np.array([voronoi.of(record.frame(row)).areas[prey] for row in rows])
    distance = lengths(record.pose[rows, :2, hunter] - record.pose[rows, :2, prey])
    time = record.time[rows]
    figure, (left, right) = charts(2)
    for ax, values in ((left, area), (right, distance)):
        curve(ax, time, values)
        ax.set_ylim(0, None)
    name(left, "Area of the evader's cell", "[m²]")
    name(right, "Distance of the two", "[m]")
    columns = {"time [s]": time, "area [m^2]": area, "distance [m]": distance}
    return Study(figure, columns, {"first": area[0], "last": area[-1]})


# -- coverage --------------------------------------------------------------------------------------


def _costs(record: Record) -> tuple[Float, Float, Float]:
    """Return times [s], the cost H [m^4], and the largest distance to a robot's centroid [m]."""
    voronoi, rows = addon(record, Voronoi), some_rows(record)
    cells = [voronoi.of(record.frame(row)) for row in rows]
    off = [np.hypot(*(each.centroids - each.points)).max() for each in cells]
    return record.time[rows], np.array([each.cost for each in cells]), np.array(off)


def cost(records: Records) -> Study:
    """Plot the cost H of a coverage, and the largest distance of a robot from its centroid."""
    (record,) = records
    time, values, off = _costs(record)
    xmin, xmax, ymin, ymax = record.scenario.bounds
    count, area = len(record.scenario.robots), (xmax - xmin) * (ymax - ymin)
    at_60 = values[np.searchsorted(time, min(60, time[-1]))]
    figure, (left, right) = charts(2)
    curve(left, time, values, "measured")
    left.axhline(5 * area**2 / (18 * sqrt(3) * count), label="hexagons", **FORMULA)
    curve(right, time, off)
    logarithmic(left.yaxis)
    logarithmic(right.yaxis)
    name(left, "Cost H", "[m⁴]")
    name(right, "Furthest from its centroid", "[m]")
    columns = {"time [s]": time, "H [m^4]": values, "off [m]": off}
    return Study(figure, columns, {"at_60": at_60, "last": values[-1], "count": count})


def two_ends(records: Records) -> Study:
    """Plot the costs of two runs of the same law, and the distance between the runs."""
    (time, of_a, _), (_, of_b, _) = map(_costs, records)
    first, second = (record.pose[some_rows(record), :2] for record in records)
    apart = lengths(second - first).max(axis=1)
    figure, (left, right) = charts(2)
    curve(left, time, of_a, "A")
    curve(left, time, of_b, "B", color=OTHERS[0])
    name(left, "Cost H", "[m⁴]")
    curve(right, time, apart)
    right.set_ylim(0, None)
    name(right, "Furthest from where it is in the other run", "[m]")
    columns = {"time [s]": time, "H of A [m^4]": of_a, "H of B [m^4]": of_b, "apart [m]": apart}
    return Study(figure, columns, {"first": apart[0], "last": apart[-1]})


# -- cyclic pursuit, and circling ------------------------------------------------------------------

GAINS = {0.05: (3, 4, 6), 0.1: (3, 4, 6, 8, 10), 0.2: (3, 4, 6, 8, 10)}
"""Numbers of robots, by the gain k_a [1/s]."""

SHARES = (0.9, 1.0, 1.1)
"""The ratio of the gains, in units of that at which robots circle."""


def _middle_distance(record: Record) -> Float:
    """Return the mean distance from the middle of the team, (T,) metres."""
    off = record.pose[:, :2] - record.pose[:, :2].mean(axis=2, keepdims=True)
    return np.asarray(lengths(off).mean(axis=1))


def radius(records: Records) -> Study:
    """Compare the radius with the formula for several teams and gains."""
    speed, seed = float(records[0].command[-1, 0, 0]), records[0].seed
    columns: dict[str, list[float]] = {
        "robots": [n for teams in GAINS.values() for n in teams],
        "gain [1/s]": [gain for gain, teams in GAINS.items() for _ in teams],
        "predicted [m]": [],
        "measured [m]": [],
    }
    predictions = []
    for n, gain in zip(columns["robots"], columns["gain [1/s]"], strict=True):
        stop = 500.0 * max(1.0, (n / 6) ** 2 * 0.1 / gain)  # large circles take longer
        record = run("cyclic_pursuit", seed, n=n, gain=gain, stop_time=stop)
        expected, found = n * speed / (pi * gain), float(_middle_distance(record)[-1])
        columns["predicted [m]"].append(expected)
        columns["measured [m]"].append(found)
        what = f"radius, n = {n}, k_a = {gain:g}/s"
        predictions.append(Prediction.within(what, expected, found, 1, "m"))

    figure, (left, right) = charts(2)
    robots, gains, predicted, measured = map(np.array, columns.values())
    ends = [predicted.min(), predicted.max()]
    left.plot(ends, ends, label="n v / (π k_a)", **FORMULA)
    for gain, mark, color in zip(GAINS, MARKS, OTHERS, strict=True):
        x, y = predicted[gains == gain], measured[gains == gain]
        points(left, x, y, mark, color, markersize=5, label=f"{gain:g}/s")
        points(right, robots[gains == gain], 1e6 * (y / x - 1), mark, color, markersize=5)
    logarithmic(left.xaxis)
    logarithmic(left.yaxis)
    right.axhline(0, **FORMULA)
    name(left, "Radius", "measured [m]", "predicted [m]")
    name(right, "Off the prediction", "[millionths]", "robots")
    return Study(figure, columns, {"runs": len(predictions)}, tuple(predictions))


def growth(records: Records) -> Study:
    """Plot how a team shrinks, circles or grows, depending on the ratio of its two gains."""
    count, seed = len(records[0].scenario.robots), records[0].seed
    limit = 2 * count / pi * sin(pi / count)
    figure, (ax,) = charts(height=2.6)
    columns: dict[str, Any] = {}
    grown = []
    for share, color in zip(SHARES, OTHERS, strict=True):
        options = {"ratio": share * limit, "speed": 9.0, "stop_time": 300.0, "sampling_time": 0.05}
        record = run("cyclic_pursuit", seed, **options)
        time, size = record.time, _middle_distance(record)
        curve(ax, time, size, f"{share:g} of the limit", color=color)
        columns |= {"time [s]": time[::30], f"{share:g} of the limit [m]": size[::30]}
        grown.append(float(size[-1] / size[np.searchsorted(time, 150)]))
    logarithmic(ax.yaxis)
    name(ax, "Mean distance from the middle", "[m]")
    predictions = (
        Prediction("size at 300 s / at 150 s, at the limit", 1.0, grown[1], 0.01),
        Prediction("below it: 1 for growing", 1.0, np.sign(grown[0] - 1), 0),
        Prediction("above it: -1 for shrinking", -1.0, np.sign(grown[2] - 1), 0),
    )
    return Study(figure, columns, {"limit": limit}, predictions)


def radius_and_gaps(records: Records) -> Study:
    """Plot the robots' distances from the beacon, and the gaps between them as seen from it."""
    (record,) = records
    beacon, time, rows = addon(record, Beacon), record.time, some_rows(record)
    lamp = np.array([beacon.where(moment) for moment in time.tolist()])  # (T, 2)
    off = record.pose[:, :2] - lamp[:, :, None]
    away = lengths(off)
    angles = np.sort(np.degrees(np.arctan2(off[:, 1], off[:, 0])), axis=1)
    gaps = np.diff(angles, axis=1, append=angles[:, :1] + 360)
    formulas = {p.name: p.predicted for p in open_experiment("circular_motion").predictions(record)}

    figure, (left, right) = charts(2)
    curve(left, time, away, linewidth=1.0, alpha=0.8)
    curve(left, [], [], "each robot")
    if "radius" in formulas:
        left.axhline(formulas["radius"], label="theory", **FORMULA)
    left.set_ylim(0, None)
    name(left, "Distance from the beacon", "[m]")
    curve(right, time, gaps.max(axis=1), "largest", color=OTHERS[0], linewidth=1.5)
    curve(right, time, gaps.min(axis=1), "smallest", color=OTHERS[2], linewidth=1.5)
    right.axhline(360 / away.shape[1], label="theory", **FORMULA)
    right.set_yticks(range(0, 361, 90))
    right.set_ylim(0, 360)
    name(right, "Gaps as seen from the beacon", "[degrees]")
    columns = {
        "time [s]": time,
        "nearest [m]": away.min(axis=1),
        "farthest [m]": away.max(axis=1),
        "smallest gap [degrees]": gaps.min(axis=1),
        "largest gap [degrees]": gaps.max(axis=1),
    }
    _, near, far, least, most = (values[-1] for values in columns.values())
    says = {"near": near, "far": far, "least": least, "most": most}
    return Study(figure, {title: values[rows] for title, values in columns.items()}, says)
