"""Densities: the weight of each place of the workspace."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.base import Addon
from mars2d.core import checks
from mars2d.core.description import entry
from mars2d.core.errors import InputError
from mars2d.core.interfaces import WorldLike
from mars2d.core.picture import Bounds
from mars2d.core.plane import Outline, bounds_of, rectangle
from mars2d.core.scene import Scene, color, rgb
from mars2d.core.usercode import called
from mars2d.geometry.voronoi import Weight, density_at

Float = NDArray[np.float64]

RASTER = 200
"""The number of points along the workspace's longer side, for checks and pictures."""

OPACITY = 0.5
"""The opacity of the densest place in pictures."""


class Density(Addon, Weight):
    """The weight of each place: a function phi(x, y) >= 0.

    >>> hill = Density(lambda x, y: 1 / (1 + x * x + y * y))
    >>> hill.of([[0, 2], [0, 0]]).tolist()
    [1.0, 0.2]

    A Voronoi in the same scenario weighs its cells by it. The function gets arrays x and y of
    coordinates [m], and returns an array as long. In a picture denser places are darker.
    """

    function: Callable[[Float, Float], Any] = entry(
        check=lambda name, value: checks.function(name, value, "x [m]", "y [m]"),
        kw_only=False,
        doc="phi(x, y) >= 0 of arrays [m]",
    )
    color: str = entry(
        default="#3f4a5a", check=color, doc="its colour where it is dense, for pictures only"
    )

    def of(self, points: Any) -> Float:
        """Return the density (k,) at points (2, k) [m].

        Raises InputError where the function returns negative or infinite values, or another shape.
        """

        def phi(x: Float, y: Float) -> Any:
            with called("Density.function", self.function):
                return self.function(x, y)

        return density_at("Density.function", phi, np.asarray(points, dtype=float))

    def on_start(self, world: WorldLike) -> None:
        """Evaluate it all over the workspace, so that errors are raised at once."""
        _, _, phi = self._raster(world.scenario.workspace or rectangle(*world.scenario.bounds))
        if not phi.any():
            raise InputError("Density.function: it is 0 everywhere in the workspace")

    def _raster(self, area: Outline) -> tuple[Bounds, NDArray[np.bool_], Float]:
        """Return an area's bounds, a mask of the raster's points in it, and the density there."""
        import shapely

        xmin, xmax, ymin, ymax = bounds = bounds_of(area)
        step = max(xmax - xmin, ymax - ymin) / RASTER
        columns, rows = (max(round(side / step), 1) for side in (xmax - xmin, ymax - ymin))
        at_x = xmin + (np.arange(columns) + 0.5) * (xmax - xmin) / columns
        at_y = ymax - (np.arange(rows) + 0.5) * (ymax - ymin) / rows
        x, y = np.meshgrid(at_x, at_y)
        inside = shapely.contains_xy(shapely.Polygon(area), x, y)
        return bounds, inside, self.of([x[inside], y[inside]])

    def paint(self, scene: Scene, area: Outline) -> None:
        """Add it to the floor of an area, the darker the denser."""
        bounds, inside, phi = self._raster(area)
        pixels = np.zeros((*inside.shape, 4), dtype=np.uint8)
        pixels[..., :3] = np.round(255 * np.array(rgb(self.color)))
        pixels[inside, 3] = np.round(255 * OPACITY * phi / max(phi.max(), 1e-300))
        scene.image(pixels, bounds)
