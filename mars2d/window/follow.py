"""A camera that keeps a body in view, or the whole team."""

from __future__ import annotations

from math import exp, hypot, log

import numpy as np
import pygame

from mars2d.output.layers.forces import bounding_circle
from mars2d.output.raster.camera import FARTHEST, NEAREST, Camera
from mars2d.record.frame import Float, Frame

__all__ = ["Follow"]

PULL = 7.0
"""How quickly the camera comes to where it should be: 1/s, critically damped."""

LEASH = 0.3
"""A body that is in view gets at most so far off its middle, in shares of the picture."""

MARGIN = 0.16
"""The room round a team when the camera turns to it, in shares of the picture..."""
EDGE = 0.03
"""... and how little of it may be left before the camera turns to it again."""

SMALL = 0.5
"""A team that has shrunk to so little of what fits is looked at from nearer."""

CLOSEST = 10.0
"""A team is seen with so many of its largest diameters across, at least."""

STILL = 0.05
"""The camera rests when it is off by less, in pixels and shares of the scale."""


class Follow:
    """Moves a camera after a body, or so that all robots are seen.

    A body is kept in the middle, at the scale that the camera has. A team is let roam in the
    picture; the camera moves when a robot gets to the edge or the team has become small.

    target: an index of `Scenario.bodies`, None for the team.
    """

    def __init__(self, target: int | None) -> None:
        """Start at rest."""
        self.target = target
        self._speed = np.zeros(3)  # of the middle [m/s], and of the scale's logarithm [1/s]
        self._turning = True  # to what is not in view yet
        self._aim: Float | None = None  # of a team: middle and logarithm of the scale

    def camera(self, camera: Camera, frame: Frame, plot: pygame.Rect, dt: float) -> Camera:
        """Return where the camera is after dt seconds of the wall clock; itself when it rests.

        plot: the part of the surface that is seen.
        """
        middle, half = _middle(camera, plot), np.array(plot.size) / (2 * camera.scale)
        if self.target is None:
            self._look_after_team(camera, frame, plot)
            if self._aim is None:
                return camera
            aim = self._aim
        else:
            aim = np.array([*_position(frame, self.target), middle[2]])
        off = middle - aim
        moved, self._speed = _damped(off, self._speed, dt)
        if self.target is not None:
            leash = 2 * LEASH * half
            self._turning &= bool((np.abs(off[:2]) > leash).any())
            if not self._turning:
                moved[:2] = np.clip(moved[:2], -leash, leash)
        if _small(moved, camera.scale) and _small(self._speed / PULL, camera.scale):
            self._speed, self._aim = np.zeros(3), None
            return camera
        scale = camera.scale  # of a body to the last bit: what is drawn can be used again
        if self.target is None:
            scale = min(exp(float(aim[2] + moved[2])), NEAREST)
        x, y = (aim + moved)[:2].tolist()
        return Camera(scale, plot.centerx - scale * x, plot.centery + scale * y)

    def _look_after_team(self, camera: Camera, frame: Frame, plot: pygame.Rect) -> None:
        """Aim at the team as it is now, unless it is well seen."""
        low, high = _box(frame)
        size = np.array(plot.size)
        fit = float(np.min((1 - 2 * MARGIN) * size / (high - low)))
        fit = min(max(fit, FARTHEST), NEAREST)
        corners = camera.to_pixels([(low[0], high[1]), (high[0], low[1])]) - plot.topleft
        room = EDGE * size
        seen = (corners[0] >= room).all() and (corners[1] <= size - room).all()
        if self._turning or not seen or camera.scale < SMALL * fit:
            self._turning = False
            self._aim = np.array([*(low + high) / 2, log(fit)])


def _position(frame: Frame, body: int) -> tuple[float, float]:
    """Return where a body is now."""
    x, y = np.hstack([frame.pose, frame.prop_pose])[:2, body].tolist()
    return x, y


def _box(frame: Frame) -> tuple[Float, Float]:
    """Return the corners (2,) of a box round all robots, of some size at least."""
    circles = [
        bounding_circle(robot.chassis, pose)
        for robot, pose in zip(frame.scenario.robots, frame.pose.T, strict=True)
    ]
    centers = np.array([center for center, _ in circles])
    radii = np.array([radius for _, radius in circles])[:, None]
    low, high = (centers - radii).min(axis=0), (centers + radii).max(axis=0)
    short = np.maximum(CLOSEST * 2 * float(radii.max()) - (high - low), 0.0) / 2
    return low - short, high + short


def _damped(off: Float, speed: Float, dt: float) -> tuple[Float, Float]:
    """Return how far off and how fast a critically damped spring is after dt: exactly."""
    push, decay = speed + PULL * off, exp(-PULL * dt)
    return (off + push * dt) * decay, (speed - PULL * push * dt) * decay


def _small(off: Float, scale: float) -> bool:
    return hypot(off[0], off[1]) * scale < STILL and abs(float(off[2])) < STILL / 50


def _middle(camera: Camera, plot: pygame.Rect) -> Float:
    """Return what a camera has in the middle of the picture [m], and its scale's logarithm."""
    ((x, y),) = camera.to_world([plot.center]).tolist()
    return np.array([x, y, log(camera.scale)])
