"""What stands around the picture: the header, the footer, and the page of help."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import pygame

from mars2d.frame import Frame
from mars2d.scenario import Scenario
from mars2d.view import theme
from mars2d.view.camera import Camera, Margins
from mars2d.view.keys import Key
from mars2d.view.painter import Painter

__all__ = ["Banner", "Layout", "Status", "draw_footer", "draw_header", "draw_help", "fitted"]

BANNER_LINES = 8
UNREADABLE = 0.2
"""Pixels a point below which a page of text is not worth drawing."""
FOOTER = 44.0
"""The height of the footer, and of a banner of one line in its place, points."""


@dataclass(frozen=True, slots=True)
class Status:
    """The chip in the header: what the clock does. `waiting`: it stands still."""

    text: str
    waiting: bool = False
    error: bool = False


@dataclass(frozen=True, slots=True)
class Banner:
    """What has to be said across the foot of the picture."""

    text: str
    hint: str = ""
    error: bool = False


@dataclass(frozen=True, slots=True)
class Layout:
    """Where everything lies on a surface; ui: pixels a point."""

    ui: float
    header: pygame.Rect
    plot: pygame.Rect
    footer: pygame.Rect

    @classmethod
    def of(cls, size: tuple[int, int], footer_height: float = FOOTER) -> Layout:
        """Divide a surface of `size` pixels; `footer_height` in points."""
        width, height = size
        ui = interface_scale(size)
        top = round(52 * ui)
        bottom = min(round(footer_height * ui), max(0, height - top - 40))
        return cls(
            ui,
            pygame.Rect(0, 0, width, top),
            pygame.Rect(0, top, width, max(1, height - top - bottom)),
            pygame.Rect(0, height - bottom, width, bottom),
        )


def interface_scale(size: tuple[int, int]) -> float:
    """Return the pixels a point on a surface of `size` pixels: 1 at 1280 x 720."""
    share = min(size[0] / 1280, size[1] / 720)
    return max(0.9, float(share**0.8))


def fitted(scenario: Scenario, size: tuple[int, int], layout: Layout) -> Camera:
    """Return the camera that shows the whole workspace between the bars, with room for labels."""
    ui, plot = layout.ui, layout.plot
    margins: Margins = (
        plot.left + 48 * ui, plot.top + 22 * ui,
        size[0] - plot.right + 48 * ui, size[1] - plot.bottom + 34 * ui,
    )  # fmt: skip
    return Camera.fit(scenario.bounds, size, margins)


def draw_header(
    surface: pygame.Surface, layout: Layout, painter: Painter, frame: Frame, status: Status | None
) -> None:
    """Draw the title on the left, the time, iteration and status on the right."""
    ui, bar, fonts = layout.ui, layout.header, painter.fonts
    surface.fill(theme.BAR, bar)
    surface.fill(theme.EDGE, (bar.left, bar.bottom - 1, bar.width, 1))
    pad = round(20 * ui)
    right = bar.right - pad
    widest = "0" * len(str(frame.scenario.last_iteration))
    if status is not None:
        right = _chip(surface, painter, status, right, bar.centery, ui) - round(24 * ui)
    right = _figure(surface, painter, "step", str(frame.iteration), widest, right, bar, ui)
    right -= round(24 * ui)
    digits = decimals(frame.scenario)
    widest = f"{frame.scenario.stop_time:.{digits}f} s"
    widest = widest if len(widest) < 12 else "00000.00 s"
    value = f"{frame.time:.{digits}f} s"
    right = _figure(surface, painter, "time", value, widest, right, bar, ui)
    room = right - pad - round(24 * ui)
    title = fonts.shorten(frame.scenario.title, 20 * ui, room, bold=True)
    image = fonts.render(title, 20 * ui, theme.INK, bold=True)
    surface.blit(image, image.get_rect(midleft=(pad, bar.centery)))


def decimals(scenario: Scenario) -> int:
    """Return how many decimals tell two sampling times apart: 1 to 3."""
    step = scenario.sampling_time
    return next((k for k in (1, 2) if abs(round(step, k) - step) < 1e-9), 3)


def _figure(
    surface: pygame.Surface,
    painter: Painter,
    name: str,
    value: str,
    widest: str,
    right: int,
    bar: pygame.Rect,
    ui: float,
) -> int:
    """Draw a name and its value, the name at a place that does not tremble; return its left end."""
    fonts = painter.fonts
    image = fonts.render(value, 18 * ui, theme.INK)
    width = max(image.get_width(), fonts.width(widest, 18 * ui))
    surface.blit(image, image.get_rect(midright=(right, bar.centery)))
    label = fonts.render(name, 14 * ui, theme.MUTED)
    place = label.get_rect(midright=(right - width - round(8 * ui), bar.centery + round(ui)))
    surface.blit(label, place)
    return place.left


def _chip(
    surface: pygame.Surface, painter: Painter, status: Status, right: int, middle: int, ui: float
) -> int:
    """Draw the status as a word on a coloured plate; return its left end."""
    ink = theme.WAITING if status.waiting else theme.RUNNING
    fill = theme.WAITING_PALE if status.waiting else theme.RUNNING_PALE
    if status.error:
        ink, fill = theme.ERROR, theme.ERROR_PALE
    image = painter.fonts.render(status.text, 17 * ui, ink, bold=True)
    width = max(image.get_width() + round(26 * ui), round(76 * ui))
    plate = pygame.Rect(right - width, 0, width, round(32 * ui))
    plate.centery = middle
    painter.panel(surface, plate, fill, plate.height / 2)
    surface.blit(image, image.get_rect(center=plate.center))
    return plate.left


def footer_height(banner: Banner | None, size: tuple[int, int], painter: Painter) -> float:
    """Return how high the footer must be, points: more than one line for a long message."""
    if banner is None:
        return FOOTER
    return FOOTER - 23.0 + 23.0 * len(_banner_lines(banner, size, painter))


def _banner_lines(banner: Banner, size: tuple[int, int], painter: Painter) -> list[str]:
    ui = interface_scale(size)
    hint = painter.fonts.width(banner.hint, 15 * ui) + 40 * ui if banner.hint else 0
    room = size[0] - 40 * ui - hint
    return painter.fonts.wrap(banner.text, 18 * ui, room, BANNER_LINES, bold=True)


def draw_footer(
    surface: pygame.Surface,
    layout: Layout,
    painter: Painter,
    banner: Banner | None,
    left: str,
    hints: Sequence[tuple[str, str]] = (),
) -> None:
    """Draw the banner across the footer, or where there is none a quiet line of text.

    hints: pairs of a key and what it does, for the right end.
    """
    ui, bar, fonts = layout.ui, layout.footer, painter.fonts
    if bar.height <= 0:
        return
    pad = round(20 * ui)
    if banner is None:
        surface.fill(theme.BAR, bar)
        surface.fill(theme.EDGE, (bar.left, bar.top, bar.width, 1))
        end = _hints(surface, painter, hints, bar.right - pad, bar.centery, ui)
        text = fonts.shorten(left, 14 * ui, end - 2 * pad)
        image = fonts.render(text, 14 * ui, theme.MUTED)
        surface.blit(image, image.get_rect(midleft=(pad, bar.centery)))
        return
    surface.fill(theme.ERROR if banner.error else theme.OVER, bar)
    lines = _banner_lines(banner, surface.get_size(), painter)
    step = 23 * ui
    y = bar.centery - step * (len(lines) - 1) / 2
    for line in lines:
        image = fonts.render(line, 18 * ui, "#ffffff", bold=True)
        surface.blit(image, image.get_rect(midleft=(pad, round(y))))
        y += step
    hint = fonts.render(banner.hint, 15 * ui, "#e6ebf0")
    surface.blit(hint, hint.get_rect(midright=(bar.right - pad, bar.centery)))


def _hints(
    surface: pygame.Surface,
    painter: Painter,
    hints: Sequence[tuple[str, str]],
    right: int,
    middle: int,
    ui: float,
) -> int:
    """Write keys and what they do, from the right; return the left end."""
    for name, meaning in reversed(hints):
        word = painter.fonts.render(meaning, 14 * ui, theme.MUTED)
        key = painter.fonts.render(name, 14 * ui, theme.TEXT, bold=True)
        place = word.get_rect(midright=(right, middle))
        surface.blit(word, place)
        place = key.get_rect(midright=(place.left - round(6 * ui), middle))
        surface.blit(key, place)
        right = place.left - round(20 * ui)
    return right


def draw_help(
    surface: pygame.Surface, layout: Layout, painter: Painter, keys: Iterable[Key]
) -> None:
    """Draw the page of help over the picture: every key and what it does."""
    fonts = painter.fonts
    rows = [(key.labels, key.help) for key in keys]
    # Smaller where the page would not fit.
    room = layout.plot.height - 16
    ui = min(layout.ui, room / (104 + 36 * len(rows)), surface.get_width() / 680)
    if ui < UNREADABLE:
        return
    size, line = 16 * ui, round(36 * ui)
    caps = max(sum(_cap_width(painter, text, ui) for text in labels) for labels, _ in rows)
    words = max(fonts.width(text, size) for _, text in rows)
    pad = round(32 * ui)
    panel = pygame.Rect(0, 0, caps + words + pad * 3, line * len(rows) + round(92 * ui))
    panel.center = layout.plot.center
    veil = pygame.Surface(layout.plot.size, 0, 32)
    veil.fill(theme.INK)
    veil.set_alpha(70)
    surface.blit(veil, layout.plot)
    painter.panel(surface, panel, "#ffffff", 14 * ui, theme.EDGE)
    title = fonts.render("Keys", 22 * ui, theme.INK, bold=True)
    surface.blit(title, (panel.left + pad, panel.top + round(22 * ui)))
    hint = fonts.render("F1 closes this", 14 * ui, theme.MUTED)
    place = hint.get_rect(right=panel.right - pad, centery=panel.top + round(36 * ui))
    surface.blit(hint, place)
    y = panel.top + round(68 * ui) + line // 2
    for labels, text in rows:
        x = panel.left + pad
        for name in labels:
            x = _cap(surface, painter, name, x, y, ui)
        image = fonts.render(text, size, theme.TEXT)
        surface.blit(image, image.get_rect(midleft=(panel.left + pad * 2 + caps, y)))
        y += line


def _cap_width(painter: Painter, text: str, ui: float) -> int:
    width = painter.fonts.width(text, 14 * ui, bold=True) + round(18 * ui)
    return max(width, round(30 * ui)) + round(6 * ui)


def _cap(surface: pygame.Surface, painter: Painter, text: str, x: int, y: int, ui: float) -> int:
    """Draw one key as it looks on a keyboard; return where the next may begin."""
    width = _cap_width(painter, text, ui)
    plate = pygame.Rect(x, 0, width - round(6 * ui), round(27 * ui))
    plate.centery = y
    painter.panel(surface, plate.move(0, round(2 * ui)), "#cbd2d9", 6 * ui)
    painter.panel(surface, plate, "#f9fafb", 6 * ui, "#cbd2d9")
    image = painter.fonts.render(text, 14 * ui, theme.TEXT, bold=True)
    surface.blit(image, image.get_rect(center=plate.center))
    return x + width
