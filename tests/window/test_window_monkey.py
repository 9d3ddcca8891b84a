"""A monkey before the window: random keys and clicks raise nothing, and pictures go on."""

import random
import time

import pygame
import pytest

from mars2d.scenario.experiment import open_experiment
from mars2d.window import keys
from mars2d.window.editor import keys as editor_keys
from mars2d.window.source import Playback
from mars2d.window.window import Window
from mars2d.world.loop import simulate
from mars2d.world.timeline import Timeline
from tests.window.monkey import COMMANDS, run
from tests.window.person import ROOM, needs_screen

SCANCODES = {
    code: getattr(pygame, f"KSCAN_{name[2:].upper()}")
    for name, code in vars(pygame).items()
    if name.startswith("K_") and hasattr(pygame, f"KSCAN_{name[2:].upper()}")
}
KEYS = [name for key in keys.KEYS for name in key.names if "+" not in name and "[" not in name]
DRIVING = [*"wasdhh0123456789", "up", "down", "left", "right", "left shift"]
EDITING = [name for _, group in editor_keys.GROUPS for key in group for name in key.names]
EDITING += ["escape", "return"] * 20  # or it would stay in the editor for long
MODIFIERS = {"ctrl": pygame.KMOD_LCTRL, "shift": pygame.KMOD_LSHIFT}
BUTTONS = (pygame.BUTTON_LEFT,) * 5 + (pygame.BUTTON_RIGHT, pygame.BUTTON_MIDDLE)
SIZES = ((800, 600), (1280, 720), (300, 200), (500, 700))


class Monkey:
    """Presses keys and moves the mouse, at random but the same each time for a seed."""

    def __init__(self, window, seed):
        self.window, self.random = window, random.Random(seed)
        self.surface = pygame.display.set_mode((800, 600))
        self.place, self.held, self.pressed = (400, 300), set(), set()
        self.done = []

    def act(self):
        window = self.window
        window._open = True
        for event in self.events():
            self.done = [*self.done[-30:], event]
            window._handle(event)
            if self.random.random() < 0.3:
                self.watch()
        self.watch()

    def watch(self):
        """Let a picture's time pass."""
        window = self.window
        window._pass_time(self.random.choice((0.001, 1 / 60, 0.1)))
        window.draw(self.surface)
        window._film(self.surface)
        window._use_rest(0.003)

    def events(self):
        what = self.random.random()
        if what < 0.55:
            yield from self.key()
        elif what < 0.85:
            yield from self.drag()
        elif what < 0.92:
            yield self.motion(*self.target())
        elif what < 0.97:
            y = self.random.choice((-1, 1, 3))
            yield pygame.Event(pygame.MOUSEWHEEL, x=0, y=y, precise_y=float(y))
        elif what < 0.98:
            self.held.clear()
            yield pygame.Event(pygame.WINDOWFOCUSLOST)
        elif what < 0.99:
            yield pygame.Event(pygame.WINDOWLEAVE)
        else:
            self.surface = pygame.display.set_mode(self.random.choice(SIZES))

    def key(self):
        own = EDITING if self.window.editor is not None else KEYS
        *before, name = self.random.choice(self.random.choice((own, own, DRIVING))).split("+")
        code = pygame.key.key_code(name)
        mod = sum(MODIFIERS[each] for each in before)
        unicode = name if len(name) == 1 and not before else ""
        told = {"key": code, "mod": mod, "scancode": SCANCODES.get(code, 0)}
        if code in self.held:
            self.held.discard(code)
            yield pygame.Event(pygame.KEYUP, **told)
            return
        yield pygame.Event(pygame.KEYDOWN, unicode=unicode, **told)
        if self.random.random() < 0.7:
            yield pygame.Event(pygame.KEYUP, **told)
        else:
            self.held.add(code)

    def target(self):
        """Return a pixel: of a body, of the bars, or any."""
        window, (width, height) = self.window, self.surface.get_size()
        choice = self.random.random()
        x, y = self.random.randrange(width), self.random.randrange(height)
        if choice < 0.5:
            poses = [*window.player.frame.pose.T, *window.player.frame.prop_pose.T]
            ((x, y),) = window.camera.to_pixels([self.random.choice(poses)[:2]])
        elif choice < 0.7:
            y = window.layout.timebar.centery
        elif choice < 0.8:
            x, y = self.place[0] + self.random.randint(-9, 9), self.place[1]
        return min(max(round(x), 0), width - 1), min(max(round(y), 0), height - 1)

    def motion(self, x, y):
        before, self.place = self.place, (x, y)
        buttons = tuple(int(button in self.pressed) for button in (1, 2, 3))
        rel = x - before[0], y - before[1]
        return pygame.Event(pygame.MOUSEMOTION, pos=self.place, rel=rel, buttons=buttons)

    def drag(self):
        yield self.motion(*self.target())
        button = self.random.choice(BUTTONS)
        self.pressed.add(button)
        yield pygame.Event(pygame.MOUSEBUTTONDOWN, pos=self.place, button=button)
        for _ in range(self.random.randrange(4)):
            yield self.motion(*self.target())
        if self.random.random() < 0.15:  # something else comes first
            yield from self.key()
        self.pressed.discard(button)
        yield pygame.Event(pygame.MOUSEBUTTONUP, pos=self.place, button=button)


@pytest.fixture
def no_screen(monkeypatch, tmp_path):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    monkeypatch.chdir(tmp_path)
    pygame.display.init()
    yield
    pygame.display.quit()


FAILS = "    if robot.pose[0] > -1.5:\n        speed = 1 / 0\n    return 0.2, 0.0"


def opened(kind, path):
    text = ROOM.replace("    return 0.2, 0.0", FAILS) if kind == "failing" else ROOM
    path.write_text(text.replace("stop_time=60.0", "stop_time=8.0"))
    experiment = open_experiment(path)
    if kind == "recording":
        return Window(Playback(simulate(experiment, 1).record), 2.0)
    return Window(Timeline(experiment, seed=1), 0 if kind == "manual" else 5.0)


def play(kind, seed, path, seconds=None, acts=0):
    window = opened(kind, path)
    monkey = Monkey(window, seed)
    end = time.monotonic() + seconds if seconds else None
    count = 0
    try:
        while count < acts or (end and time.monotonic() < end):
            if kind == "editor" and window.editor is None and count % 10 == 0:
                window._open_editor()
            monkey.act()
            count += 1
    except Exception as error:
        error.add_note(f"{kind}, seed {seed}, act {count}, at last: {monkey.done[-6:]}")
        raise
    finally:
        window.saver.close()
    return monkey


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["live", "recording", "editor", "failing", "manual"])
def test_whatever_is_pressed_the_window_goes_on(no_screen, tmp_path, kind):
    monkey = play(kind, 5, tmp_path / "room.py", acts=60)
    assert pygame.transform.average_color(monkey.surface)[:3] != (0, 0, 0)


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kind", ["live", "recording", "editor", "failing", "manual"])
def test_whatever_is_pressed_for_long_the_window_goes_on(no_screen, tmp_path, kind, seed):
    play(kind, seed, tmp_path / "room.py", seconds=15)


@needs_screen
@pytest.mark.soak
def test_real_windows_bear_real_keys_and_clicks():
    told = run([*COMMANDS], minutes=1, seed=2)["windows"]
    assert [window["errors"] for window in told.values()] == [[], [], []]
    assert all(window["left by a key, and opened again"] for window in told.values())
