"""The camera: converts metres to pixels and back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

Float = NDArray[np.float64]
Margins = tuple[float, float, float, float]
"""Left, top, right, bottom, in pixels."""

NEAREST = 1e6
FARTHEST = 1e-4


@dataclass(frozen=True, slots=True)
class Camera:
    """A uniform scale and a shift; world y points up, pixel y points down.

    scale: pixels a metre. x, y: the pixel at which the world's origin lies.

    >>> camera = Camera(scale=100.0, x=320.0, y=240.0)
    >>> camera.to_pixels([(1, 1)]).tolist()
    [[420.0, 140.0]]
    """

    scale: float
    x: float
    y: float

    @classmethod
    def fit(
        cls,
        bounds: tuple[float, float, float, float],
        size: tuple[int, int],
        margins: Margins = (0.0, 0.0, 0.0, 0.0),
    ) -> Self:
        """Return the camera that shows all of `bounds`, centred, within a surface less its margins.

        bounds: (xmin, xmax, ymin, ymax) in metres. size: (width, height) in pixels.
        """
        xmin, xmax, ymin, ymax = bounds
        left, top, right, bottom = margins
        width = max(size[0] - left - right, 16.0)
        height = max(size[1] - top - bottom, 16.0)
        scale = min(width / max(xmax - xmin, 1e-9), height / max(ymax - ymin, 1e-9))
        scale = min(max(scale, FARTHEST), NEAREST)
        return cls(
            scale=scale,
            x=left + width / 2 - scale * (xmin + xmax) / 2,
            y=top + height / 2 + scale * (ymin + ymax) / 2,
        )

    def to_pixels(self, points: ArrayLike) -> Float:
        """Return the pixels (k, 2) of world points (k, 2)."""
        x, y = np.asarray(points, dtype=float).reshape(-1, 2).T
        # One coordinate after the other in memory: finding the extent is five times as fast.
        return np.array((self.x + self.scale * x, self.y - self.scale * y)).T

    def to_world(self, pixels: ArrayLike) -> Float:
        """Return the world points (k, 2) of pixels (k, 2)."""
        points = np.asarray(pixels, dtype=float).reshape(-1, 2)
        return (points - (self.x, self.y)) / (self.scale, -self.scale)

    def zoomed(self, pixel: tuple[float, float], factor: float) -> Self:
        """Return the camera with its scale times `factor`, the world point at `pixel` staying."""
        scale = min(max(self.scale * factor, FARTHEST), NEAREST)
        factor = scale / self.scale
        return type(self)(
            scale, pixel[0] + factor * (self.x - pixel[0]), pixel[1] + factor * (self.y - pixel[1])
        )

    def panned(self, dx: float, dy: float) -> Self:
        """Return the camera with the picture moved by (dx, dy) pixels."""
        return type(self)(self.scale, self.x + dx, self.y + dy)

    def view(self, size: tuple[int, int]) -> tuple[float, float, float, float]:
        """Return the part of the plane that a surface shows, (xmin, xmax, ymin, ymax) in metres."""
        (xmin, ymax), (xmax, ymin) = self.to_world([(0, 0), size]).tolist()
        return xmin, xmax, ymin, ymax


PIXELS = Camera(1.0, 0.0, 0.0)
"""The camera for scenes in pixels, y upwards: plots, legends, handles."""
