"""Animated GIFs: one palette for all frames, and of each frame only the part that has changed.

Pillow finds the nearest colours and compresses the parts. Its own writer of animations keeps all
frames in memory until the end.
"""

from __future__ import annotations

from io import RawIOBase
from itertools import product
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pygame

Pixels = NDArray[np.uint32]
"""Pixels (height, width) as 0x..rrggbb; the highest byte is ignored."""

Entries = NDArray[np.uint8]
"""Pixels as entries of the palette."""

CLEAR = 255
"""The palette's entry for a pixel that stays as it was."""

FEW = 26
"""How many of the first picture's colours are in the palette, and half as many vivid ones."""

TINTS = (0.8, 0.6, 0.4, 0.2)
"""The shares of a vivid colour over white: of the edges of shapes, and of paths."""

LONGEST = 655_350
"""How long a frame is seen at most, milliseconds."""


class Gif:
    """Writes pictures of one size as an animated GIF that repeats for ever."""

    def __init__(self, file: BinaryIO | RawIOBase, fps: float) -> None:
        """Begin; `file` stays open at the end."""
        self._file, self._fps = file, fps
        self._count = self._written = 0  # frames; hundredths of a second
        self._last: Pixels | None = None
        self._pending: tuple[Entries, tuple[int, int]] | None = None

    def add(self, picture: pygame.Surface) -> None:
        """Add a picture; one that looks like the one before prolongs its frame."""
        import pygame

        pixels: Pixels = pygame.surfarray.pixels2d(picture).T.copy()
        if self._last is None:
            self._begin(pixels)
            changed = np.arange(pixels.size)
        else:
            changed = np.flatnonzero(pixels != self._last)
        entries, shown = self._nearest[_codes(pixels.ravel()[changed])], self._shown.reshape(-1)
        differs = entries != shown[changed]
        changed, entries = changed[differs], entries[differs]
        if len(changed):
            self._write_pending()
            shown[changed] = entries
            # Elsewhere it is CLEAR: long runs of one value compress to almost nothing.
            rows, columns = np.divmod(changed, pixels.shape[1])
            top, left = int(rows[0]), int(columns.min())
            part = np.full((rows[-1] - top + 1, columns.max() - left + 1), CLEAR, dtype=np.uint8)
            part[rows - top, columns - left] = entries
            self._pending = part, (left, top)
        self._last, self._count = pixels, self._count + 1

    def close(self) -> None:
        """Write the last frame and the end."""
        self._write_pending()
        self._file.write(b";")

    def _begin(self, pixels: Pixels) -> None:
        """Write the size, the palette, and that the film repeats."""
        colors = _palette(pixels)
        self._nearest = _nearest(colors)
        self._shown = np.full(pixels.shape, CLEAR, dtype=np.uint8)
        height, width = pixels.shape
        sides = width.to_bytes(2, "little") + height.to_bytes(2, "little")
        self._file.write(b"GIF89a" + sides + b"\xf7\x00\x00" + colors.tobytes().ljust(768, b"\0"))
        self._file.write(b"!\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00")

    def _write_pending(self) -> None:
        """Write the part that was seen until now."""
        from PIL import GifImagePlugin, Image

        if self._pending is None:
            return
        entries, corner = self._pending
        now = round(100 * self._count / self._fps)
        for block in GifImagePlugin.getdata(
            Image.frombytes("P", entries.shape[::-1], entries.tobytes()),
            corner,
            duration=min(10 * (now - self._written), LONGEST),
            transparency=CLEAR,
            disposal=1,
        ):
            self._file.write(block)
        self._pending, self._written = None, now


def _palette(pixels: Pixels) -> Entries:
    """Return a palette (k, 3), k <= 255.

    It has the first picture's colours, those of the banner at the end, tints, and a coarse cube.
    """
    from mars2d.output.raster.theme import PRINTED

    values, counts = np.unique(pixels & 0xFFFFFF, return_counts=True)
    order = np.argsort(-counts, kind="stable")
    seen = np.column_stack([values >> 16, values >> 8 & 255, values & 255])[order].astype(int)
    vivid = seen[(counts[order] >= 4) & (np.ptp(seen, axis=1) > 60)][: FEW // 2]
    banners = [list(bytes.fromhex(color[1:])) for color in (PRINTED.over, PRINTED.failed)]
    vivid = np.concatenate([banners, vivid])
    tints = [255 + np.rint(share * (vivid - 255)).astype(int) for share in TINTS]
    cube = np.array(list(product((0, 64, 128, 191, 255), repeat=3)))
    wanted = np.concatenate([seen[:FEW], vivid, *tints, cube])
    # Of colours that look alike, only the first.
    first = np.unique(wanted // 6, axis=0, return_index=True)[1]
    return wanted[np.sort(first)][:CLEAR].astype(np.uint8)


def _nearest(colors: Entries) -> Entries:
    """Return the entries of a palette (k, 3) for all colours of 6 bits a channel, (2**18,)."""
    from PIL import Image

    cells, palette = np.arange(1 << 18), Image.new("P", (1, 1))
    middles = 4 * np.column_stack([cells >> 12, cells >> 6 & 63, cells & 63]) + 2
    palette.putpalette(colors.tobytes())
    every = Image.frombytes("RGB", (512, 512), middles.astype(np.uint8).tobytes())
    found = np.array(every.quantize(palette=palette, dither=Image.Dither.NONE)).ravel()
    red, green, blue = colors[::-1].astype(int).T  # its own are exact; of two alike, the first
    found[_codes(red << 16 | green << 8 | blue)] = np.arange(len(colors))[::-1]
    return found


def _codes(pixels: NDArray[Any]) -> NDArray[Any]:
    """Return colours with 6 bits a channel, 0 to 2**18 - 1."""
    return (pixels >> 6 & 0x3F000) | (pixels >> 4 & 0xFC0) | (pixels >> 2 & 0x3F)
