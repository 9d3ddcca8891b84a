"""Tools in the hand of the person before a run: a ruler, a stopwatch, a push that is typed."""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, degrees, dist

import pygame

from mars2d.core.plane import Point
from mars2d.core.scene import Scene
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.window.run.director import Director
from mars2d.window.run.marks import GOOD, HALO, draw_dot, draw_words
from mars2d.window.run.push import EXPECTED, pushed, suggested
from mars2d.window.screen.picking import Selection
from mars2d.window.screen.player import Player
from mars2d.window.widgets.notes import Notes
from mars2d.window.widgets.prompt import Answer, Prompts
from mars2d.window.widgets.slider import draw_tooltip

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
        for place in places:
            draw_dot(scene, place, GOOD)
        if len(places) == 2:
            (x, y), (u, v) = places
            scene.line(places, stroke=HALO, width=4.0)
            scene.line(places, stroke=GOOD, width=2.0)
            way = f"{dist(*places):.3f} m at {degrees(atan2(v - y, u - x)):.1f}°"
            text, middle = way.replace("-", "\N{MINUS SIGN}"), ((x + u) / 2, (y + v) / 2)
            draw_words(scene, camera, middle, text, GOOD)


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
        if words := self.words(now):
            at = room.centerx, room.top + round(6 * painter.ui)
            draw_tooltip(surface, painter, words, midtop=at)


class Tools:
    """The tools of a run window.

    actions: what takes them up, by name.
    """

    def __init__(
        self,
        player: Player,
        director: Director,
        selection: Selection,
        notes: Notes,
        prompts: Prompts,
    ) -> None:
        """Put all of them away."""
        self.ruler, self.stopwatch = Ruler(), Stopwatch()
        self._player, self._director = player, director
        self._selection, self._notes, self._prompts = selection, notes, prompts
        self.actions: dict[str, Callable[[], None]] = {
            "ruler": self._measure_or_not,
            "stopwatch": lambda: self.stopwatch.press(player.frame.time),
            "push": self._ask_for_push,
        }

    def measure_from(self, point: Point) -> None:
        """Begin to measure at a point [m]."""
        self.ruler.begin(None)
        self.ruler.mark(point)

    def _measure_or_not(self) -> None:
        """Begin to measure, from the selected body if there is one; to another; or no more."""
        ruler, body = self.ruler, self._selection.body
        if not ruler.on:
            ruler.begin(body)
            self._notes.say("click two points or bodies, or select one and press F8; Esc ends it")
        elif len(ruler.ends) < 2 and body is not None and body not in ruler.ends:
            ruler.mark(body)
        else:
            ruler.end()

    def _ask_for_push(self) -> None:
        """Ask for the force on the selected body, and push it."""
        body, frame = self._selection.body, self._player.frame
        if body is None:
            self._notes.say("Tab selects what is pushed", "warning")
        else:

            def push(text: str) -> None:
                force, seconds = pushed(text, self._player.frame.body_pose(body)[2])
                if self._director.change(lambda world: world.operator.push(body, force, seconds)):
                    self._notes.say(f"a push of {text.strip()}")

            name, answer = frame.scenario.bodies[body].name, Answer("push", push)
            self._prompts.ask(f"Push {name}", answer, text=suggested(frame, body), doc=EXPECTED)
