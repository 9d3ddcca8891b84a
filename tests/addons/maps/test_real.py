"""Robots drive in maps: a warehouse as a lidar leaves it in a grid, and a floor drawn as DXF.

The warehouse is made here, with rough walls, specks and unknown ground.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import shapely
from PIL import Image

from mars2d import Robot, Scenario, run
from mars2d.addons import Map
from mars2d.scenario.examples import examples
from mars2d.sensors import Proximity
from tests.cases import each_case

FREE, UNKNOWN, OCCUPIED = 254, 205, 0
CELL = 0.05

# -- an occupancy grid ----------------------------------------------------------------------------


def roughened(occupied: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Add cells beside occupied ones here and there, as the noise of a lidar does."""
    beside = np.zeros_like(occupied)
    for axis in (0, 1):
        for shift in (-1, 1):
            beside |= np.roll(occupied, shift, axis)
    return occupied | beside & (rng.random(occupied.shape) < 0.15)


def depot(folder: Path) -> Path:
    """A warehouse of 30 m by 15 m: walls, rows of shelves on legs, pillars, specks."""
    rng = np.random.default_rng(5)
    rows, columns = 300, 600
    y, x = CELL * (np.indices((rows, columns)) + 0.5)
    occupied = (x < 0.3) | (x > 29.7) | (y < 0.3) | (y > 14.7)
    for left in (3.0, 7.0, 14.0, 22.0):  # a shelf is seen by its legs
        for low in (3.5, 7.0, 10.5):
            legs = (abs((x - left) % 0.9) < 0.1) & (abs((y - low) % 0.8) < 0.1)
            occupied |= legs & (left <= x) & (x < left + 2.8) & (low <= y) & (y < low + 1.7)
    for px, py in ((12.5, 6.0), (18.5, 6.2), (26.5, 6.0), (26.5, 11.0)):
        occupied |= np.hypot(x - px, y - py) < 0.35
    cells = np.where(roughened(occupied, rng), OCCUPIED, FREE)
    cells[(y > 12.5) & (x > 24) & ~occupied] = UNKNOWN  # nobody has been there
    for row, column in rng.integers((20, 20), (rows - 60, columns - 20), (25, 2)):
        cells[row, column] = OCCUPIED
    Image.fromarray(cells[::-1].astype(np.uint8)).save(folder / "depot.pgm")
    path = folder / "depot.yaml"
    path.write_text(
        f"image: depot.pgm\nmode: trinary\nresolution: {CELL:.6f}\norigin: [0.0, 0.0, 0.0]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    return path


def floor(_folder: Path) -> Path:
    """The floor of a department, which is shipped."""
    return examples()["path_planning"].with_name("maps") / "department.dxf"


# -- what they are read as, and driven in ---------------------------------------------------------


def wander(robot):
    if robot.sense.proximity:
        return -0.3, 0.0
    if robot.command[0] < 0:
        return 0.0, robot.rng.uniform(np.pi / 2, 3 * np.pi / 2)
    return 0.5, 0.0


@pytest.mark.slow
@each_case(
    ("made", "options", "starts"),
    [
        (depot, {}, [(5.5, 6), (11, 2), (12, 9), (20, 9), (28, 5)]),
        (
            floor,
            {"layers": "WALLS,FURNITURE"},
            [(2.5, 3.4), (19.5, 7.35), (18.2, 17.4), (25, 18.5)],
        ),
    ],
)
def test_robots_wander_in_a_map_and_stay_in_its_rooms(tmp_path, made, options, starts):
    found = Map.from_file(made(tmp_path), **options)
    sensor = Proximity(range=0.25)
    robots = [
        Robot(pose=(x, y, k), diameter=0.25, sensors=[sensor], controller=wander)
        for k, (x, y) in enumerate(starts)
    ]
    scenario = Scenario(robots=robots, workspace=None, addons=[found], stop_time=100)
    record = run(scenario, seed=3)
    assert record.over_message == "finished after 100 s"
    pieces = found.obstacles()
    walls = [shapely.LineString(p) if len(p) == 2 else shapely.Polygon(p) for p in pieces]
    tree = shapely.STRtree(walls)
    path = record.pose[:, :2].transpose(0, 2, 1)  # (T, n, 2)
    _, gaps = tree.query_nearest(shapely.points(path.reshape(-1, 2)), return_distance=True)
    assert gaps.min() > 0.125 - scenario.max_overlap - 1e-9
    steps = shapely.linestrings(np.stack([path[:-1], path[1:]], axis=2).reshape(-1, 2, 2))
    assert not len(tree.query(steps, "intersects")[0])  # nobody went through a wall
    assert (np.ptp(path, axis=0).max(axis=1) > 0.5).all()  # and everybody went somewhere
