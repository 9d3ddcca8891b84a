"""GeoJSON: areas and lines in plane coordinates, as shapely reads them."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

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
from mars2d.core.errors import InputError, shown

if TYPE_CHECKING:
    import shapely

LAYER_NAMES = ("layer", "Layer", "name")
"""The properties of a feature that may name its layer; the first one counts."""


def read_geojson(path: Path, unit: Unit | None) -> Drawing:
    """Read GeoJSON: polygons are solid, lines are walls, in plane coordinates.

    unit: metres if None. A feature's layer is its property ``layer`` or ``name``. Degrees of
    longitude and latitude are no plane coordinates. Raises InputError.
    """
    import shapely

    name, unit = path.name, unit or Unit("m", 1.0, "supposed: the format names none")
    pieces: list[Piece] = []
    skipped: Counter[str] = Counter()
    with broken(name, "GeoJSON"):
        data = json.loads(path.read_text(encoding="utf-8-sig"))
        for layer, geometry in _features(data, NO_LAYER):
            check_finite(name, shapely.get_coordinates(geometry))
            kind, read = geometry.geom_type, len(pieces)
            if kind == "Polygon":
                rings = [shapely.get_coordinates(ring) for ring in shapely.get_rings(geometry)]
                areas = region([ring * unit.metres for ring in rings], even_odd=True)
                pieces += [Piece(layer, area) for area in areas]
            elif kind == "LineString":
                line = wall(name, layer, shapely.get_coordinates(geometry), unit.metres)
                pieces += [line] if line else []
            if len(pieces) == read:
                skipped[f"{'empty ' * (kind in ('Polygon', 'LineString'))}{kind}"] += 1
    return Drawing(name, "GeoJSON", unit, tuple(pieces), skipped=dict(skipped))


def _features(data: Any, layer: str) -> Iterator[tuple[str, shapely.Geometry]]:
    """Yield the single geometries of GeoJSON with the layer of each."""
    import shapely
    from shapely.geometry import shape

    kind = data.get("type") if isinstance(data, dict) else None
    if kind == "FeatureCollection":
        for feature in data["features"]:
            yield from _features(feature, layer)
    elif kind == "Feature":
        names = data.get("properties") or {}
        own = next((layer_name(names[key]) for key in LAYER_NAMES if names.get(key)), layer)
        if data.get("geometry"):
            yield from _features(data["geometry"], own)
    else:
        try:
            whole = shape(data)
        except Exception as error:  # shapely raises many kinds of errors
            raise InputError(f"{shown(data)}: expected GeoJSON, such as a Polygon") from error
        parts = shapely.get_parts(shapely.get_parts(whole)).tolist()  # of multiple ones in lists
        yield from ((layer, part) for part in parts)
