"""Floors with colours: lines to follow, places to find."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from functools import cached_property, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mars2d import checks
from mars2d.addons.base import Addon, Color
from mars2d.description import entry, real, wrong
from mars2d.errors import InputError
from mars2d.geometry import Outline, Point, bounds_of, inside_polygon
from mars2d.scene import LARGEST_IMAGE, Scene, rgb
from mars2d.scene import color as checked_color

if TYPE_CHECKING:
    from mars2d.world import World

__all__ = ["Floor"]

Pixels = NDArray[np.uint8]
Bounds = tuple[float, float, float, float]


def _optional(name: str, value: object) -> str | None:
    return None if value is None else _opaque(name, value)


def _opaque(name: str, value: object) -> str:
    """Check a colour that lets nothing through."""
    result = checked_color(name, value)
    if len(result) > 7:
        raise wrong(name, value, "a colour without opacity, '#rrggbb' or a name")
    return result


def _patches(name: str, value: object) -> tuple[tuple[Outline, str], ...]:
    expected = "a list of patches, each (outline, colour), as [([(0, 0), (1, 0), (0, 1)], 'red')]"
    if not isinstance(value, (tuple, list)):
        raise wrong(name, value, expected)
    patches = []
    for i, patch in enumerate(value):
        if not isinstance(patch, (tuple, list)) or len(patch) != 2:
            raise wrong(f"{name}[{i}]", patch, "a patch (outline, colour)")
        outline = checks.outline(f"{name}[{i}][0]", patch[0], least=3)
        patches.append((outline, _opaque(f"{name}[{i}][1]", patch[1])))
    return tuple(patches)


def _image(name: str, value: object) -> str | None:
    if value is None:
        return None
    if not isinstance(value, (str, os.PathLike)) or Path(value).suffix.lower() != ".png":
        raise wrong(name, value, "the name of a file that ends in .png, or None")
    return str(value)


def _bounds(name: str, value: object) -> Bounds | None:
    expected = "(xmin, xmax, ymin, ymax) in metres with xmin < xmax and ymin < ymax, or None"
    if value is None:
        return None
    if isinstance(value, (tuple, list, np.ndarray)) and len(value) == 4:
        xmin, xmax, ymin, ymax = (real(f"{name}[{i}]", item) for i, item in enumerate(value))
        far = max(map(abs, (xmin, xmax, ymin, ymax))) > checks.LIMIT
        if xmin < xmax and ymin < ymax and not far:
            return xmin, xmax, ymin, ymax
    raise wrong(name, value, expected)


class _Picture:
    """Pixels (rows, columns, 3) that all copies of an add-on share; they can't be written."""

    def __init__(self, pixels: Pixels) -> None:
        pixels.flags.writeable = False
        self.pixels = pixels

    def __deepcopy__(self, memo: object) -> _Picture:
        return self


class Floor(Addon):
    """The colours of the floor, for the sensor Ground: one everywhere, an image on it, patches.

    >>> Floor(patches=[([(0, 0), (1, 0), (1, 1)], "black")]).ground((0.9, 0.5))
    (0.0, 0.0, 0.0)

    Of patches that overlap the later one lies on top. The image covers `bounds`, its upper row at
    ymax; a point has the colour of the pixel that it lies in, and where a pixel is transparent
    `color`, or else white, is seen through it. Without a `color` the rest has that of the floors of
    earlier add-ons, or else white. Nothing of it is in anybody's way.

    A relative name of an image is looked for in the current folder; a file beside the experiment is
    ``Path(__file__).with_name("line.png")``. It is read when a world is made, PNG with 8 bits a
    channel and up to 4096 x 4096 pixels.
    """

    patches: Sequence[tuple[Outline, str]] = entry(
        default=(), check=_patches, unit="m", doc="polygons and their colours: (outline, colour)"
    )
    image: str | None = entry(default=None, check=_image, doc="a file with the floor's picture")
    bounds: Bounds | None = entry(
        default=None, check=_bounds, unit="m", doc="where the image lies: (xmin, xmax, ymin, ymax)"
    )
    color: str | None = entry(
        default=None, check=_optional, doc="the colour of the rest; None: what lies beneath"
    )

    def _validate(self) -> None:
        super()._validate()
        if self.image is not None and self.bounds is None:
            raise InputError(
                "Floor.bounds is missing: where the image lies, (xmin, xmax, ymin, ymax) in metres"
            )
        if self.image is None and self.bounds is not None:
            raise InputError(f"Floor.bounds = {self.bounds}: given without an image")

    @property
    def pixels(self) -> Pixels:
        """The image's pixels (rows, columns, 3), the upper row first; red, green, blue to 255.

        Raises InputError if the file is not there, is no such image, or is too large.
        """
        return self._picture.pixels

    @cached_property
    def _picture(self) -> _Picture:
        assert self.image is not None
        path = Path(self.image)
        return _picture_of(path, _version(path), self.color)

    @cached_property
    def _colored(self) -> tuple[tuple[Bounds, NDArray[np.float64], Color], ...]:
        """The patches, from the upper one down: bounds, corners (k, 2), colour."""
        return tuple(
            (bounds_of(outline), np.array(outline), rgb(color))
            for outline, color in reversed(self.patches)
        )

    def ground(self, point: Point) -> Color | None:
        """Return the colour of the floor at a point: red, green and blue from 0 to 1.

        None: neither a patch nor the image lies there, and there is no colour of the rest.
        """
        x, y = point
        for (xmin, xmax, ymin, ymax), corners, color in self._colored:
            near = xmin <= x <= xmax and ymin <= y <= ymax
            if near and inside_polygon(np.array([x]), np.array([y]), corners)[0]:
                return color
        if self.bounds is not None:
            xmin, xmax, ymin, ymax = self.bounds
            if xmin <= x <= xmax and ymin <= y <= ymax:
                rows, columns, _ = self.pixels.shape
                row = min(int((ymax - y) / (ymax - ymin) * rows), rows - 1)
                column = min(int((x - xmin) / (xmax - xmin) * columns), columns - 1)
                red, green, blue = (self.pixels[row, column] / 255).tolist()
                return red, green, blue
        return None if self.color is None else rgb(self.color)

    def on_start(self, world: World) -> None:  # noqa: ARG002
        """Read the image, so that what is wrong with it is said at once, as an InputError."""
        self._prepare()

    def _prepare(self) -> None:
        """Work out what is kept, so that looking at the floor changes nothing of it."""
        self._colored  # noqa: B018
        if self.image is not None:
            self.pixels  # noqa: B018

    def paint(self, scene: Scene, area: Outline) -> None:
        """Add the floor of an area to what lies beneath everything else.

        Where the image can't be read any more, as that of a record may be, its name is written.
        """
        if self.color is not None:
            scene.polygon(area, fill=self.color)
        if self.bounds is not None:
            try:
                scene.image(self.pixels, self.bounds)
            except InputError:
                xmin, xmax, ymin, ymax = self.bounds
                corners = [(xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax)]
                scene.polygon(corners, fill="#e6e9ed")
                name = Path(str(self.image)).name
                scene.text(((xmin + xmax) / 2, (ymin + ymax) / 2), f"{name} is not there")
        for outline, color in self.patches:
            scene.polygon(outline, fill=color)


def _read_png(name: str, path: Path) -> Pixels:
    """Return the pixels (rows, columns, 4) of a PNG. Raises InputError, beginning with `name`."""
    from PIL import Image, UnidentifiedImageError

    quiet = warnings.catch_warnings(action="ignore", category=Image.DecompressionBombWarning)
    try:
        with quiet, Image.open(path, formats=["PNG"]) as image:
            problem = _problem(image.size, image.mode)
            if not problem:
                return np.asarray(image.convert("RGBA"))
    except FileNotFoundError:
        where = "" if path.is_absolute() else f" in {Path.cwd()}"
        beside = f"Path(__file__).with_name({path.name!r})"
        problem = f"there is no such file{where}; beside the experiment it is {beside}"
    except UnidentifiedImageError:
        problem = "this is no PNG image"
    except Image.DecompressionBombError:
        problem = f"it has more than {LARGEST_IMAGE} x {LARGEST_IMAGE} pixels"
    except (OSError, SyntaxError, ValueError) as error:
        problem = f"can't be read, {error}"
    raise InputError(f"{name} = {str(path)!r}: {problem}")


def _problem(size: tuple[int, int], mode: str) -> str:
    """Return why an image of this size [pixels] and kind can't be used, or nothing."""
    if max(size) > LARGEST_IMAGE:
        most = f"{LARGEST_IMAGE} x {LARGEST_IMAGE}"
        return f"{size[0]} x {size[1]} pixels; expected at most {most}"
    if mode.startswith(("I", "F")):
        return "16 bits a channel; save it with 8 bits a channel"
    return ""


def _version(path: Path) -> tuple[str, int, int]:
    """Return what tells a file from any other, and from itself when it has been changed."""
    try:
        known = path.stat()
        return str(path.absolute()), known.st_mtime_ns, known.st_size
    except (OSError, ValueError):  # it can't be read either, which says why
        return "", 0, 0


@lru_cache(maxsize=4)
def _picture_of(path: Path, version: tuple[str, int, int], color: str | None) -> _Picture:  # noqa: ARG001
    """Return an image over a colour; it is read anew when the file has another version."""
    return _Picture(_over(_read_png("Floor.image", path), color))


def _over(pixels: Pixels, color: str | None) -> Pixels:
    """Return pixels (rows, columns, 4) laid over a colour, or over white, (rows, columns, 3)."""
    result = pixels[..., :3].copy()
    opacity = pixels[..., 3]
    clear = opacity < 255
    if clear.any():
        share = opacity[clear][:, None] / 255
        beneath = 255 * np.array(rgb(color or "#ffffff"))
        result[clear] = np.round(result[clear] * share + beneath * (1 - share))
    return result
