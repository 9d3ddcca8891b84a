"""Isolated laws: each runs in a process of its own, behind a wall of the operating system.

In the match's process, `isolated` puts the laws on their robots, `process` asks one of them and
keeps its clock, and `observation` decides what a law may see. In the law's process, `child` runs
the law, `mirror_world` stands in for the world, and `jail` is the wall. `source` is the law's code.
"""

from mars2d.tournaments.isolation.isolated import Isolated, run_isolated
from mars2d.tournaments.isolation.limits import Limits, Verdict

__all__ = ["Isolated", "Limits", "Verdict", "run_isolated"]
