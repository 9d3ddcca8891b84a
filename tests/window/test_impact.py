"""The card of an impact, which opens with the keys that go from contact to contact."""

import pygame

import mars2d
from mars2d import Robot, Scenario
from mars2d.bodies import Ball
from mars2d.scenario.experiment import Experiment
from mars2d.window.run.window import Window
from mars2d.window.screen.source import Playback
from mars2d.window.widgets.panel import LINE
from mars2d.world.timeline import Timeline
from tests.cases import each_case
from tests.window.states import Preferences


@each_case("live", [False, True])
def test_the_keys_of_contacts_open_the_card_of_what_the_touch_did(live):
    balls = [Ball(name="a", velocity=(1, 0, 0)), Ball(name="b", pose=(0.5, 0, 0), mass=3.0)]
    scenario = Scenario(robots=[Robot(pose=(0, 3, 0))], props=balls, stop_time=1)
    source = Timeline(Experiment(scenario)) if live else Playback(mars2d.run(scenario))
    window = Window(source, 0.0 if live else 1.0, (900, 700), Preferences())
    surface = pygame.Surface((900, 700))
    window.draw(surface)
    assert not window.dock.impact.is_open
    window._actions["contact"]()
    while window.player.busy:
        window.player.pass_time(0.1)
    assert window.dock.impact.is_open
    window.draw(surface)
    assert window.dock.plates["impact"].height >= 12 * LINE * window.layout.ui
    (rows,) = window.dock.impact._cards(window.player.frame)
    table = {label: numbers for label, *numbers in rows}
    assert table[""] == ["a", "b", "both"]
    assert table["before, along [m/s]"] == ["1", "0", "1 nearer"]
    assert table["after, along"] == ["-0.5", "0.5", "1 apart"]
    assert table["energy lost [J]"] == ["0.375", "-0.375", "0"]
    assert table["momentum before [N s]"] == table["momentum after"] == ["", "", "(1, 0)"]
    assert table["restitution"] == ["", "", "1"]
    window._escape()
    assert not window.dock.impact.is_open
    window._actions["contact_back"]()
    assert window.dock.impact._cards(window.player.frame) == []
    window.draw(surface)
