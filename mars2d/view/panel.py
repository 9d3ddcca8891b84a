"""The panel of the selected body: the contact force on it over time."""

from __future__ import annotations

from math import ceil

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.forces import FORCE, SLIP, SLIPPING, in_newtons, round_force
from mars2d.frame import Float, Frame
from mars2d.looks import prop_colors
from mars2d.scene import Scene, faded
from mars2d.view.camera import Camera
from mars2d.view.meter import Bound, Meter, Reading, bound_of, span_of
from mars2d.view.painter import Painter
from mars2d.view.selection import body_name

__all__ = ["Panel"]

WIDTH, HEIGHT = 400.0, 220.0
"""Points; at most a part of the picture."""

LARGEST_SHARE = 0.46
SMALLEST = 200.0, 130.0
"""Points below which it is not drawn."""

OVERSHOOT = 3.0
"""The scale goes up to the highest force, but at most to so many times the bound."""


class Panel:
    """Draws the force on one body, its bound, and the effort of its drive."""

    def __init__(self, painter: Painter) -> None:
        """Start with nothing read; fonts and sprites are the painter's."""
        self.painter = painter
        self._meter = Meter()

    def place(self, plot: pygame.Rect, body: tuple[float, float]) -> pygame.Rect | None:
        """Return where it lies on the picture: in the upper corner that the body leaves free.

        body: pixels. None where the picture is too small for it.
        """
        ui = self.painter.ui
        width = min(WIDTH * ui, LARGEST_SHARE * plot.width)
        height = min(HEIGHT * ui, LARGEST_SHARE * plot.height)
        if width < SMALLEST[0] * ui or height < SMALLEST[1] * ui:
            return None
        gap = round(12 * ui)
        rect = pygame.Rect(0, 0, round(width), round(height))
        rect.topright = (plot.right - gap, plot.top + gap)
        if rect.inflate(60 * ui, 60 * ui).collidepoint(body):
            rect.left = plot.left + gap
        return rect

    def draw(self, surface: pygame.Surface, rect: pygame.Rect, frame: Frame, body: int) -> None:
        """Draw the panel of a body."""
        reading, bound = self._meter.read(frame, body), bound_of(frame, body)
        ui, theme = self.painter.ui, self.painter.theme
        self.painter.panel(surface, rect, faded(theme.plate, 0.95), 8 * ui, theme.edge)
        self._title(surface, rect, frame, body, reading)
        area = pygame.Rect(
            rect.left + round(50 * ui), rect.top + round(62 * ui),
            rect.width - round(64 * ui), rect.height - round(62 * ui) - round(36 * ui),
        )  # fmt: skip
        end = max(frame.time, span_of(frame.scenario.sampling_time))
        start = end - span_of(frame.scenario.sampling_time)
        top = _top(reading.force, bound)
        self._axes(surface, area, start, end, top)
        self._curves(surface, area, frame, reading, bound, (start, end, top))

    def _title(
        self, surface: pygame.Surface, rect: pygame.Rect, frame: Frame, body: int, reading: Reading
    ) -> None:
        """Write whose force it is and how large it is now, and what the lines are."""
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        left, right, y = rect.left + round(14 * ui), rect.right - round(14 * ui), rect.top
        now = float(reading.force[-1]) if len(reading.force) else 0.0
        image = fonts.render(in_newtons(now), 17 * ui, theme.shade(FORCE), bold=True)
        surface.blit(image, image.get_rect(midright=(right, y + round(20 * ui))))
        colors = (*frame.scenario.colors, *prop_colors(frame.scenario.props))
        scene = Scene()
        dot = (left + 6 * ui, -(y + 20 * ui))
        scene.circle(dot, 0.0, fill=theme.shade(colors[body]), stroke=theme.muted, pixels=6.0)
        room = right - image.get_width() - left - 32 * ui
        text = fonts.shorten(
            f"net contact force on {body_name(frame, body)}", 14 * ui, room, bold=True
        )
        image = fonts.render(text, 14 * ui, theme.ink, bold=True)
        surface.blit(image, image.get_rect(midleft=(left + round(20 * ui), y + round(20 * ui))))
        x, y = float(left), y + round(44 * ui)
        entries = [(theme.shade(FORCE), 2.5, "mean force of a step")]
        if reading.effort is not None:
            entries += [(theme.effort, 1.5, "drive's effort"), (SLIP, 10.0, "slips")]
        for color, width, word in entries:
            scene.line([(x, -y), (x + 16 * ui, -y)], stroke=color, width=width)
            image = fonts.render(word, 12 * ui, theme.text)
            surface.blit(image, image.get_rect(midleft=(round(x + 21 * ui), y)))
            x += image.get_width() + 36 * ui
            if x > right - 90 * ui:
                break
        self.painter.paint(surface, scene.shapes, PIXELS, shaded=False)

    def _axes(
        self, surface: pygame.Surface, area: pygame.Rect, start: float, end: float, top: float
    ) -> None:
        """Draw the grid and the numbers of both axes."""
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        step = round_force(top / 2 if area.height < 90 * ui else top / 3)
        for k in range(int(top / step + 1e-9) + 1):
            y = area.bottom - round(k * step / top * area.height)
            surface.fill(theme.grid_axis if k == 0 else theme.grid, (area.left, y, area.width, 1))
            image = fonts.render(f"{k * step:.4g} N", 12 * ui, theme.muted)
            surface.blit(image, image.get_rect(midright=(area.left - round(6 * ui), y)))
        step = round_force((end - start) / (3 if area.width < 220 * ui else 5))
        for k in range(ceil(start / step - 1e-9), int(end / step + 1e-9) + 1):
            x = area.left + round((k * step - start) / (end - start) * area.width)
            surface.fill(theme.grid, (x, area.top, 1, area.height))
            image = fonts.render(f"{k * step:.6g}", 12 * ui, theme.muted)
            surface.blit(image, image.get_rect(midtop=(x, area.bottom + round(3 * ui))))
        image = fonts.render("time [s]", 12 * ui, theme.muted)
        y = area.bottom + round(17 * ui)
        surface.blit(image, image.get_rect(midtop=(area.centerx, y)))

    def _curves(
        self,
        surface: pygame.Surface,
        area: pygame.Rect,
        frame: Frame,
        reading: Reading,
        bound: Bound | None,
        limits: tuple[float, float, float],
    ) -> None:
        """Draw the force and the effort as steps, where the drive slips, and the bound."""
        start, end, top = limits
        ui, dt, theme = self.painter.ui, frame.scenario.sampling_time, self.painter.theme
        ink = theme.shade(FORCE)

        def pixels(time: Float, force: Float) -> Float:
            x = area.left + (time - start) / (end - start) * area.width
            return np.column_stack([x, -area.bottom + np.minimum(force / top, 1.0) * area.height])

        before = surface.get_clip()
        surface.set_clip(area.inflate(2, 4).clip(before))
        scene = Scene()
        edges = reading.start + dt * np.arange(len(reading.force) + 1)
        edges = np.minimum(edges, frame.time)
        if reading.effort is not None and bound is not None:
            slips = reading.effort >= SLIPPING
            for a, b in _stretches(slips):
                ends = pixels(edges[[a, b]], np.zeros(2))[:, 0].round().tolist()
                band = pygame.Surface((max(1, int(ends[1] - ends[0])), area.height))
                band.fill(SLIP)
                band.set_alpha(70)
                surface.blit(band, (ends[0], area.top))
        if reading.effort is not None and len(reading.effort) and bound is not None:
            height = bound.force * reading.effort
            scene.line(pixels(*_steps(edges, height, area.width)), stroke=theme.effort, width=1.5)
        if len(reading.force):
            points = pixels(*_steps(edges, reading.force, area.width))
            foot = [(points[-1, 0], -area.bottom), (points[0, 0], -area.bottom)]
            scene.polygon(np.vstack([points, foot]), fill=faded(ink, 0.18))
            scene.line(points, stroke=ink, width=2.5)
        if len(reading.force) and reading.force.max() > top:
            k = int(reading.force.argmax())
            word = f"peak {in_newtons(float(reading.force[k]))}"
            half = self.painter.fonts.width(word, 12 * ui) / 2 + 4 * ui
            x = float(pixels(edges[k : k + 1], np.zeros(1))[0, 0])
            x = min(max(x, area.left + half), area.right - half)
            scene.text((x, -area.top), word, color=ink, anchor="below", halo=theme.plate)
        if bound is not None:
            ends = pixels(np.array([start, end]), np.full(2, bound.force))
            scene.line(ends, stroke=theme.ink, width=1.5, style="--")
            word = f"{bound.name} {in_newtons(bound.force)}"
            middle = area.left + 4 * ui + self.painter.fonts.width(word, 12 * ui) / 2
            place = (middle, ends[0, 1] - 2 * ui)
            scene.text(place, word, color=theme.ink, anchor="above", halo=theme.plate)
        self.painter.paint(surface, scene.shapes, PIXELS, shaded=False)
        surface.set_clip(before)


PIXELS = Camera(1.0, 0.0, 0.0)
"""Scenes of the panel are in pixels, y upwards."""


def _top(force: Float, bound: Bound | None) -> float:
    """Return the upper end of the scale, newtons."""
    peak = float(force.max(initial=0.0))
    if bound is None:
        return 1.15 * peak if peak > 0 else 1.0
    return max(1.35 * bound.force, min(1.1 * peak, OVERSHOOT * bound.force))


def _steps(edges: Float, values: Float, room: int) -> tuple[Float, Float]:
    """Return the corners of a line of steps, at most one a pixel: of those nearer the highest."""
    if len(values) > room:
        starts = np.arange(0, len(values), ceil(len(values) / room))
        values = np.maximum.reduceat(values, starts)
        edges = np.append(edges[starts], edges[-1])
    return np.repeat(edges, 2)[1:-1], np.repeat(values, 2)


def _stretches(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return from where to where flags are set."""
    changes = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    return list(zip(changes[::2].tolist(), changes[1::2].tolist(), strict=True))
