"""The help: all keys in groups, laid out in columns, on several pages if need be."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import pygame

from mars2d.output.raster.layout import Layout
from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.actions import Action
from mars2d.window.widgets.rows import Row, draw_rows, height_of

SHARES = (1.0, 0.85, 0.7)
"""The scales that are tried until all is on one page, as shares of the window's."""
SIZE, ROW, LINE = 15.0, 31.0, 19.0
"""The heights of letters, of a row, and of each further line of a row, points."""
HEADING = 42.0
"""The height of a group's heading, points."""
TOP, PAD, BETWEEN = 62.0, 28.0, 34.0
"""The height of the title, the margin, and the gap between two columns, points."""
CAPS, WORDS = 114.0, (150.0, 390.0)
"""The room for keys, and the narrowest and widest line of words, points."""
MOST = 3
"""The most columns of a page."""


class Help:
    """The help of a window; page: the open page, from 0, or None if it is closed.

    pages: how many there were when it was last drawn.
    """

    def __init__(self) -> None:
        """Start closed."""
        self.page: int | None = None
        self.pages = 1

    @property
    def is_open(self) -> bool:
        """Whether a page is open."""
        return self.page is not None

    def turn(self) -> None:
        """Open the help, turn the page, or close it after the last page."""
        page = 0 if self.page is None else self.page + 1
        self.page = page if page < self.pages else None

    def close(self) -> None:
        """Close the help."""
        self.page = None

    def draw(
        self,
        surface: pygame.Surface,
        layout: Layout,
        painter: Painter,
        groups: Iterable[tuple[str, Sequence[Action]]],
    ) -> None:
        """Draw the open page over the picture, if there is one.

        groups: pairs of a heading and its keys.
        """
        if self.page is None:
            return
        area, largest, theme = surface.get_rect(), painter.ui, painter.theme
        area.height, area.top = area.height - layout.header.bottom, layout.header.bottom
        least, most = WORDS
        for share in SHARES:
            ui = painter.ui = share * largest
            wide, high = area.width / ui - 2 * PAD, area.height / ui - 16
            count = max(1, min(MOST, int((wide + BETWEEN) / (CAPS + least + BETWEEN))))
            width = round(min(CAPS + most, (wide + BETWEEN) / count - BETWEEN) * ui)
            rows = [row for named in groups for row in _rows(painter, *named, width)]
            columns = [*_filled(rows, high - TOP - PAD)]
            if len(columns) <= count:
                break
        self.pages = -(-len(columns) // count)
        self.page = min(self.page, self.pages - 1)
        draw_veil(surface, painter, area)
        pad, step = round(PAD * ui), width + round(BETWEEN * ui)
        plate = pygame.Rect(0, 0, min(count, len(columns)) * step + 2 * pad - step + width, 0)
        plate.height = round((TOP + max(map(height_of, columns)) + PAD) * ui)
        plate.center = area.center
        painter.panel(surface, plate, theme.plate, 14 * ui, theme.edge)
        title = f"Keys, page {self.page + 1} of {self.pages}" if self.pages > 1 else "Keys"
        word = "F1 goes on" if self.page + 1 < self.pages else "F1 closes this"
        at, end = plate.move(pad, round(34 * ui)).topleft, plate.move(-pad, round(34 * ui)).topright
        painter.write(surface, title, 21 * ui, theme.ink, bold=True, midleft=at)
        painter.write(surface, word, 14 * ui, theme.muted, midright=end)
        for k, column in enumerate(columns[self.page * count : (self.page + 1) * count]):
            place = pygame.Rect(plate.left + pad + k * step, plate.top + round(TOP * ui), width, 0)
            draw_rows(surface, column, place, ui)
        painter.ui = largest


def _rows(painter: Painter, heading: str, keys: Iterable[Action], width: int) -> Iterator[Row]:
    """Yield the heading of a group, and its keys."""
    ui, fonts, theme = painter.ui, painter.fonts, painter.theme

    def draw(surface: pygame.Surface, place: pygame.Rect) -> None:
        at = place.left, place.bottom - 16 * ui
        painter.write(surface, heading, SIZE * ui, theme.running.ink, bold=True, midleft=at)
        surface.fill(theme.edge, (place.left, place.bottom - round(3 * ui), place.width, 1))

    yield Row(HEADING, draw, heading)
    for key in keys:
        left = max(CAPS * ui, sum(_widths(painter, key.labels)) + 10 * ui)
        lines = fonts.wrap(key.help, SIZE * ui, width - left, 4)
        yield row_of_keys(painter, key.labels, lines, left)


def row_of_keys(
    painter: Painter, keys: Sequence[str], lines: Sequence[str], left: float = 0.0
) -> Row:
    """Return a row of the caps of keys, and beside them, or further right, what they do.

    left: where the lines begin at least, pixels.
    """
    ui, theme = painter.ui, painter.theme

    def draw(surface: pygame.Surface, place: pygame.Rect) -> None:
        x, middle = place.left, place.top + round(ROW * ui / 2)
        for name, width in zip(keys, _widths(painter, keys), strict=True):
            plate = pygame.Rect(x, middle - round(13 * ui), width - round(6 * ui), round(26 * ui))
            painter.panel(surface, plate.move(0, round(2 * ui)), theme.key_edge, 6 * ui)
            painter.panel(surface, plate, theme.key, 6 * ui, theme.key_edge)
            at, x = plate.center, x + width
            painter.write(surface, name, 14 * ui, theme.text, bold=True, center=at)
        for k, line in enumerate(lines):
            at = round(max(place.left + left, x + 4 * ui)), middle + round(k * LINE * ui)
            painter.write(surface, line, SIZE * ui, theme.text, midleft=at)

    return Row(ROW + LINE * (len(lines) - 1), draw)


def _widths(painter: Painter, keys: Sequence[str]) -> list[int]:
    """Return the widths of the caps of keys with the gaps beside them, pixels."""
    ui = painter.ui
    wide = [painter.fonts.width(key, 14 * ui, bold=True) for key in keys]
    return [round(max(each / ui + 18, 30) * ui) + round(6 * ui) for each in wide]


def _filled(rows: Iterable[Row], limit: float) -> Iterator[list[Row]]:
    """Yield columns of rows up to a height, points; no heading stands last."""
    column: list[Row] = []
    for row in rows:
        if column and height_of([*column, row]) + ROW * bool(row.name) > limit:
            yield column
            column = []
        column.append(row)
    yield column


def draw_veil(surface: pygame.Surface, painter: Painter, area: pygame.Rect) -> None:
    """Draw a veil over a part of the surface that does not take the mouse now."""
    veil = pygame.Surface(area.size, 0, 32)
    veil.fill(painter.theme.veil)
    veil.set_alpha(150 if painter.theme.dark else 70)
    surface.blit(veil, area)
