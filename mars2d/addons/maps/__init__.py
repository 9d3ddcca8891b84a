"""Outlines from files: drawings, occupancy grids, images, shapes of the world."""

from mars2d.addons.maps.describe import described
from mars2d.addons.maps.drawing import Drawing, Piece
from mars2d.addons.maps.obstacles import TOLERANCE, Obstacles, obstacles
from mars2d.addons.maps.reading import SUFFIXES, advice, read
from mars2d.addons.maps.room import nearest_room

__all__ = [
    "SUFFIXES",
    "TOLERANCE",
    "Drawing",
    "Obstacles",
    "Piece",
    "advice",
    "described",
    "nearest_room",
    "obstacles",
    "read",
]
