"""Is what a part has drawn to be seen?"""

from __future__ import annotations

from typing import Any

import numpy as np

from mars2d.core.scene import Scene
from mars2d.testing.finding import Report

__all__ = ["check_finite", "coordinates"]


def coordinates(shape: Any) -> list[Any]:
    """Return what a shape of a scene is made of, by its slots."""
    return [type(shape).__name__, *(getattr(shape, name) for name in type(shape).__slots__)]


def check_finite(scene: Scene, name: str, when: str, report: Report) -> None:
    """Say if a shape lies nowhere: at nan or infinitely far away."""
    for shape in scene.shapes:
        for value in coordinates(shape):
            if isinstance(value, (float, tuple, np.ndarray)) and not np.isfinite(value).all():
                report.wrong(
                    f"{name} draws a {type(shape).__name__.lower()} with nan or inf in it{when}: "
                    "leave out what is missing, and end at the range what has no end"
                )
                return
