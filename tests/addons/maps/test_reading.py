"""What is in a file is what stands in the way: each format, each kind of thing, each option."""

from __future__ import annotations

import json
from math import pi

import ezdxf
import numpy as np
import pytest
import shapely
from ezdxf.xclip import XClip
from PIL import Image

from mars2d import InputError
from mars2d.addons import Map
from mars2d.addons.maps import obstacles, read
from tests.cases import each_case


def dxf(path, *, units=6):
    """A new drawing and its model space; `save` it with `.saveas(path)`."""
    document = ezdxf.new("R2010", units=units)
    return document, document.modelspace()


def length(drawing):
    return sum(p.geometry.length for p in drawing.pieces)


def same(drawing, wkt, tolerance=1e-6):
    """Whether a drawing's pieces cover what a text in WKT says, to a tolerance."""
    found = shapely.union_all([p.geometry for p in drawing.pieces])
    return found.hausdorff_distance(shapely.from_wkt(wkt)) < tolerance


# -- DXF ---------------------------------------------------------------------------------------


@pytest.fixture
def plan(tmp_path):
    return tmp_path / "plan.dxf"


def test_lines_and_polylines_of_a_dxf_are_walls(plan):
    document, space = dxf(plan)
    space.add_line((0, 0), (4, 0))
    space.add_lwpolyline([(4, 0), (4, 3), (0, 3)])
    space.add_polyline2d([(0, 3), (0, 1), (0, 0)])
    document.saveas(plan)
    drawing = read(plan)
    assert same(drawing, "LINESTRING (0 0, 4 0, 4 3, 0 3, 0 0)")
    assert obstacles(drawing).walls == (((0, 0), (0, 3), (4, 3), (4, 0), (0, 0)),)


def test_blocks_are_placed_scaled_turned_mirrored_and_nested(plan):
    document, space = dxf(plan)
    inner = document.blocks.new("INNER")
    inner.add_line((0, 0), (1, 0))
    outer = document.blocks.new("OUTER", base_point=(1, 0))
    outer.add_blockref("INNER", (1, 0), dxfattribs={"xscale": 2, "yscale": 2, "rotation": 90})
    space.add_blockref("OUTER", (10, 5), dxfattribs={"xscale": -1, "rotation": 90})
    document.saveas(plan)
    # twice as long and upright in OUTER, at its base point; turned by 90 degrees, mirrored first
    assert same(read(plan), "LINESTRING (10 5, 8 5)")


def test_what_is_on_layer_0_of_a_block_is_on_the_layer_of_its_reference(plan):
    document, space = dxf(plan)
    block = document.blocks.new("DOOR")
    block.add_line((0, 0), (1, 0))
    block.add_line((0, 0), (0, 1), dxfattribs={"layer": "HINGES"})
    space.add_blockref("DOOR", (3, 3), dxfattribs={"layer": "DOORS"})
    document.saveas(plan)
    assert read(plan).layers == {"DOORS": 1, "HINGES": 1}


def test_hidden_layers_are_read_only_when_they_are_named(plan):
    document, space = dxf(plan)
    for k, name in enumerate(("WALLS", "OFF", "FROZEN", "NO_PLOT")):
        document.layers.add(name)
        space.add_line((0, k), (1, k), dxfattribs={"layer": name})
    document.layers.get("OFF").off()
    document.layers.get("FROZEN").freeze()
    document.layers.get("NO_PLOT").dxf.plot = 0
    document.saveas(plan)
    assert read(plan).layers == {"WALLS": 1}
    assert read(plan).others == {"OFF": 1, "FROZEN": 1, "NO_PLOT": 1}
    assert read(plan, layers=["off", "FRO*"]).layers == {"OFF": 1, "FROZEN": 1}
    assert read(plan, layers="WALLS, off").layers == {"WALLS": 1, "OFF": 1}


@each_case(("units", "metres"), [(1, 0.0254), (2, 0.3048), (4, 1e-3), (5, 1e-2)])
def test_the_unit_is_that_of_the_header_unless_it_is_given(plan, units, metres):
    document, space = dxf(plan, units=units)
    space.add_line((0, 0), (100, 0))
    document.saveas(plan)
    assert read(plan).size[0] == pytest.approx(100 * metres)
    assert read(plan, unit="m").size[0] == pytest.approx(100)
    assert read(plan, unit=0.5).size[0] == pytest.approx(50)


def test_a_size_that_is_implausible_has_a_hint_which_unit_would_fit(plan):
    document, space = dxf(plan, units=4)
    space.add_line((0, 0), (900, 500))
    document.saveas(plan)
    assert read(plan).hint == (
        "0.9 m is small for a map of robots: is it unit=cm (9 m) or unit=in (22.9 m)?"
    )
    assert read(plan, unit="in").hint == ""
    assert "large" in read(plan, unit="m").hint


def test_a_map_far_away_is_moved_to_where_it_is_wanted(plan):
    document, space = dxf(plan)
    space.add_line((4_500_000, 5_400_000), (4_500_010, 5_400_005))
    document.saveas(plan)
    with pytest.raises(InputError, match=r"at=\(0, 0\) moves it"):
        read(plan)
    assert read(plan, at=(1, 2)).bounds == pytest.approx((1, 11, 2, 7))


def clipped(document):
    block = document.blocks.new("B")
    block.add_circle((0, 0), 5)
    clip = XClip(document.modelspace().add_blockref("B", (0, 0)))
    clip.set_block_clipping_path([(0, 0), (9, 0), (9, 9), (0, 9)])


def framed(document):
    line = document.modelspace().add_polyline2d([(0, 0), (1, 0), (0, 9), (9, 9)])
    line.dxf.flags |= 4
    for vertex, flag in zip(line.vertices, (8, 8, 16, 16), strict=True):
        vertex.dxf.flags = flag


def pierced(document):
    paths = document.modelspace().add_hatch().paths
    paths.add_polyline_path([(0, 0), (4, 0), (4, 4), (0, 4)], flags=1)
    paths.add_polyline_path([(1, 1), (2, 1), (2, 2), (1, 2)], flags=16)


def mirrored(document):
    document.blocks.new("B").add_lwpolyline([(0, 0), (3, 0), (3, 1)])
    document.modelspace().add_blockref("B", (5, 0), dxfattribs={"extrusion": (0, 0, -1)})


def of_zero_height(document):
    document.blocks.new("B").add_line((0, 0), (3, 0))
    document.modelspace().add_blockref("B", (5, 0), dxfattribs={"zscale": 0})


@each_case(
    ("draw", "expected"),
    [
        (clipped, "LINESTRING (5 0, 4.04508497 2.93892626, 1.545085 4.755283, 0 5)"),
        (framed, "LINESTRING (0 0, 1 0)"),
        (pierced, "POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0), (1 1, 2 1, 2 2, 1 2, 1 1))"),
        (mirrored, "LINESTRING (-5 0, -8 0, -8 1)"),
        (of_zero_height, "LINESTRING (5 0, 8 0)"),
        (
            lambda d: d.modelspace().add_solid([(0, 0), (2, 0), (0, 1), (2, 1)]),
            "POLYGON ((0 0, 2 0, 2 1, 0 1, 0 0))",
        ),
        (
            lambda d: d.modelspace().add_lwpolyline(
                [(0, 0), (4, 0)], dxfattribs={"const_width": 1}
            ),
            "POLYGON ((0 -0.5, 4 -0.5, 4 0.5, 0 0.5, 0 -0.5))",
        ),
        (
            lambda d: d.modelspace().add_mline([(0, 0), (4, 0)]),
            "MULTILINESTRING ((0 0, 4 0), (0 -1, 4 -1))",
        ),
        (lambda d: d.layout("Layout1").add_line((0, 0), (9, 9)), "LINESTRING EMPTY"),
    ],
)
def test_a_dxf_is_read_as_its_own_program_shows_it(plan, draw, expected):
    document, space = dxf(plan)
    space.add_line((20, 0), (21, 0))
    draw(document)
    document.saveas(plan)
    found = shapely.union_all([p.geometry for p in read(plan, tolerance=0).pieces])
    whole = shapely.from_wkt(expected).union(shapely.box(20, 0, 21, 0))
    assert found.difference(whole.buffer(0.25)).is_empty
    assert whole.difference(found.buffer(0.25)).is_empty


def test_a_block_on_a_frozen_layer_is_hidden_as_a_whole(plan):
    document, space = dxf(plan)
    block = document.blocks.new("B")
    block.add_line((0, 0), (1, 0))
    block.add_line((0, 1), (1, 1), dxfattribs={"layer": "WALLS"})
    for name, hide in (("FROZEN", "freeze"), ("OFF", "off")):
        getattr(document.layers.add(name), hide)()
        space.add_blockref("B", (0, 0), dxfattribs={"layer": name})
    document.saveas(plan)
    assert read(plan).layers == {"WALLS": 1}
    assert read(plan).others == {"FROZEN": 2, "OFF": 1}


def test_what_is_damaged_in_a_dxf_is_counted_and_the_rest_is_read(plan):
    document, space = dxf(plan)
    space.add_open_spline([(0, 0), (1, 0), (2, 0), (3, 1)]).knots = [0, 1]
    space.add_line((0, 0), (3, 0))
    document.saveas(plan)
    drawing = read(plan)
    assert same(drawing, "LINESTRING (0 0, 3 0)")
    assert drawing.skipped == {"damaged SPLINE": 1}


def test_a_damaged_dxf_is_repaired_and_said_to_be(plan):
    document, space = dxf(plan)
    space.add_line((0, 0), (3, 0))
    document.saveas(plan)
    text = plan.read_text()
    plan.write_text(text[: text.rindex("OBJECTS")])
    drawing = read(plan)
    assert same(drawing, "LINESTRING (0 0, 3 0)")
    assert "missing ENDSEC" in dict(drawing.notes)["damaged"]


# -- SVG ---------------------------------------------------------------------------------------


def svg(tmp_path, content, head='viewBox="0 0 10 8"'):
    path = tmp_path / "plan.svg"
    namespaces = (
        'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
        'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
    )
    path.write_text(f"<svg {namespaces} {head}>{content}</svg>")
    return path


LINE = 'fill="none" stroke="black"'
STYLE = "<style>#w g > rect{fill:none;stroke:red}</style>"


def test_what_is_filled_is_solid_what_has_a_line_alone_is_a_wall_y_points_up(tmp_path):
    path = svg(tmp_path, f'<rect x="1" y="1" width="2" height="1"/><path d="M5 8V4" {LINE}/>')
    found = Map.from_file(path)
    assert shapely.Polygon(found.outlines[0]).equals(shapely.box(1, 6, 3, 7))
    assert found.walls == (((5, 0), (5, 4)),)


@each_case(
    ("content", "areas", "walls"),
    [
        (f'<rect width="2" height="1" fill="white"/><path d="M0 0H1" {LINE}/>', 0, 1),
        ('<rect width="2" height="1" fill="white" stroke="red"/>', 0, 1),
        ('<rect width="2" height="1" style="fill:#fff;stroke:red"/>', 0, 1),
        ('<rect width="2" height="1" fill="gray" stroke="red"/>', 1, 0),
        ('<rect width="2" height="1" fill="gray" fill-opacity="0" stroke="red"/>', 0, 1),
        ('<style>.w{fill:none;stroke:#000}</style><rect class="w" width="2" height="1"/>', 0, 1),
        ('<g fill="none" stroke="red"><rect width="2" height="1"/></g>', 0, 1),
        (f'<line x1="1" y1="1" x2="2" y2="2" {LINE}/>', 0, 1),
        (f'<polyline points="1,1 2,2 3,1" {LINE}/>', 0, 1),
        ('<polygon points="1,1 2,2 3,1"/>', 1, 0),
        ('<circle r="1"/><ellipse cx="5" cy="5" rx="2" ry="1"/>', 2, 0),
        (f'<path d="M0 0H1" {LINE}/><g style="display:none"><circle r="1"/></g>', 0, 1),
        (f'<path d="M0 0H1" {LINE}/><circle r="1" visibility="hidden"/>', 0, 1),
        (f'<path d="M0 0H1" {LINE}/><defs><circle r="1"/></defs>', 0, 1),
        (f'<path d="M0 0H1" {LINE}/><symbol><circle r="1"/></symbol>', 0, 1),
        (f'<path d="M0 0H1" {LINE}/><marker><circle r="1"/></marker>', 0, 1),
        ('<defs><circle id="c" r="1"/></defs><use href="#c" x="5"/><use xlink:href="#c"/>', 2, 0),
        ('<symbol id="c"><circle r="1"/></symbol><use href="#c" x="5"/>', 1, 0),
        (f'<g opacity="0"><circle r="1"/></g><path d="M0 0H1" {LINE}/>', 0, 1),
        (f'<path d="M0 0H1" {LINE}/><path d="M0 1H1" stroke="red" opacity="0"/>', 0, 1),
        (f'<path d="M0 0H1" {LINE}/><path d="M0 1H1" stroke="red" stroke-width="0"/>', 0, 1),
        (f'<path d="M0 0H1" {LINE}/><path d="M0 1H1" stroke="white"/>', 0, 1),
        (
            f'{STYLE}<g id="w"><g><rect width="2" height="1"/></g></g><rect width="1" height="1"/>',
            1,
            1,
        ),
    ],
)
def test_what_is_seen_is_read(tmp_path, content, areas, walls):
    drawing = read(svg(tmp_path, content))
    kinds = [piece.geometry.geom_type for piece in drawing.pieces]
    assert (kinds.count("Polygon"), kinds.count("LineString")) == (areas, walls)


BOX = '<rect width="100" height="100" fill="red"/>'
USE = '<use href="#s" x="5" y="5" width="2" height="2"/>'
SIZE = 'markerWidth="2" markerHeight="2" markerUnits="userSpaceOnUse"'
MARKER = f'<marker id="m" {SIZE}>{BOX}</marker>'
HALF = (
    '<clipPath id="c"><rect width="1" height="1" transform="translate(0 2) scale(2)"/></clipPath>'
)


@each_case(
    ("content", "expected"),
    [
        (
            '<g transform="translate(4 4)"><rect width="2" height="1" transform="rotate(90)"/></g>',
            shapely.box(3, 2, 4, 4),
        ),
        ('<rect x="4" width="4" height="2" transform="rotate(90)" transform-origin="5 3"/>',
         shapely.box(6, 2, 8, 6)),
        ('<rect width="2" height="2" style="transform:rotate(45deg);transform-origin:1px 1px"/>',
         shapely.Point(1, 7).buffer(2**0.5, quad_segs=1)),
        (f'<symbol id="s" viewBox="0 0 100 100">{BOX}</symbol>{USE}', shapely.box(5, 1, 7, 3)),
        (f'<svg x="2" y="1" width="4" height="2" viewBox="0 0 100 100">{BOX}</svg>',
         shapely.box(3, 5, 5, 7)),  # in the middle of its place
        (f'<svg x="2" y="1" width="4" height="2" viewBox="0 0 50 50">{BOX}</svg>',
         shapely.box(3, 5, 6, 7)),  # cut off at its edge
        (f'<svg width="4" height="2" viewBox="0 0 100 100" preserveAspectRatio="none">{BOX}</svg>',
         shapely.box(0, 6, 4, 8)),
        ('<rect x="10%" y="25%" width="50%" height="50%"/>', shapely.box(1, 2, 6, 6)),
        (f'{HALF}<g clip-path="url(\'#c\')"><rect width="9" height="3"/></g>',
         shapely.box(0, 5, 2, 6)),
        ('<rect width="3" height="3"/><rect x="1" width="1" height="9" fill="white"/>',
         shapely.union(shapely.box(0, 5, 1, 8), shapely.box(2, 5, 3, 8))),  # white covers
        (f'{MARKER}<path d="M1 1V2" marker-end="url(#m)"/>', shapely.box(1, 4, 3, 6)),
    ],
)  # fmt: skip
def test_shapes_are_where_a_browser_shows_them(tmp_path, content, expected):
    assert same(read(svg(tmp_path, content)), expected.wkt, 1e-4)


@each_case(
    ("rule", "inner", "area"),
    [
        ("nonzero", "M1 1H3V3H1z", 16),
        ("nonzero", "M1 1V3H3V1z", 12),
        ("evenodd", "M1 1H3V3H1z", 12),
        ("evenodd", "M1 1V3H3V1z", 12),
    ],
)
def test_the_rule_by_which_a_path_is_filled_counts(tmp_path, rule, inner, area):
    drawing = read(svg(tmp_path, f'<path fill-rule="{rule}" d="M0 0H4V4H0z{inner}"/>'))
    assert sum(p.geometry.area for p in drawing.pieces) == pytest.approx(area)


def test_a_layer_is_the_innermost_group_with_a_label_or_an_id(tmp_path):
    content = (
        '<g id="layer1" inkscape:label="Walls"><g><circle r="1"/></g></g>'
        '<g id="doors"><circle r="2"/><g id="inner"><circle r="3"/></g></g><circle r="4"/>'
    )
    drawing = read(svg(tmp_path, content))
    assert drawing.layers == {"Walls": 1, "doors": 1, "inner": 1, "no layer": 1}


@each_case(
    ("head", "width"),
    [
        ('viewBox="0 0 100 80"', 50),
        ('width="200" height="160" viewBox="0 0 100 80"', 50),
        ('width="100mm" height="80mm" viewBox="0 0 100 80"', 0.05),
        ('width="1000cm" height="800cm" viewBox="0 0 100 80"', 5),
        ('width="96in" height="80in"', 50 * 0.0254 / 96),
        ('width="100%" height="100%" viewBox="0 0 100 80"', 50),
        ('viewBox="-20 -20 100 80"', 50),
        ('width="1000mm" height="100mm" viewBox="0 0 100 50"', 0.1),  # the height decides
        ('width="200mm" height="900mm" viewBox="0 0 100 5" preserveAspectRatio="none"', 0.1),
    ],
)
def test_the_unit_is_that_of_the_width_or_else_a_metre(tmp_path, head, width):
    path = svg(tmp_path, f'<path d="M0 0H50" {LINE}/><text>A</text>', head)
    assert read(path).skipped == {"text": 1}
    assert read(path).size[0] == pytest.approx(width)
    assert read(path, unit="cm").size[0] == pytest.approx(0.5)


@each_case(
    ("head", "corner"),
    [
        ('width="200mm" height="100mm" viewBox="0 0 100 100"', (0.05, 0.1)),
        ('width="200mm" height="100mm" viewBox="0 0 100 100" preserveAspectRatio="xMinYMin"',
         (0, 0.1)),
        ('width="200mm" height="100mm" viewBox="0 0 100 100" preserveAspectRatio="xMidYMid slice"',
         (0, 0.15)),
        ('width="297mm" height="210mm"', (0, 0.21)),
    ],
)  # fmt: skip
def test_the_lower_left_corner_of_the_page_is_the_origin(tmp_path, head, corner):
    drawing = read(svg(tmp_path, f'<path d="M0 0H50" {LINE}/>', head))
    assert (drawing.bounds[0], drawing.bounds[3]) == pytest.approx(corner)


def test_an_svg_with_a_doctype_and_entities_is_read(tmp_path):
    path = svg(tmp_path, '<path d="M0 0H5" style="&line;"/>')
    path.write_text(
        '<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "svg11.dtd" '
        f'[<!ENTITY line "fill:none;stroke:red">]>{path.read_text()}'
    )
    assert same(read(path), "LINESTRING (0 8, 5 8)")


# -- GeoJSON ---------------------------------------------------------------------------


def test_geojson_has_solid_polygons_walls_and_layers(tmp_path):
    path = tmp_path / "plan.geojson"
    rings = [[[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]], [[1, 1], [3, 1], [3, 3], [1, 3], [1, 1]]]
    features = [
        ({"layer": "walls"}, {"type": "Polygon", "coordinates": rings}),
        ({"name": "doors"}, {"type": "MultiLineString", "coordinates": [[[5, 0, 1], [6, 0, 9]]]}),
        (None, {"type": "LineString", "coordinates": [[7, 0], [8, 0]]}),
        ({}, {"type": "Point", "coordinates": [1, 1]}),
        ({}, None),
    ]
    data = [{"type": "Feature", "properties": p, "geometry": g} for p, g in features]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": data}))
    drawing = read(path)
    assert drawing.layers == {"walls": 1, "doors": 1, "no layer": 1}
    assert drawing.skipped == {"Point": 1}
    assert drawing.pieces[0].geometry.area == pytest.approx(12)
    assert read(path, layers="doors", unit="cm").size == pytest.approx((0.01, 0))


# -- pixels ------------------------------------------------------------------------------------

CELLS = np.array([[1, 1, 1, 1, 1], [1, 0, 0, 0, 1], [1, 0, 0, 1, 0], [1, 1, 1, 0, 0]], dtype=bool)


def grid(tmp_path, pixels, **fields):
    Image.fromarray(pixels.astype(np.uint8)).save(tmp_path / "grid.png")
    path = tmp_path / "grid.yaml"
    values = {"image": "grid.png", "resolution": 0.5, "origin": [1, 2, 0]} | fields
    path.write_text("".join(f"{key}: {value}\n" for key, value in values.items()))
    return path


def covered(drawing):
    return shapely.union_all([p.geometry for p in drawing.pieces])


def boxes(mask, cell, x, y):
    """The squares of a mask (rows, columns), the lower left corner of all at (x, y)."""
    row, column = np.argwhere(mask).T
    left, low = x + cell * column, y + cell * (len(mask) - 1 - row)
    return shapely.union_all(shapely.box(left, low, left + cell, low + cell))


@each_case("seed", range(20))
def test_any_grid_is_covered_exactly_and_its_obstacles_have_no_holes(tmp_path, seed):
    rng = np.random.default_rng(seed)
    mask = rng.random((14, 17)) < rng.uniform(0.3, 0.8)
    path = grid(tmp_path, np.where(mask, 0, 255))
    whole = boxes(mask, 0.5, 1, 2)
    assert covered(read(path)).symmetric_difference(whole).area < 1e-9
    outlines = Map.from_file(path, tolerance=0).outlines
    pieces = [shapely.Polygon(outline) for outline in outlines]
    assert sum(piece.area for piece in pieces) == pytest.approx(whole.area)  # they don't overlap
    assert shapely.union_all(pieces).symmetric_difference(whole).area < 1e-6


def test_a_grid_is_turned_about_its_lower_left_corner(tmp_path):
    drawing = read(grid(tmp_path, np.where(CELLS, 0, 254), origin=[1, 2, pi / 2]))
    straight = boxes(CELLS, 0.5, 0, 0)
    turned = shapely.transform(straight, lambda p: np.column_stack([1 - p[:, 1], 2 + p[:, 0]]))
    assert covered(drawing).symmetric_difference(turned).area < 1e-9


@each_case(
    ("fields", "occupied"),
    [
        ({}, {0, 80}),  # darker than 1 - 0.65
        ({"negate": 1}, {200, 255}),
        ({"occupied_thresh": 0.2}, {0, 80, 200}),
        ({"mode": "scale"}, {0, 80}),
        ({"mode": "raw"}, {80}),  # 80 per cent; 200 and 255 are unknown
        ({"mode": "raw", "occupied_thresh": 0.9}, set()),  # a map without walls is a map
        ({"occupied_thresh": "2e-1", "free_thresh": "1e-05"}, {0, 80, 200}),
        ({"negate": "true", "occupied_thresh": "5E-1"}, {200, 255}),
    ],
)
def test_thresholds_negation_and_modes(tmp_path, fields, occupied):
    values = np.array([[0, 80, 200, 255]])
    path = grid(tmp_path, np.kron(values, np.ones((2, 2))), **fields)
    mask = np.kron(np.isin(values, [*occupied]), np.ones((2, 2), dtype=bool))
    drawing = read(path)
    assert covered(drawing).symmetric_difference(boxes(mask, 0.5, 1, 2)).area < 1e-9
    assert len(Map.from_file(path).outlines) == len(drawing.pieces)
    assert occupied or drawing.bounds == (1, 5, 2, 3)


@each_case(
    ("mode", "occupied"),
    [
        ("trinary", [1, 0, 1, 0]),  # alpha is a fourth channel
        ("scale", [1, 0, 0, 0]),  # unknown where it is not opaque
        ("raw", [0, 1, 0, 0]),  # alpha does not matter; 0 is 0 per cent
    ],
)
def test_transparent_pixels_are_what_nav2_makes_of_them(tmp_path, mode, occupied):
    values = [(0, 255), (90, 255), (0, 0), (255, 0)]
    pixels = np.array([[[gray, gray, gray, alpha] for gray, alpha in values]])
    path = grid(tmp_path, pixels, mode=mode)
    mask = np.array([occupied], dtype=bool)
    assert covered(read(path)).symmetric_difference(boxes(mask, 0.5, 1, 2)).area < 1e-9


@each_case("name", ["deep.png", "deep.pgm", "flat.bmp"])
def test_a_grid_may_have_16_bits_or_be_a_bmp(tmp_path, name):
    kind, scale = (np.uint16, 257) if name.startswith("deep") else (np.uint8, 1)
    values = (np.where(CELLS, 80, 254) * scale).astype(kind)
    Image.fromarray(values).save(tmp_path / name)
    path = grid(tmp_path, np.zeros((1, 1)), image=name)
    assert covered(read(path)).symmetric_difference(boxes(CELLS, 0.5, 1, 2)).area < 1e-9


def test_an_image_needs_a_resolution_its_dark_pixels_are_solid_clear_ones_are_not(tmp_path):
    pixels = np.full((4, 6, 4), 255, dtype=np.uint8)
    pixels[0, 0] = (0, 0, 0, 255)
    pixels[3, 5] = (200, 0, 0, 255)
    pixels[1, 1] = (0, 0, 0, 0)
    path = tmp_path / "plan.png"
    Image.fromarray(pixels).save(path)
    with pytest.raises(InputError, match=r"needs resolution, metres per pixel"):
        read(path)
    drawing = read(path, resolution=0.1)
    expected = shapely.union(shapely.box(0, 0.3, 0.1, 0.4), shapely.box(0.5, 0, 0.6, 0.1))
    assert covered(drawing).symmetric_difference(expected).area < 1e-9


# -- obstacles ---------------------------------------------------------------------------------


def test_the_room_in_a_ring_stays_free(tmp_path):
    path = tmp_path / "ring.geojson"
    rings = [[[0, 0], [6, 0], [6, 6], [0, 6], [0, 0]], [[1, 1], [5, 1], [5, 5], [1, 5], [1, 1]],
             [[0.2, 0.2], [0.8, 0.2], [0.8, 0.8], [0.2, 0.8], [0.2, 0.2]]]  # fmt: skip
    path.write_text(json.dumps({"type": "Polygon", "coordinates": rings}))
    found = Map.from_file(path)
    pieces = shapely.union_all([shapely.Polygon(outline) for outline in found.outlines])
    assert pieces.area == pytest.approx(36 - 16 - 0.36)
    assert not pieces.intersects(shapely.Point(3, 3))


def test_what_is_drawn_twice_or_has_no_length_is_dropped(plan):
    document, space = dxf(plan)
    space.add_line((0, 0), (4, 0))
    space.add_line((4, 0), (0, 0))
    space.add_line((1, 1), (1, 1))
    space.add_lwpolyline([(4, 0), (4, 0), (4, 2), (4, 2)])
    document.saveas(plan)
    assert obstacles(read(plan)).walls == (((0, 0), (4, 0), (4, 2)),)


@each_case(
    ("options", "said"),
    [
        ({"unit": "inch"}, "unit = 'inch': expected one of mm, cm, m, in, ft"),
        ({"layers": []}, "layers = []: expected names of layers"),
        (
            {"resolution": 0.05},
            "plan.dxf: resolution is for .png, .pgm, .jpg, .jpeg, .bmp, not .dxf",
        ),
        ({"at": 3}, "at = 3: expected a point"),
        ({"tolerance": float("nan")}, "tolerance = nan: expected a number"),
    ],
)
def test_options_that_can_not_be_used_are_named(plan, options, said):
    document, space = dxf(plan)
    space.add_line((0, 0), (4, 0), dxfattribs={"layer": "WALLS"})
    document.saveas(plan)
    with pytest.raises(InputError) as caught:
        Map.from_file(plan, **options)
    assert str(caught.value).startswith(said)
