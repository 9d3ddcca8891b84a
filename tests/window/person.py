"""Who sits before a window in a process of its own: hands, eyes, and a screen to look at."""

import contextlib
import ctypes
import ctypes.util
import functools
import json
import os
import queue
import shutil
import signal
import subprocess
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageGrab, features

from tests.forking import Nursery
from tests.processes import PATIENCE, bare_environment, x_server

missing = [tool for tool in ("Xvfb", "xdotool") if shutil.which(tool) is None]
missing += [] if features.check("xcb") else ["Pillow with xcb"]
needs_screen = pytest.mark.skipif(bool(missing), reason=f"{', '.join(missing)} not installed")

ROOT = Path(__file__).parents[2]
REFERENCES = Path(__file__).parent / "references"

PLOT = np.s_[60:500]  # the rows of the screen between the bars
HEADER = np.s_[0:44]


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


@pytest.fixture(scope="session")
def screen():
    """Start an X server on a free display and return its name."""
    with x_server() as (name, _):
        yield name


@pytest.fixture(scope="session")
def repeating_screen():
    """Start an X server that repeats keys that are held, and return its name."""
    with x_server(repeats=True) as (name, _):
        yield name


class ClientMessage(ctypes.Structure):
    """An event that one program on a screen sends another."""

    _fields_ = (
        ("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
        ("display", ctypes.c_void_p), ("window", ctypes.c_ulong), ("message", ctypes.c_ulong),
        ("format", ctypes.c_int), ("data", ctypes.c_long * 5), ("rest", ctypes.c_byte * 96),
    )  # fmt: skip


@functools.cache
def nursery():
    """Start the process that windows are forked from, once in a session."""
    windows = ("observed_window", "observed_editor", "observed_hands", "observed_compare")
    return Nursery(bare_environment(), *(f"tests.window.{name}" for name in windows))


class Driver:
    """A window in a process of its own, and the hands and eyes of the person before it.

    speed, options: see observed_window.py. folder: where the window saves files.
    """

    def __init__(self, screen, speed, folder=None, **options):
        self._sit(screen, "observed_window", speed, json.dumps(options), folder=folder)

    def _sit(self, screen, module, *arguments, folder=None, shows="time"):
        """Sit down before the window of a module, and wait until it tells what `shows` names."""
        self.environment = bare_environment(
            DISPLAY=screen, SDL_VIDEO_WINDOW_POS="0,0", PYTHONPATH=str(ROOT)
        )
        words = [str(argument) for argument in arguments]
        self.process = nursery().fork(f"tests.window.{module}", words, self.environment, folder)
        self.lines = queue.Queue()
        self.state = {}
        threading.Thread(target=self._read, daemon=True).start()
        self.until(lambda s: shows in s)
        self.settle()
        time.sleep(0.1)  # until the server has mapped it and given it the keyboard

    def _read(self):
        with contextlib.suppress(ValueError):  # it was closed meanwhile
            for line in self.process.stdout:
                if line.startswith("{"):
                    self.lines.put(json.loads(line))
        self.lines.put(None)  # the window has ended

    # -- what it tells ----------------------------------------------------------------------------

    def until(self, holds):
        """Wait until what the window tells of itself satisfies `holds`."""
        end = time.monotonic() + PATIENCE
        while not (self.state and holds(self.state)):
            left = end - time.monotonic()
            told = None
            with contextlib.suppress(queue.Empty):
                told = self.lines.get(timeout=max(left, 0.001))
            if told is None:
                errors = "" if self.process.poll() is None else self.process.stderr.read()
                pytest.fail(f"no more is told; the last state: {self.state} {errors}")
            self.state = told
        return self.state

    def settle(self):
        """Wait until all that was done so far has been handled and drawn; return the state."""
        answers = self.state.get("answers", 0)
        self.process.send_signal(signal.SIGUSR1)
        return self.until(lambda s: s.get("answers", 0) > answers)

    def says(self, words):
        """Wait until a note says something."""
        return self.until(lambda s: any(words in note for note in s["notes"]))

    # -- hands ------------------------------------------------------------------------------------

    def do(self, *arguments):
        subprocess.run(["xdotool", *map(str, arguments)], env=self.environment, check=True)

    def press(self, *keys):
        self.do("key", "--delay", "30", *keys)

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
        moves = [word for place in others for word in ("mousemove", *place, "sleep", 0.04)]
        self.do("mousemove", *first, "sleep", 0.04, "mousedown", button, "sleep", 0.04, *moves)
        if drop:
            self.do("mouseup", button)

    def window(self):
        """Return the number of the window under the pointer."""
        self.do("mousemove", 300, 300)
        command = ["xdotool", "getmouselocation", "--shell"]
        told = subprocess.check_output(command, env=self.environment, text=True)
        return next(line for line in told.split() if line.startswith("WINDOW=")).split("=")[1]

    def ask_to_close(self):
        """Do what a window manager does when its close button is pressed."""
        x = ctypes.CDLL(ctypes.util.find_library("X11"))
        x.XOpenDisplay.restype = x.XInternAtom.restype = ctypes.c_void_p
        x.XInternAtom.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int]
        display = x.XOpenDisplay(self.environment["DISPLAY"].encode())
        window = int(self.window())
        names = (b"WM_PROTOCOLS", b"WM_DELETE_WINDOW")
        protocols, delete = (x.XInternAtom(display, name, 0) for name in names)
        event = ClientMessage(33, 0, 1, display, window, protocols, 32, (delete, 0, 0, 0, 0))
        x.XSendEvent.argtypes = [
            ctypes.c_void_p, ctypes.c_ulong, ctypes.c_int, ctypes.c_long, ctypes.c_void_p,
        ]  # fmt: skip
        x.XSendEvent(display, window, 0, 0, ctypes.byref(event))
        x.XCloseDisplay.argtypes = [ctypes.c_void_p]
        x.XCloseDisplay(display)

    # -- eyes -------------------------------------------------------------------------------------

    def look(self):
        """Return the screen, (height, width, 3)."""
        shot = ImageGrab.grab((0, 0, 800, 600), xdisplay=self.environment["DISPLAY"])
        return np.asarray(shot.convert("RGB")).astype(np.int16)

    def still(self):
        """Return the screen once it has stopped changing, or after many pictures."""
        seen = self.look()
        for _ in range(50):
            self.settle()
            before, seen = seen, self.look()
            if np.array_equal(before, seen):
                break
        return seen

    def shows(self, condition):
        """Wait until the screen meets a condition; return whether it did."""
        end = time.monotonic() + PATIENCE / 4
        while not (met := condition(self.look())) and time.monotonic() < end:
            time.sleep(0.05)
        return bool(met)

    def close(self):
        if self.process.poll() is None:
            # One that is killed can't tell what of the program it has run; an editor that is asked
            # to end asks whether to save.
            measured = "COVERAGE_PROCESS_CONFIG" in os.environ
            self.process.send_signal(signal.SIGTERM if measured else signal.SIGKILL)
        self.process.wait(PATIENCE)
        self.process.stdout.close()
        self.process.stderr.close()


@pytest.fixture
def open_window(screen):
    """Return a function that opens a window; all are closed at the end."""
    opened = []

    def start(speed, on=screen, **options):
        opened.append(Driver(on, speed, **options))
        return opened[-1]

    yield start
    for window in opened:
        if window.process.poll() is None:
            window.do("mouseup", 1, "mouseup", 3, "keyup", "shift")
        window.close()


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


def share(pixels, color):
    """Return which part of the pixels (k, 3) has a colour."""
    return (pixels == color).all(axis=1).mean()


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
