"""The bars round the picture: the header with the time, and the footer with messages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import pygame

from mars2d.output.excerpt import Excerpt
from mars2d.output.raster.layout import FOOTER, Layout, interface_scale
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.theme import Tone
from mars2d.record.frame import Frame

Kind = Literal["running", "waiting", "past", "hand", "error"]

LINE_HEIGHT, CODE_LINE_HEIGHT = 23.0, 20.0
"""The heights of a banner's lines, points."""
MAX_BANNER_LINES = 8
MAX_CODE_LINES = 5
MAX_BANNER_SHARE = 0.5
"""The largest share of the surface's height: longer text is cut, lines of code are left out."""
MIN_TITLE_WIDTH, NUMBER_WIDTH = 110.0, 120.0
"""The least width of a title, and about that of time and step, which makes room first, points."""


@dataclass(frozen=True, slots=True)
class Status:
    """The chip in the header: the state of the clock, in words and by its colour.

    kind: "running"; "waiting", for example paused; "past", an instant before the newest is shown;
    "hand", a robot is driven by hand; "error".
    """

    text: str
    kind: Kind = "running"


@dataclass(frozen=True, slots=True)
class Banner:
    """A message across the foot of the picture; excerpt: the lines of code it concerns.

    hint: the keys to continue with.
    """

    text: str
    hint: str = ""
    error: bool = False
    excerpt: Excerpt | None = None


# -- the header -----------------------------------------------------------------------------------


def draw_header(
    surface: pygame.Surface, layout: Layout, painter: Painter, frame: Frame, status: Status | None
) -> None:
    """Draw the title on the left, the time, step and status on the right.

    If there is no room for all, the step is left out first, then the title.
    """
    ui, bar, fonts, theme = layout.ui, layout.header, painter.fonts, painter.theme
    surface.fill(theme.bar, bar)
    surface.fill(theme.edge, (bar.left, bar.bottom - 1, bar.width, 1))
    pad, gap, space = round(20 * ui), round(24 * ui), round(8 * ui)
    right, scenario, title = bar.right - pad, frame.scenario, frame.scenario.title
    if status is not None:
        right = _chip(surface, painter, status, right, bar, ui) - gap
    step = scenario.sampling_time  # two of which the decimals tell apart
    digits = next((k for k in (1, 2) if abs(round(step, k) - step) < 1e-9), 3)
    values = {"step": str(frame.iteration), "time": f"{frame.time:.{digits}f} s"}
    least = min(MIN_TITLE_WIDTH * ui, fonts.width(title, 20 * ui, bold=True))
    if right < 2 * NUMBER_WIDTH * ui + least + 2 * gap + pad:
        del values["step"]
    for name, value in values.items():
        place = right, bar.centery
        end = painter.write(surface, value, 18 * ui, theme.ink, midright=place).left - space
        place = end, bar.centery + round(ui)
        right = painter.write(surface, name, 14 * ui, theme.muted, midright=place).left - gap
    shown = fonts.shorten(title, 20 * ui, right - pad, bold=True)
    if len(shown) > 3 or shown == title:
        painter.write(surface, shown, 20 * ui, theme.ink, bold=True, midleft=(pad, bar.centery))


def _chip(
    surface: pygame.Surface, painter: Painter, status: Status, right: int, bar: pygame.Rect,
    ui: float,
) -> int:  # fmt: skip
    """Draw the status as words on a coloured plate; return its left end."""
    tone: Tone = getattr(painter.theme, status.kind)
    text = painter.fonts.shorten(status.text, 17 * ui, 0.45 * bar.width, bold=True)
    image = painter.fonts.render(text, 17 * ui, tone.ink, bold=True)
    width = max(image.get_width() + round(26 * ui), round(76 * ui))
    plate = pygame.Rect(right - width, 0, width, round(32 * ui))
    plate.centery = bar.centery
    painter.panel(surface, plate, tone.pale, plate.height / 2)
    surface.blit(image, image.get_rect(center=plate.center))
    return plate.left


# -- the footer -----------------------------------------------------------------------------------


def draw_footer(
    surface: pygame.Surface,
    layout: Layout,
    painter: Painter,
    banner: Banner | None,
    left: str,
    hints: Sequence[tuple[str, str]] = (),
) -> None:
    """Draw the banner across the footer, or a plain line of text if there is none.

    left: text. hints: (key, action) pairs at the right end; the first ones are left out if there is
    no room.
    """
    ui, bar, fonts, theme = layout.ui, layout.footer, painter.fonts, painter.theme
    if bar.height <= 0:
        return
    if banner is not None:
        _draw_banner(surface, bar, painter, banner, ui)
        return
    pad = round(20 * ui)
    surface.fill(theme.bar, bar)
    surface.fill(theme.edge, (bar.left, bar.top, bar.width, 1))
    end = _hints(surface, painter, hints, bar, ui)
    text = fonts.shorten(left, 14 * ui, end - 2 * pad)
    if len(text) > 3:
        painter.write(surface, text, 14 * ui, theme.muted, midleft=(pad, bar.centery))


def _hints(
    surface: pygame.Surface,
    painter: Painter,
    hints: Sequence[tuple[str, str]],
    bar: pygame.Rect,
    ui: float,
) -> int:
    """Write keys and their actions, from the right; return the left end."""
    fonts, theme = painter.fonts, painter.theme
    right = bar.right - round(20 * ui)
    for key, meaning in reversed(hints):
        wide = fonts.width(meaning, 14 * ui) + fonts.width(key, 14 * ui, bold=True)
        if right - wide < bar.left + round(26 * ui):
            break
        place = right, bar.centery
        right = painter.write(surface, meaning, 14 * ui, theme.muted, midright=place).left
        place = right - round(6 * ui), bar.centery
        right = painter.write(surface, key, 14 * ui, theme.text, bold=True, midright=place).left
        right -= round(20 * ui)
    return right


def footer_height(
    banner: Banner | None,
    size: tuple[int, int],
    painter: Painter,
    text: float = 1.0,
    scale: float = 1.0,
) -> float:
    """Return the height of the footer, points: more than one line for a long message."""
    if banner is None:
        return FOOTER
    lines, below, code = _banner_rows(banner, size, painter, interface_scale(size, text, scale))
    return FOOTER + LINE_HEIGHT * (len(lines) - 1 + below) + _code_height(code)


def _code_height(lines: int) -> float:
    return CODE_LINE_HEIGHT * lines + 20 if lines > 0 else 0.0


def _banner_rows(
    banner: Banner, size: tuple[int, int], painter: Painter, ui: float
) -> tuple[list[str], bool, int]:
    """Return the lines of a banner's text, whether its hint is below, and its lines of code."""
    hint = painter.fonts.width(banner.hint, 15 * ui) + 40 * ui if banner.hint else 0.0
    below = hint > 0.4 * size[0]
    wide = size[0] - 40 * ui - (0 if below else hint)
    code = 0 if banner.excerpt is None else min(MAX_CODE_LINES, len(banner.excerpt.lines))
    high = MAX_BANNER_SHARE * size[1] / ui - FOOTER  # beside the first line
    most = 1 + int((high - _code_height(min(code, 1))) / LINE_HEIGHT) - below
    lines = painter.fonts.wrap(
        banner.text, 18 * ui, wide, min(max(most, 1), MAX_BANNER_LINES), bold=True
    )
    left = high - LINE_HEIGHT * (len(lines) - 1 + below) - 20
    return lines, below, max(0, min(code, int(left / CODE_LINE_HEIGHT)))


def _draw_banner(
    surface: pygame.Surface, bar: pygame.Rect, painter: Painter, banner: Banner, ui: float
) -> None:
    theme, pad = painter.theme, round(20 * ui)
    surface.fill(theme.failed if banner.error else theme.over, bar)
    lines, hint_below, code = _banner_rows(banner, surface.get_size(), painter, ui)
    step = LINE_HEIGHT * ui
    text = pygame.Rect(bar.left, bar.top, bar.width, bar.height - round(_code_height(code) * ui))
    y = text.centery - step * (len(lines) - 1 + hint_below) / 2
    for line in lines:
        painter.write(surface, line, 18 * ui, theme.on_banner, bold=True, midleft=(pad, y))
        y += step
    at = {"midleft": (pad, y)} if hint_below else {"midright": (bar.right - pad, text.centery)}
    painter.write(surface, banner.hint, 15 * ui, theme.on_banner_muted, **at)
    if banner.excerpt is not None and code > 0:
        place = pygame.Rect(pad, text.bottom, bar.width - 2 * pad, bar.bottom - text.bottom)
        place.height -= round(12 * ui)
        _draw_code(surface, place, painter, banner.excerpt.nearest(code), ui)


def _draw_code(
    surface: pygame.Surface, place: pygame.Rect, painter: Painter, excerpt: Excerpt, ui: float
) -> None:
    """Draw lines of code with their numbers, and mark the line concerned."""
    fonts, theme = painter.fonts, painter.theme
    painter.panel(surface, place, theme.banner_plate, 6 * ui)
    size, pad = 14 * ui, round(10 * ui)
    digits = fonts.width("0" * len(str(excerpt.first + len(excerpt.lines))), size, mono=True)
    left = place.left + pad + fonts.width("▸ ", size, mono=True) + digits
    for k, line in enumerate(excerpt.lines):
        row = pygame.Rect(place.left, 0, place.width, round(CODE_LINE_HEIGHT * ui))
        row.top = round(place.top + 4 * ui + k * CODE_LINE_HEIGHT * ui)
        number, here = excerpt.first + k, excerpt.first + k == excerpt.line
        if here:
            painter.panel(surface, row.inflate(-round(6 * ui), 0), "#ffffff30", 4 * ui)
            at = place.left + pad, row.centery
            painter.write(surface, "▸", size, theme.on_banner, mono=True, midleft=at)
        color = theme.on_banner if here else theme.on_banner_muted
        at = left, row.centery
        painter.write(surface, str(number), size, color, mono=True, midright=at)
        at = left + round(14 * ui), row.centery
        text = fonts.shorten(line, size, place.right - pad - at[0], mono=True)
        painter.write(surface, text, size, color, mono=True, midleft=at)
