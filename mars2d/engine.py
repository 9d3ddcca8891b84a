"""Contact physics: bodies moved exactly where nothing touches, by forces where something does.

What nothing can reach during the time to come is *carried*: robots go to the ends of their arcs and
props glide, both in closed form, in one step of any length. What may touch something is *near*: it
is stepped finely, robots by their clutches and props by the floor's grip.
"""

from __future__ import annotations

from math import ceil, sqrt

import numpy as np
from numpy.typing import NDArray

from mars2d.clutches import Clutches
from mars2d.contact import CONTACT, ContactLog
from mars2d.encounter import Bounds, Encounter
from mars2d.grips import Grips
from mars2d.kernel import CONTACTS, EFFORT, PLACED, Kernel, reason_without
from mars2d.motion import Motion
from mars2d.scenario import Scenario
from mars2d.space import Space
from mars2d.tethers import Tethers

__all__ = ["SLOP", "Engine"]

Float = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

SLOP = 1e-4
"""The overlap that the solver leaves in steady contact, metres."""

ITERATIONS = 15
ITERATIONS_UNEQUAL = 20  # with masses more than three times apart
ITERATIONS_TIED = 60  # with joints: several may hold the same bodies

SLACK = 1.25
"""How much further than at its present speed a body may be thrown before gaps are asked anew."""

STRETCH = 1 / 15
"""How much longer a rope may be when it jerks, in parts of how deep bodies may enter.

The solver draws it in again, and what it pulls at bounces by that much more than nothing.
"""

PRESSED = 0.25
"""How deep bodies overlap at least that press against each other, in parts of the slop."""

GROWTH = 2.0
"""How much longer or shorter a substep may be than the one before, with the same joints.

The solver begins with what they did in the substep before. From where the next one has to be
shorter than that, they begin anew.
"""


NOTHING = np.empty(0, dtype=CONTACT)
NOTHING.flags.writeable = False


class Engine(Motion):
    """The motion of one world's bodies: robots first, then props."""

    def __init__(self, scenario: Scenario) -> None:
        """Build robots, props, obstacles and, where `on_exit` is "wall", the workspace's walls."""
        bodies = scenario.bodies
        self.n, self.count = len(scenario.robots), len(bodies)
        mass = self._mass = np.array([body.inertia.mass for body in bodies])
        thinnest = min(body.shape.thickness for body in bodies)
        unequal = mass.max() > 3 * mass.min()
        iterations = ITERATIONS_UNEQUAL if unequal else ITERATIONS
        if scenario.ties:
            iterations = ITERATIONS_TIED
        slop = min(SLOP, scenario.max_overlap / 4, thinnest / 32)
        self._pressed = PRESSED * slop
        self.space = Space(scenario, slop, iterations)
        self.bounds = Bounds(bodies, [s.outline for s in scenario.surfaces], scenario.joined)
        self._tethers = Tethers(scenario.ties, bodies) if scenario.ties else None
        self.contacts = ContactLog()

        self._clutches = Clutches(scenario, self.space)
        self._grips = Grips(scenario, self.space, self.bounds)
        self._set_accuracy(scenario, thinnest, iterations)
        self._slipping = np.zeros(self.count, dtype=bool)
        self._state = self.space.read().copy()
        self._twist = np.zeros((3, self.n))
        self._kernel = self._compiled(scenario)
        self._left = 0  # of what the kernel did: contacts, efforts
        self._idle = np.zeros(self.n)
        self._idle.flags.writeable = False

    def _compiled(self, scenario: Scenario) -> Kernel | None:
        """Return the kernel that moves such a world, or None if it takes the plain engine."""
        if scenario.props or scenario.ties or not self.bounds.only_centred_discs:
            return None
        if reason_without():
            return None
        self._placed, self._reach = np.zeros(self.n, dtype=bool), np.zeros(self.n)
        arrays = {
            "state": self._state, "slipping": self._slipping, "placed": self._placed,
            "reach": self._reach,
        }  # fmt: skip
        numbers = {
            "n": self.n, "max_overlap": self._max_overlap, "entry": self._entry,
            "contact_step": self._contact_step, "pressed": self._pressed, "slack": SLACK,
            "growth": GROWTH, "last_step": self.space.last_step,
        }  # fmt: skip
        for part in (self.bounds, self._clutches, self.space):
            more_arrays, more_numbers = part.shared()
            arrays |= more_arrays
            numbers |= more_numbers
        return Kernel(arrays, numbers)

    def _set_accuracy(self, scenario: Scenario, thinnest: float, iterations: int) -> None:
        """Work out how deep a body may enter in one substep, and how long one in contact may be."""
        self._max_overlap = scenario.max_overlap
        # A quarter of the overlap allowed is left to the slop and to what the solver leaves over.
        self._entry = min(0.75 * scenario.max_overlap, 0.125 * thinnest)
        # The depth under a force F settles at about F h^2 / (m iterations).
        force = self._clutches.force
        push = float(max((force / self._mass[: self.n]).max(), force.max() / self._mass.min()))
        self._contact_step = sqrt(0.15 * scenario.max_overlap * iterations / push)
        if self._tethers is not None:
            self._contact_step = min(self._contact_step, self._tethers.longest_step)

    def take_effort(self) -> Float:
        """Return the largest share of its bounds that each drive used since the last call, (n,)."""
        if self._kernel is not None and not self._left_over(EFFORT):
            return self._idle
        return self._clutches.take_effort()

    @property
    def velocity(self) -> Float:
        """The velocities (3, N) at this instant: x', y' [m/s], theta' [rad/s], as a new array."""
        velocity = super().velocity
        free = np.flatnonzero(~self._slipping[: self.n])  # the engine has chords of these
        tangent = self._clutches.chord(self._twist, self._state[free], 0.0, free)
        velocity[:, free] = tangent.T
        return velocity

    # -- motion -----------------------------------------------------------------------------

    def drive(self, twist: Float, duration: float, time: float) -> None:
        """Move everything for `duration` seconds, the robots driven by constant twists (3, n).

        time: that of the start, seconds, for the contacts.
        """
        self._twist = twist
        if self._kernel is not None:
            self._drive_kernel(self._kernel, twist, duration, time)
            return
        elapsed = 0.0
        while elapsed < duration:
            left = duration - elapsed
            gone = self._advance(twist, left, time + elapsed)
            elapsed = duration if gone == left else elapsed + gone

    def _drive_kernel(self, kernel: Kernel, twist: Float, duration: float, time: float) -> None:
        """Do the same by the kernel."""
        left = kernel.drive(twist, duration, time)
        self._left |= left
        if left & PLACED:
            self.space.misplace(np.flatnonzero(self._placed))

    def take_contacts(self) -> NDArray[np.void]:
        """Return the contacts since the last call, by time, one row (dtype CONTACT) a pair."""
        if self._kernel is None:
            return self.contacts.take()
        return self._kernel.take() if self._left_over(CONTACTS) else NOTHING

    def _left_over(self, what: int) -> bool:
        """Return whether the kernel has left something that is taken now."""
        there = bool(self._left & what)
        self._left &= ~what
        return there

    def _advance(self, twist: Float, duration: float, time: float) -> float:
        """Go on by at most `duration` seconds, and return by how much.

        It is less when a body has been thrown further than was thought possible: then it is to be
        asked anew what it may touch.
        """
        center = self.bounds.center(self._state)
        near, path = self._find_near(twist, center, duration)
        self._clutches.release(~near[: self.n])
        self._carry(twist, duration)
        if near.any():
            who = np.flatnonzero(near)
            encounter = self.bounds.encounter(center, who, path + self._max_overlap)
            gone = self._substeps(twist, duration, time, who, encounter, path)
        else:
            gone = duration
            self.space.step(duration)
            self.contacts.add_nothing()
        self._arrive(twist, ~near, gone, duration)
        return gone

    def _carry(self, twist: Float, duration: float) -> None:
        """Set the velocities that bring what touches nothing to where it will be."""
        velocity, state, n = self.space.velocity, self._state, self.n
        velocity[:n] = self._clutches.chord(twist, state[:n], duration, slice(None))
        if self.count > n:
            moved, _ = self._grips.glide(state[n:], np.arange(n, self.count), duration)
            velocity[n : self.count] = moved / duration

    def _arrive(self, twist: Float, carried: Mask, gone: float, duration: float) -> None:
        """Read the state; put those that were carried where they are after `gone` seconds."""
        before, n = self._state, self.n
        self._state = self.space.read().copy()
        if gone < duration:  # they were on the chord of a longer time
            who = np.flatnonzero(carried[:n])
            moved = gone * self._clutches.chord(twist, before[who], gone, who)
            for i, (dx, dy, _) in zip(who.tolist(), moved.tolist(), strict=True):
                self._put(i, before[i, 0] + dx, before[i, 1] + dy, None)
        if self.count > n:
            who = n + np.flatnonzero(carried[n:])
            moved, end = self._grips.glide(before[who], who, gone)
            self._state[who, 3:] = end
            if gone < duration:
                after = (before[who, :3] + moved).tolist()
                for i, (x, y, theta) in zip(who.tolist(), after, strict=True):
                    self._put(i, x, y, theta)

    def _put(self, i: int, x: float, y: float, theta: float | None) -> None:
        self.space.place(i, x, y, theta)
        self._state[i, :2] = x, y
        if theta is not None:
            self._state[i, 2] = theta

    def _find_near(self, twist: Float, center: Complex, duration: float) -> tuple[Mask, float]:
        """Return which bodies may touch something, and the longest path that one may take.

        One that is near may be pushed by the quickest of them, and so be near to others.
        """
        bounds, n = self.bounds, self.n
        now = bounds.top_speed(self._state[:, 3:])
        speed = now.copy()
        speed[:n] = bounds.top_speed(twist.T, slice(n))
        near = self._slipping.copy()
        if self._tethers is not None:
            near |= self._tethers.tied
        if near.any():
            speed = np.where(near, np.maximum(speed, now), speed)
        path, reach, count = 0.0, speed * duration, -1
        while int(near.sum()) != count:
            count = int(near.sum())
            near |= bounds.clearance.may_touch(center, reach)
            if near.any():
                path = SLACK * float(speed[near].max()) * duration
                reach = np.where(near, path + self._max_overlap, speed * duration)
        bounds.clearance.moved(reach)
        return near, path

    def _substeps(
        self,
        twist: Float,
        duration: float,
        time: float,
        who: Index,
        encounter: Encounter,
        path: float,
    ) -> float:
        """Step through `duration` as finely as those need that are near something.

        who: (k,) their numbers. path: metres; before one of them has gone further, this returns.
        Returns the seconds gone.
        """
        slipping = self._slipping[who]
        everything = self._state
        gone = np.zeros(len(who))  # paths, metres
        elapsed = h = 0.0
        while True:
            encounter.measure(everything[who])
            if elapsed > 0:
                self._note_contacts(time + elapsed, h, everything, encounter)
            if elapsed >= duration:
                break
            if encounter.any_touch:
                self._press(everything, encounter)
            left = duration - elapsed
            velocity, h = self._look_ahead(twist, everything, slipping, who, encounter, left)
            gone += h * self.bounds.top_speed(velocity, who)
            if elapsed > 0 and gone.max() > path:
                break
            self._aim(twist, everything[who], slipping, who, h)
            self.space.step(h)
            elapsed = duration if h == left else elapsed + h
            everything = self.space.read().copy()
            robots = np.searchsorted(who, self.n)
            self._clutches.note_effort(who[:robots][slipping[:robots]])
        self._slipping[who] = slipping
        return elapsed

    def _press(self, everything: Float, encounter: Encounter) -> None:
        """Press together what touches by a rounding only, and would lose touch by another.

        everything: (N, 6) states of all bodies, which are brought up to date.
        """
        for a, b, normal in zip(*encounter.grazing(self._pressed / 8), strict=True):
            # Their common centre of mass stays.
            share = 1.0 if b < 0 else self._mass[b] / (self._mass[a] + self._mass[b])
            for i, way in ((int(a), share * self._pressed), (int(b), (share - 1) * self._pressed)):
                if i >= 0:
                    everything[i, :2] += way * normal.real, way * normal.imag
                    self.space.place(i, *everything[i, :2].tolist())

    def _note_contacts(self, time: float, h: float, state: Float, encounter: Encounter) -> None:
        if encounter.any_touch:
            pairs = encounter.touching_pairs()
            self.contacts.add(time, h, self.space.solved(state), pairs)
        else:
            self.contacts.add_nothing()

    def _look_ahead(
        self,
        twist: Float,
        everything: Float,
        slipping: Mask,
        who: Index,
        encounter: Encounter,
        left: float,
    ) -> tuple[Float, float]:
        """Return how bodies `who` move, (k, 3), and how long the next substep may be, seconds.

        everything: (N, 6) states of all bodies. slipping: (k,), which is brought up to date. left:
        seconds until the end.
        """
        state, r = everything[who], np.searchsorted(who, self.n)  # robots come first
        touching = encounter.touching()
        if self._tethers is not None:
            self._tethers.measure(everything)
            touching |= self._tethers.held()[who]
        h = left
        slipping |= touching
        if slipping.any():
            h = min(h, self._contact_step, GROWTH * self.space.last_step)
            brakes = self._clutches.time_to_brake(twist, state[:r], slipping[:r], who[:r])
            h = float(brakes.min(initial=h))
            returns = np.flatnonzero(slipping[:r] & ~touching[:r])
            slow = self._clutches.out_of_reach(twist, state[returns], who[returns], h)
            slipping[returns] = slow
            slipping[r:] = touching[r:]
        parts = [self._clutches.motion(twist, state[:r], slipping[:r], who[:r])]
        if r < len(who):
            parts.append(self._grips.motion(state[r:], slipping[r:], who[r:]))
        velocity, bend = (np.concatenate(part) for part in zip(*parts, strict=True))
        h = min(h, encounter.time_to_touch(velocity, bend, self._entry))
        if self._tethers is not None:
            h = min(h, self._time_to_jerk(velocity, bend, who))
        return velocity, left / ceil(left / h - 1e-9)  # equal ones settle best, without a sliver

    def _time_to_jerk(self, velocity: Float, bend: Float, who: Index) -> float:
        """Return for how long no rope gets taut and longer; all that are tied are near."""
        assert self._tethers is not None
        all_velocity, all_bend = np.zeros((self.count, 3)), np.zeros(self.count)
        all_velocity[who], all_bend[who] = velocity, bend
        return self._tethers.time_to_jerk(all_velocity, all_bend, STRETCH * self._entry)

    def _aim(self, twist: Float, state: Float, slipping: Mask, who: Index, h: float) -> None:
        """Prepare bodies `who` for a substep of h."""
        r = np.searchsorted(who, self.n)
        brief = h <= self._contact_step
        self._clutches.aim(twist, state[:r], slipping[:r], who[:r], h, brief=brief)
        if r < len(who):
            self._grips.aim(state[r:], slipping[r:], who[r:], h)
        if GROWTH * h < self.space.last_step and slipping.any():
            held = np.zeros(self.count, dtype=bool)
            held[who] = slipping
            self.space.renew(held)
        if self._tethers is not None:
            for rope, speed in self._tethers.drift(h):
                self.space.draw_in(rope, speed)
