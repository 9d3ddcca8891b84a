"""Video in MP4, H.264, by PyAV."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mars2d.core.extras import extra

if TYPE_CHECKING:
    import pygame

OPTIONS = {"movflags": "hybrid_fragmented", "frag_duration": "1000000", "flush_packets": "1"}
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

        self._container: Any = av.open(str(path), "w", format="mp4", options=OPTIONS)
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

    def close(self) -> None:
        """Write the pictures that still wait for later ones, and the end."""
        try:
            if self._stream is not None:
                self._container.mux(self._stream.encode(None))
        finally:
            self._container.close()

    def _begin(self, size: tuple[int, int]) -> None:
        self._stream = stream = self._container.add_stream("libx264", rate=self._fps)
        stream.width, stream.height = size
        stream.pix_fmt, stream.options = "yuv420p", QUALITY
        context = stream.codec_context
        context.colorspace = context.color_primaries = context.color_trc = BT709
        context.color_range = 1  # of video: black is 16, white 235
