"""Many runs: sweeps over settings and seeds, and tournaments between laws."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mars2d.study.run import sweep

__all__ = ["ONE_THREAD", "sweep"]

ONE_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""The environment of a process whose linear algebra (numpy) is to use one thread."""


def __getattr__(name: str) -> Any:
    if name != "sweep":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from mars2d.study.run import sweep  # late: processes take a while to import

    return sweep
