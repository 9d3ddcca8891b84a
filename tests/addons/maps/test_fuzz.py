"""Good files with a few bytes changed: each is read, or refused in one line."""

from __future__ import annotations

import json
import logging
import random
import re

import ezdxf
import numpy as np
from PIL import Image

from mars2d import InputError
from mars2d.addons import Map
from tests.cases import each_case

TRIALS = 60

NUMBERS = [
    b"1e308",
    b"-1e308",
    b"nan",
    b"inf",
    b"0",
    b"-1",
    b"999999999",
    b"1e-300",
    b"",
    b"((",
    b"[[",
]

SVG = """<svg xmlns="http://www.w3.org/2000/svg" width="10cm" viewBox="0 0 10 8">
<style>.a{fill:none;stroke:#000}</style>
<g id="w" transform="translate(1 2) rotate(3) scale(2)">
<path class="a" d="M0 0C0 2 3 4 4 4S1 2 3 3Q2 2 4 0T1 1A2 3 10 0 1 6 4z"/>
<rect width="2" height="1" rx=".2"/><circle cx="5" cy="5" r="1"/><use href="#c" x="3"/>
<polyline points="1,1 2,2 3,1" stroke="red" fill="white"/></g>
<defs><ellipse id="c" rx="1" ry="2"/></defs></svg>"""

WKT = """POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0), (1 1, 2 1, 2 2, 1 1))
GEOMETRYCOLLECTION (POINT (1 1), LINESTRING (0 1, 1 0))"""

YAML = """image: grid.pgm
mode: trinary
resolution: 0.05
origin: [1.0, 2.0, 0.3]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.25
"""


def write(folder):
    """Write a good file of each kind."""
    document = ezdxf.new("R2000", units=6)
    block = document.blocks.new("B")
    block.add_lwpolyline([(0, 0, 0.3), (1, 1, 0), (2, 0, -0.4)], format="xyb", close=True)
    space = document.modelspace()
    array = {"row_count": 2, "column_count": 2, "row_spacing": 3, "column_spacing": 4}
    space.add_blockref("B", (1, 2), dxfattribs={"xscale": 2, "rotation": 30} | array)
    space.add_arc((0, 0), 2, 10, 80)
    space.add_ellipse((0, 0), (3, 0), 0.4, 0.2, 3)
    space.add_open_spline([(0, 0), (1, 2), (3, 1), (5, 5)])
    space.add_solid([(0, 0), (1, 0), (0, 1), (1, 1)])
    document.saveas(folder / "good.dxf")
    document.saveas(folder / "binary.dxf", fmt="bin")
    pixels = np.full((20, 30), 254, np.uint8)
    pixels[3:8, 4:20], pixels[5, 6], pixels[12, 3:9] = 0, 254, 100
    for name in ("grid.pgm", "good.pgm", "good.png", "good.jpg"):
        Image.fromarray(pixels).save(folder / name)
    rings = [[[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]], [[1, 1], [2, 1], [2, 2], [1, 1]]]
    (folder / "good.geojson").write_text(json.dumps({"type": "Polygon", "coordinates": rings}))
    (folder / "good.svg").write_text(SVG)
    (folder / "good.wkt").write_text(WKT)
    (folder / "good.yaml").write_text(YAML)


def changed(data, rng):
    """Return bytes with one to twenty changes."""
    data = bytearray(data)
    for _ in range(rng.choice([1, 1, 2, 5, 20])):
        place, end = rng.randrange(len(data) + 1), rng.randrange(len(data) + 1)
        kind = rng.randrange(4)
        numbers = [found.span() for found in re.finditer(rb"-?\d+\.?\d*", bytes(data))]
        if kind == 0 and numbers:
            first, last = rng.choice(numbers)
            data[first:last] = rng.choice(NUMBERS)
        elif kind == 1:
            data[place : place + 1] = bytes([rng.randrange(256)])
        elif kind == 2:
            del data[place : place + rng.randrange(200)]
        else:
            data[place:place] = data[end : end + rng.randrange(300)]
    return bytes(data)


@each_case(
    "name",
    [f"good.{kind}" for kind in ("dxf", "svg", "wkt", "geojson", "yaml", "pgm", "png", "jpg")]
    + ["binary.dxf"],
)
def test_a_good_file_with_some_bytes_changed_is_read_or_refused_in_one_line(name, tmp_path, caplog):
    caplog.set_level(logging.CRITICAL, "ezdxf")  # its log quotes bytes that are no text
    write(tmp_path)
    path = tmp_path / name
    good, rng = path.read_bytes(), random.Random(name)
    resolution = 0.05 if path.suffix in (".pgm", ".png", ".jpg") else None
    assert Map.from_file(path, resolution=resolution).obstacles()
    messages = []
    for _ in range(TRIALS):
        path.write_bytes(changed(good, rng))
        try:
            Map.from_file(path, resolution=resolution)
        except InputError as error:
            messages.append(str(error))
    assert len(messages) > 5
    assert [text for text in messages if name not in text or "\n" in text] == []
