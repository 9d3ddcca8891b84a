"""The camera turns metres into pixels and back."""

import numpy as np
import pytest

from mars2d.core.plane import grid_step
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.grid import label, ticks
from mars2d.output.raster.strokes import clip_lines, clip_polygon
from tests.cases import each_case


def test_up_in_the_world_is_up_on_the_screen():
    camera = Camera(scale=50.0, x=100.0, y=200.0)
    assert camera.to_pixels([(0, 0), (1, 2)]).tolist() == [[100, 200], [150, 100]]


def test_pixels_and_metres_are_inverse():
    camera = Camera(scale=37.5, x=-12.0, y=801.0)
    points = np.random.default_rng(0).normal(0, 100, (50, 2))
    np.testing.assert_allclose(camera.to_world(camera.to_pixels(points)), points, atol=1e-9)


@each_case("size", [(1280, 720), (720, 1280), (800, 600)])
def test_fit_shows_all_within_the_margins_and_touches_two_of_them(size):
    margins = (50, 60, 70, 80)
    camera = Camera.fit((-3, 7, 2, 6), size, margins)
    (left, bottom), (right, top) = camera.to_pixels([(-3, 2), (7, 6)]).tolist()
    gaps = [left - 50, size[0] - 70 - right, top - 60, size[1] - 80 - bottom]
    assert min(gaps) > -1e-9
    assert gaps[0] == pytest.approx(gaps[1])
    assert gaps[2] == pytest.approx(gaps[3])
    assert min(gaps[0], gaps[2]) == pytest.approx(0)


def test_zoom_keeps_the_point_beneath_the_pointer():
    camera = Camera(scale=50.0, x=100.0, y=200.0)
    pointer = (321.0, 123.0)
    zoomed = camera.zoomed(pointer, 2.5)
    assert zoomed.scale == 125.0
    np.testing.assert_allclose(zoomed.to_world([pointer]), camera.to_world([pointer]))


@each_case(
    "scale, expected", [(50, 1.0), (40, 2.0), (21, 2.0), (9, 5.0), (500, 0.1), (0.05, 1000.0)]
)
def test_grid_lines_are_1_2_or_5_apart(scale, expected):
    assert grid_step(42 / scale) == pytest.approx(expected)


def test_labels_have_the_decimals_of_their_step_and_no_minus_zero():
    values = ticks(-0.5, 0.5, 0.25)
    assert [label(v, 0.5) for v in (-0.5, -1e-17, 0.5)] == ["\N{MINUS SIGN}0.5", "0.0", "0.5"]
    assert label(20.0, 10.0) == "20"
    assert len(values) == 5


def test_a_polygon_is_cut_to_what_is_seen():
    square = np.array([(-1e6, -1e6), (1e6, -1e6), (1e6, 1e6), (-1e6, 1e6)])
    cut = clip_polygon(square, (0, 0, 100, 50))
    assert {tuple(p) for p in cut.tolist()} == {(0, 0), (100, 0), (100, 50), (0, 50)}
    assert len(clip_polygon(square + 5e6, (0, 0, 100, 50))) == 0


def test_lines_are_cut_where_they_leave_and_stay_whole_inside():
    line = np.array([(-50.0, 10.0), (50.0, 10.0), (50.0, 20.0), (500.0, 20.0), (500.0, 30.0)])
    (piece,) = clip_lines(line, (0, 0, 100, 50))
    assert piece.tolist() == [[0, 10], [50, 10], [50, 20], [100, 20]]
    assert clip_lines(line + 1000, (0, 0, 100, 50)) == []
