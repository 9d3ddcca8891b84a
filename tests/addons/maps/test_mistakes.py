"""Files that are no map, or not what was meant: one line names the file and what was expected."""

from __future__ import annotations

import json

import ezdxf
import numpy as np
import pytest
from PIL import Image

from mars2d import InputError
from mars2d.addons.maps import SUFFIXES, obstacles, read
from mars2d.addons.maps.raster import IMAGES
from mars2d.cli.command_line import main
from tests.cases import each_case


def drawn(draw, units=6):
    """Return a writer of a DXF drawing."""

    def write(path):
        document = ezdxf.new("R2010", units=units)
        draw(document)
        document.saveas(path)

    return write


def line(*ends):
    return drawn(lambda document: document.modelspace().add_line(*ends))


def a_block_in_itself(document):
    block = document.blocks.new("A")
    block.add_blockref("A", (1, 1))
    document.modelspace().add_blockref("A", (0, 0))


def svg(content, head='viewBox="0 0 10 10"'):
    return f'<svg xmlns="http://www.w3.org/2000/svg" {head}>{content}</svg>'


def noise(path):
    pixels = np.random.default_rng(1).integers(0, 2, (600, 600), dtype=np.uint8) * 255
    Image.fromarray(pixels).save(path)


def specks(path):
    pixels = np.full((400, 400), 255, dtype=np.uint8)
    pixels[::4, ::4] = 0
    Image.fromarray(pixels).save(path)


def image(mode, color):
    return lambda path: Image.new(mode, (8, 8), color).save(path)


def grid(**fields):
    """Return a writer of an occupancy grid; a field that is None is left out."""

    def write(path):
        pixels = np.full((20, 30), 254, dtype=np.uint8)
        pixels[5:8, 5:20] = 0
        Image.fromarray(pixels).save(path.with_name("grid.pgm"))
        whole = {"image": "grid.pgm", "resolution": 0.05, "origin": [0, 0, 0]} | fields
        path.write_text(json.dumps({k: v for k, v in whole.items() if v is not None}))

    return write


def geojson(kind, coordinates):
    return json.dumps({"type": kind, "coordinates": coordinates})


GARBAGE = np.random.default_rng(7).integers(0, 256, 5000, dtype=np.uint8).tobytes()
RECT = '<rect width="5" height="5"/>'
COMB = [[0.05 * k, k % 2] for k in range(21_000)]

CASES = [
    *((suffix, b"", "an empty file; expected a map") for suffix in SUFFIXES),
    *((suffix, GARBAGE, "bad") for suffix in SUFFIXES),
    (".dwg", b"AC1032", "expected a map: .dxf"),
    (".dxf", b"x" * 10_100_000, "10.1 MB; expected at most 10 MB"),
    (".dxf", drawn(lambda d: None), "expected lines or areas; there are none"),
    (".dxf", drawn(lambda d: d.modelspace().add_text("WALL")), "there are none, but 1 TEXT"),
    (".dxf", drawn(lambda d: d.modelspace().add_blockref("GONE", (0, 0))), "a missing block"),
    (".dxf", drawn(a_block_in_itself), "can't be read as a DXF drawing: it is nested too deeply"),
    (".dxf", line((0, 0), (1e300, 1)), "expected a finite number"),
    (".dxf", line((0, 0), (1e9, 1)), "from the origin, expected at most"),
    (".dxf", drawn(lambda d: None, units=20), "$INSUNITS = 20"),
    (".svg", "<svg><rect", "can't be read as an SVG drawing"),
    (".svg", svg('<rect width="5" height="5" fill="white"/>'), "1 white or without a line"),
    (".svg", svg('<path d="M0 0H1e300" stroke="red"/>'), "m from the origin, expected at most"),
    (".svg", svg(RECT, 'viewBox="a b c d"'), "viewBox"),
    (".geojson", '{"type": ', "can't be read as GeoJSON"),
    (".geojson", '{"type": "Topology"}', "{'type': 'Topology'}: expected GeoJSON"),
    (".geojson", geojson("LineString", [[0, 0], [float("nan"), 1]]), "expected a finite number"),
    (
        ".geojson",
        geojson("LineString", COMB),
        "expected at most 20000: choose a tolerance above 0.02 m",
    ),
    (".yaml", "image: [grid.pgm", "can't be read as YAML"),
    (".yaml", "!!python/object/apply:os.system ['true']", "expected an occupancy grid"),
    (".yaml", grid(image=None), "expected an occupancy grid: image"),
    (".yaml", grid(resolution=None, reslution=0.05), "'reslution'; did you mean 'resolution'?"),
    (".yaml", grid(resolution="fine"), "resolution = 'fine'"),
    (".yaml", grid(free_thresh=0.8), "0 <= free_thresh <= occupied_thresh"),
    (".yaml", grid(image="gone.png"), "there is no such file beside it"),
    (
        ".yaml",
        "type: line_segments\ndata: lines.dat\nscale: 1",
        "layers or line_segments; expected",
    ),
    (".png", b"GIF89a" + bytes(100), "this is no PNG"),
    (".png", noise, "corners, expected at most 100000: is it a map? remove specks (single pixels)"),
    (".png", specks, "30000 corners or more, expected at most 20000: remove specks (single"),
    (".pgm", b"P5\n100000 100000\n255\n" + bytes(100), "exceeds limit"),
]


@each_case(("suffix", "content", "said"), CASES)
def test_what_is_no_map_is_refused_in_one_line(suffix, content, said, tmp_path):
    path = tmp_path / f"bad{suffix}"
    if callable(content):
        content(path)
    else:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    resolution = 0.05 if suffix in IMAGES else None
    with pytest.raises(InputError) as caught:
        obstacles(read(path, resolution=resolution))
    message = str(caught.value)
    assert said in message
    assert path.name in message
    assert "\n" not in message


def test_the_command_line_says_the_same(tmp_path, capsys):
    path = tmp_path / "bad.svg"
    path.write_text(svg(""))
    assert main(["check", str(path)]) == 2
    assert capsys.readouterr().err == ("mars2d: bad.svg: expected lines or areas; there are none\n")
