"""Video in MP4: a picture is encoded while the next one is drawn."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from mars2d.errors import MissingExtraError

if TYPE_CHECKING:
    import pygame

__all__ = ["require_av", "rewrapped", "write_mp4"]

ENCODERS = ("libx264", "libopenh264", "mpeg4")
"""What may be in a build of FFmpeg, the best first."""

IN_PIECES = "frag_keyframe+empty_moov+default_base_moof"

PIECE = 1.0
"""How long a piece is, seconds."""


def require_av(target: Path) -> None:
    """Raise MissingExtraError where PyAV isn't installed."""
    try:
        import av  # noqa: F401
    except ImportError:
        raise MissingExtraError(
            f'{target}: films in MP4 need PyAV: pip install "mars2d[video]"; a .gif needs nothing'
        ) from None


def write_mp4(
    file: BinaryIO, pictures: Iterator[pygame.Surface], fps: float, *, in_pieces: bool = False
) -> int:
    """Write H.264 video, or the next best that this build of FFmpeg has; return its frames.

    in_pieces: so that what is written can be seen at any time, a second or two late; `rewrapped`
    then makes the common kind of file of it. PyAV leaves the interpreter alone while it encodes, so
    a thread of its own does that.
    """
    import av

    count = 0
    options = {"movflags": IN_PIECES if in_pieces else "faststart"}
    with av.open(file, "w", format="mp4", options=options) as container:
        stream: Any = None

        def encode(frame: Any) -> None:
            container.mux(stream.encode(frame))

        with ThreadPoolExecutor(1, "encoder") as thread:
            before: Future[None] | None = None
            for picture in pictures:
                if stream is None:
                    stream = _video_stream(container, picture.get_size(), fps)
                    if in_pieces:
                        stream.gop_size = round(fps * PIECE)
                        stream.max_b_frames = 0  # they would make a film of pieces begin late
                frame = _video_frame(picture)
                if before is not None:
                    before.result()
                before = thread.submit(encode, frame)
                count += 1
            if before is not None:
                before.result()
                encode(None)
    return count


def rewrapped(path: Path) -> None:
    """Turn a film that was written in pieces into one that begins with its index, in its place."""
    import av

    part = path.with_name(f".{path.name}.part")
    try:
        with (
            av.open(str(path)) as pieces,
            av.open(str(part), "w", format="mp4", options={"movflags": "faststart"}) as whole,
        ):
            stream = whole.add_stream_from_template(pieces.streams.video[0])
            for packet in pieces.demux(video=0):
                if packet.dts is not None:  # the last one is empty
                    packet.stream = stream
                    whole.mux(packet)
        part.replace(path)
    except (OSError, ValueError):  # such as a full disk: what is there can be seen as well
        part.unlink(missing_ok=True)


def _video_frame(picture: pygame.Surface) -> Any:
    """Return a picture's copy as a frame."""
    import av
    import pygame

    # Its pixels are 0x..rrggbb: in memory blue comes first, on all that PyAV is built for.
    pixels = pygame.surfarray.pixels2d(picture).T
    return av.VideoFrame.from_ndarray(pixels.view("u1").reshape(*pixels.shape, 4), format="bgra")


def _video_stream(container: Any, size: tuple[int, int], fps: float) -> Any:
    import av

    known = [name for name in ENCODERS if name in av.codecs_available]
    stream = container.add_stream(known[0], rate=Fraction(fps).limit_denominator(1001))
    stream.width, stream.height = size
    stream.pix_fmt = "yuv420p"
    if known[0] == "libx264":
        # As true as crf 18 of "veryfast" in a third of its time; the file is half as large again,
        # or nearly twice as large.
        stream.options = {"crf": "22", "preset": "ultrafast", "tune": "animation"}
    else:
        stream.bit_rate = 8_000_000
    return stream
