"""A body in motion: a robot or prop in a control step, its substeps and the solver."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import length
from mars2d.physics.islands.chipmunk import Held
from mars2d.physics.islands.drive import DrivenBody
from mars2d.physics.islands.library import Handle
from mars2d.physics.islands.piece import Piece
from mars2d.physics.islands.rigid import Progress, State

if TYPE_CHECKING:
    from mars2d.physics.islands.contacts import Touch
    from mars2d.physics.islands.island import Island
    from mars2d.physics.islands.pair import Pair
    from mars2d.physics.islands.solver import Solver


@cython.cclass
class Body(DrivenBody):
    """A robot or prop. SI units; "now" is within the present substep, unless it says otherwise."""

    solved: cython.bint  # whether the solver decides how it moves in this substep
    holds: cython.bint  # whether the drive is to act in the next substep
    engaged: cython.bint  # whether it does
    traction_ahead: cython.double  # N, what its wheels have borne in the last substep
    traction_across: cython.double
    # what the floor may do
    allowed: cython.double  # N and N m that it may use now
    twist_allowed: cython.double
    drift_x: cython.double  # m/s, the velocity towards which it draws the body
    drift_y: cython.double
    applied_x: cython.double  # N and N m of all else but a pull in the last substep, if it lasts
    applied_y: cython.double
    applied_turn: cython.double
    known: cython.bint  # whether it did, and no contact pushed, whose impulses come in turns
    # a pull from outside
    pulled: cython.bint
    pull_x: cython.double
    pull_y: cython.double
    pull_torque: cython.double
    pull_turn: cython.double  # N m, its torque about the centre of mass
    # what the next substep is worked out from
    touches: cython.bint
    stopped: cython.bint
    let_go: cython.bint  # whether its drive is thought to bring it back to its command within it
    back: State  # where and how it was before the substep
    moved_x: cython.double  # where the engine has moved it
    moved_y: cython.double
    moved_angle: cython.double
    ahead: cython.bint  # whether it is elsewhere, by forces that acted meanwhile
    gone: cython.double  # m, its way in this control step
    # within a control step
    near: cython.bint  # whether it may touch something
    speed: cython.double  # how fast it may be
    way: cython.double  # how far it may go, at most
    load: cython.double  # how many robots' pushes add up on it
    slack: cython.double  # how much further than at its speed it may be thrown, a factor
    home: Body  # the body that stands for its island
    fastest: cython.double  # of the island that it stands for
    done: cython.bint  # whether its island has been stepped
    island: Island
    start_x: cython.double  # where the circle's centre was at the beginning
    start_y: cython.double
    kept: cython.bint  # whether what it was like at the beginning was kept
    initial: Progress  # that
    # velocities of the centre of mass before and after the solver's step, m/s and rad/s
    before_x: cython.double
    before_y: cython.double
    before_spin: cython.double
    after_x: cython.double
    after_y: cython.double
    # impulses of its drive, or of the floor under it, on the centre of mass
    reaction_x: cython.double
    reaction_y: cython.double
    reaction_turn: cython.double
    # impulses of contacts in a substep, and for the group of bodies that touch: how they work
    tied: cython.bint  # whether a joint may have acted on it
    group: Body  # another body on the way to that which stands for the group
    pressure: cython.double  # N s, the sum of their sizes
    hit_x: cython.double
    hit_y: cython.double
    hit_turn: cython.double
    hit_power: cython.double  # W s, of those between bodies that have come to touch
    hit_depth: cython.double  # J, the same times how deep these are
    held_by: cython.double  # N s, the impulses of drives, floors, joints and pulls
    lasting: cython.bint  # whether no more than these has acted
    eased: cython.bint  # whether a blow has put it back out of what it hit
    shift: cython.double  # s, since when the impulses have acted, in the mean
    push_work: cython.double
    friction_work: cython.double
    excess: cython.double
    push_power: cython.double
    friction_power: cython.double
    share: cython.double
    crowd: cython.int  # how many bodies are in the group
    driven: cython.bint  # whether a robot in it is told to move
    # and of all that holds it or touches it
    springy: cython.bint  # whether a spring is among the group's joints
    held_x: cython.double
    held_y: cython.double
    held_turn: cython.double
    hold_work: cython.double
    hold_energy: cython.double
    # since lists of what is near were made
    moved: cython.double
    wall_pairs: list[Pair]
    wall_gap: cython.double  # a lower bound of that to the nearest wall
    wall_skin: cython.double  # how far it may move until the list of walls has to be made again
    cell: cython.int
    next: cython.int
    contacts: list[Touch]  # with bodies of larger number, and obstacles
    first_touch: Pair | None  # of the pairs that touch now: one of which it is the first body
    # in the solver
    solver: Solver | None
    placed: cython.bint  # whether it is elsewhere than the solver thinks
    made: cython.bint
    handle: Handle
    control: Handle
    pivot: Handle  # of a robot with wheels, its motors
    side: Handle  # what holds its wheels across
    gear: Handle
    shapes: list[Held]

    def __init__(self, number: int, is_robot: bool, pieces: list[Piece], surface: Any) -> None:
        """Take its number, its pieces, its friction and restitution; `describe` does the rest."""
        self.number, self.is_robot, self.pieces, self.surface = number, is_robot, pieces, surface
        self.no_load_speed = self.grip_ahead = self.grip_across = 1e300
        self.since, self.slack, self.load, self.share, self.crowd = 1 << 20, 1.0, 1.0, 1.0, 1
        self.wall_gap = self.wall_skin = -1.0
        self.back, self.initial = State(), Progress()
        self.wall_pairs, self.contacts, self.shapes = [], [], []

    def move(self, state: list[float]) -> None:
        """Take x, y, theta, x', y', theta'."""
        self.x, self.y, self.angle, self.vx, self.vy, self.spin = state
        self.energy = 0.0
        self.account_now()
        self.by_holder = 0.0

    def memory(self) -> tuple[Any, ...]:
        """Return all that it goes on from in a control step, if no solver knows it."""
        return (
            self.x, self.y, self.angle, self.vx, self.vy, self.spin,
            self.slips, self.since, self.effort, self.energy, self.by_holder, self.by_push,
            self.by_friction, self.by_joint, self.by_hand,
            self.forward, self.left, self.turning, self.load, self.slack,
        )  # fmt: skip

    def remember(self, memory: tuple[Any, ...]) -> None:
        """Go on from the memory of a body like this; another energy is the work of hands."""
        (
            self.x, self.y, self.angle, self.vx, self.vy, self.spin,
            self.slips, self.since, self.effort, self.energy, self.by_holder, self.by_push,
            self.by_friction, self.by_joint, self.by_hand,
            self.forward, self.left, self.turning, self.load, self.slack,
        ) = memory  # fmt: skip
        by_holder: cython.double = self.by_holder
        self.account_now()
        self.by_hand += self.by_holder - by_holder
        self.by_holder = by_holder

    def look(self) -> cython.void:
        """Work out how fast its velocity may change."""
        self.accelerates = False
        if self.solved:
            self.acceleration = (
                self.spin * self.spin * abs(self.com)
            )  # its pose goes round its centre
        elif not self.is_robot:
            self.acceleration = 0.0
            if self.vx != 0.0 or self.vy != 0.0:
                self.acceleration = self.slows
            if self.spin != 0.0:
                self.acceleration += self.stops * self.reach
        elif self.limited or self.slips:
            self.look_ahead()
        else:
            self.obey()
            self.acceleration = self.pull_on_arc(self.turning) / self.mass

    def top_speed(self) -> cython.double:
        """Return how fast its circle moves at most now."""
        arm: cython.double = self.offset
        if self.slips:
            arm += 2 * abs(self.com)
        return length(self.vx, self.vy) + arm * abs(self.spin)

    def advance(self, h: cython.double) -> cython.void:
        """Move for h s as aimed, in closed form."""
        self.x += h * self.aim_x
        self.y += h * self.aim_y
        self.angle += h * self.aim_spin
        if self.aim_x != 0.0 or self.aim_y != 0.0 or self.aim_spin != 0.0:
            self.placed = True
        self.vx, self.vy, self.spin = self.end_x, self.end_y, self.end_spin

    def displace(self, x: cython.double, y: cython.double, turn: cython.double) -> cython.void:
        """Move its centre of mass by x and y, metres, and turn it about that, rad."""
        if self.com != 0.0:
            self.place_com(self.angle)
            self.x, self.y = self.x + self.com_x, self.y + self.com_y
        self.x += x
        self.y += y
        self.angle += turn
        if self.com != 0.0:
            self.place_com(self.angle)
            self.x, self.y = self.x - self.com_x, self.y - self.com_y

    def correct(self, h: cython.double) -> cython.void:
        """Go as far as the engine moved it in h s to correct overlaps, beyond its own way."""
        x: cython.double = self.moved_x - (self.back.x + h * self.back.vx)
        y: cython.double = self.moved_y - (self.back.y + h * self.back.vy)
        turn: cython.double = self.moved_angle - (self.back.angle + h * self.back.spin)
        if length(x, y) + self.reach * abs(turn) > 1e-12:  # no rounding error
            self.x, self.y, self.angle = self.x + x, self.y + y, self.angle + turn

    def fall_back(self) -> cython.void:
        """Go back to where the engine moved it."""
        if self.ahead:
            self.x, self.y, self.angle = self.moved_x, self.moved_y, self.moved_angle
            self.ahead, self.placed = False, True
