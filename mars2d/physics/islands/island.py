"""Islands: bodies that may touch each other or are tied, stepped as finely as they need.

A robot that follows its command gets the velocity of its chord in each substep, a prop glides: both
need no solver. When a contact or a joint has thrown a robot off its command, it slips: the solver
decides its velocity, and its drive is engaged. That is a control body which pulls the robot with
bounded force and torque until it follows again, and for a few short substeps more.
"""

from __future__ import annotations

from math import ceil, sqrt
from typing import TYPE_CHECKING

from mars2d.physics.islands import chipmunk, settings
from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import length
from mars2d.physics.islands.body import Body
from mars2d.physics.islands.contacts import Row, close_touches, note_row
from mars2d.physics.islands.floor import Glide
from mars2d.physics.islands.impact import Impact, settle
from mars2d.physics.islands.library import Arbiter, Vector, check_signals
from mars2d.physics.islands.pair import Pair
from mars2d.physics.islands.solver import Solver
from mars2d.physics.islands.thrust import Thrust, predict
from mars2d.physics.islands.tie import Tie

if TYPE_CHECKING:
    from mars2d.physics.islands.mover import Mover

FEW_MEET = 4
"""Of how many bodies at most a substep ends where one meets another; a crowd would take longer."""

STUCK = 16
"""After how many substeps in a row with bodies too deep in each other they are corrected faster."""


@cython.cclass
class Accuracy:
    """How finely islands are stepped, as `settings` say: metres, and seconds.

    entry: how deep bodies may get in one substep. push_depth: of one iteration. spring_step: the
    longest substep that resolves how springs swing.
    """

    max_overlap: cython.double
    entry: cython.double
    slop: cython.double
    preload: cython.double
    closed: cython.double
    touch: cython.double
    impact_depth: cython.double
    grazing_depth: cython.double
    seam_depth: cython.double
    stretch: cython.double
    joint_tolerance: cython.double
    braking_turn: cython.double
    push_depth: cython.double
    push_room: cython.double
    overload: cython.double
    spring_step: cython.double

    def __init__(self, max_overlap: float, thinnest: float, spring_step: float) -> None:
        """Take the overlap that is allowed, how thin the thinnest body is, and `spring_step`."""
        self.max_overlap, self.spring_step = max_overlap, spring_step
        # A quarter of the overlap allowed is left to the slop and to what the solver leaves over.
        self.entry = min(0.75 * max_overlap, 0.125 * thinnest)
        self.slop = min(settings.SLOP, max_overlap / 4, thinnest / 32)
        self.preload, self.touch = settings.PRELOAD * self.slop, settings.MEETING * self.slop
        self.impact_depth, self.closed = (
            settings.IMPACT_DEPTH * self.slop,
            min(settings.CLOSED, self.touch),
        )
        self.grazing_depth = min(settings.SLOP, thinnest / 32)
        self.seam_depth = min(settings.SEAM_DEPTH * max_overlap, thinnest / 2)
        self.stretch = settings.STRETCH * self.entry
        self.joint_tolerance = settings.JOINT_TOLERANCE * settings.STRETCH * self.entry
        wide: cython.double = max(1.0, max_overlap / settings.DEFAULT_OVERLAP)
        self.braking_turn = settings.BRAKING_TURN * max_overlap * wide
        self.push_depth, self.push_room = (
            settings.PUSH_DEPTH * max_overlap,
            settings.PUSH_ROOM * max_overlap,
        )
        self.overload = settings.OVERLOAD * self.entry


@cython.cclass
class Island:
    """Some bodies, and all that they may touch in this control step."""

    accuracy: Accuracy
    glide: Glide
    thrust: Thrust
    numbers: list[Body]  # all bodies by their numbers
    bodies: list[Body]
    pairs: list[Pair]
    ties: list[Tie]
    solver: Solver
    solved: cython.bint
    solvers: list[Solver]
    spare: list[Solver]
    surfaces: object  # None: friction and restitution are products
    contact_step: cython.double
    push_step: cython.double  # how long that is for the push of one robot
    load: cython.double  # how many robots' pushes add up
    least_load: cython.double
    most_load: cython.double
    iterations: cython.int
    tries: cython.int  # substeps in a row in which the solver had more iterations than these
    deepest: cython.double  # m, the overlap
    limit: cython.double  # m, how far a body may go
    any_solved: cython.bint
    any_touch: cython.bint
    impact: Impact

    def __init__(self, mover: Mover) -> None:
        """Share the bodies, the solvers and all else with the mover."""
        self.accuracy, self.glide, self.thrust = mover.accuracy, mover.glide, mover.thrust
        self.solvers, self.spare, self.surfaces = mover.solvers, mover.spare, mover.surfaces
        self.numbers, self.impact = mover.bodies, Impact(mover.bodies[0])
        self.bodies, self.pairs, self.ties = [], [], []
        self.contact_step = 1e300

    def clear(self) -> cython.void:
        """Make it one without bodies."""
        self.bodies.clear()
        self.pairs.clear()
        self.ties.clear()
        self.solved = self.any_solved = self.any_touch = False

    # -- before the first substep -------------------------------------------------------------

    def set_accuracy(self) -> cython.void:
        """Work out the solver's iterations, and how pushes drive bodies into each other."""
        accuracy: Accuracy = self.accuracy
        robots: cython.int = 0
        strongest: cython.double = 0.0
        push: cython.double = 0.0
        lightest: cython.double = 1e300
        heaviest: cython.double = 0.0
        self.load = 1.0
        for body in self.bodies:
            lightest = min(lightest, body.mass)
            heaviest = max(heaviest, body.mass)
            self.load = max(self.load, body.load)
            if body.is_robot:
                robots += 1
                strongest = max(strongest, body.strength)
                push = max(push, body.strength / body.mass)
        push = max(push, strongest / lightest)
        self.iterations = settings.ITERATIONS
        if heaviest > 3 * lightest:
            self.iterations = settings.ITERATIONS_UNEQUAL
        if self.ties:
            self.iterations = settings.ITERATIONS_JOINTS
        self.push_step = 1e300
        if push > 0.0:
            self.push_step = sqrt(accuracy.push_depth * self.iterations / push)
        # In a file, pushes from both ends meet in the middle; in a heap they spread.
        self.most_load = max(1.0, robots / 2.0)
        self.least_load = sqrt(self.most_load)
        self.load = min(max(self.load, self.least_load), self.most_load)

    def set_contact_step(self) -> cython.void:
        """Work out the longest substep in contact: the pushes that add up use no more than room.

        The depth under a force F settles at about F h^2 / (m iterations).
        """
        accuracy: Accuracy = self.accuracy
        room: cython.double = max(accuracy.push_room - self.deepest, accuracy.push_depth / 4)
        share: cython.double = 1.0
        while share * share * self.load * accuracy.push_depth > room:
            share *= 0.9  # in steps, so that substeps keep their length for a while
        self.contact_step = share * self.push_step
        if self.ties:
            self.contact_step = min(self.contact_step, accuracy.spring_step)

    def adapt_iterations(self) -> cython.void:
        """Learn from overlaps how many pushes add up, and how hard the solver has to try."""
        accuracy: Accuracy = self.accuracy
        self.solver.hurries = False
        if self.deepest > accuracy.overload:
            # What turns fast gets deeper again and again before the engine has corrected it.
            self.solver.hurries = self.tries >= STUCK
            self.load = min(settings.LOAD_GROWTH * self.load, self.most_load)
            # If the solver goes round in a circle it ends elsewhere in it each time.
            self.tries = min(self.tries + 1, 64)
        else:
            self.load = max(settings.LOAD_DECAY * self.load, self.least_load)
            self.tries = 0
        self.set_iterations()

    def set_iterations(self) -> cython.void:
        """Let the solver have more iterations while it has to try harder."""
        count: cython.int = self.iterations
        if self.tries > 0:
            count = count * settings.ITERATION_FACTOR + 2 * self.tries
        chipmunk.set_iterations(self.solver.space, count)

    def commit(self) -> cython.void:
        """Take a solver for these bodies alone: that in which most of them are."""
        self.solved = True
        self.solver = self.find_solver()
        solver: Solver = self.solver
        for body in solver.bodies[::-1]:
            if body.island is not self:
                solver.leave(body)
        for body in self.bodies:
            if body.solver is not solver:
                if body.solver is not None:
                    body.solver.leave(body)
                solver.enter(body)
        for pair in self.pairs:
            if pair.is_wall and pair.walled_in is not solver.walls:
                solver.wall_off(pair.wall)
                pair.walled_in = solver.walls
        for tie in self.ties:
            solver.tie(tie)
        solver.hurries = False
        # One that knows no impulses of bodies that touch already has to try harder.
        self.tries = 1 if self.any_solved and solver.last_step >= 1e300 else 0
        self.set_iterations()
        solver.used = True

    def find_solver(self) -> Solver:
        """Return the solver in which most of these bodies are, or one that nobody uses."""
        most: cython.int = 0
        for body in self.bodies:
            if body.solver is None:
                continue
            count: cython.int = 0
            for other in self.bodies:
                if other.solver is body.solver:
                    count += 1
            if count > most:
                most, solver = count, body.solver
            if 2 * most >= len(self.bodies):
                break
        if most > 0:
            return solver
        if self.spare:
            solver = self.spare.pop()
            solver.idle = False
        else:
            solver = Solver(self.accuracy.slop, self.accuracy.seam_depth, self.surfaces)
            self.solvers.append(solver)
        return solver

    # -- substeps -----------------------------------------------------------------------------

    def run(self, duration: cython.double, time: cython.double) -> cython.bint:
        """Step through `duration` s; return whether nobody went further than was thought possible.

        time: at the beginning, s.
        """
        elapsed: cython.double = 0.0
        count: cython.int = 0
        self.set_accuracy()
        self.measure()
        for body in self.bodies:
            body.gone = 0.0
            if body.solver is not None and (self.any_touch or self.ties or body.pulled):
                self.any_solved = True
        if self.any_solved:
            self.commit()
        while elapsed < duration:
            if self.any_touch:
                self.preload()
            left = duration - elapsed
            h = self.look_ahead(left)
            if not elapsed + h > elapsed:
                raise FloatingPointError
            count += 1
            if count % 256 == 0:
                check_signals()
            for body in self.bodies:
                body.gone += h * body.top_speed()
                if body.gone > self.limit:
                    return False
            self.aim(h)
            if self.any_solved or not self.glide_on(h):
                if not self.solved:
                    self.commit()
                self.find_flush()
                self.solver.go(h)
                settle(self.solver, self.numbers, self.impact, h)
                for body in self.bodies:
                    self.take(body, h)
                self.measure()
                self.hold_back()
                self.adapt_iterations()
                for k in range(self.solver.arbiters.count()):
                    self.note_one(self.solver.arbiters.at(k))
            elapsed = duration if h == left else elapsed + h
            self.close(time + elapsed, h)
        for body in self.bodies:
            body.load = self.load
        return True

    def measure(self) -> cython.void:
        """Measure all gaps, and find who touches something."""
        self.any_touch = False
        self.deepest = 0.0
        for body in self.bodies:
            body.locate()
            body.touches, body.first_touch = False, None
        for pair in self.pairs:
            if pair.measure() or pair.gap <= self.accuracy.closed:
                self.deepest = max(self.deepest, -pair.gap)
                self.any_touch = pair.a.touches = pair.b.touches = True
                pair.next_touch, pair.a.first_touch = pair.a.first_touch, pair

    def find_flush(self) -> cython.void:
        """Find the bodies that lie flush, for the solver."""
        room: cython.double = self.accuracy.seam_depth / 8
        for body in self.bodies:
            if body.laid:
                body.lift()
        if len(self.bodies) < 3:
            return
        for pair in self.pairs:
            if pair.gap < room and not pair.is_wall:
                pair.lay(room)

    def hold_back(self) -> cython.void:
        """Leave bodies where the engine moved them that else would be too deep in each other.

        It moved them by the velocities that they had, for which gaps are known to be wide enough.
        """
        any_back: cython.bint = self.deepest > self.accuracy.entry
        while any_back:
            any_back = False
            for pair in self.pairs:
                if pair.gap < -self.accuracy.entry and (pair.a.ahead or pair.b.ahead):
                    pair.a.fall_back()
                    pair.b.fall_back()
                    any_back = True
            if any_back:
                self.measure()

    def preload(self) -> cython.void:
        """Press bodies together that touch by a rounding error only, and would part by another."""
        preload: cython.double = self.accuracy.preload
        any_moved: cython.bint = False
        for body in self.bodies:
            body.back.go_to(body)
        for pair in self.pairs:
            if pair.gap > self.accuracy.closed or pair.gap <= -preload / 8 or pair.parts():
                continue
            draw_together(pair, preload)
            any_moved = True
        count: cython.int = 0
        while any_moved and count < 32:
            any_moved = self.preload_again()
            count += 1

    def preload_again(self) -> cython.bint:
        """Press those together that others were drawn away from; return whether there were any."""
        preload: cython.double = self.accuracy.preload
        any_moved: cython.bint = False
        for body in self.bodies:
            pair = body.first_touch
            while pair is not None:
                gap: cython.double = pair.gap + opened(pair)
                if gap > -preload / 8:
                    draw_together(pair, preload + gap)
                    any_moved = True
                pair = pair.next_touch
        return any_moved

    def look_ahead(self, left: cython.double) -> cython.double:
        """Find who slips and how all move, and return how long the next substep is.

        left: s, until the end.
        """
        for tie in self.ties:
            tie.measure()
            if tie.holds():
                tie.a.touches = tie.b.touches = True
        h: cython.double = self.shorten(self.contact_limit(left), left)
        any_back: cython.bint = False
        for body in self.bodies:
            if not body.let_go:
                continue
            body.go_to(body.back)
            if body.out_of_reach(h):
                body.solved = body.slips = self.any_solved = any_back = True
            else:
                body.obey()
        return self.shorten(h, left) if any_back else h

    def shorten(self, h: cython.double, left: cython.double) -> cython.double:
        """Return how long of h s the next substep may be, by how gaps close and joints stretch."""
        accuracy = self.accuracy
        for body in self.bodies:
            body.look()
            h = min(h, body.time_to_turn(accuracy.entry / 8))
        few: cython.bint = self.any_solved and len(self.bodies) <= FEW_MEET
        few = few and accuracy.max_overlap <= settings.DEFAULT_OVERLAP  # else speed is wanted
        for pair in self.pairs:
            met: cython.bint = few and pair.gap > accuracy.slop
            if met and (pair.a.solved or (not pair.is_wall and pair.b.solved)):
                # What drives do after a blow they do not do before it: a substep ends there.
                first: cython.double = pair.time_to_touch(h, accuracy.touch)
                h = 0.99 * first if first < h else h
            h = pair.time_to_touch(h, self.depth_of(pair))
            if pair.gap <= accuracy.slop:
                h = min(h, max(self.turn_of(pair, few) / max(pair.turns(), 1e-300), 1e-3))
        for tie in self.ties:
            h = min(h, tie.time_to_jerk(accuracy.stretch, accuracy.joint_tolerance))
        return left / ceil(left / h - 1e-9)  # equal substeps settle best, and leave no sliver

    def turn_of(self, pair: Pair, few: cython.bint) -> cython.double:
        """Return by how much the normal of a pair in contact may turn, rad.

        Two robots, whose speeds drives keep, must only stay in touch, in a crowd not even that: the
        gap of discs opens by half of their distance times the square of that.
        """
        if not (pair.a.is_robot and pair.b.is_robot):
            return settings.CONTACT_TURN
        if few and pair.a.is_disc and pair.b.is_disc:
            return sqrt(2 * self.accuracy.preload / pair.radii)
        return 1e300

    def depth_of(self, pair: Pair) -> cython.double:
        """Return how deep a pair may be when a blow turns it.

        What gathers speed has at the touch what it has gathered by then, and no more. And where no
        drive pushes, a blow along a normal that has turned inside would change angular momentum.
        Bodies that just touch as the substep begins turn where they are.
        """
        if pair.a.accelerates or (not pair.is_wall and pair.b.accelerates):
            return self.accuracy.touch
        if pair.a.is_told() or (not pair.is_wall and pair.b.is_told()):
            return self.accuracy.entry
        if pair.gap > self.accuracy.closed:
            return self.accuracy.impact_depth
        if pair.gap > -self.accuracy.closed:
            return self.accuracy.touch
        return self.accuracy.entry

    def contact_limit(self, left: cython.double) -> cython.double:
        """Mark the bodies that slip: those touched or pulled, or too fast for their drive.

        Returns how long a substep may be for them, at most `left`.
        """
        accuracy: Accuracy = self.accuracy
        h: cython.double = left
        self.any_solved = False
        for body in self.bodies:
            body.touches = body.touches or body.pulled
            body.slips = body.slips or body.touches
            body.let_go = False
            # Where others touch, a robot that has just lost touch stays with them for a while, and
            # so does one at a rope that has just gone slack.
            lately: cython.bint = self.any_touch and body.since <= settings.LINGER
            lately = lately or len(self.ties) > 0
            body.solved = body.touches or (
                body.is_robot and body.slips and (body.com != 0.0 or lately)
            )
            self.any_solved = self.any_solved or body.solved
        if not self.any_solved:
            return h
        self.set_contact_step()
        h = min(h, self.contact_step)
        if self.solved:
            h = min(h, settings.GROWTH * self.solver.last_step)
        if self.any_touch and (not self.solved or self.solver.last_step >= 1e300):
            # A solver that knows no impulses yet does not settle a file that begins to push.
            h = min(h, self.contact_step / (self.most_load * self.most_load))
        for body in self.bodies:
            if body.solved and body.limited and not body.touches:
                h = min(h, settings.OFFSET_STEP)
            if body.is_robot and body.solved and body.since > settings.LINGER:
                h = min(h, body.time_to_brake(accuracy.braking_turn))
            if body.touches and body.slows > 0.0 and self.push_step >= 1e300:
                # Where no drive pushes it on the floor stops it: there the substep ends.
                stop: cython.double = length(body.vx, body.vy) / body.slows
                if 0.0 < stop < h:
                    h = max(stop, min(h, settings.OFFSET_STEP))
        self.any_solved = False
        for body in self.bodies:
            if body.solved and not body.touches:
                body.back.go_to(body)
                body.solved = body.slips = body.out_of_reach(h)
                body.let_go = not body.solved
            self.any_solved = self.any_solved or body.solved
        return h

    def aim(self, h: cython.double) -> cython.void:
        """Set the velocities of all bodies for a substep of h seconds.

        A drive stays engaged for a while after its robot follows again if substeps are as short as
        in contact, since a robot that pushes loses touch now and then. But a robot that comes from
        afar hits with its momentum alone, without its drive's force.
        """
        brief: cython.bint = h <= self.contact_step
        for body in self.bodies:
            body.back.go_to(body)
            if body.solved:
                body.since, body.holds = 0, True
                continue
            body.since = min(body.since + 1, 1 << 20)
            body.holds = body.follows() and brief and body.since <= settings.LINGER
            predict(body, h, self.glide, self.thrust)

    def glide_on(self, h: cython.double) -> cython.bint:
        """Move all bodies as they are aimed; return whether they touch nothing then.

        If they do they are back where they were, for the solver.
        """
        for body in self.bodies:
            body.advance(h)
        self.measure()
        if self.any_touch:
            for body in self.bodies:
                body.go_to(body.back)
            return False
        for body in self.bodies:
            self.arrive(body)
        if self.solved:
            self.solver.stale = True
        return True

    def arrive(self, body: Body) -> cython.void:
        """Note that a body has moved in closed form."""
        body.slips = body.slips and body.is_robot and not body.limited and body.accelerates
        body.applied_x = body.applied_y = body.applied_turn = 0.0
        body.known = False
        body.account_now()

    def take(self, body: Body, h: cython.double) -> cython.void:
        """Take over how a body has moved in the solver's step of h s.

        What was not pushed by anything has moved in closed form, whatever it touches.
        """
        fast: cython.double = length(body.before_x, body.before_y)
        fast += body.reach * abs(body.before_spin)  # impulses that are rounding errors do not count
        pushed: cython.bint = body.tied or body.pulled or body.pressure > 1e-12 * body.mass * fast
        body.ahead = pushed or body.solved
        if pushed or (body.solved and body.com != 0.0):
            self.solver.share_out(body, h, body.shift)
            if not body.solved and body.shift > 0.0 and not body.tied:
                self.strike(body, h)
            body.slips = True
            return
        solved: cython.bint = body.solved
        body.go_to(body.back)
        if solved:
            predict(body, h, self.glide, self.thrust)
        body.advance(h)
        if solved:
            body.correct(h)
        self.arrive(body)

    def strike(self, body: Body, h: cython.double) -> cython.void:
        """Let a blow change the velocity of a body in closed form when it came, within h s.

        Its drive, or the floor, acts on it as in the open until then, and from then on.
        """
        x: cython.double = body.vx - body.end_x
        y: cython.double = body.vy - body.end_y
        turn: cython.double = body.spin - body.end_spin
        until: cython.double = h - body.shift
        body.go_to(body.back)
        if until > 0.0:
            predict(body, until, self.glide, self.thrust)
            body.advance(until)
        body.vx, body.vy, body.spin = body.vx + x, body.vy + y, body.spin + turn
        body.account_now()
        body.slips = True
        predict(body, body.shift, self.glide, self.thrust)
        body.advance(body.shift)
        body.account_now()

    # -- without forces -----------------------------------------------------------------------

    def pass_through(
        self, duration: cython.double, time: cython.double, stops: cython.bint
    ) -> cython.void:
        """Move through `duration` s without forces, and find each touch.

        time: at the beginning, s. stops: whether a robot that moves into something stands still for
        the rest of it, and a prop for good.
        """
        elapsed: cython.double = 0.0
        self.measure()
        while elapsed < duration:
            for body in self.bodies:
                body.look()
            if stops and self.any_touch:
                self.stop_some()
            left = h = duration - elapsed
            for pair in self.pairs:
                if stops or pair.gap > 0:
                    h = pair.time_to_touch(h, self.accuracy.grazing_depth)
            if not elapsed + h > elapsed:
                raise FloatingPointError
            for body in self.bodies:
                predict(body, h, self.glide, self.thrust)
                body.advance(h)
            self.measure()
            elapsed = duration if h == left else elapsed + h
            self.note_touches(time + elapsed, h)

    def stop_some(self) -> cython.void:
        """Stop each body that moves into something it touches."""
        for pair in self.pairs:
            if pair.gap > 0:
                continue
            pair.meet()
            pair.a.stopped = pair.a.stopped or pair.into_b > 1e-9
            if not pair.is_wall:
                pair.b.stopped = pair.b.stopped or pair.into_a > 1e-9
        for body in self.bodies:
            if body.stopped:
                body.forward = body.left = body.turning = 0.0
                if not body.is_robot:
                    body.account_now()
                    body.by_push -= body.energy
                    body.energy = body.vx = body.vy = body.spin = 0.0
                body.stopped = False
                body.obey()

    def note_touches(self, time: cython.double, h: cython.double) -> cython.void:
        """Note who touches whom after h s, without impulses."""
        if self.any_touch:
            for body in self.bodies:
                body.before_x, body.before_y, body.before_spin = body.vx, body.vy, body.spin
        for pair in self.pairs:
            if pair.gap > 0:
                continue
            pair.meet()
            other: cython.int = pair.other
            if pair.is_wall:
                other = pair.wall.owner(pair.point_x, pair.point_y)
            row = Row()
            row.x, row.y = pair.point_x, pair.point_y
            row.normal_x, row.normal_y = pair.normal_x, pair.normal_y
            if not pair.is_wall:
                row.add_speed(pair.b, 1.0)
            row.add_speed(pair.a, -1.0)
            note_row(pair.a, other, row)
        self.close(time, h)

    # -- contacts -----------------------------------------------------------------------------

    def close(self, time: cython.double, h: cython.double) -> cython.void:
        """Add up the notes of a substep of h seconds, which ends at `time`."""
        for body in self.bodies:
            if body.contacts:
                close_touches(body, time, h)

    def note_one(self, arbiter: Arbiter) -> cython.void:
        """Note the solver's data of one contact, if it has pushed or still touches."""
        first: cython.int = chipmunk.first_of(arbiter)
        second: cython.int = chipmunk.second_of(arbiter)
        swap: cython.bint = first < 0 or (second >= 0 and second < first)
        a: Body = self.numbers[second if swap else first]
        b: cython.int = first if swap else second
        impulse: Vector = chipmunk.impulse_of(arbiter)
        normal: Vector = arbiter.n
        if arbiter.count == 0:
            return
        if impulse.x == 0.0 and impulse.y == 0.0 and touching(a, b) is None:
            return
        row: Row = Row()
        row.impulse_x, row.impulse_y = impulse.x, impulse.y
        row.normal_x, row.normal_y = normal.x, normal.y
        count: cython.int = chipmunk.count_of(arbiter)
        # each body's velocity is that of its own point
        self.stand(row, arbiter, count, not swap)
        if b >= 0:
            row.add_speed(self.numbers[b], 1.0)
        else:
            for pair in a.wall_pairs:
                if pair.other == b:  # a wall, which may be of several obstacles
                    b = pair.wall.owner(row.x, row.y)
                    break
        self.stand(row, arbiter, count, swap)
        row.add_speed(a, -1.0)
        if swap:
            row.normal_x, row.normal_y = -row.normal_x, -row.normal_y
        if impulse.x * row.normal_x + impulse.y * row.normal_y < 0:
            # It acts on the second: the solver's sign depends on the order of shapes.
            row.impulse_x, row.impulse_y = -impulse.x, -impulse.y
        note_row(a, b, row)

    def stand(
        self, row: Row, arbiter: Arbiter, count: cython.int, second: cython.bint
    ) -> cython.void:
        """Put a row at the middle of a contact's points on one of its bodies."""
        if count > 0:
            point = chipmunk.point_of(arbiter, 0, second)
            row.x, row.y = point.x, point.y
        if count > 1:
            point = chipmunk.point_of(arbiter, 1, second)
            row.x, row.y = (row.x + point.x) / 2, (row.y + point.y) / 2


def touching(a: Body, b: cython.int) -> Pair | None:
    """Return a pair in which a body touches another or a wall now, by its measured gap."""
    pair = a.first_touch
    while pair is not None and pair.other != b:
        pair = pair.next_touch
    return pair


def draw_together(pair: Pair, way: cython.double) -> cython.void:
    """Move the bodies of a pair towards each other; their common centre of mass stays.

    A prop stays where it is: its way is measured more finely than that of what pushes it.
    """
    a: Body = pair.a
    b: Body = pair.b
    share: cython.double = 1.0
    if not pair.is_wall:
        share = b.mass / (a.mass + b.mass)
        if a.is_robot != b.is_robot:
            share = 1.0 if a.is_robot else 0.0
        b.x += (share - 1) * way * pair.normal_x
        b.y += (share - 1) * way * pair.normal_y
        b.placed = True
    a.x += share * way * pair.normal_x
    a.y += share * way * pair.normal_y
    a.placed = True


def opened(pair: Pair) -> cython.double:
    """Return by how much the gap of a pair has grown since its bodies' places were kept."""
    x: cython.double = pair.a.back.x - pair.a.x
    y: cython.double = pair.a.back.y - pair.a.y
    if not pair.is_wall:
        x = x + pair.b.x - pair.b.back.x
        y = y + pair.b.y - pair.b.back.y
    return x * pair.normal_x + y * pair.normal_y
