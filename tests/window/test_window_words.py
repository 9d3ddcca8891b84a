"""The words of a window: the keys that serve now, what is said of a change, none over another."""

import pygame
import pytest

from mars2d import Robot, Scenario
from mars2d.output.raster import legend
from mars2d.scenario.experiment import open_experiment
from mars2d.window.run.window import Window
from mars2d.world.timeline import Timeline
from tests.cases import each_case
from tests.window.written import Pens, Written, pixels
from tests.worlds import ahead

SMALL, LARGE = (922, 691), (1280, 720)
"""Pixels: with a projector, and as it opens."""


@pytest.fixture
def window(monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    robots = [Robot(name="red", controller=ahead), Robot(name="blue", pose=(0, 2, 0))]
    source = Timeline(open_experiment(Scenario(robots=robots, stop_time=60)))
    for _ in range(50):
        source.advance()
    window = Window(source)
    window.player.settle()
    window.looks.painter.fonts = Pens()
    pygame.display.init()
    yield window
    pygame.display.quit()


def words(window, size=LARGE, text=1.0):
    window.looks.text = text
    surface = Written(size)
    window.draw(surface)
    return surface.texts


def do(window, *actions):
    for action in actions:
        window._actions[action]()


def said(window):
    return [note.text for note in window.notes._notes]


def test_the_footer_has_the_keys_that_serve_now(window):
    assert {"Space", "pause"} <= set(words(window))
    do(window, "drive")
    texts = set(words(window))
    assert {"drive", "slowly", "let go"} <= texts
    assert "← →" not in texts  # they drive


@pytest.fixture
def plates(monkeypatch):
    """Return the plates of legends that are drawn from now on."""
    found, draw = [], legend._drawn

    def drawn(surface, painter, signs, plate):
        found.append(plate)
        draw(surface, painter, signs, plate)

    monkeypatch.setattr(legend, "_drawn", drawn)
    return found


def test_no_panel_covers_a_legend(window, plates):
    do(window, "forces", "select")
    window.dock.open(["parameters", "scopes"])
    window.dock.scopes.switch("speed", (0, 1))
    for size, text in [((1024, 768), 1.7), (SMALL, 1.0), (LARGE, 1.0)]:
        plates.clear()
        words(window, size, text)
        assert plates
        panels = list(window.dock.plates.values())
        assert all(plate.collidelist(panels) == -1 for plate in plates)


def test_the_inspector_leaves_the_arena_to_one_who_drives(window):
    do(window, "select")
    shown = {}
    for drives in (False, True):
        for size, text in ((SMALL, 1.7), (LARGE, 1.0), ((470, 470), 1.0)):
            words(window, size, text)
            shown[drives, size] = place = window.dock.plates.get("inspector")
            arena = window.viewpoint.seen
            assert not (drives and place and place.colliderect(arena))
        do(window, "drive")
    assert shown[False, (470, 470)]
    assert not shown[True, (470, 470)]
    assert shown[True, LARGE]  # there it is beside it


def test_the_first_branch_says_how_to_get_to_the_other(window):
    window.player.go(20)
    assert window.director.change(lambda world: world.operator.place("blue", (2, 2, 0)))
    assert "a new branch begins here; B shows what was run before" in said(window)
    do(window, "branch")
    assert "another branch, run until 5 s; B goes back" in said(window)


def test_escape_clears_an_error_and_never_closes_the_window(window):
    window._open = True
    window.notes.say("walk.py, line 3: no", "error")
    do(window, "escape")
    assert (said(window), window._open) == ([], True)
    for _ in range(3):
        do(window, "escape")
    assert (said(window), window._open) == (["Ctrl Q closes the window"], True)
    do(window, "leave")
    assert not window._open


def test_what_is_said_is_in_no_film(window):
    def seen():
        surface = Written(LARGE)
        window.draw(surface)
        return pygame.image.tobytes(surface.subsurface(window.layout.plot), "RGB")

    bare = seen()
    window.notes.say("filming; V ends the film")
    assert seen() != bare
    window.saver._film = object()
    assert seen() == bare  # the window shows what is said once the film has its picture


@each_case("size", [(640, 400), (800, 600), LARGE, (1920, 1080)])
def test_at_any_size_of_text_the_arena_has_room_and_icons_no_less(window, size):
    sides = []
    for text in (1.0, 1.3, 1.7, 2.2):
        written = words(window, size, text)
        plot, buttons = window.layout.plot, window.toolbar.bars[1].places
        assert plot.width * plot.height >= 0.4 * size[0] * size[1]
        assert all(len(each.collidelistall([*buttons.values()])) == 1 for each in buttons.values())
        assert all(window.layout.tools.contains(each) for each in buttons.values())
        sides.append(next(iter(buttons.values())).height)
        labelled = size[0] >= 1100 * window.layout.ui
        assert ("Save a picture" in written) == labelled, "an icon has a word where there is room"
    assert min(sides) >= (0.75 if size == (640, 400) else 1.0) * sides[0], sides


def test_legends_lie_beside_the_workspace_where_there_is_room(window, plates):
    do(window, "forces")
    for selects in (False, True):
        for _ in range(2):
            plates.clear()
            words(window, (1920, 1080))
        arena = window.viewpoint.seen
        assert plates
        assert arena.collidelist(plates) == -1, selects
        do(window, "select")


@each_case("text", [1.0, 1.3, 2.2])
def test_where_there_is_no_room_beside_it_legends_lie_where_no_body_is(plates, text, display):
    source = Timeline(open_experiment("push_box"))
    for _ in range(20):
        source.advance()
    window = Window(source)
    window.player.settle()
    do(window, "select", "predictions")
    window.dock.scopes.switch("speed", (0, 1))
    plates.clear()
    words(window, text=text)
    bodies = window.camera.to_pixels(window.player.frame.all_poses[:2].T)
    assert bool(plates) == (text < 2)
    assert not any(plate.collidepoint(middle) for plate in plates for middle in bodies)


@each_case("size, text", [((640, 400), 1.0), ((800, 600), 1.7), (LARGE, 2.2)])
def test_notes_lie_beside_panels_in_small_windows_too(window, size, text):
    window.looks.text = text
    window.dock.open(["parameters"])
    window.notes.clear()
    pictures = []
    for note in ("", "the film can't be written, since there is no space left"):
        if note:
            window.notes.say(note, "error")
        for _ in range(2):
            window.draw(surface := pygame.Surface(size, 0, 32))
        pictures.append(pixels(surface))
    (plate,) = window.dock.plates.values()
    changed = (pictures[0] != pictures[1]).any(axis=2)
    assert changed.any()
    assert not changed[plate.top : plate.bottom, plate.left : plate.right].any()
