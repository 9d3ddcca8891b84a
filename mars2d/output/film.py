"""Films: frames as an animated GIF or an MP4, without a display."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.errors import InputError, MissingExtraError
from mars2d.frame import Frame

if TYPE_CHECKING:
    import pygame

__all__ = ["SUFFIXES", "film_rows", "save_film", "save_pictures"]

SUFFIXES = (".gif", ".mp4")
ENCODERS = ("libx264", "libopenh264", "mpeg4")
"""What may be in a build of FFmpeg, the best first."""

Pixels = NDArray[np.uint8]


def film_rows(times: ArrayLike, speed: float = 1.0, fps: float = 25) -> NDArray[np.intp]:
    """Return which rows of a record become the frames of a film, (f,).

    times: (T,) seconds, rising. speed: simulated seconds a second of the film, > 0. fps: frames a
    second. The film lasts (times[-1] - times[0]) / speed seconds, to the nearest frame; its first
    frame is the first row, its last frame the last. Each frame shows the newest row at its time.

    >>> film_rows([0, 1, 2, 3, 4], speed=2, fps=2).tolist()
    [0, 1, 2, 4]
    """
    at = np.asarray(times, dtype=float)
    _check_rate("speed", speed)
    _check_rate("fps", fps)
    if at.ndim != 1 or len(at) == 0:
        raise InputError(f"times: expected at least one time, as (T,), not shape {at.shape}")
    count = max(1, round((at[-1] - at[0]) / speed * fps))
    if count == 1:
        return np.array([len(at) - 1])
    moments = np.linspace(at[0], at[-1], count)
    slack = 1e-9 * max(1.0, abs(at[-1]))
    rows: NDArray[np.intp] = np.searchsorted(at, moments + slack, side="right") - 1
    return rows


def save_film(
    frames: Iterable[Frame],
    path: str | os.PathLike[str],
    *,
    fps: float = 25,
    size: tuple[int, int] = (1280, 720),
    sensors: bool = True,
    status: str = "",
    progress: Callable[[int], None] | None = None,
) -> None:
    """Draw frames as the window draws them, and write them as .gif or .mp4.

    fps: frames a second, at most 50 in a GIF. size: pixels; for .mp4 made even. status: what stands
    beside the time, as "10x". progress: called with the number of frames written so far. The file
    appears under its name when it is complete.

    Raises InputError for another suffix or where it can't be written, MissingExtraError when .mp4
    is asked for and PyAV isn't installed.
    """
    if Path(path).suffix.lower() == ".mp4":
        size = (size[0] + size[0] % 2, size[1] + size[1] % 2)
    pictures = _pictures(frames, size, sensors=sensors, status=status, progress=progress)
    save_pictures(pictures, path, fps)


def save_pictures(
    pictures: Iterator[pygame.Surface], path: str | os.PathLike[str], fps: float = 25
) -> None:
    """Write pictures, all of one size, as .gif or .mp4; for .mp4 both sides must be even.

    Each is taken when the one before is written, so all may be drawn on the same surface. Raises
    InputError and MissingExtraError as `save_film`.
    """
    target = Path(path)
    suffix = target.suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(f"{target}: expected a film's name to end in {' or '.join(SUFFIXES)}")
    _check_rate("fps", fps)
    if suffix == ".gif" and fps > 50:
        raise InputError(f"fps = {fps:g}: expected at most 50, more a GIF can't show")
    if suffix == ".mp4":
        require_av(target)
    with _replacing(target) as file:
        count = (_write_gif if suffix == ".gif" else _write_mp4)(file, pictures, fps)
        if count == 0:
            raise InputError(f"{target}: a film needs at least one frame")


def _check_rate(name: str, value: object) -> None:
    if isinstance(value, bool) or not isinstance(value, (int, float, np.number)):
        raise InputError(f"{name} = {value!r}: expected a number > 0")
    if not 0 < float(value) < float("inf"):
        raise InputError(f"{name} = {value!r}: expected a number > 0")


@contextmanager
def _replacing(target: Path) -> Iterator[BinaryIO]:
    """Open a file beside `target` that takes its place once all has been written."""
    part = target.with_name(f".{target.name}.part")
    try:
        file = part.open("w+b")
    except OSError as error:
        raise InputError(f"{target}: can't be written, {error.strerror or error}") from None
    try:
        with file:
            yield file
        part.replace(target)
    finally:
        part.unlink(missing_ok=True)


def _pictures(
    frames: Iterable[Frame],
    size: tuple[int, int],
    *,
    sensors: bool,
    status: str,
    progress: Callable[[int], None] | None,
) -> Iterator[pygame.Surface]:
    """Yield each frame's picture, always on the same surface."""
    import pygame

    from mars2d.view.picture import Artist

    artist = Artist(size, sensors=sensors, status=status)
    surface = pygame.Surface(size, 0, 32)
    for count, frame in enumerate(frames, 1):
        yield artist.paint(frame, surface)
        if progress is not None:
            progress(count)


# -- GIF ------------------------------------------------------------------------------------------


def _write_gif(file: BinaryIO, pictures: Iterator[pygame.Surface], fps: float) -> int:
    """Write an animated GIF frame by frame, each only where it differs from the one before.

    One palette for all. Frames that differ in nothing prolong the one before.
    """
    from PIL import GifImagePlugin, Image

    matches: Pixels | None = None
    written = shown = 0  # hundredths of a second
    pending: tuple[Pixels, tuple[int, int]] | None = None
    before: Pixels | None = None
    count = 0

    def flush(until: int) -> None:
        nonlocal written
        if pending is None:
            return
        pixels, corner = pending
        image = Image.frombytes("P", pixels.shape[::-1], pixels.tobytes())
        pause = min(until - written, 65_535)
        for block in GifImagePlugin.getdata(
            image, corner, duration=10 * pause, transparency=CLEAR, disposal=1
        ):
            file.write(block)
        written = until

    for picture in pictures:
        if matches is None:
            palette = _palette(picture)
            matches = _matches(palette)
            _write_gif_head(file, palette, picture.get_size())
        indexed = _indexed(picture, matches)
        change = _difference(before, indexed)
        if change is not None:
            flush(shown)
            pending, before = change, indexed
        count += 1
        shown = round(100 * count / fps)
    flush(shown)
    file.write(b";")
    return count


CLEAR = 255
"""The palette's entry for "as before"."""


def _difference(before: Pixels | None, now: Pixels) -> tuple[Pixels, tuple[int, int]] | None:
    """Return the smallest part that changed and its corner (left, top); None when nothing did."""
    if before is None:
        return now, (0, 0)
    changed = before != now
    rows, columns = np.nonzero(changed.any(axis=1))[0], np.nonzero(changed.any(axis=0))[0]
    if len(rows) == 0:
        return None
    part = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    # What stays is transparent: long runs of one value, which compress to almost nothing.
    return np.where(changed[part], now[part], np.uint8(CLEAR)), (int(columns[0]), int(rows[0]))


def _palette(surface: pygame.Surface) -> Pixels:
    """Return the palette (k, 3), k < 256: the first picture's colours and their tints.

    Robots move over white, obstacles and each other, so shades between each strong colour and its
    surroundings are added to what the first picture shows; then those of the banner at the end, and
    a few from everywhere for what add-ons may bring.
    """
    import pygame
    from PIL import Image

    from mars2d.view import theme

    pixels = pygame.image.tobytes(surface, "RGB")
    picture: Any = Image.frombytes("RGB", surface.get_size(), pixels)
    counted = sorted(picture.getcolors(1 << 24) or [], key=lambda item: -item[0])
    strong = [color for n, color in counted if n >= 4 and max(color) - min(color) > 60][:12]
    wanted = [color for _, color in counted[:24]]
    for ground in ((255, 255, 255), (184, 192, 200)):
        for share in (0.85, 0.2, 0.4, 0.6, 0.1):
            wanted += [_mixed(color, ground, share) for color in strong]
    for banner in (theme.OVER, theme.ERROR):
        ink = tuple(bytes.fromhex(banner[1:]))
        wanted += [_mixed(ink, (255, 255, 255), share) for share in (1.0, 0.8, 0.6, 0.4, 0.2)]
    wanted += [(r, g, b) for r in (0, 128, 255) for g in (0, 128, 255) for b in (0, 128, 255)]
    reduced = picture.quantize(colors=256, method=Image.Quantize.MEDIANCUT)
    rest = reduced.getpalette() or []
    wanted += [tuple(rest[k : k + 3]) for k in range(0, len(rest), 3)]
    cells: dict[tuple[int, ...], tuple[int, ...]] = {}
    for color in wanted:  # of colours that can hardly be told apart, the first
        cells.setdefault(tuple(c // 6 for c in color), color)
    return np.array(list(cells.values())[:CLEAR], dtype=np.uint8)


def _matches(palette: Pixels) -> Pixels:
    """Return the palette's entry for each colour of six bits a channel, (2**18,).

    The palette's own colours match themselves, so that white stays white.
    """
    from scipy.spatial import cKDTree

    codes = np.arange(1 << 18)
    channels = np.column_stack([codes >> 12, codes >> 6 & 63, codes & 63])
    nearest = cKDTree(palette).query(4 * channels + 1.5)[1]
    entries = np.asarray(nearest, dtype=np.uint8)
    own = palette.astype(int) >> 2
    backwards = np.arange(len(palette))[::-1]  # of two with one code, the first
    entries[(own[:, 0] << 12 | own[:, 1] << 6 | own[:, 2])[backwards]] = backwards
    return entries


def _indexed(picture: pygame.Surface, matches: Pixels) -> Pixels:
    """Return each pixel's entry in the palette, (height, width)."""
    import pygame

    flat = np.frombuffer(pygame.image.tobytes(picture, "BGRA"), dtype="<u4")
    codes = (flat >> 6 & 0x3F000) | (flat >> 4 & 0xFC0) | (flat >> 2 & 0x3F)
    width, height = picture.get_size()
    indexed: Pixels = matches[codes].reshape(height, width)
    return indexed


def _mixed(color: tuple[int, ...], ground: tuple[int, ...], share: float) -> tuple[int, ...]:
    """Return a colour laid over a ground with an opacity from 0 to 1."""
    return tuple(round(g + share * (c - g)) for c, g in zip(color, ground, strict=True))


def _write_gif_head(file: BinaryIO, palette: Pixels, size: tuple[int, int]) -> None:
    """Write the header: size, the palette of 256 colours, and that the film repeats for ever."""
    colors = palette.tobytes().ljust(768, b"\0")
    sides = size[0].to_bytes(2, "little") + size[1].to_bytes(2, "little")
    file.write(b"GIF89a" + sides + b"\xf7\x00\x00" + colors)
    file.write(b"!\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00")


# -- MP4 ------------------------------------------------------------------------------------------


def require_av(target: Path) -> None:
    try:
        import av  # noqa: F401
    except ImportError:
        raise MissingExtraError(
            f'{target}: films in MP4 need PyAV: pip install "mars2d[video]"; a .gif needs nothing'
        ) from None


def _write_mp4(file: BinaryIO, pictures: Iterator[pygame.Surface], fps: float) -> int:
    """Write H.264 video, or the next best that this build of FFmpeg has."""
    import av
    import pygame

    count = 0
    with av.open(file, "w", format="mp4", options={"movflags": "faststart"}) as container:
        stream: Any = None
        for picture in pictures:
            if stream is None:
                stream = _video_stream(container, picture.get_size(), fps)
            width, height = picture.get_size()
            flat = np.frombuffer(pygame.image.tobytes(picture, "RGB"), dtype=np.uint8)
            frame = av.VideoFrame.from_ndarray(flat.reshape(height, width, 3), format="rgb24")
            container.mux(stream.encode(frame))
            count += 1
        if stream is not None:
            container.mux(stream.encode(None))
    return count


def _video_stream(container: Any, size: tuple[int, int], fps: float) -> Any:
    import av

    known = [name for name in ENCODERS if name in av.codecs_available]
    stream = container.add_stream(known[0], rate=Fraction(fps).limit_denominator(1001))
    stream.width, stream.height = size
    stream.pix_fmt = "yuv420p"
    if known[0] == "libx264":
        stream.options = {"crf": "18", "preset": "veryfast", "tune": "animation"}
    else:
        stream.bit_rate = 8_000_000
    return stream
