"""Video in MP4, H.264, by PyAV."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mars2d.core.extras import extra

if TYPE_CHECKING:
    import pygame

OPTIONS = {"movflags": "hybrid_fragmented", "frag_duration": "1000000"}
"""A file that can be played up to a second ago while it grows, and is a common one at its end."""

# A fixed quality needs no look at later pictures: as good as crf 22, a third quicker.
QUALITY = {"qp": "20", "preset": "ultrafast"}

MIN_AV = 17
"""The first version of PyAV that has everything needed here."""

BT709 = 1
"""FFmpeg's number for the colours of HD video, as players expect them."""


def require_av(target: Path) -> None:
    """Raise MissingExtraError where PyAV isn't installed, or an old one."""
    what = f"{target}: films in MP4 need PyAV {MIN_AV} or newer"
    with extra("video", what, "a .gif needs nothing"):
        import av

        if int(av.__version__.partition(".")[0]) < MIN_AV:
            raise ImportError(av.__version__)


class Mp4:
    """Writes pictures of one size, of even sides, as video."""

    def __init__(self, path: Path, fps: float) -> None:
        """Begin."""
        import av

        self._file = _Quiet(path.open("wb"))
        self._container: Any = av.open(self._file, "w", format="mp4", options=OPTIONS)
        self._fps = Fraction(fps).limit_denominator(1001)
        self._stream: Any = None

    def add(self, picture: pygame.Surface) -> None:
        """Add a picture. Raises OSError where it can't be written."""
        import av
        import pygame
        from av.video.reformatter import ColorRange, Colorspace

        if self._stream is None:
            self._begin(picture.get_size())
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
        try:
            if self._stream is not None:
                self._container.mux(self._stream.encode(None))
        finally:
            self._container.close()
            self._file.file.close()
        self._file.check()

    def _begin(self, size: tuple[int, int]) -> None:
        self._stream = stream = self._container.add_stream("libx264", rate=self._fps)
        stream.width, stream.height = size
        stream.pix_fmt, stream.options = "yuv420p", QUALITY
        context = stream.codec_context
        context.colorspace = context.color_primaries = context.color_trc = BT709
        context.color_range = 1  # of video: black is 16, white 235


class _Quiet:
    """A file that keeps its first error until it is asked: after one FFmpeg ends the process."""

    def __init__(self, file: Any) -> None:
        self.file = file
        self.read, self.tell = file.read, file.tell
        self._error: OSError | None = None

    def write(self, data: bytes) -> int:
        """Write, unless that has failed before."""
        return self._tried(self.file.write, data) or len(data)

    def seek(self, offset: int, whence: int = 0) -> int:
        """Go to another place, unless something has failed before."""
        return self._tried(self.file.seek, offset, whence) or 0

    def check(self) -> None:
        """Raise the error, if there was one."""
        if self._error is not None:
            raise self._error

    def _tried(self, act: Callable[..., int], *values: object) -> int | None:
        if self._error is None:
            try:
                return act(*values)
            except OSError as error:
                self._error = error
        return None
