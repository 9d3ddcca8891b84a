"""The window, driven by real key presses and mouse moves on a screen of its own."""

import io
import json
import os
import queue
import shutil
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from PIL import Image

from mars2d.errors import InputError
from mars2d.view.display import display_available
from mars2d.view.window import Window
from tests.view.circling import Circling

TOOLS = ("Xvfb", "xdotool", "import")
missing = [tool for tool in TOOLS if shutil.which(tool) is None]
needs_screen = pytest.mark.skipif(bool(missing), reason=f"{', '.join(missing)} not installed")

HIDDEN = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER", "SDL_VIDEO_DRIVER")


def bare_environment(**extra):
    return {key: value for key, value in os.environ.items() if key not in HIDDEN} | extra


@pytest.fixture(scope="module")
def screen():
    """Start an X server on a free display and return its name."""
    read, write = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", "1000x700x24", "-noreset"],
        pass_fds=[write],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    os.close(write)
    with os.fdopen(read) as pipe:
        number = pipe.readline().strip()
    assert number, "Xvfb did not start"
    yield f":{number}"
    server.terminate()
    server.wait(10)


class Driver:
    """A window in a process of its own, and the hands and eyes of the person before it."""

    def __init__(self, screen, speed, **options):
        self.environment = bare_environment(DISPLAY=screen, SDL_VIDEO_WINDOW_POS="0,0")
        self.process = subprocess.Popen(
            [sys.executable, "-m", "tests.view.observed_window", str(speed), json.dumps(options)],
            env=self.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.lines = queue.Queue()
        self.state = {}
        threading.Thread(target=self._read, daemon=True).start()
        self.until(lambda s: "time" in s, 20)
        time.sleep(0.1)  # until the server has mapped it and given it the keyboard

    def _read(self):
        for line in self.process.stdout:
            if line.startswith("{"):
                self.lines.put(json.loads(line))

    def until(self, holds, seconds=5.0):
        """Wait until what the window tells of itself satisfies `holds`."""
        end = time.monotonic() + seconds
        while not (self.state and holds(self.state)):
            left = end - time.monotonic()
            try:
                self.state = self.lines.get(timeout=max(left, 0.001))
            except queue.Empty:
                errors = "" if self.process.poll() is None else self.process.stderr.read()
                pytest.fail(f"not within {seconds} s; the last state: {self.state} {errors}")
        return self.state

    def settle(self):
        """Read all that has been told up to now."""
        time.sleep(0.15)
        while not self.lines.empty():
            self.state = self.lines.get()
        return self.state

    def do(self, *arguments):
        subprocess.run(["xdotool", *map(str, arguments)], env=self.environment, check=True)

    def press(self, *keys):
        self.do("key", "--delay", "30", *keys)

    def look(self):
        """Return the screen, (height, width, 3)."""
        command = ["import", "-window", "root", "-crop", "800x600+0+0", "png:-"]
        shot = subprocess.run(command, env=self.environment, check=True, capture_output=True)
        return np.asarray(Image.open(io.BytesIO(shot.stdout)).convert("RGB")).astype(int)

    def still(self):
        """Return the screen once it has stopped changing, or after 5 s."""
        seen, end = self.look(), time.monotonic() + 5
        while time.monotonic() < end:
            time.sleep(0.2)
            before, seen = seen, self.look()
            if np.array_equal(before, seen):
                break
        return seen

    def shows(self, condition):
        """Return whether the screen meets a condition within 5 s."""
        end = time.monotonic() + 5
        while not (met := condition(self.look())) and time.monotonic() < end:
            time.sleep(0.05)
        return bool(met)

    def close(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait(5)
        self.process.stdout.close()
        self.process.stderr.close()


@pytest.fixture
def open_window(screen):
    """Return a function that opens a window; all are closed at the end."""
    opened = []

    def start(speed, **options):
        opened.append(Driver(screen, speed, **options))
        return opened[-1]

    yield start
    for window in opened:
        window.close()


PLOT = np.s_[60:540]  # the rows of the screen between the bars
HEADER = np.s_[0:44]


def differing(before, after, rows=PLOT, by=0):
    """Return how many pixels differ by more than `by` of 255."""
    return int((np.abs(before[rows] - after[rows]) > by).any(axis=2).sum())


def share(pixels, color):
    """Return which part of the pixels (k, 3) has a colour."""
    return (pixels == color).all(axis=1).mean()


FORCE = (0xA3, 0x00, 0x3C)
SLIP = (0xFF, 0xC2, 0x0A)
VIOLET = (0x7B, 0x32, 0x94)


def has(seen, color):
    """Return whether the picture shows a colour, in more than a few pixels."""
    return int((seen[PLOT] == color).all(axis=2).sum()) > 20


@needs_screen
def test_space_pauses_and_resumes(open_window):
    window = open_window(1)
    window.until(lambda s: s["time"] > 0.2)
    window.press("space")
    paused = window.until(lambda s: s["status"] == "paused")
    before = window.still()
    time.sleep(0.3)
    assert window.settle()["time"] == paused["time"]
    assert differing(before, window.look()) == 0
    window.press("space")
    window.until(lambda s: s["status"] == "1x" and s["time"] > paused["time"] + 0.1)
    assert window.shows(lambda seen: differing(before, seen) > 50)


@needs_screen
def test_the_right_arrow_steps_and_pauses_and_repeats_when_held(open_window):
    window = open_window(1)
    window.press("Right")
    first = window.until(lambda s: s["status"] == "paused")
    before = window.still()
    window.press("Right")
    window.until(lambda s: s["row"] == first["row"] + 1)
    assert window.settle()["row"] == first["row"] + 1
    assert window.shows(lambda seen: differing(before, seen) > 20)
    window.do("keydown", "Right")
    window.until(lambda s: s["row"] > first["row"] + 4)
    window.do("keyup", "Right")
    stopped = window.settle()["row"]
    time.sleep(0.2)
    assert window.settle()["row"] == stopped


@needs_screen
def test_plus_and_minus_change_the_speed_that_is_shown(open_window):
    window = open_window(1, rows=200_000)
    before = window.look()
    window.press("plus")
    window.until(lambda s: s["speed"] == "2.0" and s["status"] == "2x")
    assert window.shows(lambda seen: differing(before, seen, HEADER) > 20)
    window.press("minus", "minus", "minus")
    window.until(lambda s: s["speed"] == "0.2")
    window.press(*["KP_Add"] * 9)
    window.until(lambda s: s["speed"] == "inf" and s["status"].startswith("max"))


@needs_screen
@pytest.mark.parametrize(("key", "layer"), [("g", "grid"), ("t", "trails"), ("s", "sensors")])
def test_layers_are_switched_off_and_on(open_window, key, layer):
    window = open_window(20, rows=60)
    window.until(lambda s: s["over"])
    before = window.still()
    window.press(key)
    window.until(lambda s: s["layers"][layer] is False)
    assert window.shows(lambda seen: differing(before, seen) > 100)
    window.press(key)
    window.until(lambda s: s["layers"][layer] is True)
    # Paths drawn at once differ by a shade here and there from paths that have grown.
    assert window.shows(lambda seen: differing(before, seen, by=80) < 10)


@needs_screen
def test_layers_begin_as_the_animation_says(open_window):
    window = open_window(0, scenario={"animation": {"grid": False, "wake": False}})
    assert window.state["layers"] == {
        "grid": False,
        "trails": False,
        "sensors": True,
        "messages": True,
        "forces": False,
        "theory": False,
    }
    before = window.still()
    window.press("g")
    window.until(lambda s: s["layers"]["grid"])
    assert window.shows(lambda seen: differing(before, seen) > 1000)


@needs_screen
def test_c_shows_forces_and_who_slips(open_window):
    window = open_window(0, pressed=True)
    window.press("Right", "Right")
    window.until(lambda s: s["row"] == 2)
    before = window.still()
    assert not has(before, FORCE)
    window.press("c")
    window.until(lambda s: s["layers"]["forces"])
    assert window.shows(lambda seen: has(seen, FORCE) and has(seen, SLIP))
    window.press("c")
    window.until(lambda s: not s["layers"]["forces"])
    assert window.shows(lambda seen: differing(before, seen) == 0)


@needs_screen
def test_y_shows_what_theory_predicts(open_window):
    window = open_window(0)
    before = window.still()
    assert not has(before, VIOLET)
    window.press("y")
    window.until(lambda s: s["layers"]["theory"])
    assert window.shows(lambda seen: has(seen, VIOLET))
    window.press("y")
    window.until(lambda s: not s["layers"]["theory"])
    assert window.shows(lambda seen: differing(before, seen) == 0)


@needs_screen
def test_m_hides_messages_and_shows_them_again(open_window):
    window = open_window(0, talking=True)
    window.press("Right", "Right")
    window.until(lambda s: s["row"] == 2)
    before = window.still()
    window.press("m")
    window.until(lambda s: not s["layers"]["messages"])
    assert window.shows(lambda seen: differing(before, seen) > 50)  # a broken line and a cross
    window.press("m")
    window.until(lambda s: s["layers"]["messages"])
    assert window.shows(lambda seen: differing(before, seen) == 0)


@needs_screen
def test_forces_are_shown_from_the_start_if_the_animation_says_so(open_window):
    window = open_window(0, pressed=True, scenario={"animation": {"forces": True}})
    assert window.state["layers"]["forces"]
    window.press("Right")
    assert window.shows(lambda seen: has(seen, FORCE))


@needs_screen
def test_a_click_selects_a_robot_and_shows_the_force_on_it(open_window):
    window = open_window(0, pressed=True)
    window.press(*["Right"] * 5)
    state = window.until(lambda s: s["row"] == 5)
    before = window.still()

    def click(x, y):
        left = state["origin"][0] + state["scale"] * x
        window.do("mousemove", round(left), round(state["origin"][1] - state["scale"] * y))
        window.do("click", 1)

    angle = 0.5 * 0.1 * 5
    click(4 * np.cos(angle), 4 * np.sin(angle))
    window.until(lambda s: s["selected"] == 0)
    assert window.shows(lambda seen: differing(before, seen) > 10_000 and has(seen, FORCE))
    click(2.5 * np.cos(angle), 2.5 * np.sin(angle))
    window.until(lambda s: s["selected"] == 1)
    click(-4, -4)
    window.until(lambda s: s["selected"] is None)
    assert window.shows(lambda seen: differing(before, seen) == 0)


@needs_screen
def test_a_drag_does_not_select(open_window):
    window = open_window(0, pressed=True)
    scale, origin = window.state["scale"], window.state["origin"]
    x, y = round(origin[0] + 4 * scale), round(origin[1])
    window.do("mousemove", x, y, "mousedown", 1, "mousemove", x - 30, y, "mouseup", 1)
    window.until(lambda s: s["origin"] != origin)
    assert window.settle()["selected"] is None


@needs_screen
def test_tab_selects_one_after_the_other_and_escape_none(open_window):
    window = open_window(0, pressed=True)
    for wanted in (0, 1, None, 0):
        window.press("Tab")
        window.until(lambda s, wanted=wanted: s["selected"] == wanted)
    window.press("F1", "Escape")
    window.until(lambda s: not s["help"])
    assert window.settle()["selected"] == 0
    window.press("Escape")
    window.until(lambda s: s["selected"] is None)
    assert window.process.poll() is None
    window.press("Escape")
    window.until(lambda s: s.get("left"))


@needs_screen
def test_the_wheel_zooms_about_the_pointer_a_drag_pans_and_f_fits(open_window):
    window = open_window(0)
    start = window.state
    before = window.still()
    window.do("mousemove", 500, 250, "click", 4, "click", 4)
    zoomed = window.until(lambda s: s["scale"] > 1.3 * start["scale"])
    for axis, pointer in ((0, 500), (1, 250)):
        world = [(pointer - s["origin"][axis]) / s["scale"] for s in (start, zoomed)]
        assert world[0] == pytest.approx(world[1], abs=0.02)
    assert window.shows(lambda seen: differing(before, seen) > 1000)
    window.do("mousemove", 300, 300, "mousedown", 1, "mousemove", 340, 280, "mouseup", 1)
    panned = window.until(lambda s: s["origin"] != zoomed["origin"])
    window.settle()
    panned = window.state
    assert panned["origin"][0] - zoomed["origin"][0] == pytest.approx(40, abs=0.2)
    assert panned["origin"][1] - zoomed["origin"][1] == pytest.approx(-20, abs=0.2)
    window.do("click", 5)
    window.until(lambda s: s["scale"] < panned["scale"])
    window.press("f")
    window.until(lambda s: (s["scale"], s["origin"]) == (start["scale"], start["origin"]))
    assert window.shows(lambda seen: differing(before, seen) == 0)


@needs_screen
def test_r_restarts_also_when_it_is_over(open_window):
    window = open_window(10, rows=20)
    window.until(lambda s: s["over"])
    window.press("r")
    window.until(lambda s: s["restarts"] == 1 and s["row"] < 20)
    window.until(lambda s: s["over"])


@needs_screen
def test_f1_shows_the_keys_and_hides_them(open_window):
    window = open_window(0)
    before = window.still()
    window.press("F1")
    window.until(lambda s: s["help"])
    assert window.shows(lambda seen: differing(before, seen) > 20_000)
    window.press("F1")
    window.until(lambda s: not s["help"])
    assert window.shows(lambda seen: differing(before, seen) == 0)
    window.press("F1", "Escape")
    window.until(lambda s: not s["help"])
    assert window.process.poll() is None


@needs_screen
def test_escape_leaves(open_window):
    window = open_window(1)
    window.press("Escape")
    window.until(lambda s: s.get("left"))
    assert window.process.wait(5) == 0


@needs_screen
def test_manual_mode_is_one_step_a_key(open_window):
    window = open_window(0)
    before = window.still()
    for count, key in enumerate(["space", "Return", "Right", "a", "Down"], 1):
        window.press(key)
        window.until(lambda s, count=count: s["row"] == count)
    window.press("shift", "g")
    window.until(lambda s: not s["layers"]["grid"])
    assert window.settle()["row"] == 5
    assert window.state["status"] == "manual"
    assert window.shows(lambda seen: differing(before, seen) > 100)
    window.do("keydown", "space")
    window.until(lambda s: s["row"] > 8)
    window.do("keyup", "space")


@needs_screen
def test_the_end_is_told_in_a_banner(open_window):
    window = open_window("max", rows=30, message="robot0 has caught robot1")
    window.until(lambda s: s["over"])
    assert window.shows(lambda seen: share(seen[570], (0x24, 0x3B, 0x53)) > 0.5)


@needs_screen
def test_a_law_that_fails_leaves_the_window_open_and_is_raised_at_the_end(open_window):
    window = open_window(5, fails_at=7)
    window.until(lambda s: s["status"] == "stopped")
    assert window.shows(lambda seen: share(seen[570], (0xA6, 0x1B, 0x1B)) > 0.5)
    assert window.settle()["row"] == 7
    window.press("Escape")
    window.until(lambda s: "raised" in s)
    assert window.state["raised"] == "the law of robot0 returned nan"


@needs_screen
def test_the_layout_follows_the_size_of_the_window(open_window):
    window = open_window(0)
    start = window.state
    window.do("mousemove", 300, 300)
    command = ["xdotool", "getmouselocation", "--shell"]
    told = subprocess.check_output(command, env=window.environment, text=True)
    number = next(line for line in told.split() if line.startswith("WINDOW=")).split("=")[1]
    window.do("windowsize", number, 600, 500)
    resized = window.until(lambda s: s["size"] == [600, 500])
    assert resized["scale"] < start["scale"]


@needs_screen
def test_two_windows_one_after_the_other(open_window):
    window = open_window(0, windows=2)
    window.press("space", "space")
    window.until(lambda s: s["row"] == 2)
    window.press("Escape")
    window.until(lambda s: s.get("row") == 0)
    time.sleep(0.2)
    window.press("space")
    window.until(lambda s: s["row"] == 1)
    window.press("Escape")
    window.until(lambda s: s.get("left"))
    assert window.process.wait(5) == 0


@needs_screen
def test_ctrl_c_in_the_terminal_closes_the_window(open_window):
    window = open_window(1)
    window.process.send_signal(signal.SIGINT)
    assert window.process.wait(5) != 0
    assert "KeyboardInterrupt" in window.process.stderr.read()


@needs_screen
def test_a_slow_sampling_time_moves_smoothly(open_window):
    window = open_window(1, scenario={"sampling_time": 1.0}, rows=20)
    times = set()
    end = time.monotonic() + 0.5
    while time.monotonic() < end:
        times.add(window.until(lambda s: s["time"] not in times)["time"])
    assert len(times) > 8
    assert max(times) < 1.5


# -- without a display ----------------------------------------------------------------------------


@pytest.fixture
def no_display(monkeypatch):
    for name in HIDDEN:
        monkeypatch.delenv(name, raising=False)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="there is always one elsewhere")
def test_without_a_display_the_error_says_what_to_do_instead(no_display):
    assert not display_available()
    with pytest.raises(InputError, match=r"--headless.*--figure.*--video"):
        Window(Circling(), 1).run()


@pytest.mark.parametrize("driver", ["dummy", "offscreen"])
def test_a_driver_that_shows_nothing_is_no_display(monkeypatch, driver):
    monkeypatch.setenv("SDL_VIDEODRIVER", driver)
    assert not display_available()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="X is of Linux")
def test_a_display_that_is_gone_is_no_display(no_display, monkeypatch):
    monkeypatch.setenv("DISPLAY", ":987")
    assert not display_available()


@needs_screen
def test_a_display_is_found(no_display, monkeypatch, screen):
    monkeypatch.setenv("DISPLAY", screen)
    assert display_available()
