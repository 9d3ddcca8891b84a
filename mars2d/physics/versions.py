"""The versions of the software that the numbers of a run depend on."""

from __future__ import annotations

import platform

import numpy as np

from mars2d.physics.kernel import reason_without

__all__ = ["versions"]


def versions() -> dict[str, str]:
    """Return the versions of what a run's numbers depend on."""
    from importlib.metadata import version

    from mars2d import __version__

    return {
        "mars2d": __version__,
        "kernel": "no" if reason_without() else "yes",
        "pymunk": version("pymunk"),
        "numpy": np.__version__,
        "python": platform.python_version(),
        "platform": f"{platform.system()} {platform.machine()}",
    }
