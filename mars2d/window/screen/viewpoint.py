"""From where the picture is seen: fitted to the workspace, moved by a person, or following."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from math import exp, hypot, log

import numpy as np
import pygame

from mars2d.core.plane import Point
from mars2d.output.layers.bodies import bounding_circle
from mars2d.output.raster.camera import FARTHEST, NEAREST, Camera
from mars2d.output.raster.layout import Bounds, Layout, fitted
from mars2d.record.frame import Float, Frame
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario

WHEEL_FACTOR = 1.15
REST = 0.12
"""The camera counts as moving for this long after its last move, seconds."""
MAX_ZOOM, MIN_ZOOM = 400.0, 0.05
"""The range of the scale, in multiples of that at which the workspace fits."""

PULL = 7.0
"""How quickly the camera approaches its aim, 1/s."""
MARGIN, MIN_MARGIN = 0.16, 0.03
"""The room round a team after the camera has moved, and the room at which the camera moves again,
in shares of the picture."""
SMALL = 0.5
"""The camera zooms in when a team takes less than this share of the room that it could fill."""
MIN_DIAMETERS = 10.0
"""The smallest view of a team, in diameters of its largest robot."""
STILL = 0.05
"""The camera rests when it is off by less, in pixels and shares of the scale."""


class Viewpoint:
    """The camera of a window, and how it moves.

    layout: where the picture lies; `arrange` changes it. bounds: what is fitted into it, metres,
    such as all that a recorded run needs; None for those of the scenario.
    """

    def __init__(self, scenario: Scenario, layout: Layout, bounds: Bounds | None = None) -> None:
        """Show the whole workspace."""
        self.layout = layout
        self.following: Follow | None = None
        self.bounds = bounds
        self._scenario = scenario
        self._fits = True
        self._room = layout.plot
        self._hurry = 0.0
        self.camera = self._fitted()

    @property
    def room(self) -> pygame.Rect:
        """The part of the picture in which the workspace is seen, beside all panels."""
        return self._room

    @property
    def seen(self) -> pygame.Rect:
        """Where the workspace is seen, pixels."""
        xmin, xmax, ymin, ymax = self.bounds or self._scenario.bounds
        corners = self.camera.to_pixels([(xmin, ymax), (xmax, ymin)])
        (left, top), (right, bottom) = corners.tolist()
        return pygame.Rect(left, top, right - left, bottom - top)

    @property
    def makes_room(self) -> bool:
        """Whether the workspace is seen beside panels, which cover none of it."""
        return self._fits and self._room != self.layout.plot

    @property
    def hurried(self) -> bool:
        """Whether the camera is moving."""
        return time.perf_counter() < self._hurry

    def point_at(self, pixel: tuple[int, int]) -> Point:
        """Return the point [m] that is seen at a pixel."""
        ((x, y),) = self.camera.to_world([pixel]).tolist()
        return x, y

    def arrange(self, layout: Layout, scenario: Scenario, room: pygame.Rect | None = None) -> None:
        """Change the layout. The view stays in place, or fitted to the workspace if it was.

        room: the part of the picture in which the workspace is seen, if panels stand beside it.
        """
        room = layout.plot if room is None else room
        before, self.layout = self.layout, layout
        same = scenario.bounds == self._scenario.bounds and room == self._room
        self._room = room
        self._scenario = scenario
        if self._fits and not (same and layout == before):
            self.fit()
        elif layout != before:
            old, new = before.plot.center, layout.plot.center
            self.camera = self.camera.panned(new[0] - old[0], new[1] - old[1])

    def fit(self, scenario: Scenario | None = None) -> None:
        """Show the whole workspace; scenario: replaces the present one."""
        self._scenario = scenario or self._scenario
        self._fits, self.following = True, None
        self.camera = self._fitted()

    def look_as(self, other: Viewpoint) -> None:
        """Look at the same place as another viewpoint, at the same scale."""
        if other._fits:
            self.fit()
            return
        self.following = None
        (x, y), (u, v) = other.layout.plot.center, self.layout.plot.center
        self._fits, self.camera = False, other.camera.panned(u - x, v - y)

    def zoom(self, notches: float, pixel: tuple[int, int]) -> None:
        """Zoom about a pixel by notches of the mouse wheel."""
        fit = self._fitted().scale
        wanted = self.camera.scale * WHEEL_FACTOR**notches
        wanted = min(max(wanted, MIN_ZOOM * fit), MAX_ZOOM * fit)
        self._look(self.camera.zoomed(pixel, wanted / self.camera.scale))

    def pan(self, dx: int, dy: int) -> None:
        """Move the picture by pixels, and stop following."""
        self.following = None
        self._look(self.camera.panned(dx, dy))

    def follow(self, body: int | None) -> None:
        """Follow a body, or all robots if it is None; stop if something is followed already."""
        self.following = Follow(body) if self.following is None else None

    def step(self, frame: Frame, seconds: float) -> None:
        """Move the camera after the followed bodies, for seconds of the wall clock."""
        if self.following is not None:
            camera = self.following.camera(self.camera, frame, self._room, seconds)
            if camera != self.camera:
                self._look(camera)

    def keep(self, frame: Frame, robots: Sequence[int]) -> None:
        """Move the picture as far as robots, such as those that people drive, would leave it."""
        if not robots:
            return
        low, high = _round([frame.scenario.robots[i] for i in robots], frame.pose.T[[*robots]])
        (left, top), (right, bottom) = self.camera.to_pixels([(low[0], high[1]), (high[0], low[1])])
        room = self._room
        dx = max(room.left - left, 0.0) + min(room.right - max(right, left + 1), 0.0)
        dy = max(room.top - top, 0.0) + min(room.bottom - max(bottom, top + 1), 0.0)
        if dx or dy:
            self._look(self.camera.panned(dx, dy))

    def _look(self, camera: Camera) -> None:
        """Set a camera other than that of the whole workspace."""
        self._fits = False
        self.camera = camera
        self._hurry = time.perf_counter() + REST

    def _fitted(self) -> Camera:
        """Return the camera that shows the workspace beside the panels."""
        bounds = self.bounds or self._scenario.bounds
        return fitted(bounds, self.layout.size, replace(self.layout, plot=self._room))


def wheel_notches(event: pygame.Event) -> float:
    """Return how far the wheel was turned, notches."""
    return float(getattr(event, "precise_y", event.y))


class Follow:
    """Moves a camera so that it keeps a body, or all robots, in view.

    A body is kept in the middle, at the camera's scale. A team may roam in the picture; the camera
    moves when a robot comes near the edge or the team has become small.

    target: an index of `Scenario.bodies`, None for the team.
    """

    def __init__(self, target: int | None) -> None:
        """Start with nothing aimed at."""
        self.target = target
        self._begins = True
        self._aim: Float | None = None  # middle and logarithm of the scale
        self._off = np.zeros(3)  # how far the camera is from it

    def camera(self, camera: Camera, frame: Frame, plot: pygame.Rect, dt: float) -> Camera:
        """Return the camera after dt seconds of the wall clock; the same object if it rests.

        plot: the visible part of the surface.
        """
        middle = _middle(camera, plot)
        if self.target is None:
            self._look_after_team(camera, frame, plot)
        else:
            self._aim = np.array([*frame.body_pose(self.target)[:2], middle[2]])
        if self._aim is None:
            return camera
        if self._begins:
            self._begins, self._off = False, middle - self._aim
        self._off *= exp(-PULL * dt)
        wanted = self._aim + self._off
        dx, dy, zoom = (wanted - middle).tolist()
        if (
            max(hypot(dx, dy), hypot(*self._off[:2])) * camera.scale < STILL
            and abs(zoom) < STILL / 50
        ):
            self._aim = None
            return camera
        scale = camera.scale  # unchanged to the last bit, so that drawings can be reused
        if self.target is None:
            scale = min(exp(float(wanted[2])), NEAREST)
        x, y = wanted[:2].tolist()
        return Camera(scale, plot.centerx - scale * x, plot.centery + scale * y)

    def _look_after_team(self, camera: Camera, frame: Frame, plot: pygame.Rect) -> None:
        """Aim at the team, unless it is well in view."""
        low, high = _box(frame)
        size = np.array(plot.size)
        fit = float(np.min((1 - 2 * MARGIN) * size / (high - low)))
        fit = min(max(fit, FARTHEST), NEAREST)
        corners = camera.to_pixels([(low[0], high[1]), (high[0], low[1])]) - plot.topleft
        room = MIN_MARGIN * size
        seen = (corners[0] >= room).all() and (corners[1] <= size - room).all()
        begins = self._begins and self._aim is None
        if begins or not seen or camera.scale < SMALL * fit:
            self._begins, self._aim = True, np.array([*(low + high) / 2, log(fit)])


def _box(frame: Frame) -> tuple[Float, Float]:
    """Return the lower and upper corner (2,) of a box of some least size round all robots."""
    robots = frame.scenario.robots
    low, high = _round(robots, frame.pose.T)
    widest = 2 * max(robot.chassis.bound[1] for robot in robots)
    short = np.maximum(MIN_DIAMETERS * widest - (high - low), 0.0) / 2
    return low - short, high + short


def _round(robots: Sequence[Robot], poses: Float) -> tuple[Float, Float]:
    """Return the lower and upper corner (2,) of the box round robots at poses (k, 3)."""
    circles = [
        bounding_circle(robot.chassis, pose) for robot, pose in zip(robots, poses, strict=True)
    ]
    centers = np.array([center for center, _ in circles])
    radii = np.array([radius for _, radius in circles])[:, None]
    return (centers - radii).min(axis=0), (centers + radii).max(axis=0)


def _middle(camera: Camera, plot: pygame.Rect) -> Float:
    """Return the point [m] in the middle of the picture, and the logarithm of the scale."""
    ((x, y),) = camera.to_world([plot.center]).tolist()
    return np.array([x, y, log(camera.scale)])
