"""Many runs: sweeps over settings and seeds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mars2d.study.run import sweep

__all__ = ["WORKERS", "sweep"]

WORKERS = {
    "PYTHONSAFEPATH": "1",
    **dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1"),
}
"""The environment of processes that run many: one thread each for numpy's linear algebra, and no
module from the current folder in the place of Python's own."""


def __getattr__(name: str) -> Any:
    if name != "sweep":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from mars2d.study.run import sweep  # late: processes take a while to import

    return sweep
