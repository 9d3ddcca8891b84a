"""A fork: an independent simulation that goes on from the present instant of another."""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from typing import Any

from mars2d.core.errors import InputError, one_line
from mars2d.record.recorder import History, Recorder, Unrecorded
from mars2d.world.simulation import Simulation
from mars2d.world.state import FORKING


def forked(simulation: Simulation, *, laws: bool, recorder: Recorder | None = None) -> Simulation:
    """Return a copy of a simulation at this instant; see `WorldView.fork`.

    recorder: has the rows before, and writes those that follow; None: nothing is recorded, and the
    stop time does not end it. Raises InputError, which names the law, add-on or sensor that can't
    be copied.
    """
    memo: dict[Any, Any] = {FORKING: True}
    for old, new in _replaced(simulation, recorder or Unrecorded(simulation.scenario), laws=laws):
        memo[id(old)] = new
    for name, part in _parts_of_users(simulation, laws=laws):
        try:
            deepcopy(part, memo)
        except Exception as error:  # which can be any, of code of the user's
            hint = " or use fork(laws=False)" if name.startswith("the law") else ""
            raise InputError(
                f"world.fork(): {name} can't be copied: {one_line(error)}; give it a "
                f"__deepcopy__{hint}"
            ) from error
    copied = deepcopy(simulation, memo)
    copied.endless = recorder is None
    copied.resume()
    return copied


def _replaced(
    simulation: Simulation, recorder: Recorder, *, laws: bool
) -> Iterator[tuple[object, object]]:
    """Yield the objects that are not copied, and those that take their places."""
    scenario = simulation.scenario
    parts = [sensor for robot in scenario.robots for sensor in robot.sensors]
    drives = [robot.drive for robot in scenario.robots]
    described = (scenario, simulation.declared, *scenario.robots, *drives, *parts)
    for part in (*described, *scenario.addons):  # frozen
        yield part, part
    yield simulation.recorder, recorder
    yield simulation.history, History(recorder)
    yield simulation.engine, simulation.engine.fork()
    yield simulation.operator.log, [*simulation.operator.log]
    if simulation.watch is not None:
        yield simulation.watch, None
    if not laws:
        yield simulation.laws, simulation.laws.silent()


def _parts_of_users(simulation: Simulation, *, laws: bool) -> Iterator[tuple[str, object]]:
    """Yield the places in which the user's code may have stored objects, with their names."""
    for law in simulation.laws if laws else ():
        if law.started:
            raise InputError(
                f"world.fork(): the law {law.name} is a generator, and Python can't copy a "
                "generator that runs: write it as a function that remembers by robot.memory, "
                "or use fork(laws=False)"
            )
        yield f"the law {law.name}", law.function
    for mind in simulation.minds:
        yield f"the memory of {mind.name}", mind.memory
    for key, addon in vars(simulation.addons).items():
        yield f"the add-on {key!r}", addon
    for device in simulation.sensing.devices:
        yield f"the sensor {device.key!r}", device.sensor
