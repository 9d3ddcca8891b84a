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
from mars2d.window.screen.viewpoint import Viewpoint


def frame_of(*places):
    robots = [Robot(pose=(*place, 0)) for place in places]
    pose = np.array([(*place, 0.0) for place in places]).T
    return Frame(
        Scenario(robots=robots, workspace=None), 0.0, 0, pose, np.empty((0, 3, len(robots)))
    )


def viewpoint_at(x, y):
    """Return a viewpoint whose middle is a point, at 60 pixels a metre."""
    view = Viewpoint(frame_of((0, 0), (1, 1)).scenario, Layout.of((1280, 720)))
    left, top = view.layout.plot.center
    view.camera = Camera(60.0, left - 60 * x, top + 60 * y)
    return view


def followed(path, dt):
    """Return where the first robot is seen beside the middle, (k, 2) pixels, while it goes."""
    view = viewpoint_at(9.0, -1.0)
    view.follow(0)
    off = []
    for place in path:
        view.step(frame_of(place, (1.0, 1.0)), dt)
        off.append(view.camera.to_pixels([place])[0] - view.layout.plot.center)
    assert view.camera.scale == 60.0
    return np.array(off)


def test_a_body_comes_to_the_middle_without_going_beyond_it():
    off = followed([(0.0, 0.0)] * 180, 1 / 60)
    np.testing.assert_allclose(off[-1], 0, atol=0.1)
    assert (np.diff(np.abs(off), axis=0) <= 1e-6).all(), "it never turns back"


def test_a_body_that_moves_stays_where_it_is_on_the_screen():
    late = followed([(0.3 * k / 60, 0.0) for k in range(600)], 1 / 60)[300:]
    assert np.abs(late).max() < 1
    assert np.abs(np.diff(late, axis=0)).max() < 0.01


def test_a_team_is_shown_anew_where_one_leaves_the_picture_and_where_it_has_become_small():
    view, room = viewpoint_at(0.5, 0.5), Layout.of((1280, 720)).plot
    view.follow(None)
    view.step(frame_of((0.0, 0.0), (7.0, 4.0)), 1 / 60)
    assert view.camera.scale == 60.0, "all is well in view"
    for places in (((0.0, 0.0), (40.0, 3.0)), ((0.0, 0.0), (0.5, 0.0)), ((7.0, 7.0), (7.0, 7.4))):
        view.step(frame_of(*places), 1 / 60)
        seen = view.camera.to_pixels(places)
        assert all(room.collidepoint(pixel) for pixel in seen.tolist())
        assert 20 < np.hypot(*(seen[1] - seen[0])) < 0.8 * room.width
    before = view.camera
    view.step(frame_of((7.1, 7.0), (7.0, 7.4)), 1 / 60)
    assert view.camera is before


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
