"""Tools in the hand of the person before a run: a ruler, a stopwatch, a push that is typed."""

from __future__ import annotations

from collections.abc import Callable

from mars2d.core.plane import Point
from mars2d.window.run.director import Director
from mars2d.window.run.measure import Ruler, Stopwatch
from mars2d.window.run.push import EXPECTED, pushed, suggested
from mars2d.window.screen.player import Player
from mars2d.window.screen.selection import Selection
from mars2d.window.widgets.menu import Menu
from mars2d.window.widgets.notes import Notes
from mars2d.window.widgets.prompt import Answer, Prompts
from mars2d.window.widgets.text_field import TextField
from mars2d.world.operator import forceless


class Tools:
    """The tools of a run window.

    actions: what takes them up, by name. menu: where they ask.
    """

    def __init__(
        self, player: Player, director: Director, selection: Selection, notes: Notes
    ) -> None:
        """Put all of them away."""
        self.ruler, self.stopwatch, self.menu = Ruler(), Stopwatch(), Menu()
        self.prompts = Prompts(self.menu)
        self._player, self._director = player, director
        self._selection, self._notes = selection, notes
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
        elif fault := forceless(frame.scenario, body):
            self._notes.say(fault, "warning")
        else:

            def push(text: str) -> None:
                force, seconds = pushed(text, self._player.frame.body_pose(body)[2])
                if self._director.change(lambda world: world.operator.push(body, force, seconds)):
                    self._notes.say(f"a push of {text.strip()}")

            field = TextField(suggested(frame, body), opened_by_key=True)
            field.select_all()
            name = frame.scenario.bodies[body].name
            self.prompts.ask(f"Push {name}", Answer("push", push), field=field, doc=EXPECTED)
