"""The dock: where panels stand, how they share their room, what the mouse does to them."""

from __future__ import annotations

import pygame

from mars2d import Robot, Scenario, World
from mars2d.output.raster.layout import Layout
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.theme import LIGHT
from mars2d.window.panels.lesson import Lesson
from mars2d.window.screen.viewpoint import Viewpoint
from mars2d.window.widgets.dock import Dock
from mars2d.window.widgets.panel import Panel
from mars2d.window.widgets.rows import Word
from tests.cases import each_case
from tests.window.written import Written, painter

SIZES = [(1280, 720, 1.0), (1920, 1080, 1.0), (1024, 768, 1.7), (800, 600, 1.0)]
SQUARE = [(-5, -5), (5, -5), (5, 5), (-5, 5)]
WIDE = [(-8, -2), (8, -2), (8, 2), (-8, 2)]
TALL = [(-2, -8), (2, -8), (2, 8), (-2, 8)]


class Plain(Panel):
    """A panel that remembers what happened to it."""

    def __init__(self, name, least=100.0, wanted=200.0):
        super().__init__(Painter())
        self.name, self.title = name, name.title()
        self.size, self.events, self.drags = (least, wanted), [], False

    def heights(self, frame, width):
        return self.size

    def draw(self, surface, rect, frame):
        self.rect = rect

    def handle(self, event):
        self.events.append(event.type)
        return self.drags


def frame_of(workspace):
    return World(Scenario(robots=[Robot()], workspace=workspace)).frame


class Seen:
    """A dock on a picture, and where the arena is."""

    def __init__(self, panels, size=(1280, 720), workspace=SQUARE, text=1.0, spot=None):
        width, height = size
        self.frame, self.surface = frame_of(workspace), pygame.Surface((width, height), 0, 32)
        self.layout = Layout.of((width, height), text=text, controls=True)
        self.dock = Dock(painter(self.layout, Painter().theme), panels)
        self.view = Viewpoint(self.frame.scenario, self.layout)
        self.draw(spot)

    def draw(self, spot=None):
        room = self.dock.arrange(self.layout, self.frame, self.frame.scenario.bounds)
        self.view.arrange(self.layout, self.frame.scenario, room)
        self.dock.draw(self.surface, self.frame, spot)
        xmin, xmax, ymin, ymax = self.frame.scenario.bounds
        corners = self.view.camera.to_pixels([(xmin, ymax), (xmax, ymin)])
        (left, top), (right, bottom) = corners.tolist()
        self.arena = pygame.Rect(left, top, right - left, bottom - top)
        return self

    def click(self, pixel):
        event = pygame.Event(pygame.MOUSEBUTTONDOWN, pos=pixel, button=1)
        return self.dock.handle(event)


def some(count):
    panels = [Plain(f"panel{k}") for k in range(count)]
    for panel in panels:
        panel.wanted = True
    return panels


@each_case("count", [1, 2, 3])
@each_case("workspace", [SQUARE, WIDE, TALL])
@each_case("size", SIZES)
def test_panels_cover_neither_the_arena_nor_each_other(size, workspace, count):
    *size, text = size
    seen = Seen(some(count), size, workspace, text)
    plates = [*seen.dock.plates.values()]
    assert f"panel{count - 1}" in seen.dock.plates
    assert len(plates) == count or text > 1
    assert seen.view.makes_room
    for k, plate in enumerate(plates):
        assert seen.layout.plot.contains(plate)
        assert not plate.colliderect(seen.arena)
        assert not any(plate.colliderect(other) for other in plates[:k])


def test_beside_a_square_arena_they_stand_at_the_right_and_below_a_wide_one_below():
    (plate,) = Seen(some(1)).dock.plates.values()
    assert plate.left > 900
    seen = Seen(some(2), workspace=WIDE)
    assert all(plate.top > seen.arena.bottom for plate in seen.dock.plates.values())


def test_where_there_is_little_room_the_one_opened_last_is_seen_whole():
    panels = [Plain(f"panel{k}", least=180.0) for k in range(3)]
    seen = Seen(panels, (640, 480))
    for panel in panels:
        panel.wanted = True
        seen.draw()
        whole = [name for name, plate in seen.dock.plates.items() if plate.height > 100]
        assert whole == [panel.name], "of the others only the titles"
    assert len(seen.dock.plates) == 3
    assert seen.click(seen.dock.plates["panel0"].center)
    seen.draw()
    assert seen.dock.plates["panel0"].height > 100 > seen.dock.plates["panel2"].height


def test_the_one_opened_last_is_seen_even_where_it_needs_all_the_room():
    panels = [Plain(name, least=500.0, wanted=900.0) for name in ("lesson", "inspector")]
    seen = Seen(panels, (1280, 720), text=2.2)
    for panel in panels:
        panel.wanted = True
        seen.draw()
    plate = seen.dock.plates["inspector"]
    assert plate.height > 0.85 * seen.layout.plot.height
    assert seen.layout.plot.contains(plate)


@each_case("size, text", [((640, 400), 2.2), ((640, 400), 1.0), ((480, 320), 2.2)])
def test_however_small_the_picture_a_panel_that_is_opened_is_seen(size, text):
    seen = Seen(some(1), size, text=text)
    (plate,) = seen.dock.plates.values()
    assert seen.layout.plot.contains(plate)
    assert seen.click(seen.dock.closes["panel0"].center)


@each_case("width", [150, 232, 900])
def test_the_lines_of_a_table_have_one_size_and_never_overlap(width):
    panel, surface = Panel(painter(Layout.of((640, 400)), LIGHT)), Written((width, 100))
    lines = ["", "a long name", "b", "both"], ["before, along [m/s]", "1", "2", "3 nearer"]
    lines = [*lines, ["momentum before [N s]", "", "", "(1.23, 4.56)"]]
    cells = [[[Word(each, LIGHT.ink)] * bool(each) for each in line] for line in lines]
    for k, row in enumerate(panel.table(cells)):
        row.draw(surface, pygame.Rect(0, 20 * k, width, 20))
    assert not surface.crowded()
    assert not surface.cut()
    assert len({place.height for _, place in surface.words}) == 1
    assert surface.place("3 nearer").right == surface.place("(1.23, 4.56)").right


def test_a_panel_of_what_is_selected_leaves_the_arena_where_it_is_until_it_is_fitted():
    panels = [Plain("scopes"), Plain("inspector", least=300.0, wanted=500.0)]
    panels[1].frames = False
    seen = Seen(panels, (1024, 768))
    for framed in (False, True):
        panels[0].wanted = framed
        alone = seen.draw().arena
        panels[1].wanted = True
        assert seen.draw().arena == alone
        seen.draw(alone.center)
        assert not seen.dock.plates["inspector"].collidepoint(alone.center)
        panels[1].wanted = False
        assert seen.draw().arena == alone
    panels[0].wanted, panels[1].wanted = False, True
    seen.draw()
    seen.dock.reframe()
    assert not seen.draw().dock.plates["inspector"].colliderect(seen.arena)


def test_panels_stay_where_they_stand_when_one_has_more_to_say_and_move_for_another():
    panels = [Plain(f"panel{k}", least=50.0, wanted=60.0) for k in range(3)]
    for panel in panels[:2]:
        panel.wanted = True
    seen = Seen(panels, (1152, 648), WIDE)
    corners = [plate.topleft for plate in seen.dock.plates.values()]
    assert len(corners) == 2
    arena, strip = seen.arena, min(top for _, top in corners)
    panels[0].size = 50.0, 900.0
    assert seen.draw().arena == arena
    assert [plate.topleft for plate in seen.dock.plates.values()] == corners
    panels[2].wanted = True
    seen.draw()
    assert len(seen.dock.plates) == 3
    assert min(plate.top for plate in seen.dock.plates.values()) < strip, "there is more room"


def test_a_panel_is_closed_by_its_button_and_opened_by_name():
    panels = some(2)
    seen = Seen(panels)
    assert seen.dock.opened == ["panel0", "panel1"]
    assert seen.click(seen.dock.closes["panel0"].center)
    assert seen.draw().dock.opened == ["panel1"]
    seen.dock.switch("panel0")
    seen.dock.open(["panel1", "gone since"])
    assert seen.dock.opened == ["panel0", "panel1"]
    seen.dock.switch("panel0")
    assert seen.dock.opened == ["panel1"]


def test_the_mouse_over_a_panel_is_the_panels_and_a_drag_until_it_ends():
    (panel,) = some(1)
    seen = Seen([panel])
    inside, outside = panel.rect.center, (100, 300)

    def send(kind, pixel):
        button = {} if kind == pygame.MOUSEMOTION else {"button": 1}
        return seen.dock.handle(pygame.Event(kind, pos=pixel, **button))

    assert not send(pygame.MOUSEBUTTONDOWN, outside)
    assert send(pygame.MOUSEBUTTONDOWN, inside)
    assert not send(pygame.MOUSEMOTION, outside)
    assert panel.events == [pygame.MOUSEBUTTONDOWN]
    panel.drags = True
    send(pygame.MOUSEBUTTONDOWN, inside)
    assert send(pygame.MOUSEMOTION, outside)
    assert send(pygame.MOUSEBUTTONUP, outside)
    assert not send(pygame.MOUSEMOTION, outside)
    assert panel.events[2:] == [pygame.MOUSEMOTION, pygame.MOUSEBUTTONUP]
    assert not seen.dock.handle(pygame.Event(pygame.KEYDOWN, key=pygame.K_a))


def test_a_panel_without_anything_to_show_is_remembered_all_the_same(tmp_path):
    (tmp_path / "short.py").write_text('"""Short."""\n')
    (tmp_path / "long.py").write_text('"""Long.\n\nQuestion: how far? Measured: a way.\n"""\n')
    for name, shown in (("short", False), ("long", True)):
        lesson = Lesson(Painter(), tmp_path / f"{name}.py")
        dock = Dock(Painter(), [lesson])
        dock.open(["lesson"])
        assert lesson.is_open == shown
        assert dock.opened == ["lesson"]
    assert lesson.parts == [("", "Long."), ("Question", "How far?"), ("Measured", "A way.")]


def test_what_scrolls_is_wrapped_beside_its_bar(tmp_path):
    words = " ".join(["at"] * 400)  # a line may end anywhere
    (tmp_path / "long.py").write_text(f'"""Long.\n\nQuestion: {words} Measured: a way.\n"""\n')
    pen = painter(Layout.of((300, 120), text=1.0, controls=True), Painter().theme)
    lesson, surface = Lesson(pen, tmp_path / "long.py"), Written((300, 120))
    for width in range(270, 300):
        lesson.draw(surface, pygame.Rect(0, 0, width, 120), frame_of(SQUARE))
        assert lesson.scroll.cut
    assert surface.texts
    assert not [text for text in surface.texts if "…" in text]
