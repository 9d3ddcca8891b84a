"""The camera that keeps a body in view, or the whole team."""

from __future__ import annotations

import numpy as np
import pygame

from mars2d import Robot, Scenario, Unicycle, World
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.layout import Layout
from mars2d.record.frame import Frame
from mars2d.window.run.window import Window
from mars2d.window.screen.source import Playback
from mars2d.window.screen.viewpoint import Follow, Viewpoint

PLOT = pygame.Rect(0, 52, 1280, 580)
START = Camera(60.0, 100.0, 400.0)


def frame_of(*places):
    robots = [Robot(pose=(*place, 0)) for place in places]
    pose = np.array([(*place, 0.0) for place in places]).T
    return Frame(
        Scenario(robots=robots, workspace=None), 0.0, 0, pose, np.empty((0, 3, len(robots)))
    )


def followed(follow, camera, path, dt):
    """Return the pixels (k, 2) of the first robot while it goes along places, one each dt."""
    pixels = []
    for place in path:
        frame = frame_of(place, (1.0, 1.0))
        camera = follow.camera(camera, frame, PLOT, dt)
        pixels.append(camera.to_pixels([place])[0])
    return camera, np.array(pixels)


def test_a_body_comes_to_the_middle_without_going_beyond_it():
    camera, pixels = followed(Follow(0), START, [(0.0, 0.0)] * 180, 1 / 60)
    off = pixels - PLOT.center
    np.testing.assert_allclose(off[-1], 0, atol=0.1)
    assert (np.diff(np.abs(off), axis=0) <= 1e-6).all(), "it never turns back"
    assert camera.scale == START.scale


def test_how_quickly_does_not_depend_on_how_often_pictures_are_drawn():
    seen = {}
    for rate in (60, 30, 15):
        _, pixels = followed(Follow(0), START, [(0.0, 0.0)] * (rate // 5), 1 / rate)
        seen[rate] = pixels[-1]
    np.testing.assert_allclose(seen[30], seen[60], atol=1e-6)
    np.testing.assert_allclose(seen[15], seen[60], atol=1e-6)


def test_a_body_that_moves_is_followed_smoothly():
    path = [(0.3 * k / 60, 0.0) for k in range(600)]
    _, pixels = followed(Follow(0), START, path, 1 / 60)
    late = pixels[300:]
    assert np.abs(late - PLOT.center).max() < 10
    assert np.abs(np.diff(late, axis=0)).max() < 0.01, "it stays where it is on the screen"


def test_a_team_that_gathers_is_looked_at_from_nearer_up_to_a_bound():
    follow, camera = Follow(None), Camera(10, 640, 342)
    for _ in range(300):
        camera = follow.camera(camera, frame_of((0.0, 0.0), (0.5, 0.0)), PLOT, 1 / 60)
    assert 100 < camera.scale < 200
    np.testing.assert_allclose(camera.to_pixels([(0.25, 0.0)])[0], PLOT.center, atol=1)


def test_who_is_driven_is_always_inside_and_who_is_inside_moves_no_picture():
    scenario = frame_of((0, 0), (1, 1)).scenario
    view = Viewpoint(scenario, Layout.of((1280, 720), controls=True))
    room = pygame.Rect(60, 60, 800, 500)
    view.arrange(view.layout, scenario, room)
    view.keep(frame_of((0.5, 0.5), (1, 1)), (0, 1))
    before = view.camera
    for place in ((3, 2), (-20, 0), (0, 30), (500, -500)):
        frame = frame_of(place, (1, 1))
        view.keep(frame, ())
        view.keep(frame, (0,))
        (x, y), reach = view.camera.to_pixels([place])[0], 0.15 * view.camera.scale
        assert room.left + reach - 2 <= x <= room.right - reach + 2
        assert room.top + reach - 2 <= y <= room.bottom - reach + 2
    assert view.camera != before


def test_a_replay_without_a_workspace_shows_all_of_the_way():
    robot = Robot(controller=lambda _: (0.5, 0.0), drive=Unicycle(max_linear_speed=1.0))
    scenario = Scenario(robots=[robot], workspace=None, stop_time=40)
    world = World(scenario)
    while not world.over:
        world.step()
    record = world.record
    window = Window(Playback(record), size=(800, 600))
    window.draw(pygame.Surface((800, 600), 0, 32))
    ((x, _),) = window.camera.to_pixels(record.pose[-1, :2].T)
    assert window.layout.plot.left < x < window.layout.plot.right
    assert scenario.bounds is scenario.bounds, "each body is asked once, not for each picture"
