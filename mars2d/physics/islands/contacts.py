"""Contacts: who touches whom, where and how hard, summed up over a control step.

What two bodies do to each other by one normal is one touch; in a corner there are two.
"""

from __future__ import annotations

from array import array
from math import sqrt
from typing import Any

from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import length
from mars2d.physics.islands.body import Body

ALIKE = 0.9659258262890683
"""The cosine up to which a contact's normal is still that of a touch in the substep before."""

SAME_TOUCH = 0.7071067811865476
"""The cosine up to which a normal that turns on and on is still that of one touch."""


@cython.cclass
class Row:
    """A contact of two shapes after a substep, as from the first body to the second.

    impulse: on the second, N s. x, y: on the surface of the first, m. vx, vy: the velocity of the
    second's point relative to the first's before the substep, m/s.
    """

    impulse_x: cython.double
    impulse_y: cython.double
    normal_x: cython.double
    normal_y: cython.double
    x: cython.double
    y: cython.double
    vx: cython.double
    vy: cython.double

    def add_speed(self, body: Body, sign: cython.double) -> cython.void:
        """Add the velocity of the point as one of a body, or subtract it."""
        self.vx += sign * (body.before_x - body.before_spin * (self.y - body.y))
        self.vy += sign * (body.before_y + body.before_spin * (self.x - body.x))

    def is_above(self, other: Row) -> cython.bint:
        """Return whether it is the stronger one; of equal ones one of them is."""
        mine: cython.double = length(self.impulse_x, self.impulse_y)
        theirs: cython.double = length(other.impulse_x, other.impulse_y)
        if mine != theirs:
            return mine > theirs
        return self.x < other.x or (self.x == other.x and self.y < other.y)


@cython.cclass
class Touch:
    """The contact of a body with another, or with an obstacle: its number `b` is negative then."""

    a: cython.int
    b: cython.int
    goes_on: cython.bint  # whether they touch after the last substep
    was_on: cython.bint  # whether they did when contacts were last taken
    now: Row | None  # the strongest of the present substep
    last: Row  # and of the last substep with one: by its normal others are known as this touch's
    # since contacts were last taken
    any: cython.bint
    time: cython.double
    held: cython.double
    first: Row
    impulse_x: cython.double
    impulse_y: cython.double
    push: cython.double  # the sum of normal impulses, whatever their directions
    base: Row | None  # the first that has pushed
    turn_x: cython.double  # by how much others' normals are off, times their pushes
    turn_y: cython.double
    steepest: cython.double  # the largest ratio of friction to push
    kept: Any  # itself as it was when the control step began

    def __init__(self, a: int, b: int, last: Row) -> None:
        """Take the numbers of both, and the contact by which it is found."""
        self.a, self.b, self.first, self.last = a, b, last, last

    def begin(self) -> cython.void:
        """Start again, after contacts were taken."""
        self.was_on, self.any, self.base = self.goes_on, False, None
        self.held = self.impulse_x = self.impulse_y = self.push = self.steepest = 0.0
        self.turn_x = self.turn_y = 0.0

    def keep(self) -> cython.void:
        """Keep it as it is, to begin with it again."""
        copy: Touch = Touch(self.a, self.b, self.last)
        copy.goes_on, copy.was_on, copy.any = self.goes_on, self.was_on, self.any
        copy.time, copy.held, copy.first = self.time, self.held, self.first
        copy.impulse_x, copy.impulse_y, copy.push = self.impulse_x, self.impulse_y, self.push
        copy.base, copy.turn_x, copy.turn_y = self.base, self.turn_x, self.turn_y
        copy.steepest = self.steepest
        self.kept = copy

    def likeness(self, row: Row) -> cython.double:
        """Return the cosine of the angle that the normal has turned to be a contact's."""
        x: cython.double = row.normal_x
        y: cython.double = row.normal_y
        if self.any and self.first.normal_x * x + self.first.normal_y * y < SAME_TOUCH:
            return 0.0
        return self.last.normal_x * x + self.last.normal_y * y

    def add(self, row: Row) -> cython.void:
        """Add a contact of the present substep."""
        if self.now is None or row.is_above(self.now):
            self.now = row
        self.impulse_x += row.impulse_x
        self.impulse_y += row.impulse_y
        push: cython.double = row.impulse_x * row.normal_x + row.impulse_y * row.normal_y
        friction: cython.double = row.impulse_y * row.normal_x - row.impulse_x * row.normal_y
        if push <= 0.0:
            return
        if self.base is None:
            self.base = row
        self.push += push
        self.turn_x += push * (row.normal_x - self.base.normal_x)
        self.turn_y += push * (row.normal_y - self.base.normal_y)
        self.steepest = max(self.steepest, abs(friction) / push)

    def close(self, time: cython.double, h: cython.double, passes_on: cython.bint) -> cython.void:
        """End a substep of h seconds at `time`.

        passes_on: whether the pair touches by another normal alone: this one lasted until then.
        """
        if self.now is None and not passes_on:
            self.end(time - h)
            return
        if self.now is not None:
            self.last = self.now
        if not self.any:
            self.any, self.first = True, self.last
            self.time = time - h if self.was_on else time
        if self.goes_on:
            self.held += h
        self.goes_on = self.now is not None

    def end(self, time: cython.double) -> cython.void:
        """End it; one that lasted until the control step's start, `time`, has a row of then."""
        if self.goes_on and not self.any:
            self.any, self.first, self.time = True, self.last, time
        self.goes_on = False

    def __lt__(self, other: Touch) -> bool:
        """Return whether it began earlier, or comes before it by bodies and normal."""
        if self.time != other.time:
            return self.time < other.time
        if self.a != other.a or self.b != other.b:
            return self.a < other.a or (self.a == other.a and self.b < other.b)
        mine: Row = self.first
        theirs: Row = other.first
        if mine.normal_x != theirs.normal_x:
            return mine.normal_x < theirs.normal_x
        return mine.normal_y < theirs.normal_y

    def write(self, numbers: cython.Doubles, k: cython.int) -> cython.void:
        """Write the fields of `mars2d.record.contact.CONTACT` from the k-th number on."""
        row: Row = self.first if self.base is None else self.base
        x: cython.double = row.normal_x
        y: cython.double = row.normal_y
        whole: cython.double = length(self.impulse_x, self.impulse_y)
        turns: cython.bint = self.turn_x != 0.0 or self.turn_y != 0.0
        turns = turns and self.push * self.push > 0.0 and whole * whole > 0.0  # not so weak
        if turns:
            x, y = self.push * x + self.turn_x, self.push * y + self.turn_y
            far: cython.double = length(x, y)
            x, y = x / far, y / far
        along: cython.double = min(self.impulse_x * x + self.impulse_y * y, whole)
        across: cython.double = self.impulse_y * x - self.impulse_x * y
        if turns and abs(across) > self.steepest * along:
            # The sum leaves the cone of the mean normal: turn that until it is on its edge.
            along = whole / sqrt(1.0 + self.steepest * self.steepest)
            across = self.steepest * along if across > 0.0 else -self.steepest * along
            x = (self.impulse_x * along + self.impulse_y * across) / (whole * whole)
            y = (self.impulse_y * along - self.impulse_x * across) / (whole * whole)
        row = self.first
        numbers[k] = self.time
        numbers[k + 1] = self.held
        numbers[k + 2] = self.a
        numbers[k + 3] = self.b
        numbers[k + 4] = row.x
        numbers[k + 5] = row.y
        numbers[k + 6] = x
        numbers[k + 7] = y
        numbers[k + 8] = whole
        numbers[k + 9] = along
        numbers[k + 10] = across
        numbers[k + 11] = 0.0
        if not self.was_on:
            numbers[k + 11] = -(row.vx * row.normal_x + row.vy * row.normal_y)
        numbers[k + 12] = row.vy * row.normal_x - row.vx * row.normal_y
        numbers[k + 13] = 0.0 if self.was_on else 1.0
        numbers[k + 14] = 0.0 if self.goes_on else 1.0


def note_row(a: Body, b: cython.int, row: Row) -> cython.void:
    """Add a contact of a body with another or an obstacle to the touch whose normal it has."""
    most: cython.double = ALIKE
    for touch in a.contacts:
        if touch.b == b:
            likeness = touch.likeness(row)
            if likeness > most:
                found, most = touch, likeness
    if most == ALIKE:
        found = Touch(a.number, b, row)
        a.contacts.append(found)
    found.add(row)


def close_touches(body: Body, time: cython.double, h: cython.double) -> cython.void:
    """End a substep of h seconds at `time`."""
    for touch in body.contacts:
        passes_on: cython.bint = False
        if touch.goes_on and touch.now is None:
            for other in body.contacts:
                passes_on = passes_on or (other.b == touch.b and other.now is not None)
        touch.close(time, h, passes_on)
    for touch in body.contacts:
        touch.now = None


def begin_touches_again(body: Body) -> cython.void:
    """Go back to the contacts that were kept, and drop those that are new."""
    touches = body.contacts
    body.contacts = []
    for touch in touches:
        if touch.kept is not None:
            body.contacts.append(touch.kept)
    for touch in body.contacts:
        touch.keep()


def touch_on(body: Body, lasting: list[Any]) -> cython.void:
    """Let a body touch what another one touches, of which the last contact with each is known."""
    body.contacts = []
    for b, last in lasting:
        touch = Touch(body.number, b, last)
        touch.goes_on = touch.was_on = True
        body.contacts.append(touch)


def take_touches(bodies: list[Body]) -> array[float]:
    """Return the contacts since the last call by time, a, b and normal, and forget the ended.

    Fifteen numbers each; see `Touch.write`.
    """
    taken: list[Touch] = []
    left: list[Touch]
    for body in bodies:
        if not body.contacts:
            continue
        left = []
        for touch in body.contacts:
            if touch.goes_on:
                left.append(touch)
            if touch.any:
                taken.append(touch)
            else:
                touch.begin()
        body.contacts = left
    taken.sort()
    numbers = array("d", bytes(120 * len(taken)))
    row: cython.Doubles = numbers
    k: cython.int = 0
    for touch in taken:
        touch.write(row, k)
        touch.begin()
        k += 15
    return numbers
