"""The picture of a run: bodies, forces, other branches, and the marks of hands and tools."""

from __future__ import annotations

from collections.abc import Sequence

import pygame

from mars2d.core.plane import Point
from mars2d.core.scene import Scene
from mars2d.output.layers.forces import in_newtons
from mars2d.output.layers.table import Layers
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.stage import Stage
from mars2d.record.frame import Frame
from mars2d.record.interventions import pushes_at
from mars2d.window.run.ghosts import ghosts
from mars2d.window.run.grab import Grab
from mars2d.window.run.heat import AGAIN, MOST, heat, squeezes
from mars2d.window.run.marks import GOOD, draw_ring
from mars2d.window.run.push import draw_pushes
from mars2d.window.run.tools import Ruler
from mars2d.window.screen.picking import Selection, sensed_by
from mars2d.window.screen.source import Source, done_in
from mars2d.world.timeline import Timeline


class Arena:
    """Draws a source, with what the mouse grabs, what is selected, and what is measured."""

    def __init__(
        self, painter: Painter, source: Source, grab: Grab, selection: Selection, ruler: Ruler
    ) -> None:
        """Start with nothing drawn."""
        self._stage, self._source = Stage(painter), source
        self._grab, self._selection, self._ruler = grab, selection, ruler
        self._crowded = False  # whether forces are drawn as colours

    def draw(
        self,
        surface: pygame.Surface,
        frame: Frame,
        layers: Layers,
        free: Sequence[pygame.Rect],
        pointer: Point | None,
    ) -> None:
        """Draw a frame; free: the sides of the picture without panels. pointer: metres."""
        marks, more, selected = Scene(), "", self._selection.body
        viewpoint, source = self._grab.viewpoint, self._source
        many = len(frame.contacts) > (AGAIN if self._crowded else MOST)
        self._crowded = many and layers.forces
        if self._crowded:
            layers, over = layers.switched(forces=False), self._grab.over
            more = "" if over is None else in_newtons(float(squeezes(frame)[over]))
            heat(marks, frame)
        if selected is not None:
            draw_ring(marks, frame, selected, GOOD, 2.5, 10.0)
        marks.shapes += self._grab.marks(frame, named=layers.names, more=more)
        pushes = pushes_at(done_in(source), frame.time, frame.scenario.sampling_time)
        draw_pushes(marks, frame, pushes, viewpoint.camera)
        self._ruler.draw(marks, frame, viewpoint.camera, pointer)
        self._stage.draw(
            surface,
            sensed_by(frame, selected),
            viewpoint.camera,
            layers,
            viewpoint.layout.plot,
            free=free,
            beneath=ghosts(source, frame).shapes if isinstance(source, Timeline) else [],
            marks=marks.shapes,
            hurried=viewpoint.hurried,
        )
