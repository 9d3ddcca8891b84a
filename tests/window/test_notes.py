"""Notes are read, fade and make room; errors stay until something replaces them."""

import numpy as np
import pygame

from mars2d.output.raster.layout import TEXT_SIZES, Layout
from mars2d.output.raster.theme import LIGHT
from mars2d.window.widgets.notes import STAYS, Notes
from tests.cases import each_case
from tests.window.written import painter, pixels

LONG = (
    "The film can't be written to /home/somebody/films/of/robots.mp4: there is no space left. " * 4
)


class Board:
    """Notes on an empty picture."""

    def __init__(self, theme=LIGHT, size=(1280, 720), text=1.0):
        self.layout = Layout.of(size, text=text, controls=True)
        self.painter = painter(self.layout, theme)
        self.notes, self.theme = Notes(), theme
        self.empty = self.draw(0.0)

    def draw(self, now):
        surface = pygame.Surface(self.layout.footer.bottomright, 0, 32)
        surface.fill(self.theme.page)
        self.notes.draw(surface, self.layout.plot, self.painter, now)
        return pixels(surface)

    def marks(self, now):
        """Return how much of the picture the notes change: 0 for nothing."""
        return float(np.abs(self.draw(now) - self.empty).sum())

    def seen(self, now):
        """Return the box of what the notes change: left, top, right, bottom."""
        ys, xs = np.nonzero(np.abs(self.draw(now) - self.empty).sum(axis=2))
        return xs.min(), ys.min(), xs.max() + 1, ys.max() + 1


def test_a_note_is_seen_for_five_seconds_from_its_first_picture_on_and_fades():
    board = Board()
    board.notes.say("saved walk_1.png")
    fresh = board.marks(100.0)
    assert fresh > 0
    assert board.marks(104.0) == fresh
    assert 0 < board.marks(104.7) < fresh
    assert board.marks(100.0 + STAYS) == 0
    assert len(board.notes) == 0


def test_an_error_stays_until_another_one_or_until_it_is_cleared():
    board = Board()
    board.notes.say("walk.py, line 3: no", "error")
    first = board.draw(0.0)
    assert np.array_equal(board.draw(1000.0), first)
    board.notes.say("saved")
    board.draw(1000.0)
    assert len(board.notes) == 2
    board.notes.say("walk.py, line 4: no", "error")
    assert len(board.notes) == 2
    board.draw(2000.0)
    assert len(board.notes) == 1
    board.notes.clear()
    assert board.marks(2000.0) == 0


def test_the_same_words_are_said_once_with_the_newest_number():
    board = Board()
    for now, text in ((0.0, "text 1.7 times as large"), (4.0, "text 2.2 times as large")):
        board.notes.say(text)
        board.draw(now)
    assert len(board.notes) == 1
    assert board.marks(8.0) > 0


@each_case("size, text", [((640, 480), 1.0), ((1280, 720), max(TEXT_SIZES))])
def test_long_notes_are_wrapped_and_stay_within_the_picture(size, text):
    board = Board(LIGHT, size, text)
    for kind in ("info", "warning", "error"):
        board.notes.say(f"{kind}: {LONG}", kind)
    left, top, right, bottom = board.seen(0.0)
    plot = board.layout.plot
    assert plot.collidepoint((left, top))
    assert right <= plot.right
    assert bottom <= plot.bottom
    assert right - left <= 0.63 * plot.width
