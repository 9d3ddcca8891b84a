"""Worlds abreast: many of one experiment do their control steps together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from mars2d.bodies.drives.base import Drive
from mars2d.bodies.team import Drives
from mars2d.world.world import World


class Abreast:
    """Steps worlds whose drives are asked together, as numpy is quick for many robots at once.

    Each moves as it would alone, to the bit. Where a drive has noise, ramps or a delay, and so
    remembers, each world asks its own.
    """

    def __init__(self) -> None:
        self._known: list[Drive] = []

    def step(self, worlds: Sequence[World], commands: Sequence[Mapping[Any, Any] | None]) -> None:
        """Do one control step in each world under its commands, as `World.step` does.

        commands: None for a world that rests; the others are not over. Raises what that raises,
        when some worlds have not done their whole step.
        """
        simulations = [world.simulation for world in worlds]
        together = all(simulation.drives_at_once for simulation in simulations)
        if not together or len({simulation.command.shape for simulation in simulations}) > 1:
            for world, command in zip(worlds, commands, strict=True):
                if command is not None:
                    world.step(command)
            return
        self._take([robot.drive for now in simulations for robot in now.scenario.robots], worlds)
        steps = zip(simulations, commands, strict=True)
        wanted = np.hstack(
            [now.command if given is None else now.decide(given) for now, given in steps]
        )
        limited = self._drives.limit(wanted, wanted)  # whatever was before, as they have no ramps
        twists = self._drives.twist(limited)
        n = len(worlds[0].robots)
        for k, (simulation, given) in enumerate(zip(simulations, commands, strict=True)):
            if given is not None:
                mine = slice(k * n, (k + 1) * n)
                simulation.carry_out(limited[:, mine].copy(), twists[:, mine])

    def _take(self, drives: list[Drive], worlds: Sequence[World]) -> None:
        """Take the drives of the robots of all worlds, unless they are those of the last step."""
        if drives != self._known:
            first = worlds[0]
            named = {str(i): drive for i, drive in enumerate(drives)}
            still = np.zeros((first.scenario.inputs, len(drives)))
            self._drives = Drives(named, first.sampling_time, first.stream, still)
            self._known = drives
