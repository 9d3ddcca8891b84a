"""Forces in a crowd: a colour for each body in place of a mat of arrows."""

import numpy as np
import pygame
import pytest

from mars2d import Robot, Scenario
from mars2d.core.scene import Circle, Scene, Text
from mars2d.output.layers.forces import in_newtons
from mars2d.scenario.experiment import Experiment
from mars2d.window.run.heat import MOST, heat, squeezes
from mars2d.window.run.window import Window
from mars2d.world.timeline import Timeline


@pytest.fixture(scope="module")
def crowd():
    """Forty robots that press against a wall."""
    robots = [
        Robot(pose=(2 - k // 8 * 0.31, (k % 8 - 3.5) * 0.31, 0), controller=lambda _: (0.3, 0.0))
        for k in range(40)
    ]
    room = [(-3, -2), (2.2, -2), (2.2, 2), (-3, 2)]
    timeline = Timeline(Experiment(Scenario(robots=robots, workspace=room, on_exit="wall")))
    while timeline.newest < 25:
        timeline.advance()
    return timeline


def test_a_squeeze_is_the_sum_of_the_forces_on_a_body(crowd):
    frame, forces = crowd.frame, np.zeros(40)
    for row in frame.contacts:
        for body in (row["a"], row["b"]):
            if body >= 0:
                forces[body] += row["impulse"] / frame.scenario.sampling_time
    assert squeezes(frame) == pytest.approx(forces)


def test_above_thirty_contacts_colours_stand_for_arrows_and_the_pointer_reads_newtons(crowd):
    frame = crowd.frame
    assert len(frame.contacts) > MOST
    hottest = int(squeezes(frame).argmax())
    scene = Scene()
    heat(scene, frame)
    discs = [s for s in scene.shapes if isinstance(s, Circle) and s.fill is not None]
    assert np.hypot(*(discs[-1].center - frame.pose[:2, hottest])) < 1e-9, "the hottest is on top"
    assert sum(isinstance(shape, Text) for shape in scene.shapes) == 5
    window = Window(crowd, 1.0, (1280, 720))
    window.layers = window.layers.switched(forces=True)
    surface = pygame.Surface((1280, 720), 0, 32)
    window.draw(surface)
    assert window._arena._crowded
    pixel = tuple(window.camera.to_pixels([frame.pose[:2, hottest]])[0].astype(int).tolist())
    window.grab.move(pixel)
    said = in_newtons(float(squeezes(frame)[hottest]))
    marks = window.grab.marks(frame, more=said)
    assert f"robot{hottest}  {said}" in [each.text for each in marks if isinstance(each, Text)]
    window.layers = window.layers.switched(forces=False)
    window.draw(surface)
    assert not window._arena._crowded
