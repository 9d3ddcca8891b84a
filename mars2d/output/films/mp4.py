"""Video in MP4: one picture is encoded while others are converted and drawn."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from mars2d.core.extras import extra
from mars2d.core.files import atomic_write

if TYPE_CHECKING:
    import pygame

Pixels = NDArray[np.uint32]

ENCODERS = ("libx264", "libopenh264", "mpeg4")
"""Encoders that a build of FFmpeg may have, the best first."""

IN_PIECES = "frag_keyframe+empty_moov+default_base_moof"

GIF = "a .gif needs nothing"
"""What is there without PyAV."""

MIN_AV = 17
"""The first version of PyAV that has everything needed here."""

BT709 = 1
"""FFmpeg's number for the colours of HD video."""

PLACES = 3
"""Pictures in memory: one is encoded, one converted, and one copied as soon as it is drawn."""

PIECE_SECONDS = 1.0
"""The length of a piece."""


def require_av(target: Path) -> None:
    """Raise MissingExtraError where PyAV isn't installed, or an old one."""
    with extra("video", f"{target}: films in MP4 need PyAV {MIN_AV} or newer", GIF):
        import av

        if int(av.__version__.partition(".")[0]) < MIN_AV:
            raise ImportError(av.__version__)


def write_mp4(
    file: BinaryIO, pictures: Iterator[pygame.Surface], fps: float, *, in_pieces: bool = False
) -> int:
    """Write H.264 video, or the next best of this build of FFmpeg; return the number of frames.

    in_pieces: write a file that can be played at any time, a second or two late; afterwards
    `rewrapped` makes a common file of it. PyAV releases the interpreter while it converts and
    encodes, so each of these has its own thread.
    """
    import av

    count = 0
    options = {"movflags": IN_PIECES if in_pieces else "faststart"}
    encoder: _Encoder | None = None
    waiting: deque[Future[None]] = deque()
    target = _Quiet(file)
    with (
        target.checked(),
        av.open(target, "w", format="mp4", options=options) as container,
        ThreadPoolExecutor(1, "converter") as converting,
        ThreadPoolExecutor(1, "encoder") as encoding,
    ):
        for picture in pictures:
            if encoder is None:
                encoder = _Encoder(container, picture.get_size(), fps, in_pieces=in_pieces)
            pixels = encoder.copied(picture, count % PLACES)
            if len(waiting) == PLACES - 1:
                waiting.popleft().result()
            target.check()
            frame = converting.submit(encoder.converted, pixels)
            waiting.append(encoding.submit(encoder.encode, frame))
            count += 1
        for each in waiting:
            each.result()
        if encoder is not None:
            encoder.finish()
    return count


def rewrapped(path: Path) -> None:
    """Replace a film that was written in pieces by one that begins with its index."""
    import av

    # If this fails, for example on a full disk, the film in pieces can be played as well.
    with (
        suppress(OSError, ValueError),
        atomic_write(path) as file,
        _Quiet(file).checked() as target,
        av.open(str(path)) as pieces,
        av.open(target, "w", format="mp4", options={"movflags": "faststart"}) as whole,
    ):
        stream = whole.add_stream_from_template(pieces.streams.video[0])
        for packet in pieces.demux(video=0):
            if packet.dts is not None:  # the last one is empty
                packet.stream = stream
                whole.mux(packet)


class _Quiet:
    """A file that keeps its first error for later, for example that of a full disk.

    PyAV writes again when it closes a film, and prints the errors that are raised then.
    """

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self._error: OSError | None = None

    def __getattr__(self, name: str) -> Any:
        return getattr(self._file, name)

    def write(self, data: bytes) -> int:
        """Write bytes, unless writing has failed before."""
        return self._tried(lambda: self._file.write(data), len(data))

    def seek(self, offset: int, whence: int = 0) -> int:
        """Go to a place, unless writing has failed before."""
        return self._tried(lambda: self._file.seek(offset, whence), offset)

    def _tried(self, act: Callable[[], int], otherwise: int) -> int:
        if self._error is None:
            try:
                return act()
            except OSError as error:
                self._error = error
        return otherwise

    def check(self) -> None:
        """Raise the error that was kept, if any."""
        if self._error is not None:
            raise self._error

    @contextmanager
    def checked(self) -> Iterator[_Quiet]:
        """Raise the error that was kept, if any, at the end of the block."""
        yield self
        self.check()


class _Encoder:
    """Encodes pictures of one size [pixels] into a container."""

    def __init__(
        self, container: Any, size: tuple[int, int], fps: float, *, in_pieces: bool
    ) -> None:
        """Add a video to the container."""
        from av.video.reformatter import VideoReformatter

        self._container, self._stream = container, _video_stream(container, size, fps)
        if in_pieces:
            self._stream.gop_size = round(fps * PIECE_SECONDS)
            self._stream.max_b_frames = 0  # with them a film in pieces begins late
        self._reformatter = VideoReformatter()
        self._sound = True  # unless encoding has failed
        self._memory = np.empty((PLACES, size[1], size[0]), dtype=np.uint32)

    def copied(self, picture: pygame.Surface, place: int) -> Pixels:
        """Return a picture's pixels (height, width), copied to one of the places in memory."""
        import pygame

        pixels: Pixels = self._memory[place]
        pixels[:] = pygame.surfarray.pixels2d(picture).T
        return pixels

    def converted(self, pixels: Pixels) -> Any:
        """Return a picture in a video's colours; afterwards its pixels may be overwritten."""
        import av
        from av.video.reformatter import ColorRange, Colorspace

        # They are 0x..rrggbb: in memory blue comes first, on all that PyAV is built for.
        picture = pixels.view(np.uint8).reshape(*pixels.shape, 4)
        return self._reformatter.reformat(
            av.VideoFrame.from_numpy_buffer(picture, format="bgra"),
            format=self._stream.pix_fmt,
            dst_colorspace=Colorspace.ITU709,  # as players expect of HD
            dst_color_range=ColorRange.MPEG,
        )

    def encode(self, frame: Future[Any]) -> None:
        """Encode a picture once it is converted; do nothing after a failure.

        FFmpeg ends the process if it is told to continue a file whose beginning has failed.
        """
        if self._sound:
            self._sound = False
            self._container.mux(self._stream.encode(frame.result()))
            self._sound = True

    def finish(self) -> None:
        """Encode the pictures that still wait for later ones."""
        self._container.mux(self._stream.encode(None))


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
