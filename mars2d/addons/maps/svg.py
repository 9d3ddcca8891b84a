"""SVG drawings: filled shapes are solid, lines are walls."""

from __future__ import annotations

import io
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
from numpy.typing import NDArray

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
from mars2d.addons.maps.regions import region
from mars2d.core.errors import InputError, shown
from mars2d.core.extras import extra

Float = NDArray[np.float64]

SVG = "{http://www.w3.org/2000/svg}"
LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"

ASIDE = ("symbol", "marker", "mask", "pattern", "clipPath", "filter", "metadata", "foreignObject")
"""Elements that draw nothing where they stand."""

LENGTHS = {"mm": 1e-3, "cm": 1e-2, "in": 0.0254, "pt": 0.0254 / 72, "pc": 0.0254 / 6}
PIXEL = 0.0254 / 96
"""The pixel of CSS, metres."""

PAPER = 0.97
"""The brightness above which a filled shape is paper, from 0 to 1."""

ROUND = 128
"""The points on a full turn of an arc; a Bezier curve has a quarter of them."""


def read_svg(path: Path, unit: Unit | None) -> Drawing:
    """Read an SVG drawing; its y axis, which points down, is turned up.

    unit: that of a user unit, which is a unit of the viewBox; None takes it from the width in mm,
    cm, in, pt or pc, if there is one. What has a fill that is not white is solid, as it looks;
    else what has a stroke is a wall without thickness. A layer is the innermost group with a
    label, or with an id. Raises InputError.
    """
    name = path.name
    with extra("maps", f"{name}: an SVG drawing needs svgelements", ALWAYS):
        import svgelements
    with broken(name, "an SVG drawing"):
        root = _parsed(name, path.read_bytes())
        unit, height = unit or _unit(root), _height(root)
        for size in ("width", "height", "preserveAspectRatio"):
            root.attrib.pop(size, None)  # now a user unit is 1
        data = io.BytesIO(ET.tostring(root))
        document = svgelements.SVG.parse(data, on_error="raise")
        skipped: Counter[str] = Counter()
        pieces = []
        for layer, shape in _drawn(document, NO_LAYER, skipped):
            rings = _rings(shape)
            for points in rings:
                check_finite(name, points)
                points[:, 1] = height - points[:, 1]
            pieces += _pieces(name, layer, shape, rings, unit.metres, skipped)
    return Drawing(name, "an SVG drawing", unit, tuple(pieces), skipped=dict(skipped))


def _parsed(name: str, data: bytes) -> ET.Element:
    """Return the tree of an SVG. Raises InputError."""
    root = ET.fromstring(data)
    if root.tag not in ("svg", f"{SVG}svg"):
        raise InputError(f"{name}: expected an SVG drawing; its root is <{shown(root.tag, 40)}>")
    _set_aside(root)
    return root


def _set_aside(root: ET.Element) -> None:
    """Put elements that draw nothing where they stand into <defs>: they are found by their ids."""
    names = {prefix + tag for tag in ASIDE for prefix in ("", SVG)}
    for parent in list(root.iter()):
        if parent.tag in ("defs", f"{SVG}defs"):
            continue
        for k, child in enumerate(list(parent)):
            if child.tag in names:
                aside = ET.Element(f"{SVG}defs")
                aside.append(child)
                parent[k] = aside


def _unit(root: ET.Element) -> Unit:
    """Return the user unit, by the drawing's width; metres if that has no unit."""
    width, suffix = _length(root.get("width", ""))
    box = _view_box(root)
    if suffix in LENGTHS and width:
        metres = PIXEL if box is None else LENGTHS[suffix] * width / box[2]
        said = f"by the width, {root.get('width')}" + (f" for {box[2]:g} units" if box else "")
        for name, length in METRES.items():
            if abs(metres / length - 1) < 1e-6:
                return Unit.named(name, said)
        return Unit(f"{metres:.6g} m", metres, said)
    return Unit.named("m", "supposed: the width has no unit")


def _height(root: ET.Element) -> float:
    """Return y at the lower edge, in user units as svgelements counts them."""
    box = _view_box(root)
    return box[3] if box is not None else _length(root.get("height", ""))[0]


def _length(text: str) -> tuple[float, str]:
    """Return a length as number and unit; 0 if it is none, or a share."""
    found = re.fullmatch(r"\s*([0-9.]+(?:e[+-]?\d{1,2})?)\s*([a-z]*)\s*", text[:40], flags=re.I)
    return (float(found[1]), found[2].lower()) if found else (0.0, "")


def _view_box(root: ET.Element) -> tuple[float, float, float, float] | None:
    text = root.get("viewBox")
    if text is None:
        return None
    try:
        x, y, width, height = (float(item) for item in re.split(r"[\s,]+", text.strip()))
    except ValueError:
        width = height = 0.0
    if not (0 < width < 1e12 and 0 < height < 1e12):
        raise InputError(f"viewBox = {shown(text)}: expected x, y, width > 0 and height > 0")
    return x, y, width, height


def _drawn(group: Any, layer: str, skipped: Counter[str]) -> Iterator[tuple[str, Any]]:
    """Yield the shapes of a group with the layer of each."""
    import svgelements

    for element in group:
        if isinstance(element, svgelements.Shape):
            if str(element.values.get("visibility", "")) in ("hidden", "collapse"):
                skipped["hidden"] += 1
            else:
                yield layer, element
        elif isinstance(element, list):  # a group, a <use>, a drawing in the drawing
            values: Any = getattr(element, "values", {})
            own = values.get("attributes", {})
            name = layer_name(own.get(LABEL) or own.get("id"), layer)
            inner = name if values.get("tag") == "g" else layer
            yield from _drawn(element, inner, skipped)
        elif isinstance(element, (svgelements.Text, svgelements.Image)):
            skipped[type(element).__name__.lower()] += 1


def _pieces(
    name: str, layer: str, shape: Any, rings: list[Float], metres: float, skipped: Counter[str]
) -> list[Piece]:
    """Return a shape as areas if it is filled, else as walls if it has a line."""
    if _is_solid(shape):
        even_odd = str(shape.values.get("fill-rule", "")) == "evenodd"
        areas = region([points * metres for points in rings], even_odd=even_odd)
        if areas:
            return [Piece(layer, area) for area in areas]
    if _is_seen(shape.stroke, shape.values.get("stroke-opacity")):
        walls = [wall(name, layer, points, metres) for points in rings]
        return [piece for piece in walls if piece is not None]
    skipped["white or without a line"] += 1
    return []


def _is_solid(shape: Any) -> bool:
    if not _is_seen(shape.fill, shape.values.get("fill-opacity")):
        return False
    fill = shape.fill
    return bool(min(fill.red, fill.green, fill.blue) < 255 * PAPER)


def _is_seen(color: Any, opacity: Any) -> bool:
    """Return whether there is a colour that is not fully transparent."""
    try:
        clear = opacity is not None and float(opacity) == 0
    except ValueError:
        clear = False
    there = color is not None and color.value is not None and color.alpha > 0
    return bool(there and not clear)


def _rings(shape: Any) -> list[Float]:
    """Return the points (k, 2) of each part of a shape, in user units, y down."""
    import svgelements

    found: list[list[tuple[float, float]]] = []
    for segment in abs(svgelements.Path(shape)):  # abs: its transforms done
        if isinstance(segment, svgelements.Move):
            found.append([(segment.end.x, segment.end.y)])
            continue
        if segment.start is None or segment.end is None:
            continue
        if not found:
            found.append([(segment.start.x, segment.start.y)])
        if isinstance(segment, svgelements.Arc):
            count = int(min(abs(segment.sweep) / (2 * np.pi), 1) * ROUND) + 2
        elif isinstance(segment, (svgelements.CubicBezier, svgelements.QuadraticBezier)):
            count = ROUND // 4
        else:
            count = 1
        if count == 1:
            found[-1].append((segment.end.x, segment.end.y))
        else:
            places = np.arange(1, count + 1) / count
            found[-1] += [tuple(point) for point in np.asarray(segment.npoint(places))]
    return [np.array(points, dtype=float) for points in found if len(points) > 1]
