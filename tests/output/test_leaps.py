"""A body that a hand puts elsewhere leaves no path on its way there, however it is drawn."""

from itertools import pairwise

import numpy as np
import pygame
import pytest

from mars2d import Animation, Robot, Scenario, World
from mars2d.bodies.props import Box
from mars2d.core.scene import Line
from mars2d.output.layers.table import Layers
from mars2d.output.layers.trails import trails
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.stage import Stage
from mars2d.record.frame import between
from tests.cases import each_case
from tests.worlds import ahead

BEFORE, AFTER = 10, 20
SIZE, CAMERA = (640, 480), Camera(60.0, 320.0, 240.0)
SEEN = Layers(grid=False, names=False)


def run(**changes):
    """Return a world at its end, the frames that were seen live, and its record.

    Robot 0 is put upwards at row 10, and the box downwards.
    """
    robots = [Robot(pose=(-3, y, 0), controller=ahead) for y in (0, -1)]
    world = World(Scenario(robots=robots, props=[Box(pose=(2, 0, 0))], stop_time=10, **changes))
    frames = []
    for row in range(AFTER):
        if row == BEFORE:
            world.operator.place(0, (-1, 3, 0))
            world.operator.place(2, (2, -3, 0))
        frames.append(world.frame)
        world.step()
    return [*frames, world.frame], world.record


@pytest.fixture(scope="module")
def runs():
    return run()


def lines(scene):
    return [shape.points for shape in scene.shapes if isinstance(shape, Line)]


def longest_step(points):
    return max((float(np.hypot(*step)) for step in np.diff(points, axis=0)), default=0.0)


@each_case("row", [BEFORE - 1, BEFORE, BEFORE + 1, AFTER - 1])
def test_a_path_has_a_gap_where_its_body_leapt(runs, row):
    frames, record = runs
    for frame in (frames[row], record.frame(row)):
        assert max(longest_step(points) for points in lines(trails(frame))) < 0.3
        assert len(lines(trails(frame))) == (5 if frame.leaps else 2)


@pytest.mark.slow
@each_case("style", ["-", "o"])
def test_the_picture_has_a_gap_live_and_replayed(style):
    frames, record = run(animation=Animation(wake_style=style))
    recorded = [record.frame(row) for row in range(AFTER)]
    half = [between(a, b, (a.time + b.time) / 2) for a, b in pairwise(recorded)]
    for shown in (frames, recorded, half):
        stage = Stage(Painter())
        for frame in [*shown, *shown[::-1]]:
            surface = pygame.Surface(SIZE, 0, 32)
            stage.draw(surface, frame, CAMERA, SEEN)
            (x, y), (bx, by) = CAMERA.to_pixels([(-1.5, 1.5), (2, -1.5)]).astype(int).tolist()
            seen = pygame.surfarray.array3d(surface).astype(int)
            ways = seen[x - 120 : x + 120, y - 20 : y + 20], seen[bx - 9 : bx + 9, by - 9 : by + 9]
            for part in ways:
                assert (part == part[0, 0]).all(), frame.iteration


def test_a_body_is_not_seen_on_its_way_and_has_no_speed_from_it(runs):
    _, record = runs
    first, second = record.frame(BEFORE - 1), record.frame(BEFORE)
    for share in (0.01, 0.5):
        now = between(first, second, first.time + share * (second.time - first.time))
        assert now.pose[1, 0] == now.prop_pose[1, 0] == 0
    assert (second.velocity[:, [0, 2]] == 0).all()
    assert second.velocity[0, 1] > 0.1
