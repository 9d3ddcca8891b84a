"""Reads a map from a file of any kind, with the options that the kind takes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from mars2d.addons.maps.drawing import MAX_TOLERANCE, METRES, TOLERANCE, Drawing, Unit, check_bytes
from mars2d.addons.maps.dxf import read_dxf
from mars2d.addons.maps.geo import read_geojson
from mars2d.addons.maps.raster import IMAGES, MAX_BYTES, read_occupancy, read_picture
from mars2d.addons.maps.svg import read_svg
from mars2d.core.checks import point
from mars2d.core.description import number, real, wrong
from mars2d.core.errors import InputError, likely


class _Kind(NamedTuple):
    """A kind of file: its reader, the largest file [bytes], and what it takes besides a path."""

    reader: Callable[..., Drawing]
    largest: int
    takes: tuple[str, ...] = ()


KINDS = {
    ".dxf": _Kind(read_dxf, 10_000_000, ("layers", "unit", "within")),
    ".svg": _Kind(read_svg, 10_000_000, ("layers", "unit", "within")),
    **dict.fromkeys((".geojson", ".json"), _Kind(read_geojson, 10_000_000, ("layers", "unit"))),
    **dict.fromkeys((".yaml", ".yml"), _Kind(read_occupancy, 64_000)),
    **dict.fromkeys(IMAGES, _Kind(read_picture, MAX_BYTES, ("resolution",))),
}

SUFFIXES = tuple(KINDS)
"""The suffixes of files that are maps."""

CURVES = 0.05
"""The share of the tolerance by which curves may be off, before corners are removed."""

WITHIN = number(low=0, high=MAX_TOLERANCE, unit="m")

FINEST = 1e-4
"""How far curves may always be off, even if the tolerance is smaller, metres."""


def read(
    path: Path,
    *,
    layers: str | Sequence[str] | None = None,
    unit: str | float | None = None,
    resolution: float | None = None,
    at: Sequence[float] | None = None,
    tolerance: float = TOLERANCE,
) -> Drawing:
    """Read a map from a file, with the options of `Map.from_file`.

    Raises InputError, which names the file, what is wrong with it, and what was expected.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(f"{path}: expected a map: {', '.join(SUFFIXES)}{advice(path)}")
    kind = KINDS[suffix]
    options = {"layers": layers, "unit": unit, "resolution": resolution}
    for option, value in options.items():
        if value is not None and option not in kind.takes:
            takers = [other for other, takes in KINDS.items() if option in takes.takes]
            raise InputError(
                f"{path.name}: {option} is for {', '.join(takers)}, not {suffix}; leave it None"
            )
    if suffix in IMAGES and resolution is None:
        raise InputError(f"{path.name}: an image needs resolution, metres per pixel, such as 0.05")
    chosen = None if layers is None else _layers(layers)
    place = None if at is None else point("at", at)
    tolerance = WITHIN.metadata["check"]("tolerance", tolerance)
    _check_file(path, suffix)
    within = max(CURVES * tolerance, FINEST)
    given = {"unit": _unit(unit), "resolution": resolution, "within": within}
    arguments = {name: value for name, value in given.items() if name in kind.takes}
    drawing = kind.reader(path, **arguments).only(chosen)
    if place is not None:
        drawing = drawing.moved(place)
    drawing.check_size()
    return replace(drawing, tolerance=tolerance)


def advice(path: Path) -> str:
    """Return advice on a drawing that can't be read, or nothing."""
    return "; save the drawing as DXF" if path.suffix.lower() == ".dwg" else ""


def _check_file(path: Path, suffix: str) -> None:
    """Raise InputError for a path that is no file, or too large a file, before it is read."""
    if path.is_dir():
        raise InputError(f"{path}: a folder; expected a map, a file that ends in {suffix}")
    if not path.is_file():
        folder = path.parent
        beside = [f for f in folder.iterdir() if f.suffix in SUFFIXES] if folder.is_dir() else []
        raise InputError(f"{path}: there is no such file{likely(path, map(str, beside))}")
    check_bytes(path.name, path, KINDS[suffix].largest)
    if not path.stat().st_size:
        raise InputError(f"{path.name}: an empty file; expected a map")


def _layers(value: Any) -> list[str]:
    """Check names of layers: a list, or one text with commas."""
    names = value.split(",") if isinstance(value, str) else value
    expected = "names of layers, such as ['WALLS'] or 'WALLS,DOORS'"
    if not isinstance(names, (list, tuple)) or not names:
        raise wrong("layers", value, expected)
    if not all(isinstance(name, str) and name.strip() for name in names):
        raise wrong("layers", value, expected)
    return [name.strip() for name in names]


def _unit(value: Any) -> Unit | None:
    """Check a unit: its name, or its length in metres."""
    if value is None:
        return None
    expected = f"one of {', '.join(METRES)}, or a number of metres > 0"
    if isinstance(value, str):
        if value not in METRES:
            raise wrong("unit", value, expected + likely(value, METRES))
        return Unit(value, METRES[value], "as given")
    metres = real("unit", value, expected)
    if not 1e-9 <= metres <= 1e6:
        raise wrong("unit", value, expected)
    return Unit(f"{metres:g} m", metres, "as given")
