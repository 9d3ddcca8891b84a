"""The contents of ROS messages, as trees of their fields; they know nothing of ROS itself.

Fields and units follow the message definitions of ROS 2, such as those of geometry_msgs and
sensor_msgs; frames follow REP 103 and REP 105.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin
from typing import Any

from numpy.typing import NDArray

from mars2d.sensors.base import Fan

Tree = dict[str, Any]
Triple = Sequence[float]

WORLD = "odom"
"""The frame in which robots move."""


def _stamp(time: float) -> Tree:
    seconds, nanoseconds = divmod(round(time * 1e9), 10**9)
    return {"sec": seconds, "nanosec": nanoseconds}


def _header(time: float, frame: str) -> Tree:
    return {"stamp": _stamp(time), "frame_id": frame}


def _vector(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Tree:
    return {"x": float(x), "y": float(y), "z": float(z)}


def _turned(theta: float) -> Tree:
    return {"x": 0.0, "y": 0.0, "z": sin(theta / 2), "w": cos(theta / 2)}


def clock(time: float) -> Tree:
    """Return a rosgraph_msgs/Clock of a simulated time, seconds."""
    return {"clock": _stamp(time)}


def transform(time: float, parent: str, child: str, pose: Triple) -> Tree:
    """Return a geometry_msgs/TransformStamped. pose: x, y [m], theta [rad] of child in parent."""
    x, y, theta = pose
    return {
        "header": _header(time, parent),
        "child_frame_id": child,
        "transform": {"translation": _vector(x, y), "rotation": _turned(theta)},
    }


def odometry(time: float, robot: str, pose: Triple, velocity: Triple) -> Tree:
    """Return a nav_msgs/Odometry. pose: in the world. velocity: (x', y', theta') in the world.

    The twist is in the robot's frame. Both are exact, and their covariances zero.
    """
    x, y, theta = pose
    vx, vy, omega = velocity
    c, s = cos(theta), sin(theta)
    return {
        "header": _header(time, WORLD),
        "child_frame_id": robot,
        "pose": {
            "pose": {"position": _vector(x, y), "orientation": _turned(theta)},
            "covariance": [0.0] * 36,
        },
        "twist": {
            "twist": {
                "linear": _vector(c * vx + s * vy, c * vy - s * vx),
                "angular": _vector(z=omega),
            },
            "covariance": [0.0] * 36,
        },
    }


def scan(time: float, frame: str, fan: Fan, ranges: NDArray[Any], period: float) -> Tree:
    """Return a sensor_msgs/LaserScan. period: the time between two scans, seconds."""
    angles = fan.angles
    return {
        "header": _header(time, frame),
        "angle_min": float(angles[0]),
        "angle_max": float(angles[-1]),
        "angle_increment": float(angles[1] - angles[0]) if len(angles) > 1 else 0.0,
        "time_increment": 0.0,
        "scan_time": float(period),
        "range_min": 0.0,
        "range_max": float(fan.range),
        "ranges": [float(each) for each in ranges],
        "intensities": [],
    }


def fill(message: Any, tree: Tree) -> Any:
    """Set the fields of a message of ROS, and return it."""
    for name, value in tree.items():
        if isinstance(value, dict):
            fill(getattr(message, name), value)
        else:
            setattr(message, name, value)
    return message
