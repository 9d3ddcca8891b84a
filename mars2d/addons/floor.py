"""Floors with colours: lines to follow, places to find."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.base import Addon, Color
from mars2d.core import checks
from mars2d.core.description import accepts, entry, wrong
from mars2d.core.errors import InputError
from mars2d.core.interfaces import WorldLike
from mars2d.core.picture import Bounds, Pixels, image_bounds, image_file, read_picture
from mars2d.core.plane import Outline, Point, bounds_of, inside_polygon, rectangle
from mars2d.core.scene import Scene, rgb
from mars2d.core.scene import color as checked_color


@accepts({"type": "string"})
def _opaque(name: str, value: object) -> str:
    """Check a colour that lets nothing through."""
    result = checked_color(name, value)
    if len(result) > 7:
        raise wrong(name, value, "a colour without opacity, '#rrggbb' or a name")
    return result


@accepts({"type": "array"})
def _patches(name: str, value: object) -> tuple[tuple[Outline, str], ...]:
    expected = "a list of patches: (outline, colour), such as [([(0, 0), (1, 0), (0, 1)], 'red')]"
    if not isinstance(value, (tuple, list)):
        raise wrong(name, value, expected)
    patches = []
    for i, patch in enumerate(value):
        if not isinstance(patch, (tuple, list)) or len(patch) != 2:
            raise wrong(f"{name}[{i}]", patch, "a patch (outline, colour)")
        outline = checks.outline(f"{name}[{i}][0]", patch[0], least=3)
        patches.append((outline, _opaque(f"{name}[{i}][1]", patch[1])))
    return tuple(patches)


class Floor(Addon):
    """The colours of the floor, for the sensor Ground: one everywhere, an image on it, patches.

    >>> Floor(patches=[([(0, 0), (1, 0), (1, 1)], "black")]).ground((0.9, 0.5))
    (0.0, 0.0, 0.0)

    Of patches that overlap the later one lies on top. The image covers `bounds`, its upper row at
    ymax; a point has the colour of the pixel that it lies in, and where a pixel is transparent
    `color`, or else white, is seen through it. Without a `color` the rest has that of the floors of
    earlier add-ons, or else white. It is no obstacle.

    A relative name of an image is looked for in the current folder; a file beside the experiment is
    ``Path(__file__).with_name("line.png")``. It is read when a world is made, PNG with 8 bits a
    channel and up to 4096 x 4096 pixels.
    """

    image: str | None = entry(default=None, check=image_file, optional=True, doc="a PNG file")
    bounds: Bounds | None = entry(
        default=None, check=image_bounds, optional=True, unit="m",
        doc="the area of the image",
    )  # fmt: skip
    patches: Sequence[tuple[Outline, str]] = entry(
        default=(), check=_patches, unit="m", doc="polygons and their colours: (outline, colour)"
    )
    color: str | None = entry(
        default=None, check=_opaque, optional=True,
        doc="the colour of the rest; None: transparent",
    )  # fmt: skip

    def _validate(self) -> None:
        super()._validate()
        if (self.image is None) != (self.bounds is None):
            problem = "is missing" if self.bounds is None else "is given without an image"
            where = "where the image lies, (xmin, xmax, ymin, ymax) in metres"
            raise InputError(f"{type(self).__name__}.bounds {problem}: {where}")

    @cached_property
    def picture(self) -> Pixels:
        """The pixels (rows, columns, 3). Raises InputError where the file can't be read."""
        assert self.image is not None
        return read_picture(f"{type(self).__name__}.image", self.image, self.color)

    @cached_property
    def _colored(self) -> tuple[tuple[Bounds, NDArray[np.float64], Color], ...]:
        """The patches, from the upper one down: bounds, corners (k, 2), colour."""
        return tuple(
            (bounds_of(outline), np.array(outline), rgb(color))
            for outline, color in reversed(self.patches)
        )

    def ground(self, point: Point) -> Color | None:
        """Return the colour of the floor at a point: red, green and blue from 0 to 1.

        None: neither a patch nor the image lies there, and the rest has no colour.
        """
        x, y = point
        for (xmin, xmax, ymin, ymax), corners, color in self._colored:
            near = xmin <= x <= xmax and ymin <= y <= ymax
            if near and inside_polygon(np.array([x]), np.array([y]), corners)[0]:
                return color
        if self.bounds is not None:
            xmin, xmax, ymin, ymax = self.bounds
            if xmin <= x <= xmax and ymin <= y <= ymax:
                pixels = self.picture
                rows, columns, _ = pixels.shape
                row = min(int((ymax - y) / (ymax - ymin) * rows), rows - 1)
                column = min(int((x - xmin) / (xmax - xmin) * columns), columns - 1)
                red, green, blue = (pixels[row, column] / 255).tolist()
                return red, green, blue
        return None if self.color is None else rgb(self.color)

    def on_start(self, world: WorldLike) -> None:  # noqa: ARG002
        """Read the image, so that its errors are raised at once."""
        if self.image is not None:
            self.picture  # noqa: B018

    def paint(self, scene: Scene, area: Outline) -> None:
        """Paint the floor of an area.

        Where the image can't be read any more, for example for an old record, its name is written.
        """
        if self.color is not None:
            scene.polygon(area, fill=self.color)
        if self.bounds is not None:
            try:
                scene.image(self.picture, self.bounds)
            except InputError:
                scene.polygon(rectangle(*self.bounds), fill="#e6e9ed")
                xmin, xmax, ymin, ymax = self.bounds
                absent = f"{Path(str(self.image)).name} is not there"
                scene.text(((xmin + xmax) / 2, (ymin + ymax) / 2), absent)
        for outline, color in self.patches:
            scene.polygon(outline, fill=color)
