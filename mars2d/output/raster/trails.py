"""Growing paths: drawn once, and then extended."""

from __future__ import annotations

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.output.layers.trails import (
    PROP_TRAIL_WIDTH,
    TRAIL_WIDTH,
    prop_trail_colors,
    trail_colors,
)
from mars2d.output.lines import spaced
from mars2d.output.raster.brushes import rgba
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.strokes import hairlines
from mars2d.output.raster.theme import mixed
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]

MIN_GROWTH = 2.0
"""The length by which a path must grow before it is extended, points."""


class Wakes:
    """Draws the solid paths of all bodies on a copy of a picture, and prolongs them there.

    The opacity is worked into the colours, as over paper, since strokes that are drawn piece by
    piece would overlap. still: the picture without paths.
    """

    def __init__(
        self, painter: Painter, scenario: Scenario, camera: Camera, still: pygame.Surface
    ) -> None:
        """Start with no path drawn."""
        self.surface, self._still, self._camera = still.copy(), still, camera
        theme, self._ui = painter.theme, painter.ui
        thick = [(color, TRAIL_WIDTH) for color in trail_colors(scenario)]
        thin = [(color, PROP_TRAIL_WIDTH) for color in prop_trail_colors(scenario)]
        self._looks = [
            (mixed(theme.shade(color), theme.paper, rgba(color)[3] / 255), self._ui * width)
            for color, width in (*thick, *thin)
        ]
        self.drawn = 0
        self._ends = np.empty(0)

    def show(self, frame: Frame) -> None:
        """Show the paths up to a frame: prolong those that are there, or begin anew."""
        rows, k = len(frame.path), self.drawn
        if k and not (k <= rows and np.array_equal(self._ends, _places(frame, [0, k - 1]))):
            self.surface.blit(self._still, (0, 0))
            k = self.drawn = 0
        if rows == k:
            return
        new = self._pixels(_places(frame, slice(k, rows)))  # (m, 2, bodies)
        if k == 0:
            self._pens = new[0].copy()
        cuts: dict[int, list[int]] = {}
        for row, body in frame.leaps:
            if k <= row < rows:
                cuts.setdefault(body, []).append(row - k)
        robots, bodies = len(frame.scenario.robots), new.shape[2]
        for body in (*range(robots, bodies), *range(robots)):
            for j, piece in enumerate(np.split(new[:, :, body], sorted(cuts.get(body, ())))):
                before = piece[:1] if j else self._pens[None, :, body]
                points, (color, width) = np.concatenate([before, piece]), self._looks[body]
                kept = points[spaced(points, MIN_GROWTH * self._ui)]  # long enough to be seen
                hairlines(self.surface, rgba(color)[:3], kept, width)
                self._pens[:, body] = kept[-1]
        self.drawn, self._ends = rows, _places(frame, [0, rows - 1])

    def finish(self, surface: pygame.Surface, frame: Frame) -> None:
        """Draw the loose ends of the paths up to a frame, which `show` has shown, on a surface.

        What was put elsewhere since the last row went no way.
        """
        if not self.drawn:
            return
        here = self._pixels(frame.all_poses[None, :2, : self._pens.shape[1]])[0]
        leaping = {body for row, body in frame.leaps if row == self.drawn}
        for body, (pen, end) in enumerate(zip(self._pens.T, here.T, strict=True)):
            if body not in leaping:
                color, width = self._looks[body]
                pygame.draw.aaline(surface, color, pen.tolist(), end.tolist(), round(width))

    def _pixels(self, places: Float) -> Float:
        """Return pixels of places (m, 2, bodies), metres."""
        c = self._camera
        return np.stack([c.x + c.scale * places[:, 0], c.y - c.scale * places[:, 1]], axis=1)


def _places(frame: Frame, rows: slice | list[int]) -> Float:
    """Return where the bodies were at rows of a frame's path, (m, 2, bodies), metres.

    The paths of props may be unknown.
    """
    paths = [frame.path] + [frame.prop_path] * (len(frame.prop_path) == len(frame.path))
    return np.concatenate([path[rows, :2] for path in paths], axis=2)
