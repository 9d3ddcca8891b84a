"""Broken and hostile files: always one line that names the file, never a hang, never a crash."""

from __future__ import annotations

import json
import struct
import time
import zlib
from collections.abc import Callable
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from PIL import Image

from mars2d import InputError
from mars2d.addons import Map
from mars2d.addons.maps import obstacles, read
from tests.cases import each_case

LONGEST = 10.0
"""Seconds that any file may take, on a slow machine."""

Maker = Callable[[Path], Path]
CASES: list[tuple[str, str, Maker]] = []


def case(expected: str) -> Callable[[Maker], Maker]:
    """Register a maker of a file that must be refused with these words."""

    def register(maker: Maker) -> Maker:
        CASES.append((maker.__name__, expected, maker))
        return maker

    return register


def text(name: str, content: str | bytes, expected: str, about: str) -> None:
    """Register a file of this content."""

    def make(folder: Path) -> Path:
        path = folder / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    CASES.append((about, expected, make))


# -- any format --------------------------------------------------------------------------------

SUFFIXES = (".dxf", ".svg", ".yaml", ".geojson", ".json", ".wkt")
IMAGES = (".png", ".pgm", ".jpg")
GARBAGE = np.random.default_rng(7).integers(0, 256, 5000, dtype=np.uint8).tobytes()

for suffix in (*SUFFIXES, *IMAGES):
    text(f"empty{suffix}", b"", "an empty file", f"empty{suffix}")
    text(f"garbage{suffix}", GARBAGE, "garbage", f"garbage{suffix}")
    text(f"zeros{suffix}", bytes(4000), "zeros", f"zeros{suffix}")


@case("there is no such file")
def missing(folder: Path) -> Path:
    return folder / "missing.dxf"


@case("a folder; expected a map")
def a_folder(folder: Path) -> Path:
    (folder / "plan.svg").mkdir()
    return folder / "plan.svg"


@case("expected a map: .dxf")
def of_no_known_kind(folder: Path) -> Path:
    (folder / "plan.dwg").write_bytes(b"AC1032")
    return folder / "plan.dwg"


# -- DXF ---------------------------------------------------------------------------------------


def dxf(
    folder: Path, draw: Callable[[ezdxf.document.Drawing], None], name: str = "bad.dxf"
) -> Path:
    document = ezdxf.new("R2010", units=6)
    draw(document)
    document.saveas(folder / name)
    return folder / name


HEADER = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1024\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n"


@case("contains itself")
def a_block_in_itself(folder: Path) -> Path:
    def draw(document):
        block = document.blocks.new("A")
        block.add_line((0, 0), (1, 0))
        block.add_blockref("A", (1, 1))
        document.modelspace().add_blockref("A", (0, 0))

    return dxf(folder, draw)


@case("contains itself")
def two_blocks_in_each_other(folder: Path) -> Path:
    def draw(document):
        for name, other in (("A", "B"), ("B", "A")):
            document.blocks.new(name).add_blockref(other, (0, 0))
        document.modelspace().add_blockref("A", (0, 0))

    return dxf(folder, draw)


@case("more than 30000 pieces")
def a_bomb_of_nested_blocks(folder: Path) -> Path:
    def draw(document):
        document.blocks.new("B0").add_line((0, 0), (1, 0))
        for k in range(1, 12):
            block = document.blocks.new(f"B{k}")
            for i in range(10):
                block.add_blockref(f"B{k - 1}", (i, 0))
        document.modelspace().add_blockref("B11", (0, 0))

    return dxf(folder, draw)


@case("more than 16 deep")
def a_tower_of_blocks(folder: Path) -> Path:
    def draw(document):
        document.blocks.new("B0").add_line((0, 0), (1, 0))
        for k in range(1, 400):
            document.blocks.new(f"B{k}").add_blockref(f"B{k - 1}", (1, 0))
        document.modelspace().add_blockref("B399", (0, 0))

    return dxf(folder, draw)


@case("more than 30000 pieces")
def an_array_of_a_billion(folder: Path) -> Path:
    def draw(document):
        document.blocks.new("B").add_line((0, 0), (1, 0))
        array = {"row_count": 32767, "column_count": 32767, "row_spacing": 1, "column_spacing": 1}
        document.modelspace().add_blockref("B", (0, 0), dxfattribs=array)

    return dxf(folder, draw)


@case("there are none")
def an_array_of_a_billion_empty_blocks(folder: Path) -> Path:
    def draw(document):
        document.blocks.new("B")
        array = {"row_count": 32767, "column_count": 32767}
        document.modelspace().add_blockref("B", (0, 0), dxfattribs=array)

    return dxf(folder, draw)


@case("more than 100000 points")
def circles_beyond_number(folder: Path) -> Path:
    def draw(document):
        block = document.blocks.new("B")
        for k in range(1000):
            block.add_ellipse((k, 0), (1, 0), 0.5)
        array = {"row_count": 100, "row_spacing": 3}
        document.modelspace().add_blockref("B", (0, 0), dxfattribs=array)

    return dxf(folder, draw)


@case("a SPLINE of degree 3")
def a_spline_with_60000_knots(folder: Path) -> Path:
    path = folder / "bad.dxf"
    count = 60_000
    points = "".join(f"10\n{k}.0\n20\n{k % 7}.0\n30\n0.0\n" for k in range(count))
    knots = "".join(f"40\n{k}.0\n" for k in range(count + 4))
    head = f"{HEADER}0\nSPLINE\n5\nAA\n100\nAcDbEntity\n8\n0\n100\nAcDbSpline\n70\n8\n71\n3\n"
    path.write_text(f"{head}72\n{count + 4}\n73\n{count}\n{knots}{points}0\nENDSEC\n0\nEOF\n")
    return path


@case("a SPLINE of degree 3000")
def a_spline_of_high_degree(folder: Path) -> Path:
    def draw(document):
        spline = document.modelspace().add_spline()
        spline.control_points = [(k, k % 3, 0) for k in range(900)]
        spline.knots = range(3901)
        spline.dxf.degree = 3000

    return dxf(folder, draw)


@case("more than 100000 points")
def a_polyline_without_end(folder: Path) -> Path:
    path = folder / "bad.dxf"
    corners = "".join(f"10\n{k}\n20\n{k % 2}\n" for k in range(101_000))
    head = "5\nAA\n100\nAcDbEntity\n8\n0\n100\nAcDbPolyline\n90\n101000\n70\n0\n"
    path.write_text(f"{HEADER}0\nLWPOLYLINE\n{head}{corners}0\nENDSEC\n0\nEOF\n")
    return path


@case("90000 corners or more")
def a_zigzag(folder: Path) -> Path:
    path = folder / "bad.geojson"
    corners = [[0.05 * k, k % 2] for k in range(90_000)]
    path.write_text(json.dumps({"type": "LineString", "coordinates": corners}))
    return path


@case("cross each other too many times")
def areas_upon_areas(folder: Path) -> Path:
    path = folder / "bad.geojson"
    rings = [[[[k / 99, 0], [k / 99 + 9, 0], [k / 99, 5], [k / 99, 0]]] for k in range(900)]
    path.write_text(json.dumps({"type": "MultiPolygon", "coordinates": rings}))
    return path


@case("corners or more")
def a_comb(folder: Path) -> Path:
    path = folder / "bad.geojson"
    corners = [[0.05 * k, 1 + k % 2] for k in range(90_000)]
    ring = [*corners, [4500, 0], [0, 0], corners[0]]
    path.write_text(json.dumps({"type": "Polygon", "coordinates": [ring]}))
    return path


@case("finite number")
def a_line_to_infinity(folder: Path) -> Path:
    return dxf(folder, lambda d: d.modelspace().add_line((0, 0), (1e300, 1)))


@case("finite number")
def a_line_to_nowhere(folder: Path) -> Path:
    path = dxf(folder, lambda d: d.modelspace().add_line((0, 0), (123.25, 1)))
    path.write_text(path.read_text().replace("123.25", "nan"))
    return path


@case("from the origin, expected at most")
def a_line_too_far_away(folder: Path) -> Path:
    return dxf(folder, lambda d: d.modelspace().add_line((0, 0), (1e9, 1)))


@case("m in size, expected a map")
def a_line_too_short(folder: Path) -> Path:
    return dxf(folder, lambda d: d.modelspace().add_line((0, 0), (1e-7, 0)))


@case("bad.dxf: a coordinate is")
def a_block_scaled_beyond_reason(folder: Path) -> Path:
    def draw(document):
        document.blocks.new("B").add_circle((0, 0), 1)
        document.modelspace().add_blockref("B", (0, 0), dxfattribs={"xscale": 1e200})

    return dxf(folder, draw)


@case("there are none, but 1 TEXT")
def nothing_but_text(folder: Path) -> Path:
    return dxf(folder, lambda d: d.modelspace().add_text("WALL"))


@case("there are none")
def nothing_at_all(folder: Path) -> Path:
    return dxf(folder, lambda d: None)


@case("there are none, but 1 INSERT of a missing block")
def a_block_that_is_not_there(folder: Path) -> Path:
    return dxf(folder, lambda d: d.modelspace().add_blockref("GONE", (0, 0)))


@case("$INSUNITS = 20")
def a_plan_in_parsecs(folder: Path) -> Path:
    def draw(document):
        document.units = 20
        document.modelspace().add_line((0, 0), (1, 1))

    return dxf(folder, draw)


@case("can't be read as a DXF drawing")
def half_a_dxf(folder: Path) -> Path:
    path = dxf(folder, lambda d: d.modelspace().add_line((0, 0), (1, 1)))
    data = path.read_bytes()
    path.write_bytes(data[: data.index(b"AcDbLine") + 20])
    return path


@case("can't be read as a DXF drawing")
def half_a_binary_dxf(folder: Path) -> Path:
    path = folder / "bad.dxf"
    document = ezdxf.new("R2010")
    document.modelspace().add_line((0, 0), (1, 1))
    document.saveas(path, fmt="bin")
    path.write_bytes(path.read_bytes()[:3000])
    return path


@case("there are none")
def a_drawing_of_no_known_version(folder: Path) -> Path:
    path = folder / "bad.dxf"
    path.write_text("0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC9999\n0\nENDSEC\n0\nEOF\n")
    return path


text("bad.dxf", "0\nSECTION\n" * 1000, "can't be read as a DXF drawing", "DXF of open sections")
text("bad.dxf", "0\n" * 100_000, "can't be read as a DXF drawing", "DXF of zeros as text")
text("bad.dxf", "0\nSECTION\n2\nENTITIES\n" + "0\nPOINT\n" * 1_000_000 + "0\nENDSEC\n0\nEOF\n",
     "more than 200000 entities", "a DXF of a million entities")  # fmt: skip
text("bad.dxf", b"AutoCAD Binary DXF\r\n\x1a\0" + b"\0\0POINT\0" * 1_000_000,
     "more than 200000 entities", "a binary DXF of a million entities")  # fmt: skip
text("bad.dxf", "x" * 10_100_000, "expected at most 10 MB", "too large a DXF")


# -- SVG ---------------------------------------------------------------------------------------

SVG = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'


def svg(content: str, expected: str, about: str, head: str = ' viewBox="0 0 10 10">') -> None:
    text("bad.svg", f"{SVG}{head}{content}</svg>", expected, about)


LAUGHS = "".join(f'<!ENTITY lol{k} "{f"&lol{k - 1};" * 10}">' for k in range(1, 10))
text("bad.svg", f'<!DOCTYPE svg [<!ENTITY lol0 "lol">{LAUGHS}]><svg>&lol9;</svg>',
     "has a <!DOCTYPE", "a billion laughs")  # fmt: skip
text("bad.svg", '<?xml version="1.0"?><!doctype svg SYSTEM "file:///etc/passwd"><svg/>',
     "has a <!DOCTYPE", "an external entity")  # fmt: skip
text("bad.svg", f"{SVG}>&undefined;</svg>", "can't be read as an SVG", "an unknown entity")
text("bad.svg", '<!DOCTYPE svg [<!ENTITY a "b">]><svg/>'.encode("utf-16"),
     "text in UTF-8", "an entity in UTF-16")  # fmt: skip
text("bad.svg", f"{SVG}><rect", "can't be read as an SVG", "half an SVG")
text("bad.svg", "<html><body/></html>", "its root is", "a page")
text("bad.svg", "<g>" * 200_000, "more than 64 deep", "groups without end")
text("bad.svg", f"{SVG}>" + "<g/>" * 30_000 + "</svg>", "more than 20000 elements", "many groups")
svg('<g id="a"><use href="#a"/></g>', "<use> of what it is part of", "a use of itself")
svg('<g id="a"><use xlink:href="#b"/></g><g id="b"><use href="#a"/></g>',
    "<use> of what it is part of", "uses of each other")  # fmt: skip
svg('<use href="http://example.com/plan.svg#a"/>', "expected #id", "a use of another file")
svg('<use href="file:///etc/passwd"/>', "expected #id", "a use of a secret")
svg('<defs><path id="u0" d="M0 0L1 1" stroke="red"/>' + "".join(
    f'<g id="u{k}">' + f'<use href="#u{k - 1}"/>' * 10 + "</g>" for k in range(1, 12)
) + '</defs><use href="#u11"/>', "by <use> of others", "a bomb of uses")  # fmt: skip
svg('<path d="M0 0 L1e400 5" stroke="red" fill="none"/>', "finite number", "a path to infinity")
svg('<path d="M0 0 Lnan 5 z" stroke="red"/>', "bad.svg", "a path to nowhere")
svg('<g transform="scale(1e200)"><rect width="5" height="5"/></g>', "finite number", "a huge scale")
svg('<g transform="' + "rotate(1) " * 50_000 + 'scale(1e18)"><rect width="5" height="5"/></g>',
    "bad.svg", "fifty thousand turns")  # fmt: skip
svg('<rect width="0.00001" height="0.00001"/>', "in size, expected a map", "a tiny rect")
svg('<rect width="5" height="5" fill="white"/>', "1 white or without a line", "white on white")
svg('<text x="1" y="1">WALL</text>', "there are none", "an SVG of text")
svg("", "there are none", "an SVG of nothing")
svg('<g transform="' + "rotate(1) " * 10_000 + '">' + "<path/>" * 15_000 + "</g>",
    "too many attributes", "turns for all")  # fmt: skip
svg(f'<g d="M0 0{"L1 1" * 20_000}">' + "<path/>" * 15_000 + "</g>",
    "too many attributes", "a path for all")  # fmt: skip
svg("<style>.a{fill:red}" + " " * 90_000 + "</style>" + f'<rect class="{"a " * 50_000}"/>',
    "too many attributes", "a class that is named too often")  # fmt: skip
svg('<g id="u0"/>' + "".join(f'<g id="u{k}"><use href="#u{k - 1}"/></g>' for k in range(1, 900))
    + '<use href="#u899"/>', "more than 64 deep", "a tower of uses")  # fmt: skip
svg('<g id="a&#27;"/>', "can't be read as an SVG", "an escape in a name")
svg('<path d="M0 0' + "L1 1" * 1_100_000 + '"/>', "more than 100000 points", "a path of megabytes")
svg('<polyline fill="none" stroke="red" points="' + "1 1 2 2 " * 60_000 + '"/>',
    "more than 100000 points", "a polyline without end")  # fmt: skip
TANGLE = " ".join(f"{k * 7919 % 10007} {k * 104729 % 10007}" for k in range(5000))
svg(f'<path d="M{TANGLE}z"/>',
    "cross each other too many times", "a tangle")  # fmt: skip
svg("<style>" + ".a{fill:none}" * 700_000 + '</style><rect width="5" height="5"/>',
    "too many attributes", "a style of megabytes")  # fmt: skip
# What the patterns of the library that reads SVG would look at again and again:
PLAIN = '<rect width="5" height="5"/>'
MANY = 300_000
svg(f"<style>{'a' * MANY}</style>{PLAIN}", "too many attributes", "a style of letters")
svg(f"<style>{'a{' * MANY}</style>{PLAIN}", "too many attributes", "a style of opened braces")
svg(f'<g transform="{"rotate(" * MANY}"/>{PLAIN}', "too many attributes", "turns never closed")
svg(f'<rect fill="rgb({"1" * MANY}" width="5" height="5"/>', "100 digits", "a colour of digits")
svg(f'<text style="font:{"1" * MANY}">a</text>{PLAIN}', "100 digits", "a font of digits")
svg(f'<path d="M0 0{"z" * MANY}"/>', "too many attributes", "a path closed without end")
svg(f'<path d="M0 0{"l1 1z" * 40_000}"/>', "too many attributes", "a path closed and gone on with")
svg(f'<path d="M0 0{"T5 5" * 10_000}"/>', "more than 100000 points", "curves without end")
svg('<rect width="5" height="5"/>', "viewBox", "a viewBox of words", ' viewBox="a b c d">')
svg('<rect width="5" height="5"/>', "viewBox", "a viewBox without area", ' viewBox="0 0 0 0">')
svg('<rect width="5" height="5"/>', "viewBox", "a viewBox of nan", ' viewBox="0 0 nan 1">')
svg('<circle r="1e300"/>', "finite number", "a circle as large as the world")


# -- GeoJSON and WKT ---------------------------------------------------------------------------


def geo(content: object, expected: str, about: str) -> None:
    data = content if isinstance(content, str) else json.dumps(content)
    text("bad.geojson", data, expected, about)


geo("[" * 200_000, "nested too deeply", "brackets without end")
geo('{"type": ', "can't be read as GeoJSON", "half a GeoJSON")
geo({"type": "Topology"}, "type 'Topology'", "a topology")
geo([1, 2], "expected GeoJSON", "a list")
geo({"type": "Polygon"}, "coordinates = None", "a polygon without corners")
geo(
    {"type": "Polygon", "coordinates": [[["a", "b"], [1, 2], [3, 4]]]},
    "expected positions",
    "words",
)
geo(
    {"type": "Polygon", "coordinates": [[[True, 1], [1, 2], [3, 4]]]}, "expected positions", "bools"
)
geo({"type": "Polygon", "coordinates": [[1, 2, 3]]}, "expected positions", "too flat a polygon")
geo({"type": "LineString", "coordinates": {"a": 1}}, "coordinates = ", "a dict of corners")
geo('{"type": "LineString", "coordinates": [[0, 0], [NaN, 1]]}', "NaN is no coordinate", "NaN")
geo('{"type": "LineString", "coordinates": [[0, 0], [Infinity, 1]]}', "Infinity is no", "Infinity")
geo('{"type": "LineString", "coordinates": [[0, 0], [1e999, 1]]}', "expected positions", "1e999")
geo('{"type": "LineString", "coordinates": [[0, 0], [' + "9" * 5000 + ", 1]]}",
    "can't be read as GeoJSON", "a number of 5000 digits")  # fmt: skip
geo({"type": "LineString", "coordinates": [[0, 0], [1e12, 1]]}, "from the origin", "far away")
geo({"type": "LineString", "coordinates": [[3, 3], [3, 3]]}, "1 line without length", "a dot")
geo(
    {"type": "Polygon", "coordinates": [[[0, 0], [1, 1], [2, 2]]]}, "1 Polygon without area", "flat"
)
geo({"type": "FeatureCollection", "features": [None]}, "None: expected GeoJSON", "no feature")
geo({"type": "FeatureCollection", "features": []}, "there are none", "no features")
nested: dict[str, object] = {"type": "Point", "coordinates": [0, 0]}
for _ in range(50):
    nested = {"type": "GeometryCollection", "geometries": [nested]}
geo(nested, "more than 16 deep", "collections without end")
geo({"type": "MultiLineString", "coordinates": [[[k, 0], [k, 1]] for k in range(30_001)]},
    "more than 30000 pieces", "too many lines")  # fmt: skip
geo({"type": "MultiLineString", "coordinates": [[[k, 0], [k, 1]] for k in range(12_000)]},
    "corners or more, expected at most 20000", "too many corners")  # fmt: skip
text("bad.wkt", "POLYGON ((0 0, 1 0, 1 1", "not closed", "half a WKT")
text("bad.wkt", "POLYGON ((0 0, 1 0))", "can't be read as WKT", "a ring of two")
text("bad.wkt", "WALL (0 0, 1 1)", "can't be read as WKT", "a WKT of its own")
text("bad.wkt", "GEOMETRYCOLLECTION(" * 300_000, "more than 16 deep", "a tower of WKT")
text("bad.wkt", "LINESTRING (0 0, nan 1)", "bad.wkt", "a WKT to nowhere")
text("bad.wkt", "LINESTRING (0 0, 1e300 1)", "finite number", "a WKT to infinity")
text("bad.wkt", "POINT (1 2)\nMULTIPOINT ((1 2))", "2 Point", "points")
text("bad.wkt", "LINESTRING EMPTY", "1 empty LineString", "an empty line")


# -- occupancy grids and images ----------------------------------------------------------------

GRID = {"image": "grid.pgm", "resolution": 0.05, "origin": [0, 0, 0]}


def grid(expected: str, about: str, raw: str | None = None, **fields: object) -> None:
    def make(folder: Path) -> Path:
        pixels = np.full((20, 30), 254, dtype=np.uint8)
        pixels[5:8, 5:20] = 0
        Image.fromarray(pixels).save(folder / "grid.pgm")
        chosen = {key: value for key, value in (GRID | fields).items() if value is not None}
        path = folder / "bad.yaml"
        path.write_text(raw if raw is not None else json.dumps(chosen))
        return path

    CASES.append((about, expected, make))


grid("can't be read as YAML", "a Python object", "!!python/object/apply:os.system ['true']")
grid("has an alias or anchor", "a bomb of aliases",
     "a: &a [x, x]\nb: &b [*a, *a]\nc: &c [*b, *b]\nimage: *c\nresolution: 1")  # fmt: skip
grid("can't be read as YAML", "half a YAML", "image: [grid.pgm")
grid("more than 100 brackets", "brackets in YAML", "[" * 20_000)
grid("0.13 MB; expected at most 0.064 MB", "too large a YAML", "# comment\n" * 13_000)
grid("expected an occupancy grid", "a YAML of a list", "[1, 2]")
grid("expected image", "no image", image=None)
grid("did you mean 'reslution'", "a misspelt resolution", resolution=None, reslution=0.05)
grid("resolution = 0", "no resolution", resolution=0)
grid("resolution = 'fine'", "a resolution in words", resolution="fine")
grid("resolution = nan", "a resolution of nan",
     "image: grid.pgm\nresolution: .nan\norigin: [0, 0, 0]")  # fmt: skip
grid("origin = ", "an origin of one", origin=[0])
grid("origin[0] = ", "an origin in words", origin=["a", 0, 0])
grid("origin = ", "a giddy origin", origin=[0, 0, 1e6])
grid("from the origin", "an origin far away", origin=[1e9, 0, 0])
grid("occupied_thresh", "thresholds that cross", free_thresh=0.8)
grid("mode = 'trinery'", "a misspelt mode", mode="trinery")
grid("negate = 'no'", "negate in words", negate="no")
grid("no absolute path", "an absolute image", image="/etc/passwd.png")
grid("no absolute path", "an image on a drive", image="C:\\maps\\grid.pgm")
grid("without ..", "an image elsewhere", image="../grid.pgm")
grid("the name of an image beside it", "an image that is none", image="grid.txt")
grid("the name of an image beside it", "an image that is a list", image=["grid.pgm"])
grid("there is no such file", "an image that is not there", image="gone.png")
grid("no pixel is occupied", "an empty grid", negate=1, occupied_thresh=1)


@case("no link that leads elsewhere")
def an_image_that_is_a_link(folder: Path) -> Path:
    (folder / "maps").mkdir()
    Image.new("L", (5, 5)).save(folder / "secret.png")
    (folder / "maps" / "grid.png").symlink_to(folder / "secret.png")
    path = folder / "maps" / "bad.yaml"
    path.write_text("image: grid.png\nresolution: 0.05")
    return path


def chunk(kind: bytes, data: bytes) -> bytes:
    checksum = struct.pack(">I", zlib.crc32(kind + data))
    return struct.pack(">I", len(data)) + kind + data + checksum


def png(width: int, height: int, data: bytes, depth: int = 8) -> bytes:
    header = struct.pack(">IIBBBBB", width, height, depth, 0, 0, 0, 0)
    chunks = chunk(b"IHDR", header) + chunk(b"IDAT", data) + chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + chunks


text("bad.png", png(100_000, 100_000, zlib.compress(bytes(1000))),
     "exceeds limit", "a PNG that claims ten billion pixels")  # fmt: skip
text(
    "bad.png", png(4000, 4000, zlib.compress(bytes(1000))), "can't be read as a PNG", "a short PNG"
)
text("bad.png", png(0, 0, b""), "bad.png", "a PNG of nothing")
text("bad.png", png(8, 8, b"garbage"), "can't be read as a PNG", "a PNG of garbage")
text("bad.png", png(8, 8, zlib.compress(bytes(136)), depth=16), "8 bits", "a PNG of 16 bits")
text("bad.png", b"GIF89a" + bytes(100), "this is no PNG", "a GIF")
text("bad.pgm", b"P5\n100000 100000\n255\n" + bytes(100), "exceeds limit", "a huge PGM")
text("bad.pgm", b"P5\n-5 -5\n255\n" + bytes(100), "bad.pgm", "a negative PGM")
text("bad.pgm", b"P5\nwide high\n255\n", "bad.pgm", "a PGM of words")
text("bad.pgm", b"P5\n10 10\n255\n" + bytes(50), "can't be read as a PGM", "half a PGM")
text("bad.pgm", b"P5\n10 10\n65535\n" + bytes(200), "8 bits", "a PGM of 16 bits")
text("bad.pgm", b"P9\n10 10\n255\n" + bytes(100), "this is no PGM", "a P9")
text("bad.pgm", b"P2\n2000 2000\n255\n" + b"9 " * 3_900_000, "bad.pgm", "a PGM as text")
text("bad.pgm", b"P5\n8 8\n255\n" + b"\xff" * 64, "no pixel is occupied", "a white PGM")


@case("corners, expected at most 100000")
def an_image_of_noise(folder: Path) -> Path:
    noise = np.random.default_rng(1).integers(0, 2, (2000, 2000), dtype=np.uint8) * 255
    Image.fromarray(noise).save(folder / "bad.png")
    return folder / "bad.png"


@case("corners or more, expected at most")
def a_checkerboard(folder: Path) -> Path:
    board = (np.indices((180, 180)).sum(axis=0) % 2 * 255).astype(np.uint8)
    Image.fromarray(board).save(folder / "bad.png")
    return folder / "bad.png"


@case("can't be read as a JPG")
def half_a_jpeg(folder: Path) -> Path:
    path = folder / "bad.jpg"
    Image.new("L", (500, 500)).save(path)
    path.write_bytes(path.read_bytes()[:700])
    return path


SLOW = {
    "a_spline_with_60000_knots", "a_polyline_without_end", "a_zigzag", "a_comb", "too_many_lines",
    "too_many_corners", "a_PGM_as_text", "a_checkerboard",
}  # fmt: skip
"""Cases that take more than a second."""


# -- all of them -------------------------------------------------------------------------------


@pytest.mark.slow
@each_case("expected, maker", [(expected, maker) for _, expected, maker in CASES])
def test_a_bad_file_is_refused_in_one_line_that_names_it(expected, maker, tmp_path):
    path = maker(tmp_path)
    resolution = 0.05 if path.suffix in IMAGES else None
    start = time.process_time()
    with pytest.raises(InputError) as caught:
        obstacles(read(path, resolution=resolution))
    assert time.process_time() - start < LONGEST
    message = str(caught.value)
    assert expected in message
    assert path.name in message
    assert "\n" not in message
    assert len(message) < 500


def test_enough_files_are_tried():
    assert len(CASES) >= 120


def test_the_same_is_said_by_a_map_and_by_the_command_line(tmp_path, child):
    path = tmp_path / "bad.svg"
    path.write_text(f"{SVG}></svg>")
    with pytest.raises(InputError) as caught:
        Map.from_file(path)
    code = f"from mars2d.cli import main; raise SystemExit(main(['check', {str(path)!r}]))"
    done = child(code)
    assert done.returncode == 2
    assert done.stderr == f"mars2d: {caught.value}\n"
