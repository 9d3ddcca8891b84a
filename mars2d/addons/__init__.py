"""What can be added to an experiment: maps, measures, games."""

from mars2d.addons.base import HOOKS, Addon
from mars2d.addons.map import Map

__all__ = ["HOOKS", "Addon", "Map"]
