"""Maps from files: drawings, occupancy grids, images, geographic shapes."""

from mars2d.addons.maps.drawing import TOLERANCE, Drawing, Piece
from mars2d.addons.maps.obstacles import Obstacles, described, obstacles
from mars2d.addons.maps.reading import SUFFIXES, advice, read

__all__ = [
    "SUFFIXES",
    "TOLERANCE",
    "Drawing",
    "Obstacles",
    "Piece",
    "advice",
    "described",
    "obstacles",
    "read",
]
