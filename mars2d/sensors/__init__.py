"""The sensors of robots. A new one is a file here, and a line below."""

from mars2d.core.quantity import ANGLE, COLOR, DISTANCE, FLAG, NUMBER, Quantity
from mars2d.sensors.base import Sensor, Sighting
from mars2d.sensors.beacon import Beacon
from mars2d.sensors.bumper import Bumper
from mars2d.sensors.ground import Ground
from mars2d.sensors.imu import Imu
from mars2d.sensors.line_camera import LineCamera
from mars2d.sensors.odometry import Odometry
from mars2d.sensors.pose import Pose
from mars2d.sensors.proximity import Proximity
from mars2d.sensors.range_bearing import RangeBearing
from mars2d.sensors.range_finder import RangeFinder
from mars2d.sensors.sonar_ring import SonarRing
from mars2d.sensors.surroundings import Surroundings

__all__ = [
    "ANGLE",
    "COLOR",
    "DISTANCE",
    "FLAG",
    "NUMBER",
    "Beacon",
    "Bumper",
    "Ground",
    "Imu",
    "LineCamera",
    "Odometry",
    "Pose",
    "Proximity",
    "Quantity",
    "RangeBearing",
    "RangeFinder",
    "Sensor",
    "Sighting",
    "SonarRing",
    "Surroundings",
]
