"""What a drag of the mouse does to a body: pull it while time passes, else move or turn it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import atan2, cos, hypot, pi, sin
from typing import Literal

import numpy as np

from mars2d.bodies.rigid import Rigid, Triple
from mars2d.core.plane import Point
from mars2d.core.scene import Scene, faded
from mars2d.output.layers.bodies import bounding_circle, draw_prop, draw_robot
from mars2d.output.layers.forces import FORCE, in_newtons
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.theme import LIGHT
from mars2d.record.frame import Frame
from mars2d.scenario.changes import obstruction
from mars2d.scenario.scenario import Scenario
from mars2d.window.panels.readout import holding_force, in_both_units
from mars2d.world.world import World

Act = Callable[[World], None]
"""Something that is done to a world."""

PULL_ACCELERATION = 10.0
"""How strongly a pull accelerates a body, after it has overcome the resistance, m/s^2."""
MAX_PULL_SPEED = 5.0
"""m/s."""

GOOD, BAD = LIGHT.selected, LIGHT.error.ink
HALO = "#ffffff"
LABEL = 13.0
"""The size of labels, points."""


def pull_of(scenario: Scenario, body: int) -> tuple[float, float]:
    """Return the largest force [N] and speed [m/s] with which the mouse pulls a body.

    They overcome the body's drive or the floor, and cross the workspace in a few seconds.
    """
    xmin, xmax, ymin, ymax = scenario.bounds
    speed = 0.2 * max(xmax - xmin, ymax - ymin)
    if body < len(scenario.robots):
        speed = max(speed, 1.5 * scenario.robots[body].drive.max_linear_speed)
    force = 1.5 * holding_force(scenario, body)
    force += PULL_ACCELERATION * scenario.bodies[body].inertia.mass
    return force, min(speed, MAX_PULL_SPEED)


class Drag:
    """A drag of a body that has begun. do: does something to the world, and returns if it could.

    keeps: whether a drag that is cancelled ends as if it were released.
    """

    keeps = False

    def __init__(self, do: Callable[[Act], bool], body: int) -> None:
        self._do, self.body = do, body

    def move(self, frame: Frame, point: Point) -> None:
        """Move the pointer to a point [m]."""
        raise NotImplementedError

    def end(self) -> None:
        """Release the body."""
        raise NotImplementedError

    def draw(self, scene: Scene, frame: Frame, camera: Camera) -> None:
        """Draw what is dragged."""
        raise NotImplementedError


class Pull(Drag):
    """Pulls a body by a spring from the point where it was gripped to the pointer."""

    keeps = True

    def __init__(
        self, do: Callable[[Act], bool], scenario: Scenario, body: int, grip: Point, target: Point
    ) -> None:
        super().__init__(do, body)
        self.grip, self.target = within(scenario.bodies[body], grip), target
        self.force, self.speed = pull_of(scenario, body)
        self.newtons = 0.0
        self._world: World | None = None  # in which the body is pulled

    def move(self, frame: Frame, point: Point) -> None:  # noqa: ARG002
        """Pull towards a point."""
        self.target = point

        def pull(world: World) -> None:
            self._world = world
            world.operator.pull(self.body, self.grip, point, self.force, self.speed)
            self.newtons = world.operator.force(self.body)

        self._do(pull)

    def end(self) -> None:
        """Release the body in the world in which it is pulled: that makes no branch."""
        if self._world is not None and not self._world.over:
            self._world.operator.pull(self.body, self.grip, None)

    def draw(self, scene: Scene, frame: Frame, camera: Camera) -> None:
        """Draw the spring and its force."""
        start = world_point(frame.body_pose(self.body), self.grip)
        draw_ring(scene, frame, self.body, GOOD, 2.0)
        scene.line([start, self.target], stroke=HALO, width=5.0)
        scene.line([start, self.target], stroke=FORCE, width=2.5)
        for point in (start, self.target):
            scene.circle(point, 0.0, fill=FORCE, stroke=HALO, width=1.5, pixels=3.5)
        if self.newtons > 0.005:
            draw_words(scene, camera, self.target, in_newtons(self.newtons))


class Placement(Drag):
    """Moves a body while time stands still, or turns it; at the end it gets its new pose.

    turns: whether it is turned towards the pointer. now: the pose at the pointer.
    """

    def __init__(
        self, do: Callable[[Act], bool], frame: Frame, body: int, point: Point, *, turns: bool
    ) -> None:
        super().__init__(do, body)
        self._turns = turns
        self.before = self.now = frame.body_pose(body)
        self._start = self._pointer = point

    def move(self, frame: Frame, point: Point) -> None:  # noqa: ARG002
        """Move the body by as much as the pointer, or turn it there the shorter way round."""
        x, y, theta = self.before
        self._pointer = point
        if self._turns:
            angle = atan2(point[1] - y, point[0] - x)
            self.now = x, y, theta + (angle - theta + pi) % (2 * pi) - pi
        else:
            self.now = x + point[0] - self._start[0], y + point[1] - self._start[1], theta

    def end(self) -> None:
        """Place the body, if its pose has changed."""
        if self.now != self.before:
            self._do(lambda world: world.operator.place(self.body, self.now))

    def draw(self, scene: Scene, frame: Frame, camera: Camera) -> None:
        """Draw the former place, and the new one with why the body can't stay there."""
        scenario, n = frame.scenario, len(frame.scenario.robots)
        there = with_pose(frame, self.body, self.now)
        fault = obstruction(scenario, there.all_poses, self.body)
        color = BAD if fault else GOOD
        draw_ring(scene, there, self.body, color, 2.5)
        words = f"would {fault}" if fault else self.words()
        draw_label(scene, there, camera, self.body, words, color, "below")  # names are above
        (x, y, theta), ghost = self.now, np.array(self.before)
        if self._turns:
            way = hypot(self._pointer[0] - x, self._pointer[1] - y)
            end = x + way * cos(theta), y + way * sin(theta)
            scene.line([(x, y), end], stroke=faded(color, 0.7), width=1.5)
            scene.circle(end, 0.0, fill=color, stroke=HALO, width=1.5, pixels=3.5)
            return
        if self.body < n:
            draw_robot(scene, scenario.robots[self.body], ghost, None, faded(color, 0.6))
        else:
            draw_prop(scene, scenario.props[self.body - n], ghost, color, hollow=True)
        scene.line([self.before[:2], (x, y)], stroke=faded(color, 0.5), width=1.2)

    def words(self) -> str:
        """Return the new heading, or the new position."""
        x, y, theta = self.now
        if self._turns:
            return in_both_units((theta + pi) % (2 * pi) - pi)
        return f"({x:.2f}, {y:.2f}) m".replace("-", "\N{MINUS SIGN}")


# -- poses and points -------------------------------------------------------------------------


def with_pose(frame: Frame, body: int, pose: Triple) -> Frame:
    """Return a frame with one body put at another pose."""
    robots, props, n = frame.pose.copy(), frame.prop_pose.copy(), frame.pose.shape[1]
    if body < n:
        robots[:, body] = pose
    else:
        props[:, body - n] = pose
    sensed = frame.pose if frame.sensed is None else frame.sensed
    leaps = (*frame.leaps, (len(frame.path), body))
    return replace(frame, pose=robots, prop_pose=props, sensed=sensed, leaps=leaps)


def local_point(frame: Frame, body: int, point: Point) -> Point:
    """Return a point [m] in a body's own frame."""
    x, y, theta = frame.body_pose(body)
    dx, dy, c, s = point[0] - x, point[1] - y, cos(theta), sin(theta)
    return c * dx + s * dy, c * dy - s * dx


def world_point(pose: Triple, local: Point) -> Point:
    """Return where a point of a body's own frame [m] is."""
    c, s = cos(pose[2]), sin(pose[2])
    return pose[0] + c * local[0] - s * local[1], pose[1] + s * local[0] + c * local[1]


def within(rigid: Rigid, point: Point) -> Point:
    """Return the point of a body's bounding circle nearest to a point, both in its frame."""
    (x, y), radius = rigid.shape.bound
    dx, dy = point[0] - x, point[1] - y
    share = min(1.0, radius / max(hypot(dx, dy), 1e-300))
    return x + share * dx, y + share * dy


# -- marks ------------------------------------------------------------------------------------


def draw_words(scene: Scene, camera: Camera, point: Point, text: str) -> None:
    """Write a text about a force above its tip."""
    place = point[0], point[1] + 9 / camera.scale
    scene.text(place, text, color=FORCE, size=LABEL, anchor="above", halo=HALO)


def draw_ring(
    scene: Scene, frame: Frame, body: int, color: str, width: float, far: float = 6.0
) -> None:
    """Draw a ring round a body; width: of its line, far: its least radius, points."""
    center, radius = bounding_circle(
        frame.scenario.bodies[body].shape, np.array(frame.body_pose(body))
    )
    for stroke, more in ((HALO, 2.0), (color, 0.0)):
        scene.circle(center, radius, stroke=stroke, width=width + more, pixels=far)


def draw_label(
    scene: Scene,
    frame: Frame,
    camera: Camera,
    body: int,
    text: str,
    color: str,
    side: Literal["above", "below"] = "above",
) -> None:
    """Write a text above or below the ring round a body."""
    shape, pose = frame.scenario.bodies[body].shape, np.array(frame.body_pose(body))
    (x, y), radius = bounding_circle(shape, pose)
    off = radius + 12 / camera.scale
    place = x, y + off if side == "above" else y - off
    scene.text(place, text, color=color, size=LABEL, anchor=side, halo=HALO)
