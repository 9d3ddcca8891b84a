"""Animated GIFs: one palette for all frames, and of each frame only the part that has changed.

Pillow compresses the parts. Its own writer of animations keeps all frames in memory until the end.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, BinaryIO

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pygame

Rgb = NDArray[np.uint32]
"""Pixels as 0x..rrggbb; the highest byte is ignored."""
Entries = NDArray[np.uint8]
"""Pixels as entries of the palette."""
Corner = tuple[int, int]

CLEAR = 255
"""The palette's entry for a pixel that stays as it was."""


def write_gif(file: BinaryIO, pictures: Iterator[pygame.Surface], fps: float) -> int:
    """Write pictures as an animated GIF and return their number.

    A picture that is equal to the one before prolongs its frame. `file` stays open.
    """
    written = shown = 0  # hundredths of a second
    canvas: _Canvas | None = None
    pending: tuple[Entries, Corner] | None = None
    count = 0
    for picture in pictures:
        if canvas is None:
            palette = _Palette(_colors(picture))
            canvas = _Canvas(palette, picture.get_size())
            _write_head(file, palette.colors, picture.get_size())
        change = canvas.change(picture)
        if change is not None:
            if pending is not None:
                _write_frame(file, *pending, shown - written)
                written = shown
            pending = change
        count += 1
        shown = round(100 * count / fps)
    if pending is not None:
        _write_frame(file, *pending, shown - written)
    file.write(b";")
    return count


def _write_head(file: BinaryIO, palette: Entries, size: tuple[int, int]) -> None:
    """Write the header: size, a palette of 256 colours, and that the film repeats for ever."""
    colors = palette.tobytes().ljust(768, b"\0")
    sides = size[0].to_bytes(2, "little") + size[1].to_bytes(2, "little")
    file.write(b"GIF89a" + sides + b"\xf7\x00\x00" + colors)
    file.write(b"!\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00")


def _write_frame(file: BinaryIO, entries: Entries, corner: Corner, pause: int) -> None:
    """Write a part of the picture, which is seen for `pause` hundredths of a second."""
    from PIL import GifImagePlugin, Image

    image = Image.frombuffer("P", entries.shape[::-1], entries)
    for block in GifImagePlugin.getdata(
        image, corner, duration=10 * min(pause, 65_535), transparency=CLEAR, disposal=1
    ):
        file.write(block)


class _Canvas:
    """The picture that is seen so far, to be compared with the next one."""

    def __init__(self, palette: _Palette, size: tuple[int, int]) -> None:
        """Start without a picture; size: pixels."""
        self._palette = palette
        self._width, height = size
        self._pixels: Rgb | None = None
        self._entries = np.full(self._width * height, CLEAR, dtype=np.uint8)

    def change(self, picture: pygame.Surface) -> tuple[Entries, Corner] | None:
        """Return the smallest part that a picture changes and its corner; None without a change.

        The part is (height, width), with `CLEAR` where nothing changes: long runs of one value
        compress to almost nothing.
        """
        pixels = _pixels(picture)
        if self._pixels is None:
            changed = np.arange(len(pixels))
        else:
            changed = np.flatnonzero(pixels != self._pixels)
        entries = self._palette.entries(pixels[changed])
        self._pixels = pixels.copy()
        differs = entries != self._entries[changed]
        changed, entries = changed[differs], entries[differs]
        self._entries[changed] = entries
        if len(changed) == 0:
            return None
        top, bottom = int(changed[0]) // self._width, int(changed[-1]) // self._width + 1
        band = np.full((bottom - top, self._width), CLEAR, dtype=np.uint8)
        band.ravel()[changed - top * self._width] = entries
        columns = np.flatnonzero(band.min(axis=0) != CLEAR)
        part = band[:, columns[0] : columns[-1] + 1]
        return np.ascontiguousarray(part), (int(columns[0]), top)


class _Palette:
    """The colours of a GIF (k, 3), k < 256, and the nearest of them to any other colour.

    The nearest is looked up once for each colour of six bits a channel. The palette's own colours
    match themselves, so that white stays white.
    """

    def __init__(self, colors: Entries) -> None:
        """Enter the palette's own colours."""
        from scipy.spatial import cKDTree

        self.colors = colors
        self._nearest = cKDTree(colors)
        self._found = np.full(1 << 18, CLEAR, dtype=np.uint8)
        red, green, blue = colors.astype(int).T >> 2
        backwards = np.arange(len(colors))[::-1]  # of two with one code, the first counts
        self._found[(red << 12 | green << 6 | blue)[backwards]] = backwards

    def entries(self, pixels: Rgb) -> Entries:
        """Return the entry for each of some pixels."""
        codes = (pixels >> 6 & 0x3F000) | (pixels >> 4 & 0xFC0) | (pixels >> 2 & 0x3F)
        entries: Entries = self._found[codes]
        if (entries == CLEAR).any():
            wanted = np.zeros(len(self._found), dtype=bool)
            wanted[codes[entries == CLEAR]] = True
            new = np.flatnonzero(wanted)
            channels = np.column_stack([new >> 12, new >> 6 & 63, new & 63])
            self._found[new] = self._nearest.query(4 * channels + 1.5)[1]
            entries = self._found[codes]
        return entries


def _colors(surface: pygame.Surface) -> Entries:
    """Return a palette (k, 3), k < 256: the first picture's colours and their tints.

    Robots move over white, obstacles and each other, so shades between each strong colour and its
    surroundings are added to the colours of the first picture; then the colours of the banner at
    the end, and a few from the whole range for add-ons.
    """
    import pygame
    from PIL import Image

    from mars2d.output.raster.theme import PRINTED

    values, counts = np.unique(_pixels(surface) & 0xFFFFFF, return_counts=True)
    order = np.argsort(counts, kind="stable")[::-1]
    values, counts = values[order], counts[order]
    counted = np.column_stack([values >> 16, values >> 8 & 255, values & 255]).astype(int)
    vivid = (counts >= 4) & (np.ptp(counted, axis=1) > 60)
    strong = [tuple(color) for color in counted[vivid][:12].tolist()]
    wanted = [tuple(color) for color in counted[:24].tolist()]
    for ground in ((255, 255, 255), (184, 192, 200)):
        for share in (0.85, 0.2, 0.4, 0.6, 0.1):
            wanted += [_mixed(color, ground, share) for color in strong]
    for banner in (PRINTED.over, PRINTED.failed):
        ink = tuple(bytes.fromhex(banner[1:]))
        wanted += [_mixed(ink, (255, 255, 255), share) for share in (1.0, 0.8, 0.6, 0.4, 0.2)]
    wanted += [(r, g, b) for r in (0, 128, 255) for g in (0, 128, 255) for b in (0, 128, 255)]
    # Every other pixel is enough, and counted several times as fast.
    width, height = surface.get_size()
    picture = Image.frombytes("RGB", (width, height), pygame.image.tobytes(surface, "RGB"))
    picture = picture.resize((width // 2, height // 2), Image.Resampling.NEAREST)
    reduced = picture.quantize(colors=256, method=Image.Quantize.MEDIANCUT)
    rest = reduced.getpalette() or []
    wanted += [tuple(rest[k : k + 3]) for k in range(0, len(rest), 3)]
    cells: dict[tuple[int, ...], tuple[int, ...]] = {}
    for color in wanted:  # of colours that look alike, only the first
        cells.setdefault(tuple(c // 6 for c in color), color)
    return np.array(list(cells.values())[:CLEAR], dtype=np.uint8)


def _pixels(surface: pygame.Surface) -> Rgb:
    """Return a surface's own pixels, row by row; it is locked while they are in use."""
    import pygame

    pixels: Rgb = pygame.surfarray.pixels2d(surface).ravel(order="F")
    return pixels


def _mixed(color: tuple[int, ...], ground: tuple[int, ...], share: float) -> tuple[int, ...]:
    """Return a colour laid over a ground with an opacity from 0 to 1."""
    return tuple(round(g + share * (c - g)) for c, g in zip(color, ground, strict=True))
