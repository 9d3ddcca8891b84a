"""The layout of a window or picture."""

from __future__ import annotations

from dataclasses import dataclass

import pygame

from mars2d.output.raster.camera import Camera, Margins

Bounds = tuple[float, float, float, float]

TEXT_SIZES = (1.0, 1.3, 1.7, 2.2)
"""Factors on the size of all text and lines."""
HEADER, FOOTER, STRIP = 52.0, 44.0, 44.0
"""The heights of header, footer and time bar, points. A banner of one line has the
height of the footer, which it replaces."""
TRANSPORT, TOOLS, LABELLED = 244.0, 44.0, 138.0
"""Widths of the buttons beside the time bar, and of the toolbar without and with labels, points."""
WIDE = 1100.0
"""The width of a surface from which on the toolbar has labels, points."""
MIN_WIDTH = 400.0
"""The least width of a surface, points, which limits the size of text."""
MAX_BARS_SHARE = 0.45
"""The largest share of the height for all bars, which limits the size of text."""


@dataclass(frozen=True, slots=True)
class Layout:
    """The rectangles of the parts of a surface; ui: pixels per point.

    transport, timebar, slider: side by side between the picture and the footer. tools: the toolbar
    at the left of the picture. These are empty if left out.
    """

    ui: float
    header: pygame.Rect
    plot: pygame.Rect
    footer: pygame.Rect
    timebar: pygame.Rect
    slider: pygame.Rect
    transport: pygame.Rect
    tools: pygame.Rect

    @property
    def size(self) -> tuple[int, int]:
        """The surface's width and height, pixels."""
        return self.header.width, self.footer.bottom

    @classmethod
    def of(
        cls,
        size: tuple[int, int],
        footer_height: float = FOOTER,
        *,
        text: float = 1.0,
        scale: float = 1.0,
        controls: bool = False,
    ) -> Layout:
        """Divide a surface of `size` pixels; `footer_height` in points.

        text: a factor for all text and lines. scale: the desktop's scaling factor. controls:
        whether there are buttons, a time bar and a slider of the speed.
        """
        width, height = size
        ui = interface_scale(size, text, scale)
        top = round(HEADER * ui)
        strip = min(round(STRIP * ui), max(0, height - top - 40)) if controls else 0
        bottom = min(round(footer_height * ui), max(0, height - top - strip - 40))
        foot = height - bottom
        right = round(min(max(0.24 * width, 160 * ui), 290 * ui, 0.285 * width)) if strip else 0
        buttons = round(min(TRANSPORT * ui, 0.28 * width)) if strip else 0
        plot = max(1, height - top - strip - bottom)
        tall = (height - top - strip) / ui - FOOTER
        columns = 1.0 if tall >= 520 else 1.9 if tall >= 330 else 2.7  # of buttons
        tools = round(min(columns * TOOLS * ui, 0.115 * width)) if controls else 0
        if tools and columns == 1.0 and width >= WIDE * ui:
            tools = round(LABELLED * ui)
        return cls(
            ui,
            header=pygame.Rect(0, 0, width, top),
            plot=pygame.Rect(tools, top, width - tools, plot),
            footer=pygame.Rect(0, foot, width, bottom),
            timebar=pygame.Rect(buttons, foot - strip, width - buttons - right, strip),
            slider=pygame.Rect(width - right, foot - strip, right, strip),
            transport=pygame.Rect(0, foot - strip, buttons, strip),
            tools=pygame.Rect(0, top, tools, plot),
        )


def next_text_size(text: float) -> float:
    """Return the next larger size of text, or after the largest the smallest."""
    return next((size for size in TEXT_SIZES if size > text), TEXT_SIZES[0])


def interface_scale(size: tuple[int, int], text: float = 1.0, scale: float = 1.0) -> float:
    """Return the pixels per point on a surface of `size` pixels: 1 at 1280 x 720.

    text, scale: as for `Layout.of`. If there is no room for such large text, it is made smaller.
    """
    width, height = size[0] / scale, size[1] / scale
    own = max(0.9, float(min(width / 1280, height / 720) ** 0.8))
    most = min(width / MIN_WIDTH, MAX_BARS_SHARE * height / (HEADER + STRIP + FOOTER))
    return scale * max(own, min(own * text, most))


def fitted(bounds: Bounds, size: tuple[int, int], layout: Layout) -> Camera:
    """Return the camera that shows bounds (xmin, xmax, ymin, ymax) [m] between the bars."""
    ui, plot = layout.ui, layout.plot
    margins: Margins = (
        plot.left + 48 * ui, plot.top + 22 * ui,
        size[0] - plot.right + 48 * ui, size[1] - plot.bottom + 34 * ui,
    )  # fmt: skip
    return Camera.fit(bounds, size, margins)
