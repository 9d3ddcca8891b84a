"""Add-ons with an image that lies on the floor."""

from __future__ import annotations

from functools import cached_property

from mars2d.addons.base import Addon
from mars2d.core.description import entry
from mars2d.core.errors import InputError
from mars2d.core.picture import (
    Bounds,
    Picture,
    image_bounds,
    image_file,
    picture_name,
    read_picture,
)
from mars2d.core.scene import Scene


class Pictured(Addon):
    """The base of add-ons with an image, which covers `bounds`, its upper row at ymax."""

    image: str | None = entry(default=None, check=image_file, doc="a PNG file")
    bounds: Bounds | None = entry(
        default=None, check=image_bounds, unit="m",
        doc="the area of the image",
    )  # fmt: skip

    def _validate(self) -> None:
        super()._validate()
        if (self.image is None) != (self.bounds is None):
            problem = "is missing" if self.bounds is None else "is given without an image"
            where = "where the image lies, (xmin, xmax, ymin, ymax) in metres"
            raise InputError(f"{type(self).__name__}.bounds {problem}: {where}")

    @cached_property
    def picture(self) -> Picture:
        """The picture. Raises InputError where its file can't be read."""
        assert self.image is not None
        return read_picture(f"{type(self).__name__}.image", self.image, self._beneath)

    @property
    def _beneath(self) -> str | None:
        """The colour that shows through transparent pixels; None: white."""
        return None

    def paint_absent(self, scene: Scene, bounds: Bounds) -> None:
        """Write into bounds that the image is not there, as it may be for an old record."""
        xmin, xmax, ymin, ymax = bounds
        text = f"{picture_name(str(self.image))} is not there"
        scene.text(((xmin + xmax) / 2, (ymin + ymax) / 2), text)
