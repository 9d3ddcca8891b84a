"""DXF drawings: lines, arcs, curves and blocks, by layer."""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.maps.drawing import (
    ALWAYS,
    Drawing,
    Piece,
    Unit,
    broken,
    check_finite,
    layer_name,
    wall,
)
from mars2d.addons.maps.regions import region
from mars2d.core.errors import InputError
from mars2d.core.extras import extra

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document
    from ezdxf.entities.dxfentity import DXFEntity
    from ezdxf.entities.insert import Insert

Float = NDArray[np.float64]

UNITS = {1: "in", 2: "ft", 4: "mm", 5: "cm", 6: "m"}
"""The units of the header's $INSUNITS in which maps are drawn."""

LINES = ("LINE", "LWPOLYLINE", "POLYLINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE")
AREAS = ("SOLID", "TRACE")
"""The kinds of entities that are read, besides INSERT."""

FLATNESS = 2e-4
"""The largest distance of a curve from its points, in parts of its own size."""


@dataclass(frozen=True)
class _Shape:
    """Points (k, 3) in the file's unit. In a block, layer ``0`` is the outer one."""

    layer: str
    points: Float
    solid: bool = False


def read_dxf(path: Path, unit: Unit | None) -> Drawing:
    """Read the model space of a DXF drawing, version R12 or later, text or binary.

    unit: None takes the header's. Walls are LINE, LWPOLYLINE and POLYLINE with their bulges, ARC,
    CIRCLE, ELLIPSE and SPLINE; SOLID and TRACE are areas; INSERT is followed. Heights are left
    out. Layers that are off, frozen or not plotted are hidden. Raises InputError.
    """
    name = path.name
    with extra("maps", f"{name}: a DXF drawing needs ezdxf", ALWAYS):
        import ezdxf
    with broken(name, "a DXF drawing"):
        _quiet()
        document = ezdxf.filemanagement.readfile(path)
        reader = _Reader(document)
        shapes = reader.layout()
        unit = unit or _unit(document, named=b"$INSUNITS" in path.read_bytes())
        hidden = {
            layer_name(layer.dxf.name)
            for layer in document.layers
            if layer.is_off() or layer.is_frozen() or not layer.dxf.get("plot", 1)
        }
        pieces = [piece for shape in shapes for piece in _pieces(name, shape, unit.metres)]
    return Drawing(
        name, "a DXF drawing", unit, tuple(pieces),
        hidden=frozenset({*hidden, "Defpoints"}), skipped=dict(reader.skipped),
    )  # fmt: skip


def _quiet() -> None:
    """Drop the library's log, unless the program that uses us wants it."""
    log = logging.getLogger("ezdxf")
    if not log.handlers:
        log.addHandler(logging.NullHandler())


def _unit(document: Document, *, named: bool) -> Unit:
    """Return the unit that the header names; metres if it names none.

    named: whether the file names one; if not, the library supposes metres.
    """
    code = int(document.header.get("$INSUNITS", 0)) if named else 0
    if code in UNITS:
        return Unit.named(UNITS[code], f"as the header says ($INSUNITS = {code})")
    if code == 0:
        return Unit.named("m", "supposed: the header names no unit")
    raise InputError(
        f"$INSUNITS = {code} in the header: expected one of "
        f"{', '.join(f'{k} ({u})' for k, u in UNITS.items())}; unit=... overrides it"
    )


def _pieces(name: str, shape: _Shape, metres: float) -> Iterator[Piece]:
    points = shape.points[:, :2]
    if shape.solid:
        check_finite(name, points)
        for area in region([points * metres]):
            yield Piece(shape.layer, area)
        return
    piece = wall(name, shape.layer, points, metres)
    if piece is not None:
        yield piece


class _Reader:
    """Walks a document; each block is read once, however often it is inserted."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._blocks: dict[str, list[_Shape]] = {}
        self.skipped: Counter[str] = Counter()

    def layout(self) -> list[_Shape]:
        """Return all shapes of the model space."""
        return self._shapes(self._document.modelspace())

    def _shapes(self, entities: Any) -> list[_Shape]:
        found: list[_Shape] = []
        for entity in entities:
            kind = entity.dxftype()
            if entity.dxf.get("invisible", 0):
                self.skipped[f"invisible {kind}"] += 1
            elif kind == "INSERT":
                found += self._inserted(entity)
            elif kind in AREAS:
                corners = np.array([tuple(v) for v in entity.wcs_vertices()]).reshape(-1, 3)
                found.append(_Shape(layer_name(entity.dxf.layer), corners, solid=True))
            elif kind in LINES and self._is_flat(entity):
                found.append(_Shape(layer_name(entity.dxf.layer), self._points(entity)))
            else:
                self.skipped[kind] += 1
        return found

    def _is_flat(self, entity: Any) -> bool:
        """Return whether a POLYLINE is a line, not a mesh of faces."""
        flat = entity.dxftype() != "POLYLINE" or entity.is_2d_polyline or entity.is_3d_polyline
        return bool(flat)

    def _points(self, entity: DXFEntity) -> Float:
        """Return points (k, 3) along a line or curve."""
        from ezdxf.path import make_path

        line = make_path(entity)
        points = np.array([tuple(v) for v in line.control_vertices()]).reshape(-1, 3)
        if not line.has_curves or not len(points):
            return points
        size = float(np.ptp(points, axis=0).max())
        curve = line.flattening(max(FLATNESS * size, 1e-12), segments=8)
        return np.array([tuple(v) for v in curve]).reshape(-1, 3)

    def _inserted(self, insert: Insert) -> list[_Shape]:
        """Return the shapes of a block's reference, once for each time that it repeats them."""
        from ezdxf.math import Vec3

        shapes = self._block(insert.dxf.name)
        rows = max(int(insert.dxf.get("row_count", 1)), 1)
        columns = max(int(insert.dxf.get("column_count", 1)), 1)
        matrix = np.array(list(insert.matrix44())).reshape(4, 4)
        ocs, turn = insert.ocs(), insert.dxf.rotation
        steps = insert.dxf.get("column_spacing", 0.0), insert.dxf.get("row_spacing", 0.0)
        found = []
        for row, column in product(range(rows), range(columns)):
            offset = Vec3(column * steps[0], row * steps[1]).rotate_deg(turn)
            shift = matrix[3, :3] + tuple(ocs.to_wcs(offset))
            for shape in shapes:
                layer = layer_name(insert.dxf.layer) if shape.layer == "0" else shape.layer
                placed = shape.points @ matrix[:3, :3] + shift
                found.append(_Shape(layer, placed, shape.solid))
        return found

    def _block(self, name: str) -> list[_Shape]:
        """Return the shapes of a block, in its own coordinates."""
        key = name.lower()
        if key in self._blocks:
            return self._blocks[key]
        block = self._document.blocks.get(name)
        if block is None:
            self.skipped["INSERT of a missing block"] += 1
            return []
        if block.block is not None and block.block.is_xref:
            self.skipped["INSERT of another file"] += 1
            return []
        self._blocks[key] = self._shapes(block)
        return self._blocks[key]
