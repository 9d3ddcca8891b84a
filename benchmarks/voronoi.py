"""What the Voronoi cells of a team cost a control step, and a picture.

    python benchmarks/voronoi.py [--json OUT.json] [--sizes N ...] [--rounds N]

Teams at random places in a square, a circle of 60 corners and a hook, which is not convex, 10 m
wide. `cells`: the cells, their centroids and the cost; `edges`: who is beside whom, and the shared
edges; `density`: the cells with masses, centroids and cost by a density. All are worked out again
for each of 40 places of the team. `drawing`: the shapes for a picture, and their painting at
1280 x 720. Times are those of the processor: the median, the least and the most over the rounds.
"""

from __future__ import annotations

import argparse
import os
import statistics
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import outcome
from numpy.typing import NDArray

from mars2d import Robot, Scenario, World
from mars2d.addons import Voronoi
from mars2d.geometry.voronoi import Tessellation

os.environ.setdefault("SDL_VIDEODRIVER", "dummy")

Float = NDArray[np.float64]
Outline = tuple[tuple[float, float], ...]

SIZES = (5, 20, 100)
ROUNDS = 7
PLACES = 40
SIDE = 10.0
ANGLES = 2 * np.pi * np.arange(60) / 60
REGIONS: dict[str, Outline] = {
    "square": ((0.0, 0.0), (SIDE, 0.0), (SIDE, SIDE), (0.0, SIDE)),
    "circle": tuple(
        zip((5 + 5 * np.cos(ANGLES)).tolist(), (5 + 5 * np.sin(ANGLES)).tolist(), strict=True)
    ),
    "hook": (
        *((0.0, 0.0), (SIDE, 0.0), (SIDE, 4.0), (4.0, 4.0)),
        *((4.0, 6.0), (SIDE, 6.0), (SIDE, SIDE), (0.0, SIDE)),
    ),
}


def hill(x: Float, y: Float) -> Float:
    """Return a density that is high near (3, 3)."""
    return np.asarray(0.1 + 1 / (1 + (x - 3) ** 2 + (y - 3) ** 2))


def cells(points: Float, region: Outline) -> object:
    """Work out what the law of coverage asks for."""
    found = Tessellation(points, region)
    return found.cells, found.centroids, found.cost


def edges(points: Float, region: Outline) -> object:
    """Work out who is beside whom."""
    found = Tessellation(points, region)
    return [found.edge(i, j) for i in range(points.shape[1]) for j in found.neighbours(i)]


def density(points: Float, region: Outline) -> object:
    """Work out the same as `cells` with a density."""
    found = Tessellation(points, region, hill)
    return found.cells, found.centroids, found.cost


WAYS: dict[str, Callable[[Float, Outline], object]] = {
    "cells": cells,
    "edges": edges,
    "density": density,
}


def summary(times: list[float]) -> dict[str, float]:
    """Return the median, the least and the most, in milliseconds."""
    figures = statistics.median(times), min(times), max(times)
    return {k: round(1e3 * v, 3) for k, v in zip(("ms", "least", "most"), figures, strict=True)}


def compare(name: str, size: int, rounds: int) -> dict[str, Any]:
    """Return what a team of this size costs in a region, for each way, a control step."""
    rng = np.random.default_rng(size)
    places = rng.uniform(0, SIDE, (PLACES, 2, size))
    taken: dict[str, list[float]] = {way: [] for way in WAYS}
    for each in WAYS.values():
        each(places[0], REGIONS[name])  # libraries are loaded, the region is kept
    for _ in range(rounds):
        for way, each in WAYS.items():
            start = time.process_time()
            for points in places:
                each(points, REGIONS[name])
            taken[way].append((time.process_time() - start) / PLACES)
    return {"region": name, "n": size} | {way: summary(times) for way, times in taken.items()}


def drawing(size: int, rounds: int) -> dict[str, Any]:
    """Return what it costs to draw the cells: the shapes, and painting them."""
    import pygame

    from mars2d.core.scene import Scene
    from mars2d.output.raster.camera import Camera
    from mars2d.output.raster.painter import Painter

    side = int(np.ceil(np.sqrt(size)))
    at = np.array([np.arange(size) % side + 0.5, np.arange(size) // side + 0.5])
    rng = np.random.default_rng(size)
    frames = []
    for _ in range(PLACES):
        places = (at + rng.uniform(-0.2, 0.2, (2, size))) * SIDE / side
        robots = [Robot().at(x, y) for x, y in places.T.tolist()]
        scenario = Scenario(robots=robots, workspace=REGIONS["square"], addons=[Voronoi()])
        frames.append(World(scenario).frame)
    painter = Painter()
    surface = pygame.Surface((1280, 720), 0, 32)
    camera = Camera(scale=70.0, x=290.0, y=710.0)
    shapes: list[float] = []
    painting: list[float] = []
    for frame in frames * rounds:
        start = time.process_time()
        scene = Scene()
        frame.scenario.addons[0].draw(scene, frame)
        middle = time.process_time()
        painter.paint(surface, scene.shapes, camera)
        shapes.append(middle - start)
        painting.append(time.process_time() - middle)
    return {"n": size, "shapes": summary(shapes), "painting": summary(painting)}


def main() -> None:
    """Time all and print it."""
    parser = argparse.ArgumentParser(description="Voronoi cells: a control step, and a picture.")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    parser.add_argument("--sizes", type=int, nargs="*", default=SIZES, help="numbers of robots")
    parser.add_argument("--rounds", type=int, default=ROUNDS, help="how often all is timed")
    arguments = parser.parse_args()
    print(f"{'region':>7} {'n':>5}" + "".join(f" {way:>20}" for way in WAYS) + "  ms")
    rows = []
    for name in REGIONS:
        for size in arguments.sizes:
            rows.append(row := compare(name, size, arguments.rounds))
            timed = [row[way] for way in WAYS]
            figures = [f"{f['ms']:.2f} ({f['least']:.2f}-{f['most']:.2f})" for f in timed]
            print(f"{name:>7} {size:>5}" + "".join(f" {figure:>20}" for figure in figures))
    pictures = [drawing(size, arguments.rounds) for size in arguments.sizes]
    for row in pictures:
        shapes, painting = row["shapes"]["ms"], row["painting"]["ms"]
        print(
            f"drawing {row['n']:>5}: {shapes:.2f} ms for the shapes, {painting:.2f} to paint them"
        )
    result = {"cells": rows, "drawing": pictures}
    outcome.write(result, arguments.json)


if __name__ == "__main__":
    main()
