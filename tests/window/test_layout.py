"""At any size of the window and of the text all has room: run, comparison, editor, menus, home."""

from itertools import combinations

import pygame

from mars2d.bodies.joints import Rope
from mars2d.bodies.props import Box
from mars2d.output.figures.comparison import MODES
from mars2d.output.raster.layout import TEXT_SIZES
from mars2d.output.raster.painter import Painter
from mars2d.scenario.controllers import FollowWall, FollowWaypoints
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.window import home
from mars2d.window.compare_window import CompareWindow
from mars2d.window.editor import Editor
from mars2d.window.editor.draft import Item
from mars2d.window.run.window import Window
from mars2d.window.screen.display import Preferences
from mars2d.window.screen.looks import Looks
from mars2d.window.screen.memory import Memory
from mars2d.window.screen.source import Trio
from mars2d.world.timeline import Timeline
from tests.cases import each_case
from tests.window.written import Pens, Written

SIZES = [(640, 400), (800, 600), (1280, 720), (1920, 1080)]
SCENARIO = Scenario(
    robots=[
        Robot(pose=(-3, -2, 0), controller=FollowWall(), sensors=FollowWall.needs),
        Robot(pose=(3, 2, 0), controller=FollowWaypoints()),
    ],
    props=[Box(pose=(0, 2, 0.4), length=1.2, width=0.6)],
    joints=[Rope(a="robot0", b="box0", length=6)],
)
LEAST = 0.4
"""The least share of the picture for the arena."""


def unfit(places, picture):
    """Yield what lies on something else, or beyond the picture."""
    for (a, one), (b, two) in combinations(places, 2):
        if one.colliderect(two):
            yield a, b
    yield from (name for name, place in places if not picture.contains(place))


def press(editor, pixel):
    editor.handle(pygame.Event(pygame.MOUSEBUTTONDOWN, pos=pixel, button=pygame.BUTTON_LEFT))


def editor_of(text):
    looks = Looks(Preferences(text=text))
    looks.painter = Painter(Pens(), theme=looks.painter.theme)
    return Editor(SCENARIO, looks)


def faults_of_editor(size, text):
    """Yield what is wrong with the editor's layout."""
    editor, picture = editor_of(text), pygame.Rect(0, 0, *size)
    for selection in ([], [Item("robot", 0)], [Item("robot", 1)], [Item("prop", 0)]):
        editor.desk.select(selection)
        surface = Written(size)
        editor.draw(surface)
        plot = editor.layout.plot  # the arena has words of its own
        surface.words = [(word, at) for word, at in surface.words if not plot.contains(at)]
        yield from (*surface.crowded(), *surface.cut())
        panel = [word for word, at in surface.words if at.left > plot.right and size[0] >= 1280]
        yield from (word for word in panel if word.endswith("…"))
    if plot.width * plot.height < LEAST * size[0] * size[1]:
        yield f"the arena has {plot.width * plot.height / size[0] / size[1]:.2f} of the picture"
    buttons = [*editor._toolbar.places.items(), *editor._header.places.items()]
    yield from unfit([*buttons, ("the arena", plot)], picture)
    for title in ("Mass", "Color", "Drive", "Sensors"):
        if title in editor.panel.places:
            press(editor, editor.panel.places[title].center)
            editor.draw(surface)
            yield from unfit([*editor.menu.places.items()], picture)
            if not editor.menu.places:
                yield f"{title} opens nothing"
            editor.menu.close()


def faults_of_home(size, text):
    """Yield what is wrong with the home's layout."""
    shown = home.Home(Memory())
    shown.looks.text = text
    shown.painter = shown.looks.painter = Painter(Pens(), theme=shown.painter.theme)
    surface, page = Written(size), Written(size)
    shown.draw(surface)
    shown.page.draw(page, shown.painter)
    bars = surface.words[len(page.words) :]  # the cards scroll below them
    yield from unfit([*bars, *shown._buttons.places.items()], surface.get_rect())
    long = surface.get_rect().inflate(0, 99_999)  # the page scrolls
    yield from unfit([(card.title, place) for card, place in shown.page.places], long)
    if shown.page._area.height < LEAST * size[1]:
        yield "the cards have too little room"


def faults_of_run(timeline, size, text):
    """Yield what is wrong with a game's layout before it begins."""
    shown = Window(timeline, 1.0, size, Preferences(text=text))
    shown.play()
    surface = pygame.Surface(size, 0, 32)
    for _ in range(2):  # panels have their places from the second picture on
        shown.draw(surface)
    plot = shown.layout.plot
    if plot.width * plot.height < LEAST * size[0] * size[1]:
        yield "the arena has too little of the picture"
    if not plot.contains(shown.menu.plate):
        yield "the roles lie beyond the arena"
    yield from unfit([*shown.toolbar.places.items(), ("the arena", plot)], surface.get_rect())


def faults_of_comparison(trio, size, text):
    """Yield what is wrong with the layout of a comparison."""
    shown = CompareWindow(trio, 1.0, size, Preferences(text=text))
    shown.looks.painter = Painter(Pens(), theme=shown.looks.painter.theme)
    surface = Written(size)
    shown.draw(surface)
    places = [*shown.plots.items(), ("the drift", shown.plot.area)]
    yield from unfit(places, surface.get_rect())
    yield from (name for name, place in places if place.height < 50)
    top = shown.plots["contact"].top
    titles = [place for word, place in surface.words if word in MODES and place.top < top]
    if len(titles) != len(MODES) or min(place.top for place in titles) < shown.layout.header.bottom:
        yield "not all titles are seen"


@each_case("size", SIZES)
def test_all_has_room_at_every_size_of_the_window_and_of_the_text(size, monkeypatch):
    monkeypatch.setenv("MARS2D_MEMORY", "")
    monkeypatch.setattr(home, "thumbnail_of", lambda *_: None)
    faults, sides, rows = [], [], []
    game = Timeline(open_experiment("lion_and_man"))
    trio = Trio({mode: Timeline(open_experiment("tug_of_war")) for mode in MODES})
    for text in TEXT_SIZES:
        faults += [("editor", text, fault) for fault in faults_of_editor(size, text)]
        faults += [("home", text, fault) for fault in faults_of_home(size, text)]
        faults += [("run", text, fault) for fault in faults_of_run(game, size, text)]
        faults += [("comparison", text, each) for each in faults_of_comparison(trio, size, text)]
        editor = editor_of(text)
        editor.draw(Written(size))
        sides.append(editor._toolbar.places["robot"].width)
        rows.append(editor.panel.places["Title"].height)
    assert faults == []
    assert min(sides) >= 0.85 * sides[0], "larger text takes little room from the buttons"
    assert size != (1280, 720) or rows[-1] >= 2 * rows[0], "the panel is read from the back row"
