"""Draw by how much the theory of each pursuit game misses with real bodies, docs/pictures/*_bodies.png.

python docs/make_pursuit.py [NAME ...]

Each game is run from the same seeds with contact, stop and ideal, and with drives that are weaker and
weaker. A dot is a run: what was measured, less what the formula says of its start. The bars are means
with their 95 % intervals, by Student's t. It takes about five minutes.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from scipy import stats

import mars2d
from mars2d import Record
from mars2d.scenario.experiment import open_experiment

PICTURES = Path(__file__).parent / "pictures"
SEEDS = 10
COLORS = {"contact": "#d55e00", "stop": "#0072b2", "ideal": "#707070"}

Options = dict[str, Any]


def capture(record: Record) -> float:
    """Return when the evader was caught, s; nan if it was not."""
    return next(iter(record.scenario.addons)).outcome(record).capture_time  # type: ignore[attr-defined]


def nearest(record: Record) -> float:
    """Return the least distance between the last robot and another one, m."""
    path = record.pose[:, :2]
    return float(np.hypot(*(path[:, :, :-1] - path[:, :, -1:]).transpose(1, 0, 2)).min())


def passing(record: Record) -> float:
    """Return the distance at the first pass, m."""
    apart = np.hypot(*np.diff(record.pose[:, :2], axis=2)[..., 0].T)
    grows = np.flatnonzero((np.diff(apart) > 0) & (apart[:-1] < 1.0))
    return float(apart[grows[0]] if len(grows) else apart[-1])


class Study(NamedTuple):
    """A game: the options of all runs, those of each panel by its title, and what is measured."""

    options: Options
    panels: dict[str, Options]
    measure: Callable[[Record], float]
    label: str


STUDIES = {
    "straight_chase": Study(
        {"pursuer": "chase_pursuers/bearing.py"},
        {"an empty floor": {}, "crates in the way": {"crates": True}},
        capture,
        "capture, later than predicted [s]",
    ),
    "homicidal_chauffeur": Study(
        {"stop_time": 20},
        {"any force": {}, "1 m/s$^2$": {"accel": 1.0}, "0.6 m/s$^2$": {"accel": 0.6}},
        passing,
        "first pass, farther than predicted [m]",
    ),
    "two_cars": Study(
        {"stop_time": 30},
        {"any force": {}, "1.5 m/s$^2$": {"accel": 1.5}, "0.7 m/s$^2$": {"accel": 0.7}},
        passing,
        "first pass, farther than predicted [m]",
    ),
    "lion_and_man": Study(
        {},
        {"any force": {}, "1 m/s$^2$": {"accel": 1.0}, "0.3 m/s$^2$": {"accel": 0.3}},
        capture,
        "meal, later than predicted [s]",
    ),
    "encirclement": Study(
        {"ratio": 0.8},
        {"any force": {}, "1 m/s$^2$": {"accel": 1.0}, "0.3 m/s$^2$": {"accel": 0.3}},
        nearest,
        "nearest, farther than predicted [m]",
    ),
}


def misses(name: str, study: Study, extra: Options) -> dict[str, list[float]]:
    """Return measured less predicted, by physics, a number for each seed."""
    found: dict[str, list[float]] = {physics: [] for physics in COLORS}
    for seed in range(SEEDS):
        plain = open_experiment(name, study.options | {"seed": seed, "physics": "ideal"})
        predicted = plain.predictions(mars2d.run(plain.scenario, control=plain.control))[
            0
        ].predicted
        for physics, values in found.items():
            options = study.options | extra | {"seed": seed, "physics": physics}
            values.append(study.measure(mars2d.run(name, options=options)) - predicted)
    return found


def draw(name: str, study: Study) -> None:
    """Draw the figure of a game, and print its numbers."""
    figure, axes = plt.subplots(
        1,
        len(study.panels),
        figsize=(2.6 * len(study.panels) + 1.4, 3.4),
        sharey=True,
        squeeze=False,
    )
    for ax, (title, extra) in zip(axes[0], study.panels.items(), strict=True):
        for k, (physics, values) in enumerate(misses(name, study, extra).items()):
            known = np.array([value for value in values if np.isfinite(value)])
            label = (
                f"{physics}\n{len(known)} of {len(values)}" if len(known) < len(values) else physics
            )
            ax.plot([], [])
            if len(known) > 1:
                half = stats.t.ppf(0.975, len(known) - 1) * known.std(ddof=1) / len(known) ** 0.5
                ax.errorbar(
                    k, known.mean(), half, fmt="_", ms=22, mew=2, capsize=5, color=COLORS[physics]
                )
                print(
                    f"{name}, {title}, {physics}: {known.mean():.3f} ± {half:.3f}, {len(known)} runs"
                )
            spread = np.linspace(-0.18, 0.18, len(known))
            ax.plot(k + spread, known, "o", ms=3.5, alpha=0.5, color=COLORS[physics], mec="none")
            ax.text(k, -0.02, label, transform=ax.get_xaxis_transform(), ha="center", va="top")
        ax.axhline(0, color="#7b3294", lw=1.5, zorder=0)
        ax.set(title=title, xlim=(-0.6, 2.6), xticks=[])
        ax.spines[["top", "right"]].set_visible(False)
    axes[0][0].set_ylabel(study.label)
    figure.tight_layout(rect=(0, 0.06, 1, 1))
    figure.savefig(PICTURES / f"{name}_bodies.png", dpi=110)
    plt.close(figure)


if __name__ == "__main__":
    for each in sys.argv[1:] or STUDIES:
        draw(each, STUDIES[each])
