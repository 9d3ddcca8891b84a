"""The loop around `World.step`: run an experiment to its end, without a window."""

from __future__ import annotations

import gc
import time
from collections.abc import Sequence
from contextlib import nullcontext
from typing import TYPE_CHECKING

from mars2d.core.deadline import Deadline, patience
from mars2d.core.errors import InputError, Late, LawError
from mars2d.core.interrupt import give_up, interrupts
from mars2d.record.columns import DiskError
from mars2d.scenario.experiment import Experiment
from mars2d.world.record import Record
from mars2d.world.world import Watcher, World

if TYPE_CHECKING:
    from mars2d.output.formats.mcap import Log


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during a run; `record` is the record until then."""

    def __init__(self, record: Record) -> None:
        super().__init__("interrupted")
        self.record = record


class RealTime:
    """Waits until the wall clock has gone on by the simulated time / factor."""

    def __init__(self, factor: float) -> None:
        """Take the simulated seconds per second, > 0."""
        self._factor = factor
        self._start: float | None = None

    def __call__(self, world: World) -> None:
        """Wait until it is time for the control step of `world`."""
        now = time.monotonic()
        if self._start is None:
            self._start = now - world.time / self._factor
        delay = self._start + world.time / self._factor - now
        if delay > 0:
            time.sleep(delay)


def simulate(
    experiment: Experiment,
    speed: float | str = "max",
    watchers: Sequence[Watcher] = (),
    log: Log | None = None,
) -> World:
    """Run an opened experiment to its end and return the world, which is over.

    speed: simulated seconds per second, > 0, or "max". watchers: called with the world at each
    control step, after its sensors are read: to draw, to count, to wait. log: writes each control
    step to a file when it is done; it is closed at the end in any case. A LawError
    that ends the run carries the record until then as its `record`, and so do a DiskError of the
    log and Interrupted, which Ctrl-C raises.
    """
    every: list[Watcher] = [*watchers]
    if speed != "max":
        every.append(RealTime(float(speed)))
    world: World | None = None
    calls = lambda: (world is None) or world.simulation.calls  # noqa: E731
    deadline = Deadline(patience(), give_up, calls)
    try:
        noted = interrupts(kept=lambda: None if world is None else world.record)
        with noted as check, log or nullcontext(), deadline:
            world = open_world(experiment, every)
            gc.freeze()  # or the longest step would be that in which it looks for garbage in it
            try:
                while not world.over:
                    world.step()
                    if log is not None:
                        log.follow(world)
                    check()
            except KeyboardInterrupt:
                world.break_off("Interrupted by Ctrl-C")
                raise
            except DiskError as error:
                world.break_off(f"Error: {error}")
                error.record = world.record
                raise
            except Late as error:  # between two calls of the user's code
                if not error.why:  # a limit that somebody else has set
                    raise
                late = LawError(f"the user's code {error.why}")
                late.time, late.record = world.time, world.record
                raise late from None
    except KeyboardInterrupt:
        if world is None:
            raise
        raise Interrupted(world.record) from None
    finally:
        gc.unfreeze()
    return world


def open_world(
    experiment: Experiment,
    watchers: Sequence[Watcher] = (),
    record: bool = True,
) -> World:
    """Return the world of an experiment, which calls the watchers at each control step.

    record: see `World`. Raises InputError, which names the file.
    """
    try:
        return World(
            experiment.scenario,
            experiment.control,
            experiment.seed or 0,
            filename=experiment.source.name,
            watch=watch_by(watchers),
            options=experiment.options,
            record=record,
        )
    except InputError as error:
        error.where = error.where or experiment.source.name or None
        raise


def watch_by(watchers: Sequence[Watcher]) -> Watcher | None:
    """Return a function that calls all watchers; None if there are none."""

    def watch(world: World) -> None:
        for watcher in watchers:
            watcher(world)

    return watch if watchers else None
