"""From where the picture is seen: fitted to the workspace, moved by a person, or following."""

from __future__ import annotations

import time

import pygame

from mars2d.output.raster.camera import Camera
from mars2d.output.raster.layout import Layout, fitted
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario
from mars2d.window.follow import Follow

__all__ = ["Viewpoint", "wheel_notches"]

WHEEL_FACTOR = 1.15
REST = 0.12
"""The camera moves until it has rested for so many seconds."""
DEEPEST, WIDEST = 400.0, 0.05
"""How far one can zoom in and out, times the scale at which the workspace fits."""


class Viewpoint:
    """The camera of a window, and what moves it.

    layout: where the picture lies; `arrange` takes another one.
    """

    def __init__(self, scenario: Scenario, layout: Layout) -> None:
        """Start with the whole workspace in view."""
        self.layout = layout
        self.following: Follow | None = None
        self._scenario = scenario
        self._fits = True
        self._hurry = 0.0
        self.camera = self._fitted()

    @property
    def hurried(self) -> bool:
        """Whether the camera moves."""
        return time.perf_counter() < self._hurry

    def arrange(self, layout: Layout, scenario: Scenario) -> None:
        """Take another layout; keep what is seen in place, or fitted if it was."""
        before, self.layout = self.layout, layout
        same = scenario.bounds == self._scenario.bounds
        self._scenario = scenario
        if self._fits and not (same and layout == before):
            self.fit()
        elif layout != before:
            old, new = before.plot.center, layout.plot.center
            self.camera = self.camera.panned(new[0] - old[0], new[1] - old[1])

    def fit(self, scenario: Scenario | None = None) -> None:
        """Show the whole workspace; of another scenario from now on, if one is given."""
        self._scenario = scenario or self._scenario
        self._fits, self.following = True, None
        self.camera = self._fitted()

    def zoom(self, notches: float, pixel: tuple[int, int]) -> None:
        """Zoom about a pixel by notches of the wheel."""
        fit = self._fitted().scale
        wanted = self.camera.scale * WHEEL_FACTOR**notches
        wanted = min(max(wanted, WIDEST * fit), DEEPEST * fit)
        self._look(self.camera.zoomed(pixel, wanted / self.camera.scale))

    def pan(self, dx: int, dy: int) -> None:
        """Move the picture by pixels; what was followed is not any more."""
        self.following = None
        self._look(self.camera.panned(dx, dy))

    def follow(self, body: int | None) -> None:
        """Follow a body, or all robots; if something is followed, nothing any more."""
        self.following = Follow(body) if self.following is None else None

    def step(self, frame: Frame, seconds: float) -> None:
        """Move on with what is followed, for seconds of the wall clock."""
        if self.following is not None:
            camera = self.following.camera(self.camera, frame, self.layout.plot, seconds)
            if camera != self.camera:
                self._look(camera)

    def _look(self, camera: Camera) -> None:
        """Look with another camera than that of the whole workspace."""
        self._fits = False
        self.camera = camera
        self._hurry = time.perf_counter() + REST

    def _fitted(self) -> Camera:
        return fitted(self._scenario, self.layout.size, self.layout)


def wheel_notches(event: pygame.Event) -> float:
    """Return by how many notches a wheel was turned."""
    return float(getattr(event, "precise_y", event.y))
