"""Versions: the environment on which the numbers of a run may depend, beside its scenario."""

from __future__ import annotations

import platform
from importlib import import_module

import numpy as np

from mars2d.physics.islands import reason_without, version


def versions() -> dict[str, str]:
    """Return the environment on which a run's numbers may depend: software versions, the processor.

    The engine, sensors and add-ons round alike on all; laws may use the sines of a C library.
    """
    from mars2d import __version__

    return {
        "mars2d": __version__,
        "compiled": "no" if reason_without() else "yes",
        "pymunk": version(),
        "numpy": np.__version__,
        "python": platform.python_version(),
        "platform": f"{platform.system()} {platform.machine()}",
        "libc": " ".join(platform.libc_ver()).strip(),
        "processor": _processor(),
    }


def _processor() -> str:
    """Return the processor's features that may change the rounding of a law's sines."""
    try:
        able = import_module("numpy._core._multiarray_umath").__cpu_features__
    except (ImportError, AttributeError):
        return ""
    return " ".join(each for each in ("FMA3", "AVX2", "AVX512F", "ASIMD") if able.get(each))
