"""Video in MP4 by PyAV, H.264 where its FFmpeg can."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from io import RawIOBase
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from mars2d.core.extras import extra

if TYPE_CHECKING:
    import pygame

ENCODERS = ("libx264", "libopenh264", "mpeg4")
"""Encoders that a build of FFmpeg may have, the best first."""

OPTIONS = {"movflags": "hybrid_fragmented", "frag_duration": "1000000"}
"""A file that can be played up to a second ago while it grows, and is a common one at its end."""

GIF = "a .gif needs nothing"
"""What is there without PyAV."""

MIN_AV = 17
"""The first version of PyAV that has everything needed here."""

BT709 = 1
"""FFmpeg's number for the colours of HD video, as players expect them."""


def require_av(target: Path) -> None:
    """Raise MissingExtraError where PyAV isn't installed, or an old one."""
    with extra("video", f"{target}: films in MP4 need PyAV {MIN_AV} or newer", GIF):
        import av

        if int(av.__version__.partition(".")[0]) < MIN_AV:
            raise ImportError(av.__version__)


class Mp4:
    """Writes pictures of one size, of even sides, as video."""

    def __init__(self, file: BinaryIO | RawIOBase, fps: float) -> None:
        """Begin; `file` stays open at the end."""
        import av

        self._file: Any = _Quiet(file)
        self._container: Any = av.open(self._file, "w", format="mp4", options=OPTIONS)
        self._fps = fps
        self._stream: Any = None

    def add(self, picture: pygame.Surface) -> None:
        """Add a picture."""
        import av
        import pygame
        from av.video.reformatter import ColorRange, Colorspace

        if self._stream is None:
            self._stream = _video_stream(self._container, picture.get_size(), self._fps)
        # They are 0x..rrggbb: in memory blue comes first, on all that PyAV is built for.
        pixels = np.ascontiguousarray(pygame.surfarray.pixels2d(picture).T)
        frame: Any = av.VideoFrame.from_numpy_buffer(
            pixels.view(np.uint8).reshape(*pixels.shape, 4), format="bgra"
        )
        video = frame.reformat(
            format=self._stream.pix_fmt,
            dst_colorspace=Colorspace.ITU709,
            dst_color_range=ColorRange.MPEG,
        )
        self._container.mux(self._stream.encode(video))
        self._file.check()

    def close(self) -> None:
        """Write the pictures that still wait for later ones, and the end."""
        if self._stream is not None:
            self._container.mux(self._stream.encode(None))
        self._container.close()
        self._file.check()


class _Quiet:
    """A file that keeps its first error until it is asked; FFmpeg ends the process after one."""

    def __init__(self, file: Any) -> None:
        self._file = file
        self._error: OSError | None = None
        self.read, self.tell = file.read, file.tell

    def write(self, data: bytes) -> int:
        return self._tried(self._file.write, data) or len(data)

    def seek(self, offset: int, whence: int = 0) -> int:
        return self._tried(self._file.seek, offset, whence) or 0

    def _tried(self, act: Callable[..., int], *values: object) -> int | None:
        if self._error is None:
            try:
                return act(*values)
            except OSError as error:
                self._error = error
        return None

    def check(self) -> None:
        if self._error is not None:
            raise self._error


def _video_stream(container: Any, size: tuple[int, int], fps: float) -> Any:
    import av

    known = [name for name in ENCODERS if name in av.codecs_available]
    stream = container.add_stream(known[0], rate=Fraction(fps).limit_denominator(1001))
    stream.width, stream.height = size
    stream.pix_fmt = "yuv420p"
    context = stream.codec_context
    context.colorspace = context.color_primaries = context.color_trc = BT709
    context.color_range = 1  # of video: black is 16, white 235
    if known[0] == "libx264":
        # A fixed quality needs no look at later pictures: as good as crf 22, a third quicker.
        stream.options = {"qp": "20", "preset": "ultrafast"}
    else:
        stream.bit_rate = 8_000_000
    return stream
