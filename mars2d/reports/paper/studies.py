"""The charts beside the pictures: numbers over time, and sweeps, compared with theory.

Each study takes the records of its figure's runs and draws on its axes; figures.toml has the words.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.resources import as_file, files
from math import pi, sin, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.addons import Beacon, Game, Voronoi
from mars2d.core.scene import THEORY
from mars2d.output.figures.figure import new_figure
from mars2d.reports.paper.figures import Chart
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

OTHERS, MARKS = ("#d55e00", "#0072b2", "#009e73"), "osD"
"""The colours of several measured curves, and their marks; a single one has that of the style."""

FORMULA: dict[str, Any] = {"color": THEORY, "linestyle": "--"}
"""How theory is drawn."""

POINTS = 200
"""The most points of a curve in the numbers, and where each needs a Voronoi diagram."""

Study = tuple[dict[str, float], Sequence[Prediction]]
"""The numbers in a chart's caption, and predictions about it."""


@contextmanager
def drawn(chart: Chart, records: Records) -> Iterator[tuple[Figure, Study]]:
    """Draw a chart; within the block, matplotlib has the style in which to save it."""
    from matplotlib import style

    with as_file(files(__package__) / "charts.mplstyle") as path, style.context(path):
        figure = new_figure(7.6, chart.height)
        axes = figure.subplots(1, len(chart.axes), squeeze=False).ravel().tolist()
        study = globals()[chart.study](records, *axes)
        for ax, words in zip(axes, chart.axes, strict=True):
            ax.set(**{"xlabel": "time [s]"} | words)
            for axis in (ax.xaxis, ax.yaxis):
                if axis.get_scale() == "log":
                    label_plainly(axis)
            if curves := len(ax.get_legend_handles_labels()[1]):
                ax.legend(bbox_to_anchor=(0.0, 1.0), ncols=curves).set_in_layout(False)
        yield figure, study


def curves_of(figure: Figure) -> list[dict[str, Any]]:
    """Return all curves of a figure as data for JSON: title of the axes, label, x and y."""
    found = []
    for ax in figure.axes:
        for line in ax.get_lines():
            x, y = np.asarray(line.get_data(), dtype=float)
            some = some_of(len(x))
            names = {"axes": ax.get_title("left"), "label": f"{line.get_label()}".removeprefix("_")}
            found.append(names | {"x": x[some].tolist(), "y": y[some].tolist()})
    return found


def label_plainly(axis: Axis) -> None:
    """Label a logarithmic axis with plain numbers: 1, 2 and 5 times powers of ten."""
    from matplotlib.ticker import LogLocator, NullLocator

    low, high = axis.get_view_interval()
    axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 200 * low else (1,), numticks=12))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter("{x:g}")


def run(experiment: str, seed: int, **options: Any) -> tuple[Record, Sequence[Prediction]]:
    """Return the record of an example with other options, and what its checks predict."""
    opened = open_experiment(experiment, options, seed=seed)
    record = simulate(opened).record
    return record, opened.predictions(record)


def some_of(count: int) -> list[int]:
    """Return at most `POINTS` of so many indices, evenly spread from the first to the last."""
    chosen = np.linspace(0, count - 1, min(count, POINTS)).round().astype(int)
    return [int(index) for index in chosen]


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


def speed_ratio(records: Records, left: Axes, right: Axes) -> Study:
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
            record, _ = run("pursuit_corners", seed, **{"mu": ratio, "robots.0.pose": start})
            near[i, j] = lengths(np.diff(record.pose[-lap:, :2])[..., 0]).min()
            time[i, j] = record.time[-1]
    free = time >= scenario.stop_time
    last, first = RATIOS[free.all(axis=1)].max(), RATIOS[~free.any(axis=1)].min()
    fine = np.linspace(0.8, 1.0, 20_001)[:-1]
    begins = float(fine[least(fine) > pursuer.diameter][-1])

    left.plot(fine, least(fine), label="theory", **FORMULA)
    left.axhline(pursuer.diameter, color="#b42318", linewidth=1, label="touch")
    for j, (mark, color, (x, y, _)) in enumerate(zip(MARKS, OTHERS, STARTS, strict=True)):
        left.plot(RATIOS, near[:, j], "o", label="_measured" if j else "measured")
        ends, escaped, place = time[:, j], free[:, j], f"from ({x:g}, {y:g})"
        look: dict[str, Any] = {"color": "white", "markeredgecolor": color, "markeredgewidth": 1}
        right.plot(RATIOS[~escaped], ends[~escaped], mark, color=color, label=place)
        right.plot(RATIOS[escaped], ends[escaped], mark, label=f"_{place}, escaped", **look)
    left.set_ylim(0, None)
    right.axvline(begins, **FORMULA)
    right.set_ylim(0, 1.08 * scenario.stop_time)
    right.set_xlim(left.get_xlim())
    caught = Prediction("ratio from which it is caught", begins, (last + first) / 2, 0.01)
    return {"last": last, "first": first}, [caught]


def cell_area(records: Records, left: Axes, right: Axes) -> Study:
    """Plot the area of the evader's cell, and the distance between pursuer and evader."""
    (record,) = records
    game, voronoi, rows = addon(record, Game), addon(record, Voronoi), some_of(len(record))
    (hunter, *_), (prey, *_) = game.teams(record.scenario)
    area = np.array([voronoi.of(record.frame(row)).areas[prey] for row in rows])
    distance = lengths(record.pose[rows, :2, hunter] - record.pose[rows, :2, prey])
    time = record.time[rows]
    for ax, values in ((left, area), (right, distance)):
        ax.plot(time, values)
        ax.set_ylim(0, None)
    return {"first": area[0], "last": area[-1]}, []


# -- coverage --------------------------------------------------------------------------------------


def _costs(record: Record) -> tuple[Float, Float, Float]:
    """Return times [s], the cost H [m^4], and the largest distance to a robot's centroid [m]."""
    voronoi, rows = addon(record, Voronoi), some_of(len(record))
    cells = [voronoi.of(record.frame(row)) for row in rows]
    off = [np.hypot(*(each.centroids - each.points)).max() for each in cells]
    return record.time[rows], np.array([each.cost for each in cells]), np.array(off)


def cost(records: Records, left: Axes, right: Axes) -> Study:
    """Plot the cost H of a coverage, and the largest distance of a robot from its centroid."""
    (record,) = records
    time, values, off = _costs(record)
    xmin, xmax, ymin, ymax = record.scenario.bounds
    count, area = len(record.scenario.robots), (xmax - xmin) * (ymax - ymin)
    at_60 = values[np.searchsorted(time, min(60, time[-1]))]
    left.plot(time, values, label="measured")
    left.axhline(5 * area**2 / (18 * sqrt(3) * count), label="hexagons", **FORMULA)
    right.plot(time, off)
    return {"at_60": at_60, "last": values[-1], "count": count}, []


def two_ends(records: Records, left: Axes, right: Axes) -> Study:
    """Plot the costs of two runs of the same law, and the distance between the runs."""
    (time, of_a, _), (_, of_b, _) = map(_costs, records)
    first, second = (record.pose[some_of(len(record)), :2] for record in records)
    apart = lengths(second - first).max(axis=1)
    left.plot(time, of_a, label="A")
    left.plot(time, of_b, label="B", color=OTHERS[0])
    right.plot(time, apart)
    right.set_ylim(0, None)
    return {"first": apart[0], "last": apart[-1]}, []


# -- cyclic pursuit, and circling ------------------------------------------------------------------

GAINS = {0.05: (3, 4, 6), 0.1: (3, 4, 6, 8, 10), 0.2: (3, 4, 6, 8, 10)}
"""Numbers of robots, by the gain k_a [1/s]."""

SHARES = (0.9, 1.0, 1.1)
"""The ratio of the gains, in units of that at which robots circle."""


def radius(records: Records, left: Axes, right: Axes) -> Study:
    """Compare the radius with the formula for several teams and gains."""
    cases = [(n, gain) for gain, teams in GAINS.items() for n in teams]
    predictions = []
    for n, gain in cases:
        stop = 500.0 * max(1.0, (n / 6) ** 2 * 0.1 / gain)  # large circles take longer
        _, checks = run("cyclic_pursuit", records[0].seed, n=n, gain=gain, stop_time=stop)
        (found,) = (check for check in checks if check.name == "radius")
        predictions.append(found.replace(name=f"radius, n = {n}, k_a = {gain:g}/s"))
    robots, gains = np.array(cases).T
    predicted, measured = np.array([(p.predicted, p.measured) for p in predictions]).T
    ends = [predicted.min(), predicted.max()]
    left.plot(ends, ends, label="n v / (π k_a)", **FORMULA)
    for gain, mark, color in zip(GAINS, MARKS, OTHERS, strict=True):
        x, y = predicted[gains == gain], measured[gains == gain]
        left.plot(x, y, mark, color=color, markersize=5, label=f"{gain:g}/s")
        right.plot(robots[gains == gain], 1e6 * (y / x - 1), mark, color=color, markersize=5)
    right.axhline(0, **FORMULA)
    return {"runs": len(cases)}, predictions


def growth(records: Records, ax: Axes) -> Study:
    """Plot how a team shrinks, circles or grows, depending on the ratio of its two gains."""
    count, seed = len(records[0].scenario.robots), records[0].seed
    limit = 2 * count / pi * sin(pi / count)
    grown = []
    for share, color in zip(SHARES, OTHERS, strict=True):
        options = {"ratio": share * limit, "speed": 9.0, "stop_time": 300.0, "sampling_time": 0.05}
        record, _ = run("cyclic_pursuit", seed, **options)
        off = record.pose[:, :2] - record.pose[:, :2].mean(axis=2, keepdims=True)
        time, size = record.time, lengths(off).mean(axis=1)
        ax.plot(time, size, label=f"{share:g} of the limit", color=color)
        grown.append(float(size[-1] / size[np.searchsorted(time, 150)]))
    predictions = (
        Prediction("size at 300 s / at 150 s, at the limit", 1.0, grown[1], 0.01),
        Prediction("below it: 1 for growing", 1.0, np.sign(grown[0] - 1), 0),
        Prediction("above it: -1 for shrinking", -1.0, np.sign(grown[2] - 1), 0),
    )
    return {"limit": limit}, predictions


def radius_and_gaps(records: Records, left: Axes, right: Axes) -> Study:
    """Plot the robots' distances from the beacon, and the gaps between them as seen from it."""
    (record,) = records
    beacon, time = addon(record, Beacon), record.time
    lamp = np.array([beacon.where(moment) for moment in time.tolist()])  # (T, 2)
    off = record.pose[:, :2] - lamp[:, :, None]
    away = lengths(off)
    angles = np.sort(np.degrees(np.arctan2(off[:, 1], off[:, 0])), axis=1)
    gaps = np.diff(angles, axis=1, append=angles[:, :1] + 360)
    checks = open_experiment("circular_motion").predictions(record)

    left.plot(time, away, linewidth=1.0, alpha=0.8)
    left.plot([], [], label="each robot")
    for radius in (check.predicted for check in checks if check.name == "radius"):
        left.axhline(radius, label="theory", **FORMULA)
    left.set_ylim(0, None)
    least, most = gaps.min(axis=1), gaps.max(axis=1)
    right.plot(time, most, label="largest", color=OTHERS[0], linewidth=1.5)
    right.plot(time, least, label="smallest", color=OTHERS[2], linewidth=1.5)
    right.axhline(360 / away.shape[1], label="theory", **FORMULA)
    right.set_yticks(range(0, 361, 90))
    right.set_ylim(0, 360)
    near, far = away[-1].min(), away[-1].max()
    return {"near": near, "far": far, "least": least[-1], "most": most[-1]}, []
