"""The picture of a run: bodies, forces, other branches, marks of hands and tools, and panels."""

from __future__ import annotations

import pygame

from mars2d.core.plane import Point
from mars2d.core.scene import Scene, Shape
from mars2d.output.layers.forces import in_newtons
from mars2d.output.layers.table import Layers
from mars2d.output.raster.layout import Layout
from mars2d.output.raster.stage import Stage
from mars2d.record.frame import Frame
from mars2d.record.interventions import pushes_at
from mars2d.window.panels.panels import Panels
from mars2d.window.run.ghosts import ghosts
from mars2d.window.run.grab import CLICK, Grab
from mars2d.window.run.heat import AGAIN, MOST, heat, squeezes
from mars2d.window.run.marks import GOOD, draw_ring
from mars2d.window.run.mouse import Pixel
from mars2d.window.run.push import draw_pushes
from mars2d.window.run.tools import Tools
from mars2d.window.screen.picking import Selection, sensed_by
from mars2d.window.screen.source import Source, done_in
from mars2d.world.timeline import Timeline


class Arena:
    """What is between the bars: a run with the marks of hands and tools, and panels beside it."""

    def __init__(
        self, source: Source, grab: Grab, selection: Selection, tools: Tools, dock: Panels
    ) -> None:
        """Start with nothing drawn."""
        self._stage, self._source, self._dock = Stage(dock.painter), source, dock
        self._grab, self._selection, self._tools = grab, selection, tools
        self._crowded = False  # whether forces are drawn as colours

    def draw(
        self,
        surface: pygame.Surface,
        layout: Layout,
        frame: Frame,
        layers: Layers,
        pointer: Pixel | None,
        *,
        drives: bool,
    ) -> None:
        """Draw a frame; drives: whether a person drives, who is not to be covered."""
        view, dock, grab = self._grab.viewpoint, self._dock, self._grab
        grab.click, dock.inspector.frames = CLICK * layout.ui, drives
        bounds = view.bounds or frame.scenario.bounds
        view.arrange(layout, frame.scenario, dock.arrange(layout, frame, bounds))
        over = None if pointer is None else grab.place(pointer)
        marks, layers = self._marks(frame, layers, None if over is None else view.point_at(over))
        source, beneath = self._source, list[Shape]()
        if isinstance(source, Timeline):
            beneath = ghosts(source, frame).shapes
        self._stage.draw(
            surface,
            sensed_by(frame, self._selection.body),
            view.camera,
            layers,
            layout.plot,
            free=dock.free,
            beneath=beneath,
            marks=marks.shapes,
            hurried=view.hurried,
        )
        spot = None if view.makes_room and dock.beside else self.selected_pixel(frame)
        free = view.seen if drives and not view.following else None
        dock.draw(surface, frame, spot, pointer, free=free)
        self._tools.stopwatch.draw(surface, view.room, dock.painter, frame.time)

    def _marks(self, frame: Frame, layers: Layers, point: Point | None) -> tuple[Scene, Layers]:
        """Return marks, and the layers without forces where they are colours; point: the mouse."""
        scene, more, selected = Scene(), "", self._selection.body
        camera, source = self._grab.viewpoint.camera, self._source
        many = len(frame.contacts) > (AGAIN if self._crowded else MOST)
        self._crowded = many and layers.forces
        if self._crowded:
            layers, over = layers.switched(forces=False), self._grab.over
            more = "" if over is None else in_newtons(float(squeezes(frame)[over]))
            heat(scene, frame)
        if selected is not None:
            draw_ring(scene, frame, selected, GOOD, 2.5, 10.0)
        scene.shapes += self._grab.marks(frame, named=layers.names, more=more)
        pushes = pushes_at(done_in(source), frame.time, frame.scenario.sampling_time)
        draw_pushes(scene, frame, pushes, camera)
        self._tools.ruler.draw(scene, frame, camera, point)
        return scene, layers

    def selected_pixel(self, frame: Frame) -> tuple[float, float] | None:
        """Return where the selected body is drawn, if one is selected."""
        body, camera = self._selection.body, self._grab.viewpoint.camera
        if body is None:
            return None
        ((x, y),) = camera.to_pixels([frame.body_pose(body)[:2]]).tolist()
        return x, y
