"""What is kept from one picture to the next saves time, has a bound, and changes no pixel."""

import numpy as np
import pygame
import pytest

from mars2d import Robot, Scenario, World
from mars2d.addons import Map
from mars2d.output.raster.painter import Painter
from mars2d.scenario.animation import Animation
from mars2d.sensors import Proximity, RangeFinder
from mars2d.window.run.window import Window
from mars2d.window.screen.source import Playback
from tests.cases import each_case
from tests.window.written import pixels

STEPS = 60


def sprite(width, height):
    return pygame.Surface((width, height), pygame.SRCALPHA, 32), 0, 0


def test_a_full_store_is_emptied_and_what_is_too_large_is_not_kept():
    painter = Painter(kept=300)
    for name in "abcd":
        painter._store(name, sprite(10, 10))
    assert list(painter._sprites) == ["d"]
    painter._store("e", sprite(20, 20))
    assert not painter._sprites


# -- pictures -------------------------------------------------------------------------------------


def run(sensor=None, **animation):
    """Return the record of a team that scans and wanders among obstacles."""
    seeing = Robot(diameter=0.4, sensors=[sensor or RangeFinder(range=4.0)])
    places = [(-3, -2, 0.3), (2.5, 1, 2.0), (0, 3, -1.0), (3, -3, 1.2)]
    scenario = Scenario(
        robots=[seeing.at(*pose) for pose in places],
        on_exit="wall",
        stop_time=0.1 * STEPS,
        addons=[Map([[(0, 0), (1, 0), (1, 1)], [(-4, 2), (-2, 3)]])],
        animation=Animation(**animation),
    )
    turns = np.array([0.4, -0.7, 1.0, 0.2])
    world = World(scenario, lambda world: np.vstack([np.full(4, 0.8), turns]))
    while not world.over:
        world.step()
    return world.record


@pytest.fixture(scope="module")
def record():
    return run()


class Viewer:
    """A window of a record, and a surface to draw it on."""

    def __init__(self, record, *, plain=False):
        self.window = Window(Playback(record), 1.0, (1280, 720))
        self.window.player._clock = lambda: 0.0  # it never falls behind, however busy the machine
        if plain:
            self.window.looks.painter = painter = Painter(kept=0)
            dock = self.window.dock
            dock.painter = dock.inspector.painter = self.window._arena._stage.painter = painter
        self.plain = plain
        self.size = (1280, 720)

    def draw(self):
        self.window.viewpoint._hurry = 0.0  # as after a rest: in motion pictures may be rough
        self.window.dock.inspector._drawn_at = -1e9
        surface = pygame.Surface(self.size, 0, 32)
        self.window.draw(surface)
        return surface

    def play(self, pictures, draw):
        for _ in range(pictures):
            self.window.player.pass_time(0.04)  # between the control steps as well
            if draw:
                self.draw()


SITUATIONS = {
    "nothing": lambda viewer: None,
    "zoom": lambda viewer: look(viewer, viewer.window.camera.zoomed((500, 300), 3.0)),
    "pan": lambda viewer: look(viewer, viewer.window.camera.panned(130.3, -61.7)),
    "select": lambda viewer: viewer.window.select(2),
    "restart": lambda viewer: viewer.window.player.restart(),
    "resize": lambda viewer: setattr(viewer, "size", (700, 640)),
    "no paths": lambda viewer: viewer.window._toggle("trails"),
    "pause": lambda viewer: viewer.window.player.pause_or_resume(),
}


def look(viewer, camera):
    viewer.window.viewpoint._look(camera)


@pytest.mark.nightly
@each_case("situation", SITUATIONS)
def test_what_is_kept_changes_no_pixel(record, situation):
    kept, plain = Viewer(record), Viewer(record, plain=True)
    for viewer in (kept, plain):
        viewer.play(20, draw=True)
        SITUATIONS[situation](viewer)
        viewer.play(5, draw=True)
    assert len(kept.window.looks.painter._sprites) > 0
    assert len(plain.window.looks.painter._sprites) == 0
    assert np.array_equal(pixels(kept.draw()), pixels(plain.draw()))


def test_what_a_sensor_sees_moves_with_its_robot_between_two_readings():
    record = run(Proximity(range=1.0))
    kept, plain = Viewer(record), Viewer(record, plain=True)
    for viewer in (kept, plain):
        viewer.play(21, draw=True)
        viewer.play(1, draw=False)  # between the same control steps
    assert np.array_equal(pixels(kept.draw()), pixels(plain.draw()))


def test_what_stays_between_two_pictures_is_not_drawn_again(record, monkeypatch):
    viewer = Viewer(record)
    viewer.window._toggle("sensors")
    viewer.play(10, draw=True)
    viewer.window.player.pause_or_resume()
    before = viewer.draw()

    def refuse(*arguments, **options):
        raise AssertionError("a shape was drawn again")

    monkeypatch.setattr("mars2d.output.raster.brushes.layer", refuse)
    assert np.array_equal(pixels(viewer.draw()), pixels(before))
