"""A bare pymunk loop: the cost of the engine alone, by which two machines are compared."""

from __future__ import annotations

import numpy as np
import pymunk
from numpy.typing import NDArray
from pymunk import batch
from scenes import FORCE, FRICTION, MASS, TORQUE, WALL_FRICTION, Scene

Float = NDArray[np.float64]


class Bare:
    """A scene's robots in pymunk alone; each call does one control step.

    The law `Turns` drives them through joints with batch access, in a fixed number of equal
    substeps, without sensors, checks or recording.
    """

    def __init__(self, scene: Scene, substeps: int = 1) -> None:
        """Build the scene. substeps: in each control step."""
        self._n = n = len(scene.poses)
        self._law, self._iteration = scene.law(), 0
        self._substeps, self._h = substeps, scene.sampling_time / substeps
        self._space = space = pymunk.Space()
        space.collision_slop, space.iterations = 1e-4, 15
        bodies = [self._robot(pose, scene.radius) for pose in scene.poses.tolist()]
        for body in bodies:
            self._drive(body)
        self._build_obstacles(scene)
        self._index = {body.id: i for i, body in enumerate(bodies)}
        self._state, self._arbiters, self._out = batch.Buffer(), batch.Buffer(), batch.Buffer()
        self._velocity = np.zeros((2 * n + 1, 3))  # of robots, what drives them, and obstacles
        self._out.set_float_buf(self._velocity)

    def _robot(self, pose: list[float], radius: float) -> pymunk.Body:
        body = pymunk.Body(MASS, MASS * radius**2 / 2)
        body.position, body.angle = (pose[0], pose[1]), pose[2]
        disc = pymunk.Circle(body, radius)
        disc.friction = FRICTION
        self._space.add(body, disc)
        return body

    def _drive(self, body: pymunk.Body) -> None:
        """Let a body follow a kinematic one by joints of bounded force."""
        control = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
        pivot = pymunk.PivotJoint(control, body, (0, 0), (0, 0))
        gear = pymunk.GearJoint(control, body, 0, 1)
        pivot.max_bias = gear.max_bias = 0
        pivot.max_force, gear.max_force = FORCE, TORQUE
        self._space.add(control, pivot, gear)

    def _build_obstacles(self, scene: Scene) -> None:
        fixed = pymunk.Body(body_type=pymunk.Body.STATIC)
        self._space.add(fixed)
        ends = zip(scene.walls, [*scene.walls[1:], scene.walls[0]], strict=True)
        walls = [pymunk.Segment(fixed, a, b, 0) for a, b in ends]
        for shape in (*walls, *(pymunk.Poly(fixed, box) for box in scene.boxes)):
            shape.friction, shape.elasticity = WALL_FRICTION, 1.0
            self._space.add(shape)

    @property
    def pose(self) -> Float:
        """The poses (3, n): x, y [m], theta [rad]."""
        return self._read()[:, :3].T.copy()

    def __call__(self) -> None:
        """Do one control step."""
        v, omega = self._law(self._iteration)
        self._iteration += 1
        length = v * np.sinc(omega * self._h / 2 / np.pi)
        for _ in range(self._substeps):
            self._substep(length, omega, self._h)

    def _read(self) -> Float:
        """Return the robots' states (n, 6): pose, then velocity."""
        fields = batch.BodyFields
        everything = fields.POSITION | fields.ANGLE | fields.VELOCITY | fields.ANGULAR_VELOCITY
        self._state.clear()
        batch.get_space_bodies(self._space, everything, self._state)
        return np.frombuffer(self._state.float_buf())[: 6 * self._n].reshape(self._n, 6)

    def _substep(self, length: Float, omega: Float, h: float) -> None:
        n, velocity, state = self._n, self._velocity, self._read()
        theta, spin = state[:, 2], omega.copy()
        now = theta + omega * (h / 2)
        velocity[:n, 0], velocity[:n, 1] = length * np.cos(now), length * np.sin(now)
        velocity[:n, 2] = omega
        self._arbiters.clear()
        ids = batch.ArbiterFields.BODY_A_ID | batch.ArbiterFields.BODY_B_ID
        batch.get_space_arbiters(self._space, ids, self._arbiters)
        for address in np.frombuffer(self._arbiters.int_buf(), dtype=np.int64).tolist():
            i = self._index.get(address)
            if i is not None:  # a robot in contact keeps the velocity that the solver found
                velocity[i] = state[i, 3:]
                spin[i] = state[i, 5]
        then = theta + spin * h + omega * (h / 2)
        driving = velocity[n : 2 * n]
        driving[:, 0], driving[:, 1] = length * np.cos(then), length * np.sin(then)
        driving[:, 2] = omega
        fields = batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY
        batch.set_space_bodies(self._space, fields, self._out)
        self._space.step(h)
