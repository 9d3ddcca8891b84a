"""The editor in a window of its own."""

from __future__ import annotations

from pathlib import Path

import pygame

from mars2d.scenario.experiment import open_experiment
from mars2d.window.editor.editor import Editor
from mars2d.window.screen.display import PICTURES_A_SECOND, started_display
from mars2d.window.screen.looks import Looks
from mars2d.window.screen.viewpoint import Viewpoint
from mars2d.window.show import show_experiment

IDLE_WAIT = 100
"""How long to wait for an event before the editor is drawn again, milliseconds."""


def show_editor(editor: Editor, size: tuple[int, int] = (1280, 720)) -> None:
    """Show an editor in a window until it is left. Raises InputError without a display.

    size: of the window at first, points.
    """
    with started_display():
        screen, clock = editor.looks.open(size), pygame.time.Clock()
        while not editor.dialogs.done:
            pygame.display.set_caption(f"{editor.title} - MARS2D")
            editor.draw(pygame.display.get_surface() or screen)
            pygame.display.flip()
            clock.tick(PICTURES_A_SECOND)
            for event in (pygame.event.wait(IDLE_WAIT), *pygame.event.get()):
                editor.handle(event)


def play(path: Path, looks: Looks, viewpoint: Viewpoint) -> None:
    """Run a file in the window of an editor, which stays as it is, until it is closed."""
    experiment = open_experiment(path)
    speed = experiment.scenario.animation.playback_speed
    show_experiment(experiment, speed, preferences=looks.preferences, viewpoint=viewpoint)
