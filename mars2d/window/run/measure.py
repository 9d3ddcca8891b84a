"""A ruler on the floor, and a stopwatch of the run's time."""

from __future__ import annotations

from math import atan2, degrees, dist

import pygame

from mars2d.core.plane import Point
from mars2d.core.scene import Scene
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.window.run.drags import GOOD, HALO, LABEL

End = Point | int
"""A point of the floor [m], or a body, with which the ruler's end moves."""


class Ruler:
    """Measures from one end to another; until there is a second one, to the pointer.

    ends: two at most. on: whether clicks make ends.
    """

    def __init__(self) -> None:
        """Start without ends."""
        self.ends: list[End] = []
        self.on = False

    def begin(self, body: int | None) -> None:
        """Let clicks make ends; the first one is a body, if there is one."""
        self.on, self.ends = True, [] if body is None else [body]

    def mark(self, end: End) -> None:
        """Put an end; a third one begins anew."""
        self.ends = [end] if len(self.ends) == 2 else [*self.ends, end]

    def end(self) -> None:
        """Put it away."""
        self.on, self.ends = False, []

    def draw(self, scene: Scene, frame: Frame, camera: Camera, pointer: Point | None) -> None:
        """Draw it with its length and direction."""
        places = [frame.body_pose(e)[:2] if isinstance(e, int) else e for e in self.ends]
        if len(places) == 1 and pointer is not None:
            places.append(pointer)
        for x, y in places:
            scene.circle((x, y), 0.0, fill=GOOD, stroke=HALO, width=1.5, pixels=3.5)
        if len(places) == 2:
            (x, y), (u, v) = places
            scene.line(places, stroke=HALO, width=4.0)
            scene.line(places, stroke=GOOD, width=2.0)
            way = f"{dist(*places):.3f} m at {degrees(atan2(v - y, u - x)):.1f}°"
            middle = (x + u) / 2, (y + v) / 2 + 8 / camera.scale
            text = way.replace("-", "\N{MINUS SIGN}")
            scene.text(middle, text, color=GOOD, size=LABEL, anchor="above", halo=HALO)


class Stopwatch:
    """Measures the time of the run between two moments, seconds; a third press puts it away."""

    def __init__(self) -> None:
        """Start put away."""
        self.moments: list[float] = []

    def press(self, time: float) -> None:
        """Start, stop, or put it away."""
        self.moments = [] if len(self.moments) == 2 else [*self.moments, time]

    def words(self, now: float) -> str:
        """Return what it shows, "" while it is put away."""
        if not self.moments:
            return ""
        first, last = self.moments[0], self.moments[1] if len(self.moments) == 2 else now
        span = f"{last - first:.3f} s".replace("-", "\N{MINUS SIGN}")
        return f"{span}   from {first:.3f} s to {last:.3f} s"

    def draw(
        self, surface: pygame.Surface, room: pygame.Rect, painter: Painter, now: float
    ) -> None:
        """Draw it at the upper edge of the room of the arena."""
        words, ui = self.words(now), painter.ui
        if not words:
            return
        plate = pygame.Rect(0, 0, painter.fonts.width(words, 14 * ui) + 28 * ui, 30 * ui)
        plate.midtop = room.centerx, room.top + round(6 * ui)
        painter.panel(surface, plate, painter.theme.plate, 8 * ui, painter.theme.edge)
        painter.write(surface, words, 14 * ui, painter.theme.ink, center=plate.center)
