"""The shapes of bodies: discs, polygons, and compounds of them.

A shape is given in the frame of its body, in metres, x ahead. The physics uses its convex pieces,
drawing uses its rims; mass properties are those of a uniform plate.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache, cached_property, lru_cache
from math import frexp, pi, sqrt
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from mars2d.core import checks
from mars2d.core.arithmetic import cosine_sine, norm, norms
from mars2d.core.description import Description, accepts, entry, number, wrong
from mars2d.core.errors import InputError
from mars2d.core.plane import Outline, Point

Float = NDArray[np.float64]

MAX_VERTICES = 64
"""The largest number of vertices of a polygon: more make the engine slow."""

MAX_PARTS = 64
"""The largest number of parts of a compound."""

MIN_THICKNESS = 1e-4
"""The smallest thickness of a polygon's pieces, metres: the overlap of resting bodies."""

STRAIGHT = 1e-12
"""A vertex nearer to its neighbours' line is removed, relative to the outline's size."""

DISC_CORNERS = 1024
"""Corners of the polygon that stands for a disc in a union of shapes: accurate to 8 digits."""


class Piece(NamedTuple):
    """A shape for the engine: a convex polygon, counter-clockwise, or one point with a radius.

    vertices: at least three [m], or the centre of a disc. radius: 0 for a polygon [m].
    """

    vertices: tuple[Point, ...]
    radius: float


class Rim(NamedTuple):
    """A shape to draw: a closed outline, perhaps concave, or one point with a radius.

    points: at least three [m], or the centre of a disc. radius: 0 for an outline [m].
    """

    points: tuple[Point, ...]
    radius: float


class Plate(NamedTuple):
    """The mass properties of a uniform plate, for any mass.

    area [m^2]; centroid (x, y) [m]; moment_per_mass [m^2], of inertia about the frame's origin;
    lever [m], the mean distance of the plate's points from the centroid: ground friction slows a
    spinning body with the torque mu m g lever.
    """

    area: float
    centroid: Point
    moment_per_mass: float
    lever: float


class Shape(Description):
    """The base of all shapes: a region of the plane in its body's frame."""

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Convex pieces that cover the shape."""
        raise NotImplementedError(f"{type(self).__name__} must say what pieces it has")

    @cached_property
    def rims(self) -> tuple[Rim, ...]:
        """The outlines to draw."""
        raise NotImplementedError(f"{type(self).__name__} must say how it looks")

    @cached_property
    def plate(self) -> Plate:
        """Its mass properties."""
        raise NotImplementedError(f"{type(self).__name__} must say what area it has")

    def moved(self, dx: float, dy: float) -> Self:
        """Return the shape moved by (dx, dy) metres in its frame."""
        raise NotImplementedError(f"{type(self).__name__} must say how it is moved")

    @property
    def area(self) -> float:
        """Its area, m^2; overlapping parts count once."""
        return self.plate.area

    @property
    def centroid(self) -> Point:
        """Its centre of mass (x, y), metres."""
        return self.plate.centroid

    @cached_property
    def bound(self) -> tuple[Point, float]:
        """The centre (x, y) [m] and the radius [m] of the smallest enclosing circle."""
        return _circle_round(self.pieces)

    @property
    def reach(self) -> float:
        """The largest distance of its points from the frame's origin, at most, metres."""
        center, radius = self.bound
        return norm(*center) + radius

    @cached_property
    def thickness(self) -> float:
        """The smallest width of any of its pieces, metres."""
        return min(_width(piece) for piece in self.pieces)


class Disc(Shape):
    """A disc.

    >>> Disc(0.3).moved(0.1, 0).bound
    ((0.1, 0.0), 0.15)
    """

    diameter: float = number(low=1e-3, high=1e3, unit="m", kw_only=False, doc="its diameter")
    center: Point = entry(default=(0.0, 0.0), check=checks.point, unit="m", doc="its centre")

    @property
    def radius(self) -> float:
        """Half the diameter, metres."""
        return self.diameter / 2

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """The disc."""
        return (Piece((self.center,), self.radius),)

    @cached_property
    def rims(self) -> tuple[Rim, ...]:
        """The circle."""
        return (Rim((self.center,), self.radius),)

    @cached_property
    def plate(self) -> Plate:
        """Its mass properties: the lever is two thirds of the radius."""
        r, (x, y) = self.radius, self.center
        return Plate(pi * r * r, self.center, r * r / 2 + x * x + y * y, 2 * r / 3)

    @cached_property
    def bound(self) -> tuple[Point, float]:
        """The circle itself."""
        return self.center, self.radius

    def moved(self, dx: float, dy: float) -> Self:
        """Return the disc moved by (dx, dy) metres."""
        x, y = self.center
        return self.replace(center=(x + dx, y + dy))


@accepts(checks.OUTLINE | {"minItems": 3})
def _outline(name: str, value: object) -> Outline:
    result = checks.outline(name, value, least=3)
    if len(result) > MAX_VERTICES:
        raise InputError(
            f"{name} has {len(result)} vertices: expected at most {MAX_VERTICES}; "
            "leave some out, use Disc for what is round, or Compound for several parts"
        )
    return result


class Polygon(Shape):
    """A polygon from its vertices [m] in order, in either sense; concave ones are cut into pieces.

    >>> ell = Polygon([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)])
    >>> ell.area, len(ell.pieces), ell.thickness
    (3.0, 2, 1.0)
    """

    outline: Outline = entry(check=_outline, unit="m", kw_only=False, doc="its vertices in order")

    def _validate(self) -> None:
        if self.thickness < MIN_THICKNESS:
            raise wrong(
                "Polygon.outline", self.outline,
                f"at least {MIN_THICKNESS:g} m of thickness in each convex piece; "
                f"one is {self.thickness:.3g} m thin",
            )  # fmt: skip

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """The outline if it is convex, else convex parts of it, without new vertices."""
        return tuple(Piece(part, 0.0) for part in _convex_parts(self.outline))

    @cached_property
    def rims(self) -> tuple[Rim, ...]:
        """The outline as it was given."""
        return (Rim(tuple(self.outline), 0.0),)

    @cached_property
    def plate(self) -> Plate:
        """Its mass properties, in closed form."""
        ring = np.array(self.outline)
        return _plate([ring if _is_counter_clockwise(ring) else ring[::-1]])

    def moved(self, dx: float, dy: float) -> Self:
        """Return the polygon moved by (dx, dy) metres."""
        return self.replace(outline=[(x + dx, y + dy) for x, y in self.outline])


def known_shape(name: str, value: object, example: str = "Disc(0.2)") -> Shape:
    """Check a shape: a Disc, Polygon or Compound, or derived from one, whose pieces are sound."""
    shape: Shape = checks.instance(Shape, example)(name, value)
    if isinstance(shape, Compound):
        for part in shape.parts:
            known_shape(name, part)
    elif not isinstance(shape, (Disc, Polygon)):
        raise wrong(name, shape, "a Disc, Polygon or Compound, or a class derived from one")
    return shape


def _parts(name: str, value: object) -> tuple[Shape, ...]:
    parts: tuple[Shape, ...] = checks.listing(Shape, "Disc(0.2)")(name, value)
    if not 1 <= len(parts) <= MAX_PARTS:
        raise wrong(name, value, f"from 1 to {MAX_PARTS} shapes, such as [Disc(0.2), Polygon(...)]")
    return parts


def rectangle(length: float, width: float) -> Polygon:
    """Return a rectangle about the origin, `length` along x and `width` along y, metres."""
    x, y = length / 2, width / 2
    return Polygon([(-x, -y), (x, -y), (x, y), (-x, y)])


class Compound(Shape):
    """Several shapes in one rigid body; overlapping areas count once.

    >>> dumbbell = Compound([Disc(0.2).moved(-0.2, 0), Disc(0.2).moved(0.2, 0)])
    >>> len(dumbbell.pieces), [round(x, 12) for x in (dumbbell.area, dumbbell.bound[1])]
    (2, [0.062831853072, 0.3])

    Mass properties are those of the parts' union. If discs are among them, they are accurate to
    8 digits.
    """

    parts: Sequence[Shape] = entry(check=_parts, kw_only=False, doc="the shapes that make it up")

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """The pieces of all parts; those of overlapping parts overlap."""
        return tuple(piece for part in self.parts for piece in part.pieces)

    @cached_property
    def rims(self) -> tuple[Rim, ...]:
        """The outlines of all parts."""
        return tuple(rim for part in self.parts for rim in part.rims)

    @cached_property
    def plate(self) -> Plate:
        """The mass properties of the parts' union."""
        return _plate(_union(self.rims))

    def moved(self, dx: float, dy: float) -> Self:
        """Return all parts moved by (dx, dy) metres."""
        return self.replace(parts=[part.moved(dx, dy) for part in self.parts])


def _plate(rings: Sequence[Float]) -> Plate:
    """Return the mass properties of a region from its rings (k, 2), metres.

    Outer rings run counter-clockwise, holes clockwise. Each edge contributes the triangle that it
    spans with a reference point, whose area has the sign of its sense of rotation.
    """
    start = np.concatenate(rings)
    end = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
    near = start.mean(axis=0)
    p, q = start - near, end - near
    area = _cross(p, q) / 2
    total = float(area.sum())
    offset = (area[:, None] * (p + q)).sum(axis=0) / (3 * total)
    p, q = p - offset, q - offset
    # A triangle (0, p, q) has the mean square distance (p.p + p.q + q.q) / 6 from 0.
    squares = (p * p + p * q + q * q).sum(axis=1) / 6
    about_centroid = float((_cross(p, q) / 2 * squares).sum()) / total
    x, y = (near + offset).tolist()
    lever = sum(map(_distance_integral, p.tolist(), q.tolist())) / total
    return Plate(total, (x, y), about_centroid + x * x + y * y, lever)


def _distance_integral(p: Point, q: Point) -> float:
    """Return the integral of the distance from 0 over the signed triangle (0, p, q), m^3.

    Let d be the edge's distance from 0, s the position along it, and rho the distance from 0. The
    integral is d / 6 (s rho + d^2 arsinh(s / |d|)) between the ends: |d|^3 / 3 sec^3 over the
    angle.
    """
    ex, ey = q[0] - p[0], q[1] - p[1]
    length = norm(ex, ey)
    d = (p[0] * q[1] - p[1] * q[0]) / length
    if d * d == 0.0:
        return 0.0

    def until(x: float, y: float) -> float:
        s = (x * ex + y * ey) / length
        return s * norm(x, y) + d * d * arsinh(s / abs(d))

    return d / 6 * (until(*q) - until(*p))


def _cross(p: Float, q: Float) -> Float:
    return np.asarray(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0])


def _is_counter_clockwise(ring: Float) -> bool:
    local = ring - ring[0]
    return bool(_cross(local, np.roll(local, -1, axis=0)).sum() > 0)


def _union(rims: Iterable[Rim]) -> list[Float]:
    """Return the rings round the union of regions: outer ones counter-clockwise, then holes."""
    import shapely

    regions = [shapely.Polygon(_region(rim)) for rim in rims]
    united = shapely.orient_polygons(shapely.union_all(regions))
    return [
        np.array(ring.coords[:-1])
        for region in shapely.get_parts(united)
        for ring in (region.exterior, *region.interiors)
    ]


def _circle(center: Point, radius: float, count: int) -> list[Point]:
    angles = [2 * pi * k / count for k in range(count)]
    ways = map(cosine_sine, angles)
    return [(center[0] + radius * c, center[1] + radius * s) for c, s in ways]


def _region(rim: Rim) -> Sequence[Point]:
    """Return the polygon of a rim; for a disc one of the same area, its moment right to 1e-11."""
    if rim.radius == 0:
        return rim.points
    turn = 2 * pi / DISC_CORNERS
    return _circle(rim.points[0], rim.radius * sqrt(turn / cosine_sine(turn)[1]), DISC_CORNERS)


def _circle_round(pieces: Sequence[Piece]) -> tuple[Point, float]:
    """Return the centre and radius of the smallest circle round the pieces, up to rounding.

    The centre is found with 64 points on each disc; the radius encloses the discs themselves.
    """
    import shapely

    corners: list[Point] = []
    for vertices, radius in pieces:
        corners += _circle(vertices[0], radius, 64) if radius else vertices
    middle = shapely.minimum_bounding_circle(shapely.MultiPoint(corners)).centroid
    x, y = (round(float(v), 12) + 0.0 for v in (middle.x, middle.y))  # alike on all processors
    reach = max(norm(px - x, py - y) + r for vertices, r in pieces for px, py in vertices)
    return (x, y), reach


def _width(piece: Piece) -> float:
    """Return the width of a piece: the smallest distance of parallel lines round it, metres."""
    if piece.radius:
        return 2 * piece.radius
    ring = np.array(piece.vertices)
    edges = np.roll(ring, -1, axis=0) - ring
    normals = np.column_stack([-edges[:, 1], edges[:, 0]]) / norms(*edges.T)[:, None]
    heights = ((ring[None, :, :] - ring[:, None, :]) * normals[:, None, :]).sum(axis=2)
    return float(heights.max(axis=1).min())


@lru_cache(maxsize=256)
def _convex_parts(outline: Outline) -> tuple[tuple[Point, ...], ...]:
    """Return a few convex polygons, counter-clockwise, that make up a polygon, without new points.

    The triangles of a constrained Delaunay triangulation are merged across one diagonal after the
    other if the result is convex, the thinnest first.
    Source: Hertel and Mehlhorn, Fast triangulation of simple polygons (1983).
    """
    ring = list(outline)
    if not _is_counter_clockwise(np.array(ring)):
        ring.reverse()
    slack = STRAIGHT * float(np.abs(np.array(ring)).max())
    ring = _bent(ring, slack)
    if _is_convex(ring, slack):
        return (tuple(ring),)
    parts = _triangles(ring)
    width = cache(lambda part: _width(Piece(tuple(ring[i] for i in part), 0.0)))
    while (merged := _merge(ring, parts, slack, width)) is not None:
        parts = merged
    return tuple(tuple(_bent([ring[i] for i in part], slack)) for part in sorted(parts))


def _bend(a: Point, b: Point, c: Point) -> float:
    """Return the distance of b outside the line from a to c, metres; negative at a right turn."""
    turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
    return turn / norm(c[0] - a[0], c[1] - a[1])


def _bends(ring: Sequence[Point]) -> list[float]:
    ends = zip((ring[-1], *ring[:-1]), ring, (*ring[1:], ring[0]), strict=True)
    return [_bend(a, b, c) for a, b, c in ends]


def _bent(ring: Sequence[Point], slack: float) -> list[Point]:
    """Return a ring without the vertices at which it is straight."""
    bends = _bends(ring)
    return [point for point, bend in zip(ring, bends, strict=True) if abs(bend) > slack]


def _is_convex(ring: Sequence[Point], slack: float) -> bool:
    return min(_bends(ring)) > -slack


Part = tuple[int, ...]
"""A part of a ring: the indices of its vertices, counter-clockwise, from the lowest."""


def _from_lowest(part: Sequence[int]) -> Part:
    first = part.index(min(part))
    return (*part[first:], *part[:first])


def _triangles(ring: Sequence[Point]) -> list[Part]:
    """Return the constrained Delaunay triangles of a counter-clockwise ring."""
    import shapely

    index = {point: i for i, point in enumerate(ring)}
    found = shapely.constrained_delaunay_triangles(shapely.Polygon(ring))
    turned = shapely.orient_polygons(found)
    return [
        _from_lowest([index[point] for point in triangle.exterior.coords[:-1]])
        for triangle in shapely.get_parts(turned)
    ]


def _merge(
    ring: Sequence[Point], parts: list[Part], slack: float, width: Callable[[Part], float]
) -> list[Part] | None:
    """Return the parts with two of them merged, or None if no two make a convex one."""
    owner = {edge: part for part in parts for edge in zip(part, (*part[1:], part[0]), strict=True)}
    choices = []
    for (i, j), part in owner.items():
        other = owner.get((j, i))
        if other is None or i > j:
            continue
        whole = _joined(part, other, i, j)
        if _is_convex([ring[k] for k in whole], slack):
            thin = round(min(width(part), width(other)) / slack)  # so that equal widths are equal
            choices.append((thin, i, j, part, other, whole))
    if not choices:
        return None
    *_, part, other, whole = min(choices)
    return [p for p in parts if p not in (part, other)] + [whole]


def _joined(part: Part, other: Part, i: int, j: int) -> Part:
    """Return two parts merged across their diagonal, (i, j) in the first, (j, i) in the other."""
    a, b = part.index(j), other.index(i)
    return _from_lowest((*part[a:], *part[:a], *(*other[b:], *other[:b])[1:-1]))


def logarithm(x: float) -> float:
    """Return the natural logarithm of a number x > 0, the same on every processor."""
    m, k = frexp(x)
    if m < 0.7071067811865476:
        m, k = m * 2, k - 1
    rest = _double_artanh((m - 1) / (m + 1))
    return k * 6.93147180369123816490e-01 + (k * 1.90821492927058770002e-10 + rest)


def arsinh(x: float) -> float:
    """Return the inverse hyperbolic sine of a number."""
    more = abs(x) + x * x / (1 + sqrt(x * x + 1))
    size = _double_artanh(more / (2 + more)) if more < 0.4 else logarithm(1 + more)
    return -size if x < 0 else size


def _double_artanh(s: float) -> float:
    """Return ln((1 + s) / (1 - s)) for |s| <= 0.172."""
    z, p = s * s, 0.0
    for odd in range(21, 1, -2):
        p = (p + 1 / odd) * z
    return 2 * s * (1 + p)
