"""The panel of parameters: a slider for each number of the experiment that can be set."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from math import floor, inf, log10
from typing import Literal

import pygame

from mars2d.core.errors import InputError, Mars2dError
from mars2d.output.controls import CONTROLS
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.scenario.experiment import Experiment
from mars2d.scenario.parameters import PREFIX, Parameter
from mars2d.window.screen.picking import Selection
from mars2d.window.screen.player import Player
from mars2d.window.screen.source import RECORDING
from mars2d.window.widgets.buttons import draw_icon
from mars2d.window.widgets.panel import LINE, Panel
from mars2d.window.widgets.rows import Pixel, Row, Word, write_line
from mars2d.window.widgets.slider import Slider
from mars2d.window.widgets.text_field import TextField
from mars2d.world.timeline import Timeline

Line = tuple[str, Parameter | None]
"""A heading, or a name in words and its parameter."""
Say = Literal["info", "error"]

Set = Callable[[str, float, bool], str]
"""Sets a parameter: its name, its value, and whether the run may start again for it. Returns why it
does or would, or ""; raises InputError for values that it can't have."""

ROW, HEADING, SIZE = 38.0, 24.0, 13.0
"""The heights of a row, of a heading and of letters, points."""
NAME, PAD = 20.0, 6.0
"""The height of a row's name, above its slider, and the gap beside both, points."""
RESET = 18.0
"""The side of the button at the end of a row that puts it back, points."""
LINES, MAX_LINES = 2, 4
"""How many lines of the panel's message have room, and how many there are at most."""
LEAST_ROWS = 3
"""The rows that are seen at least."""
EVERY = 0.1
"""The least time between two settings during a drag, seconds."""
SHARE = 0.25
"""The largest share of the time that settings may take during a drag."""
TYPED = "0123456789.-e"
"""The characters of a number."""
MAX_TYPED, TYPED_WIDTH = 12, 104.0
"""The longest number that can be typed, and the width of its field, points."""


class ParameterPanel(Panel):
    """Shows the parameters of an experiment, and of the body that is selected, as sliders.

    A slider is dragged, or moved by arrow keys once it was clicked; a number that is typed then is
    taken by Enter. The button at its right puts it back as the file has it.

    player: of the experiment; while time passes, a drag is felt at once. set_to: sets a parameter.
    """

    name, title = "parameters", "Parameters"
    least = LEAST_ROWS * ROW + HEADING + LINES * LINE + 4

    def __init__(
        self,
        painter: Painter,
        player: Player,
        selection: Selection,
        set_to: Set,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Start with nothing drawn and nothing said."""
        super().__init__(painter)
        self._player, self._selection = player, selection
        self._set_to, self._clock = set_to, clock
        self.lacks = "" if isinstance(player.source, Timeline) else RECORDING
        self._known: tuple[Experiment | None, int | None] = None, None
        self._lines: list[Line] = []
        self._sliders: dict[str, Slider] = {}
        self.resets: dict[str, pygame.Rect] = {}  # buttons, by the names of parameters
        self.focus: str | None = None  # the parameter that keys go to
        self.typed = TextField(accepts=TYPED, most=MAX_TYPED)  # a number
        self.said: tuple[str, Say] = "", "info"
        self._held: str | None = None
        self._value = 0.0  # of what is held
        self._anew = ""  # why it needs a new start
        self._next = 0.0  # when it may be set

    # -- what there is ------------------------------------------------------------------------

    def parameters(self) -> dict[str, Parameter]:
        """Return the parameters by name."""
        return {each.name: each for _, each in self._look() if each is not None}

    def _look(self) -> list[Line]:
        """Return the lines; the parameters are read again where something was set or selected."""
        source, body = self._player.source, self._selection.body
        experiment = source.experiment if isinstance(source, Timeline) else None
        (before, last), self._known = self._known, (experiment, body)
        if experiment is None or (experiment is before and body == last):
            return self._lines
        try:
            self._lines = list(_lines(experiment, body))
        except InputError as error:  # of a Range of a law
            self._lines, self.said = [("No parameters", None)], (str(error), "error")
        if body is not None and body != last:  # let its sliders be seen
            self.scroll.at, self.sought = inf, self._first
        if self.focus not in {each.name for _, each in self._lines if each is not None}:
            self.leave()
        return self._lines

    @property
    def _first(self) -> str:
        """The name of the first parameter of what is selected, else of all; "" for none."""
        names = ["" if each is None else each.name for _, each in self._look()]
        last = max((k for k, name in enumerate(names) if not name), default=0)
        return next(filter(None, [*names[last:], *names]), "")

    # -- drawing ------------------------------------------------------------------------------

    def rows(self, frame: Frame, width: float) -> Sequence[Row]:  # noqa: ARG002
        """Return the headings, and a row for each parameter."""
        color, self.resets = self.painter.theme.muted, {}
        return [
            self.line([Word(text, color, bold=True)], high=HEADING)
            if parameter is None
            else Row(ROW, partial(self._draw_row, text, parameter), parameter.name)
            for text, parameter in self._look()
        ]

    def foot(self, width: float) -> Sequence[Row]:
        """Return the effect of the last setting, or else words about the slider with the focus."""
        text, kind = self._words()
        color = self.painter.theme.error.ink if kind == "error" else self.painter.theme.muted
        lines = [*self.wrapped(Word(text, color), width, MAX_LINES)]
        return [self.gap(4), *lines, *[self.gap(LINE)] * (LINES - len(lines))]

    def _draw_row(
        self, text: str, parameter: Parameter, surface: pygame.Surface, place: pygame.Rect
    ) -> None:
        """Draw a name, its value, the button that puts it back, and below them the slider."""
        ui, theme, pad = self.painter.ui, self.painter.theme, round(PAD * self.painter.ui)
        name, held = parameter.name, parameter.name == self._held
        if name == self.focus:
            self.painter.panel(surface, place, theme.key, 5 * ui, theme.selected)
        value = self._value if held else parameter.value
        changed = value != parameter.default
        above = pygame.Rect(place.left + pad, place.top, place.width - 2 * pad, round(NAME * ui))
        line = pygame.Rect(above.bottomleft, (above.width, place.bottom - above.bottom))
        if changed and not held:
            reset = pygame.Rect(0, 0, round(RESET * ui), round(RESET * ui))
            reset.midright = above.right + pad // 2, above.centery
            draw_icon(surface, CONTROLS["restart"].icon, theme.muted, reset.inflate(8, 8))
            self.resets[name] = reset
            above.width = reset.left - pad // 2 - above.left
        words = [Word(_number(parameter, value), theme.ink, SIZE, bold=changed)]
        if name == self.focus and self.typed.text:
            box = pygame.Rect(0, 0, round(TYPED_WIDTH * ui), round((NAME - 3) * ui))
            box.midright, words = above.midright, []
            self.painter.panel(surface, box, theme.paper, 4 * ui, theme.selected)
            self.typed.draw(surface, box.inflate(-round(10 * ui), 0), self.painter, SIZE * ui)
            above.width = box.left - 2 * pad - above.left
        write_line(surface, above, self.painter, [Word(text, theme.text, SIZE)], words)
        slider = self._sliders[name] = Slider(parameter.low, parameter.high)
        line = line.inflate(-round(12 * ui), -round(4 * ui))
        slider.draw_value(surface, line, self.painter, value, parameter.default, held=held)

    def _words(self) -> tuple[str, Say]:
        if self._held is not None and self._anew:
            return f"let go to start again: {self._anew}", "info"
        if self.said[0]:
            return self.said
        focused = self.parameters().get(self.focus or "")
        if focused is not None:
            between = f"{focused.low:g} to {focused.high:g} {focused.unit}".strip()
            return f"{focused.name}: {between}; {focused.default:.6g} in the file", "info"
        if self._selection.body is None:
            return "select a robot or prop for its mass and more; Shift F2: to the sliders", "info"
        return "drag a slider, or click it and type a number; Shift F2: to the sliders", "info"

    # -- the mouse ----------------------------------------------------------------------------

    def handle(self, event: pygame.Event) -> bool:
        """Handle an event of the mouse within the panel; return whether a drag has begun."""
        super().handle(event)
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == pygame.BUTTON_LEFT:
            self._press(event.pos)
        held = self.parameters().get(self._held or "")
        if held is None:  # or the file was saved, and has it no more
            self._held = None
        elif event.type in (pygame.MOUSEBUTTONDOWN, pygame.MOUSEMOTION):
            self._value = held.nearest(self._sliders[held.name].value_at(event.pos[0]))
        elif event.type == pygame.MOUSEBUTTONUP:
            self._held = None
            if held.value != self._value or self._anew:
                self._set(held.name, self._value)
        return self._held is not None

    def _press(self, pixel: Pixel) -> None:
        """Press a button or a slider, which is held then."""
        name = next((n for n, place in self.places.items() if place.collidepoint(pixel)), None)
        self.focus_on(name)
        if name in self.resets and self.resets[name].collidepoint(pixel):
            self._set(name, self.parameters()[name].default)
        elif name is not None and self._sliders[name].hit(pixel):
            self._held, self._anew, self._next = name, "", self._clock()

    def tick(self) -> None:
        """While time passes, set the dragged value as often as that is quick; call it often."""
        held, start = self.parameters().get(self._held or ""), self._clock()
        waits = held is not None and held.value != self._value and not self._anew
        if held is not None and waits and self._player.playing and start >= self._next:
            self._set(held.name, self._value, restart=False)
            self._next = start + max(EVERY, (self._clock() - start) / SHARE)

    def _set(self, name: str, value: float, *, restart: bool = True) -> None:
        """Set a parameter, and report the effect."""
        parameter = self.parameters()[name]
        try:
            reason = self._set_to(name, value, restart)
        except Mars2dError as error:  # of the value, or of a law that is asked again
            self.said = str(error), "error"
            return
        if reason and not restart:
            self._anew = reason
            return
        what = f"{name.removeprefix(PREFIX)} = {_number(parameter, value)}"
        effect = f"started again: {reason}" if reason else "in effect from now on"
        self.said = f"{what}: {effect}", "info"

    # -- keys ---------------------------------------------------------------------------------

    def leave(self) -> None:
        """Take the focus from all sliders."""
        self.focus = None
        self.typed.clear()

    def press(self, event: pygame.Event) -> bool:
        """Give an event of the keyboard to the slider that has the focus; return if it took it."""
        parameter = self.parameters().get(self.focus or "") if self.is_open else None
        if parameter is None:
            return False
        begins = event.type != pygame.KEYDOWN or event.unicode != "e" or self.typed.text
        if begins and self.typed.handle(event):
            self.said = "", "info"
            return True
        name = pygame.key.name(event.key) if event.type == pygame.KEYDOWN else ""
        if name in ("left", "right"):
            step = parameter.step * (1 if name == "right" else -1)
            self._set(parameter.name, parameter.nearest(parameter.value + step))
        elif name in ("up", "down"):
            names = [*self.parameters()]
            number = names.index(parameter.name) + (1 if name == "down" else -1)
            self.focus_on(names[number % len(names)])
        elif name in ("return", "enter") and self.typed.text:
            self._take(parameter, self.typed.text)
            self.typed.clear()
        elif name == "escape":
            self.focus = self.focus if self.typed.text else None
            self.typed.clear()
        else:
            return False
        return True

    def focus_on(self, name: str | None) -> None:
        """Let a slider have the focus, and be seen; None: none."""
        self.leave()
        self.focus, self.sought, self.said = name, name or "", ("", "info")

    def begin(self) -> None:
        """Let the first slider of what is selected have the focus."""
        self.focus_on(self._first or None)

    def _take(self, parameter: Parameter, typed: str) -> None:
        """Set the number that was typed."""
        try:
            value = int(typed) if parameter.whole else float(typed)
        except ValueError:
            kind = "a whole number" if parameter.whole else "a number"
            self.said = f"{typed}: expected {kind}", "error"
        else:
            self._set(parameter.name, value)


def _lines(experiment: Experiment, body: int | None) -> Iterator[Line]:
    """Yield the lines of a panel: the parameters, under headings."""
    heading = ""
    found: Sequence[Parameter] = experiment.parameters()
    for parameter in found:
        above = "Scenario"
        if parameter.name.startswith(PREFIX):
            above = f"Law {parameter.name.removeprefix(PREFIX).rpartition('.')[0]}"
        if above != heading:
            yield above, None
        heading = above
        yield parameter.name.rpartition(".")[2], parameter
    if not found:
        yield "No parameters in this file", None
    if body is not None and body < len(experiment.scenario.bodies):
        yield str(experiment.scenario.bodies[body].name), None
        for parameter in experiment.parameters(body):
            yield parameter.name.rpartition(".")[2].replace("_", " "), parameter


def _number(parameter: Parameter, value: float) -> str:
    """Return a value with the decimals of its slider's steps, unless it lies between two."""
    short = f"{value:.{max(0, -floor(log10(parameter.step)))}f}"
    return f"{short if float(short) == value else f'{value:.6g}'} {parameter.unit}".strip()
