"""Draw by how much theory misses in each pursuit game with real bodies, docs/pictures/*_bodies.png.

python docs/make/pursuit.py [NAME ...]

Each game is run from the same seeds with contact, stop and ideal, and with drives that are weaker
and weaker. A dot is a run: what was measured, less what the formula says of its start. The bars are
means with their 95 % intervals, by Student's t. It takes some minutes, and draws the boundary of
the homicidal chauffeur as well.
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
from mars2d.scenario.experiment import open_experiment, open_module

PICTURES = Path(__file__).parents[1] / "pictures"
SEEDS = 10
COLORS = {"contact": "#d55e00", "stop": "#0072b2", "ideal": "#707070"}

Options = dict[str, Any]


def capture(record: Record) -> float:
    """Return when the evader was caught, s; nan if it was not."""
    game: Any = record.scenario.addons[0]
    return float(game.outcome(record).capture_time)


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
        {"pursuer": "pursuers/bearing.py"},
        {"an empty floor": {}, "crates in the way": {"crates": True}},
        capture,
        "capture, later than predicted [s]",
    ),
    "homicidal_chauffeur": Study(
        {"stop_time": 30, "reach": 0.2},
        {"any force": {}, "1 m/s$^2$": {"accel": 1.0}, "0.6 m/s$^2$": {"accel": 0.6}},
        passing,
        "first pass, farther than predicted [m]",
    ),
    "two_cars": Study(
        {"stop_time": 30, "radius": 0.5},
        {"any force": {}, "1.5 m/s$^2$": {"accel": 1.5}, "0.7 m/s$^2$": {"accel": 0.7}},
        passing,
        "first pass, farther than predicted [m]",
    ),
    "lion_and_man": Study(
        {"man": "men/edge.py", "start": 1.0},
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
        record = mars2d.run(plain.scenario, control=plain.control)
        if not plain.predictions(record):
            continue  # its laws did not do what the formula takes for granted
        predicted = plain.predictions(record)[0].predicted
        for physics, values in found.items():
            options = study.options | extra | {"seed": seed, "physics": physics}
            values.append(study.measure(mars2d.run(name, options=options)) - predicted)
    return found


def draw(name: str, study: Study) -> None:
    """Draw the figure of a game, and print its numbers."""
    count = len(study.panels)
    figure, axes = plt.subplots(
        1, count, figsize=(2.6 * count + 1.4, 3.4), sharey=True, squeeze=False
    )
    for ax, (title, extra) in zip(axes[0], study.panels.items(), strict=True):
        for k, (physics, values) in enumerate(misses(name, study, extra).items()):
            known, color = np.array([v for v in values if np.isfinite(v)]), COLORS[physics]
            label = physics
            if len(known) < len(values):
                label = f"{physics}\n{len(known)} of {len(values)}"
            if len(known) > 1:
                half = stats.t.ppf(0.975, len(known) - 1) * known.std(ddof=1) / len(known) ** 0.5
                ax.errorbar(k, known.mean(), half, fmt="_", ms=22, mew=2, capsize=5, color=color)
                print(f"{name}, {title}, {physics}: {known.mean():.3f} ± {half:.3f}", len(known))
            spread = np.linspace(-0.18, 0.18, len(known))
            ax.plot(k + spread, known, "o", ms=3.5, alpha=0.5, color=color, mec="none")
            ax.text(k, -0.02, label, transform=ax.get_xaxis_transform(), ha="center", va="top")
        ax.axhline(0, color="#7b3294", lw=1.5, zorder=0)
        ax.set(title=title, xlim=(-0.6, 2.6), xticks=[])
        ax.spines[["top", "right"]].set_visible(False)
    axes[0][0].set_ylabel(study.label)
    figure.tight_layout(rect=(0, 0.06, 1, 1))
    figure.savefig(PICTURES / f"{name}_bodies.png", dpi=110)
    plt.close(figure)


def boundary() -> None:
    """Draw who wins the homicidal chauffeur, over the ratio of speeds and the reach."""
    least = open_module("homicidal_chauffeur").least
    figure, ax = plt.subplots(figsize=(6, 4))
    for ratio in np.arange(0.3, 0.76, 0.05).round(2).tolist():
        for reach in np.arange(0.12, 0.69, 0.04).round(2).tolist():
            options = {"ratio": ratio, "reach": reach, "stop_time": 25}
            caught = np.isfinite(capture(mars2d.run("homicidal_chauffeur", options=options)))
            ax.plot(ratio, reach, "o", ms=5, mfc="#d62728" if caught else "none", mec="#d62728")
    ratios = np.linspace(0.28, 0.77, 100)
    ax.plot(ratios, [least(ratio) for ratio in ratios], color="#7b3294", lw=2)
    ax.set(
        xlabel="ratio of the speeds, pedestrian to car", ylabel="reach [m]",
        title="filled: the car wins; line: Isaacs' formula",
    )  # fmt: skip
    ax.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    figure.savefig(PICTURES / "homicidal_chauffeur_boundary.png", dpi=110)
    plt.close(figure)


if __name__ == "__main__":
    for each in sys.argv[1:] or STUDIES:
        draw(each, STUDIES[each])
    if sys.argv[1:] in ([], ["homicidal_chauffeur"]):
        boundary()
