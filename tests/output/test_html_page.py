"""A replay in a browser, driven by real clicks, keys and fingers: what is seen."""

import io
import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import mars2d
from mars2d import Robot, Scenario
from mars2d.addons import Communication, Map, Voronoi
from mars2d.bodies.props import Box
from mars2d.record.marks import marks_of
from mars2d.sensors import Proximity, RangeFinder
from tests.browser import Tab, differing

REFERENCES = Path(__file__).parent / "references"
EVIL = "<img src=x onerror=alert(1)>"
GREEN, ORANGE = "#009e73", "#d55e00"


def law(world):
    """Robot 0 pushes a box, robot 1 circles, robot 2 turns on the spot; 0 and 1 talk."""
    if world.iteration % 5 == 0:
        world.robots[0].send({"time": world.time}, to=1)
    return np.array([[0.3, 0.4, 0.0], [0.0, 0.4, 0.6]])


@pytest.fixture(scope="session")
def record():
    scenario = Scenario(
        robots=[
            Robot(pose=(-2.5, 0, 0), sensors=[Proximity(range=0.8)]),
            Robot(pose=(0.5, -2, 0), name=EVIL),
            Robot(pose=(-1.5, 1.8, 0), sensors=[RangeFinder(beams=60, range=2.0)]),
        ],
        props=[Box(pose=(-1.6, 0, 0.1), name="crate")],
        addons=[
            Communication(delay=0.2),
            Voronoi(),
            Map(outlines=[[(1.5, 1.2), (2.3, 1.2), (1.9, 2.2)]]),
        ],
        workspace=[(-3, -3), (3, -3), (3, 3), (-3, 3)],
        title=f"Push & {EVIL}",
        stop_time=12,
    )
    return mars2d.run(scenario, control=law, seed=7)


@pytest.fixture(scope="session")
def replay(record, tmp_path_factory):
    return record.save_html(tmp_path_factory.mktemp("replay") / "replay.html")


@pytest.fixture
def open_tab(browser):
    """Return what opens a page; at the end, none has asked for anything or complained."""
    tabs = []

    def open_page(path, size=(900, 640), **how):
        tab = Tab(browser, size, **how)
        tabs.append((tab, path))
        tab.open(path)
        return tab

    yield open_page
    for tab, path in tabs:
        tab.close()
        assert tab.asked == [path.as_uri()]
        assert tab.complaints == []


@pytest.fixture
def tab(open_tab, replay):
    return open_tab(replay)


def show_only(tab, *layers):
    """Switch off all layers but some, by their keys."""
    keys = {
        "trails": "t", "sensors": "s", "forces": "x", "messages": "m", "addons": "o",
        "theory": "y", "velocities": "u", "names": "i", "grid": "g",
    }  # fmt: skip
    for layer, key in keys.items():
        if tab.is_on(f"#layer-{layer}") != (layer in layers):
            tab.press(key)


# -- time -----------------------------------------------------------------------------------------


def test_buttons_and_keys_move_the_time(tab):
    assert (tab.row(), tab.text("#time")) == (0, "0.0 / 12.0 s")
    steps = {
        "One step on": 1, "To the end": 120, "One step back": 119, "To the start": 0,
    }  # fmt: skip
    for button, row in steps.items():
        before = tab.picture()
        tab.click(button)
        assert tab.row() == row
        assert differing(tab.picture(), before) > 0 or row == 1
    assert tab.page.locator("#slider").get_attribute("aria-valuetext") == "0.0 s of 12.0 s"
    keys = {"ArrowRight": 1, "PageDown": 11, "ArrowLeft": 10, "PageUp": 0, "End": 120, "Home": 0}
    for key, row in keys.items():
        tab.press(key)
        assert tab.row() == row, key


def test_it_plays_to_its_end_and_says_why_it_ended(tab, record):
    assert tab.page.locator("#banner").is_hidden()
    tab.page.select_option("#speed", "5")
    tab.press("Space")
    assert tab.page.get_by_role("button", name="Pause").is_visible()
    tab.page.wait_for_selector("#banner:visible")
    assert tab.row() == 120
    assert tab.text("#banner") == record.over_message
    assert record.over_message in tab.page.locator("#live").text_content()
    tab.page.select_option("#speed", "0.1")
    tab.click("Play")  # from the start again
    tab.click("Pause")
    assert tab.row() < 60  # however long the two clicks take
    assert tab.page.locator("#banner").is_hidden()
    assert "Paused at " in tab.page.locator("#live").text_content()


def test_the_slider_goes_where_it_is_dragged_and_by_its_keys(tab):
    box = tab.page.locator("#slider").bounding_box()
    middle = box["y"] + box["height"] / 2
    tab.page.mouse.move(box["x"] + 8, middle)
    tab.page.mouse.down()
    tab.page.mouse.move(box["x"] + box["width"] / 2, middle, steps=4)
    tab.page.mouse.up()
    tab.settle()
    row = tab.row()
    assert 55 < row < 65
    tab.page.locator("#slider").focus()
    tab.press("ArrowRight")
    assert tab.row() == row + 1
    assert tab.text("#time") == f"{(row + 1) / 10:.1f} / 12.0 s"


# -- what is shown --------------------------------------------------------------------------------


def test_layers_are_switched_by_buttons_and_keys(tab):
    tab.click("Show")
    tab.press(*["PageDown"] * 3, "ArrowRight")  # while a message is under way
    keys = {
        "Trails": "t", "Sensors": "s", "Forces": "x", "Messages": "m", "Add-ons": "o",
        "Velocities": "u", "Names": "i", "Grid": "g",
    }  # fmt: skip
    before = tab.picture()
    for layer, key in keys.items():
        switch = f"#layer-{layer.lower().replace('-', '')}"
        was = tab.is_on(switch)
        tab.click(layer)
        assert tab.is_on(switch) is not was
        assert differing(tab.picture(), before) > 1e-4, layer
        tab.press(key)
        assert tab.is_on(switch) is was
        assert differing(tab.picture(), before) < 1e-5, layer


def test_a_legend_says_how_long_a_force_is_and_follows_the_zoom(tab):
    show_only(tab, "forces")
    assert "slips" in tab.text("#legend").split("\n")
    far = tab.text("#legend").split()[:2]
    for _ in range(4):
        tab.click("Zoom in")
    near = tab.text("#legend").split()[:2]
    assert far[1] == near[1] == "N"
    assert float(near[0]) < float(far[0])
    show_only(tab, "velocities")
    assert "m/s" in tab.text("#legend")
    assert "slips" not in tab.text("#legend")
    show_only(tab)
    assert not tab.text("#legend").strip()


def test_n_goes_from_contact_to_contact_with_their_forces(record, tab):
    met = marks_of(record)["collision"]
    show_only(tab)
    tab.press("Home")
    for row in met[:2]:
        tab.press("n")
        assert tab.text("#time").startswith(f"{record.time[row]:.1f} /")
    assert tab.is_on("#layer-forces")
    tab.press("Shift+N")
    assert tab.text("#time").startswith(f"{record.time[met[0]]:.1f} /")
    tab.press("End", "n")
    assert tab.text("#time").startswith(f"{record.time[-1]:.1f} /")


SAID = """
window.said = [];
const fill = CanvasRenderingContext2D.prototype.fillText;
CanvasRenderingContext2D.prototype.fillText = function (text, ...rest) {
  said.push(text);
  return fill.call(this, text, ...rest);
};
"""
"""Notes what is written on the picture."""


def test_a_blow_has_its_impulse_for_a_second_and_x_switches_it_with_the_forces(open_tab, tmp_path):
    record = mars2d.run("billiards", stop_time=3.0)
    path = record.save_html(tmp_path / "billiards.html")
    tab = open_tab(path, script=SAID)

    def said_at(row):
        tab.page.evaluate("said = []")
        tab.go(row)
        return {text for text in tab.page.evaluate("said") if text.endswith(" N s")}

    assert said_at(10) == set()
    assert said_at(32) == {"0.25 N s", "0.37 N s", "0.50 N s", "0.40 N s", "0.43 N s"}
    legend = tab.page.locator("#legend").inner_text()
    assert "over 2.0 N s" in legend
    assert "friction, and its cone" in legend
    assert "over 0.50 N" in legend
    tab.press("x")
    assert said_at(33) == set()
    tab.press("x")
    assert "0.43 N s" in said_at(34)
    assert said_at(59) == set(), "a second later it is gone"


def test_it_zooms_and_moves_by_buttons_keys_wheel_and_mouse(tab):
    show_only(tab)
    fitted = tab.picture()
    x, y = tab.middle_of(GREEN)
    tab.page.mouse.move(x, y)
    tab.page.mouse.wheel(0, -300)
    tab.settle()
    assert differing(tab.picture(), fitted) > 0.01
    assert tab.middle_of(GREEN) == pytest.approx((x, y), abs=4)  # what is under the pointer stays
    for button in ("Show all", "Zoom in", "Show all", "Zoom out"):
        before = tab.picture()
        tab.click(button)
        assert differing(tab.picture(), before) > 0.01
        assert (differing(tab.picture(), fitted) == 0) is (button == "Show all")
    tab.press("f", "z", "Shift+Z")
    assert differing(tab.picture(), fitted) < 1e-3
    tab.press("f", "Shift+ArrowRight")
    assert tab.middle_of(GREEN) == pytest.approx((x - 40, y), abs=1)
    tab.page.mouse.move(x + 100, y + 150)
    tab.page.mouse.down()
    tab.page.mouse.move(x + 190, y + 210, steps=5)
    tab.page.mouse.up()
    tab.settle()
    assert tab.middle_of(GREEN) == pytest.approx((x + 50, y + 60), abs=1)
    assert tab.page.locator("#panel").is_hidden()  # a drag picks nothing


def test_a_robot_is_picked_where_it_is_drawn_and_its_numbers_are_those_of_the_record(tab, record):
    show_only(tab)
    tab.press(*["PageDown"] * 4)
    x, y = tab.middle_of(ORANGE)
    tab.page.mouse.click(x, y)
    tab.settle()
    assert tab.text("#panel h2") == EVIL
    assert tab.page.locator("#bodies").input_value() == "1"
    assert f"{EVIL} is picked" in tab.page.locator("#live").text_content()
    px, py, theta = record.pose[40, :, 1]
    said = tab.text("#panel").replace("\N{MINUS SIGN}", "-")
    turned = round((np.degrees(theta) + 180) % 360 - 180)
    v, omega = record.command[40, :, 1]
    pose = f"x {px:.2f} m", f"y {py:.2f} m", f"θ {turned}°"
    for words in (*pose, f"v {v:.2f} m/s", f"ω {omega:.2f} rad/s"):
        assert words in said
    tab.page.mouse.click(x, y - 90)  # beside it
    tab.settle()
    assert tab.page.locator("#panel").is_hidden()
    tab.page.select_option("#bodies", label="crate")
    assert tab.text("#panel .kind") == "box"
    tab.press("Escape")
    assert tab.page.locator("#panel").is_hidden()


# -- looks ----------------------------------------------------------------------------------------


def test_it_looks_as_it_did(open_tab, replay):
    tab = open_tab(replay, (700, 560))
    tab.press(*["PageDown"] * 6)
    show_only(tab, "trails", "sensors", "forces", "addons")  # all but letters
    reference = REFERENCES / "replay.png"
    seen = tab.picture()
    if os.environ.get("MARS2D_REFERENCES"):
        reference.parent.mkdir(exist_ok=True)
        Image.fromarray(seen).quantize(128).save(reference, optimize=True)
    with Image.open(reference) as image:
        assert differing(seen, np.asarray(image.convert("RGB"))) < 0.004


def test_dark_is_switched_by_button_and_key(tab):
    def screen():
        with Image.open(io.BytesIO(tab.page.screenshot())) as image:
            return np.asarray(image.convert("RGB"))

    light = screen()
    tab.click("Dark")
    assert tab.is_on("#dark")
    assert screen().mean() < 60 < 200 < light.mean()
    tab.press("d")
    assert differing(screen(), light) < 1e-3


# -- phones, frames -------------------------------------------------------------------------------


@pytest.mark.nightly
def test_on_a_phone_all_is_in_reach_of_a_thumb(open_tab, replay):
    tab = open_tab(replay, (360, 640), has_touch=True, is_mobile=True, device_scale_factor=2)
    assert tab.page.evaluate("document.documentElement.scrollWidth") == 360
    for control in tab.page.locator("button:visible, select:visible, input:visible").all():
        box = control.bounding_box()
        assert box["width"] >= 44, control
        assert box["height"] >= 44, control
        assert box["x"] >= 0, control
        assert box["x"] + box["width"] <= 360, control
        assert box["y"] + box["height"] <= 640, control
    tab.page.get_by_role("button", name="Show", exact=True).tap()
    tab.page.get_by_role("button", name="Trails").tap()
    tab.settle()
    assert not tab.is_on("#layer-trails")
    tab.page.get_by_role("button", name="Show", exact=True).tap()
    show_only(tab)
    x, y = tab.middle_of(ORANGE)
    tab.page.touchscreen.tap(x, y)
    tab.settle()
    assert tab.text("#panel h2") == EVIL


@pytest.mark.nightly
def test_two_fingers_zoom_about_their_middle(open_tab, replay):
    tab = open_tab(replay, (360, 640), has_touch=True, is_mobile=True)
    show_only(tab)
    x, y = tab.middle_of(ORANGE)
    before = np.hypot(*np.subtract(tab.middle_of(GREEN), (x, y)))
    tab.pinch((x, y), 60, 84)
    after = np.hypot(*np.subtract(tab.middle_of(GREEN), tab.middle_of(ORANGE)))
    assert tab.middle_of(ORANGE) == pytest.approx((x, y), abs=4)
    assert after / before == pytest.approx(84 / 60, rel=0.05)
    assert tab.page.locator("#panel").is_hidden()  # a pinch picks nothing


def test_it_begins_to_play_unless_motion_is_unwanted(open_tab, replay):
    for motion, plays in (("reduce", 0), ("no-preference", 1)):
        tab = open_tab(replay, reduced_motion=motion)
        tab.settle()
        assert tab.page.locator("body.playing").count() == plays


# -- words ----------------------------------------------------------------------------------------


@pytest.mark.nightly
def test_a_screen_reader_finds_the_controls(tab):
    tab.page.select_option("#bodies", label="robot0")
    tab.settle()
    tree = tab.page.locator("body").aria_snapshot()
    for line in (
        "heading", 'slider "Time"', 'button "Play"', 'button "One step on"', 'button "Zoom in"',
        'combobox "Speed"', 'combobox "Pick a robot or prop"', 'button "Help"', "status",
        'complementary "What is picked"', 'img "Push & ',
    ):  # fmt: skip
        assert line in tree, line
    assert "3 robots and 1 prop, seen from above at 0.0 s" in tree


def test_help_lists_the_keys(tab):
    tab.press("F1")
    for words in ("play, pause", "trails on and off", "clear the selection"):
        assert words in tab.text("#helping")
    tab.press("Escape")
    assert tab.page.locator("#helping").is_hidden()


def test_about_tells_where_the_run_comes_from(tab, record):
    assert tab.page.title() == f"Push & {EVIL}"  # names are text
    tab.click("About this run")
    said = tab.text("#telling")
    told = record.digest, record.versions["pymunk"], record.over_message
    for each in ("seed", "7", *told, "rounded by at most"):
        assert each in said
    tab.click("Close")
    assert tab.page.locator("#telling").is_hidden()


def test_a_damaged_file_or_an_old_browser_is_told_in_words(browser, replay, tmp_path):
    text = replay.read_text(encoding="utf-8")
    head, mark, rest = text.partition('type="text/plain">')
    (tmp_path / "cut.html").write_text(head + mark + rest[:400] + rest[800:], encoding="utf-8")
    for path, script, words in (
        (tmp_path / "cut.html", "", "This file is damaged"),
        (replay, "delete window.DecompressionStream", "This browser is too old"),
    ):
        tab = Tab(browser, (900, 640))
        tab.page.add_init_script(script)
        tab.page.goto(path.as_uri())
        tab.page.wait_for_selector("#trouble:visible")
        assert words in tab.text("#trouble")
        tab.close()
        assert tab.complaints == []
