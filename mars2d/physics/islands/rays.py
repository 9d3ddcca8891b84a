"""Rays and nearest points: how far it is to what is there.

A ray alone and one of many get the same bits.

A fan is a set of rays that start in one point. What is near covers an interval of their bearings,
and only rays within it are worked out: a fan of 180 rays among 200 edges needs about a hundred
divisions instead of 36 000. Bearings are compared as *diamond angles*, which take one division: the
way along the square |x| + |y| = 1, from 0 to 4.

The length of a ray follows from its start, its direction and the thing hit alone.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import cosine_sine, length


@cython.cclass
class Things:
    """What rays may hit: convex rings of edges, counter-clockwise, and discs.

    The first `wide` of them are much larger than the others, which are kept in the order of `x`.
    """

    solid: cython.bint  # whether a ray that starts within one has the length 0
    wide: cython.int
    largest: cython.double  # radius of the others
    order: list[int]  # of the others
    # of each thing: its owner, its first edge, how many (none for a disc), and a circle about it
    owner: cython.Doubles
    first: cython.Doubles
    edges: cython.Doubles
    radius: cython.Doubles
    x: cython.Doubles
    y: cython.Doubles
    # the ends of each edge
    ax: cython.Doubles
    ay: cython.Doubles
    bx: cython.Doubles
    by: cython.Doubles
    # all middles of circles and ends: whose they are, where in its frame, and where they are
    bodies: cython.Doubles
    local_x: cython.Doubles
    local_y: cython.Doubles
    all_x: cython.Doubles
    all_y: cython.Doubles

    def __init__(self, solid: bool, wide: int, largest: float, things: Any, points: Any) -> None:
        """Take things: owners, first edges, numbers of edges, radii; and the memory of points.

        points: their bodies, and where they are in the frames of these; x and y of all, and the
        parts of both for middles, starts and ends.
        """
        self.solid, self.wide, self.largest = solid, wide, largest
        self.owner, self.first, self.edges, self.radius = things
        self.bodies, self.local_x, self.local_y = points[:3]
        self.all_x, self.all_y, self.x, self.y, self.ax, self.ay, self.bx, self.by = points[3:]
        self.order = list(range(wide, len(self.radius)))

    def place(self, states: cython.Doubles) -> None:
        """Move all to where their bodies are: six numbers each, first x, y [m], theta [rad]."""
        at: cython.int = 0
        c, s = cosine_sine(states[2])
        for k in range(len(self.bodies)):
            if 6 * int(self.bodies[k]) != at:
                at = 6 * int(self.bodies[k])
                c, s = cosine_sine(states[at + 2])
            self.all_x[k] = states[at] + c * self.local_x[k] - s * self.local_y[k]
            self.all_y[k] = states[at + 1] + s * self.local_x[k] + c * self.local_y[k]
        self.order.sort(key=self.x_of)

    def x_of(self, thing: int) -> float:
        """Return the x of a thing."""
        return self.x[thing]

    def from_x(self, x: cython.double) -> cython.int:
        """Return how many of the things in order have a smaller x."""
        low: cython.int = 0
        high: cython.int = len(self.order)
        while low < high:
            middle = (low + high) // 2
            thing: cython.int = self.order[middle]
            if self.x[thing] < x:
                low = middle + 1
            else:
                high = middle
        return low


@cython.cclass
class Caster:
    """Casts fans of rays at things, fan by fan."""

    groups: list[Things]
    # the fan: its start, the cosine and sine of its heading, whom it does not see, its reach [m]
    x: cython.double
    y: cython.double
    c: cython.double
    s: cython.double
    ignore: cython.int
    reach: cython.double
    # its rays: how many, their diamond angles from the heading, ascending, and their directions
    count: cython.int
    angle: cython.Doubles
    way_x: cython.Doubles
    way_y: cython.Doubles
    # what is found: lengths [m] and owners, from `at` on
    at: cython.int
    lengths: cython.Doubles
    owners: cython.Doubles
    # or without rays, of the nearest points: how far away they are [m], x and y
    nearest: list[Any]

    def __init__(self, groups: list[Things]) -> None:
        """Take the groups of things."""
        self.groups = groups

    def scan(
        self,
        poses: cython.Doubles,
        rays: Any,
        reach: float,
        ignore: cython.Doubles,
        ways: Any,
        found: Any,
    ) -> None:
        """Find the lengths and the owners of all rays of fans (m,) with the same bearings (k,).

        poses: (3 m,). rays: diamond angles, ascending, cosines and sines of the bearings, (k,)
        each. ways: memory for their directions (k,). found: lengths and owners (m k,), which
        begin with inf and the number that stands for nothing.
        """
        cosines: cython.Doubles
        sines: cython.Doubles
        self.angle, cosines, sines = rays
        self.way_x, self.way_y = ways
        self.lengths, self.owners = found
        self.count, self.reach = len(cosines), reach
        m: cython.int = len(ignore)
        for i in range(m):
            self.x, self.y, self.at = poses[i], poses[m + i], i * self.count
            self.c, self.s = cosine_sine(poses[2 * m + i])
            self.ignore = int(ignore[i])
            for k in range(self.count):
                self.way_x[k] = self.c * cosines[k] - self.s * sines[k]
                self.way_y[k] = self.s * cosines[k] + self.c * sines[k]
            self.look()

    def reach_points(
        self,
        x: float,
        y: float,
        points: cython.Doubles,
        ignore: int,
        memory: Any,
        found: Any,
    ) -> None:
        """Find the lengths and the owners of one ray to each of some points, (2 k,): x, then y.

        memory: three numbers. found: as for `scan`; a ray goes as far as its point.
        """
        self.angle, self.way_x, self.way_y = memory
        self.lengths, self.owners = found
        self.x, self.y, self.ignore, self.count = x, y, ignore, 1
        many: cython.int = len(points) // 2
        for k in range(many):
            dx: cython.double = points[k] - self.x
            dy: cython.double = points[many + k] - self.y
            self.reach = length(dx, dy)
            if self.reach > 0.0:
                self.c, self.s, self.at = dx / self.reach, dy / self.reach, k
                self.angle[0], self.way_x[0], self.way_y[0] = 0.0, self.c, self.s
                self.look()

    def nearby(self, x: float, y: float, limit: float, ignore: int) -> list[Any]:
        """Return the nearest points of the surfaces that are nearer to a point than `limit`.

        They are tuples: how far away, in metres and negative within a body, x and y. A surface is
        an edge of what is not solid, or else a disc or ring.
        """
        self.x, self.y, self.reach, self.ignore, self.count = x, y, limit, ignore, 0
        self.nearest = []
        self.look()
        return self.nearest

    def look(self) -> cython.void:
        """Cast the fan, or find the nearest points."""
        for things in self.groups:
            for k in range(things.wide):
                self.meet(things, k)
            far: cython.double = (1.0 + 1e-9) * (self.reach + things.largest)
            for k in range(things.from_x(self.x - far), len(things.order)):
                thing: cython.int = things.order[k]
                if things.x[thing] > self.x + far:
                    break
                self.meet(things, thing)

    def meet(self, things: Things, thing: cython.int) -> cython.void:
        """Let the fan's rays meet a thing."""
        x: cython.double = things.x[thing] - self.x
        y: cython.double = things.y[thing] - self.y
        radius: cython.double = things.radius[thing]
        far: cython.double = (1.0 + 1e-9) * (radius + self.reach)
        owner: cython.int = int(things.owner[thing])
        if x * x + y * y > far * far or (owner >= 0 and owner == self.ignore):
            return
        if self.count == 0:
            self.approach(things, thing)
            return
        if self.count == 1:  # most things are beside a single ray
            beside: cython.double = self.way_x[0] * y - self.way_y[0] * x
            if abs(beside) > (1.0 + 1e-9) * radius + 1e-9:
                return
        if things.edges[thing] == 0.0:
            self.meet_disc(x, y, radius, owner)
        else:
            self.meet_ring(things, int(things.first[thing]), int(things.edges[thing]), owner)

    def approach(self, things: Things, thing: cython.int) -> cython.void:
        """Find the nearest point of a thing.

        Source for a disc and an edge: C. Ericson, Real-Time Collision Detection, 5.1 (2005).
        """
        x: cython.double = things.x[thing] - self.x
        y: cython.double = things.y[thing] - self.y
        if things.edges[thing] == 0.0:
            far = length(x, y)
            share: cython.double = things.radius[thing] / far if far > 0.0 else 0.0
            x, y = things.x[thing] - x * share, things.y[thing] - y * share
            self.note(far - things.radius[thing], x, y)
            return
        first: cython.int = int(things.first[thing])
        edge: cython.int
        least: cython.double = 1e300
        inside: cython.bint = things.solid
        for edge in range(first, first + int(things.edges[thing])):
            back_x: cython.double = things.ax[edge] - things.bx[edge]
            back_y: cython.double = things.ay[edge] - things.by[edge]
            along: cython.double = (self.x - things.bx[edge]) * back_x
            along = along + (self.y - things.by[edge]) * back_y
            along = along / (back_x * back_x + back_y * back_y)
            along = max(0.0, min(along, 1.0))
            at_x: cython.double = things.bx[edge] + back_x * along
            at_y: cython.double = things.by[edge] + back_y * along
            far = length(self.x - at_x, self.y - at_y)
            inside = inside and self.area(things, edge) >= 0.0
            if not things.solid:
                self.note(far, at_x, at_y)
            elif far < least:
                least, x, y = far, at_x, at_y
        if things.solid:
            self.note(-least if inside else least, x, y)

    def note(self, far: cython.double, x: cython.double, y: cython.double) -> cython.void:
        """Keep a point that is near enough."""
        if far < self.reach:
            self.nearest.append((far, x, y))

    def meet_disc(
        self, x: cython.double, y: cython.double, radius: cython.double, owner: cython.int
    ) -> cython.void:
        """Let rays meet a disc. x, y: from the start to its middle."""
        tangent: cython.double = x * x + y * y - radius * radius
        if tangent <= 0.0:
            self.end_all(owner)
            return
        tangent = sqrt(tangent)
        low: cython.double = self.diamond(x * tangent + y * radius, y * tangent - x * radius)
        high: cython.double = self.diamond(x * tangent - y * radius, y * tangent + x * radius)
        if high < low:
            high += 4.0
        if low < 2e-9:
            low, high = low + 4.0, high + 4.0
        first: cython.int = self.below(low - 2e-9)
        for k in range(first, self.end_of(first, high + 2e-9)):
            ray: cython.int = k % self.count
            c: cython.double = self.way_x[ray]
            s: cython.double = self.way_y[ray]
            across: cython.double = c * y - s * x
            inner: cython.double = radius * radius - across * across
            if inner >= 0.0:
                self.end(ray, max((c * x + s * y) - sqrt(inner), 0.0), owner)

    def meet_ring(
        self, things: Things, first: cython.int, edges: cython.int, owner: cython.int
    ) -> cython.void:
        """Let rays meet a convex ring, or a single edge, of which both sides count.

        From outside, some edges show their outer sides and hide the others; from inside, none does.
        """
        inside: cython.bint = True
        for edge in range(first, first + edges):
            if self.area(things, edge) < 0.0:
                inside = False
                break
        if inside and things.solid:
            self.end_all(owner)
            return
        for edge in range(first, first + edges):
            area: cython.double = self.area(things, edge)
            if inside or area < 0.0:
                self.meet_edge(things, edge, area, owner)

    def area(self, things: Things, edge: cython.int) -> cython.double:
        """Return the signed area of the parallelogram spanned by an edge and the start, m^2."""
        ex: cython.double = things.bx[edge] - things.ax[edge]
        ey: cython.double = things.by[edge] - things.ay[edge]
        return (things.ax[edge] - self.x) * ey - (things.ay[edge] - self.y) * ex

    def meet_edge(
        self, things: Things, edge: cython.int, area: cython.double, owner: cython.int
    ) -> cython.void:
        """Let rays meet an edge."""
        ax: cython.double = things.ax[edge] - self.x
        ay: cython.double = things.ay[edge] - self.y
        bx: cython.double = things.bx[edge] - self.x
        by: cython.double = things.by[edge] - self.y
        ex: cython.double = things.bx[edge] - things.ax[edge]
        ey: cython.double = things.by[edge] - things.ay[edge]
        long: cython.double = ex * ex + ey * ey
        reach: cython.double = (1.0 + 1e-9) * self.reach
        if area * area > reach * reach * long:  # its line is too far away
            return
        far_a: cython.double = ax * ax + ay * ay
        far_b: cython.double = bx * bx + by * by
        # An edge seen under a smaller angle than 1e-4 is worked out by what is stable there.
        grazing: cython.bint = area * area <= max(far_a, far_b) * (1e-8 * long)
        low: cython.double = self.diamond(ax, ay)
        high: cython.double = self.diamond(bx, by)
        if -2.0 < high - low < 0.0 or high - low > 2.0:
            low, high = high, low
        if high < low:
            high += 4.0
        if grazing and (far_a == 0.0 or far_b == 0.0 or ax * bx + ay * by < 0.0):
            low, high = 0.0, 4.0  # the start lies on the edge, which is all around it
        if low < 2e-9:
            low, high = low + 4.0, high + 4.0
        first: cython.int = self.below(low - 2e-9)
        for k in range(first, self.end_of(first, high + 2e-9)):
            ray: cython.int = k % self.count
            c: cython.double = self.way_x[ray]
            s: cython.double = self.way_y[ray]
            angle: cython.double = self.angle[ray]
            while angle < low - 2e-9:
                angle += 4.0
            if grazing or angle < low + 2e-9 or angle > high - 2e-9:
                self.meet_closely(ray, ax, ay, bx, by, area, c * ey - s * ex, grazing, owner)
            else:
                # The ray (c, s) t meets the line a + e u at t = (a x e) / ((c, s) x e).
                self.end(ray, area / (c * ey - s * ex), owner)

    def meet_closely(
        self,
        ray: cython.int,
        ax: cython.double,
        ay: cython.double,
        bx: cython.double,
        by: cython.double,
        area: cython.double,
        slope: cython.double,
        grazing: cython.bint,
        owner: cython.int,
    ) -> cython.void:
        """Let a ray meet an edge near one of its ends, or along it.

        For two edges that share an end, the result there follows from the same numbers, so that no
        ray can pass between them.
        """
        c: cython.double = self.way_x[ray]
        s: cython.double = self.way_y[ray]
        beside_a: cython.double = c * ay - s * ax
        beside_b: cython.double = c * by - s * bx
        along_a: cython.double = c * ax + s * ay
        along_b: cython.double = c * bx + s * by
        at_a: cython.bint = abs(beside_a) <= aimed(length(ax, ay))
        at_b: cython.bint = abs(beside_b) <= aimed(length(bx, by))
        between: cython.bint = min(beside_a, beside_b) <= 0.0 <= max(beside_a, beside_b)
        if not (at_a or at_b or between):
            return
        if not grazing:
            distance = area / slope
        elif at_a and at_b:  # in line: the nearer end ahead
            distance = max(along_a, along_b)
            if distance >= 0.0:
                distance = max(min(along_a, along_b), 0.0)
        elif between:
            distance = (along_a * beside_b - along_b * beside_a) / (beside_b - beside_a)
        else:
            distance = along_a if at_a else along_b
        if distance >= -1e-13:
            self.end(ray, max(distance, 0.0), owner)

    # -- rays ---------------------------------------------------------------------------------

    def diamond(self, x: cython.double, y: cython.double) -> cython.double:
        """Return the diamond angle of a vector from the fan's heading."""
        ahead: cython.double = self.c * x + self.s * y
        left: cython.double = self.c * y - self.s * x
        way: cython.double = abs(ahead) + abs(left)
        if way == 0.0:
            return 0.0
        way = left / way
        if ahead < 0.0:
            return 2.0 - way
        return way if way >= 0.0 else 4.0 + way

    def below(self, angle: cython.double) -> cython.int:
        """Return how many rays come before a diamond angle, in several turns from 0 on."""
        turns: cython.int = 0
        while angle >= 4.0:
            angle, turns = angle - 4.0, turns + self.count
        low: cython.int = 0
        high: cython.int = self.count
        while low < high:
            middle = (low + high) // 2
            if self.angle[middle] < angle:
                low = middle + 1
            else:
                high = middle
        return low + turns

    def end_of(self, first: cython.int, angle: cython.double) -> cython.int:
        """Return the ray after the last one up to a diamond angle, at most a turn on."""
        return min(self.below(angle), first + self.count)

    def end(self, ray: cython.int, distance: cython.double, owner: cython.int) -> cython.void:
        """Let a ray end after a distance, if it does not end before."""
        k: cython.int = self.at + ray
        if distance < self.lengths[k] or (distance == self.lengths[k] and owner < self.owners[k]):
            self.lengths[k], self.owners[k] = distance, owner

    def end_all(self, owner: cython.int) -> cython.void:
        """Let all rays of the fan end where they start."""
        for k in range(self.count):
            self.end(k, 0.0, owner)


def aimed(apart: cython.double) -> cython.double:
    """Return the distance within which a ray counts as aimed at a point `apart` away, metres."""
    return min(1e-13 * (1.0 + apart), 5e-10 * apart)
