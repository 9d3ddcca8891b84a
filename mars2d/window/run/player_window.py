"""A window that plays a source: the base of the run window and of the window of a comparison."""

from __future__ import annotations

import sys
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import combinations
from math import dist, inf
from threading import Lock

import pygame

from mars2d.core.deadline import Deadline, patience
from mars2d.core.errors import Mars2dError
from mars2d.core.interrupt import give_up
from mars2d.output.layers.table import LAYERS, Layers
from mars2d.output.raster.bars import Status, draw_footer, draw_header, footer_height
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.layout import Layout
from mars2d.output.raster.picture import arena_of, summary
from mars2d.window.run import keys
from mars2d.window.run.ending import Ending
from mars2d.window.run.menus import layer_entries
from mars2d.window.run.mouse import Handle, Mouse, Pixel
from mars2d.window.run.timebar import TimeBar, costs
from mars2d.window.run.toolbar import Toolbar
from mars2d.window.screen.display import PICTURES_A_SECOND, Preferences, started_display
from mars2d.window.screen.looks import Looks
from mars2d.window.screen.player import SPEEDS, Player
from mars2d.window.screen.rest import Rest
from mars2d.window.screen.saving import Saver
from mars2d.window.screen.source import Source, Trio
from mars2d.window.screen.viewpoint import Viewpoint
from mars2d.window.widgets.actions import Action, action_of, label_of
from mars2d.window.widgets.help import Help
from mars2d.window.widgets.menu import Menu
from mars2d.window.widgets.notes import Notes
from mars2d.window.widgets.prompt import Prompts
from mars2d.window.widgets.slider import SpeedSlider
from mars2d.world.timeline import Timeline

HINTS = (
    ("Space", "pause"), ("← →", "step"), ("+ \N{MINUS SIGN}", "speed"), ("F1", "help"),
)  # fmt: skip
NAME = 20.0
"""How far bodies are apart at the start where their names are drawn at first, points."""
LEAP = 10
"""How many steps PgDn and PgUp do."""
ZOOM = 2.0
"""How far a key zooms, in notches of the wheel."""
THEIRS = ("sensors", "messages", "neighbours", "theory", "addons")
"""The layers that the user's code may draw."""


class PlayerWindow(ABC):
    """Opens a window, plays a source in it, and answers keys and mouse until it is closed.

    title: of the window. size: at first, points. stem: the name of saved files, without a number.

    A subclass makes `viewpoint`, `mouse` with the `handles`, and `toolbar`.
    """

    viewpoint: Viewpoint
    mouse: Mouse
    toolbar: Toolbar

    def __init__(
        self,
        source: Source,
        speed: float | str,
        size: tuple[int, int],
        preferences: Preferences | None,
        *,
        title: str,
        stem: str,
        marked: Source | None = None,
    ) -> None:
        """Prepare; the window opens with `run`. marked: whose events the time bar marks."""
        self.player = player = Player(source, speed)
        self.size, self.title = size, f"{title} - MARS2D"
        self.layers = Layers.of(source.scenario.animation)
        self.help, self.notes, self.menu = Help(), Notes(), Menu()
        self.prompts = Prompts(self.menu)
        self.looks = Looks(preferences, self.notes.say)
        self.saver = Saver(self.notes, stem)
        self.time_bar, self.slider = TimeBar(self.player, marked or source), SpeedSlider(SPEEDS)
        self.handles = [
            Handle(self.time_bar.hit, self.time_bar.go),
            Handle(self.slider.hit, self._choose_speed),
        ]
        self._ending = Ending(self.player)
        self._held, self._rest = set[int](), Rest()  # keys; a held one repeats few actions
        self._open = False
        self._passing = False  # whether laws may be asked
        self._limit = Deadline(patience(), give_up, self._calls, self._answer)
        self._screen = Lock()  # held by the thread that draws
        self._actions: dict[str, Callable[[], None]] = {
            "pause": player.pause_or_resume,
            "step": player.step,
            "back": player.back,
            "leap": partial(player.step, LEAP),
            "leap_back": partial(player.back, LEAP),
            "start": partial(player.go, 0),
            "newest": lambda: player.go(player.source.newest),
            "faster": player.faster,
            "slower": player.slower,
            "contact": lambda: self._to_contact(self.player.next_contact),
            "contact_back": lambda: self._to_contact(self.player.last_contact),
            "restart": self._restart,
            "layers": lambda: self.toolbar.open(
                "layers", lambda: layer_entries(self.layers, self._toggle)
            ),
            **{layer.name: partial(self._toggle, layer.name) for layer in LAYERS if layer.key},
            "nearer": lambda: self.viewpoint.zoom(ZOOM, self.layout.plot.center),
            "farther": lambda: self.viewpoint.zoom(-ZOOM, self.layout.plot.center),
            "fit": self._fit,
            **self.looks.actions,
            "picture": lambda: self.saver.picture(self._picture(self._drawn())),
            "film": self.saver.film_or_not,
            "help": self.help.turn,
            "leave": self._close,
            "escape": self._escape,
        }

    @property
    def camera(self) -> Camera:
        """The camera."""
        return self.viewpoint.camera

    @property
    def layout(self) -> Layout:
        """The layout."""
        return self.viewpoint.layout

    def run(self) -> None:
        """Open the window and play until it is closed; then raise the error of a failed law.

        Ctrl+C in the terminal closes the window and raises KeyboardInterrupt. Raises InputError
        without a display.
        """
        with started_display():
            try:
                pygame.display.set_caption(self.title)
                screen = self.looks.open(self.size)
                self._open = True
                self._show_picture(screen)  # before the first law is asked: it may take long
                with self._limit:
                    self._loop(screen)
            finally:
                self.saver.close()
        if self.player.error is not None:
            raise self.player.error

    # -- time -----------------------------------------------------------------------------------

    def _loop(self, screen: pygame.Surface) -> None:
        clock, last = pygame.time.Clock(), time.perf_counter()
        while self._open:
            for event in self._rest.events():
                self._handle(event)
            now = time.perf_counter()
            self._passing = True
            self._pass_time(now - last)
            self._passing = False
            last = now
            if self._moves:
                self._rest.stir()
            if not self._rest.resting and (pygame.display.get_active() or self.saver.filming):
                self._show_picture(pygame.display.get_surface() or screen)
            clock.tick(PICTURES_A_SECOND)

    def _pass_time(self, seconds: float) -> None:
        """Advance by seconds of the wall clock."""
        self.player.pass_time(seconds)

    @property
    def _moves(self) -> bool:
        """Whether the next picture may differ from this one though nobody does anything."""
        goes_on = self.player.playing or self.player.busy
        return goes_on or self.saver.filming or len(self.notes) > 0

    def _show_picture(self, screen: pygame.Surface) -> None:
        """Draw the window and put it on the screen."""
        start = time.perf_counter()
        with self._screen:
            self._paint(screen)
            pygame.display.flip()
        self.player.drawing = time.perf_counter() - start

    def _paint(self, screen: pygame.Surface) -> None:
        """Draw the next picture of the loop, and add it to the film."""
        self.draw(screen)
        if self.saver.filming:
            plot, painter = self.layout.plot, self.looks.painter
            self.saver.film(self._picture(screen), screen, plot, painter)
            self._draw_notes(screen)  # which are not part of the film

    # -- waiting for a law ----------------------------------------------------------------------

    def _calls(self) -> object:
        """Return a value that changes with each call of the user's code."""
        source = self.player.source
        runs = source.runs.values() if isinstance(source, Trio) else [source]
        return [run.world.simulation.calls for run in runs if isinstance(run, Timeline)]

    def _answer(self, where: str) -> str:
        """Answer the user while a law takes long at a line; return why to break it off, or ""."""
        blocked = self._limit.blocked
        if self._passing:
            how = "Ctrl Q ends the program, and saves" if blocked else "Esc breaks it off"
            self.notes.say(f"waiting for {where}; {how}", kind="warning")
        surface = pygame.display.get_surface()
        draws = not (blocked and sys.platform == "darwin")
        # A drawing that takes long is not waited for: it may be this thread's own.
        if surface is not None and draws and self._screen.acquire(blocking=False):
            try:  # a call in C may end while another thread draws
                self.draw(surface)
                pygame.display.flip()
            finally:
                self._screen.release()
        pygame.event.pump()
        closed = pygame.event.peek(pygame.QUIT)
        moved = pygame.event.get((pygame.KEYDOWN, pygame.KEYUP))
        for event in moved:  # for later, in their order
            if event.key != pygame.K_ESCAPE:
                pygame.event.post(event)
        pressed = {label_of(each) for each in moved if each.type == pygame.KEYDOWN}
        if closed or not pressed.isdisjoint((*keys.LEAVE.labels, *keys.LEAVE.also)):
            self._open = False
            return "did not return before the window was closed"
        broken_off = "Esc" in pressed and not blocked
        return "did not return before Esc was pressed" if broken_off else ""

    # -- drawing --------------------------------------------------------------------------------

    def draw(self, surface: pygame.Surface, *, notes: bool = True) -> None:
        """Draw the window on a surface; the layout follows its size. notes: and what lies over."""
        painter, drag, pointer = self.looks.painter, self.mouse.drag, self._pointer
        layout = self._layout(surface.get_size())
        painter.ui = layout.ui
        try:
            self._draw_picture(surface, layout, self.layers)
        except Mars2dError as error:  # raised by the drawing of an add-on or a sensor
            self.player.fail(error)
            own = self.layers.switched(**dict.fromkeys(THEIRS, False))
            self._draw_picture(surface, layout, own)
        if notes and not self.saver.filming:
            self._draw_notes(surface)
        frame, (bar, slider) = self.player.frame, self.handles[:2]
        draw_header(surface, layout, painter, frame, self._status())
        self.time_bar.draw(surface, layout.timebar, painter, pointer, held=drag is bar)
        self.slider.draw(
            surface, layout.slider, painter, self.player.speed, pointer=pointer,
            held=drag is slider, costs=costs(self.player),
        )  # fmt: skip
        banner, words = self._ending.banner(), summary(frame)
        draw_footer(surface, layout, painter, banner, words, self._hints)
        if notes:
            self.toolbar.draw(surface, layout, painter, pointer)
        if self.help.is_open:
            self.help.draw(surface, layout, painter, [*self._helps()])

    def _drawn(self) -> pygame.Surface:
        """Return a picture of the window without notes and menus."""
        surface = pygame.Surface(self.layout.size, 0, 32)
        self.draw(surface, notes=False)
        return surface

    def _picture(self, window: pygame.Surface) -> pygame.Surface:
        """Return the picture that a drawn window shows, without its own bars."""
        banner, layout = self._ending.banner(), self._layout(window.get_size())
        return arena_of(window, layout, self.looks.painter, self.player.frame, banner)

    @abstractmethod
    def _draw_picture(self, surface: pygame.Surface, layout: Layout, layers: Layers) -> None:
        """Draw what is between the bars."""

    def _draw_notes(self, surface: pygame.Surface) -> None:
        plot = self._layout(surface.get_size()).plot  # of all arenas
        self.notes.draw(surface, plot, self.looks.painter, time.monotonic())

    def _status(self) -> Status:
        """Return the words beside the time."""
        return Status(*self.player.status())

    @property
    def _hints(self) -> Sequence[tuple[str, str]]:
        """The keys that the footer names."""
        return HINTS

    def _helps(self) -> Iterator[tuple[str, Sequence[Action]]]:
        """Yield what the help tells, in groups: the keys that do something here."""
        for group, each in keys.GROUPS.items():
            yield group, [key for key in each if key.name in self._actions]

    def _layout(self, size: tuple[int, int]) -> Layout:
        """Return the layout on a surface of this size."""
        looks = self.looks
        banner = self._ending.banner()
        height = footer_height(banner, size, looks.painter, looks.text, looks.scale)
        return looks.layout(size, height, controls=True)

    def _leave_out_names(self, ui: float) -> None:
        """Draw no names at first where bodies are so near that these would cover each other."""
        places = [body.pose[:2] for body in self.player.source.scenario.bodies]
        apart = min((dist(*pair) for pair in combinations(places, 2)), default=inf)
        fits = apart * self.camera.scale > NAME * ui
        self.layers = self.layers.switched(names=self.layers.names and fits)

    @property
    def _pointer(self) -> tuple[int, int] | None:
        """Where the mouse is, if it is on the open window."""
        return pygame.mouse.get_pos() if self._open and pygame.mouse.get_focused() else None

    # -- events ---------------------------------------------------------------------------------

    def _handle(self, event: pygame.Event) -> None:
        if event.type == pygame.QUIT:
            self._close()
        elif self._take(event):
            pass
        elif event.type == pygame.KEYDOWN:
            self._press(event)
        elif event.type == pygame.KEYUP:
            self._held.discard(event.key)
        elif event.type == pygame.WINDOWFOCUSLOST:
            self._held.clear()
        else:
            self._point(event)

    def _take(self, event: pygame.Event) -> bool:
        """Give an event to the parts of the window; return whether one of them took it."""
        return self.toolbar.handle(event)

    def _point(self, event: pygame.Event) -> None:
        """Handle an event of the mouse on the picture and the bars."""
        self.mouse.handle(event)

    def _press(self, event: pygame.Event) -> None:
        action, held = action_of(event, keys.ACTIONS), event.key in self._held
        self._held.add(event.key)
        if action is not None and action.name in self._actions and (action.repeats or not held):
            self._actions[action.name]()

    def _is_on(self, action: str) -> bool:
        """Return whether the setting that a button switches is on."""
        return {
            "pause": self.player.playing,
            "layers": self.menu.name == "layers",
            "help": self.help.is_open,
            "film": self.saver.filming,
        }.get(action, self.looks.is_on(action))

    # -- commands -------------------------------------------------------------------------------

    def _choose_speed(self, pixel: Pixel) -> None:
        """Play at the speed at a pixel of the slider."""
        self.player.set_speed(self.slider.speed_at(pixel[0]))

    def _restart(self) -> None:
        """Start again, with the file as it is now."""
        self.notes.clear()
        self.player.restart()

    def _to_contact(self, go: Callable[[], None]) -> None:
        """Go to a contact; forces are shown there."""
        self.layers = self.layers.switched(forces=True, impulses=True)
        go()

    def _fit(self) -> None:
        """Show the whole workspace."""
        self.viewpoint.fit()

    def _toggle(self, layer: str, *, alone: bool = False) -> None:
        self.layers = self.layers.toggled(layer, alone=alone)

    def _close(self) -> None:
        """Close the window."""
        self._open = False

    def _escape(self) -> None:
        """Close the help, end an activity, or clear errors; a window is never closed by Esc."""
        if self.help.is_open:
            self.help.close()
        elif self._end_activity():
            pass
        elif self.notes.failed:
            self.notes.clear()
        else:
            self.notes.say("Ctrl Q closes the window")

    def _end_activity(self) -> bool:
        """End the last activity of the user's, such as a drag; return whether there was one."""
        return False
