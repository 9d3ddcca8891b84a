"""The loop around `World.step`: run an experiment to its end, without a window."""

from __future__ import annotations

from collections.abc import Sequence

from mars2d.files import Experiment
from mars2d.pace import RealTime
from mars2d.record import Record
from mars2d.world import Watcher, World

__all__ = ["Interrupted", "open_world", "simulate", "watch_by"]


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during a run; `record` is what was recorded until then."""

    def __init__(self, record: Record) -> None:
        super().__init__("interrupted")
        self.record = record


def simulate(
    experiment: Experiment,
    seed: int = 0,
    speed: float | str = "max",
    watchers: Sequence[Watcher] = (),
) -> World:
    """Run an opened experiment to its end and return the world, which is over.

    speed: simulated seconds per second, > 0, or "max". watchers: called with the world at each
    control step, once its sensors have been read: to draw, to count, to wait. A LawError that ends
    the run carries what was recorded until then as its `record`; Ctrl-C raises Interrupted, which
    does as well.
    """
    every: list[Watcher] = [*watchers]
    if speed != "max":
        every.append(RealTime(float(speed)))
    world = open_world(experiment, seed, every)
    try:
        while not world.over:
            world.step()
    except KeyboardInterrupt:
        world.break_off("Interrupted by Ctrl-C")
        raise Interrupted(world.record) from None
    return world


def open_world(experiment: Experiment, seed: int, watchers: Sequence[Watcher] = ()) -> World:
    """Return the world of an experiment, which calls the watchers at each control step."""
    return World(
        experiment.scenario,
        experiment.control,
        seed,
        filename=experiment.filename,
        watch=watch_by(watchers),
    )


def watch_by(watchers: Sequence[Watcher]) -> Watcher | None:
    """Return what calls all watchers at each control step; None if there are none."""

    def watch(world: World) -> None:
        for watcher in watchers:
            watcher(world)

    return watch if watchers else None
