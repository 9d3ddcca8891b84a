"""The loop around `World.step`: run an experiment to its end, without a window."""

from __future__ import annotations

from collections.abc import Callable

from mars2d.errors import Mars2dError
from mars2d.files import Experiment
from mars2d.pace import RealTime
from mars2d.record import Record
from mars2d.world import World

__all__ = ["Interrupted", "simulate"]

Progress = Callable[[World], None]


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during a run; `record` is what was recorded until then."""

    def __init__(self, record: Record) -> None:
        super().__init__("interrupted")
        self.record = record


def simulate(
    experiment: Experiment,
    seed: int = 0,
    speed: float | str = "max",
    progress: Progress | None = None,
) -> Record:
    """Run an opened experiment to its end and return the record.

    speed: simulated seconds per second, > 0, or "max". progress: called with the world after each
    step. A Mars2dError that ends the run carries what was recorded until then as its `record`;
    Ctrl-C raises Interrupted, which does as well.
    """
    pace = None if speed == "max" else RealTime(float(speed))
    world = World(
        experiment.scenario, experiment.control, seed, filename=experiment.filename, pace=pace
    )
    try:
        while not world.over:
            world.step()
            if progress is not None:
                progress(world)
    except Mars2dError as error:
        world.stop(f"Error: {error}")
        error.record = world.record
        raise
    except KeyboardInterrupt:
        world.stop("Interrupted by Ctrl-C")
        raise Interrupted(world.record) from None
    return world.record
