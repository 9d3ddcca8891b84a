"""Maps as they come from other programs: they are read quickly, and robots drive in each.

They are made here: a warehouse and a sandbox as a lidar leaves them in an occupancy grid, with
rough walls, specks and unknown ground, and a house as an architect's program draws it, with layers
of referenced files, doors, blocks, texts and dimensions, in inches whatever its header says.
"""

from __future__ import annotations

from pathlib import Path

import ezdxf
import numpy as np
import pytest
import shapely
from PIL import Image

from mars2d import Robot, Scenario, run
from mars2d.addons import Map
from mars2d.cli.command_line import main
from mars2d.sensors import Proximity
from tests.cases import each_case

FREE, UNKNOWN, OCCUPIED = 254, 205, 0
CELL = 0.05

ROOMS = {
    "depot": ("depot.yaml", {}, [(5.5, 6), (11, 2), (12, 9), (20, 9), (28, 5)]),
    "sandbox": ("sandbox.yaml", {}, [(0.55, 0.55), (-0.5, -0.5), (1.8, 0), (-2, 0.5)]),
    "house": (
        "house.dxf", {"unit": "in", "layers": ["*A-WALL", "*OPENING"]},
        [(2, 2), (6, 2), (2, 7), (10, 7), (8, 4)],
    ),
}  # fmt: skip
"""A map, how it is read, and where robots begin."""

"""How many outlines and walls each has."""


# -- an occupancy grid ----------------------------------------------------------------------------


def written_grid(folder: Path, name: str, cells: np.ndarray, origin: tuple[float, float]) -> Path:
    """Write a grid, whose row 0 is the lowest, as ROS does: a PGM and a YAML beside it."""
    Image.fromarray(cells[::-1].astype(np.uint8)).save(folder / f"{name}.pgm")
    text = (
        f"image: {name}.pgm\nmode: trinary\nresolution: {CELL:.6f}\n"
        f"origin: [{origin[0]:.6f}, {origin[1]:.6f}, 0.000000]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    (folder / f"{name}.yaml").write_text(text)
    return folder / f"{name}.yaml"


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
    return written_grid(folder, "depot", cells, (0.0, 0.0))


def sandbox(folder: Path) -> Path:
    """A hexagon with nine pillars, in the middle of 20 m by 20 m that are unknown."""
    rng = np.random.default_rng(6)
    y, x = CELL * (np.indices((400, 400)) + 0.5) - 10
    turns = np.arange(6) * np.pi / 3
    reach = np.max([x * np.cos(t) + y * np.sin(t) for t in turns], axis=0)
    cells = np.full(x.shape, UNKNOWN)
    cells[reach < 2.5] = FREE
    wall = roughened((reach >= 2.4) & (reach < 2.5), rng)
    pillars = [np.hypot(x - px, y - py) < 0.15 for px in (-1.1, 0, 1.1) for py in (-1.1, 0, 1.1)]
    cells[roughened(wall | np.any(pillars, axis=0), rng)] = OCCUPIED
    return written_grid(folder, "sandbox", cells, (-10.0, -10.0))


# -- a drawing ------------------------------------------------------------------------------------

XREF = "xref-Maple-07$0$"
METRE = 1 / 0.0254  # inches


def house(folder: Path) -> Path:
    """A house of 12 m by 9 m, drawn in inches, whose header says millimetres."""
    document = ezdxf.new("R2004", setup=True)
    document.header["$INSUNITS"] = 4
    space = document.modelspace()

    def on(layer: str) -> dict[str, str]:
        return {"layer": XREF + layer}

    def scaled(*points: tuple[float, float]) -> list[tuple[float, float]]:
        return [(x * METRE, y * METRE) for x, y in points]

    def wall(a: tuple[float, float], b: tuple[float, float]) -> None:
        """Draw both sides of a wall of 15 cm, and its ends."""
        (x0, y0), (x1, y1) = a, b
        dx, dy = (0.075, 0.0) if x0 == x1 else (0.0, 0.075)
        corners = scaled((x0 + dx, y0 + dy), (x1 + dx, y1 + dy), (x1 - dx, y1 - dy),
                         (x0 - dx, y0 - dy))  # fmt: skip
        for start, end in zip(corners, corners[1:] + corners[:1], strict=True):
            space.add_line(start, end, dxfattribs=on("A-WALL"))

    outside = scaled((0, 0), (12, 0), (12, 9), (0, 9))
    space.add_lwpolyline(outside, close=True, dxfattribs=on("A-WALL"))
    for a, b in (
        ((4, 0.1), (4, 3)), ((4, 4), (4, 8.9)), ((0.1, 4.5), (2.5, 4.5)),
        ((3.4, 4.5), (3.9, 4.5)), ((4.1, 5.5), (7, 5.5)), ((8, 5.5), (11.9, 5.5)),
    ):  # fmt: skip
        wall(a, b)
    block = document.blocks.new("DOOR")
    block.add_arc((0, 0), METRE * 0.9, 0, 90)
    block.add_line((0, 0), (0, METRE * 0.9))
    for x, y, turn in ((4, 3.05, 0), (2.5, 4.5, 90), (7, 5.5, 180)):
        (place,) = scaled((x, y))
        space.add_blockref("DOOR", place, dxfattribs=on("A-DOOR") | {"rotation": turn})
        space.add_line(place, scaled((x + 0.1, y))[0], dxfattribs=on("OPENING"))
    for k in range(7):
        (place,) = scaled((1 + 1.5 * k, 8))
        space.add_text(f"ROOM {k}", height=6, dxfattribs=on("A-TEXT")).set_placement(place)
    for k in range(3):
        base, first, second = scaled((0, -0.5 - 0.3 * k), (0, 0), (4 * (k + 1), 0))
        space.add_linear_dim(base, first, second, dxfattribs=on("A-DIMS")).render()
    for x in (9, 10):
        hatch = space.add_hatch(dxfattribs=on("A-FURN"))
        hatch.paths.add_polyline_path(scaled((x, 1), (x + 0.5, 1), (x + 0.5, 2)), is_closed=True)
        space.add_lwpolyline(scaled((x, 1), (x + 0.5, 1), (x + 0.5, 2)), close=True,
                             dxfattribs=on("A-FURN"))  # fmt: skip
    document.saveas(folder / "house.dxf")
    return folder / "house.dxf"


@pytest.fixture(scope="module")
def maps(tmp_path_factory) -> Path:
    """A folder with all of them."""
    folder = tmp_path_factory.mktemp("maps")
    for make in (depot, sandbox, house):
        make(folder)
    return folder


# -- what they are read as, and driven in ---------------------------------------------------------


def wander(robot):
    if robot.sense.proximity:
        return -0.3, 0.0
    if robot.command[0] < 0:
        return 0.0, robot.rng.uniform(np.pi / 2, 3 * np.pi / 2)
    return 0.5, 0.0


def read(maps, name):
    file, options, _ = ROOMS[name]
    return Map.from_file(maps / file, **options)


@pytest.mark.slow
@each_case("name", ROOMS)
def test_robots_wander_in_a_real_map_and_stay_in_its_rooms(maps, name):
    found = read(maps, name)
    starts = ROOMS[name][2]
    sensor = Proximity(range=0.25)
    robots = [
        Robot(pose=(x, y, k), diameter=0.25, sensors=[sensor], controller=wander)
        for k, (x, y) in enumerate(starts)
    ]
    scenario = Scenario(robots=robots, workspace=None, addons=[found], stop_time=100)
    record = run(scenario, seed=3)
    assert record.over_message == "Time is over: 100 s"
    pieces = found.obstacles()
    walls = [shapely.LineString(p) if len(p) == 2 else shapely.Polygon(p) for p in pieces]
    tree = shapely.STRtree(walls)
    path = record.pose[:, :2].transpose(0, 2, 1)  # (T, n, 2)
    _, gaps = tree.query_nearest(shapely.points(path.reshape(-1, 2)), return_distance=True)
    assert gaps.min() > 0.125 - scenario.max_overlap - 1e-9
    steps = shapely.linestrings(np.stack([path[:-1], path[1:]], axis=2).reshape(-1, 2, 2))
    assert not len(tree.query(steps, "intersects")[0])  # nobody went through a wall
    assert (np.ptp(path, axis=0).max(axis=1) > 0.5).all()  # and everybody went somewhere


def test_the_house_was_drawn_in_inches_whatever_its_header_says(maps, capsys):
    assert main(["check", str(maps / "house.dxf")]) == 0
    said = capsys.readouterr().out
    assert "unit        mm, as the header says ($INSUNITS = 4)\n" in said
    assert "is it unit=cm (4.72 m) or unit=in (12 m)" in said
    assert "xref-Maple-07$0$A-WALL   25 pieces\n" in said
    assert "7 TEXT, 3 DIMENSION\n" in said
