"""At any size of the window and of the text all has room: the editor with its menus, the home."""

from itertools import combinations

import pygame

from mars2d.bodies.joints import Rope
from mars2d.bodies.props import Box
from mars2d.output.raster.layout import TEXT_SIZES
from mars2d.output.raster.painter import Painter
from mars2d.scenario.controllers import FollowWall
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.window import home
from mars2d.window.editor import Editor
from mars2d.window.editor.item import Item
from mars2d.window.screen.display import Preferences
from mars2d.window.screen.looks import Looks
from mars2d.window.screen.memory import Memory
from tests.cases import each_case
from tests.window.written import Pens, Written

SIZES = [(640, 400), (800, 600), (1280, 720), (1920, 1080)]
SCENARIO = Scenario(
    robots=[
        Robot(pose=(-3, -2, 0), controller=FollowWall(), sensors=FollowWall.needs),
        Robot(pose=(3, 2, 0)),
    ],
    props=[Box(pose=(0, 2, 0.4), length=1.2, width=0.6)],
    joints=[Rope(a="robot0", b="box0", length=6)],
)
LEAST = 0.4
"""The least share of the picture for the arena."""


def overlapping(places):
    return [(a, b) for (a, one), (b, two) in combinations(places, 2) if one.colliderect(two)]


def editor_of(text):
    looks = Looks(Preferences(text=text))
    looks.painter = Painter(Pens(), theme=looks.painter.theme)
    return Editor(SCENARIO, looks)


def drawn(editor, size):
    """Draw an editor; return its words outside the arena, which has words of its own."""
    surface = Written(size)
    editor.draw(surface)
    plot = editor.layout.plot
    surface.words = [(word, at) for word, at in surface.words if not plot.contains(at)]
    return surface


def faults_of_editor(size, text):
    """Yield what is wrong with the editor's layout."""
    editor = editor_of(text)
    for selection in ([], [Item("robot", 0)], [Item("prop", 0)]):
        editor.desk.select(selection)
        surface = drawn(editor, size)
        yield from surface.crowded()
        yield from surface.cut()
    plot, picture = editor.layout.plot, pygame.Rect(0, 0, *size)
    if plot.width * plot.height < LEAST * size[0] * size[1]:
        yield f"the arena has {plot.width * plot.height / size[0] / size[1]:.2f} of the picture"
    buttons = [*editor._toolbar.places.items(), *editor._header._places]
    yield from overlapping(buttons)
    yield from (name for name, place in buttons if not picture.contains(place))
    yield from (name for name, place in buttons if place.colliderect(plot))
    for title in {*editor.panel.places} & {"Mass", "Colour", "More"}:
        editor.panel.click(editor.panel.places[title].center)
        surface = Written(size)
        editor.draw(surface)
        menu, prompt = editor.menu, editor.dialogs.prompt
        if menu.is_open:
            yield from (
                (title, word)
                for word, at in surface.words
                if menu.plate.colliderect(at) and not picture.contains(at)
            )
            yield from overlapping(menu.places.items())
            if not picture.contains(menu.plate) or not menu.places:
                yield title
        if prompt is not None:
            yield from overlapping(prompt.places.items())
            yield from (
                name for name, place in prompt.places.items() if not picture.contains(place)
            )
        menu.close()
        editor.dialogs.prompt = None


def faults_of_home(size, text):
    """Yield what is wrong with the home's layout."""
    shown = home.Home(Memory())
    shown.looks.text = text
    shown.painter = shown.looks.painter = Painter(Pens(), theme=shown.painter.theme)
    surface, page = Written(size), Written(size)
    shown.draw(surface)
    shown.page.draw(page, shown.painter)
    bars = surface.words[len(page.words) :]  # the cards scroll below them
    yield from overlapping([*bars, *shown._buttons.places.items()])
    yield from (word for word, at in bars if not surface.get_rect().contains(at))
    yield from overlapping([(card.title, place) for card, place in shown.page.places])
    if shown.page._area.height < LEAST * size[1]:
        yield "the cards have too little room"


@each_case("size", SIZES)
def test_all_has_room_at_every_size_of_the_window_and_of_the_text(size, monkeypatch):
    monkeypatch.setenv("MARS2D_MEMORY", "")
    monkeypatch.setattr(home, "thumbnail_of", lambda *_: None)
    faults, sides = [], []
    for text in TEXT_SIZES:
        faults += [("editor", text, fault) for fault in faults_of_editor(size, text)]
        faults += [("home", text, fault) for fault in faults_of_home(size, text)]
        editor = editor_of(text)
        drawn(editor, size)
        sides.append(editor._toolbar.places["robot"].width)
    assert faults == []
    assert min(sides) >= 0.8 * sides[0], "larger text takes room from the buttons, but not much"
