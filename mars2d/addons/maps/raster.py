"""Maps made of pixels: ROS occupancy grids, and plain images."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite, pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.maps.drawing import ALWAYS, Drawing, Piece, Unit, broken, check_bytes
from mars2d.core.arithmetic import cosine_sine
from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError, nearest
from mars2d.core.extras import extra
from mars2d.core.picture import opened_image

if TYPE_CHECKING:
    import shapely

Mask = NDArray[np.bool_]
Gray = NDArray[np.float32]
Pose = tuple[float, float, float]

IMAGES = {".png": "PNG", ".pgm": "PPM", ".jpg": "JPEG", ".jpeg": "JPEG"}
"""The suffixes of images, and Pillow's names of their formats."""

MAX_BYTES = 20_000_000
"""The largest file of an image, bytes."""

MAX_CORNERS = 100_000
"""The most corners of occupied cells: an image with more is noise, not a map."""

MODES = ("trinary", "scale", "raw")
KEYS = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode")

OCCUPIED = 0.65
"""The share above which a cell is occupied, unless the file gives one."""

DARK = 127.5
"""The brightness below which a pixel of an image is solid, from 0 to 255."""

MAX_CELL = 1000.0
"""The largest size of a pixel, metres."""


def read_picture(path: Path, resolution: float) -> Drawing:
    """Read a plain image: pixels darker than middle grey are solid, transparent ones are free.

    resolution: metres per pixel. The lower left corner is (0, 0). Raises InputError.
    """
    gray, clear = _read_image(path.name, path)
    dark = (gray < DARK) & ~clear
    return _drawing(path.name, "an image", dark, _checked(path.name, resolution), (0.0, 0.0, 0.0))


def read_occupancy(path: Path) -> Drawing:
    """Read an occupancy grid as ROS's map_server keeps it: a YAML file and an image beside it.

    Occupied cells are solid; free and unknown ones are free. Raises InputError.
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
    gray, clear = _read_image(f"{name}: image {image.name}", image)
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
        c, s = (cell * each for each in cosine_sine(yaw))
        turn = np.array([[c, s], [-s, c]])
        found = _cells(name, occupied)
        if not found:
            raise InputError(f"{name}: expected walls; no pixel is occupied")
        placed = shapely.transform(found, lambda xy: xy @ turn + (x, y))
        pieces = tuple(Piece("occupied", area) for area in placed.tolist())
    unit = Unit("", cell, f"{cell:g} m a pixel")
    return Drawing(name, kind, unit, pieces, apart=True)


def _checked(name: str, resolution: Any) -> float:
    expected = f"metres per pixel, a number > 0 and <= {MAX_CELL:g}"
    if isinstance(resolution, bool) or not isinstance(resolution, (int, float)):
        raise wrong(f"{name}: resolution", resolution, expected)
    if not 1e-5 < resolution <= MAX_CELL:
        raise wrong(f"{name}: resolution", resolution, expected)
    return float(resolution)


def _origin(name: str, value: Any) -> Pose:
    expected = "the pose of the lower left pixel, such as [x, y, yaw] in metres and radians"
    if not isinstance(value, list) or len(value) not in (2, 3):
        raise wrong(f"{name}: origin", value, expected)
    x, y, yaw = (real(f"{name}: origin[{i}]", v) for i, v in enumerate([*value, 0.0][:3]))
    if not isfinite(yaw) or abs(yaw) > 4 * pi:
        raise wrong(f"{name}: origin", value, expected)
    return x, y, yaw


def _fields(name: str, path: Path) -> dict[str, Any]:
    """Return the fields of a YAML file, plain values only."""
    with extra("maps", f"{name}: an occupancy grid needs PyYAML", ALWAYS):
        import yaml
    with broken(name, "YAML"):
        fields = yaml.safe_load(path.read_text(encoding="utf-8"))
    if not isinstance(fields, dict):
        raise InputError(f"{name}: expected an occupancy grid: image, resolution, origin, ...")
    for key in ("image", "resolution"):
        if key not in fields:
            near = nearest(key, [str(k) for k in fields if k not in KEYS])
            raise InputError(f"{name}: expected {key}: ..., as in an occupancy grid of ROS{near}")
    return fields


def _beside(name: str, path: Path, image: Any) -> Path:
    """Return the image that a YAML file names, by a path from its own folder."""
    expected = "the name of an image beside it, " + ", ".join(IMAGES)
    if not isinstance(image, str) or Path(image).suffix.lower() not in IMAGES:
        raise wrong(f"{name}: image", image, expected)
    found = path.parent / image
    if not found.is_file():
        raise InputError(f"{name}: image = {image!r}: there is no such file beside it")
    check_bytes(f"{name}: image {image}", found, MAX_BYTES)
    return found


def _read_image(name: str, path: Path) -> tuple[Gray, Mask]:
    """Return the brightness of an image's pixels from 0 to 255, and where they are transparent.

    Both are (rows, columns), the upper row first; colours count by the mean of their channels.
    Raises InputError, which begins with `name`.
    """
    with opened_image(name, path, IMAGES[path.suffix.lower()]) as image:
        if image.mode == "L":
            gray = np.asarray(image, dtype=np.float32)
            return gray, np.zeros(gray.shape, dtype=bool)
        pixels = np.asarray(image.convert("RGBA"))
    return pixels[..., :3].mean(axis=2, dtype=np.float32), pixels[..., 3] == 0


def _cells(name: str, occupied: Mask) -> list[shapely.Polygon]:
    """Return the outlines of occupied cells (rows, columns), those that share an edge as one.

    A cell is a square of side 1, the lower left one at (0, 0). Raises InputError, which begins
    with `name`, for more corners than a map has.
    """
    import shapely

    rows, columns = occupied.shape
    inside = np.zeros((rows + 2, columns + 2), dtype=bool)
    inside[1:-1, 1:-1] = occupied[::-1]  # the lower row first
    across = inside[1:, 1:-1] != inside[:-1, 1:-1]  # edges along x: (rows + 1, columns)
    along = (inside[1:-1, 1:] != inside[1:-1, :-1]).T  # edges along y: (columns + 1, rows)
    corner = _ends(across) & _ends(along).T
    count = int(corner.sum())
    if count > MAX_CORNERS:
        raise InputError(
            f"{name}: the occupied cells have {count} corners, expected at most {MAX_CORNERS}: "
            "is it a map? smooth it, or make it coarser"
        )
    y, x1, x2 = _runs(across, corner)
    x, y1, y2 = _runs(along, corner.T)
    ends = np.vstack([np.column_stack([x1, y, x2, y]), np.column_stack([x, y1, x, y2])])
    lines = shapely.linestrings(ends.reshape(-1, 2, 2).astype(float))
    faces = shapely.get_parts(shapely.polygonize(lines))
    middle = np.floor(shapely.get_coordinates(shapely.point_on_surface(faces))).astype(int)
    column, row = middle.reshape(-1, 2).T
    chosen: list[shapely.Polygon] = faces[inside[row + 1, column + 1]].tolist()
    return chosen


def _ends(edges: Mask) -> Mask:
    """Return the points of each line that an edge touches, as a mask (lines, edges + 1)."""
    points = np.zeros((edges.shape[0], edges.shape[1] + 1), dtype=bool)
    points[:, :-1] |= edges
    points[:, 1:] |= edges
    return points


def _runs(edges: Mask, corner: Mask) -> tuple[NDArray[np.int64], ...]:
    """Return where edges (lines, k) run straight on between corners: line, first and last point."""
    none = np.zeros((edges.shape[0], 1), dtype=bool)
    before = np.hstack([none, edges[:, :-1]])
    after = np.hstack([edges[:, 1:], none])
    line, first = np.nonzero(edges & (~before | corner[:, :-1]))
    _, last = np.nonzero(edges & (~after | corner[:, 1:]))
    return line, first, last + 1
