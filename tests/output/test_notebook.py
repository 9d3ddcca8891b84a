"""Scenarios, worlds and records show themselves in notebooks, whatever parts of the user's do."""

from __future__ import annotations

import base64
import html
import importlib.util
import io
import platform
import re
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import mars2d
from mars2d import Robot, Scenario, World, sensors
from mars2d.addons import Addon, Map
from mars2d.bodies import props
from mars2d.output.pages import notebook
from mars2d.output.pages.replay import page
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment
from mars2d.sensors import Sensor
from mars2d.world.loop import simulate
from tests.cases import each_case
from tests.processes import PATIENCE

MAKER = "notebook.py"
NOTEBOOK = Path(__file__).parents[2] / "docs" / "notebook.ipynb"
REMAKE = f"run: python docs/{MAKER}"

SQUARE = [(1, 1), (2, 1), (2, 2), (1, 2)]


def drive(world):
    return np.tile([[0.3], [0.2]], len(world.robots))


def room(**changes):
    settings = {
        "title": "A room",
        "robots": [
            Robot(pose=(-3, -3, 0), name="Ada", sensors=[sensors.RangeFinder()]),
            Robot(pose=(-3, 3, 0), name="Bob"),
        ],
        "props": [props.Box(pose=(0, 0, 0.5))],
        "addons": [Map([SQUARE])],
        "stop_time": 3.0,
    }
    return Scenario(**(settings | changes))


def shown(thing):
    """What a notebook is sent of an object, by the kinds of content."""
    formatters = pytest.importorskip("IPython.core.formatters")
    formatter = formatters.DisplayFormatter()
    formatter.active_types = formatter.format_types
    return formatter.format(thing)[0]


def words(svg):
    """All texts of a picture, one a line."""
    root = ET.fromstring(svg)
    return [each.text for each in root.iter() if each.tag.endswith("}text")]


def test_a_scenario_shows_its_start_and_says_what_it_holds():
    found = shown(room())
    assert set(found) == {"image/svg+xml", "text/plain"}
    sentence = " ".join(words(found["image/svg+xml"])[-5:])
    assert "A room: 2 robots, 1 prop, 1 obstacle; 0.1 s a control step, 3 s at most" in sentence


def test_a_world_shows_what_is_seen_now_and_why_it_is_over():
    world = World(room(), drive)
    for _ in range(10):
        world.step()
    found = shown(world)
    assert set(found) == {"image/svg+xml", "text/plain"}
    assert words(found["image/svg+xml"])[-1] == "A room: t = 1 s of 3 s"
    world.stop("They have met")
    assert words(world._repr_svg_())[-1] == "A room: t = 1 s of 3 s; They have met"


def test_to_look_at_a_world_changes_nothing():
    def run(look):
        world = World(room(), drive, seed=3)
        while not world.over:
            look(world)
            world.step()
        return world.record.digest

    assert run(World._repr_svg_) == run(repr)


def test_a_record_shows_a_replay_and_the_picture_of_its_end_beneath_it():
    record = mars2d.run(room(), control=drive)
    found = shown(record)
    assert set(found) == {"text/html", "image/svg+xml", "text/plain"}
    assert found["text/plain"] == repr(record)
    frame = re.search(r'<iframe .*? srcdoc="([^"]*)"', found["text/html"])
    assert html.unescape(frame[1]) == page(record)
    assert ' sandbox="allow-scripts"' in frame[0]
    picture = re.search(r'<img [^>]*src="data:image/png;base64,([^"]*)"', found["text/html"])
    assert Image.open(io.BytesIO(base64.b64decode(picture[1]))).width > 500
    assert "31 rows to t = 3 s" in " ".join(words(found["image/svg+xml"]))


def test_the_replay_plays_in_its_frame_and_covers_the_picture(browser, tmp_path):
    record = mars2d.run(room(), control=drive)
    path = tmp_path / "cell.html"
    path.write_text(f"<meta charset=utf-8>{record._repr_html_()}", encoding="utf-8")
    page = browser.new_page(viewport={"width": 900, "height": 600}, reduced_motion="reduce")
    complaints = []
    page.on("console", lambda message: complaints.append(message.text))
    page.goto(path.as_uri())
    frame = page.frame_locator("iframe")
    frame.get_by_role("button", name="Play").click()
    frame.get_by_text("3.0 / 3.0 s").wait_for(timeout=PATIENCE * 1000)
    shape = page.locator("iframe").bounding_box()
    page.close()
    assert (shape["width"], shape["height"]) == pytest.approx((884, 480))
    assert complaints == []


def test_a_replay_too_large_for_a_notebook_is_a_picture_and_a_word_about_it(monkeypatch):
    record = mars2d.run(room(), control=drive)
    monkeypatch.setattr(notebook, "MAX_CHARACTERS", 1000)
    found = record._repr_html_()
    assert "<iframe" not in found
    assert "too large for a notebook" in found
    assert 'record.save_html("replay.html")' in found


class Failing(Addon):
    def draw(self, scene, frame):
        raise ValueError("no ink </text>")


class Blind(Sensor):
    def read(self, robot, around, rng):
        return 1.0

    def draw(self, scene, pose, reading, color):
        raise RuntimeError("dark")


def test_what_a_part_raises_while_it_is_drawn_stands_below_the_picture():
    robots = [Robot(pose=(0, 0, 0), name="Ada", sensors=[Blind()])]
    world = World(room(robots=robots, props=(), addons=[Failing()]), drive)
    world.step()
    joined = " ".join(words(world._repr_svg_()))
    assert "Not drawn: add-ons." in joined
    assert "no ink </text>" in joined
    assert "Not drawn: sensors." in joined
    assert "dark" in joined
    assert "Not drawn: add-ons." in " ".join(words(world.scenario._repr_svg_()))
    while not world.over:
        world.step()
    assert "Not drawn: add-ons." in " ".join(words(world.record._repr_svg_()))
    assert world.record._repr_html_().startswith(("<img", "<div"))


@pytest.mark.slow
@each_case("name", list(examples()))
def test_each_example_has_a_small_picture(name):
    experiment = open_experiment(name, {"stop_time": 0.5})
    pictures = experiment.scenario._repr_svg_(), simulate(experiment).record._repr_svg_()
    for picture in pictures:
        text = words(picture)
        assert len(picture) < 200_000
        assert not [line for line in text if "Not drawn" in line or "can't" in line]
        assert any(line.startswith(experiment.scenario.title[:12]) for line in text)


# -- the notebook in the documents ------------------------------------------------------------


@pytest.fixture(scope="module")
def stored():
    nbformat = pytest.importorskip("nbformat")
    found = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(found)
    return found


@pytest.fixture(scope="module")
def maker():
    spec = importlib.util.spec_from_file_location("notebook", NOTEBOOK.parent / "make" / MAKER)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def said(book):
    """What the cells of a notebook say as text, and which other kinds of content they show."""
    found = []
    for cell in book.cells:
        for output in cell.get("outputs", ()):
            assert output.output_type != "error", output
            data = output.get("data", {})
            found.append((output.get("text", data.get("text/plain")), sorted(data)))
    return found


def test_the_notebook_in_the_documents_is_that_of_the_script_and_small(stored, maker):
    written = [(cell.cell_type, cell.source) for cell in maker.written().cells]
    assert [(cell.cell_type, cell.source) for cell in stored.cells] == written, REMAKE
    assert NOTEBOOK.stat().st_size < 700_000
    counts = [cell.execution_count for cell in stored.cells if cell.cell_type == "code"]
    assert counts == list(range(1, len(maker.CELLS) + 1))


@pytest.mark.nightly
@pytest.mark.skipif(
    (sys.platform, platform.machine()) != ("linux", "x86_64"),
    reason="another platform may round the last digit differently, and then digests differ",
)
def test_the_notebook_in_the_documents_says_what_its_cells_say_today(stored, maker, tmp_path):
    for module in ("nbclient", "ipykernel", "pandas"):
        pytest.importorskip(module)
    assert said(maker.executed(tmp_path)) == said(stored), REMAKE
    assert {path.name for path in tmp_path.iterdir()} >= {"chase.npz", "chase.html"}
