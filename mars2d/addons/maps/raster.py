"""Maps made of pixels: ROS occupancy grids, and plain images."""

from __future__ import annotations

from dataclasses import replace
from math import cos, isfinite, pi, sin
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.maps.drawing import Drawing, Piece, Unit, broken, check_bytes
from mars2d.addons.maps.grid import IMAGES, MOST_BYTES, cells, read_image
from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError, nearest

__all__ = ["read_occupancy", "read_picture"]

Mask = NDArray[np.bool_]
Pose = tuple[float, float, float]

MOST_BRACKETS = 100

MODES = ("trinary", "scale", "raw")
KEYS = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode")

OCCUPIED = 0.65
"""A cell is occupied beyond this, where the file does not say."""

DARK = 127.5
"""Pixels of an image that are darker are wall, from 0 to 255."""

LARGEST_CELL = 1000.0
"""Metres."""


def read_picture(path: Path, resolution: float) -> Drawing:
    """Read a plain image: what is darker than middle grey is solid, what is transparent is free.

    resolution: metres per pixel. The lower left corner is (0, 0). Raises InputError.
    """
    gray, clear = read_image(path.name, path)
    dark = (gray < DARK) & ~clear
    return _drawing(path.name, "an image", dark, _checked(path.name, resolution), (0.0, 0.0, 0.0))


def read_occupancy(path: Path) -> Drawing:
    """Read an occupancy grid as ROS's map_server keeps it: a YAML file and an image beside it.

    What is occupied is solid; what is free, and what nobody knows, is free. Raises InputError.
    """
    name = path.name
    fields = _fields(name, path)
    resolution = _checked(name, fields["resolution"])
    origin = _origin(name, fields.get("origin", [0, 0, 0]))
    mode = fields.get("mode", "trinary")
    if mode not in MODES:
        raise wrong(f"{name}: mode", mode, "one of " + ", ".join(MODES))
    negate = fields.get("negate", 0)
    if negate not in (0, 1):
        raise wrong(f"{name}: negate", negate, "0 or 1")
    limit = real(f"{name}: occupied_thresh", fields.get("occupied_thresh", OCCUPIED))
    free = real(f"{name}: free_thresh", fields.get("free_thresh", min(0.25, limit)))
    if not 0 <= free <= limit <= 1:
        raise InputError(
            f"{name}: free_thresh = {free:g}, occupied_thresh = {limit:g}: expected "
            "0 <= free_thresh <= occupied_thresh <= 1"
        )
    image = _beside(name, path, fields["image"])
    gray, clear = read_image(f"{name}: image {image.name}", image)
    if mode == "raw":
        share, unknown = gray / 100, (gray > 100) | clear
    else:
        share, unknown = (gray if negate else 255 - gray) / 255, clear
    occupied = (share > limit) & ~unknown
    known_free = (share < free) & ~unknown
    drawing = _drawing(name, "an occupancy grid", occupied, resolution, origin)
    counts = [occupied.sum(), known_free.sum(), (~occupied & ~known_free).sum()]
    rows, columns = occupied.shape
    text = "{} x {}; {} occupied, {} free, {} unknown, which are free here"
    note = ("cells", text.format(columns, rows, *map(int, counts)))
    return replace(drawing, notes=(note,))


def _drawing(name: str, kind: str, occupied: Mask, cell: float, origin: Pose) -> Drawing:
    """Return the occupied cells as solid, their lower left corner at a pose."""
    import shapely

    with broken(name, kind):
        x, y, yaw = origin
        c, s = cell * cos(yaw), cell * sin(yaw)
        turn = np.array([[c, s], [-s, c]])
        found = cells(name, occupied)
        if not found:
            raise InputError(f"{name}: expected walls; no pixel is occupied")
        placed = shapely.transform(found, lambda xy: xy @ turn + (x, y))
        pieces = tuple(Piece("occupied", area) for area in placed.tolist())
    unit = Unit("", cell, f"{cell:g} m a pixel")
    return Drawing(name, kind, unit, pieces, apart=True)


def _checked(name: str, resolution: Any) -> float:
    expected = f"metres per pixel, a number > 0 and <= {LARGEST_CELL:g}"
    if isinstance(resolution, bool) or not isinstance(resolution, (int, float)):
        raise wrong(f"{name}: resolution", resolution, expected)
    if not 1e-5 < resolution <= LARGEST_CELL:
        raise wrong(f"{name}: resolution", resolution, expected)
    return float(resolution)


def _origin(name: str, value: Any) -> Pose:
    expected = "the pose of the lower left pixel, as [x, y, yaw] in metres and radians"
    if not isinstance(value, list) or len(value) not in (2, 3):
        raise wrong(f"{name}: origin", value, expected)
    x, y, yaw = (real(f"{name}: origin[{i}]", v) for i, v in enumerate([*value, 0.0][:3]))
    if not isfinite(yaw) or abs(yaw) > 4 * pi:
        raise wrong(f"{name}: origin", value, expected)
    return x, y, yaw


def _fields(name: str, path: Path) -> dict[str, Any]:
    """Return what a YAML file says, plain values only."""
    import yaml

    with broken(name, "YAML"):
        text = path.read_text(encoding="utf-8")
        if max(text.count("["), text.count("{")) > MOST_BRACKETS:
            raise InputError(f"{name}: more than {MOST_BRACKETS} brackets")
        for token in yaml.scan(text, Loader=yaml.SafeLoader):
            if isinstance(token, (yaml.AliasToken, yaml.AnchorToken)):
                raise InputError(f"{name}: has an alias or anchor (& or *), which is refused")
        fields = yaml.safe_load(text)
    if not isinstance(fields, dict):
        raise InputError(f"{name}: expected an occupancy grid: image, resolution, origin, ...")
    for key in ("image", "resolution"):
        if key not in fields:
            near = nearest(key, [str(k) for k in fields if k not in KEYS])
            raise InputError(f"{name}: expected {key}: ..., as in an occupancy grid of ROS{near}")
    return fields


def _beside(name: str, path: Path, image: Any) -> Path:
    """Return the image that a YAML file names: beside it, or in a folder beside it."""
    expected = "the name of an image beside it, " + ", ".join(IMAGES)
    if not isinstance(image, str) or not image or "\0" in image:
        raise wrong(f"{name}: image", image, expected)
    outside = PurePosixPath(image).is_absolute() or PureWindowsPath(image).drive
    parts = PureWindowsPath(image).parts
    if outside or ".." in parts or PureWindowsPath(image).root:
        raise wrong(f"{name}: image", image, f"{expected}, without .. and no absolute path")
    found = path.parent / image
    if found.suffix.lower() not in IMAGES:
        raise wrong(f"{name}: image", image, expected)
    if not found.resolve().is_relative_to(path.parent.resolve()):
        raise wrong(f"{name}: image", image, f"{expected}, no link that leads elsewhere")
    if not found.is_file():
        raise InputError(f"{name}: image = {image!r}: there is no such file beside it")
    check_bytes(f"{name}: image {image}", found, MOST_BYTES)
    return found
