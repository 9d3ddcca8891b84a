"""Window, figure, notebook and replay paint the same layers in the same order."""

from __future__ import annotations

import colorsys
from dataclasses import replace

import numpy as np
import pygame
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

import mars2d
from mars2d import Animation, Robot, Scenario
from mars2d.addons import Addon, Communication, Map
from mars2d.bodies.joints import Rope, Spring
from mars2d.bodies.props import Ball, Box, Puck
from mars2d.core.scene import Circle, Scene
from mars2d.output.figures.figure import plot_paths
from mars2d.output.layers import bodies
from mars2d.output.layers.table import LAYERS, Layer, Layers
from mars2d.output.pages.notebook import drawn, svg_of
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.stage import Stage
from mars2d.scenario.neighbours import Within
from mars2d.sensors import Proximity, RangeFinder, SonarRing
from mars2d.sensors.base import Sensor
from tests.browser import Tab
from tests.cases import each_case

APART, RADIUS = 0.5, 0.35
CORNERS = {"#00ff00": (-5.0, -5.0), "#ff00ff": (5.0, 5.0)}
"""The colours of two marks in the uppermost layer, by which the plane is found in a picture."""


class Sticker(Sensor):
    """Draws the mark of the layer of sensors, wherever its robot is."""

    def read(self, robot, world, rng):
        return 1.0

    def draw(self, scene, pose, reading, color):
        scene.shapes.append(mark("sensors"))


class Painted(Addon):
    """Paints, draws and predicts something."""

    def paint(self, scene, area):
        scene.polygon([(2, 2), (4, 2), (4, 4), (2, 4)], fill="#f3e8c8")

    def draw(self, scene, frame):
        scene.circle((3, 3), 0.5, stroke="#123456", width=3)

    def theory(self, scene, frame):
        scene.line([(-5, -4), (5, -4)], stroke="#654321", width=2)


def law(world):
    """The first robot goes straight ahead, through all marks; others push, circle and talk."""
    if world.iteration % 3 == 0:
        world.robots[3].send({"time": world.time}, to=0)
    return np.array([[0.5, 0.3, 0.3, 0.1], [0.0, 0.0, 0.4, 0.3]])


BETWEEN = [[(3, 4.5), (3, 5)], [(3.5, 4.5), (3.5, 5)]]
BOUNCING = Ball(
    pose=(3.2, 4.7, 0), diameter=0.2, velocity=(1, 0, 0), restitution=1.0, ground_friction=0.0
)
"""It flies to and fro between two walls, so that there always is a blow to be seen."""


def scenario():
    return Scenario(
        robots=[
            Robot(pose=(-5.7, 0, 0), color="#000000", diameter=0.2, sensors=[Sticker()]),
            Robot(pose=(-4, -2, 0), sensors=[Proximity(range=0.8)]),
            Robot(pose=(0, -3, 0), sensors=[RangeFinder(beams=36, range=1.0)]),
            Robot(pose=(0, 3, 0), sensors=[SonarRing(range=1.0)]),
        ],
        props=[
            Box(pose=(-3.3, -2, 0)), Puck(pose=(1.5, -3, 0)), Box(pose=(-4, 3, 0)),
            Box(pose=(-3, 3, 0)), BOUNCING,
        ],
        joints=[Rope(a="robot2", b="puck1", length=3), Spring(a="box2", b="box3", rest_length=1)],
        addons=[
            Communication(delay=0.2), Painted(),
            Map(outlines=[[(-1, 4), (0, 4), (0, 5)]], walls=BETWEEN, restitution=1.0),
        ],
        neighbours=Within(5.0),
        animation=Animation(forces=True, theory=True),
        workspace=[(-6, -6), (6, -6), (6, 6), (-6, 6)],
        stop_time=22,
    )  # fmt: skip


MINE = Layer(name="mine", title="Mine", shapes=lambda frame: Scene([mark("mine")]))
NAMES = [layer.name for layer in LAYERS[:-1]] + [MINE.name, LAYERS[-1].name]
"""All layers, and one more before the last."""


def color(name):
    """Return the colour of the mark of a layer, different from those beside it."""
    hue = (NAMES.index(name) * 0.382) % 0.9
    return "#" + "".join(f"{round(255 * c):02x}" for c in colorsys.hsv_to_rgb(hue, 0.9, 0.9))


def place(name):
    return -4.5 + APART * NAMES.index(name), 0.0


def mark(name):
    return Circle(place(name), RADIUS, fill=color(name))


def marked(layer):
    """Return a layer whose shapes have its mark among them."""
    if layer.name in ("grid", "trails", "sensors"):
        return layer

    def shapes(frame):
        more = [mark(layer.name)]
        if layer.name == NAMES[-1]:
            more += [Circle(at, 0.3, fill=shade) for shade, at in CORNERS.items()]
        return Scene([*layer.shapes(frame).shapes, *more])

    return replace(layer, shapes=shapes, each=None)


@pytest.fixture(scope="module")
def record():
    return mars2d.run(scenario(), control=law, seed=2)


@pytest.fixture
def table():
    """Mark all layers, and register another one, for the time of a test."""
    before = LAYERS[:]
    LAYERS[:] = [marked(layer) for layer in before]
    LAYERS.insert(-1, MINE)
    yield LAYERS
    LAYERS[:] = before


def everything():
    return Layers(frozenset(layer.name for layer in LAYERS if layer.switch))


def drawn_at_the_end(record):
    """Return the last row at which a message is under way."""
    return max(k for k in range(len(record)) if len(record.frame(k).messages))


def window(record, row):
    surface = pygame.Surface((900, 900), 0, 32)
    Stage(Painter()).draw(surface, record.frame(row), Camera(70.0, 450.0, 450.0), everything())
    return pygame.surfarray.array3d(surface).swapaxes(0, 1).astype(int)


def figure(record, row):
    del row  # the last one
    ax = plot_paths(record, layers=everything())
    canvas = FigureCanvasAgg(ax.figure)
    ax.figure.set_dpi(170)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[:, :, :3].astype(int)


def check_order(picture):
    """Check that marks lie on each other as the table says, and paths and grid among them."""
    middle = {}
    for shade, at in CORNERS.items():
        rgb = [int(shade[k : k + 2], 16) for k in (1, 3, 5)]
        rows, columns = np.nonzero((np.abs(picture - rgb) < 12).all(axis=2))
        assert len(rows) > 50, "a mark of the uppermost layer is missing"
        middle[at] = columns.mean(), rows.mean()
    (left, low), (right, high) = middle.values()
    scale = (right - left) / 10

    def pixels(x, y, reach):
        px, py = round(left + (x + 5) * scale), round(low - (y + 5) * scale)
        return picture[py - reach : py + reach + 1, px - reach : px + reach + 1].reshape(-1, 3)

    def shows(x, y, name, reach=1):
        rgb = [int(color(name)[k : k + 2], 16) for k in (1, 3, 5)]
        return (np.abs(pixels(x, y, reach) - rgb) < 20).all()

    assert low - high == pytest.approx(10 * scale, rel=0.02)
    with_marks = [name for name in NAMES if name not in ("grid", "trails")]
    for name in with_marks:
        x, _ = place(name)
        assert shows(x - 0.1, -0.13, name), f"{name} is not on those below"
    above_grid, above_trails = NAMES.index("grid"), NAMES.index("trails")
    for k, name in enumerate(NAMES):
        if name not in with_marks:
            continue
        x, _ = place(name)
        crossed = not shows(x - 0.1, 0.0, name, reach=3)
        assert crossed is (k < above_trails), f"the path and {name}"
        if x % 2 == 0:  # where each painter's grid has a line
            lined = not shows(x, -0.13, name, reach=2)
            assert lined is (k < above_grid), f"the grid and {name}"


@pytest.mark.slow
@each_case("painter", [window, figure])
def test_pictures_have_all_layers_in_the_order_of_the_table(record, table, painter):
    check_order(painter(record, len(record) - 1))


def test_a_replay_has_all_layers_in_the_order_of_the_table(browser, record, table, tmp_path):
    tab = Tab(browser, (1700, 1000))
    tab.open(record.save_html(tmp_path / "layers.html"))
    tab.press("End", "u", "i")
    tab.click("Show")
    tab.click("Neighbours")
    tab.click("Ranges")
    check_order(tab.picture().astype(int))
    for layer in table:
        there = tab.page.locator(f"#layer-{layer.name}").count()
        assert there == layer.switch, layer.name
    tab.click("Mine")
    with pytest.raises(AssertionError, match="mine is not on"):
        check_order(tab.picture().astype(int))
    tab.close()
    assert tab.complaints == []


@pytest.mark.slow
def test_each_layer_of_the_scene_is_seen_in_window_notebook_and_replay(record, monkeypatch):
    """Each layer that is switched off is missed, and a page holds shapes of each."""
    monkeypatch.setattr(bodies, "SMALL", 0.1)  # all robots have one
    from tests.output.test_html import held

    row = drawn_at_the_end(record)
    frame = record.frame(row)
    content, columns = held(mars2d.output.pages.replay.page(record))
    full, text = window(record, row), svg_of(drawn(frame, "", everything()))
    for layer in list(LAYERS):
        if layer.shapes is None:
            continue
        assert layer.shapes(frame).shapes, layer.name
        if layer.switch:
            without = replace(everything(), **{layer.name: False})
            surface = pygame.Surface((900, 900), 0, 32)
            Stage(Painter()).draw(surface, frame, Camera(70.0, 450.0, 450.0), without)
            seen = pygame.surfarray.array3d(surface).swapaxes(0, 1)
            assert (seen != full).any(), layer.name
            assert svg_of(drawn(frame, "", without)) != text, layer.name
        if layer.name != "trails":  # the page draws paths of its poses
            assert len(columns[f"{layer.name}:rows"]) > 0, layer.name
    assert [layer["name"] for layer in content["layers"]] == [layer.name for layer in LAYERS]
