"""Runs in a window or without one, and what several verbs print."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from mars2d.core.errors import InputError
from mars2d.core.progress import progress
from mars2d.core.terminal import tell, warn
from mars2d.output.raster import require_pygame
from mars2d.scenario.examples import courses, title_of
from mars2d.scenario.experiment import Experiment
from mars2d.window.screen.display import display_available
from mars2d.world.loop import simulate
from mars2d.world.world import Watcher, World

if TYPE_CHECKING:
    from mars2d.output.formats.mcap import Log


def opens_window(wanted: bool) -> bool:
    """Return whether a window is wanted and can be opened; warn if it can't be."""
    if wanted and not display_available():
        warn("there is no display, so this runs without a window")
        return False
    return wanted


def require_display(otherwise: str) -> None:
    """Raise InputError where no window can be opened; otherwise: what there is to say."""
    if not display_available():
        require_pygame("a window")
        raise InputError(otherwise)


def run_headless(
    experiment: Experiment,
    watchers: Sequence[Watcher] = (),
    log: Log | None = None,
    speed: float | str = "max",
) -> World:
    """Run to the end without a window, with a progress bar, and return the world."""
    last = experiment.scenario.last_iteration
    with progress(last, "step") as update:
        return simulate(experiment, speed, [*watchers, lambda at: update(at.iteration)], log)


def print_table(title: str, lines: Mapping[str, str]) -> None:
    """Print names and their descriptions in two columns."""
    tell(f"{title}:")
    width = max((len(name) for name in lines), default=0)
    for name, line in lines.items():
        tell(f"  {name:<{width}}  {line}")


def print_examples() -> None:
    """Print the examples and their first lines, by course."""
    for course, names in courses().items():
        print_table(course, {name: title_of(name)[1] for name in names})
