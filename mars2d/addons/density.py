"""Densities: the weight of each place of the workspace."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.pictured import Pictured
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


class Density(Pictured, Weight):
    """The weight of each place: a function phi(x, y) >= 0, or an image, dark where it is dense.

    >>> hill = Density(lambda x, y: 1 / (1 + x * x + y * y))
    >>> hill.of([[0, 2], [0, 0]]).tolist()
    [1.0, 0.2]

    A Voronoi in the same scenario weighs its cells by it. The function gets arrays x and y of
    coordinates [m], and returns an array as long. An image covers `bounds`, its upper row at ymax:
    black is 1 and white is 0, it is linear between the middles of the pixels, and 0 beyond the
    image. The image is a PNG like that of `Floor`. In a picture denser places are darker.
    """

    function: Callable[[Float, Float], Any] | None = entry(
        default=None,
        check=checks.optional(checks.function, "x [m]", "y [m]"),
        kw_only=False,
        doc="phi(x, y) >= 0 of arrays [m]",
    )
    color: str = entry(
        default="#3f4a5a", check=color, doc="its colour where it is dense, for pictures only"
    )

    def _validate(self) -> None:
        super()._validate()
        if (self.function is None) == (self.image is None):
            raise InputError(
                "Density: expected a function, such as Density(lambda x, y: 1 + x * x), or an "
                "image, such as Density(image='city.png', bounds=(-5, 5, -5, 5))"
            )

    def of(self, points: Any) -> Float:
        """Return the density (k,) at points (2, k) [m].

        Raises InputError where a function returns negative or infinite values, or another shape.
        """
        places = np.asarray(points, dtype=float)
        return self._of_image(*places) if self.function is None else self._of_function(places)

    def _of_function(self, places: Float) -> Float:
        def phi(x: Float, y: Float) -> Any:
            assert self.function is not None
            with called("Density.function", self.function):
                return self.function(x, y)

        return density_at("Density.function", phi, places)

    def _of_image(self, x: Float, y: Float) -> Float:
        assert self.bounds is not None
        xmin, xmax, ymin, ymax = self.bounds
        dark = self._dark
        rows, columns = dark.shape
        across = np.clip((x - xmin) / (xmax - xmin) * columns - 0.5, 0, columns - 1)
        down = np.clip((ymax - y) / (ymax - ymin) * rows - 0.5, 0, rows - 1)
        i, j = down.astype(int), across.astype(int)
        below, right = np.minimum(i + 1, rows - 1), np.minimum(j + 1, columns - 1)
        u, v = across - j, down - i
        upper = dark[i, j] * (1 - u) + dark[i, right] * u
        lower = dark[below, j] * (1 - u) + dark[below, right] * u
        inside = (xmin <= x) & (x <= xmax) & (ymin <= y) & (y <= ymax)
        return np.asarray(np.where(inside, upper * (1 - v) + lower * v, 0.0))

    @cached_property
    def _dark(self) -> Float:
        """The darkness (rows, columns) of the image by Rec. 601 luma: 1 is black, 0 is white."""
        luma = self.picture.pixels @ np.array([299, 587, 114])
        return np.asarray((255_000 - luma) / 255_000)

    def on_start(self, world: WorldLike) -> None:
        """Evaluate it all over the workspace, so that errors are raised at once."""
        _, _, phi = self._raster(world.scenario.workspace or rectangle(*world.scenario.bounds))
        if not phi.any():
            what = "Density.function" if self.image is None else f"Density.image = {self.image!r}"
            raise InputError(f"{what}: it is 0 everywhere in the workspace")

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
        """Add it to the floor of an area, the darker the denser.

        Where the image can't be read any more, for example for an old record, its name is written.
        """
        try:
            bounds, inside, phi = self._raster(area)
        except InputError:
            if self.image is None:
                raise
            self.paint_absent(scene, bounds_of(area))
            return
        pixels = np.zeros((*inside.shape, 4), dtype=np.uint8)
        pixels[..., :3] = np.round(255 * np.array(rgb(self.color)))
        pixels[inside, 3] = np.round(255 * OPACITY * phi / max(phi.max(), 1e-300))
        scene.image(pixels, bounds)
