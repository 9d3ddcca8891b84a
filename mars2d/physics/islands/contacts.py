"""Contacts: who touches whom, where and how hard, summed up over a control step."""

from __future__ import annotations

from typing import Any

from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import length
from mars2d.physics.islands.body import Body

__all__ = [
    "Row", "Touch", "begin_touches_again", "keep_touches", "part", "take_touches", "touch_between",
]  # fmt: skip


@cython.final
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

    def __init__(self) -> None:
        """Make one in which nothing has happened."""
        self.impulse_x = self.impulse_y = self.normal_x = self.normal_y = 0.0
        self.x = self.y = self.vx = self.vy = 0.0

    @cython.cfunc
    def add_speed(self, body: Body, sign: cython.double) -> cython.void:
        """Add the velocity of the point as one of a body, or subtract it."""
        self.vx += sign * (body.before_x - body.before_spin * (self.y - body.y))
        self.vy += sign * (body.before_y + body.before_spin * (self.x - body.x))

    @cython.cfunc
    def push_apart(self) -> cython.void:
        """Let the impulse act on the second: the solver's sign depends on the order of shapes."""
        if self.impulse_x * self.normal_x + self.impulse_y * self.normal_y < 0:
            self.impulse_x, self.impulse_y = -self.impulse_x, -self.impulse_y

    def order(self) -> tuple[float, ...]:
        """Return the sort key of a pair's rows: the strongest comes first."""
        strength = length(self.impulse_x, self.impulse_y)
        return -strength, self.x, self.y, self.normal_x, self.normal_y


@cython.final
@cython.cclass
class Touch:
    """The contact of a body with another, or with an obstacle: its number `b` is negative then."""

    a: cython.int
    b: cython.int
    goes_on: cython.bint  # whether they touch after the last substep
    was_on: cython.bint  # whether they did when contacts were last taken
    # of the present substep: the solver lists them by their places in memory
    count: cython.int
    row: Row
    rows: list[Row]  # where there are several
    # since contacts were last taken
    any: cython.bint
    time: cython.double
    h: cython.double
    first: Row
    held: cython.double
    impulse_x: cython.double
    impulse_y: cython.double
    along: cython.double
    across: cython.double
    # as it was when the control step began, if it was there
    kept: cython.bint
    kept_goes_on: cython.bint
    kept_any: cython.bint
    kept_held: cython.double
    kept_impulse_x: cython.double
    kept_impulse_y: cython.double
    kept_along: cython.double
    kept_across: cython.double

    def __init__(self, a: int, b: int) -> None:
        """Take the numbers of both."""
        self.a, self.b, self.goes_on, self.was_on = a, b, False, False
        self.count, self.row, self.rows, self.first = 0, Row(), [], Row()
        self.any = False
        self.time = self.h = self.held = 0.0
        self.impulse_x = self.impulse_y = self.along = self.across = 0.0
        self.kept = self.kept_goes_on = self.kept_any = False
        self.kept_held = self.kept_impulse_x = self.kept_impulse_y = 0.0
        self.kept_along = self.kept_across = 0.0

    @cython.cfunc
    def keep(self) -> cython.void:
        """Keep it as it is, to begin with it again."""
        self.kept, self.kept_goes_on, self.kept_any = True, self.goes_on, self.any
        self.kept_held, self.kept_along, self.kept_across = self.held, self.along, self.across
        self.kept_impulse_x, self.kept_impulse_y = self.impulse_x, self.impulse_y

    @cython.cfunc
    def begin_again(self) -> cython.void:
        """Go back to the kept rows; the first row stays, if there was one."""
        self.goes_on, self.any, self.count = self.kept_goes_on, self.kept_any, 0
        self.held, self.along, self.across = self.kept_held, self.kept_along, self.kept_across
        self.impulse_x, self.impulse_y = self.kept_impulse_x, self.kept_impulse_y

    @cython.cfunc
    def close(self, time: cython.double, h: cython.double) -> cython.void:
        """Add the rows of a substep of h seconds, which ends at `time`."""
        row: Row
        if self.count == 0:
            self.goes_on = False
            return
        if self.goes_on:
            self.held += h
        if self.count == 1:
            self.add(self.row, time, h)
        else:
            self.rows.sort(key=Row.order)
            for row in self.rows:
                self.add(row, time, h)
            self.row, self.rows = Row(), []
        self.count, self.goes_on = 0, True

    @cython.cfunc
    def fresh(self) -> Row:
        """Return a row for the present substep."""
        self.count += 1
        if self.count == 1:
            return self.row
        if self.count == 2:
            self.rows.append(self.row)
        self.rows.append(Row())
        return self.rows[self.count - 1]

    @cython.cfunc
    def add(self, row: Row, time: cython.double, h: cython.double) -> cython.void:
        """Add a row; the first one is kept, the strongest of its substep."""
        if not self.any:
            self.any, self.time, self.h = True, time, h
            self.row, self.first = self.first, row
        self.impulse_x += row.impulse_x
        self.impulse_y += row.impulse_y
        self.along += row.impulse_x * row.normal_x + row.impulse_y * row.normal_y
        self.across += row.impulse_y * row.normal_x - row.impulse_x * row.normal_y

    def order(self) -> tuple[float, int, int]:
        """Return the sort key of contacts: when they began in this step, and between whom."""
        return self.time if not self.was_on else self.time - self.h, self.a, self.b

    @cython.cfunc
    def write(self, numbers: cython.Doubles, k: cython.int) -> cython.void:
        """Write the fields of `mars2d.record.contact.CONTACT` from the k-th number on."""
        row: Row = self.first
        numbers[k] = self.time if not self.was_on else self.time - self.h
        numbers[k + 1] = self.held
        numbers[k + 2] = self.a
        numbers[k + 3] = self.b
        numbers[k + 4] = row.x
        numbers[k + 5] = row.y
        numbers[k + 6] = row.normal_x
        numbers[k + 7] = row.normal_y
        numbers[k + 8] = length(self.impulse_x, self.impulse_y)
        numbers[k + 9] = self.along
        numbers[k + 10] = self.across
        numbers[k + 11] = 0.0
        if not self.was_on:
            numbers[k + 11] = -(row.vx * row.normal_x + row.vy * row.normal_y)
        numbers[k + 12] = row.vy * row.normal_x - row.vx * row.normal_y
        numbers[k + 13] = 0.0 if self.was_on else 1.0
        numbers[k + 14] = 0.0 if self.goes_on else 1.0

    @cython.cfunc
    def begin(self) -> cython.void:
        """Start again, after contacts were taken."""
        self.was_on, self.any, self.held = self.goes_on, False, 0.0
        self.impulse_x = self.impulse_y = self.along = self.across = 0.0


@cython.cfunc
def touch_between(a: Body, b: cython.int) -> Touch:
    """Return the contact of a body with another or an obstacle, made if there is none yet."""
    touch: Touch
    for touch in a.contacts:
        if touch.b == b:
            return touch
    touch = Touch(a.number, b)
    a.contacts.append(touch)
    return touch


@cython.cfunc
def part(body: Body) -> cython.void:
    """Note that a body touches nothing of larger number, and no obstacle, any more."""
    touch: Touch
    for touch in body.contacts:
        touch.goes_on = False


@cython.cfunc
def keep_touches(body: Body) -> cython.void:
    """Keep a body's contacts as they are."""
    touch: Touch
    for touch in body.contacts:
        touch.keep()


@cython.cfunc
def begin_touches_again(body: Body) -> cython.void:
    """Go back to the contacts that were kept, and drop those that are new."""
    touch: Touch
    left: list[Any] = []
    for touch in body.contacts:
        if touch.kept:
            touch.begin_again()
            left.append(touch)
    body.contacts = left


@cython.cfunc
def take_touches(bodies: list[Body]) -> list[Any]:
    """Return the contacts since the last call, sorted; those that have ended are forgotten."""
    taken: list[Any] = []
    left: list[Any]
    body: Body
    touch: Touch
    for body in bodies:
        if not body.contacts:
            continue
        left = []
        for touch in body.contacts:
            if touch.any:
                taken.append(touch)
            else:
                touch.begin()
            if touch.goes_on:
                left.append(touch)
        body.contacts = left
    if len(taken) > 1:
        taken.sort(key=Touch.order)
    return taken
