"""Going back and forth in a long run: the paths are those that were drawn going forward."""

from __future__ import annotations

import numpy as np
import pygame
import pytest

from mars2d import Robot, Scenario
from mars2d.bodies.props import Ball
from mars2d.output.layers.table import Layers
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.stage import MEMORY, Stage
from mars2d.record.frame import Frame

ROWS = 3000
SIZE = (640, 360)
CAMERA = Camera(30.0, 320.0, 180.0)


@pytest.fixture(scope="module")
def run():
    rng = np.random.default_rng(3)
    heading = np.cumsum(rng.normal(0, 0.2, (ROWS, 4)), axis=0) + np.arange(4)
    way = np.cumsum(0.05 * np.stack([np.cos(heading), np.sin(heading)], axis=1), axis=0)
    place = np.abs((way + 9) % 20 - 10) - 5
    pose = np.concatenate([place, heading[:, None]], axis=1)
    robots = [Robot(pose=(1.5 * i, 0, 0)) for i in range(3)]
    ball = Ball(pose=(0, 2, 0))
    scenario = Scenario(robots=robots, props=[ball], stop_time=0.1 * ROWS, workspace=None,
                        physics="contact", sampling_time=0.1)  # fmt: skip
    return scenario, pose[:, :, :3], pose[:, :, 3:]


def frame_at(run, row):
    scenario, pose, prop = run
    return Frame(scenario, 0.1 * row, row, pose[row], pose[:row], prop_pose=prop[row],
                 prop_path=prop[:row])  # fmt: skip


def drawn(stage, frame):
    surface = pygame.Surface(SIZE, 0, 32)
    stage.draw(surface, frame, CAMERA, Layers())
    return pygame.surfarray.array3d(surface).astype(int)


@pytest.mark.slow
def test_forward_row_by_row_memory_changes_no_pixel(run):
    remembering, plain = Stage(Painter(), MEMORY), Stage(Painter())
    for row in range(200):
        frame = frame_at(run, row)
        if row % 50 == 49:
            np.testing.assert_array_equal(drawn(remembering, frame), drawn(plain, frame))
        else:
            for stage in (remembering, plain):
                stage.draw(pygame.Surface(SIZE, 0, 32), frame, CAMERA, Layers())


def test_after_a_branch_the_old_paths_are_gone(run):
    scenario, pose, prop = run
    stage = Stage(Painter(), MEMORY)
    drawn(stage, frame_at(run, ROWS - 1))
    other = pose.copy()
    other[1000:, 0] = other[1000:, 0][::-1]
    frame = frame_at((scenario, other, prop), 2500)
    seen, wanted = drawn(stage, frame), drawn(Stage(Painter()), frame)
    assert np.abs(seen - wanted).mean() < 0.25


def test_dragging_back_draws_few_rows_anew(run):
    stage = Stage(Painter(), MEMORY)
    drawn(stage, frame_at(run, ROWS - 1))
    trails = stage._canvas.wakes.trails[1]
    grown = []
    prolong = type(trails).prolong

    def counted(self, surface, path, *leaping):
        grown.append(len(path) - self.drawn)
        prolong(self, surface, path, *leaping)

    type(trails).prolong = counted
    try:
        for row in range(ROWS - 1, 0, -50):
            drawn(stage, frame_at(run, row))
    finally:
        type(trails).prolong = prolong
    assert max(grown) <= 256, "no more than lie between two that are kept"


# -- while the camera moves -----------------------------------------------------------------------


def test_a_picture_that_is_moved_by_whole_pixels_is_what_it_would_be_drawn_anew(run, monkeypatch):
    monkeypatch.setattr("mars2d.output.raster.stage.PATIENCE", 0.0)  # as if all were slow
    monkeypatch.setattr("mars2d.output.raster.stage.MAX_AGE", 0.0)
    stage, frame = Stage(Painter(), MEMORY), frame_at(run, 1500)
    drawn(stage, frame)
    surface = pygame.Surface(SIZE, 0, 32)
    stage.draw(surface, frame, CAMERA.panned(2, -1), Layers(), hurried=True)
    kept = stage._canvas
    assert kept.still.get_width() > SIZE[0], "more is drawn than is seen"
    for k, later in ((20, 1500), (39, 1600)):
        frame, camera = frame_at(run, later), CAMERA.panned(2 * k, -k)
        stage.draw(surface, frame, camera, Layers(), hurried=True)
        assert stage._canvas is kept
        fresh = pygame.Surface(SIZE, 0, 32)
        Stage(Painter()).draw(fresh, frame, camera, Layers())
        seen, wanted = (pygame.surfarray.array3d(each).astype(int) for each in (surface, fresh))
        assert np.abs(seen - wanted).mean() < 0.25
    stage.draw(surface, frame, camera, Layers())
    assert np.abs(pygame.surfarray.array3d(surface).astype(int) - wanted).mean() < 0.25


@pytest.mark.parametrize("age", [0.0, np.inf])
def test_while_the_scale_changes_floor_and_paths_are_old_for_a_moment_only(run, monkeypatch, age):
    monkeypatch.setattr("mars2d.output.raster.stage.PATIENCE", 0.0)
    monkeypatch.setattr("mars2d.output.raster.stage.MAX_AGE", age)
    stage, surface = Stage(Painter(), MEMORY), pygame.Surface(SIZE, 0, 32)
    drawn(stage, frame_at(run, 1500))
    first = stage._canvas
    for k in range(1, 6):
        camera, frame = CAMERA.zoomed((320, 180), 1.05**k), frame_at(run, 1500 + 20 * k)
        stage.draw(surface, frame, camera, Layers(), hurried=True)
        assert (stage._canvas is first) == (age > 0)
        assert stage._canvas.wakes.trails[1].drawn == len(frame.path), "up to the newest row"
        if age == 0:
            assert stage._canvas.camera.scale == camera.scale
