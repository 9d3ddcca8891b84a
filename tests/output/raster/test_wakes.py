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
from mars2d.output.raster.stage import Stage
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


def test_paths_that_grow_row_by_row_are_those_that_are_drawn_at_once(run):
    stage = Stage(Painter())
    for row in range(200):
        seen = drawn(stage, frame_at(run, row))
    assert np.abs(seen - drawn(Stage(Painter()), frame_at(run, 199))).mean() < 0.25


def test_after_a_branch_the_old_paths_are_gone(run):
    scenario, pose, prop = run
    stage = Stage(Painter())
    drawn(stage, frame_at(run, ROWS - 1))
    other = pose.copy()
    other[1000:, 0] = other[1000:, 0][::-1]
    frame = frame_at((scenario, other, prop), 2500)
    seen, wanted = drawn(stage, frame), drawn(Stage(Painter()), frame)
    assert np.abs(seen - wanted).mean() < 0.25


def test_while_the_scale_changes_the_floor_is_old_and_the_paths_are_new(run, monkeypatch):
    monkeypatch.setattr("mars2d.output.raster.stage.PATIENCE", 0.0)
    monkeypatch.setattr("mars2d.output.raster.stage.MAX_AGE", np.inf)
    stage, surface = Stage(Painter()), pygame.Surface(SIZE, 0, 32)
    drawn(stage, frame_at(run, 1500))
    first = stage._canvas
    for k in range(1, 6):
        camera, frame = CAMERA.zoomed((320, 180), 1.05**k), frame_at(run, 1500 + 20 * k)
        stage.draw(surface, frame, camera, Layers(), hurried=True)
        assert stage._canvas is first
        assert stage._canvas.wakes.drawn == len(frame.path), "up to the newest row"
