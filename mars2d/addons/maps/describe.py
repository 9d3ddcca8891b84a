"""What was read of a map, in words."""

from __future__ import annotations

from mars2d.addons.maps.drawing import Drawing, listed
from mars2d.addons.maps.obstacles import Obstacles
from mars2d.core.errors import counted

__all__ = ["described"]

SHOWN = 24
"""So many layers are named."""


def described(drawing: Drawing, found: Obstacles, tolerance: float) -> list[tuple[str, str]]:
    """Return what was read of a map, and what became of it, as names and texts.

    found: its obstacles, at a tolerance in metres.
    """
    (width, height), (xmin, xmax, ymin, ymax) = drawing.size, drawing.bounds
    unit = f"{drawing.unit.name}, {drawing.unit.source}"
    rows = [
        ("map", f"{drawing.source}, {drawing.kind}"),
        ("size", f"{width:.4g} m x {height:.4g} m"),
        ("from, to", f"({xmin:.5g}, {ymin:.5g}), ({xmax:.5g}, {ymax:.5g})"),
        ("unit", unit if drawing.unit.name else drawing.unit.source),
        ("hint", drawing.hint),
        *drawing.notes,
        *_layers(drawing),
        ("not read", listed(drawing.skipped)),
        ("obstacles", _counts(found)),
        ("corners", f"{found.corners}, within {tolerance:g} m"),
    ]
    return [(name, text) for name, text in rows if text]


def _layers(drawing: Drawing) -> list[tuple[str, str]]:
    """Return a row for each layer: those that were read, then the others."""
    both = [(name, count, "") for name, count in drawing.layers.items()]
    for name, count in drawing.others.items():
        hidden = "hidden, " if name in drawing.hidden else ""
        both.append((name, count, f" ({hidden}not read)"))
    if len(both) < 2:
        return []
    width = max(len(name) for name, _, _ in both[:SHOWN])
    rows = [
        ("" if k else "layers", f"{name:<{width}}  {counted(count, 'piece')}{more}")
        for k, (name, count, more) in enumerate(both[:SHOWN])
    ]
    rest = sum(count for _, count, _ in both[SHOWN:])
    more = [("", f"and {len(both) - SHOWN} more, {counted(rest, 'piece')}")] if rest else []
    return [*rows, *more]


def _counts(found: Obstacles) -> str:
    parts = [(len(found.outlines), "outline"), (len(found.walls), "wall")]
    return ", ".join(counted(count, thing) for count, thing in parts if count)
