"""From where the picture is seen: fitted to the workspace, moved by a person, or following."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from math import exp, hypot

import numpy as np
import pygame

from mars2d.core.plane import Point
from mars2d.output.layers.bodies import bounding_circle
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.layout import Bounds, Layout, fitted
from mars2d.record.frame import Float, Frame
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario

Pair = Point | Float

WHEEL_FACTOR = 1.15
REST = 0.12
"""The camera counts as moving for this long after its last move, seconds."""
MAX_ZOOM, MIN_ZOOM = 400.0, 0.05
"""The range of the scale, in multiples of that at which the workspace fits."""

PULL = 7.0
"""How quickly the camera approaches what it follows, 1/s."""
STILL = 0.05
"""The camera rests when it is off by less, pixels."""
MARGIN, SMALL = 0.25, 0.33
"""The room on each side of a team that the camera shows anew, in parts of the team, and the share
of the picture below which the team is too small."""
MIN_DIAMETERS = 10.0
"""The smallest view of a team, in diameters of its largest robot."""


class Viewpoint:
    """The camera of a window, and how it moves.

    layout: where the picture lies; `arrange` changes it. bounds: what is fitted into it, metres,
    such as all that a recorded run needs; None for those of the scenario.
    """

    def __init__(self, scenario: Scenario, layout: Layout, bounds: Bounds | None = None) -> None:
        """Show the whole workspace."""
        self.layout = layout
        self.following = False
        self._target: int | None = None  # an index of `Scenario.bodies`; None for all robots
        self._off: Float | None = None  # how far the middle is from it, metres
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
        (left, top), (right, bottom) = self._corners((xmin, ymin), (xmax, ymax))
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
        self._fits, self.following = True, False
        self.camera = self._fitted()

    def look_as(self, other: Viewpoint) -> None:
        """Look at the same place as another viewpoint, at the same scale."""
        if other._fits:
            self.fit()
            return
        self.following = False
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
        self.following = False
        self._look(self.camera.panned(dx, dy))

    def follow(self, body: int | None) -> None:
        """Follow a body, or all robots if it is None; stop if something is followed already."""
        self.following, self._target, self._off = not self.following, body, None

    def step(self, frame: Frame, seconds: float) -> None:
        """Move the camera after what is followed, for seconds of the wall clock.

        A body is kept in the middle, at the camera's scale. All robots may roam in the picture, and
        are shown anew where one of them leaves it or they have become small.
        """
        if not self.following:
            return
        if self._target is None:
            self._show_team(frame)
            return
        aim = np.array(frame.body_pose(self._target)[:2])
        middle = np.array(self.point_at(self._room.center))
        self._off = (middle - aim if self._off is None else self._off) * exp(-PULL * seconds)
        dx, dy = (self.camera.scale * (middle - aim - self._off)).tolist()
        if hypot(dx, dy) >= STILL:
            self._look(self.camera.panned(dx, -dy))

    def _show_team(self, frame: Frame) -> None:
        robots, room = frame.scenario.robots, self._room
        low, high = _round(robots, frame.pose.T)
        least = 2 * MIN_DIAMETERS * max(robot.chassis.bound[1] for robot in robots)
        middle, half = (low + high) / 2, np.maximum(high - low, least) / 2
        (left, top), (right, bottom) = self._corners(low, high)
        share = (2 * half * self.camera.scale / room.size).max()
        outside = min(left - room.left, room.right - right, top - room.top, room.bottom - bottom)
        if outside < 0 or share < SMALL:
            far = (1 + 2 * MARGIN) * half
            (xmin, ymin), (xmax, ymax) = (middle - far).tolist(), (middle + far).tolist()
            self._look(self._fitted((xmin, xmax, ymin, ymax)))

    def keep(self, frame: Frame, robots: Sequence[int]) -> None:
        """Move the picture as far as robots, such as those that people drive, would leave it."""
        if not robots:
            return
        mine = [frame.scenario.robots[i] for i in robots]
        (left, top), (right, bottom) = self._corners(*_round(mine, frame.pose.T[[*robots]]))
        room = self._room
        dx = max(room.left - left, 0.0) + min(room.right - max(right, left + 1), 0.0)
        dy = max(room.top - top, 0.0) + min(room.bottom - max(bottom, top + 1), 0.0)
        if dx or dy:
            self._look(self.camera.panned(dx, dy))

    def _corners(self, low: Pair, high: Pair) -> tuple[Point, Point]:
        """Return the upper left and the lower right pixel of a box between two points [m]."""
        one, other = self.camera.to_pixels([(low[0], high[1]), (high[0], low[1])]).tolist()
        return tuple(one), tuple(other)

    def _look(self, camera: Camera) -> None:
        """Set a camera other than that of the whole workspace."""
        self._fits = False
        self.camera = camera
        self._hurry = time.perf_counter() + REST

    def _fitted(self, bounds: Bounds | None = None) -> Camera:
        """Return the camera that shows bounds [m], or else the workspace, beside the panels."""
        bounds = bounds or self.bounds or self._scenario.bounds
        return fitted(bounds, self.layout.size, replace(self.layout, plot=self._room))


def wheel_notches(event: pygame.Event) -> float:
    """Return how far the wheel was turned, notches."""
    return float(getattr(event, "precise_y", event.y))


def _round(robots: Sequence[Robot], poses: Float) -> tuple[Float, Float]:
    """Return the lower and upper corner (2,) of the box round robots at poses (k, 3)."""
    circles = [
        bounding_circle(robot.chassis, pose) for robot, pose in zip(robots, poses, strict=True)
    ]
    centers = np.array([center for center, _ in circles])
    radii = np.array([radius for _, radius in circles])[:, None]
    return (centers - radii).min(axis=0), (centers + radii).max(axis=0)
