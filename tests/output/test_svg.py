"""SVG pictures say what a scene holds: at the right place, in few characters, and as valid XML."""

from __future__ import annotations

import base64
import re
import xml.etree.ElementTree as ET
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from mars2d.core.scene import WAKE_LINES, Scene
from mars2d.output.figures.extent import View
from mars2d.output.pages.svg import svg
from tests.cases import each_case

VIEW, SIZE = View(0.0, 4.0, 0.0, 2.0), (400.0, 200.0)  # 100 pixels a metre
NUMBER = r"-?(?:\d+\.?\d*|\.\d+)"


def drawn(scene, scale=1.0):
    """The elements of a picture after its white ground."""
    root = ET.fromstring(svg([(scene, scale)], VIEW, SIZE, "a test"))
    elements = [(each.tag.rpartition("}")[2], each) for each in root]
    assert [tag for tag, _ in elements[:2]] == ["title", "rect"]
    return elements[2:]


def only(scene, scale=1.0):
    [(tag, element)] = drawn(scene, scale)
    return tag, element


def corners(path):
    """The pixels (k, 2) of each stretch of a path of straight steps."""
    stretches = []
    for part in re.findall(r"M([^M]+)", path.removesuffix("Z")):
        numbers = np.array(re.findall(NUMBER, part), dtype=float).reshape(-1, 2)
        stretches.append(np.cumsum(numbers, axis=0))
    return stretches


def test_a_picture_has_its_size_white_ground_and_a_name_for_who_cant_see_it():
    root = ET.fromstring(svg([], VIEW, SIZE, "robots & <walls>"))
    assert (root.get("width"), root.get("height"), root.get("viewBox")) == (
        "400", "200", "0 0 400 200",
    )  # fmt: skip
    assert root.get("role") == "img"
    assert root.get("aria-label") == root[0].text == "robots & <walls>"
    assert root[1].attrib == {"width": "400", "height": "200", "fill": "#ffffff"}


def test_a_circle_lies_where_it_is_and_its_pixels_and_width_are_scaled():
    scene = Scene()
    scene.circle((1, 0.5), 0.3, fill="#00ff0080", stroke="red", width=2, pixels=4)
    tag, circle = only(scene, scale=0.5)
    assert tag == "circle"
    assert circle.attrib == {
        "cx": "100", "cy": "150", "r": "32", "fill": "#00ff00", "fill-opacity": "0.5",
        "stroke": "#d62728", "stroke-width": "1",
    }  # fmt: skip


def test_a_polygon_is_closed_and_filled():
    scene = Scene()
    scene.polygon([(0, 0), (1, 0), (1, 1)], fill="blue")
    tag, path = only(scene)
    assert tag == "path"
    assert path.get("d").endswith("Z")
    assert corners(path.get("d"))[0].tolist() == [[0, 200], [100, 200], [100, 100]]


def test_an_arrow_ends_at_its_tip_and_one_without_length_is_left_out():
    scene = Scene()
    scene.arrow((1, 1), (3, 1), fill="red", stroke="white")
    scene.arrow((1, 1), (1, 1), fill="red")
    _, path = only(scene)
    points = corners(path.get("d"))[0]
    assert points[:, 0].max() == pytest.approx(300)
    assert points[points[:, 0].argmax(), 1] == pytest.approx(100)
    assert path.get("paint-order") == "stroke"


@each_case(
    "anchor, x, above",
    [("center", 100, 0), ("left", 104, 0), ("right", 96, 0), ("above", 100, 10),
     ("below", 100, -10)],
)  # fmt: skip
def test_a_text_lies_on_the_side_that_its_anchor_says(anchor, x, above):
    scene = Scene()
    scene.text((1, 1), "here", size=12, anchor=anchor, halo="white")
    tag, text = only(scene)
    assert tag == "text"
    assert text.text == "here"
    assert float(text.get("x")) == x
    middle = float(text.get("y")) - 0.36 * 12  # of the letters
    assert middle == pytest.approx(100 - above, abs=0.01)
    expected = {"left": None, "right": "end"}.get(anchor, "middle")
    assert text.get("text-anchor") == expected
    assert (text.get("stroke"), text.get("paint-order")) == ("#ffffff", "stroke")


def test_texts_that_look_like_markup_or_that_xml_cant_hold_are_shown_as_text():
    scene = Scene()
    nasty = "</text><script>alert('a' & \"b\")</script>"
    scene.text((1, 1), nasty + "\x00\x1b\ud800")
    _, text = only(scene)
    assert text.text == nasty + 3 * "\N{REPLACEMENT CHARACTER}"
    assert len(text) == 0


@each_case("line", WAKE_LINES)
def test_each_line_style_goes_through_its_points(line):
    scene = Scene()
    scene.line([(0, 0), (1, 2), (2, 0), (3, 2)], stroke="green", style=line, width=2)
    _, path = only(scene)
    found = corners(path.get("d"))[0]
    assert found.tolist() == [[0, 200], [100, 0], [200, 200], [300, 0]]
    assert (path.get("stroke-dasharray") is None) == (line == "-")


def test_what_is_not_a_number_is_left_out_and_lines_have_gaps_there():
    nan = float("nan")
    scene = Scene()
    scene.circle((nan, 0), 1, fill="red")
    scene.circle((0, 0), nan, fill="red")
    scene.circle((0, 0), float("inf"), fill="red")
    scene.polygon([(0, 0), (1, nan), (1, 1)], fill="red")
    scene.text((nan, nan), "nowhere")
    scene.arrow((0, 0), (nan, 1), fill="red")
    scene.line([(nan, nan), (nan, 0)], stroke="red")
    scene.line(np.empty((0, 2)), stroke="red")
    scene.line([(0, 0), (1, 0), (nan, 0), (2, 0), (3, 0)], stroke="red")
    [(_, line)] = drawn(scene)
    found = [each.tolist() for each in corners(line.get("d"))]
    assert found == [[[0, 200], [100, 200]], [[200, 200], [300, 200]]]


def picture_in(element):
    data = element.get("href").removeprefix("data:image/png;base64,")
    return np.asarray(Image.open(BytesIO(base64.b64decode(data))))


def test_an_image_holds_its_pixels_and_large_ones_stay_sharp():
    pixels = np.arange(24, dtype=np.uint8).reshape(2, 3, 4)
    scene = Scene()
    scene.image(pixels, (1, 2, 0, 1))
    tag, image = only(scene)
    assert tag == "image"
    place = [image.get(name) for name in ("x", "y", "width", "height")]
    assert place == ["100", "100", "100", "100"]
    assert image.get("image-rendering") == "pixelated"
    assert np.array_equal(picture_in(image), pixels)


def test_the_same_scenes_make_the_same_text_without_ids():
    def made():
        scene = Scene()
        scene.circle((1, 1), 0.5, fill="red")
        scene.line(np.random.default_rng(1).random((100, 2)), stroke="blue", style="o--")
        scene.text((1, 1), "again")
        return svg([(scene, 1.0)], VIEW, SIZE, "twice")

    assert made() == made()
    assert " id=" not in made()
    assert "url(" not in made()
