"""Box2D: a widely used engine of rigid bodies in the plane, in a bare loop with equal substeps.

What it does not do in these scenes:

- It bounds no overlap; see `pymunk_peer.py`, which is the same loop. "1 mm" has as many substeps as
  a scene needs.
- With metres as its units, bodies may overlap by 5 mm (`b2_linearSlop`) before they are moved
  apart, and polygons and lines have a skin of 10 mm. Here ten of its units are a metre, which
  leaves a tenth of both, and polygons and walls are drawn back by their skin. So corners are
  rounded by 1 mm.
- Free robots go straight on in a control step, and the floor's torque does not know of its force,
  as in `pymunk_peer.py`.
- Sensors: its queries call Python back for each shape. S1 and S3 are left out.
- Nothing is recorded, and contacts are not reported. It counts in 32 bits.

What was set, and how: 8 iterations for velocities and 3 for positions, which its manual
recommends; no sleep, no bullets. A friction joint ties each robot to a kinematic body with the
velocity that it is told, and each crate to the ground; ropes are rope joints. The friction of a
contact is the root of a product, so each body has the square of its coefficient. Robots that touch
nothing, and whose rope is slack, get their velocity at once at each control step. It has no batch
access: all is read and set by attributes.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

import Box2D
import numpy as np
from peer import Engine, Float, main, scenes

UNIT = 10.0
"""Its units of length in a metre."""

SKIN = Box2D.b2_polygonRadius
"""How far before their outlines polygons and lines begin, in its units."""

CENTRES = {"localAnchorA": (0, 0), "localAnchorB": (0, 0), "collideConnected": True}
"""What all joints have: they hold the centres of bodies that may touch each other."""


class Box2d(Engine):
    """A scene in Box2D."""

    SUBSTEPS: ClassVar[dict[str, int]] = {
        "S2": 23, "S4": 28, "P1": 17, "P2": 28, "P3": 15,
    }  # fmt: skip

    def build(self) -> None:
        scene = self.scene
        self._world = world = Box2D.b2World(gravity=(0, 0), doSleep=False)
        ground = self._ground()
        self._robots = [
            self._body(pose, scene.radius, disc=not scene.square) for pose in scene.poses.tolist()
        ]
        self._crates = [
            self._body(pose, scenes.BOX / 2, disc=False) for pose in scene.crates.tolist()
        ]
        self._controls = [world.CreateKinematicBody() for _ in self._robots]
        for k, (control, robot) in enumerate(zip(self._controls, self._robots, strict=True)):
            robot.userData = k
            self._hold(control, robot, scenes.FORCE, scenes.TORQUE)
        force = scenes.FLOOR * scenes.MASS * scenes.GRAVITY
        for crate in self._crates:
            self._hold(ground, crate, force, force * scenes.LEVER)
        self._ropes = [
            (i, self._rope(self._robots[i], self._crates[k], length))
            for i, k, length in scene.ropes
        ]

    def _ground(self) -> Any:
        """Add walls and boxes, and return the body that they belong to."""
        ground = self._world.CreateStaticBody()
        corners = np.array(self.scene.walls) * (UNIT + 2 * SKIN / self.scene.side)
        ends = zip(corners.tolist(), np.roll(corners, -1, axis=0).tolist(), strict=True)
        shapes = [Box2D.b2EdgeShape(vertices=[*pair]) for pair in ends]
        for box in np.array(self.scene.boxes).reshape(-1, 4, 2):
            centre = box.mean(axis=0)
            drawn = UNIT * centre + (UNIT - 2 * SKIN / scenes.BOX) * (box - centre)
            shapes.append(Box2D.b2PolygonShape(vertices=drawn.tolist()))
        for shape in shapes:
            ground.CreateFixture(shape=shape, friction=scenes.WALL_FRICTION**2)
        return ground

    def _body(self, pose: Sequence[float], half: float, *, disc: bool) -> Any:
        """Add a disc of radius `half`, or a square of twice that side."""
        (x, y, theta), half = pose, half * UNIT
        body = self._world.CreateDynamicBody(position=(x * UNIT, y * UNIT), angle=theta)
        if disc:
            shape = Box2D.b2CircleShape(radius=half)
        else:
            shape = Box2D.b2PolygonShape(box=(half - SKIN, half - SKIN))
        body.CreateFixture(shape=shape, density=1.0, friction=scenes.FRICTION**2)
        moment = scenes.MASS * half**2 * (1 / 2 if disc else 2 / 3)
        body.massData = Box2D.b2MassData(mass=scenes.MASS, I=moment, center=(0, 0))
        return body

    def _hold(self, by: Any, body: Any, force: float, torque: float) -> None:
        """Let a body follow the velocity of another by a joint of bounded force and torque."""
        self._world.CreateFrictionJoint(
            bodyA=by, bodyB=body, maxForce=force * UNIT, maxTorque=torque * UNIT**2, **CENTRES
        )

    def _rope(self, a: Any, b: Any, length: float) -> Any:
        return self._world.CreateRopeJoint(bodyA=a, bodyB=b, maxLength=length * UNIT, **CENTRES)

    def move(self, command: Float) -> None:
        v, omega = command
        angle = np.array([robot.angle for robot in self._robots])
        middle = angle + omega * (self.scene.sampling_time / 2)
        held = self._held()
        told = zip(
            (UNIT * v * np.cos(middle)).tolist(),
            (UNIT * v * np.sin(middle)).tolist(),
            omega.tolist(),
            strict=True,
        )
        for k, (vx, vy, spin) in enumerate(told):
            control = self._controls[k]
            control.linearVelocity, control.angularVelocity = (vx, vy), spin
            if k not in held:
                robot = self._robots[k]
                robot.linearVelocity, robot.angularVelocity = (vx, vy), spin
        step, h = self._world.Step, self.scene.sampling_time / self.substeps
        for _ in range(self.substeps):
            step(h, 8, 3)

    def _held(self) -> set[int]:
        """Return the robots that touch something, or pull a rope: those that forces move."""
        held = {i for i, rope in self._ropes if rope.limitState}
        for contact in self._world.contacts:
            if contact.touching:
                held.add(contact.fixtureA.body.userData)
                held.add(contact.fixtureB.body.userData)
        return held

    def poses(self) -> Float:
        bodies = [*self._robots, *self._crates]
        rows = np.array([(*body.position, body.angle) for body in bodies])
        return rows / (UNIT, UNIT, 1.0)

    def near(self) -> Sequence[bool]:
        raise NotImplementedError("S1 is left out")

    def ranges(self) -> Sequence[Any]:
        raise NotImplementedError("S3 is left out")


if __name__ == "__main__":
    main(Box2d)
