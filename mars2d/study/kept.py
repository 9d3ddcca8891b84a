"""Kept records: the runs of a study as files, from which they are measured without a run."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mars2d.core.errors import InputError
from mars2d.scenario.experiment import Experiment
from mars2d.study.table import cells_of
from mars2d.world.loop import simulate
from mars2d.world.record import Record, load

NAME_DIGITS = 16
"""How many digits of a hash are the name of a record's file."""


def records_beside(table: Path) -> Path:
    """Return the folder that keeps the records of a study, beside its table."""
    return table.with_name(f"{table.stem}_records")


def kept_as(code: str, options: Mapping[str, Any], seed: int, folder: str | Path) -> Path:
    """Return the file that keeps the record of a run: its name is a hash of all that decides it.

    code: that of the run, see `mars2d.study.job.code_of`.
    """
    decides = (code, sorted(zip(options, cells_of(options), strict=True)), seed)
    return Path(folder, hashlib.sha256(repr(decides).encode()).hexdigest()[:NAME_DIGITS] + ".npz")


def recorded(experiment: Experiment, code: str, folder: str) -> Record:
    """Return the record of a run: the one that is kept in the folder, or that of a run made now.

    folder: where the record is kept from then on; if empty, it is not.
    """
    if not folder:
        return simulate(experiment).record
    file = kept_as(code, experiment.options, experiment.seed or 0, folder)
    if file.is_file():
        try:
            return dataclasses.replace(load(file), scenario=experiment.scenario)
        except InputError:
            file.unlink()  # it is broken: the run is made again
    record = simulate(experiment).record
    record.save(file)
    return record
