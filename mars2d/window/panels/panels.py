"""All panels of a run window, and the commands that open, scroll and change them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import pygame

from mars2d.output.raster.painter import Painter
from mars2d.window.panels.impact import Impact
from mars2d.window.panels.inspector import Inspector
from mars2d.window.panels.lesson import Lesson
from mars2d.window.panels.parameter_panel import ParameterPanel, Set
from mars2d.window.panels.predictions import Predictions
from mars2d.window.panels.printed import Printed
from mars2d.window.panels.scopes import Scopes
from mars2d.window.screen.picking import Selection
from mars2d.window.screen.player import Player
from mars2d.window.screen.saving import Saver
from mars2d.window.widgets.dock import Dock
from mars2d.window.widgets.notes import Notes
from mars2d.world.timeline import Timeline

OPENED = ("predictions", "lesson", "parameters", "printed")
"""The panels that have a command of their own."""


class Panels(Dock):
    """The panels beside the arena.

    path: of the experiment's file. set_to: sets a parameter. actions: the commands, by name.
    """

    def __init__(
        self,
        painter: Painter,
        player: Player,
        selection: Selection,
        path: Path | None,
        set_to: Set,
        notes: Notes,
        saver: Saver,
    ) -> None:
        """Start with all closed, but for plots that the experiment's file names."""
        source = player.source
        self.inspector = Inspector(painter, selection)
        self.scopes = scopes = Scopes(painter, player, selection)
        self.parameters = ParameterPanel(painter, player, selection, set_to)
        self.predictions = Predictions(painter, source if isinstance(source, Timeline) else None)
        self.lesson, self.impact = Lesson(painter, path), Impact(painter, player)
        self.printed = Printed(painter, player)
        super().__init__(
            painter,
            [
                self.inspector, scopes, self.parameters, self.predictions, self.lesson,
                self.printed, self.impact,
            ],
        )  # fmt: skip
        self._notes = notes
        self.actions: dict[str, Callable[[], None]] = {
            **{name: partial(self._open_or_not, name) for name in OPENED},
            "figure": lambda: scopes.save_figure(player.frame, saver),
            "less_time": lambda: scopes.zoom(1),
            "more_time": lambda: scopes.zoom(-1),
            "slider": self._to_sliders,
            "turn_on": partial(self._turn, -1),
            "turn_back": partial(self._turn, 1),
        }

    @property
    def lacking(self) -> list[str]:
        """The names of panels with nothing to show."""
        return [panel.name for panel in self.panels if panel.lacks]

    def is_on(self, name: str) -> bool:
        """Return whether there is an open panel of this name."""
        return any(panel.is_open for panel in self.panels if panel.name == name)

    def _open_or_not(self, name: str) -> None:
        """Show a panel, or no longer; or say what it lacks."""
        lacks = self.named(name).lacks
        if lacks:
            self._notes.say(lacks, "warning")
        else:
            self.switch(name)

    def _to_sliders(self) -> None:
        """Let keys go to the sliders of parameters, which are shown."""
        if not self.parameters.is_open or "parameters" in self._folded:
            self._open_or_not("parameters")
        self.parameters.begin()

    def _turn(self, notches: int) -> None:
        """Scroll the panels that have more rows, as the wheel over them does."""
        turned = pygame.Event(pygame.MOUSEWHEEL, x=0, y=3 * notches)
        for panel in self.panels:
            if panel.is_open and panel.scroll.cut:
                panel.handle(turned)
