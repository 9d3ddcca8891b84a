"""Mover: moves all bodies of a world, and finds the islands that they form."""

from __future__ import annotations

from typing import Any

from mars2d.physics.islands import settings
from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import length
from mars2d.physics.islands.body import Body
from mars2d.physics.islands.contacts import (
    Touch,
    begin_touches_again,
    end_touches,
    keep_touches,
    lasting_touches,
    take_touches,
    touch_on,
)
from mars2d.physics.islands.floor import Glide
from mars2d.physics.islands.island import Accuracy, Island
from mars2d.physics.islands.neighbours import Neighbours
from mars2d.physics.islands.pair import Wall
from mars2d.physics.islands.solver import Solver, free_things_of, free_tie
from mars2d.physics.islands.thrust import Thrust, predict
from mars2d.physics.islands.tie import Tie


@cython.cclass
class Mover:
    """All bodies of a world, by their numbers, with their possible contacts and their ties."""

    accuracy: Accuracy
    glide: Glide
    thrust: Thrust
    bodies: list[Body]
    ties: list[Tie]
    neighbours: Neighbours
    taken: list[Touch]  # contacts that were counted, but not written yet
    solvers: list[Solver]
    spare: list[Solver]  # those that no island uses
    islands: list[Island]  # as many as there were at most
    found: cython.int  # how many there are now
    surfaces: object  # what settles friction and restitution; None: they are products

    def __init__(
        self,
        accuracy: Accuracy,
        glide: Glide,
        bodies: list[Body],
        walls: list[Wall],
        ties: list[Tie],
        passing: set[Any],
        surfaces: Any = None,
    ) -> None:
        """Take bodies, walls, ties, and pairs of bodies that pass through each other.

        surfaces: what settles friction and restitution of contacts; None: they are products.
        """
        self.surfaces = surfaces
        self.accuracy, self.glide, self.bodies, self.ties = accuracy, glide, bodies, ties
        self.thrust = Thrust()
        self.neighbours = Neighbours(bodies, walls, passing)
        self.taken, self.spare, self.solvers, self.islands = [], [], [], []
        for body in bodies:
            body.slack = settings.SLACK

    # -- a control step -----------------------------------------------------------------------

    def drive(self, twist: cython.Doubles, duration: float, time: float) -> None:
        """Move all bodies for `duration` seconds under constant twists of the robots.

        twist: ahead [m/s] or x', to the left or y', spin [rad/s] of all robots. time: at the
        beginning, s.
        """
        self.command(twist)
        self.begin(duration)
        self.neighbours.measure()
        self.find_islands(duration)
        while not self.run_islands(duration, time):
            self.find_islands(duration)  # with more room for those that went too far
        self.carry_on(duration, time)
        self.clear_up()

    def drift(self, twist: cython.Doubles, duration: float, time: float, stops: bool) -> None:
        """Do the same without forces: bodies that touch go through, or stop; see `Island`."""
        self.command(twist)
        self.begin(duration)
        for body in self.bodies:
            body.near, body.home, body.way = False, body, body.speed * duration
        self.neighbours.refresh()
        self.neighbours.measure()
        self.join()
        self.make_islands()
        for k in range(self.found):
            island = self.islands[k]
            island.pass_through(duration, time, stops)
        self.carry_on(duration, time)

    def command(self, twist: cython.Doubles) -> None:
        """Take the twists of all robots."""
        n: cython.int = len(twist) // 3
        for i in range(n):
            body = self.bodies[i]
            body.forward = twist[i]
            body.left = twist[n + i]
            body.turning = twist[2 * n + i]

    def ask(self, twist: cython.Doubles) -> None:
        """Take the twists of all robots at an instant, but of those that were stopped."""
        n: cython.int = len(twist) // 3
        for i in range(n):
            body = self.bodies[i]
            if body.forward != 0.0 or body.left != 0.0 or body.turning != 0.0:
                body.forward, body.left, body.turning = twist[i], twist[n + i], twist[2 * n + i]
                if body.solver is None:  # one that touches something needs a force for that
                    body.obey()
                    body.account_now()

    def begin(self, duration: cython.double) -> cython.void:
        """Find out who slips, and how fast each body may be."""
        for body in self.bodies:
            body.done = body.kept = body.solved = body.touches = False
            body.start_x, body.start_y = body.x, body.y
            if not body.is_disc:
                body.locate()
                body.start_x, body.start_y = body.center_x, body.center_y
            if body.limited and body.com != 0.0:
                body.look()
                body.slips = (
                    body.slips or body.accelerates
                )  # no closed form is known of how it sways
            body.speed = length(body.vx, body.vy) + body.offset * abs(body.spin)
            if body.slips:
                body.speed += 2 * abs(body.com * body.spin)
            asked: cython.double = 0.0
            if body.is_robot:
                asked = length(body.forward, body.left)
                body.speed = max(body.speed, asked + body.offset * abs(body.turning))
            if not body.speed + asked + abs(body.x) + abs(body.y) < 1e100:  # squares are finite
                raise FloatingPointError
            if body.pulled:
                push: cython.double = length(body.pull_x, body.pull_y) / body.mass
                sway: cython.double = abs(body.pull_torque) + abs(body.com) * push * body.mass
                push += (body.offset + abs(body.com)) * sway / body.moment
                body.speed += push * duration

    def find_islands(self, duration: cython.double) -> cython.void:
        """Mark who may touch something or is held, and find who is in one island.

        A body that is near may be pushed by the fastest of its island, and so get near to others.
        """
        for body in self.bodies:
            body.near = body.initial.slips if body.kept else body.slips
            body.home = body
        more: cython.bint = True
        while more:
            self.set_ways(duration)
            self.neighbours.refresh()
            more = self.join()

    def set_ways(self, duration: cython.double) -> cython.void:
        """Work out how far each body may go."""
        for body in self.bodies:
            body.fastest = 0.0
            body.way = body.speed * duration
        for body in self.bodies:
            if body.near:
                home = root(body)
                # A spring may move what is at rest.
                thrown: cython.double = (body.slack - settings.SLACK) * 0.01
                home.fastest = max(home.fastest, body.slack * body.speed * duration + thrown)
        for body in self.bodies:
            if body.near:
                home = root(body)
                body.way = home.fastest + self.accuracy.max_overlap

    def join(self) -> cython.bint:
        """Join those that may touch or hold each other; return whether anything is new."""
        more: cython.bint = False
        for pair in self.neighbours.pairs:
            if pair.start_gap <= pair.a.way + pair.b.way:
                if pair.a.near and pair.b.near and root(pair.a) is root(pair.b):
                    continue
                join_homes(pair.a, pair.b)
                more = True
        for tie in self.ties:
            if tie.a.near and tie.b.near and root(tie.a) is root(tie.b):
                continue
            tie.measure()
            if tie.may_hold():
                join_homes(tie.a, tie.b)
                more = True
        for body in self.bodies:
            if not body.near and self.neighbours.at_wall(body):
                body.near = True
                more = True
        return more

    def run_islands(self, duration: cython.double, time: cython.double) -> cython.bint:
        """Step all islands that were not yet; return whether none went further than it could."""
        good: cython.bint = True
        self.make_islands()
        for k in range(self.found):
            island = self.islands[k]
            if self.is_done(island):
                continue
            body = island.bodies[0]
            home = root(body)
            island.limit = home.fastest
            if island.run(duration, time):
                for body in island.bodies:
                    body.done = True
            else:
                good = False
                for body in island.bodies:
                    self.begin_again(body)
                    body.slack = 2 * body.slack
        return good

    def is_done(self, island: Island) -> cython.bint:
        """Return whether an island has been stepped as it is.

        If it has grown since, all of it begins again.
        """
        done: cython.int = 0
        for body in island.bodies:
            done += body.done
        if done == len(island.bodies):
            return True
        if done:
            for body in island.bodies:
                if body.done:
                    self.begin_again(body)
        return False

    def begin_again(self, body: Body) -> cython.void:
        """Put a body back to where it was at the beginning; its solver forgets it."""
        if body.solver is not None:
            body.solver.leave(body)
        body.begin_with(body.initial)
        body.done = False
        begin_touches_again(body)

    def make_islands(self) -> cython.void:
        """Make the islands of those that are near."""
        self.found = 0
        for body in self.bodies:
            body.island = None
        for body in self.bodies:
            if not body.near:
                continue
            home = root(body)
            if home.island is None:
                home.island = self.next_island()
            island = home.island
            body.island = island
            island.bodies.append(body)
            if not body.kept:
                body.kept = True
                body.initial.begin_with(body)
                keep_touches(body)
            if self.neighbours.at_wall(body):
                for pair in body.wall_pairs:
                    if pair.apart() <= body.way and not pair.hidden():
                        island.pairs.append(pair)
        self.add_pairs_of_bodies()

    def next_island(self) -> Island:
        """Return an island without bodies."""
        if self.found == len(self.islands):
            self.islands.append(Island(self))
        island = self.islands[self.found]
        island.clear()
        self.found += 1
        return island

    def add_pairs_of_bodies(self) -> cython.void:
        """Add pairs of bodies that may touch, and ties that may hold."""
        for pair in self.neighbours.pairs:
            if pair.start_gap <= pair.a.way + pair.b.way:
                island = pair.a.island
                island.pairs.append(pair)
        for tie in self.ties:
            if tie.a.near and tie.b.near and tie.a.island is tie.b.island:
                island = tie.a.island
                island.ties.append(tie)

    # -- who is free --------------------------------------------------------------------------

    def carry_on(self, duration: cython.double, time: cython.double) -> cython.void:
        """Carry those that nothing can reach, and end the control step."""
        self.neighbours.advance()
        for body in self.bodies:
            if not body.near:
                end_touches(body, time)
                self.carry(body, duration)
            body.account_now()

    def carry(self, body: Body, duration: cython.double) -> cython.void:
        """Move a body that nothing can reach, in closed form."""
        if body.solver is not None:
            body.solver.leave(body)
        body.slack, body.load = settings.SLACK, 1.0
        body.since = 1 << 20
        predict(body, duration, self.glide, self.thrust)
        body.advance(duration)

    def clear_up(self) -> cython.void:
        """Empty the solvers that were not needed, and keep those that were."""
        for solver in self.solvers:
            if not solver.used or not solver.bodies:
                solver.empty()
                if not solver.idle:
                    solver.idle = True
                    self.spare.append(solver)
            solver.used = False

    # -- what is asked of it ------------------------------------------------------------------

    def write_states(self, states: cython.Doubles) -> None:
        """Write x, y, theta, x', y', theta' of all bodies into a row of numbers."""
        k: cython.int = 0
        for body in self.bodies:
            states[k] = body.x
            states[k + 1] = body.y
            states[k + 2] = body.angle
            states[k + 3] = body.vx
            states[k + 4] = body.vy
            states[k + 5] = body.spin
            k += 6

    def count_contacts(self) -> int:
        """Return how many pairs have touched since contacts were last written."""
        self.taken = take_touches(self.bodies)
        return len(self.taken)

    def write_contacts(self, numbers: cython.Doubles) -> None:
        """Write the contacts that were counted, fifteen numbers each; see `Touch.write`."""
        k: cython.int = 0
        for touch in self.taken:
            touch.write(numbers, k)
            touch.begin()
            k += 15
        self.taken = []

    def take_effort(self, efforts: cython.Doubles) -> None:
        """Write the largest share of its bounds that each drive used since the last call."""
        for i in range(len(efforts)):
            body = self.bodies[i]
            efforts[i] = min(body.effort, 1.0)
            body.effort = 0.0

    def write_work(self, work: cython.Doubles) -> None:
        """Write the work since the beginning, J; see `mars2d.record.energy.WORK`."""
        for k in range(6):
            work[k] = 0.0
        for body in self.bodies:
            work[0 if body.is_robot else 1] += body.by_holder
            work[2] += body.by_friction
            work[3] += body.by_push
            work[4] += body.by_joint
            work[5] += body.by_hand

    def pull(self, i: int, pull: list[float]) -> None:
        """Let a force x, y and a torque act on a body, until `let_go`."""
        body: Body = self.bodies[i]
        body.pull_x, body.pull_y, body.pull_torque = pull
        body.pulled = body.slips = True

    def let_go(self) -> None:
        """End all pulls."""
        for body in self.bodies:
            body.pulled = False
            body.pull_x = body.pull_y = body.pull_torque = 0.0

    def withstands(self, i: int, force: float, torque: float) -> bool:
        """Return whether a body stays where it is held under a force and a torque."""
        body: Body = self.bodies[i]
        if body.slips:
            return False
        if body.limited:
            body.look()
            if body.accelerates:
                return False
        if body.is_robot:
            least: cython.double = min(body.force, body.grip_ahead, body.grip_across)
            share: cython.double = max(force / least, torque / body.torque)
            if share > 1.0:
                return False
            body.effort = max(body.effort, share)
            return True
        if body.vx != 0.0 or body.vy != 0.0 or body.spin != 0.0 or body.rest_grip == 0.0:
            return False
        return length(force / body.rest_grip, torque / body.rest_twist_grip) <= 1.0

    def rest(self) -> list[Any]:
        """Forget all but how bodies move and touch, and return that, for `remember`."""
        self.free()
        self.islands = []
        self.neighbours.begin()
        return [(body.memory(), lasting_touches(body)) for body in self.bodies]

    def remember(self, memories: list[Any]) -> None:
        """Go on as another mover of the same bodies does since it has rested."""
        for body in self.bodies:
            memory, touches = memories[body.number]
            body.remember(memory)
            touch_on(body, touches)

    def free(self) -> None:
        """Free the engine's objects, and the impulses that the solvers keep."""
        for solver in self.solvers:
            solver.free()
        for tie in self.ties:
            free_tie(tie)
        for body in self.bodies:
            free_things_of(body)
        self.solvers, self.spare = [], []


def root(body: Body) -> Body:
    """Return the body that stands for an island."""
    home: Body = body.home
    while home.home is not home:
        home = home.home
    body.home = home
    return home


def join_homes(a: Body, b: Body) -> cython.void:
    """Join the islands of two bodies; the smaller number stands for both."""
    a.near = b.near = True
    first: Body = root(a)
    second: Body = root(b)
    if first.number < second.number:
        second.home = first
    elif second is not first:
        first.home = second
