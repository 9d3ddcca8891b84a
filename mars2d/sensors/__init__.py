"""What robots perceive: the virtual sensors."""

from mars2d.sensors.base import Sensor, Surroundings
from mars2d.sensors.proximity import Proximity

__all__ = ["Proximity", "Sensor", "Surroundings"]
