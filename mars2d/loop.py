"""The loop around `World.step`: run an experiment to its end, without a window."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from mars2d.errors import Mars2dError
from mars2d.files import Experiment
from mars2d.pace import RealTime
from mars2d.record import Record
from mars2d.world import World

__all__ = ["Interrupted", "simulate"]

Watcher = Callable[[World], None]


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
) -> Record:
    """Run an opened experiment to its end and return the record.

    speed: simulated seconds per second, > 0, or "max". watchers: called with the world at each
    control step, once its sensors have been read: to draw, to count, to wait. A Mars2dError that
    ends the run carries what was recorded until then as its `record`; Ctrl-C raises Interrupted,
    which does as well.
    """
    every: list[Watcher] = [*watchers]
    if speed != "max":
        every.append(RealTime(float(speed)))

    def pace(world: World) -> None:
        for watcher in every:
            watcher(world)

    world = World(
        experiment.scenario,
        experiment.control,
        seed,
        filename=experiment.filename,
        pace=pace if every else None,
    )
    try:
        while not world.over:
            world.step()
    except Mars2dError as error:
        world.break_off(f"Error: {error}")
        error.record = world.record
        raise
    except KeyboardInterrupt:
        world.break_off("Interrupted by Ctrl-C")
        raise Interrupted(world.record) from None
    return world.record
