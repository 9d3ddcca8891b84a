"""A drawing: the pieces that a file holds, by layer, in metres."""

from __future__ import annotations

import contextlib
import fnmatch
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mars2d.core.checks import MAX_COORDINATE
from mars2d.core.errors import InputError, counted, nearest, shown

if TYPE_CHECKING:
    import shapely

Float = NDArray[np.float64]

ALWAYS = "GeoJSON and images need nothing"
"""The maps that are read without the extra `maps`."""

METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254, "ft": 0.3048}
"""The units that a drawing can be in, by name, in metres."""

TOLERANCE = 0.02
"""How far corners and curves may be off by default, metres."""

MAX_TOLERANCE = 10.0
"""Metres."""

COARSER = "remove specks (single pixels), or save it with fewer pixels and a larger resolution"
"""Advice on pixels with too many corners."""

NO_LAYER = "no layer"
"""The layer of a piece that is in none."""

USUAL = (2.0, 500.0)
"""The longer side of a usual map, metres; beyond it the unit is probably wrong."""

LIKELY = (4.0, 200.0)
"""The longer side of a map in the unit that it was drawn in, metres."""


@dataclass(frozen=True)
class Unit:
    """The unit of a drawing: its name, its length in metres, and where that was said."""

    name: str
    metres: float
    source: str


@dataclass(frozen=True)
class Piece:
    """One thing drawn, in metres: a LineString is a wall, a Polygon is solid."""

    layer: str
    geometry: shapely.Geometry


@dataclass(frozen=True)
class Drawing:
    """The contents of a file: its pieces by layer, in metres, and counts of those left out.

    source: the file's name. kind: of the file, in words. notes: remarks, as names and texts.
    hidden: layers that are not shown unless they are named. skipped: the number of things that
    were not read, by kind. others: the number of pieces in layers that were not chosen. apart:
    its areas are known not to overlap. within: how far its curves, which are polylines, may be
    off [m]. tolerance: how far corners and curves may be off in the obstacles [m].
    extent: the area of pixels; without it, a drawing has pieces.
    """

    source: str
    kind: str
    unit: Unit
    pieces: tuple[Piece, ...]
    notes: tuple[tuple[str, str], ...] = ()
    hidden: frozenset[str] = frozenset()
    skipped: Mapping[str, int] = field(default_factory=dict)
    others: Mapping[str, int] = field(default_factory=dict)
    apart: bool = False
    within: float = 0.0
    tolerance: float = TOLERANCE
    extent: shapely.Polygon | None = None

    @cached_property
    def layers(self) -> dict[str, int]:
        """The number of pieces of each layer, the largest first."""
        return dict(Counter(piece.layer for piece in self.pieces).most_common())

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """(xmin, xmax, ymin, ymax) of all pieces, or of the pixels if there are none [m]."""
        import shapely

        shown = [piece.geometry for piece in self.pieces] or [self.extent]
        xmin, ymin, xmax, ymax = shapely.total_bounds(shown).tolist()
        return xmin, xmax, ymin, ymax

    @property
    def size(self) -> tuple[float, float]:
        """Width and height, metres."""
        xmin, xmax, ymin, ymax = self.bounds
        return xmax - xmin, ymax - ymin

    @property
    def hint(self) -> str:
        """A remark on a size that is hardly that of a map, or nothing."""
        longer = max(self.size)
        if USUAL[0] <= longer <= USUAL[1] or not self.unit.name:
            return ""
        drawn = longer / self.unit.metres
        fits = {
            name: drawn * metres
            for name, metres in METRES.items()
            if LIKELY[0] <= drawn * metres <= LIKELY[1]
        }
        size = "small" if longer < USUAL[0] else "large"
        better = " or ".join(f"unit={name} ({long:.3g} m)" for name, long in fits.items())
        ask = f": is it {better}?" if better else ": is the unit right?"
        return f"{longer:.3g} m is {size} for a map of robots{ask}"

    def only(self, layers: Sequence[str] | None) -> Drawing:
        """Return the drawing with those layers only, by name or pattern; None: all that is shown.

        Raises InputError for a name that no layer has, and where nothing is left.
        """
        names = list(self.layers)
        chosen = {name for name in names if name not in self.hidden}
        if layers is not None:
            chosen = set()
            for wanted in layers:
                found = {n for n in names if fnmatch.fnmatch(n.lower(), wanted.lower())}
                if not found:
                    hint = nearest(wanted, names)
                    raise InputError(f"{self.source} has no layer {shown(wanted)}{hint}")
                chosen |= found
        pieces = tuple(piece for piece in self.pieces if piece.layer in chosen)
        if not pieces and self.extent is None:
            more = f", but {listed(self.skipped)}" if self.skipped else ""
            raise InputError(f"{self.source}: expected lines or areas; there are none{more}")
        others = {name: count for name, count in self.layers.items() if name not in chosen}
        return replace(self, pieces=pieces, others=others)

    def moved(self, at: tuple[float, float]) -> Drawing:
        """Return the drawing with the lower left corner of its bounds at a point [m]."""
        import shapely

        xmin, _, ymin, _ = self.bounds
        shift = np.array(at) - (xmin, ymin)
        shapes = [*(piece.geometry for piece in self.pieces), self.extent]
        *moved, extent = shapely.transform(shapes, lambda xy: xy + shift).tolist()
        pieces = tuple(Piece(p.layer, g) for p, g in zip(self.pieces, moved, strict=True))
        return replace(self, pieces=pieces, extent=extent)

    def check_size(self) -> None:
        """Raise InputError for a drawing that is too far away, or has no size."""
        xmin, xmax, ymin, ymax = self.bounds
        far = max(map(abs, (xmin, xmax, ymin, ymax)))
        scale = "unit=... says" if self.unit.name else "its resolution says"
        if not isfinite(far) or far > MAX_COORDINATE:
            moves = "at=(0, 0) moves it there, " if max(self.size) <= MAX_COORDINATE else ""
            raise InputError(
                f"{self.source}: lies up to {far:.3g} m from the origin, expected at most "
                f"{MAX_COORDINATE:g} m: {moves}{scale} how large it is"
            )
        if max(self.size) < 1e-3:
            raise InputError(
                f"{self.source}: is {max(self.size):.3g} m in size, expected a map; "
                f"{scale} how large it is"
            )


def wall(name: str, layer: str, points: Float, metres: float) -> Piece | None:
    """Return a wall through points (k, 2) in units of `metres`; None if it has no length.

    Raises InputError, which begins with `name`, for coordinates that are not finite.
    """
    import shapely

    check_finite(name, points)
    differ = np.ones(len(points), dtype=bool)
    differ[1:] = (np.diff(points, axis=0) != 0).any(axis=1)
    kept = points[differ] * metres
    return Piece(layer, shapely.LineString(kept)) if len(kept) > 1 else None


def check_finite(name: str, points: Float) -> None:
    """Raise InputError for coordinates (k, 2) that are not finite, or absurdly large."""
    wild = ~(np.abs(points) < 1e15)
    if wild.any():
        raise InputError(f"{name}: a coordinate is {points[wild][0]}: expected a finite number")


def layer_name(name: object, otherwise: str = NO_LAYER) -> str:
    """Return a layer's name as it can be shown: on one line, and no longer than 80 characters."""
    plain = "".join(c if c.isprintable() else " " for c in str(name or "")[:200])
    return " ".join(plain.split())[:80] or otherwise


@contextlib.contextmanager
def broken(name: str, kind: str) -> Iterator[None]:
    """Turn any error of a reader into an InputError: `name` can't be read as `kind`."""
    try:
        with np.errstate(all="ignore"):  # coordinates are checked later
            yield
    except InputError as error:
        if str(error).startswith(name):
            raise
        raise InputError(f"{name}: {error}") from error
    except RecursionError:
        raise InputError(f"{name}: can't be read as {kind}: it is nested too deeply") from None
    except Exception as error:  # libraries raise all kinds
        text = " ".join(str(error).split()) or type(error).__name__
        said = text if len(text) <= 120 else f"{text[:117]}..."
        raise InputError(f"{name}: can't be read as {kind}: {said}") from error


def check_bytes(name: str, path: Path, most: int) -> None:
    """Raise InputError, which begins with `name`, for a file of more than `most` bytes."""
    size = path.stat().st_size
    if size > most:
        raise InputError(f"{name}: {size / 1e6:.3g} MB; expected at most {most / 1e6:g} MB")


def listed(counts: Mapping[str, int], most: int = 8) -> str:
    """Return counts in words, the largest first, such as ``12 TEXT, 3 HATCH``."""
    ranked = sorted(counts.items(), key=lambda item: (-item[1], item[0]))
    words = [f"{count} {name}" for name, count in ranked[:most]]
    rest = sum(count for _, count in ranked[most:])
    return ", ".join([*words, *([counted(rest, "other")] if rest else [])])
