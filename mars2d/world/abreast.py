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
        drives = [robot.drive for now in simulations for robot in now.scenario.robots]
        if drives != self._known:
            still = np.hstack([now.command for now in simulations])
            named = {str(i): drive for i, drive in enumerate(drives)}
            self._drives = Drives(named, worlds[0].sampling_time, worlds[0].stream, still)
            self._known = drives
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
