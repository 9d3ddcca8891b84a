"""Animated GIFs: one palette for all frames, and of each frame only the part that has changed.

Pillow finds the nearest colours and compresses the parts. Its own writer of animations keeps all
frames in memory until the end.
"""

from __future__ import annotations

from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pygame
    from PIL.Image import Image

Entries = NDArray[np.uint8]
"""Pixels as entries of the palette, or colours."""

CLEAR = 255
"""The palette's entry for a pixel that stays as it was."""

OWN = 64
"""How many of the first picture's colours are in the palette; the rest is a coarse cube."""

ALIKE = 8
"""Of colours whose channels differ by less, only the first is there, since Pillow mixes them up."""

LONGEST = 655_350
"""How long a frame is seen at most, milliseconds."""


class Gif:
    """Writes pictures of one size as an animated GIF that repeats for ever."""

    def __init__(self, path: Path, fps: float) -> None:
        """Begin."""
        self._file = path.open("wb", buffering=0)  # without a buffer nothing is lost
        self._fps = fps
        self._count = self._written = 0  # frames; hundredths of a second
        self._shown: Entries | None = None
        self._pending: tuple[Entries, tuple[int, int]] | None = None

    def add(self, picture: pygame.Surface) -> None:
        """Add a picture; one that looks like the one before prolongs its frame."""
        import pygame
        from PIL import Image

        pixels = pygame.image.tobytes(picture, "RGB")
        image = Image.frombytes("RGB", picture.get_size(), pixels)
        if self._shown is None:
            self._begin(image)
        entries = np.asarray(image.quantize(palette=self._palette, dither=Image.Dither.NONE))
        changed = np.ones(entries.shape, bool) if self._shown is None else entries != self._shown
        if box := Image.fromarray(changed).getbbox():
            self._write_pending()
            left, top, right, bottom = box
            # Elsewhere it is CLEAR: long runs of one value compress to almost nothing.
            part = np.where(changed, entries, CLEAR)[top:bottom, left:right]
            self._pending = part.astype(np.uint8), (left, top)
        self._shown, self._count = entries, self._count + 1

    def close(self) -> None:
        """Write the last frame and the end."""
        with self._file:
            self._write_pending()
            self._file.write(b";")

    def _begin(self, image: Image) -> None:
        """Write the size, the palette, and that the film repeats."""
        from PIL.Image import new

        colors = _palette(image).tobytes()
        self._palette = new("P", (1, 1))
        self._palette.putpalette(colors)
        sides = b"".join(side.to_bytes(2, "little") for side in image.size)
        self._file.write(b"GIF89a" + sides + b"\xf7\x00\x00" + colors.ljust(768, b"\0"))
        self._file.write(b"!\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00")

    def _write_pending(self) -> None:
        """Write the part that was seen until now."""
        from PIL import GifImagePlugin, Image

        if self._pending is None:
            return
        entries, corner = self._pending
        now = round(100 * self._count / self._fps)
        for block in GifImagePlugin.getdata(
            Image.fromarray(entries),
            corner,
            duration=min(10 * (now - self._written), LONGEST),
            transparency=CLEAR,
            disposal=1,
        ):
            self._file.write(block)
        self._pending, self._written = None, now


def _palette(image: Image) -> Entries:
    """Return a palette (k, 3), k <= 255, for a first picture: its colours, and a coarse cube."""
    from mars2d.output.raster.theme import PRINTED

    banners = [bytes.fromhex(color[1:]) for color in (PRINTED.over, PRINTED.failed)]
    colors: Any = image.getcolors(image.width * image.height)
    seen = sorted(colors, reverse=True)
    cube = product((0, 64, 128, 191, 255), repeat=3)
    wanted = np.array([*(color for _, color in seen[:OWN]), *map(tuple, banners), *cube])
    kept = wanted[:1]
    for color in wanted[1:]:
        if np.abs(kept - color).max(axis=1).min() >= ALIKE:
            kept = np.vstack([kept, color])
    return kept[:CLEAR].astype(np.uint8)
