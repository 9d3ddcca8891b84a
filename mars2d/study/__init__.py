"""Many runs: sweeps over settings and seeds, and tournaments between laws."""

from __future__ import annotations

__all__ = ["ONE_THREAD"]

ONE_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""The environment of a process whose linear algebra (numpy) is to use one thread."""
