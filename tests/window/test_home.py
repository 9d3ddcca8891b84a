"""The home: every entry opens by a click, and what windows remember."""

import numpy as np
import pygame
import pytest

from mars2d.cli.command_line import main, parse
from mars2d.output.raster.layout import TEXT_SIZES
from mars2d.scenario.examples import examples, games
from mars2d.window.home import Home
from mars2d.window.screen.display import Preferences
from mars2d.window.screen.memory import Memory
from tests.window.written import Pens, Written


@pytest.fixture
def memory(tmp_path, monkeypatch):
    monkeypatch.setenv("MARS2D_MEMORY", str(tmp_path / "memory"))
    return Memory()


def shown(memory, size=(1280, 720), text=1.0):
    home = Home(memory)
    home.looks.text = text
    surface = pygame.Surface(size, 0, 32)
    home.draw(surface)
    return home, surface


def click(home, surface, title):
    """Bring a card into view by keys, and click on it; title: or its command."""
    wanted = enumerate(home.page.places)
    number = next(k for k, (card, _) in wanted if title in (card.title, card.command))
    while home.page.chosen != number:
        press(home, pygame.K_RIGHT if home.page.chosen < number else pygame.K_LEFT)
    home.draw(surface)
    width, height = surface.get_size()
    pixels = ((x, y) for y in range(0, height, 12) for x in range(0, width, 12))
    pixel = next(pixel for pixel in pixels if home.page.at(pixel) == number)
    home.handle(pygame.Event(pygame.MOUSEBUTTONDOWN, button=1, pos=pixel))


def press(home, key, modifiers=0):
    home.handle(pygame.Event(pygame.KEYDOWN, key=key, mod=modifiers, unicode=""))


def all_cards(home):
    return [card for shelf in home.shelves for card in shelf.cards]


# -- clicks ---------------------------------------------------------------------------------------


def test_each_card_opens_by_a_click_and_its_command_is_one(memory):
    cards = all_cards(shown(memory)[0])
    for card in cards:
        parse(card.command)
    for card in (cards[0], cards[-1]):
        home, surface = shown(memory)
        click(home, surface, card.command)
        assert home.choice == card.command


@pytest.mark.parametrize(("size", "text"), [((1280, 720), 2.2), ((640, 480), 1.0)])
def test_the_chosen_card_is_seen_as_a_whole(memory, size, text):
    home, surface = shown(memory, size, text)
    for _ in range(12):
        home.draw(surface)
        place = home.page._seen(home.page.places[home.page.chosen][1])
        assert home.page._area.contains(place)
        press(home, pygame.K_DOWN)


def test_what_is_typed_is_searched_for(memory):
    home, surface = shown(memory)

    def found(words):
        press(home, pygame.K_ESCAPE)
        for letter in words:
            home.handle(pygame.Event(pygame.TEXTINPUT, text=letter))
        return {card.title for card in all_cards(home)}

    assert "Push box" in found("push b")
    assert all_cards(home)[0].title == "Push box", "what is called so comes first"
    assert found("RangeFinder") == found("range_finder") >= {"Obstacle avoidance"}, "a part"
    assert len(found("contact")) > 10, "a course, docstrings, and the field physics"
    press(home, pygame.K_ESCAPE)
    assert len(all_cards(home)) == len(examples()) + 1, "each once, and a new drawing"
    home.draw(surface)
    home.page.turn(9)
    found("contact")
    home.draw(surface)
    assert home.page._area.contains(home.page._seen(home.page.places[0][1])), "what Enter opens"
    found("qq")
    home.draw(surface)
    press(home, pygame.K_RETURN)
    assert home.choice is None


def test_a_game_has_one_card_with_two_buttons(memory):
    home, _ = shown(memory)
    game = games()[0]
    assert {command for _, command in home.page.buttons} >= {("play", game), ("demo", game)}
    for place, command in home.page.buttons[:2]:
        home, _ = shown(memory)
        home.handle(pygame.Event(pygame.MOUSEBUTTONDOWN, button=1, pos=place.center))
        assert home.choice == command
    for mod, verb in ((0, "play"), (pygame.KMOD_LSHIFT, "demo")):
        home, _ = shown(memory)
        press(home, pygame.K_DOWN)
        key = {"key": pygame.K_RETURN, "unicode": "\r", "mod": mod}
        home.handle(pygame.Event(pygame.KEYDOWN, **key))
        assert home.choice == (verb, game)


def test_arrows_and_enter_choose(memory):
    home, surface = shown(memory)
    press(home, pygame.K_DOWN)
    press(home, pygame.K_RIGHT)
    home.draw(surface)
    press(home, pygame.K_RETURN)
    assert home.choice == ("play", games()[1])


def test_the_wheel_scrolls_to_the_last_card(memory):
    home, surface = shown(memory)
    home.handle(pygame.Event(pygame.MOUSEWHEEL, y=-200))
    home.draw(surface)
    last = len(home.page.places) - 1
    assert any(home.page.at((x, 600)) == last for x in range(0, 1280, 20))


def test_a_file_that_is_dropped_opens_and_another_one_is_told_of(memory, tmp_path):
    home, _ = shown(memory)
    home.handle(pygame.Event(pygame.DROPFILE, file=str(tmp_path / "a.docx")))
    assert home.choice is None
    home.handle(pygame.Event(pygame.DROPFILE, file=str(tmp_path / "walk.py")))
    assert home.choice == ("run", str(tmp_path / "walk.py"))


def test_buttons_and_keys_change_colours_and_text_and_f1_tells_them(memory):
    home, surface = shown(memory)
    before = pygame.surfarray.array3d(surface).mean()
    for name in ("dark", "text"):
        place = home._buttons.places[name]
        home.handle(pygame.Event(pygame.MOUSEBUTTONDOWN, button=1, pos=place.center))
    home.draw(surface)
    assert pygame.surfarray.array3d(surface).mean() < 0.5 * before
    assert home.looks.text == TEXT_SIZES[1]
    press(home, pygame.K_d, pygame.KMOD_LCTRL)
    press(home, pygame.K_z, pygame.KMOD_LCTRL)
    assert (home.painter.theme.dark, home.looks.text) == (False, TEXT_SIZES[2])
    press(home, pygame.K_F1)
    written = Written((1280, 720))
    home.painter.fonts = Pens()
    home.draw(written)
    told = {"Ctrl D", "Ctrl Z", "Shift Enter", "F11", "Ctrl Q"}
    assert told <= set(written.texts)
    press(home, pygame.K_ESCAPE)
    assert not home.help.is_open
    press(home, pygame.K_w, pygame.KMOD_LCTRL)
    assert not home._open


# -- memory ---------------------------------------------------------------------------------------


def test_files_last_opened_come_first_with_their_pictures(memory, tmp_path):
    red = pygame.Surface((700, 500), 0, 32)
    red.fill("red")
    (tmp_path / "tag").mkdir()
    for name in ("tag/game.py", "a.py", "b.toml", "gone.py", "a.py"):
        (tmp_path / name).touch()
        memory.opened(tmp_path / name, red)
    (tmp_path / "gone.py").unlink()
    names = ["a.py", "b.toml", "tag/game.py"]
    assert Memory().recent == [tmp_path / name for name in names]
    home, surface = shown(Memory())
    assert [card.title for card in home.shelves[0].cards] == ["New drawing", *names]
    place = home.page.places[1][1]
    pixels = pygame.surfarray.array3d(surface)
    near = pixels[place.left : place.right, place.top + 80 : place.top + 180].reshape(-1, 3)
    assert (np.abs(near.astype(int) - (255, 0, 0)).sum(axis=1) < 10).mean() > 0.5


def test_looks_are_remembered_and_what_is_asked_for_counts_more(memory):
    memory.keep(dark=True, text=1.7, size=[1000, 700])
    assert Memory().preferences() == Preferences(dark=True, text=1.7)
    assert Memory().preferences(dark=False, text=1.3) == Preferences(dark=False, text=1.3)
    assert Memory().size == (1000, 700)
    memory.keep(panels=["scopes", 3])
    assert Memory().panels == ["scopes"]


# -- the command ----------------------------------------------------------------------------------


def test_without_a_display_the_command_alone_prints_its_help(capsys, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    assert main([]) == 0
    alone = capsys.readouterr().out
    with pytest.raises(SystemExit):
        main(["--help"])
    assert alone == capsys.readouterr().out
    assert main(["--bogus"]) == 2
    assert "--bogus" in capsys.readouterr().err
