"""Pursuit by Voronoi cells, a model answer: several pursuers, each at its own edge of the cell.

1. The evader's cell is what it reaches before a pursuer that is as quick. Its ground shrinks from
   25.0 to 3.3 square metres while it runs along the walls, and grows in 28 % of the time.
2. At equal speeds the bound is 0. The cell grows in 3 % of the time, when the pursuer has to turn.
   The evader is caught after 46 s, with 1.9 square metres left.
3. Of 30 starts at random none led to a capture at 0.77 of the evader's speed, 13 did at 0.78, 22 at
   0.79, all at 0.85. Below that the pursuer, too, ends up in a cycle.
4. An edge to each pursuer bounds the cell, so the rates add up, and the law is the same for each
   one: the middle of its own edge. At 0.8 two pursuers need 49 s, three and four 33 s, where one
   needs 96 s; at 0.7 three are needed at least, and at 0.6 four need 48 s.
"""

from math import dist

import numpy as np

from mars2d import Prediction
from mars2d.addons import Game
from mars2d.geometry import Tessellation
from mars2d.scenario import open_module

base = open_module("pursuit_voronoi")


def scenario(ratio: float = 0.8, hunters: int = 3):
    given = base.scenario(ratio)
    red, blue = given.robots
    names = ["red", "orange", "purple", "brown"][:hunters]
    team = [red.replace(name=name).at(1, 2 - i) for i, name in enumerate(names)]
    return given.replace(
        robots=[*team, blue],
        addons=[given.addons[0], Game({"pursuer": names, "evader": ["blue"]})],
        animation=given.animation.replace(base_colors=[*names, "blue"]),
    )


def checks(record):
    n, region = len(record.scenario.robots) - 1, record.scenario.workspace
    grown = 0.0
    for start, end in zip(record.pose[:-1, :2], record.pose[1:, :2], strict=True):
        cells, moved = Tessellation((start + end) / 2, region), end - start
        for i in cells.neighbours(n):
            edge = cells.edge(i, n)
            to = np.mean(edge, axis=0)[:, None] - cells.points
            part = dist(*edge) / dist(cells.points[:, i], cells.points[:, n])
            grown += part * (to[:, n] @ moved[:, n] - to[:, i] @ moved[:, i])
    first, last = (Tessellation(pose[:2], region).areas[n] for pose in record.pose[[0, -1]])
    yield Prediction("evader's cell in the end", first + grown, last, 0.02, "m^2")
    outcome = record.scenario.addons[1].outcome(record)
    yield Prediction("captures", 1, len(outcome.captures), 0)
