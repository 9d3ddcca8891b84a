"""Maps made of pixels: ROS occupancy grids, and plain images."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite, pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.maps.drawing import ALWAYS, COARSER, Drawing, Piece, Unit, broken, check_bytes
from mars2d.core.arithmetic import cosine_sine
from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError, nearest
from mars2d.core.extras import extra
from mars2d.core.picture import opened_image

if TYPE_CHECKING:
    import shapely

Mask = NDArray[np.bool_]
Gray = NDArray[np.float64]
Pose = tuple[float, float, float]

IMAGES = {".png": "PNG", ".pgm": "PPM", ".jpg": "JPEG", ".jpeg": "JPEG", ".bmp": "BMP"}
"""The suffixes of images, and Pillow's names of their formats."""

MAX_BYTES = 20_000_000
"""The largest file of an image, bytes."""

MAX_CORNERS = 100_000
"""The most corners of occupied cells: an image with more is noise, not a map."""

MODES = ("trinary", "scale", "raw")
KEYS = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode")

NEGATE = {"0": False, "1": True, "false": False, "true": True, "no": False, "yes": True}
"""What YAML may say for negate."""

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
    gray, alpha = _read_image(path.name, path)
    dark = gray < DARK if alpha is None else (gray < DARK) & (alpha > 0)
    if not dark.any():
        raise InputError(f"{path.name}: expected walls; no pixel is darker than middle grey")
    return _drawing(path.name, "an image", dark, _checked(path.name, resolution), (0.0, 0.0, 0.0))


def read_occupancy(path: Path) -> Drawing:
    """Read an occupancy grid as ROS's map_server keeps it: a YAML file and an image beside it.

    Occupied cells are solid, and there may be none; free and unknown ones are free. Transparent
    pixels count as in nav2: in the mode trinary, alpha is one more channel of brightness, in scale
    a pixel that is not opaque is unknown, and in raw alpha does not matter. Raises InputError.
    """
    name = path.name
    fields = _fields(name, path)
    resolution = _checked(name, fields["resolution"])
    origin = _origin(name, fields.get("origin", [0, 0, 0]))
    mode = str(fields.get("mode", "trinary")).lower()
    if mode not in MODES:
        raise wrong(f"{name}: mode", mode, "one of " + ", ".join(MODES))
    negate = str(fields.get("negate", 0)).lower()
    if negate not in NEGATE:
        raise wrong(f"{name}: negate", negate, "0 or 1")
    limit = _number(f"{name}: occupied_thresh", fields.get("occupied_thresh", OCCUPIED))
    free = _number(f"{name}: free_thresh", fields.get("free_thresh", min(0.25, limit)))
    if not 0 <= free <= limit <= 1:
        raise InputError(
            f"{name}: free_thresh = {free:g}, occupied_thresh = {limit:g}: expected "
            "0 <= free_thresh <= occupied_thresh <= 1"
        )
    image = _beside(name, path, fields["image"])
    gray, alpha = _read_image(f"{name}: image {image.name}", image)
    unknown = np.zeros(gray.shape, dtype=bool)
    if mode == "raw":
        share = np.rint(gray) / 100
        unknown = share > 1
    else:
        if alpha is not None and mode == "scale":
            unknown = alpha < 255
        elif alpha is not None:
            gray = (3 * gray + alpha) / 4
        share = gray / 255 if NEGATE[negate] else 1 - gray / 255
    occupied = (share > limit) & ~unknown
    known_free = (share < free) & ~unknown
    drawing = _drawing(name, "an occupancy grid", occupied, resolution, origin)
    counts = [occupied.sum(), known_free.sum(), (~occupied & ~known_free).sum()]
    rows, columns = occupied.shape
    text = "{} x {}; {} occupied, {} free, {} unknown, which are free here"
    note = ("cells", text.format(columns, rows, *map(int, counts)))
    return replace(drawing, notes=(note,))


def _drawing(name: str, kind: str, occupied: Mask, cell: float, origin: Pose) -> Drawing:
    """Return the occupied cells (rows, columns) as solid, their lower left corner at a pose."""
    import shapely

    with broken(name, kind):
        x, y, yaw = origin
        c, s = (cell * each for each in cosine_sine(yaw))
        turn = np.array([[c, s], [-s, c]])
        rows, columns = occupied.shape
        cells = [*_cells(name, occupied), shapely.box(0, 0, columns, rows)]
        *placed, whole = shapely.transform(cells, lambda xy: xy @ turn + (x, y)).tolist()
        pieces = tuple(Piece("occupied", area) for area in placed)
    unit = Unit("", cell, f"{cell:g} m a pixel")
    return Drawing(name, kind, unit, pieces, apart=True, extent=whole)


def _checked(name: str, resolution: Any) -> float:
    expected = f"metres per pixel, a number > 0 and <= {MAX_CELL:g}"
    cell = _number(f"{name}: resolution", resolution, expected)
    if not 1e-5 < cell <= MAX_CELL:
        raise wrong(f"{name}: resolution", resolution, expected)
    return cell


def _number(name: str, value: Any, expected: str = "a number") -> float:
    """Check a number, or the text of one, as `1e-05`, which Python's YAML does not know as one."""
    try:
        return real(name, float(value) if isinstance(value, str) else value, expected)
    except ValueError:
        raise wrong(name, value, expected) from None


def _origin(name: str, value: Any) -> Pose:
    expected = "the pose of the lower left pixel, such as [x, y, yaw] in metres and radians"
    if not isinstance(value, list) or len(value) not in (2, 3):
        raise wrong(f"{name}: origin", value, expected)
    x, y, yaw = (_number(f"{name}: origin[{i}]", v) for i, v in enumerate([*value, 0.0][:3]))
    if not isfinite(yaw) or abs(yaw) > 4 * pi:
        raise wrong(f"{name}: origin", value, expected)
    return x, y, yaw


def _fields(name: str, path: Path) -> dict[str, Any]:
    """Return the fields of a YAML file, plain values only."""
    with extra("maps", f"{name}: an occupancy grid needs PyYAML", ALWAYS):
        import yaml
    with broken(name, "YAML"):
        fields = yaml.load(path.read_text(encoding="utf-8-sig"), Loader=yaml.BaseLoader)
    if not isinstance(fields, dict):
        raise InputError(f"{name}: expected an occupancy grid: image, resolution, origin, ...")
    if fields.get("type") == "line_segments" or ("data" in fields and "image" not in fields):
        raise InputError(
            f"{name}: line_segments of flatland are not read; expected an occupancy grid: image, "
            "resolution, ..., or its lines as WKT"
        )
    if "layers" in fields:
        raise InputError(
            f"{name}: a world of several layers, as flatland has them; expected the YAML file of "
            "one occupancy grid: image, resolution, ..."
        )
    for key in KEYS:
        near = [k for k in fields if k not in KEYS and nearest(key, [k])]
        if key not in fields and (near or key in ("image", "resolution")):
            said = f" in place of {near[0]}" if near else ""
            raise InputError(f"{name}: expected {key}: ...{said}, as in an occupancy grid of ROS")
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


def _read_image(name: str, path: Path) -> tuple[Gray, Gray | None]:
    """Return the brightness and alpha of an image's pixels from 0 to 255; None without alpha.

    Both are (rows, columns), the upper row first; colours count by the mean of their channels.
    Raises InputError, which begins with `name`.
    """
    with opened_image(name, path, IMAGES[path.suffix.lower()], deep=True) as image:
        if image.mode.startswith("I"):  # 16 bits
            return np.asarray(image, dtype=float) / 257, None
        if image.mode == "L" and "transparency" not in image.info:
            return np.asarray(image, dtype=float), None
        clear = image.has_transparency_data
        pixels = np.asarray(image.convert("RGBA"), dtype=float)
    return pixels[..., :3].mean(axis=2), pixels[..., 3] if clear else None


def _cells(name: str, occupied: Mask) -> list[shapely.Polygon]:
    """Return the outlines of occupied cells (rows, columns), those that share an edge as one.

    A cell is a square of side 1, the lower left one at (0, 0). Raises InputError, which begins
    with `name`, for more corners than a map has.
    """
    import shapely

    rows, columns = occupied.shape
    inside = np.zeros((rows + 2, columns + 2), dtype=bool)
    inside[1:-1, 1:-1] = occupied[::-1]  # the lower row first
    below, above = inside[:-1], inside[1:]
    bends = (below[:, :-1] != below[:, 1:]) | (above[:, :-1] != above[:, 1:])
    bends &= (below[:, :-1] != above[:, :-1]) | (below[:, 1:] != above[:, 1:])
    if (count := int(bends.sum())) > MAX_CORNERS:
        raise InputError(
            f"{name}: the occupied cells have {count} corners, expected at most {MAX_CORNERS}: "
            f"is it a map? {COARSER}"
        )
    y, x = np.nonzero(below != above)
    row, column = np.nonzero(inside[:, :-1] != inside[:, 1:])
    across, along = np.stack([x - 1, y, x, y]), np.stack([column, row - 1, column, row])
    ends = np.hstack([across, along]).T.reshape(-1, 2, 2).astype(float)
    faces = shapely.get_parts(shapely.polygonize(shapely.linestrings(ends)))
    middle = np.floor(shapely.get_coordinates(shapely.point_on_surface(faces))).astype(int)
    column, row = middle.reshape(-1, 2).T
    chosen: list[shapely.Polygon] = shapely.simplify(faces[inside[row + 1, column + 1]], 0).tolist()
    return chosen
