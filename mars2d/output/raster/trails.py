"""Growing paths: drawn once and then extended, with earlier pictures to go back to."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.core.scene import split_wake_style
from mars2d.output.layers.trails import (
    PROP_TRAIL_WIDTH,
    TRAIL_WIDTH,
    prop_trail_colors,
    trail_colors,
)
from mars2d.output.lines import DASHES, MARK_SPACING
from mars2d.output.raster.brushes import rgba
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.strokes import dashes, hair_shifts, hairlines
from mars2d.output.raster.theme import Theme, mixed
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]

MIN_GROWTH = 2.0
"""The length by which a path must grow before it is extended, points."""


class Trails:
    """Draws growing paths on a surface that keeps them, and their loose ends on another.

    style: the wake style. colors: one a robot, with opacity. width: points. The opacity is worked
    into the colour, as over paper, since strokes that are drawn piece by piece would overlap.
    """

    def __init__(
        self, painter: Painter, camera: Camera, style: str, colors: tuple[str, ...], width: float
    ) -> None:
        """Start with no path drawn."""
        self.painter, self.camera, self.width = painter, camera, width
        self.marker, self.line = split_wake_style(style)
        self.colors = [_on_paper(color, painter.theme) for color in colors]
        self.inks = [rgba(color)[:3] for color in self.colors]
        self.drawn = 0
        self.first: Float | None = None
        self.last: Float | None = None

    def continues(self, path: Float) -> bool:
        """Return whether a path (k, 3, n) is, or continues, the path drawn so far."""
        if self.first is None or self.last is None:
            return True
        return (
            len(path) >= self.drawn
            and np.array_equal(path[0, :2], self.first)
            and np.array_equal(path[self.drawn - 1, :2], self.last)
        )

    def prolong(self, surface: pygame.Surface, path: Float, leaping: Sequence[int] = ()) -> None:
        """Draw the new rows of a path (k, 3, n).

        leaping: those that were put elsewhere at the first of these rows.
        """
        if len(path) <= self.drawn:
            return
        if self.first is None:
            self.first = path[0, :2].copy()
            start = self._pixels(self.first[None])
            self.pen = self.tip = start[0]  # (n, 2)
            n = len(self.pen)
            self.pen_along = self.tip_along = np.zeros(n)
            if self.marker:
                for i in range(n):
                    self._mark(surface, self.pen[i : i + 1], i)
        new = self._pixels(path[self.drawn :, :2])  # (m, n, 2)
        # Copies of this object keep the arrays that it had.
        self.pen, self.pen_along, self.tip = self.pen.copy(), self.pen_along.copy(), self.tip.copy()
        self.tip[leaping] = self.pen[leaping] = new[0, leaping]
        self.last = path[-1, :2].copy()
        self.drawn = len(path)
        steps = np.diff(np.concatenate([self.tip[None], new]), axis=0)
        along = self.tip_along + np.cumsum(np.hypot(steps[..., 0], steps[..., 1]), axis=0)
        kept = self._crossings(along, MIN_GROWTH * self.painter.ui)
        marked = self._crossings(along, MARK_SPACING * self.painter.ui) if self.marker else None
        grown = np.nonzero(kept.any(axis=0))[0]
        if self.line == "-" and len(new) == 1:
            self._segments(surface, grown, self.pen[grown], new[0, grown])
        for i in grown.tolist():
            rows = kept[:, i]
            if self.line != "-" or len(new) > 1:
                points = np.concatenate([self.pen[i : i + 1], new[rows, i]])
                self._stroke(surface, points, float(self.pen_along[i]), i)
            self.pen[i], self.pen_along[i] = new[rows, i][-1], along[rows, i][-1]
        if marked is not None:
            for i in np.nonzero(marked.any(axis=0))[0].tolist():
                self._mark(surface, new[marked[:, i], i], i)
        self.tip, self.tip_along = new[-1], along[-1]

    def loose_ends(
        self,
        surface: pygame.Surface,
        position: Float,
        shift: tuple[int, int] = (0, 0),
        leaping: Sequence[int] = (),
    ) -> None:
        """Draw each path from its drawn end to its robot's position, (2, n) metres.

        shift: the offset of the surface that keeps the paths from this one, pixels. leaping: those
        that were put there, and went no way.
        """
        if self.first is None or not self.line:
            return
        here, pen = self._pixels(position[None])[0] + shift, self.pen + shift
        for i in leaping:
            pen[i] = here[i]
        if self.line == "-":
            self._segments(surface, np.arange(len(here)), pen, here)
            return
        for i in range(len(here)):
            points = np.array([pen[i], here[i]])
            self._stroke(surface, points, float(self.pen_along[i]), i)

    def _pixels(self, positions: Float) -> Float:
        """Return (m, n, 2) pixels of (m, 2, n) metres."""
        c = self.camera
        return np.stack([c.x + c.scale * positions[:, 0], c.y - c.scale * positions[:, 1]], axis=-1)

    def _crossings(self, along: Float, stride: float) -> NDArray[np.bool_]:
        """Return a mask (m, n) of lengths along the paths that pass a multiple of `stride`."""
        buckets = np.floor(np.concatenate([self.tip_along[None], along]) / stride)
        return np.diff(buckets, axis=0) > 0

    def _mark(self, surface: pygame.Surface, points: Float, i: int) -> None:
        self.painter.marks(surface, points, self.marker, self.colors[i], self.width)

    def _stroke(self, surface: pygame.Surface, points: Float, start: float, i: int) -> None:
        if not self.line:
            return
        pieces = [points]
        if self.line != "-":
            pattern = tuple(self.painter.ui * length for length in DASHES[self.line])
            pieces = dashes(points, pattern, start)
        for piece in pieces:
            hairlines(surface, self.inks[i], piece, self.width * self.painter.ui)

    def _segments(
        self, surface: pygame.Surface, which: NDArray[np.intp], starts: Float, ends: Float
    ) -> None:
        """Draw one straight piece for each of some robots, from (m, 2) to (m, 2) pixels."""
        steps = ends - starts
        lengths = np.hypot(steps[:, 0], steps[:, 1])
        keep = lengths > 0.05
        if not keep.any():
            return
        starts, ends, steps = starts[keep], ends[keep], steps[keep] / lengths[keep, None]
        normals = np.column_stack([-steps[:, 1], steps[:, 0]])
        inks = [self.inks[i] for i in which[keep].tolist()]
        for shift in hair_shifts(self.width * self.painter.ui, normals):
            a, b = (starts + shift).tolist(), (ends + shift).tolist()
            for ink, start, end in zip(inks, a, b, strict=True):
                pygame.draw.aaline(surface, ink, start, end)


def _on_paper(color: str, theme: Theme) -> str:
    """Return a colour with opacity as it looks on the theme's paper."""
    return mixed(theme.shade(color), theme.paper, rgba(color)[3] / 255)


FIRST_STRIDE = 256
"""The rows between two kept pictures, at first."""

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
        self._start: Kept = still, tuple(map(copy, self.trails))
        self._most = memory // (still.get_pitch() * still.get_height())
        self._every = FIRST_STRIDE
        self._kept: dict[int, Kept] = {}

    def show(self, frame: Frame) -> None:
        """Show the paths of props, which may be unknown, and of robots up to a frame."""
        paths = frame.prop_path, frame.path
        rows, cuts = len(paths[1]), sorted({row for row, _ in frame.leaps})
        self._begin(paths)
        while self._drawn < rows:
            end = rows
            if self._most:
                end = min(rows, (self._drawn // self._every + 1) * self._every)
            end = min([end, *(cut for cut in cuts if cut > self._drawn)])
            leaping = _leaping(frame, self._drawn)
            for trails, path, those in zip(self.trails, paths, leaping, strict=True):
                trails.prolong(self.surface, path[:end], those)
            if self._most and end % self._every == 0:
                self._keep(end)

    def finish(self, surface: pygame.Surface, frame: Frame, shift: tuple[int, int]) -> None:
        """Draw the loose ends of the paths that `show` has drawn up to a frame.

        shift: the offset of the picture from this surface, pixels.
        """
        poses = frame.prop_pose, frame.pose
        leaping = _leaping(frame, self._drawn)
        for trails, pose, those in zip(self.trails, poses, leaping, strict=True):
            trails.loose_ends(surface, pose[:2], shift, those)

    @property
    def _drawn(self) -> int:
        return self.trails[1].drawn

    def _begin(self, paths: tuple[Float, Float]) -> None:
        """Go on from the present picture or from a kept one, whichever is nearest."""
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
        self.trails = tuple(map(copy, trails))

    def _keep(self, row: int) -> None:
        self._kept[row] = self.surface.copy(), tuple(map(copy, self.trails))
        while len(self._kept) > self._most:
            self._every *= 2
            self._kept = {k: kept for k, kept in self._kept.items() if k % self._every == 0}


def _leaping(frame: Frame, row: int) -> tuple[list[int], list[int]]:
    """Return the props and the robots that were put elsewhere at a row."""
    n = len(frame.scenario.robots)
    bodies = [body for leap, body in frame.leaps if leap == row]
    return [body - n for body in bodies if body >= n], [body for body in bodies if body < n]


def _continues(trails: tuple[Trails, ...], paths: tuple[Float, Float]) -> bool:
    return all(each.continues(path) for each, path in zip(trails, paths, strict=True))
