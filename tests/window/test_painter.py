"""What is painted lies where it should, in its colour, with soft edges; without any display."""

import numpy as np
import pygame
import pytest

from mars2d import Robot, Scenario, World
from mars2d.bodies.props import Box
from mars2d.core.errors import InputError
from mars2d.core.scene import Scene, wake_style
from mars2d.output.layers.table import LAYERS, Layers
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.layout import fitted
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.picture import Artist, paint_frame, save_png
from mars2d.output.raster.stage import Stage
from mars2d.scenario.animation import Animation
from tests.cases import each_case
from tests.window.circling import Circling, circling_scenario
from tests.window.written import pixels

CAMERA = Camera(scale=10.0, x=50.0, y=50.0)  # (-5, -5) to (5, 5) on 100 x 100 pixels


def painted(scene, ui=1.0):
    surface = pygame.Surface((100, 100), 0, 32)
    surface.fill("white")
    painter = Painter()
    painter.ui = ui
    painter.paint(surface, scene.shapes, CAMERA)
    return surface


def coverage(surface):
    """Return how much of each pixel black covers, (height, width), 0 to 1."""
    return 1 - pixels(surface)[..., 0] / 255


def test_a_disc_covers_its_area_and_is_centred():
    scene = Scene()
    scene.circle((1.03, -0.57), 2.0, fill="#000000")
    covered = coverage(painted(scene))
    assert covered.sum() == pytest.approx(np.pi * 20**2, rel=0.01)
    y, x = np.mgrid[:100, :100] + 0.5
    assert (covered * x).sum() / covered.sum() == pytest.approx(60.3, abs=0.2)
    assert (covered * y).sum() / covered.sum() == pytest.approx(55.7, abs=0.2)


def test_a_ring_is_hollow():
    scene = Scene()
    scene.circle((0, 0), 3.0, stroke="#000000", width=2.0)
    covered = coverage(painted(scene))
    assert covered[50, 50] == 0
    assert covered.sum() == pytest.approx(2 * np.pi * 30 * 2, rel=0.16)


def test_a_concave_polygon_is_not_filled_in_its_notch():
    scene = Scene()
    scene.polygon([(-4, -4), (4, -4), (4, 4), (0, 0), (-4, 4)], fill="#000000")
    covered = coverage(painted(scene))
    assert covered[80, 50] == 1  # the foot
    assert covered[20, 50] == 0  # the notch
    assert covered.sum() == pytest.approx(80 * 80 * 0.75, rel=0.02)


@each_case("angle", np.linspace(0, np.pi, 7))
@each_case("width", [1.0, 1.6, 3.0])
def test_a_line_is_as_wide_in_every_direction(angle, width):
    scene = Scene()
    end = 3 * np.array([np.cos(angle), np.sin(angle)])
    scene.line([-end, (0, 0), end], stroke="#000000", width=width)
    assert coverage(painted(scene)).sum() == pytest.approx(60 * width, rel=0.25)


@each_case("style", ["--", ":", "-."])
def test_dashes_leave_gaps(style):
    whole, dashed = Scene(), Scene()
    whole.line([(-4, 0), (0, 0), (4, 0)], stroke="#000000", width=2)
    dashed.line([(-4, 0), (0, 0), (4, 0)], stroke="#000000", width=2, style=style)
    row, full = coverage(painted(dashed))[49:51].max(axis=0), coverage(painted(whole))
    assert (row[12:88] < 0.2).sum() > 10
    assert 0.15 < coverage(painted(dashed)).sum() / full.sum() < 0.9


@each_case("marker", [".", "o", "x", "+", "*", "s"])
def test_each_marker_has_a_shape_of_its_own(marker):
    assert wake_style("style", marker) == marker
    scene = Scene()
    scene.line([(-3, 0), (3, 0)], stroke="#000000", style=marker)
    covered = coverage(painted(scene))
    assert covered[45:55, 15:25].sum() > 3
    assert covered[45:55, 45:55].sum() == 0
    assert (covered[49:51, 19:21].min() > 0.4) == (marker in ".x+*")


def test_text_stands_on_the_side_of_its_point_that_it_is_anchored_at():
    sides = {}
    for anchor in ("center", "left", "right", "above", "below"):
        scene = Scene()
        scene.text((0, 0), "HHH", anchor=anchor, color="#000000")
        rows, columns = np.nonzero(coverage(painted(scene)) > 0.5)
        sides[anchor] = columns.mean() - 50, rows.mean() - 50
    assert sides["left"][0] > 8
    assert sides["right"][0] < -8
    assert sides["above"][1] < -5
    assert sides["below"][1] > 5
    assert abs(sides["center"][0]) < 2


# -- whole pictures -------------------------------------------------------------------------------


def frame(row=60, **changes):
    source = Circling(circling_scenario(**changes))
    source.row = row
    return source.frame


def differing(a, b):
    return int((pixels(a) != pixels(b)).any(axis=2).sum())


def test_of_labels_that_overlap_the_last_is_written_alone():
    def written(*places):
        scene = Scene()
        for place in places:
            scene.text(place, "12 N", color="#000000", halo="#ffffff")
        return coverage(painted(scene)).sum()

    one = written((0, 0))
    assert one > 10
    assert written((0.5, 0.3), (-0.5, -0.3), (0, 0)) == one
    assert written((0, 3), (0, -3), (0, 0)) == pytest.approx(3 * one)
    scenario = Scenario(robots=[Robot(name="red")], props=[Box(name="crate", pose=(1, 0, 0))])
    (names,) = [layer.shapes(World(scenario).frame) for layer in LAYERS if layer.name == "names"]
    assert [text.text for text in names.shapes] == ["crate", "red"], "no prop hides a robot's name"


def test_a_picture_shows_the_robots_where_they_are():
    now, artist = frame(), Artist()
    surface = artist.paint(now)
    camera = fitted(now.scenario.bounds, (1280, 720), artist.layout)
    behind = now.pose[:2] - 0.15 * np.array([np.cos(now.pose[2]), np.sin(now.pose[2])])
    for point, color in zip(behind.T, now.scenario.colors, strict=True):
        x, y = camera.to_pixels(point)[0]
        assert pygame.Color(color)[:3] == surface.get_at((int(x), int(y)))[:3]


@each_case(
    "changed",
    [{"grid": False}, {"show_initial_pose": False}, {"show_real_shape": False}, {"wake": False},
     {"wake_style": "--"}, {"wake_style": "o"}, {"base_colors": ["red", "green"]}],
)  # fmt: skip
def test_every_animation_field_changes_the_picture(changed):
    usual = paint_frame(frame())
    assert differing(usual, paint_frame(frame(animation=Animation(**changed)))) > 100


def test_the_message_of_the_end_stands_in_a_banner():
    source = Circling()
    source.row = source.rows
    before, after = paint_frame(frame(row=99)), paint_frame(source.frame)
    assert after.get_at((640, 710))[:3] == (0x24, 0x3B, 0x53)
    assert before.get_at((640, 710))[:3] == (255, 255, 255)


def test_a_picture_is_saved_as_png(tmp_path):
    target = tmp_path / "picture.png"
    surface = paint_frame(frame(), (320, 240))
    save_png(surface, target)
    assert differing(pygame.image.load(target), surface) == 0
    with pytest.raises(InputError, match=r"picture\.jpg.*\.png"):
        save_png(surface, tmp_path / "picture.jpg")
    with pytest.raises(InputError, match=r"no/picture\.png.*can't be written"):
        save_png(surface, tmp_path / "no" / "picture.png")


def test_while_the_camera_moves_a_slow_picture_is_enlarged_and_then_drawn_anew(monkeypatch):
    monkeypatch.setattr("mars2d.output.raster.stage.PATIENCE", 0.0)
    monkeypatch.setattr("mars2d.output.raster.stage.MAX_AGE", np.inf)
    now, painter = frame(), Painter()
    start = Camera.fit(now.scenario.bounds, (640, 480), (20, 20, 20, 20))
    zoomed = start.zoomed((400, 200), 1.5).panned(-7.5, 3.25)
    stage, plot = Stage(painter), pygame.Rect(0, 30, 640, 420)
    layers = Layers(sensors=False)
    pictures = []
    for camera, hurried in ((start, False), (zoomed, True), (zoomed, False)):
        surface = pygame.Surface((640, 480), 0, 32)
        stage.draw(surface, now, camera, layers, plot, hurried=hurried)
        pictures.append(surface)
    first, rough, fine = pictures
    assert differing(rough, fine) > 500
    assert np.abs(pixels(rough) - pixels(fine)).mean() < 3
    assert np.abs(pixels(first) - pixels(fine)).mean() > 5
    fresh = pygame.Surface((640, 480), 0, 32)
    Stage(painter).draw(fresh, now, zoomed, layers, plot)
    assert differing(fresh, fine) == 0


# -- arrows and forces ----------------------------------------------------------------------------


@each_case("tip", [(3.0, 0.0), (2.1, 2.1), (-1.0, -2.5)])
def test_an_arrow_goes_from_its_tail_to_its_tip_with_its_width(tip):
    scene = Scene()
    scene.arrow((0, 0), tip, fill="#000000", width=3.0)
    covered = coverage(painted(scene))
    y, x = np.mgrid[:100, :100] + 0.5
    along = np.array([tip[0], -tip[1]]) / np.hypot(*tip)
    at = (x - 50) * along[0] + (y - 50) * along[1]
    assert covered[(at < -1.5) | (at > 10 * np.hypot(*tip) + 1.5)].sum() < 0.1
    shaft = (at > 3) & (at < 8)
    assert covered[shaft].sum() / 5 == pytest.approx(3.0, abs=0.7)
    head = (at > 10 * np.hypot(*tip) - 11) & (at < 10 * np.hypot(*tip) - 8)
    assert covered[head].sum() / 3 > 6.0
