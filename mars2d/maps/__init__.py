"""Outlines from files: drawings, occupancy grids, images, shapes of the world."""

from mars2d.maps.describe import described
from mars2d.maps.drawing import Drawing, Piece
from mars2d.maps.obstacles import TOLERANCE, Obstacles, obstacles
from mars2d.maps.reading import SUFFIXES, advice, read
from mars2d.maps.room import nearest_room

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
