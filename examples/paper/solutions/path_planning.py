"""Model answer to the exercises of path_planning.

1. With (22, 9.8) the third arrives after 69.2 s, with (22.6, 9.8) after 67.1 s, with (24, 10) after
   78.9 s: it goes through the door as long as the straight line to the point does. With (20, 10) it
   comes to that point, and then the wall south of the store holds it at (21.55, 11.52).
2. The pull is k_p d* = 0.5 m/s. A wall's face at the distance rho pushes with
   eta (1/rho - 1/rho_0) / rho^2, its other face, 0.15 m farther, too: the sum is 0.5 m/s at
   rho = 0.239 m. With the radius of 0.2 m, the robot stands at 22 - 0.439 = 21.561, as measured.
3. The straight line to (26, 12.6) meets the wall below the middle, and y pulls down to 12.6, where
   the other arm repels: the corner is the lower one. (21.561, 12.811) is predicted, and
   (21.561, 12.813) measured.
4. On the axis of a door the posts push back with up to 0.2263 m/s, 0.16 m before the wall, if
   eta = 0.01 m^4/s. So at eta = 0.01 x 0.5 / 0.2263 = 0.0221 m^4/s they hold the pull, and doors
   of 1 m are closed. From 0.02207 on, by trials, somebody is stuck at a door; at 0.03 all three.
5. Below: the shortest way on a grid, one point in each metre, is the third's list of waypoints.
   Dijkstra's algorithm knows no local minima. It arrives after 70.5 s, and its way is 1.5 % longer
   than that through its waypoints. The potential never rises from one step to the next, which
   is why it can't get out of a minimum by itself.
6. They push each other back with 0.5 m/s at rho = 0.231 m. That holds along the corridor only: to
   the side U falls, until a wall pushes back as much. In 1.4 m they slide past each other; in 1.3 m
   both stand aside and block each other for ever.
"""

from math import dist, hypot, inf

import numpy as np

from mars2d import Prediction
from mars2d.addons import Waypoints
from mars2d.geometry import Potential
from mars2d.scenario import open_module

base = open_module("path_planning")
control = base.control
CELL, ROOM = 0.25, 0.35  # m: of the grid; from its points to the walls, at least


def shortest(scenario, start, goal):
    """Return the shortest way on a grid of 8 neighbours, by Dijkstra's algorithm: (k, 2)."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import dijkstra

    xmin, xmax, ymin, ymax = scenario.bounds
    field = Potential(scenario.obstacles, radius=ROOM)
    grid = [(x, y) for x in np.arange(xmin, xmax, CELL) for y in np.arange(ymin, ymax, CELL)]
    points = [point for point in grid if field.free(point)]
    number = {(round(x / CELL), round(y / CELL)): k for k, (x, y) in enumerate(points)}
    edges = [
        (k, number[i + a, j + b], CELL * hypot(a, b))
        for (i, j), k in number.items()
        for a, b in [(1, 0), (0, 1), (1, 1), (1, -1)]
        if (i + a, j + b) in number
    ]
    rows, columns, lengths = zip(*edges, strict=True)
    graph = coo_array((lengths, (rows, columns)), shape=(len(points), len(points)))
    first, last = (np.argmin([dist(point, end) for point in points]) for end in (start, goal))
    before = dijkstra(graph, directed=False, indices=first, return_predecessors=True)[1]
    way = [last]
    while way[-1] != first:
        way.append(before[way[-1]])
    return np.array(points)[way[::-1]]


def scenario():
    plain = base.scenario()
    drawing, ways, field = plain.addons
    *others, route = ways.routes
    way = shortest(plain, route[-2], route[-1])[4:-4:4]  # one in a metre
    planned = Waypoints([*others, [*route[:-1], *map(tuple, way), route[-1]]])
    return plain.replace(title="Path planning on a grid", addons=[drawing, planned, field])


def highest_rise(field, route, path, tolerance):
    """Return by how much the potential rises in a step, at most, between one and the same goal."""
    goals, last, most = list(route), inf, 0.0
    for at in path.tolist():
        now = field.potential(at, goals[0])
        most, last = max(most, now - last), now
        while len(goals) > 1 and dist(at, goals[0]) <= tolerance:
            goals.pop(0)
            last = inf
    return most


def checks(record):
    _, ways, addon = record.scenario.addons
    field, reached = addon.of(record.scenario), ways.of(record.frame(-1))
    arrived = sum(k == len(route) for k, route in zip(reached, ways.routes, strict=True))
    yield Prediction("robots that arrive", 3, arrived, 0)
    paths = record.pose[:, :2].transpose(2, 0, 1)
    rises = [
        highest_rise(field, *both, ways.tolerance) for both in zip(ways.routes, paths, strict=True)
    ]
    yield Prediction("rise of the potential", 0.0, max(rises), 1e-3, "m^2/s")
    planned, path = np.array(ways.routes[2])[3:], paths[2]
    ends = [np.argmax(np.hypot(*(path - at).T) <= ways.tolerance) for at in planned[[0, -1]]]
    ways = [np.hypot(*np.diff(p, axis=0).T).sum() for p in (planned, path[ends[0] : ends[1] + 1])]
    yield Prediction.within("way of the third, from waypoint 4 on", *ways, 5, "m")
