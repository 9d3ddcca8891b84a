"""The run window: watch an experiment, pause it, go back in it, intervene in it."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import pygame

from mars2d.core.errors import Mars2dError, counted
from mars2d.core.plane import Point
from mars2d.core.scene import Scene
from mars2d.output.layers.forces import in_newtons
from mars2d.output.layers.table import Layers
from mars2d.output.raster.bars import Banner, Status, draw_footer, draw_header, footer_height
from mars2d.output.raster.layout import Layout, fitted
from mars2d.output.raster.picture import arena_of, summary
from mars2d.output.raster.stage import Stage
from mars2d.record.frame import Frame
from mars2d.record.interventions import Intervention, pushes_at
from mars2d.scenario.controllers import standing_still
from mars2d.scenario.examples import experiment_name
from mars2d.window.panels.impact import Impact
from mars2d.window.panels.inspector import Inspector
from mars2d.window.panels.lesson import Lesson
from mars2d.window.panels.parameter_panel import ParameterPanel
from mars2d.window.panels.predictions import Predictions
from mars2d.window.panels.printed import Printed
from mars2d.window.panels.rows import RowsPanel
from mars2d.window.panels.scopes import Scopes
from mars2d.window.run import keys
from mars2d.window.run.countdown import Countdown
from mars2d.window.run.director import RECORDING, Director
from mars2d.window.run.drags import GOOD, draw_ring
from mars2d.window.run.ending import Ending
from mars2d.window.run.ghosts import ghosts
from mars2d.window.run.grab import CLICK, Grab
from mars2d.window.run.heat import AGAIN, MOST, heat, squeezes
from mars2d.window.run.menus import (
    entries_of_body,
    entries_of_leaving,
    entries_of_place,
    entries_of_scopes,
)
from mars2d.window.run.mouse import Mouse
from mars2d.window.run.play import Play
from mars2d.window.run.player_window import PlayerWindow
from mars2d.window.run.push import draw_pushes
from mars2d.window.run.reload import Reload
from mars2d.window.run.score_panel import ScorePanel
from mars2d.window.run.toolbar import Toolbar
from mars2d.window.run.tools import Tools
from mars2d.window.screen.display import (
    Preferences,
)
from mars2d.window.screen.picking import Selection, body_at, next_body, sensed_by
from mars2d.window.screen.source import Playback, Source
from mars2d.window.screen.viewpoint import Viewpoint
from mars2d.window.widgets.dock import Dock
from mars2d.window.widgets.menu import Entry
from mars2d.world.timeline import Timeline

if TYPE_CHECKING:
    from mars2d.window.editor import Editor

TYPING = (pygame.KEYDOWN, pygame.TEXTINPUT, pygame.TEXTEDITING)
LACKS = {
    "predictions": "this file has no checks, which compare a run with theory",
    "lesson": "this file has no lesson: a docstring with Question: and the like",
    "parameters": RECORDING,
}
"""What is said where a panel has nothing to show."""
USUAL = (
    ("Space", "pause"), ("← →", "step"), ("+ \N{MINUS SIGN}", "speed"), ("F1", "help"),
)  # fmt: skip
BY_HAND = (("↑ ↓ ← →", "drive"), ("Shift", "slowly"), ("H", "let go"), ("F1", "help"))
"""The keys that the footer names; a game's panel has its own."""


class Window(PlayerWindow):
    """Shows a source on the screen until the window is closed.

    speed: a factor of real time, 0 for one step a key press, or "max". size: at first, pixels.
    preferences: how the window looks.
    """

    def __init__(
        self,
        source: Source,
        speed: float | str = 1.0,
        size: tuple[int, int] = (1280, 720),
        preferences: Preferences | None = None,
    ) -> None:
        """Prepare; the window opens with `run`."""
        title, name = source.scenario.title, _stem(source)
        super().__init__(source, speed, size, preferences, title=title, stem=name)
        self.layers = self.layers.switched(neighbours=True)
        self.asks = False  # before a run is lost that can't just be run again
        self.director = Director(self.player, self.notes, self._show_way_back)
        self.grab = Grab(self.director.change, partial(self.notes.say, kind="warning"))
        self.editor: Editor | None = None
        self.game: Play | None = None  # where people play
        self._before: Countdown | None = None
        self._score: ScorePanel | None = None
        self._crowded = False  # whether forces are drawn as colours
        timeline = self.director.timeline
        self._reload = None if timeline is None else Reload(timeline, self._show_way_back)
        self._ending = Ending(self.player)
        self._cast = _cast(source)
        painter = self._painter = self.looks.painter
        self._stage = Stage(painter)
        self._selection = Selection()
        self._tools = Tools(self.player, self.director, self._selection, self.notes)
        self._printed = Printed(painter, lambda: self.player.source.frame.time)
        self._inspector = Inspector(painter, self._selection)
        self._predictions = Predictions(painter, timeline)
        self._lesson, self._impact = Lesson(painter, _path(source)), Impact(painter, self.player)
        self.parameters = ParameterPanel(painter, self.player, self._selection, self._set_parameter)
        bounds = source.bounds if isinstance(source, Playback) else None
        self.viewpoint = Viewpoint(source.scenario, self._layout(size, None), bounds)
        self._mouse = Mouse(
            self.player, self.viewpoint, self.grab, self._controls.handles,
            self._is_picture, self._select_at, self._offer,
        )  # fmt: skip
        self._actions |= {
            "contacts": self._stop_or_go_on,
            "source": lambda: self._ending.open_source(self.notes),
            **{name: partial(self._switch_panel, name) for name in (*LACKS, "printed")},
            "within": partial(self._step_within, 1),
            "within_back": partial(self._step_within, -1),
            "branch": self._other_branch,
            "undo": self._undo,
            "scopes": self._open_scopes,
            "figure": lambda: self.scopes.save_figure(self.player.frame, self.saver),
            "less_time": lambda: self.scopes.zoom(1),
            "more_time": lambda: self.scopes.zoom(-1),
            "select": lambda: self.select(next_body(self.player.frame, self.selected)),
            "follow": self._follow_or_not,
            "slider": self._to_sliders,
            "offer": self._offer_by_key,
            "turn_on": partial(self._turn_panels, -1),
            "turn_back": partial(self._turn_panels, 1),
            "drive": self._drive_or_not,
            **self._tools.actions,
            "edit": self._open_editor,
            "film": self.saver.film_or_not,
        }
        self.scopes: Scopes = Scopes(painter, self.player)
        self.dock = Dock(
            painter,
            [
                self._inspector, self.scopes, self.parameters, self._predictions, self._lesson,
                self._printed, self._impact,
            ],
        )  # fmt: skip
        buttons = dict(self._actions)
        for name, panel in (("predictions", self._predictions), ("lesson", self._lesson)):
            if not panel.offered:
                del buttons[name]
        self.toolbar = Toolbar(buttons, self._is_on, live=timeline is not None)

    @property
    def selected(self) -> int | None:
        """The selected body, an index of `Scenario.bodies`."""
        return self._selection.body

    def select(self, body: int | None) -> None:
        """Select a body, or none."""
        self._selection.body = body

    @property
    def remembered(self) -> dict[str, object]:
        """How the window looks, to be remembered: size [points], colours, size of text, panels."""
        return self.looks.remembered(self.layout.size) | {"panels": self.dock.opened}

    def run(self) -> None:
        """Do what any window does, and show what laws print."""
        with self._printed.listening():
            super().run()

    def arena(self) -> pygame.Surface:
        """Return a picture of the arena alone, without any bars."""
        self.editor, surface = None, pygame.Surface(self.layout.size, 0, 32)
        self.draw(surface, notes=False)
        return surface.subsurface(self.layout.plot)

    def _calls(self) -> object:
        timeline = self.director.timeline
        return None if timeline is None else timeline.world.simulation.calls

    def _answer(self, where: str) -> str:
        broken_off = super()._answer(where)
        if not broken_off and self._reload is not None and self._reload.waits():
            return "did not return before its file was saved"
        return broken_off

    @property
    def _moves(self) -> bool:
        followed = self.viewpoint.following is not None
        acts = self.grab.busy or self.saver.filming or self.editor is not None
        acts |= self._drives and self.game is None
        if self.game is not None:
            acts |= self.game.counting > 0
        return acts or followed or super()._moves

    def _paint(self, screen: pygame.Surface) -> None:
        """Draw the next picture of the loop, and add it to the film."""
        self.draw(screen)
        self._film(screen)

    def _film(self, screen: pygame.Surface) -> None:
        """Add the drawn screen to the film, if one is being made, and mark it as filmed."""
        if not self.saver.filming:
            return
        plot = self.layout.plot
        picture = self._arena(screen) if self.editor is None else screen
        self.saver.film(picture, screen, plot, self._painter)
        if self.editor is None:  # notes are not part of the film
            self.notes.draw(screen, plot, self._painter, time.monotonic())

    def _pass_time(self, seconds: float) -> None:
        if self.editor is not None:
            return
        self._read_again()
        if self.game is not None and self.game.pass_time(seconds):
            self._rest.stir()
        self.director.steer(seconds)
        self.grab.tick(self.player.frame, self.camera, self.player.playing)
        self.parameters.tick()
        self.player.pass_time(seconds)
        if self._predictions.look(playing=self.player.playing):
            self._rest.stir()
        self.viewpoint.step(self.player.frame, seconds)
        if self.player.playing:
            self.viewpoint.keep(self.player.frame, self.director.driven)

    def _read_again(self) -> None:
        """Continue with the experiment's files if they were saved."""
        reloaded = None if self._reload is None else self._reload.poll(time.monotonic())
        if reloaded is None:
            return
        self._rest.stir()
        if reloaded.error is None:
            self.notes.clear()  # the error is corrected
        self.notes.say(reloaded.message, "info" if reloaded.error is None else "error")
        if self.director.timeline is not None:
            self.player.error = self.director.timeline.error
        self.player.settle()
        self._meet()

    def _meet(self) -> None:
        """Release and deselect all bodies if the experiment has others than before."""
        self.scopes.meet(self.player.source.scenario)
        cast = _cast(self.player.source)
        if cast == self._cast:
            return
        self._cast, self.viewpoint.following = cast, None
        self.select(None)
        self.director.release()
        self.grab.cancel()
        self.grab.leave()

    # -- drawing --------------------------------------------------------------------------------

    def draw(self, surface: pygame.Surface, *, notes: bool = True) -> None:
        """Draw the window or its editor on a surface; the layout follows its size."""
        if self.editor is not None:
            self.editor.draw(surface)
            return
        try:
            self._draw(surface, self.layers, notes=notes)
        except Mars2dError as error:  # raised by the drawing of an add-on or a sensor
            self.player.fail(error)
            self._draw(surface, self._own_layers(), notes=notes)

    def _draw(self, surface: pygame.Surface, layers: Layers, *, notes: bool) -> None:
        banner = self._ending.banner()
        frame = self.grab.shown(self.player.frame)
        layout = self._layout(surface.get_size(), banner)
        self._painter.ui, self.grab.click = layout.ui, CLICK * layout.ui
        self._inspector.frames = self._drives
        self.scopes.chosen = self.selected
        bounds = self.viewpoint.bounds or frame.scenario.bounds
        fit = partial(fitted, bounds, layout.size)
        room = self.dock.arrange(layout, frame, fit, bounds[3] - bounds[2])
        self.viewpoint.arrange(layout, frame.scenario, room)
        many = len(frame.contacts) > (AGAIN if self._crowded else MOST)
        self._crowded, squeezed = many and layers.forces, ""
        if self._crowded:
            layers, over = layers.switched(forces=False), self.grab.over
            squeezed = "" if over is None else in_newtons(float(squeezes(frame)[over]))
        marks = self.grab.marks(frame, self.camera, named=self.layers.names, more=squeezed)
        if self.selected is not None:
            ring = Scene()
            draw_ring(ring, frame, self.selected, GOOD, 2.5, 10.0)
            marks = [*ring.shapes, *marks]
        timeline = self.director.timeline
        source, done = self.player.source, list[Intervention]()
        if timeline is not None:
            done = timeline.world.operator.log
        elif isinstance(source, Playback):
            done += source.record.interventions
        scene, dt = heat(frame) if self._crowded else Scene(), frame.scenario.sampling_time
        draw_pushes(scene, frame, pushes_at(done, frame.time, dt), self.camera)
        pointer = None if self._pointer is None else self._point_at(self._pointer)
        self._tools.ruler.draw(scene, frame, self.camera, pointer)
        marks = [*marks, *scene.shapes]
        others = [] if timeline is None else ghosts(timeline, frame).shapes
        self._stage.draw(
            surface,
            sensed_by(frame, self.selected),
            self.camera,
            layers,
            layout.plot,
            free=self.dock.free,
            beneath=others,
            marks=marks,
            hurried=self.viewpoint.hurried,
        )
        self._draw_dock(surface, frame)
        if notes and not self.saver.filming:
            off = self._selected_pixel(frame)
            self.notes.draw(surface, layout.plot, self._painter, time.monotonic(), off)
        self._tools.stopwatch.draw(surface, self.viewpoint.room, self._painter, frame.time)
        self._draw_bars(surface, frame, banner)
        if self._before is not None and notes:
            self._before.draw(surface, self.viewpoint.room, layout.plot, frame.scenario)
        if notes:
            self.toolbar.draw(surface, layout, self._painter, self._pointer)
            self._tools.menu.draw(surface, layout.plot, self._painter)
        self.help.draw(surface, layout, self._painter, keys.GROUPS.items())

    def _selected_pixel(self, frame: Frame) -> tuple[float, float] | None:
        """Return where the selected body is drawn, if one is selected."""
        if self.selected is None:
            return None
        ((x, y),) = self.camera.to_pixels([frame.body_pose(self.selected)[:2]]).tolist()
        return x, y

    def _draw_bars(self, surface: pygame.Surface, frame: Frame, banner: Banner | None) -> None:
        """Draw the bars round the picture."""
        layout, painter = self.layout, self._painter
        draw_header(surface, layout, painter, frame, self._status())
        self._controls.draw(surface, layout, painter, self._pointer, self._mouse.drags)
        hints = () if self.game is not None else BY_HAND if self._drives else USUAL
        draw_footer(surface, layout, painter, banner, summary(frame), hints)

    def _status(self) -> Status:
        text, kind = self.player.status()
        if self.game is not None and self.game.counting:
            return Status("get ready", "waiting")
        if self.game is not None and self.player.playing and kind == "running":
            return Status(text, "hand")
        if self._drives and kind in ("running", "waiting") and not self.player.over:
            return Status(f"{text}  {self.director.status}", "hand")
        return Status(text, kind)

    def _draw_dock(self, surface: pygame.Surface, frame: Frame) -> None:
        """Draw the panels, away from the selected body where the arena makes no room for them."""
        beside = self.viewpoint.makes_room and self.dock.beside
        spot = None if beside else self._selected_pixel(frame)
        drives = self._drives and self.viewpoint.following is None
        free = self._seen_arena(frame) if drives else None
        self.dock.draw(surface, frame, spot, self._pointer, free=free)

    @property
    def _drives(self) -> bool:
        """Whether a robot is driven by hand."""
        return bool(self.director.driven)

    def _seen_arena(self, frame: Frame) -> pygame.Rect:
        """Return where the workspace is seen, which a driver needs to see, pixels."""
        xmin, xmax, ymin, ymax = self.viewpoint.bounds or frame.scenario.bounds
        (left, top), (right, bottom) = self.camera.to_pixels([(xmin, ymax), (xmax, ymin)]).tolist()
        return pygame.Rect(left, top, right - left, bottom - top)

    def _layout(self, size: tuple[int, int], banner: Banner | None) -> Layout:
        """Return the layout on a surface of this size."""
        text, scale = self.looks.text, self.looks.scale
        height = footer_height(banner, size, self._painter, text, scale)
        return self.looks.layout(size, height, controls=True)

    # -- events ---------------------------------------------------------------------------------

    def _take(self, event: pygame.Event) -> bool:
        if self._tools.menu.handle(event):
            return True
        over = self.editor is None and self.toolbar.menu.is_open and self.toolbar.handle(event)
        if not over and self.director.handle(event):
            return True
        if self.editor is not None:
            self.editor.handle(event)
            if self.editor.dialogs.done:
                self._close_editor(self.editor)
            return True
        if not over and self._before is not None and self._before.handle(event):
            return True
        if over or self.toolbar.handle(event):
            self._meet()
            return True
        if not self.help.is_open and self.dock.handle(event):
            return True
        return event.type in TYPING and not self._drives and self.parameters.press(event)

    def _point(self, event: pygame.Event) -> None:
        if event.type == pygame.MOUSEBUTTONDOWN:
            self.parameters.leave()
            if self.player.failed and self.layout.footer.collidepoint(event.pos):
                self._ending.open_source(self.notes)
        self._mouse.handle(event)

    def _is_picture(self, pixel: tuple[int, int]) -> bool:
        """Return whether a pixel shows the picture, with nothing over it."""
        over = self.help.is_open or self.dock.covers(pixel) or self.toolbar.covers(pixel)
        return not over and self.layout.plot.collidepoint(pixel)

    def _select_at(self, point: Point) -> None:
        """Select the body at a point [m] of the picture, or nothing; or measure there."""
        body = body_at(self.player.frame, point, self.grab.click / self.camera.scale)
        if self._tools.ruler.on:
            self._tools.ruler.mark(point if body is None else body)
        else:
            self.select(body)

    def _point_at(self, pixel: tuple[int, int]) -> Point:
        """Return the point [m] at a pixel."""
        ((x, y),) = self.camera.to_world([pixel]).tolist()
        return x, y

    def _offer_by_key(self) -> None:
        """Open the menu of the selected body, or of the middle of the floor."""
        frame, body = self.player.frame, self.selected
        middle = self.viewpoint.room.center
        self._offer_at(self._point_at(middle) if body is None else frame.body_pose(body)[:2])

    def _offer(self, point: Point) -> None:
        """Select the thing at a point [m] of the picture, and open its menu."""
        self._tools.ruler.end()
        self._select_at(point)
        self._offer_at(point)

    def _offer_at(self, point: Point) -> None:
        """Open the menu of what can be done with what is selected, or at a point [m]."""
        ((x, y),) = self.camera.to_pixels([point]).astype(int).tolist()
        frame, body, live = self.player.frame, self.selected, self.director.timeline is not None
        if body is None:
            entries = entries_of_place(point, self._actions, self._tools.measure_from, live=live)
        else:
            entries = entries_of_body(frame, body, self._actions, live=live)
        self.toolbar.menu.open("offer", lambda: entries, (x, y))

    def _is_on(self, action: str) -> bool:
        return {
            "contacts": self.player.stops,
            "parameters": self.parameters.is_open,
            "scopes": self.scopes.is_open,
            "predictions": self._predictions.is_open,
            "lesson": self._lesson.is_open,
            "drive": self._drives,
            "follow": self.viewpoint.following is not None,
            "film": self.saver.filming,
        }.get(action, super()._is_on(action))

    # -- commands -------------------------------------------------------------------------------

    def _restart(self) -> None:
        """Start again, with the file as it is now."""
        self.grab.cancel()
        self.notes.clear()
        self.player.restart()
        self._meet()
        if self.game is not None and self._score is not None:
            self._score.wanted = True
            self.game.begin()

    def _switch_panel(self, name: str) -> None:
        """Show a panel, or no longer; or say what it lacks."""
        panel = next(panel for panel in self.dock.panels if panel.name == name)
        if panel.offered:
            self.dock.switch(name)
        else:
            self.notes.say(LACKS[name], "warning")

    def _stop_or_go_on(self) -> None:
        """Let time stop where contacts begin, or go on."""
        self.player.stops = not self.player.stops
        self.notes.say(f"time {'stops' if self.player.stops else 'goes on'} at contacts")

    def _to_contact(self, go: Callable[[], None]) -> None:
        """Go to a contact of the selected body, or of any; forces and its card are shown there."""
        self.player.body = self.selected
        super()._to_contact(go)
        self._impact.open()

    def _step_within(self, way: int) -> None:
        """Go to another moment within a control step; forces are shown there."""
        self.layers = self.layers.switched(forces=True, impulses=True)
        self.director.step_within(way)

    def _open_scopes(self) -> None:
        """Open the menu of plots."""

        def entries() -> list[Entry]:
            plots = entries_of_scopes(self.player.frame, self.selected, self.scopes)
            figure = Entry("Save the plots as a figure", self._actions["figure"])
            return [figure, *plots] if self.scopes.is_open else plots

        self.toolbar.open("scopes", entries)

    def _undo(self) -> None:
        """Undo the last thing done by hand; a drag ends."""
        self.grab.cancel()
        self.director.undo()

    def _close(self) -> None:
        """Close the window; if hands did something that would be lost, ask first, once."""
        timeline, menu = self.director.timeline, self.toolbar.menu
        if not self.asks or timeline is None or not timeline.changed or menu.name == "leave":
            super()._close()
            return
        self.editor = None
        self.player.pause()

        def save() -> None:
            self._open = not self.saver.record(timeline.record)

        entries, plot = entries_of_leaving(save, super()._close), self.layout.plot
        corner = plot.left + plot.width // 4, plot.top + plot.height // 4
        menu.open("leave", lambda: entries, corner)

    def _other_branch(self) -> None:
        """Show the branch that was left longest ago, or an earlier run."""
        self.grab.cancel()
        self.director.other_branch()
        self._meet()

    def _fit(self) -> None:
        """Show the whole workspace, beside all panels."""
        self.dock.reframe()
        super()._fit()

    def _follow_or_not(self) -> None:
        """Let the camera follow the selected body or all robots, or stop following."""
        self.viewpoint.follow(self.selected)
        if self.viewpoint.following is None:
            self.notes.say("the camera stays where it is; F shows all")
            return
        bodies = self.player.source.scenario.bodies
        who = "all robots" if self.selected is None else bodies[self.selected].name
        self.notes.say(f"the camera follows {who}; L ends it")

    def _end_activity(self) -> bool:
        """End a drag, measuring or driving, select nothing, pause a game; return whether it did."""
        if self.grab.busy:
            self.grab.cancel()
        elif self._tools.ruler.on:
            self._tools.ruler.end()
        elif self._drives and self.game is None:
            self.director.let_go()
        elif self.selected is not None:
            self.select(None)
        elif self.game is not None and self.player.playing and not self.notes.failed:
            self.player.pause()
            self.notes.say("paused: Space goes on, R begins again, Ctrl Q leaves")
        else:
            return False
        return True

    # -- saving, and changing the run -----------------------------------------------------------

    def _save_picture(self) -> None:
        """Save a picture of the arena, without the notes."""
        surface = pygame.Surface(self.layout.size, 0, 32)
        self.draw(surface, notes=False)
        self.saver.picture(self._arena(surface))

    def _arena(self, window: pygame.Surface) -> pygame.Surface:
        """Return the picture that a drawn window shows, without its own bars."""
        banner, frame = self._ending.banner(), self.player.frame
        return arena_of(window, self.layout, self._painter, frame, banner)

    def _to_sliders(self) -> None:
        """Let keys go to the sliders of parameters, which are shown."""
        if not self.parameters.is_open:
            self._switch_panel("parameters")
        self.parameters.focus_on(None)

    def _turn_panels(self, notches: int) -> None:
        """Scroll the panels that have more rows, as the wheel over them does."""
        turned = pygame.Event(pygame.MOUSEWHEEL, x=0, y=3 * notches)
        for panel in self.dock.panels:
            if isinstance(panel, RowsPanel) and panel.is_open and panel.cut:
                panel.handle(turned)

    def _set_parameter(self, name: str, value: float, restart: bool) -> str:
        """Set a parameter; return why the run starts again, or ""."""
        reason = self.director.set(name, value, restart)
        if reason and restart:
            self.grab.cancel()
        self._meet()
        return reason

    def _drive_or_not(self) -> None:
        """Drive the selected robot by hand, or the first one; or stop driving."""
        scenario = self.player.source.scenario
        if self.game is not None:
            self.notes.say("people drive until the end of the game; R begins again, Ctrl Q leaves")
        elif self._drives:
            self.director.let_go()
        elif self.selected is not None and self.selected >= len(scenario.robots):
            self.notes.say(f"{scenario.bodies[self.selected].name} has no drive", "warning")
        else:
            robot = self.selected or 0
            self.select(robot)
            self.director.drive(robot)

    def say_who_stands_still(self) -> None:
        """Say which robots of a drawn scenario nothing moves, or that nothing moves any."""
        timeline = self.director.timeline
        if timeline is None:
            return
        experiment = timeline.experiment
        idle = standing_still(experiment.scenario, experiment.control)
        drawn = experiment.source.path is not None and experiment.source.path.suffix == ".toml"
        all_idle = len(idle) == len(experiment.scenario.robots) and not experiment.scenario.props
        if not idle or not (drawn or all_idle):
            return
        first, want = next(iter(idle.items()))
        name = experiment.scenario.robots[first].name
        more = f", and {counted(len(idle) - 1, 'more robot')}" if len(idle) > 1 else ""
        stands = "stand" if more else "stands"
        self.notes.say(f"{name}{more} {stands} still: {name} lacks {want}", "warning")

    def play(self, robots: Sequence[int] = ()) -> None:
        """Make it a game, with people at these robots, or with roles that they choose."""
        self.game = Play(self.player, self.director)
        self._ending.of_game = True
        self._before = Countdown(self._painter, self.game)
        self._score = ScorePanel(self._painter, self.game)
        self.dock.panels = [*self.dock.panels, self._score]
        self.game.begin(robots)

    def _open_editor(self) -> None:
        """Open the editor on the scenario as it is now."""
        self._mouse.let_go()
        self.editor = self.director.editor(self.looks)
        if self.editor is not None:
            self.editor.viewpoint.look_as(self.viewpoint)

    def _close_editor(self, editor: Editor) -> None:
        """Close the editor, and apply its outcome."""
        self.editor = None
        self.viewpoint.look_as(editor.viewpoint)
        self._keyboard.clear()
        if editor.dialogs.outcome is not None:
            self.director.apply(editor.dialogs.outcome)
            self._meet()

    def _show_way_back(self, share: float) -> bool:  # noqa: ARG002
        """Say that a world goes back, which takes a while; return whether it may."""
        self.notes.say(f"going back to {self.player.frame.time:.1f} s; Esc stays here")
        surface = pygame.display.get_surface()
        if surface is not None:
            self.draw(surface)
            pygame.display.flip()
        leaving = pygame.event.get(pygame.QUIT)
        self._open = self._open and not leaving
        keys_down = pygame.event.get(pygame.KEYDOWN)
        return not leaving and all(event.key != pygame.K_ESCAPE for event in keys_down)


def _cast(source: Source) -> tuple[list[str | None], list[str | None]]:
    """Return the names of robots and of props."""
    scenario = source.scenario
    return [robot.name for robot in scenario.robots], [prop.name for prop in scenario.props]


def _path(source: Source) -> Path | None:
    """Return the file of an experiment."""
    return source.experiment.source.path if isinstance(source, Timeline) else None


def _stem(source: Source) -> str:
    """Return the name for saved files, without a number."""
    path = _path(source)
    return source.scenario.title if path is None else experiment_name(path)
