"""How the time and the memory of a control step grow with the number of robots.

    python benchmarks/growth.py [--json OUT.json] [--figure OUT.png] [--sizes N ...] [--time S]

Teams of unicycles at constant density (5 % of the area covered, one obstacle for fifty robots),
with a law and recording, at a sampling time of 0.1 s and both settings of the suite; and by default
among half as many crates again, as densely as in P1. Each team runs in a process of its own. The
exponent is that of the power of n that fits best. The memory is by how much the process grows in
the second half of the control steps, when nothing else is built any more; from 1000 robots on, as
below that it grows by other things.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import statistics
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scenes import Scene, among_crates, team
from worlds import SETTINGS, deepest, world_of

from mars2d.output.figures.style import GRID, INK, MUTED

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DT = 0.1
SIZES = (10, 30, 100, 300, 1000, 3000, 5000, 10_000)
WARM_UP = 30
LEAST = 30
"""Control steps, before and while it is timed."""

MEASURABLE = 1000
"""So many robots at least, for the memory that they take to be told from other things."""

EXPONENT = {"default": 1.05, "loose": 1.05, "crates": 1.1}
"""The power of n with which time may grow, at most."""

COLOURS = {"default": "#0b69a3", "loose": "#b45309", "crates": "#2e7d32"}
LABELS = {"default": "under 1 mm", "loose": "under 20 mm", "crates": "with crates"}
NUMBERS = 8 * (3 + 2 + 1 + 3)
"""What a robot takes in a row of the record, bytes; a crate takes 48."""


def measure(n: int, setting: str, least_time: float) -> dict[str, Any]:
    """Build a team and step it; return seconds of both, and bytes that a robot-step takes."""
    scene, max_overlap = scene_of(n, setting)
    start = time.perf_counter()
    world = world_of(scene, max_overlap)
    build = time.perf_counter() - start
    for _ in range(WARM_UP):
        world.step()
    ticks, memory = timed(world.step, least_time)
    record = world.record
    contacts = record.contacts.nbytes / (len(record) * n)
    row = {
        "n": n,
        "setting": setting,
        "build_s": build,
        "tick_s": statistics.median(ticks),
        "real_time": DT / statistics.median(ticks),
        "deepest_mm": 1e3 * deepest(scene, np.concatenate([record.pose, record.prop_pose], axis=2)),
        "bytes_needed": NUMBERS + (64 + 48 * len(scene.crates)) / n + contacts,
        "bytes_of_contacts": contacts,
    }
    half = len(ticks) // 2
    if n >= MEASURABLE and memory[-1] > memory[half]:
        row["bytes_measured"] = (memory[-1] - memory[half]) / ((len(ticks) - 1 - half) * n)
    return row


def scene_of(n: int, setting: str) -> tuple[Scene, float]:
    """Return a team's scene and the overlap that is allowed, metres."""
    if setting == "crates":
        return among_crates(n, DT), SETTINGS["default"]
    return team(n, DT), SETTINGS[setting]


def timed(step: Callable[[], None], least_time: float) -> tuple[list[float], list[int]]:
    """Return how long each of some steps takes, and how much memory is held after it."""
    ticks: list[float] = []
    memory: list[int] = []
    end = time.perf_counter() + least_time
    while len(ticks) < LEAST or time.perf_counter() < end:
        start = time.perf_counter()
        step()
        ticks.append(time.perf_counter() - start)
        memory.append(resident())
    return ticks, memory


def resident() -> int:
    """Return how much memory this process holds, bytes; 0 where the system does not say."""
    try:
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    except OSError:
        return 0
    import resource

    return pages * resource.getpagesize()


def exponent(rows: Sequence[dict[str, Any]]) -> float:
    """Return the power of n that the time of a control step grows with."""
    n, tick = ([row[name] for row in rows] for name in ("n", "tick_s"))
    return float(np.polyfit(np.log(n), np.log(tick), 1)[0])


def draw(rows: Sequence[dict[str, Any]], path: Path) -> None:
    """Draw time and memory against the number of robots, as a PNG of few colours."""
    from io import BytesIO

    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from PIL import Image

    figure = Figure(figsize=(11, 4.2), facecolor="white", layout="tight")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, width_ratios=(1.35, 1))
    draw_time(left, rows)
    draw_memory(right, rows)
    png = BytesIO()
    figure.savefig(png, format="png", dpi=110)
    Image.open(png).convert("RGB").quantize(128).save(path, optimize=True)


def draw_time(ax: Axes, rows: Sequence[dict[str, Any]]) -> None:
    """Draw the time of a control step on logarithmic axes, and the goals."""
    dress(ax, "A control step, sampling time 0.1 s", "milliseconds")
    for setting, colour in COLOURS.items():
        mine = [row for row in rows if row["setting"] == setting]
        n, tick = [row["n"] for row in mine], [1e3 * row["tick_s"] for row in mine]
        name = f"{LABELS[setting]}: n to the power {exponent(mine):.2f}"
        ax.plot(n, tick, "o-", color=colour, linewidth=2, markersize=6, label=name, zorder=3)
    ends = np.array([min(row["n"] for row in rows), max(row["n"] for row in rows)])
    first = min(1e3 * row["tick_s"] for row in rows if row["n"] == ends[0])
    power, dashes = max(EXPONENT.values()), (0, (4, 3))
    guide = first * (ends / ends[0]) ** power
    ax.plot(ends, guide, color=MUTED, linewidth=1, linestyle=dashes, label=f"power {power}")
    ax.axhline(1e3 * DT, color=MUTED, linewidth=1)
    ax.text(ends[0], 0.87e3 * DT, "quicker than real time", color=MUTED, fontsize=9, va="top")
    ax.set_yscale("log")
    ax.yaxis.set_major_formatter("{x:g}")
    ax.legend(loc="lower right", frameon=False, fontsize=9.5, labelcolor=INK)


def draw_memory(ax: Axes, rows: Sequence[dict[str, Any]]) -> None:
    """Draw what a robot adds to the record in a control step, measured and needed."""
    dress(ax, "Memory of a robot and control step", "bytes")
    for setting, colour in COLOURS.items():
        mine = [row for row in rows if row["setting"] == setting]
        needed = [row["bytes_needed"] for row in mine]
        ax.plot(
            [row["n"] for row in mine], needed, color=colour, linewidth=2,
            label=f"columns and contacts, {setting}",
        )  # fmt: skip
        seen = [row for row in mine if "bytes_measured" in row]
        ax.plot(
            [row["n"] for row in seen], [row["bytes_measured"] for row in seen], "o", color=colour,
            markersize=6, label=f"growth of the process, {setting}",
        )  # fmt: skip
    ax.axhline(NUMBERS, color=MUTED, linewidth=1)
    ax.text(
        min(row["n"] for row in rows), NUMBERS - 2, "pose 24, command 16, effort 8, velocity 24",
        color=MUTED, fontsize=9, va="top",
    )  # fmt: skip
    ax.set_ylim(0, 1.9 * ax.get_ylim()[1])
    ax.legend(loc="upper right", frameon=False, fontsize=9.5, labelcolor=INK)


def dress(ax: Axes, title: str, unit: str) -> None:
    """Set title, labels and grid as in the figures of records."""
    ax.set_title(title, loc="left", fontsize=11, color=INK, pad=8)
    ax.set_xscale("log")
    ax.xaxis.set_major_formatter("{x:,.0f}")
    ax.grid(visible=True, color=GRID, linewidth=0.6)
    ax.set_axisbelow(True)
    ax.tick_params(which="both", length=0, labelsize=9, labelcolor=MUTED)
    ax.spines[:].set(color="#c3cad2", linewidth=0.8)
    ax.spines[["top", "right"]].set_visible(False)
    ax.set_xlabel("robots", color=INK, fontsize=10)
    ax.set_ylabel(unit, color=INK, fontsize=10)


def main() -> None:
    """Measure, print a table, and write the figures and the chart where they are asked for."""
    parser = argparse.ArgumentParser(description="How a control step grows with the team.")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    parser.add_argument("--figure", type=Path, metavar="OUT.png", help="draw the chart")
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES, help="robots in a team")
    parser.add_argument("--time", type=float, default=6.0, help="seconds for each, at least")
    arguments = parser.parse_args()
    print("robots  setting    build    control step  x real time  deepest   bytes a robot-step")
    rows = []
    for setting in COLOURS:
        for n in arguments.sizes:
            row = alone(n, setting, arguments.time)
            rows.append(row)
            print(as_line(row), flush=True)
    powers = {
        setting: exponent([r for r in rows if r["setting"] == setting]) for setting in COLOURS
    }
    for setting, power in powers.items():
        goal = f"the goal is {EXPONENT[setting]:g} at most"
        print(f"{setting}: time grows with n to the power {power:.2f}; {goal}")
    if arguments.json is not None:
        result = {"sampling_time": DT, "exponents": powers, "rows": rows}
        arguments.json.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    if arguments.figure is not None:
        draw(rows, arguments.figure)


def alone(n: int, setting: str, least_time: float) -> dict[str, Any]:
    """Measure in a process of its own, so that nothing else takes memory."""
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(max_workers=1, mp_context=spawn) as pool:
        return pool.submit(measure, n, setting, least_time).result()


def as_line(row: dict[str, Any]) -> str:
    """Return a row as a line of the table."""
    measured = f", {row['bytes_measured']:.0f} measured" if "bytes_measured" in row else ""
    return (
        f"{row['n']:>6,}  {row['setting']:<8}{row['build_s']:>6.2f} s"
        f"{1e3 * row['tick_s']:>13.2f} ms{row['real_time']:>13.1f}{row['deepest_mm']:>6.2f} mm"
        f"{row['bytes_needed']:>7.0f} needed{measured}"
    )


if __name__ == "__main__":
    main()
