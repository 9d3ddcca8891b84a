"""The run window: watch an experiment, pause it, go back in it, intervene in it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from operator import is_
from typing import TYPE_CHECKING

import pygame

from mars2d.core.plane import Point
from mars2d.output.layers.table import Layers
from mars2d.output.raster.bars import Status
from mars2d.output.raster.layout import Layout
from mars2d.scenario.examples import experiment_name
from mars2d.scenario.scenario import Scenario
from mars2d.window.panels.panels import Panels
from mars2d.window.run import keys
from mars2d.window.run.arena import Arena
from mars2d.window.run.countdown import draw_countdown, entries_of_roles
from mars2d.window.run.director import Director
from mars2d.window.run.grab import Grab
from mars2d.window.run.menus import Offers
from mars2d.window.run.mouse import Pixel
from mars2d.window.run.play import Play
from mars2d.window.run.player_window import PlayerWindow
from mars2d.window.run.reload import Reload
from mars2d.window.run.score_panel import ScorePanel
from mars2d.window.run.toolbar import Toolbar
from mars2d.window.run.tools import Tools
from mars2d.window.screen.display import Preferences
from mars2d.window.screen.picking import Selection, body_at, next_body
from mars2d.window.screen.source import Playback, Source
from mars2d.window.screen.viewpoint import Viewpoint
from mars2d.window.widgets.actions import Action
from mars2d.window.widgets.notes import Notes
from mars2d.window.widgets.prompt import Answer
from mars2d.world.timeline import Timeline

if TYPE_CHECKING:
    from mars2d.window.editor import Editor

CHANGED = "This run was changed by hand, and is not saved."
TYPING = (pygame.KEYDOWN, pygame.TEXTINPUT, pygame.TEXTEDITING)
BY_HAND = (("↑ ↓ ← →", "drive"), ("Shift", "slowly"), ("H", "let go"), ("F1", "help"))
"""The keys that the footer names; a game's panel has its own."""


class Window(PlayerWindow):
    """Shows a source on the screen until the window is closed.

    speed: a factor of real time, 0 for one step a key press, or "max". size: at first, pixels.
    preferences: how the window looks.

    director changes the run as a person asks, grab is the mouse, dock has the panels, tools are
    those in the hand; arena draws the picture, editor and game are there while people draw or play.
    """

    def __init__(
        self,
        source: Source,
        speed: float | str = 1.0,
        size: tuple[int, int] = (1280, 720),
        preferences: Preferences | None = None,
    ) -> None:
        """Prepare; the window opens with `run`."""
        path = source.experiment.source.path if isinstance(source, Timeline) else None
        title = source.scenario.title
        stem = title if path is None else experiment_name(path)
        super().__init__(source, speed, size, preferences, title=title, stem=stem)
        self.layers = self.layers.switched(neighbours=True)
        self.asks = False  # before a run is lost that can't just be run again
        self.editor: Editor | None = None
        self.game: Play | None = None  # where people play
        self.selection, painter = Selection(), self.looks.painter
        self.director = Director(self.player, self.notes, self._show_way_back)
        self.tools = Tools(self.player, self.director, self.selection, self.notes, self.prompts)
        self.dock = Panels(
            painter, self.player, self.selection, path, self.director.set, self.notes, self.saver
        )
        bounds = source.bounds if isinstance(source, Playback) else None
        self.viewpoint = Viewpoint(source.scenario, self._layout(size), bounds)
        self._leave_out_names(self.layout.ui)
        clicks = {pygame.BUTTON_LEFT: self._select_at, pygame.BUTTON_RIGHT: self._offer}
        change, view = self.director.change, self.viewpoint
        self.mouse = self.grab = Grab(self.player, view, self.handles, self._place, change, clicks)
        self._arena = Arena(source, self.grab, self.selection, self.tools, self.dock)
        timeline = self.director.timeline
        self._reload = None if timeline is None else Reload(timeline, self._show_way_back)
        self._seen: tuple[object, object] = (None, None)  # the scenario and the experiment
        self._cast = _cast(source.scenario)
        acts, scopes = self._actions, self.dock.scopes
        self._offers = Offers(self.player, self.selection, self.tools, scopes, acts)
        acts |= {
            "contacts": self._stop_or_go_on,
            "source": lambda: self._ending.open_source(self.notes),
            "within": partial(self._step_within, 1),
            "within_back": partial(self._step_within, -1),
            "branch": self._other_branch,
            "undo": self._undo,
            "scopes": lambda: self.toolbar.open("scopes", self._offers.plots),
            "select": lambda: self.select(next_body(self.player.frame, self.selected)),
            "follow": self._follow_or_not,
            "offer": self._offer_at,
            "drive": self._drive_or_not,
            "edit": self._open_editor,
            **self.tools.actions,
            **self.dock.actions,
        }
        there = {name: act for name, act in acts.items() if name not in self.dock.lacking}
        self.toolbar = Toolbar(there, self._is_on, self.menu, live=timeline is not None)

    @property
    def selected(self) -> int | None:
        """The selected body, an index of `Scenario.bodies`."""
        return self.selection.body

    def select(self, body: int | None) -> None:
        """Select a body, or none."""
        self.selection.body = body

    @property
    def remembered(self) -> dict[str, object]:
        """How the window looks, to be remembered: size [points], colours, size of text, panels."""
        return self.looks.remembered(self.layout.size) | {"panels": self.dock.opened}

    def run(self) -> None:
        """Do what any window does, and show what laws print."""
        with self.dock.printed.listening():
            super().run()

    def play(self, robots: Sequence[int] = ()) -> None:
        """Make it a game, with people at these robots, or with roles that they choose."""
        self.game = Play(self.player, self.director)
        self._ending.of_game = True
        self.dock.panels = [*self.dock.panels, ScorePanel(self.looks.painter, self.game)]
        self.game.begin(robots)
        if not self.game.seats:
            self._offer_roles(self.game)

    def _offer_roles(self, game: Play) -> None:
        self.menu.open("roles", partial(entries_of_roles, game), (0, 0), stays=True)

    # -- time -----------------------------------------------------------------------------------

    def _answer(self, where: str) -> str:
        broken_off = super()._answer(where)
        if not broken_off and self._reload is not None and self._reload.waits():
            return "did not return before its file was saved"
        return broken_off

    @property
    def _moves(self) -> bool:
        counts = self.game is not None and self.game.counting > 0
        drives = self.director.drives and self.game is None
        acts = self.grab.busy or self.editor is not None
        return counts or drives or acts or self.viewpoint.following or super()._moves

    def _pass_time(self, seconds: float) -> None:
        if self.editor is not None:
            return
        self._read_again()
        self._meet()
        if self.game is not None:
            if self.game.pass_time(seconds):
                self._rest.stir()
            if not (self.game.seats or self.menu.is_open):
                self._offer_roles(self.game)
        self.director.steer(seconds)
        self.grab.tick(self._pointer)
        self.dock.parameters.tick()
        self.player.pass_time(seconds)
        if self.dock.predictions.look(playing=self.player.playing):
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

    def _meet(self) -> None:
        """Where the run has become another, release and deselect bodies that it may not have."""
        scenario, timeline = self.player.source.scenario, self.director.timeline
        now = scenario, None if timeline is None else timeline.experiment
        if all(map(is_, now, self._seen)):
            return
        self._seen = now
        self.dock.scopes.meet(scenario)
        if self._cast != (cast := _cast(scenario)):
            self._cast, self.viewpoint.following = cast, False
            self.select(None)
            self.director.release()
            self.grab.let_go()
            self.grab.over = None

    # -- drawing --------------------------------------------------------------------------------

    def draw(self, surface: pygame.Surface, *, notes: bool = True) -> None:
        """Draw the window or its editor on a surface; the layout follows its size."""
        if self.editor is not None:
            self.editor.draw(surface)
        else:
            super().draw(surface, notes=notes)

    def _draw_picture(self, surface: pygame.Surface, layout: Layout, layers: Layers) -> None:
        frame, drives = self.grab.shown(self.player.frame), self.director.drives
        self._arena.draw(surface, layout, frame, layers, self._pointer, drives=drives)
        room, painter = self.viewpoint.room, self.looks.painter
        if self.game is not None and self.game.counting:
            draw_countdown(surface, room, painter, self.game.counting)
        if self.menu.name == "roles":
            plate = pygame.Rect((0, 0), self.menu.size(painter))
            plate.center = room.center
            self.menu.corner = plate.topleft

    @property
    def _hints(self) -> Sequence[tuple[str, str]]:
        if self.game is not None:
            keys_of = [(" ".join(seat.keys), seat.role or "drive") for seat in self.game.seats]
            return [*keys_of, ("Space", "pause"), ("F1", "help")]
        if not self.director.drives:
            return super()._hints
        return BY_HAND if self.player.playing else (("Space", "go on"), *BY_HAND)

    def _helps(self) -> Iterator[tuple[str, Sequence[Action]]]:
        yield from super()._helps()
        yield "Mouse", keys.MOUSE

    def _draw_notes(self, surface: pygame.Surface) -> None:
        off, painter = self._arena.selected_pixel(self.player.frame), self.looks.painter
        plot, now = self.layout.plot, time.monotonic()
        if self.editor is None:
            self.notes.draw(surface, plot, painter, now, self.dock.free, off)

    def _status(self) -> Status:
        text, kind = self.player.status()
        if self.game is not None and self.game.counting:
            return Status("get ready", "waiting")
        if self.game is not None and self.player.playing and kind == "running":
            return Status(text, "hand")
        drives = self.director.drives and self.game is None
        if drives and kind != "error" and not self.player.over:
            return Status(f"{text}  {self.director.status}", "hand")
        return Status(text, kind)

    def arena(self) -> pygame.Surface:
        """Return a picture of the arena alone, without any bars."""
        self.editor = None
        return self._drawn().subsurface(self.layout.plot)

    def _picture(self, window: pygame.Surface) -> pygame.Surface:
        return window if self.editor is not None else super()._picture(window)

    # -- events ---------------------------------------------------------------------------------

    def _take(self, event: pygame.Event) -> bool:
        if self.editor is None and self.menu.is_open and self.toolbar.handle(event):
            return True
        if self.director.handle(event):
            return True
        if self.editor is not None:
            self.editor.handle(event)
            if self.editor.dialogs.done:
                self._close_editor(self.editor)
            return True
        if self.game is not None and self.game.handle(event):
            return True
        if self.toolbar.handle(event):
            return True
        if not self.help.is_open and self.dock.handle(event):
            return True
        elsewhere = self.help.is_open or self.director.drives
        return event.type in TYPING and not elsewhere and self.dock.parameters.press(event)

    def _point(self, event: pygame.Event) -> None:
        if event.type == pygame.MOUSEBUTTONDOWN:
            self.dock.parameters.leave()
            if self.player.failed and self.layout.footer.collidepoint(event.pos):
                self._ending.open_source(self.notes)
        super()._point(event)

    def _place(self, pixel: Pixel) -> Pixel | None:
        """Return a pixel of the picture, if nothing lies over it."""
        over = self.help.is_open or self.dock.covers(pixel) or self.toolbar.covers(pixel)
        return pixel if self.layout.plot.collidepoint(pixel) and not over else None

    def _is_on(self, action: str) -> bool:
        return self.dock.is_on(action) or {
            "contacts": self.player.stops,
            "drive": self.director.drives,
            "follow": self.viewpoint.following,
        }.get(action, super()._is_on(action))

    # -- selecting, and menus -------------------------------------------------------------------

    def _select_at(self, point: Point) -> None:
        """Select the body at a point [m] of the picture, or nothing; or measure there."""
        body = body_at(self.player.frame, point, self.grab.click / self.camera.scale)
        if self.tools.ruler.on:
            self.tools.ruler.mark(point if body is None else body)
        else:
            self.select(body)

    def _offer(self, point: Point) -> None:
        """Select the thing at a point [m] of the picture, and open its menu."""
        self.tools.ruler.end()
        self._select_at(point)
        self._offer_at(point)

    def _offer_at(self, point: Point | None = None) -> None:
        """Open the menu of what is selected, or of a point [m] of the floor, else of its middle."""
        if point is None:
            middle = self.viewpoint.point_at(self.viewpoint.room.center)
            body, frame = self.selected, self.player.frame
            point = middle if body is None else frame.body_pose(body)[:2]
        ((x, y),) = self.camera.to_pixels([point]).astype(int).tolist()
        entries = self._offers.at(point)
        self.menu.open("offer", lambda: entries, (x, y))

    # -- commands -------------------------------------------------------------------------------

    def _other_branch(self) -> None:
        """Show the branch that was run before a change."""
        self.grab.let_go()
        self.director.other_branch()

    def _undo(self) -> None:
        """Undo what was done by hand; people who play go on from there."""
        self.grab.let_go()
        self.director.undo()
        if self.game is not None and self.game.seats:
            self.game.begin()

    def _restart(self) -> None:
        self.grab.let_go()
        super()._restart()
        if self.game is not None:
            self.dock.named("score").open()
            self.game.begin()

    def _stop_or_go_on(self) -> None:
        """Let time stop where contacts begin, or go on."""
        self.player.stops = not self.player.stops
        self.notes.say(f"time {'stops' if self.player.stops else 'goes on'} at contacts")

    def _to_contact(self, go: Callable[[], None]) -> None:
        """Go to a contact of the selected body, or of any; forces and its card are shown there."""
        self.player.body = self.selected
        super()._to_contact(go)
        self.dock.impact.open()

    def _step_within(self, way: int) -> None:
        """Go to another moment within a control step; forces are shown there."""
        self.layers = self.layers.switched(forces=True, impulses=True)
        self.director.step_within(way)

    def _fit(self) -> None:
        """Show the whole workspace, beside all panels."""
        self.dock.reframe()
        super()._fit()

    def _follow_or_not(self) -> None:
        """Let the camera follow the selected body or all robots, or stop following."""
        self.viewpoint.follow(self.selected)
        if not self.viewpoint.following:
            self.notes.say("the camera stays where it is; F shows all")
            return
        bodies = self.player.source.scenario.bodies
        who = "all robots" if self.selected is None else bodies[self.selected].name
        self.notes.say(f"the camera follows {who}; L ends it")

    def _drive_or_not(self) -> None:
        """Drive the selected robot by hand, or the first one; or stop driving."""
        if self.game is not None:
            self.notes.say("people drive until the end of the game; R begins again, Ctrl Q leaves")
        elif self.director.drives:
            self.director.let_go()
        else:
            self.select(self.selected or 0)
            self.director.drive(self.selected or 0)

    def _end_activity(self) -> bool:
        """End a drag, measuring or driving, select nothing, pause a game; return whether it did."""
        if self.grab.busy:
            self.grab.let_go()
        elif self.tools.ruler.on:
            self.tools.ruler.end()
        elif self.director.drives and self.game is None:
            self.director.let_go()
        elif self.dock.impact.is_open:
            self.dock.impact.close()
        elif self.selected is not None:
            self.select(None)
        elif self.game is not None and self.player.playing and not self.notes.failed:
            self.player.pause()
            self.notes.say("paused: Space goes on, R begins again, Ctrl Q leaves")
        else:
            return False
        return True

    def _close(self) -> None:
        """Close the window; if hands did something that would be lost, ask first, once."""
        timeline, open_one = self.director.timeline, self.prompts.prompt
        asked = open_one is not None and open_one.label == CHANGED
        if asked or not self.asks or timeline is None or not timeline.changed:
            super()._close()
            return
        self.editor = None
        self.player.pause()

        def save(_: str) -> None:
            self._open = not self.saver.record(timeline.record)

        leave = Answer(
            "leave without it", lambda _: PlayerWindow._close(self), keys.LEAVE.labels[0]
        )
        self.prompts.ask(CHANGED, Answer("save it, and leave", save), leave, escape="stay")

    def _open_editor(self) -> None:
        """Open the editor on the scenario as it is now."""
        self.grab.cancel()
        self.editor = self.director.editor(self.looks)
        if self.editor is not None:
            self.editor.viewpoint.look_as(self.viewpoint)

    def _close_editor(self, editor: Editor) -> None:
        """Close the editor, and apply its outcome."""
        self.editor = None
        self.viewpoint.look_as(editor.viewpoint)
        self._held.clear()
        if editor.dialogs.outcome is not None:
            self.director.apply(editor.dialogs.outcome)

    def _show_way_back(self, share: float) -> bool:  # noqa: ARG002
        """Say that a world goes back, which takes a while; return whether it may."""
        surface, way = pygame.display.get_surface(), Notes()
        if surface is not None:
            self.draw(surface, notes=False)
            way.say(f"going back to {self.player.frame.time:.1f} s; Esc stays here")
            way.draw(surface, self.layout.plot, self.looks.painter, time.monotonic())
            pygame.display.flip()
        leaving = pygame.event.get(pygame.QUIT)
        self._open = self._open and not leaving
        keys_down = pygame.event.get(pygame.KEYDOWN)
        return not leaving and all(event.key != pygame.K_ESCAPE for event in keys_down)


def _cast(scenario: Scenario) -> tuple[list[str | None], list[str | None]]:
    """Return the names of robots and of props."""
    return [robot.name for robot in scenario.robots], [prop.name for prop in scenario.props]
