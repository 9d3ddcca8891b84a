"""GeoJSON and WKT: areas and lines in plane coordinates."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.maps.drawing import (
    NO_LAYER,
    Drawing,
    Piece,
    Unit,
    broken,
    check_finite,
    layer_name,
    wall,
)
from mars2d.addons.maps.regions import region
from mars2d.core.description import real
from mars2d.core.errors import InputError, shown

if TYPE_CHECKING:
    import shapely

Float = NDArray[np.float64]

LAYER_NAMES = ("layer", "Layer", "name")
"""The properties of a feature that may name its layer; the first one counts."""

METRES = Unit.named("m", "supposed: the format names none")


def read_geojson(path: Path, unit: Unit | None) -> Drawing:
    """Read GeoJSON: polygons are solid, lines are walls, in plane coordinates.

    unit: metres if None. A feature's layer is its property ``layer`` or ``name``. Degrees of
    longitude and latitude are no plane coordinates. Raises InputError.
    """
    name = path.name
    with broken(name, "GeoJSON"):
        data = json.loads(path.read_text(encoding="utf-8-sig"), parse_constant=_no_number)
        reader = _Reader(name, unit or METRES)
        for layer, geometry in _geometries(name, data, NO_LAYER):
            reader.add_json(layer, geometry)
    return reader.drawing("GeoJSON")


def read_wkt(path: Path, unit: Unit | None) -> Drawing:
    """Read well-known text, one geometry or several below each other, in plane coordinates.

    unit: metres if None. Raises InputError.
    """
    import shapely

    name = path.name
    with broken(name, "WKT"):
        reader = _Reader(name, unit or METRES)
        for text in _statements(name, path.read_text(encoding="utf-8-sig")):
            parts = [shapely.from_wkt(text)]
            while any(hasattr(part, "geoms") for part in parts):  # collections hold collections
                parts = shapely.get_parts(parts).tolist()
            for part in parts:
                reader.add(part)
    return reader.drawing("WKT")


def _no_number(text: str) -> float:
    raise InputError(f"{text} is no coordinate: expected finite numbers")


class _Reader:
    """Collects pieces, and counts the other things."""

    def __init__(self, name: str, unit: Unit) -> None:
        self._name, self._unit = name, unit
        self._pieces: list[Piece] = []
        self._skipped: Counter[str] = Counter()

    def drawing(self, kind: str) -> Drawing:
        """Return the pieces as a drawing."""
        return Drawing(
            self._name, kind, self._unit, tuple(self._pieces), skipped=dict(self._skipped)
        )

    def add(self, geometry: shapely.Geometry) -> None:
        """Add a geometry of shapely that has no parts."""
        import shapely

        if geometry.is_empty:
            self._skipped[f"empty {geometry.geom_type}"] += 1
        elif geometry.geom_type == "Polygon":
            rings = shapely.get_rings(geometry)
            self._area(NO_LAYER, [shapely.get_coordinates(ring) for ring in rings])
        elif geometry.geom_type in ("LineString", "LinearRing"):
            self._line(NO_LAYER, shapely.get_coordinates(geometry))
        else:
            self._skipped[geometry.geom_type] += 1

    def add_json(self, layer: str, geometry: dict[str, Any]) -> None:
        """Add a geometry of GeoJSON that is no collection."""
        kind, given = geometry["type"], geometry.get("coordinates")
        if kind in ("Point", "MultiPoint"):
            self._skipped[kind] += 1
            return
        if not isinstance(given, list):
            raise InputError(f"{self._name}: {kind} has coordinates = {shown(given)}")
        parts = given if kind.startswith("Multi") else [given]
        for part in parts:
            if kind.endswith("LineString"):
                self._line(layer, self._points(part))
            else:
                self._area(layer, [self._points(ring) for ring in part])

    def _points(self, positions: Any) -> Float:
        """Return positions [[x, y], ...] as points (k, 2); heights are left out."""
        try:
            return np.array([(real("x", p[0]), real("y", p[1])) for p in positions]).reshape(-1, 2)
        except (TypeError, ValueError, KeyError, IndexError):
            raise InputError(
                f"{self._name}: {shown(positions)}: expected positions, such as [[x, y], [x, y]]"
            ) from None

    def _line(self, layer: str, points: Float) -> None:
        piece = wall(self._name, layer, points, self._unit.metres)
        if piece is None:
            self._skipped["line without length"] += 1
        else:
            self._pieces.append(piece)

    def _area(self, layer: str, rings: list[Float]) -> None:
        for ring in rings:
            check_finite(self._name, ring)
        areas = region([r * self._unit.metres for r in rings], even_odd=True)
        self._pieces += [Piece(layer, area) for area in areas]
        if not areas:
            self._skipped["Polygon without area"] += 1


def _geometries(name: str, data: Any, layer: str) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the single geometries of GeoJSON with the layer of each."""
    kind = data.get("type") if isinstance(data, dict) else None
    if kind == "FeatureCollection" and isinstance(data.get("features"), list):
        for feature in data["features"]:
            yield from _geometries(name, feature, layer)
    elif kind == "Feature":
        properties = data.get("properties")
        names = properties if isinstance(properties, dict) else {}
        own = next((layer_name(names[key]) for key in LAYER_NAMES if names.get(key)), layer)
        if data.get("geometry") is not None:
            yield from _geometries(name, data["geometry"], own)
    elif kind == "GeometryCollection" and isinstance(data.get("geometries"), list):
        for geometry in data["geometries"]:
            yield from _geometries(name, geometry, layer)
    elif kind in GEOMETRIES:
        yield layer, data
    else:
        said = f"type {shown(kind)}" if isinstance(data, dict) else shown(data)
        raise InputError(f"{name}: {said}: expected GeoJSON, as a FeatureCollection or a Polygon")


GEOMETRIES = (
    "Point", "MultiPoint", "LineString", "MultiLineString", "Polygon", "MultiPolygon",
)  # fmt: skip


def _statements(name: str, text: str) -> Iterator[str]:
    """Yield each geometry of a WKT file: it ends where its brackets close."""
    depth, statement = 0, ""
    for line in text.splitlines():
        statement += line.strip() + " "
        depth += line.count("(") - line.count(")")
        if depth <= 0 and statement.strip():
            yield statement
            depth, statement = 0, ""
    if statement.strip():
        raise InputError(f"{name}: its last geometry is not closed by )")
