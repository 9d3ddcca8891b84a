"""The add-ons: maps, measures, games, radio. A new one is a file here, and a line below."""

from mars2d.addons.base import HOOKS, Addon
from mars2d.addons.beacon import Beacon
from mars2d.addons.communication import Burst, Communication
from mars2d.addons.density import Density
from mars2d.addons.estimate import Estimate
from mars2d.addons.field_of_view import FieldOfView
from mars2d.addons.floor import Floor
from mars2d.addons.game import Game
from mars2d.addons.map import Map
from mars2d.addons.potential_field import PotentialField
from mars2d.addons.ring import Ring
from mars2d.addons.theory import Theory
from mars2d.addons.trails import Trails
from mars2d.addons.voronoi import Voronoi
from mars2d.addons.waypoints import Waypoints

__all__ = [
    "HOOKS",
    "Addon",
    "Beacon",
    "Burst",
    "Communication",
    "Density",
    "Estimate",
    "FieldOfView",
    "Floor",
    "Game",
    "Map",
    "PotentialField",
    "Ring",
    "Theory",
    "Trails",
    "Voronoi",
    "Waypoints",
]
