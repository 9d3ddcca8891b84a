"""Scripts written for the Robotarium, run here unchanged."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from mars2d.core.errors import InputError, Mars2dError
from mars2d.core.interrupt import interrupts
from mars2d.record.record import Record
from mars2d.scenario.experiment import open_module
from mars2d.world.loop import Interrupted
from mars2d.world.robotarium import barriers, controllers, graphs, mappings, placement
from mars2d.world.robotarium.arena import Robotarium

UTILITIES = {
    "transformations": mappings,
    "controllers": controllers,
    "graph": graphs,
    "misc": placement,
    "barrier_certificates": barriers,
}
"""The modules of `rps.utilities`, and those that stand for them."""


def run_script(path: Path) -> Record:
    """Run a script, and return the record of its arena, the last one if it makes several.

    The script imports `rps`, which is here for as long as it runs. Raises InputError where it makes
    no arena, and where it fails, and Interrupted at Ctrl-C; their `record` has what was recorded
    until then. Random numbers of numpy's global generator start from seed 0.
    """
    arenas: list[Robotarium] = []
    try:
        noted = interrupts(kept=lambda: arenas[-1].world.record if arenas else None)
        with noted as check, _seeded(), _importable(arenas):
            open_module(path)
            check()
    except KeyboardInterrupt:
        if not arenas:
            raise
        arenas[-1].world.break_off("Interrupted by Ctrl-C")
        raise Interrupted(arenas[-1].world.record) from None
    except Mars2dError as error:
        if arenas:
            arenas[-1].world.break_off(f"Error: {error}")
            error.record = arenas[-1].world.record
        raise
    if not arenas:
        raise InputError(f"{path.name}: makes no Robotarium, as rps.robotarium.Robotarium(...)")
    world = arenas[-1].world
    world.stop("the script has ended")
    return world.record


@contextmanager
def _seeded() -> Iterator[None]:
    """Start numpy's global generator from seed 0; afterwards it goes on as if nothing had been."""
    before = np.random.get_state()
    np.random.seed(0)
    try:
        yield
    finally:
        np.random.set_state(before)


@contextmanager
def _importable(arenas: list[Robotarium]) -> Iterator[None]:
    """Let scripts import `rps`; the arenas that they make are added to a list.

    With the utilities come numpy as `np`, and pyplot as `plt`, which draws where nobody sees it:
    scripts that import all names of `rps.utilities` rely on that. The backend that pyplot had
    before, if one was chosen, it has again afterwards.
    """
    import matplotlib as mpl

    backend = mpl.get_backend(auto_select=False)
    mpl.use("Agg")
    from matplotlib import pyplot as plt

    class Listed(Robotarium):
        def __init__(self, *arguments: Any, **named: Any) -> None:
            super().__init__(*arguments, **named)
            arenas.append(self)

    Listed.__name__ = Listed.__qualname__ = "Robotarium"
    modules = {name: ModuleType(name) for name in ("rps", "rps.robotarium", "rps.utilities")}
    modules["rps.robotarium"].Robotarium = Listed  # type: ignore[attr-defined]
    for name, source in UTILITIES.items():
        module = ModuleType(f"rps.utilities.{name}")
        vars(module).update({each: getattr(source, each) for each in source.__all__}, np=np)
        modules[module.__name__] = module
    modules["rps.utilities.misc"].plt = plt  # type: ignore[attr-defined]
    for name, module in modules.items():
        parent, _, own = name.rpartition(".")
        module.__path__ = []
        if parent:
            setattr(modules[parent], own, module)
    before = {name: sys.modules.get(name) for name in modules}
    sys.modules.update(modules)
    try:
        yield
    finally:
        for name, held in before.items():
            sys.modules.pop(name)
            if held is not None:
                sys.modules[name] = held
        if backend is not None:
            mpl.use(backend)
