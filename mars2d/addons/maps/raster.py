"""Maps made of pixels: ROS occupancy grids, and plain images."""

from __future__ import annotations

import contextlib
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.maps.drawing import ALWAYS, COARSER, Drawing, Piece, Unit, broken, check_bytes
from mars2d.core.arithmetic import cosine_sine
from mars2d.core.checks import pose
from mars2d.core.description import Description, choice, entry, flag, number, text, wrong
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

DARK = 127.5
"""The brightness below which a pixel of an image is solid, from 0 to 255."""

WORDS = {"true": True, "yes": True, "false": False, "no": False}
"""What YAML may say for negate, besides 0 and 1."""

RESOLUTION = number(above=1e-5, high=1e3, unit="m per pixel")


class Grid(Description):
    """An occupancy grid: the fields of its YAML file, as ROS's map_server has them."""

    image: str = text(doc="the name of an image beside it")
    resolution: float = RESOLUTION
    origin: Pose = entry(default=(0, 0, 0), check=pose, doc="of its lower left corner")
    negate: bool = flag(default=False, doc="whether dark pixels are free")
    occupied_thresh: float = number(default=0.65, low=0, high=1, doc="a cell above it is occupied")
    free_thresh: float = number(
        default=None, low=0, high=1, optional=True, doc="a cell below it is free; None: 0.25"
    )
    mode: str = choice(default="trinary", of=("trinary", "scale", "raw"), doc="what pixels mean")

    def _validate(self) -> None:
        if self.free_thresh is None:
            object.__setattr__(self, "free_thresh", min(0.25, self.occupied_thresh))
        if self.free_thresh > self.occupied_thresh:
            raise InputError(
                f"free_thresh = {self.free_thresh:g}, occupied_thresh = {self.occupied_thresh:g}: "
                "expected 0 <= free_thresh <= occupied_thresh <= 1"
            )
        if Path(self.image).suffix.lower() not in IMAGES:
            expected = "the name of an image beside it, " + ", ".join(IMAGES)
            raise wrong("image", self.image, expected)


def read_picture(path: Path, resolution: float) -> Drawing:
    """Read a plain image: pixels darker than middle grey are solid, transparent ones are free.

    resolution: metres per pixel. The lower left corner is (0, 0). Raises InputError.
    """
    gray, alpha = _read_image(path.name, path)
    dark = gray < DARK if alpha is None else (gray < DARK) & (alpha > 0)
    if not dark.any():
        raise InputError(f"{path.name}: expected walls; no pixel is darker than middle grey")
    cell = RESOLUTION.metadata["check"](f"{path.name}: resolution", resolution)
    return _drawing(path.name, "an image", dark, cell, (0.0, 0.0, 0.0))


def read_occupancy(path: Path) -> Drawing:
    """Read an occupancy grid as ROS's map_server keeps it: a YAML file and an image beside it.

    Occupied cells are solid, and there may be none; free and unknown ones are free. Transparent
    pixels count as in nav2: in the mode trinary, alpha is one more channel of brightness, in scale
    a pixel that is not opaque is unknown, and in raw alpha does not matter. Raises InputError.
    """
    name = path.name
    grid = _grid(name, path)
    image = path.parent / grid.image
    if not image.is_file():
        raise InputError(f"{name}: image = {grid.image!r}: there is no such file beside it")
    check_bytes(f"{name}: image {grid.image}", image, MAX_BYTES)
    gray, alpha = _read_image(f"{name}: image {grid.image}", image)
    unknown = np.zeros(gray.shape, dtype=bool)
    if grid.mode == "raw":
        share = np.rint(gray) / 100
        unknown = share > 1
    else:
        if alpha is not None and grid.mode == "scale":
            unknown = alpha < 255
        elif alpha is not None:
            gray = (3 * gray + alpha) / 4
        share = gray / 255 if grid.negate else 1 - gray / 255
    occupied = (share > grid.occupied_thresh) & ~unknown
    known_free = (share < grid.free_thresh) & ~unknown
    drawing = _drawing(name, "an occupancy grid", occupied, grid.resolution, grid.origin)
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


def _grid(name: str, path: Path) -> Grid:
    """Return the fields of a YAML file."""
    with extra("maps", f"{name}: an occupancy grid needs PyYAML", ALWAYS):
        import yaml
    with broken(name, "YAML"):
        fields = yaml.load(path.read_text(encoding="utf-8-sig"), Loader=yaml.BaseLoader)
        given = fields if isinstance(fields, dict) else {}
        if given.get("type") == "line_segments" or "layers" in given:
            raise InputError(
                "a world of flatland, with layers or line_segments; expected the YAML file of one "
                "occupancy grid: image, resolution, ..., or lines as GeoJSON"
            )
        if "image" not in given:
            raise InputError("expected an occupancy grid: image, resolution, origin, ...")
        known = Grid.__dataclass_fields__
        found = {k: _value(v) for k, v in given.items() if k in known or nearest(k, known)}
        if "negate" in found:
            found["negate"] = {0.0: False, 1.0: True}.get(found["negate"], found["negate"])
        return Grid(**found)


def _value(value: Any) -> Any:
    """Return what a text of YAML says; Python's own reader takes `1e-05` for a text."""
    if isinstance(value, list):
        return [_value(item) for item in value]
    with contextlib.suppress(ValueError):
        return float(value)
    return WORDS.get(value.lower(), value)


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
