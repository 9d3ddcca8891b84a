"""The names of bodies, placed so that they cover neither each other nor bodies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.scene import INK, Arrow, Scene, Shape, Text
from mars2d.output.layers.bodies import bounding_circle
from mars2d.output.layers.rings import RING, has_ring
from mars2d.record.frame import Frame

Float = NDArray[np.float64]

LETTER = 0.6
"""The approximate width of a letter, in text heights."""

RINGS = 6
"""How many text heights a name may be away from its body."""

WAYS = [(0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0),
        (0.7, 0.7), (-0.7, 0.7), (0.7, -0.7), (-0.7, -0.7)]  # fmt: skip
"""Where a name may stand, as seen from its body: above at best."""

PLACES = np.array([(ring, *way) for ring in range(RINGS) for way in WAYS])
"""All places (48, 3), the best first: the ring, and the way to it."""

AVOIDED = ("velocities", "impulses", "forces")
"""The layers whose arrows and numbers names don't cover."""

SELECTED = 11.0
"""How far the ring of a selected body lies outside of it, points."""

CLEAR, STAYS = 1e-9, 0.05
"""The shared area that counts as none, and by how much of its own area another place must be
better than the last one, in shares of the name's area."""


class Box(NamedTuple):
    """An upright rectangle by its centre and its half width and height, metres."""

    x: float
    y: float
    wide: float
    high: float


def placed_names(
    names: Scene,
    frame: Frame,
    metres_per_point: float,
    bounds: tuple[float, float, float, float],
    others: Sequence[Shape] = (),
    first: int | None = None,
    last: dict[int, int] | None = None,
) -> Scene:
    """Return the names of all bodies, each beside its body and away from the others.

    names: a text for each body; anything else stays where it is. A name that has room above its
    body stands there; one that finds no room beside it has a thin line to it. metres_per_point: how
    long a point of a text's height is. bounds: (xmin, xmax, ymin, ymax) of what is shown, metres;
    names of bodies beyond stay as they are. others: arrows and texts that are there already. first:
    the selected body, which has a ring: its name is placed before all others. last: the places by
    body in the picture before, which are kept where they are as good as others; it is updated.
    """
    rings = [has_ring(frame.scenario, i) for i in range(len(frame.scenario.bodies))]
    ringed = [ring or i == first for i, ring in enumerate(rings)]
    bodies = []
    for body, pose, ring in zip(frame.scenario.bodies, frame.all_poses.T, rings, strict=True):
        middle, radius = bounding_circle(body.shape, pose)
        x, y = middle.tolist()
        bodies.append(Box(x, y, *[max(radius, RING * metres_per_point * ring)] * 2))
    if first is not None:
        x, y, radius, _ = bodies[first]
        bodies[first] = Box(x, y, *[radius + SELECTED * metres_per_point] * 2)
    labels = [shape for shape in names.shapes if isinstance(shape, Text)]
    if not bodies or len(labels) != len(bodies):
        return names
    half = [_half(label, metres_per_point) for label in labels]
    covering = [each for each in others if isinstance(each, (Arrow, Text))]
    fixed = np.array([_box_of(each, metres_per_point) for each in covering]).reshape(-1, 4)
    xmin, xmax, ymin, ymax = bounds
    view = Box((xmin + xmax) / 2, (ymin + ymax) / 2, (xmax - xmin) / 2, (ymax - ymin) / 2)
    discs, seen_part = np.array(bodies), np.array([view])
    above = _boxes(bodies, half, PLACES[:1])[:, 0]
    mutual = _overlaps(above, above)
    np.fill_diagonal(mutual, 0.0)
    cost = mutual.sum(axis=1) + _cost(above, fixed, discs, seen_part)
    free = cost <= CLEAR * 4 * above[:, 2] * above[:, 3]
    if first is not None:
        free[first] = True
    seen = (abs(discs[:, 0] - view.x) <= view.wide) & (abs(discs[:, 1] - view.y) <= view.high)
    crowded = np.flatnonzero(seen & ~free).tolist()
    chosen = np.zeros(len(bodies), dtype=int)
    taken = np.vstack([above[seen & free], fixed])
    for i, boxes in zip(
        crowded, _boxes(discs[crowded], np.array(half)[crowded], PLACES), strict=True
    ):
        cost = _cost(boxes, taken, discs, seen_part)
        if last is not None and i in last:
            cost[last[i]] -= STAYS * 4 * half[i][0] * half[i][1]
        chosen[i] = int(np.argmin(cost))
        taken = np.vstack([taken, boxes[chosen[i]]])
    if last is not None:
        last.clear()
        last.update({i: int(chosen[i]) for i in crowded})
    return _drawn(names, labels, bodies, half, chosen, ringed)


def _drawn(
    names: Scene,
    labels: Sequence[Text],
    bodies: Sequence[Box],
    half: Sequence[tuple[float, float]],
    chosen: NDArray[np.int64],
    ringed: Sequence[bool],
) -> Scene:
    """Return the labels at their places, by index, with a line where one is far from its body."""
    scene = Scene([shape for shape in names.shapes if not isinstance(shape, Text)])
    each = zip(labels, bodies, half, chosen, ringed, strict=True)
    for label, body, (wide, high), place, above_ring in each:
        if not (place or above_ring):
            scene.shapes.append(label)
            continue
        at = Box(*_boxes([body], [(wide, high)], PLACES[place][None])[0, 0].tolist())
        if PLACES[place][0] > 1:
            scene.line([(body.x, body.y), (at.x, at.y)], stroke=INK, width=0.7)
        scene.shapes.append(
            Text((at.x, at.y), label.text, label.color, label.size, "center", label.halo)
        )
    return scene


def _half(label: Text, metres_per_point: float) -> tuple[float, float]:
    """Return half the width and height of a text, metres."""
    height = label.size * metres_per_point
    return 0.5 * LETTER * height * len(label.text), 0.6 * height


def _box_of(shape: Arrow | Text, metres_per_point: float) -> Box:
    """Return the box that an arrow or a text covers."""
    if isinstance(shape, Text):
        (x, y), (wide, high) = shape.position, _half(shape, metres_per_point)
        up = {"above": high, "below": -high}.get(shape.anchor, 0.0)
        return Box(x + wide * (shape.anchor == "left"), y + up, wide, high)
    (x0, y0), (x1, y1) = shape.tail, shape.tip
    thick = 2 * shape.width * metres_per_point
    return Box((x0 + x1) / 2, (y0 + y1) / 2, abs(x1 - x0) / 2 + thick, abs(y1 - y0) / 2 + thick)


def _boxes(bodies: ArrayLike, half: ArrayLike, places: Float) -> Float:
    """Return the boxes (n, k, 4) of names at k places beside their bodies (n, 4)."""
    x, y, far, _ = np.asarray(bodies).T[:, :, None]
    wide, high = np.asarray(half).T[:, :, None]
    ring, across, up = places.T[:, None]
    gap = (2 * ring + 0.3) * high
    made = (x + across * (far + gap + wide), y + up * (far + gap + high), wide, high)
    return np.stack(np.broadcast_arrays(*made), axis=-1)


def _overlaps(boxes: Float, others: Float) -> Float:
    """Return the areas (n, m) that boxes (n, 4) share with others (m, 4), square metres."""
    (x, y, wide, high), (u, v, w, h) = boxes.T[:, :, None], others.T[:, None]
    across = np.minimum(x + wide, u + w) - np.maximum(x - wide, u - w)
    along = np.minimum(y + high, v + h) - np.maximum(y - high, v - h)
    return np.asarray(np.maximum(across, 0.0) * np.maximum(along, 0.0))


def _cost(boxes: Float, taken: Float, bodies: Float, view: Float) -> Float:
    """Return how much of each box is not free; covering another name counts most."""
    covered = 10 * _overlaps(boxes, taken).sum(axis=1) + _overlaps(boxes, bodies).sum(axis=1)
    outside = 4 * boxes[:, 2] * boxes[:, 3] - _overlaps(boxes, view)[:, 0]
    return np.asarray(np.round(covered + 10 * outside, 12))
