"""Maps that others made: they are read quickly, and robots drive in each."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
import shapely

from mars2d import Robot, Scenario, run
from mars2d.addons import Map
from mars2d.addons.maps import nearest_room
from mars2d.sensors import Proximity

MAPS = Path(__file__).parents[4] / "shared" / "maps"
pytestmark = pytest.mark.skipif(not MAPS.is_dir(), reason="the maps of others are not here")

ROOMS = {
    "depot": ("depot.yaml", {}, [(5, 5), (11, 2), (12, 9), (20, 9), (28, 5)]),
    "sandbox": ("tb3_sandbox.yaml", {}, [(0.55, 0.55), (-0.5, -0.5), (1.8, 0), (-2, 0.5)]),
    "house": (
        "floorplan.dxf", {"unit": "in", "layers": ["*A-WALL", "*OPENING"]},
        [(-14, 1.5), (-10, 1.5), (-6, 6), (-2, -3), (-3.3, 2)],
    ),
}  # fmt: skip
"""A map, how it is read, and where robots begin."""

COUNTS = {"depot": (245, 0), "sandbox": (22, 0), "house": (0, 150)}


def wander(robot):
    if robot.sense.proximity:
        return -0.3, 0.0
    if robot.command[0] < 0:
        return 0.0, robot.rng.uniform(np.pi / 2, 3 * np.pi / 2)
    return 0.5, 0.0


def read(name):
    file, options, _ = ROOMS[name]
    return Map.from_file(MAPS / file, **options)


@pytest.mark.parametrize("name", ROOMS)
def test_a_real_map_is_read_in_no_time(name):
    start = time.process_time()
    found = read(name)
    assert time.process_time() - start < 5
    assert (len(found.outlines), len(found.walls)) == COUNTS[name]


@pytest.mark.parametrize("name", ROOMS)
def test_robots_wander_in_a_real_map_and_stay_in_its_rooms(name):
    found = read(name)
    starts = ROOMS[name][2]
    sensor = Proximity(range=0.25)
    robots = [
        Robot(pose=(x, y, k), diameter=0.25, sensors=[sensor], controller=wander)
        for k, (x, y) in enumerate(starts)
    ]
    scenario = Scenario(robots=robots, workspace=None, addons=[found], stop_time=300)
    record = run(scenario, seed=3)
    assert record.over_message == "Time is over: 300 s"
    pieces = found.obstacles()
    walls = [shapely.LineString(p) if len(p) == 2 else shapely.Polygon(p) for p in pieces]
    tree = shapely.STRtree(walls)
    path = record.pose[:, :2].transpose(0, 2, 1)  # (T, n, 2)
    _, gaps = tree.query_nearest(shapely.points(path.reshape(-1, 2)), return_distance=True)
    assert gaps.min() > 0.125 - scenario.max_overlap - 1e-9
    steps = shapely.linestrings(np.stack([path[:-1], path[1:]], axis=2).reshape(-1, 2, 2))
    assert not len(tree.query(steps, "intersects")[0])  # nobody went through a wall
    assert (np.ptp(path, axis=0).max(axis=1) > 0.5).all()  # and everybody went somewhere


def test_the_house_was_drawn_in_inches_whatever_its_header_says(child):
    file = MAPS / "floorplan.dxf"
    code = f"from mars2d.cli import main; raise SystemExit(main(['check', {str(file)!r}]))"
    done = child(code)
    assert done.returncode == 0, done.stderr
    assert "unit        mm, as the header says ($INSUNITS = 4)\n" in done.stdout
    assert "is it unit=cm (8.66 m) or unit=in (22 m)?" in done.stdout
    assert "xref-Bishop-Overland-08$0$A-WALL         175 pieces\n" in done.stdout
    assert "89 TEXT, 63 DIMENSION, 13 HATCH" in done.stdout


def test_room_is_found_among_the_shelves_of_the_depot():
    outlines = read("depot").obstacles()
    workspace = [(0, 0), (30, 0), (30, 15), (0, 15)]
    place = nearest_room((18.5, 6.2), 0.3, outlines, workspace)
    assert place is not None
    disc = shapely.Point(place).buffer(0.29)
    assert not any(shapely.Polygon(outline).intersects(disc) for outline in outlines)
