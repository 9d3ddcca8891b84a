"""The paths of all bodies on a picture, and how it looked before, so that one can go back."""

from __future__ import annotations

from time import perf_counter

import pygame

from mars2d.output.layers.trails import (
    PROP_TRAIL_WIDTH,
    TRAIL_WIDTH,
    prop_trail_colors,
    trail_colors,
)
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.trails import Trails
from mars2d.record.frame import Float
from mars2d.scenario.scenario import Scenario

__all__ = ["Wakes"]

EVERY = 256
"""So many rows lie between two pictures that are kept, at first."""

Kept = tuple[pygame.Surface, tuple[Trails, ...]]


class Wakes:
    """Draws paths on a copy of a picture, which it keeps at some rows.

    still: the picture without paths. memory: bytes that kept pictures may take, 0 for none: then
    going back draws the paths from their start.
    """

    def __init__(
        self,
        painter: Painter,
        scenario: Scenario,
        camera: Camera,
        still: pygame.Surface,
        memory: int,
    ) -> None:
        """Start with no path drawn."""
        thin = prop_trail_colors(scenario), PROP_TRAIL_WIDTH
        thick = trail_colors(scenario), TRAIL_WIDTH
        self.surface = still.copy()
        self.trails: tuple[Trails, ...] = (
            Trails(painter, camera, "-", *thin),
            Trails(painter, camera, scenario.animation.wake_style, *thick),
        )
        self._start: Kept = still, tuple(trails.copy() for trails in self.trails)
        self._most = memory // (still.get_pitch() * still.get_height())
        self._every = EVERY
        self._kept: dict[int, Kept] = {}

    def show(self, paths: tuple[Float, Float], until: float = float("inf")) -> bool:
        """Show the paths of props (k, 3, p), which may be empty, and of robots (k, 3, n).

        until: at which time of the clock to stop. Returns whether all is drawn.
        """
        rows = len(paths[1])
        self._begin(paths)
        while self._drawn < rows:
            end = rows
            if self._most:
                end = min(rows, (self._drawn // self._every + 1) * self._every)
            for trails, path in zip(self.trails, paths, strict=True):
                trails.prolong(self.surface, path[:end])
            if self._most and end % self._every == 0:
                self._keep(end)
            if perf_counter() > until:
                break
        return self._drawn == rows

    @property
    def _drawn(self) -> int:
        return self.trails[1].drawn

    def _begin(self, paths: tuple[Float, Float]) -> None:
        """Go on from what is there, or from what was kept, whichever is nearest."""
        rows, here = len(paths[1]), -1
        if _continues(self.trails, paths):
            here = self._drawn
        for row in sorted((row for row in self._kept if here < row <= rows), reverse=True):
            if _continues(self._kept[row][1], paths):
                self._take(self._kept[row])
                return
            del self._kept[row]  # of a run that went another way
        if here < 0:
            self._take(self._start)

    def _take(self, kept: Kept) -> None:
        surface, trails = kept
        self.surface.blit(surface, (0, 0))
        self.trails = tuple(each.copy() for each in trails)

    def _keep(self, row: int) -> None:
        self._kept[row] = self.surface.copy(), tuple(trails.copy() for trails in self.trails)
        while len(self._kept) > self._most:
            self._every *= 2
            self._kept = {k: kept for k, kept in self._kept.items() if k % self._every == 0}


def _continues(trails: tuple[Trails, ...], paths: tuple[Float, Float]) -> bool:
    return all(each.continues(path) for each, path in zip(trails, paths, strict=True))
