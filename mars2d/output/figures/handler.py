"""The entries of matplotlib's legends that are signs of layers."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.legend_handler import HandlerBase
from matplotlib.patches import Polygon
from matplotlib.transforms import Affine2D

from mars2d.core.scene import Image, Text
from mars2d.output.figures.artists import artists, points_per_metre
from mars2d.output.layers.arrows import Sign
from mars2d.output.lines import arrow_outline


class SignHandler(HandlerBase):
    """Draws signs; scale: a factor for their size."""

    def __init__(self, scale: float) -> None:
        """Take the scale."""
        super().__init__()
        self.scale = scale

    def create_artists(self, *given: Any) -> Any:
        """Return a sign's artists, as `HandlerBase` says."""
        _, sign, left, foot, width, height, _, trans = given
        middle = Affine2D().scale(self.scale).translate(width / 2 - left, height / 2 - foot)
        made: list[Any] = [ToScale(sign, self.scale)] if sign.length else []
        for shape in () if sign.length else sign.scene.shapes:
            if not isinstance(shape, Text | Image):  # which no sign has
                made += artists(shape, self.scale, self.scale)
        for artist in made:
            artist.set_transform(middle + trans)
        return made


class ToScale(Polygon):
    """An arrow that is as long as a sign's length is on its axes, however they are laid out."""

    def __init__(self, sign: Sign, scale: float) -> None:
        """Take a sign whose scene is one arrow, and the factor for its size."""
        (self.arrow,) = sign.scene.shapes
        super().__init__(np.zeros((1, 2)), facecolor=self.arrow.fill, linewidth=0.0)  # type: ignore[union-attr]
        self.length, self.scale = sign.length, scale

    def draw(self, renderer: Any) -> None:
        """Draw it at the present scale of the axes."""
        half = points_per_metre(self.axes) * self.length / 2 / self.scale  # type: ignore[arg-type]
        self.set_xy(arrow_outline((-half, 0.0), (half, 0.0), self.arrow.width))  # type: ignore[union-attr]
        super().draw(renderer)
