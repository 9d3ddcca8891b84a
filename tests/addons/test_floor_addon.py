"""The floor's colours: what Floor paints is what the sensor Ground reads, and what one sees."""

from __future__ import annotations

from math import nan

import numpy as np
import pygame
import pytest
from PIL import Image

import mars2d
from mars2d import Addon, InputError, LawError, Robot, Scenario, World
from mars2d.addons import Floor
from mars2d.core.scene import Scene, Text
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.picture import paint_frame
from mars2d.sensors import Ground
from tests.cases import each_case

SQUARE = [(0, 0), (2, 0), (2, 2), (0, 2)]
RED, BLUE = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)


@pytest.fixture
def picture(tmp_path, monkeypatch):
    """A picture of 2 rows and 3 columns in the current folder, each pixel of its own colour."""
    monkeypatch.chdir(tmp_path)
    values = np.arange(18, dtype=np.uint8).reshape(2, 3, 3) * 10
    Image.fromarray(values).save("p.png")
    return values


def read_at(point, *floors, sensor=None):
    robot = Robot(pose=(*point, 0), sensors=[sensor or Ground()])
    world = World(Scenario(robots=[robot], workspace=None, addons=floors))
    world.observe()
    return world.robots[0].sense.ground.tolist()


CAMERA = Camera(scale=10.0, x=50.0, y=50.0)  # (-5, -5) to (5, 5) on 100 x 100 pixels


def painted(scene):
    """The pixels (height, width, 3) of a scene."""
    surface = pygame.Surface((100, 100), 0, 32)
    surface.fill("white")
    Painter().paint(surface, scene.shapes, CAMERA)
    return pygame.surfarray.array3d(surface).swapaxes(0, 1)


# -- what is read ---------------------------------------------------------------------------


OVER = [(1, 0), (3, 0), (3, 2), (1, 2)]
PATCH = Floor(patches=[(SQUARE, "#ff0000")])
BOTH = Floor(color="#0000ff", patches=[(SQUARE, "#ff0000")])
LATER = Floor(patches=[(SQUARE, "#ff0000"), (OVER, "#0000ff")])


@each_case(
    ("floors", "point", "mount", "color"),
    [
        ([], (0, 0), (0, 0, 0), [1, 1, 1]),  # white, where nothing is said
        ([BOTH], (1, 1), (0, 0, 0), [1, 0, 0]),
        ([BOTH], (3, 1), (0, 0, 0), [0, 0, 1]),
        ([LATER], (0.5, 1), (0, 0, 0), [1, 0, 0]),
        ([LATER], (1.5, 1), (0, 0, 0), [0, 0, 1]),  # the later patch lies on top
        ([Floor(color="#0000ff", name="a"), Floor(color="#ff0000")], (0, 0), (0, 0, 0), [1, 0, 0]),
        ([Floor(color="#ff0000"), Floor(name="a")], (0, 0), (0, 0, 0), [1, 0, 0]),
        ([PATCH], (-0.2, 1), (0, 0, 0), [1, 1, 1]),
        ([PATCH], (-0.2, 1), (0.3, 0, 0), [1, 0, 0]),
        ([PATCH], (1, 2.1), (0, -0.2, 0), [1, 0, 0]),
    ],
)
def test_the_uppermost_colour_below_the_mount_is_read_as_it_is_seen(floors, point, mount, color):
    assert read_at(point, *floors, sensor=Ground(mount=mount)) == color
    scene, (x, y) = Scene(), np.add(point, mount[:2])
    for floor in floors:
        floor.paint(scene, [(-5, -5), (5, -5), (5, 5), (-5, 5)])
    assert (painted(scene)[int(50 - 10 * y), int(50 + 10 * x)] / 255).tolist() == color


def test_each_pixel_of_an_image_covers_its_part_of_the_floor(picture):
    floor = Floor(image="p.png", bounds=(-1, 2, 10, 12), color="#00ff00")  # a metre each
    for row in range(2):
        for column in range(3):
            color = tuple((picture[row, column] / 255).tolist())
            for off in (1e-9, 0.5, 1 - 1e-9):
                assert floor.ground((-1 + column + off, 12 - row - off)) == color


def test_through_a_transparent_pixel_the_colour_of_the_rest_is_seen(tmp_path):
    values = np.array([[[255, 0, 0, 0], [255, 0, 0, 255], [255, 0, 0, 51]]], dtype=np.uint8)
    Image.fromarray(values).save(tmp_path / "p.png")
    floor = Floor(image=tmp_path / "p.png", bounds=(0, 3, 0, 1), color="#0000ff")
    assert [floor.ground((x, 0.5)) for x in (0.5, 1.5, 2.5)] == [BLUE, RED, (0.2, 0.0, 0.8)]


def test_a_reading_is_recorded_and_disturbed_like_any_other():
    robot = Robot(sensors=[Ground(noise=0.1, dropouts=0.2)])
    scenario = Scenario(robots=[robot], addons=[Floor(color="#808080")], stop_time=30)
    found = mars2d.run(scenario).sensors["ground"][:, 0]
    assert found.shape == (301, 3)
    assert 0.1 < np.isnan(found).mean() < 0.3
    assert np.nanstd(found) == pytest.approx(0.1, rel=0.1)
    assert np.nanmean(found) == pytest.approx(128 / 255, abs=0.02)


@each_case("found", ["red", (1, 2, 3), (0.5, 0.5), (nan, 0, 0), [(1, 1, 1)]])
def test_a_floor_of_ones_own_must_return_a_colour(found):
    class Carpet(Addon):
        def ground(self, point):
            return found

    with pytest.raises(LawError, match=r"the floor at \(0, 0\) is .*: expected of ground"):
        read_at((0, 0), Carpet())


# -- what can't be --------------------------------------------------------------------------


@each_case(
    ("fields", "message"),
    [
        ({"color": "#ffffff80"}, "Floor.color = .*: expected a colour without opacity"),
        ({"patches": [SQUARE]}, r"Floor.patches\[0\] = .*: expected a patch \(outline, colour\)"),
        ({"patches": [(SQUARE, 3)]}, r"Floor.patches\[0\]\[1\] = 3: expected a colour"),
        ({"image": "line.jpg", "bounds": (0, 1, 0, 1)}, "Floor.image = 'line.jpg': .*.png"),
        ({"image": "p.png", "bounds": (1, 0, 0, 1)}, r"Floor.bounds = .*xmin < xmax"),
        ({"image": "p.png", "bounds": (0, 1, 0, nan)}, r"Floor.bounds = \(0, 1, 0, nan\)"),
    ],
)
def test_a_floor_that_can_not_be_is_an_error(fields, message):
    with pytest.raises(InputError, match=message):
        Floor(**fields)


def files(folder):
    """Files that are no images to be used, by what is said of them."""
    (folder / "text.png").write_text("hello")
    (folder / "empty.png").write_bytes(b"")
    Image.new("L", (5000, 2)).save(folder / "long.png")
    Image.new("RGB", (4, 4)).save(folder / "jpeg.png", format="JPEG")
    Image.new("I;16", (4, 4)).save(folder / "deep.png")
    Image.new("RGB", (64, 64), "red").save(folder / "cut.png")
    whole = (folder / "cut.png").read_bytes()
    (folder / "cut.png").write_bytes(whole[: len(whole) - 60])
    (folder / "folder.png").mkdir()
    return {
        "text.png": "this is no PNG image",
        "empty.png": "this is no PNG image",
        "jpeg.png": "this is no PNG image",
        "long.png": "5000 x 2 pixels; expected at most 4096 x 4096",
        "deep.png": "more than 8 bits a channel; save it with 8",
        "cut.png": "can't be read",
        "folder.png": "can't be read as a PNG image: .*Is a directory",
        "gone.png": "there is no such file in ",
    }


def test_an_image_that_can_not_be_used_is_an_error_when_a_world_is_made(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, message in files(tmp_path).items():
        floor = Floor(image=name, bounds=(0, 1, 0, 1))  # not read yet
        with pytest.raises(InputError, match=rf"^Floor.image = '{name}': {message}") as raised:
            World(Scenario(addons=[floor]))
        assert not isinstance(raised.value, LawError)  # it is no law's fault
    with pytest.raises(InputError, match=r"Path\(__file__\).with_name\('gone.png'\)"):
        World(Scenario(addons=[Floor(image="a/gone.png", bounds=(0, 1, 0, 1))]))


# -- what is seen ---------------------------------------------------------------------------


def test_an_image_is_painted_where_it_lies_with_its_first_row_on_top(picture):
    scene = Scene()
    scene.image(picture, (-3, 3, -1, 3))
    made = painted(scene)
    for row in range(2):
        for column in range(3):
            part = made[20 + 20 * row : 40 + 20 * row, 20 + 20 * column : 40 + 20 * column]
            assert (part == picture[row, column]).all()
    outside = made.copy()
    outside[20:60, 20:80] = 255
    assert (outside == 255).all()


def test_a_record_names_its_image_and_shows_it_where_its_file_is_there(picture, tmp_path):
    scenario = Scenario(addons=[Floor(image="p.png", bounds=(0, 3, 0, 2))], stop_time=0.2)
    path = mars2d.run(scenario).save("run.npz")
    assert (mars2d.load(path).scenario.addons[0].picture == picture).all()
    (tmp_path / "p.png").unlink()
    scene = Scene()
    mars2d.load(path).scenario.addons[0].paint(scene, SQUARE)
    assert [shape.text for shape in scene.shapes if isinstance(shape, Text)] == [
        "p.png is not there"
    ]


@pytest.mark.slow
def test_the_floor_lies_beneath_obstacles_grid_and_robots_and_is_in_every_picture():
    patch = [(-4, -4), (4, -4), (4, 4), (-4, 4)]
    scenario = Scenario(
        addons=[Floor(patches=[(patch, "#ff0000")], color="#00ff00")],
        robots=[Robot(pose=(1, 1, 0), color="#0000ff", diameter=1)],
        animation=mars2d.Animation(grid=False),
    )
    surface = paint_frame(World(scenario).frame, (600, 600))
    made = pygame.surfarray.array3d(surface).swapaxes(0, 1).reshape(-1, 3)
    seen = {tuple(color) for color in made.tolist()}
    assert {(255, 0, 0), (0, 255, 0), (0, 0, 255)} <= seen
    figure = mars2d.run(scenario, stop_time=1).plot().figure
    figure.canvas.draw()
    shown = np.asarray(figure.canvas.buffer_rgba())[..., :3].reshape(-1, 3)
    assert {(255, 0, 0), (0, 255, 0), (0, 0, 255)} <= {tuple(c) for c in shown.tolist()}
