"""Who sits before a window that nobody sees: hands that make events, eyes on what is drawn."""

import json
import os
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pygame
import pytest
from PIL import Image

from mars2d.window.editor import Editor
from mars2d.window.run import player_window, timebar, window
from mars2d.window.screen import viewpoint
from tests.processes import HIDDEN
from tests.window import states

REFERENCES = Path(__file__).parent / "references"

PLOT = np.s_[60:500]  # the rows of the screen between the bars
HEADER = np.s_[0:44]

PICTURE = 1 / 60
"""The time from picture to picture, seconds; none is waited for."""
MOST = 3000
"""How many pictures may pass until something is so."""
REPEAT_DELAY, REPEAT_INTERVAL = 0.4, 0.06
"""When a key that is held repeats, seconds."""

MODIFIERS = {"shift": pygame.KMOD_LSHIFT, "ctrl": pygame.KMOD_LCTRL}
KEYS = {
    "Return": "\r", "Escape": "\x1b", "BackSpace": "\b", "Tab": "\t", "Delete": "\x7f",
    "space": " ", "plus": "+", "minus": "-", "equal": "=", "period": ".", "comma": ",",
    "KP_Add": "+",
}  # fmt: skip
"""What keys with a name write."""
NAMES = {
    "Next": "page down", "Prior": "page up", "plus": "=", "minus": "-", "equal": "=", "period": ".",
    "comma": ",", "KP_Add": "[+]",
}  # fmt: skip
"""What pygame calls keys whose names differ by more than the case."""


ROOM = """
from mars2d import Robot, Scenario
from mars2d.addons import Map
from mars2d.bodies.props import Box


def ahead(robot):
    return 0.2, 0.0


def scenario():
    red = Robot(name="red", pose=(-2, 0.5, 0), controller=ahead)
    blue = red.replace(name="blue", pose=(-2, -1, 0), controller=None)
    crate = Box(name="crate", pose=(1, -1, 0), length=0.4, width=0.4, mass=2.0)
    return Scenario(
        title="A room",
        robots=[red, blue],
        props=[crate],
        workspace=[(-3, -2), (3, -2), (3, 2), (-3, 2)],
        addons=[Map([[(2.5, -1), (2.5, 1)]])],
        stop_time=60.0,
    )
"""


PUSHING = """
import numpy as np
from mars2d import Robot, Scenario
from mars2d.bodies.props import Box


def push(robot):
    return 0.2, 0.0


def gap(record):
    # how far blue is ahead of red, m
    return record.pose[:, 0, 1] - record.pose[:, 0, 0]


def scenario():
    red = Robot(name="red", pose=(-2, 0.5, 0), controller=push)
    blue = red.replace(name="blue", pose=(-1, -1, 0))
    crate = Box(name="crate", pose=(-1.2, 0.5, 0), length=0.4, width=0.4, mass=0.5)
    return Scenario(
        title="Pushing",
        robots=[red, blue],
        props=[crate],
        workspace=[(-3, -2), (3, -2), (3, 2), (-3, 2)],
        stop_time=20.0,
    )
"""


class Person:
    """A window, and the hands and eyes of the person before it; time passes by pictures.

    What it shows is told by `states` as `state`, as JSON has it. Keys have the names of X servers.
    """

    def __init__(self, shown, display):
        self.shown, self.display, self.state = shown, display, {}
        self._held, self._buttons, self._events = {}, set(), []
        self.picture()

    # -- pictures ---------------------------------------------------------------------------------

    def picture(self):
        """Handle all events, let time pass, and draw a picture; return the state."""
        if "left" in self.state:
            return self.state
        self._repeat()
        events, self._events = self._events, []
        edits = isinstance(self.shown, Editor)
        self.state = self._edited(events) if edits else self._played(events)
        self.state = json.loads(json.dumps(self.state))
        self.display.clock += PICTURE
        return self.state

    def _edited(self, events):
        editor = self.shown
        for event in events:
            if not editor.dialogs.done:
                editor.handle(event)
        if editor.dialogs.done:
            return states.left_editor(editor)
        self.shown.draw(pygame.display.get_surface())
        return states.of_editor(editor)

    def _played(self, events):
        for event in events:
            if self.shown._open:
                self.shown._handle(event)
        if self.shown._open:
            self.shown._pass_time(PICTURE)
        if not self.shown._open:
            self.shown.saver.close()
            error = self.shown.player.error
            return {"left": True} | ({} if error is None else {"raised": str(error)})
        self.shown._paint(pygame.display.get_surface())
        return states.of_window(self.shown)

    def until(self, holds):
        """Let pictures pass until the state satisfies `holds`."""
        for _ in range(MOST):
            if holds(self.state):
                return self.state
            self.picture()
        pytest.fail(f"it was not so; the last state: {self.state}")

    def settle(self):
        """Let three pictures pass; return the state."""
        for _ in range(3):
            self.picture()
        return self.state

    def says(self, words):
        """Wait until a note says something."""
        return self.until(lambda s: any(words in note for note in s["notes"]))

    # -- hands ------------------------------------------------------------------------------------

    def do(self, *words):
        """Do what words say as those of xdotool: mousemove X Y, click B, keydown K, sleep S, ..."""
        words = list(words)
        while words:
            word = words.pop(0)
            if word == "mousemove":
                self._move(round(words.pop(0)), round(words.pop(0)))
            elif word == "click":
                self._click(int(words.pop(0)))
            elif word == "sleep":
                for _ in range(round(float(words.pop(0)) / PICTURE)):
                    self.picture()
            else:
                getattr(self, f"_{word}")(words.pop(0))

    def press(self, *keys):
        """Press keys, one after the other, some with modifiers: ctrl+z."""
        for key in keys:
            *modifiers, name = key.split("+")
            for each in modifiers:
                self._keydown(each)
            self._keydown(name)
            self._keyup(name)
            for each in modifiers:
                self._keyup(each)

    def steps(self, count):
        """Go on by steps, or back for a negative number, as by so many presses of an arrow."""
        row, player = self.state["row"] + count, self.shown.player
        player.step(count) if count > 0 else player.back(-count)
        self.until(lambda s: s["row"] == row)

    def type(self, text):
        """Write a text."""
        named = {" ": "space", ".": "period", "-": "minus"}
        self.press(*(named.get(character, character) for character in text))

    def pixel(self, x, y):
        """Return the pixel of a point in metres."""
        (left, top), scale = self.state["origin"], self.state["scale"]
        return round(left + scale * x), round(top - scale * y)

    def point(self, x, y):
        self.do("mousemove", *self.pixel(x, y))

    def click(self, x, y, button=1):
        self.do("mousemove", *self.pixel(x, y), "click", button)

    def drag(self, *places, button=1, drop=True):
        """Drag through points in metres."""
        self.slide(*(self.pixel(*place) for place in places), button=button, drop=drop)

    def slide(self, first, *others, button=1, drop=True):
        """Drag through pixels."""
        moves = [word for place in others for word in ("mousemove", *place)]
        self.do("mousemove", *first, "mousedown", button, *moves)
        if drop:
            self.do("mouseup", button)

    def resize(self, width, height):
        """Pull the window to another size."""
        pygame.display.set_mode((width, height))
        self.settle()

    def ask_to_close(self):
        """Press the close button of the window."""
        self._send(pygame.QUIT)

    # -- hands in an editor -----------------------------------------------------------------------

    def tool(self, letter, name):
        self.press(letter)
        self.until(lambda s: s["tool"] == name)

    def row(self, title):
        """Click a row of the panel."""
        self.until(lambda s: title in s["panel"])
        self.do("mousemove", *self.state["panel"][title], "click", 1)

    def entry(self, title):
        """Click an entry of the open menu."""
        self.until(lambda s: title in s["menu"])
        self.do("mousemove", *self.state["menu"][title], "click", 1)

    def fill(self, text):
        """Type over the field of the open prompt, and press Enter."""
        self.until(lambda s: s["prompt"] is not None)
        self.press("ctrl+a")
        self.type(text)
        self.press("Return")
        self.until(lambda s: s["typed"] is None or s["error"])

    # -- events -----------------------------------------------------------------------------------

    def _send(self, kind, **told):
        self._events.append(pygame.Event(kind, **told))
        self.picture()

    def _move(self, x, y):
        (left, top), self.display.pointer = self.display.pointer, (x, y)
        buttons = tuple(int(k in self._buttons) for k in (1, 2, 3))
        self._send(pygame.MOUSEMOTION, pos=(x, y), rel=(x - left, y - top), buttons=buttons)

    def _click(self, button):
        if button > 3:
            notches = 1 if button == 4 else -1
            self._send(pygame.MOUSEWHEEL, x=0, y=notches, precise_y=float(notches), flipped=False)
        else:
            self._mousedown(button)
            self._mouseup(button)

    def _mousedown(self, button):
        self._buttons.add(button)
        self._send(pygame.MOUSEBUTTONDOWN, pos=self.display.pointer, button=button)

    def _mouseup(self, button):
        self._buttons.discard(button)
        self._send(pygame.MOUSEBUTTONUP, pos=self.display.pointer, button=button)

    def _keydown(self, key):
        if key in MODIFIERS:
            pygame.key.set_mods(pygame.key.get_mods() | MODIFIERS[key])
        told = self._told(key)
        self._held[key] = told, self.display.clock + REPEAT_DELAY
        self._type_event(told)
        self.picture()

    def _keyup(self, key):
        self._held.pop(key)
        if key in MODIFIERS:
            pygame.key.set_mods(pygame.key.get_mods() & ~MODIFIERS[key])
        self._send(pygame.KEYUP, **self._told(key))

    def _told(self, key):
        """Return what an event of a key tells."""
        mods = pygame.key.get_mods() | (MODIFIERS["shift"] if key == "plus" else 0)
        name = f"left {key}" if key in MODIFIERS else NAMES.get(key, key.lower())
        text = KEYS.get(key, key if len(key) == 1 else "")
        if mods & MODIFIERS["ctrl"] and text.isalpha():
            text = chr(ord(text.lower()) - 96)
        scancode = getattr(pygame, f"KSCAN_{key.upper()}", 0)
        code = pygame.key.key_code(name)
        return {"key": code, "unicode": text, "mod": mods, "scancode": scancode}

    def _repeat(self):
        """Press the key again that is held the last, if it is held long enough."""
        for key, (told, when) in [*self._held.items()][-1:]:
            if self.display.clock > when and key not in MODIFIERS:
                self._held[key] = told, when + REPEAT_INTERVAL
                self._type_event(told)

    def _type_event(self, told):
        """Press a key; its text comes in an event of its own, as from a desktop."""
        self._events.append(pygame.Event(pygame.KEYDOWN, **told))
        if told["unicode"].isprintable() and told["unicode"] and not told["mod"] & pygame.KMOD_CTRL:
            self._events.append(pygame.Event(pygame.TEXTINPUT, text=told["unicode"]))

    # -- eyes -------------------------------------------------------------------------------------

    def look(self):
        """Return what is drawn, (height, width, 3)."""
        pixels = pygame.surfarray.array3d(pygame.display.get_surface())
        return pixels.swapaxes(0, 1).astype(np.int16)

    def still(self):
        """Return what is drawn once it has stopped changing."""
        seen = self.look()
        for _ in range(50):
            self.settle()
            before, seen = seen, self.look()
            if np.array_equal(before, seen):
                break
        return seen

    def shows(self, condition):
        """Let pictures pass until one meets a condition; return whether one did."""
        for _ in range(100):
            if condition(self.look()):
                return True
            self.settle()
        return False


@pytest.fixture
def display(monkeypatch):
    """Start a display that nobody sees; its pointer and its clock are moved by hand."""
    for name in HIDDEN:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    pygame.display.quit()
    pygame.display.init()
    pygame.display.set_mode((800, 600))
    made = SimpleNamespace(pointer=(0, 0), clock=1000.0)
    monkeypatch.setattr(pygame.mouse, "get_pos", lambda: made.pointer)
    monkeypatch.setattr(pygame.mouse, "get_focused", lambda: True)
    time = SimpleNamespace(monotonic=lambda: made.clock, perf_counter=lambda: made.clock)
    for module in (window, player_window, timebar, viewpoint):
        monkeypatch.setattr(module, "time", time)
    yield made
    pygame.key.set_mods(0)
    pygame.display.quit()


@pytest.fixture
def open_window(display, monkeypatch):
    """Return a function that opens a window; options: see `states.made_window`."""

    def start(speed, folder=None, **options):
        if folder is not None:
            monkeypatch.chdir(folder)
        made = states.made_window(speed, **options)
        made._open = True
        return Person(made, display)

    return start


@pytest.fixture
def open_editor(display, monkeypatch, tmp_path):
    """Return a function that opens an editor on a scenario or a file."""
    monkeypatch.chdir(tmp_path)
    return lambda source="-", **options: Person(
        states.made_editor(source, tmp_path, **options), display
    )


@pytest.fixture
def pushing(tmp_path):
    path = tmp_path / "pushing.py"
    path.write_text(PUSHING)
    return path


@pytest.fixture
def room(tmp_path):
    """Return the file of an experiment: red goes ahead, blue stands, a crate lies in a room."""
    path = tmp_path / "room.py"
    path.write_text(ROOM)
    return path


# -- pictures -------------------------------------------------------------------------------------


def differing(before, after, rows=PLOT, by=0):
    """Return how many pixels differ by more than `by` of 255."""
    return int((np.abs(before[rows] - after[rows]) > by).any(axis=2).sum())


def has(seen, color):
    """Return whether the picture shows a colour, in more than a few pixels."""
    return int((seen[PLOT] == color).all(axis=2).sum()) > 20


def compare(name, seen):
    """Compare a picture with the one that was looked at; MARS2D_REFERENCES=new keeps a new one.

    Edges of letters and lines may differ by a shade, as other versions of pygame draw them.
    """
    path = REFERENCES / f"{name}.png"
    if os.environ.get("MARS2D_REFERENCES") == "new":
        path.parent.mkdir(exist_ok=True)
        picture = Image.fromarray(seen.astype(np.uint8))
        picture.quantize(256, kmeans=1, dither=Image.Dither.NONE).save(path, optimize=True)
    wanted = np.asarray(Image.open(path).convert("RGB")).astype(int)
    assert wanted.shape == seen.shape
    off = np.abs(wanted - seen).max(axis=2)
    assert off.mean() < 2, f"{path}: by {off.mean():.1f} of 255 in the mean"
    assert (off > 60).mean() < 0.005, f"{(off > 60).mean():.2%} of the picture differs from {path}"
