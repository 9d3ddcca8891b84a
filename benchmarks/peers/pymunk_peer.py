"""pymunk: the engine under MARS2D, in a bare loop with equal substeps.

What it does not do in these scenes:

- It bounds no overlap: the same number of substeps is done at all times, whatever is near, and how
  deep bodies get is seen afterwards. "1 mm" has as many as a scene needs to stay within MARS2D's
  default in the steps that are timed and looked at; another scene would need others.
- Free robots go straight on in a control step, in the middle direction of their arc.
- The floor holds a crate by a force and a torque that don't know of each other: one that is pushed
  beside its centre turns less than in MARS2D.
- Nothing is recorded, and contacts are not reported.

What was set, and how: 15 iterations, `collision_slop` 0.1 mm. A `PivotJoint` and a `GearJoint` of
bounded force tie each robot to a kinematic body with the velocity that it is told, and each crate
to the floor (`max_bias` 0); ropes are `SlideJoint`s. Robots that touch nothing, and whose rope is
slack, get their velocity at once at each control step, as they do in MARS2D. States are read and
set by `pymunk.batch`, once a control step: quicker than attributes from ten robots on; with the two
of S1, attributes would save some 16 us of the 180 of a control step.
"Is something near?" is `Space.point_query_nearest`; the 180 beams are as many calls of
`Space.segment_query_first`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
import pymunk
from peer import Engine, Float, main, scenes
from pymunk import batch


class Pymunk(Engine):
    """A scene in pymunk."""

    SUBSTEPS: ClassVar[dict[str, int]] = {
        "S1": 19, "S2": 27, "S3": 33, "S4": 29, "P1": 18, "P2": 31, "P3": 18,
    }  # fmt: skip

    def build(self) -> None:
        scene = self.scene
        self._space = space = pymunk.Space()
        space.collision_slop, space.iterations = 1e-4, 15
        self._robots = [
            self._body(k, pose, scene.radius, disc=not scene.square)
            for k, pose in enumerate(scene.poses.tolist())
        ]
        self._crates = [
            self._body(None, pose, scenes.BOX / 2, disc=False) for pose in scene.crates.tolist()
        ]
        for body in self._robots:
            control = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
            space.add(control)
            self._hold(control, body, scenes.FORCE, scenes.TORQUE)
        force = scenes.FLOOR * scenes.MASS * scenes.GRAVITY
        for body in self._crates:
            self._hold(space.static_body, body, force, force * scenes.LEVER)
        self._ropes = [
            (i, self._rope(self._robots[i], self._crates[k], length))
            for i, k, length in scene.ropes
        ]
        self._build_outlines()
        self._index = {body.id: i for i, body in enumerate(self._robots)}
        self._arbiters, self._state, self._out = batch.Buffer(), batch.Buffer(), batch.Buffer()
        # The velocities of robots and crates, of what drives the robots, and of what stands still.
        self._velocity = np.zeros((2 * len(self._robots) + len(self._crates) + 1, 3))
        self._out.set_float_buf(self._velocity)

    def _body(
        self, robot: int | None, pose: Sequence[float], half: float, *, disc: bool
    ) -> pymunk.Body:
        """Add a disc of radius `half`, or a square of twice that side."""
        mass = scenes.MASS
        moment = mass * half**2 * (1 / 2 if disc else 2 / 3)
        body = pymunk.Body(mass, moment)
        body.position, body.angle = (pose[0], pose[1]), pose[2]
        shape: pymunk.Shape
        shape = pymunk.Circle(body, half) if disc else pymunk.Poly.create_box(body, (2 * half,) * 2)
        shape.friction = scenes.FRICTION
        if robot is not None:
            shape.filter = pymunk.ShapeFilter(group=robot + 1)  # its queries miss itself
        self._space.add(body, shape)
        return body

    def _hold(self, by: pymunk.Body, body: pymunk.Body, force: float, torque: float) -> None:
        """Let a body follow the velocity of another by joints of bounded force and torque."""
        pivot = pymunk.PivotJoint(by, body, (0, 0), (0, 0))
        gear = pymunk.GearJoint(by, body, 0, 1)
        pivot.max_bias = gear.max_bias = 0
        pivot.max_force, gear.max_force = force, torque
        self._space.add(pivot, gear)

    def _rope(self, a: pymunk.Body, b: pymunk.Body, length: float) -> pymunk.SlideJoint:
        rope = pymunk.SlideJoint(a, b, (0, 0), (0, 0), 0, length)
        self._space.add(rope)
        return rope

    def _build_outlines(self) -> None:
        fixed, corners = self._space.static_body, self.scene.walls
        ends = zip(corners, [*corners[1:], corners[0]], strict=True)
        walls = [pymunk.Segment(fixed, a, b, 0) for a, b in ends]
        for shape in (*walls, *(pymunk.Poly(fixed, box) for box in self.scene.boxes)):
            shape.friction = scenes.WALL_FRICTION
            self._space.add(shape)

    def move(self, command: Float) -> None:
        v, omega = command
        n, velocity = len(self._robots), self._velocity
        bodies = n + len(self._crates)
        state = self._read()
        middle = state[:n, 2] + omega * (self.scene.sampling_time / 2)
        told = np.column_stack([v * np.cos(middle), v * np.sin(middle), omega])
        velocity[:n], velocity[n:bodies], velocity[bodies:-1] = told, state[n:, 3:], told
        held = list(self._held())
        velocity[held] = state[held, 3:]
        fields = batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY
        batch.set_space_bodies(self._space, fields, self._out)
        step, h = self._space.step, self.scene.sampling_time / self.substeps
        for _ in range(self.substeps):
            step(h)

    def _held(self) -> set[int]:
        """Return the robots that touch something, or pull a rope: those that forces move."""
        self._arbiters.clear()
        ids = batch.ArbiterFields.BODY_A_ID | batch.ArbiterFields.BODY_B_ID
        batch.get_space_arbiters(self._space, ids, self._arbiters)
        touching = np.frombuffer(self._arbiters.int_buf(), dtype=np.int64).tolist()
        pulling = {i for i, rope in self._ropes if rope.impulse}
        return pulling | {self._index[body] for body in touching if body in self._index}

    def _read(self) -> Float:
        """Return the states (n + p, 6) of robots and crates: pose, then velocity."""
        fields = batch.BodyFields
        everything = fields.POSITION | fields.ANGLE | fields.VELOCITY | fields.ANGULAR_VELOCITY
        self._state.clear()
        batch.get_space_bodies(self._space, everything, self._state)
        states = np.frombuffer(self._state.float_buf()).reshape(-1, 6)
        return states[: len(self._robots) + len(self._crates)]

    def poses(self) -> Float:
        return self._read()[:, :3].copy()

    def near(self) -> Sequence[bool]:
        within, query = self.scene.proximity, self._space.point_query_nearest
        return [
            query(body.position, within, pymunk.ShapeFilter(group=k + 1)) is not None
            for k, body in enumerate(self._robots)
        ]

    def ranges(self) -> Sequence[Any]:
        beams, reach = self.scene.beams, self.scene.range
        query = self._space.segment_query_first
        found = np.full((len(self._robots), beams), reach)
        for k, body in enumerate(self._robots):
            (x, y), own = body.position, pymunk.ShapeFilter(group=k + 1)
            angles = body.angle - np.pi + 2 * np.pi / beams * np.arange(beams)
            ends = reach * np.column_stack([np.cos(angles), np.sin(angles)]) + (x, y)
            for beam, end in enumerate(ends.tolist()):
                hit = query((x, y), end, 0, own)
                if hit is not None:
                    found[k, beam] = reach * hit.alpha
        return list(found)


if __name__ == "__main__":
    main(Pymunk)
