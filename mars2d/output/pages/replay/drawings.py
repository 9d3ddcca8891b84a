"""What add-ons and sensors draw over time, as columns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from mars2d.output.pages.replay.columns import Columns, Int, rounded
from mars2d.output.pages.replay.shapes import Flat, Style

__all__ = ["Book", "Drawing", "pack"]


@dataclass(frozen=True)
class Drawing:
    """Scenes over time: `scenes[k]` is seen from row `rows[k]` on.

    body: the index of the body in whose frame they are; None: in that of the world. stays: they
    are where the body was at the last row, not where it is between two.
    """

    rows: Sequence[int]
    scenes: Sequence[Flat]
    body: int | None = None
    stays: bool = False


@dataclass
class Book:
    """What several scenes share: styles, and which of them follow on each other in a scene."""

    styles: dict[Style, int] = field(default_factory=dict)
    orders: dict[tuple[int, ...], int] = field(default_factory=dict)
    images: dict[int, str] = field(default_factory=dict)

    def order_of(self, scene: Flat, columns: Columns, name: str) -> int:
        """Return the number of a scene's order of shapes; its images become columns."""
        for key, pixels in scene.images.items():
            if key not in self.images:
                self.images[key] = f"{name}:image{len(self.images)}"
                columns.add_bytes(self.images[key], pixels)
        listed: list[int] = []
        for style, count in zip(scene.styles, scene.counts, strict=True):
            own = ("image", self.images[style[1]]) if style[0] == "image" else style
            listed += [self.styles.setdefault(own, len(self.styles)), count]
        return self.orders.setdefault(tuple(listed), len(self.orders))


def pack(
    name: str, drawings: Sequence[Drawing], every: int, step: float
) -> tuple[Columns, dict[str, Any], int]:
    """Return drawings as columns, with what has to be known of them, and how many rows they have.

    every: of so many rows in a row, one scene is kept, the last. step: metres. A shape is written
    as what it differs from the one before at its place among as many numbers.
    """
    columns, book = Columns(), Book()
    rows: list[int] = []
    orders: list[int] = []
    numbers: list[Int] = []
    heads: list[dict[str, Any]] = []
    most = 0
    for drawing in drawings:
        before: tuple[int, Int] | None = None
        last: dict[tuple[int, int], Int] = {}
        scenes = 0
        for row, scene in _last_of_each(drawing, every):
            order = book.order_of(scene, columns, name)
            values = rounded(scene.numbers, step)
            if before is not None and before[0] == order and np.array_equal(before[1], values):
                continue
            before = order, values
            start = 0
            for k, count in enumerate(scene.counts):
                part = values[start : start + count]
                numbers.append(part - last.get((k, count), 0))
                last[k, count] = part
                start += count
            rows.append(row)
            orders.append(order)
            scenes += 1
        most = max(most, scenes)
        heads.append({"scenes": scenes, "body": drawing.body, "stays": drawing.stays})
    columns.add(f"{name}:rows", np.array(rows, dtype=int), order=1)
    columns.add(f"{name}:orders", np.array(orders, dtype=int))
    joined = np.concatenate(numbers) if numbers else np.empty(0, dtype=int)
    columns.add(f"{name}:numbers", joined)
    header = {
        "name": name,
        "step": step,
        "drawings": heads,
        "styles": [list(style) for style in book.styles],
        "orders": [list(order) for order in book.orders],
    }
    return columns, header, most


def _last_of_each(drawing: Drawing, every: int) -> list[tuple[int, Flat]]:
    """Return the last row and scene of each `every` rows."""
    kept = {
        row // every: (row, scene) for row, scene in zip(drawing.rows, drawing.scenes, strict=True)
    }
    return list(kept.values())
