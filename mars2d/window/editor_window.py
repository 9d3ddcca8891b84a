"""The editor in a window of its own."""

from __future__ import annotations

import pygame

from mars2d.core.errors import Mars2dError
from mars2d.scenario.experiment import open_experiment
from mars2d.window.editor.editor import Editor
from mars2d.window.screen.display import PICTURES_A_SECOND, started_display
from mars2d.window.show import show_experiment

IDLE_WAIT = 100
"""How long to wait for an event before the editor is drawn again, milliseconds."""


class EditorWindow:
    """Shows an editor until it is left; F5 runs the saved file in between.

    size: of the window at first, points.
    """

    def __init__(self, editor: Editor, size: tuple[int, int] = (1280, 720)) -> None:
        """Prepare; the window opens with `run`."""
        self.editor, self.size = editor, size

    def run(self) -> None:
        """Open the window, and return when it is left. Raises InputError without a display."""
        with started_display():
            self.editor.looks.open(self.size)
            self._loop()

    def _loop(self) -> None:
        clock, editor = pygame.time.Clock(), self.editor
        while not editor.dialogs.done:
            pygame.display.set_caption(f"{editor.title} - MARS2D")
            surface = pygame.display.get_surface()
            assert surface is not None
            self.draw(surface)
            pygame.display.flip()
            clock.tick(PICTURES_A_SECOND)
            for event in (pygame.event.wait(IDLE_WAIT), *pygame.event.get()):
                if event.type == pygame.QUIT:
                    self._quit()
                else:
                    editor.handle(event)
            if editor.dialogs.to_run is not None:
                self._play()

    def draw(self, surface: pygame.Surface) -> None:
        """Draw the editor."""
        self.editor.draw(surface)

    def _quit(self) -> None:
        """Close the editor; without a question the second time."""
        asked = self.editor.dialogs.prompt is not None
        if asked:
            self.editor.dialogs.done = True
        else:
            self.editor.dialogs.leave()

    def _play(self) -> None:
        """Run the file in a window, then open the editor's window again."""
        editor, surface = self.editor, pygame.display.get_surface()
        path, editor.dialogs.to_run = editor.dialogs.to_run, None
        assert path is not None
        if surface is not None:
            self.size = editor.looks.points(surface.get_size())
        try:
            experiment = open_experiment(path)
            speed = experiment.scenario.animation.playback_speed
            likes = editor.looks.preferences
            show_experiment(experiment, speed, preferences=likes, viewpoint=editor.viewpoint)
        except Mars2dError as error:
            editor.desk.say(str(error), warns=True)
        pygame.event.clear()
        editor.looks.open(self.size)
