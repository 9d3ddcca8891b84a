"""A recorder of what ezdxf draws: it resolves layers, blocks, clips, hatches and multilines."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from ezdxf.addons.drawing.config import (
    Configuration,
    HatchPolicy,
    ImagePolicy,
    LinePolicy,
    TextPolicy,
)
from ezdxf.addons.drawing.frontend import UniversalFrontend
from ezdxf.addons.drawing.pipeline import RenderPipeline2d
from ezdxf.addons.drawing.properties import RenderContext
from ezdxf.addons.drawing.recorder import (
    DataRecord,
    FilledPathsRecord,
    PathRecord,
    PointsRecord,
    Recorder,
    SolidLinesRecord,
)
from ezdxf.path import Path, from_vertices
from numpy.typing import NDArray

from mars2d.addons.maps.curves import cubic
from mars2d.addons.maps.drawing import Piece, check_finite, layer_name, wall
from mars2d.addons.maps.regions import region
from mars2d.core.errors import InputError

if TYPE_CHECKING:
    from ezdxf.addons.drawing.properties import BackendProperties, LayerProperties, Properties
    from ezdxf.document import Drawing as Document

Float = NDArray[np.float64]

READ = {
    "LINE", "LWPOLYLINE", "POLYLINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE", "MLINE",
    "SOLID", "TRACE", "HATCH", "MPOLYGON", "INSERT", "ACAD_PROXY_ENTITY",
}  # fmt: skip
"""The kinds of entities that are read."""

FRAME = 16
"""The flag of a vertex of a polyline that only shapes its spline."""

CONFIGURATION = Configuration(
    line_policy=LinePolicy.SOLID,
    hatch_policy=HatchPolicy.SHOW_SOLID,
    text_policy=TextPolicy.IGNORE,
    image_policy=ImagePolicy.IGNORE,
    circle_approximation_count=8192,  # of wide arcs: 0.3 mm off at a radius of 1 km
)


def recorded(
    document: Document, name: str, metres: float, within: float
) -> tuple[list[Piece], dict[str, int]]:
    """Return the pieces of the model space of a document, and what was not read, by kind.

    name: of the file, for errors. metres: the length of a unit. within: the largest distance of
    curves from their polylines, metres.
    """
    recorder = _Recorder(name, metres)
    frontend = _Frontend(document, recorder, within / metres)
    document.header["$XCLIPFRAME"] = 0  # the frame of a clip is no wall
    for entity in document.chain_layouts_and_blocks():
        if entity.dxftype() == "INSERT":
            for scale in ("xscale", "yscale", "zscale"):  # 0 means 1, as in CAD programs
                entity.dxf.set(scale, entity.dxf.get(scale, 1.0) or 1.0)
    frontend.draw_layout(document.modelspace())
    return recorder.pieces, dict(frontend.skipped)


def _show(layers: Sequence[LayerProperties]) -> None:
    """Make all layers visible: those that are hidden are left out later."""
    for layer in layers:
        layer.is_visible = True


class _Frontend(UniversalFrontend):
    """Walks the entities, and counts those that are not read."""

    def __init__(self, document: Document, recorder: _Recorder, within: float) -> None:
        super().__init__(RenderContext(document), _Pipeline(recorder, within), CONFIGURATION)
        self.ctx.set_layer_properties_override(_show)
        self._document, self._recorder, self._within = document, recorder, within
        self.skipped: Counter[str] = Counter()

    def draw_entity(self, entity: Any, properties: Properties) -> None:
        """Draw an entity, if its kind is read."""
        kind = entity.dxftype()
        block = entity.block() if kind == "INSERT" else None
        line = kind != "POLYLINE" or entity.is_2d_polyline or entity.is_3d_polyline  # or a mesh
        if kind not in READ or not line:
            self.skipped[kind] += 1
        elif kind == "INSERT" and block is None:
            self.skipped["INSERT of a missing block"] += 1
        elif block is not None and block.block is not None and block.block.is_xref:
            self.skipped["INSERT of another file"] += 1
        else:
            try:
                super().draw_entity(entity, properties)
            except (InputError, RecursionError):
                raise
            except Exception:  # of what is wrong in the entity
                self.skipped[f"damaged {kind}"] += 1

    def draw_composite_entity(self, entity: Any, properties: Properties) -> None:
        """Draw what an entity consists of; a block on a frozen layer is hidden as a whole."""
        outer, layers = self._recorder.frozen, self._document.layers
        name = properties.layer
        if entity.dxftype() == "INSERT" and name in layers and layers.get(name).is_frozen():
            self._recorder.frozen = outer or name
        super().draw_composite_entity(entity, properties)
        self._recorder.frozen = outer

    def draw_curve_entity(self, entity: Any, properties: Properties) -> None:
        """Draw a curve; a spline by its own points, since not all of them are Bezier curves."""
        if entity.dxftype() == "SPLINE":
            self.pipeline.draw_path(from_vertices(entity.flattening(self._within)), properties)
        else:
            super().draw_curve_entity(entity, properties)

    def draw_polyline_entity(self, entity: Any, properties: Properties) -> None:
        """Draw a polyline without the frame of its spline; a wide one is an area."""
        if entity.dxftype() == "POLYLINE":
            entity.vertices[:] = [v for v in entity.vertices if not v.dxf.flags & FRAME]
        super().draw_polyline_entity(entity, properties)

    def skip_entity(self, entity: Any, msg: str) -> None:
        """Count what is invisible or can't be drawn."""
        self.skipped["invisible " * (msg == "invisible") + entity.dxftype()] += 1


class _Pipeline(RenderPipeline2d):
    """Makes polylines of paths, before they are clipped."""

    def __init__(self, recorder: _Recorder, within: float) -> None:
        super().__init__(recorder)
        self._within = within

    def draw_path(self, path: Path, properties: Properties) -> None:
        """Draw the parts of a path."""
        for part in path.sub_paths():
            super().draw_path(self._flat(part), properties)

    def draw_filled_paths(self, paths: Iterable[Path], properties: Properties) -> None:
        """Fill what paths surround."""
        parts = [self._flat(part) for path in paths for part in path.sub_paths()]
        super().draw_filled_paths(parts, properties)

    def _flat(self, path: Path) -> Path:
        """Return a path without curves."""
        points = [np.array((path.start.x, path.start.y))]
        for command in path.commands():
            end, *arms = (np.array((place.x, place.y)) for place in command)
            if len(arms) == 1:  # a quadratic curve
                arms = [points[-1] + 2 / 3 * (arms[0] - points[-1]), end + 2 / 3 * (arms[0] - end)]
            if arms:
                points += [*cubic(np.array([points[-1], *arms, end]), self._within, arcs=True)]
            else:
                points.append(end)
        return from_vertices(points)


class _Recorder(Recorder):
    """Takes the lines and areas that are drawn. frozen: the layer that hides all of them."""

    def __init__(self, name: str, metres: float) -> None:
        super().__init__()
        self._name, self._metres = name, metres
        self.pieces: list[Piece] = []
        self.frozen: str | None = None

    def store(self, record: DataRecord, properties: BackendProperties) -> None:
        """Take what is drawn, in place of a list of all records."""
        lines: list[Float] = []
        rings: list[Float] = []
        if isinstance(record, PathRecord):
            lines = [record.path.np_vertices()]
        elif isinstance(record, SolidLinesRecord):
            lines = [*record.lines.np_vertices().reshape(-1, 2, 2)]
        elif isinstance(record, FilledPathsRecord):
            rings = [path.np_vertices() for path in record.paths]
        elif isinstance(record, PointsRecord):
            points = record.points.np_vertices()
            lines, rings = ([points], []) if len(points) == 2 else ([], [points])
        where = f"{self._name}: entity #{properties.handle}"
        layer = layer_name(self.frozen or properties.layer)
        for ring in rings:
            check_finite(where, ring)
        areas = region([ring * self._metres for ring in rings], even_odd=True)
        walls = [wall(where, layer, line, self._metres) for line in lines]
        self.pieces += [Piece(layer, area) for area in areas]
        self.pieces += [piece for piece in walls if piece is not None]
