"""Draw department.dxf: one floor of a department, 30 x 20 m, as an architect would, in millimetres.

python examples/paper/maps/make_department.py

Walls (layer WALLS) are filled rectangles, a polyline with a bulge for the hall's round corner, a
line for a screen, and an arc for a cabin. Furniture is blocks (FURNITURE), door leaves are lines
with their swing as arcs (DOORS), and room names and dimensions have layers of their own. The
building is invented.

department.geojson holds the same outlines in metres, by layer; to read it needs no other package.
"""

import json
from math import pi, tan
from pathlib import Path

import ezdxf
from ezdxf.enums import TextEntityAlignment
from shapely.geometry import mapping

from mars2d.addons import maps

MM = 1000.0  # of a metre: below, all lengths are metres
OUTER = 0.3  # m, how thick the outer walls are; the inner ones are half of it
QUARTER = tan(pi / 8)  # the bulge of a quarter of a circle: tan(angle / 4)

LAYERS = {"WALLS": 7, "DOORS": 3, "FURNITURE": 8, "TEXT": 5, "DIMENSIONS": 1}  # and their colours

# (x, y), (x, y): opposite corners
OUTER_WALLS = [
    ((0, 0), (30, OUTER)), ((0, 20 - OUTER), (30, 20)),
    ((0, OUTER), (OUTER, 6.6)), ((0, 8.1), (OUTER, 20 - OUTER)),
    ((30 - OUTER, OUTER), (30, 20 - OUTER)),
]  # fmt: skip
OFFICE_DOORS = [3.2, 5.8, 13.2, 15.8, 23.2, 25.8]  # x of their west posts
ROOMS = {
    **{f"OFFICE {k + 1}": (2.5 + 5 * k, 3.4) for k in range(6)}, "CORRIDOR": (19.5, 7.35),
    "LECTURE HALL": (6.6, 18.6), "LAB": (18.2, 17.4), "STORE": (20.8, 13.6),
    "WORKSHOP": (25.0, 18.9),
}  # fmt: skip
DOORS = [  # hinge, end of the open leaf, end of the closed one
    *(((x, 6.0), (x, 5.0), (x + 1, 6.0)) for x in OFFICE_DOORS),
    ((9.5, 8.7), (9.5, 9.4), (10.2, 8.7)), ((10.9, 8.7), (10.9, 9.4), (10.2, 8.7)),
    ((16.0, 8.7), (16.0, 9.7), (17.0, 8.7)), ((26.0, 8.7), (26.0, 9.7), (27.0, 8.7)),
    ((22.15, 10.3), (23.15, 10.3), (22.15, 9.3)), ((12.0, 18.0), (11.0, 18.0), (12.0, 17.0)),
    ((0.0, 6.6), (-0.75, 6.6), (0.0, 7.35)), ((0.0, 8.1), (-0.75, 8.1), (0.0, 7.35)),
]  # fmt: skip
FURNITURE = [  # block, place, turned by degrees, scale
    *(("DESK", (x, 1.3), 0, 1.0) for x in (3.6, 6.6, 13.6, 16.4, 23.6, 26.6)),
    *(("BENCH", (5.2, 13.9), angle, scale) for angle in (-24, 24) for scale in (1.0, 1.4)),
    ("DESK", (3.0, 13.9), 90, 1.0), ("DESK", (15.6, 18.6), 0, 1.0), ("DESK", (18.4, 18.9), 0, 1.0),
    ("DESK", (15.2, 15.0), 90, 1.0), ("DESK", (28.6, 16.4), 90, 1.0),
    ("TABLE", (28.0, 12.2), 0, 1.0), ("TABLE", (24.6, 17.0), 0, 0.8),
]  # fmt: skip


def inner_walls():
    """Return the inner walls as opposite corners: the corridor's between its doors, then others."""
    west = [0.3, *(x + 1 for x in OFFICE_DOORS)]
    walls = [((a, 6.0), (b, 6.15)) for a, b in zip(west, [*OFFICE_DOORS, 29.7], strict=True)]
    north = [(0.3, 9.5), (10.9, 12.15), (14.25, 16.0), (17.0, 26.0), (27.0, 29.7)]
    walls += [((a, 8.55), (b, 8.7)) for a, b in north]
    walls += [((x - 0.075, 0.3), (x + 0.075, 6.0)) for x in (5, 10, 15, 20, 25)]
    walls += [((12.0, 8.7), (12.15, 17.0)), ((12.0, 18.0), (12.15, 19.7))]  # the hall's
    walls += [((14.25, 8.7), (14.4, 19.7))]  # the lab's
    walls += [((22.0, 8.7), (22.15, 9.3)), ((22.0, 10.3), (22.15, 19.7))]  # the workshop's
    return [*walls, ((19.5, 12.0), (22.0, 12.15)), ((19.5, 15.0), (22.0, 15.15))]  # the store's


def rectangle(layout, a, b, layer):
    """Fill a rectangle; a SOLID has its corners in the order of a Z."""
    (x1, y1), (x2, y2) = a, b
    corners = [(x * MM, y * MM) for y in (y1, y2) for x in (x1, x2)]
    layout.add_solid(corners, dxfattribs={"layer": layer})


def blocks(drawing):
    """Draw each piece of furniture once, about its own origin, on layer 0: so inserts decide."""
    rectangle(drawing.blocks.new("DESK"), (-0.8, -0.4), (0.8, 0.4), "0")
    drawing.blocks.new("TABLE").add_circle((0, 0), 0.6 * MM)
    bench = drawing.blocks.new("BENCH")  # a curved one, 3 m from the origin and 0.5 m deep
    near, far, half = 3.0 * MM, 3.5 * MM, pi / 10
    bulge = tan(half / 2)
    ends = [ezdxf.math.Vec2.from_angle(a, r) for a, r in
            ((-half, near), (half, near), (half, far), (-half, far))]  # fmt: skip
    turns = (bulge, 0, -bulge, 0)
    points = [(p.x, p.y, turn) for p, turn in zip(ends, turns, strict=True)]
    bench.add_lwpolyline(points, format="xyb", close=True)


def door(space, hinge, leaf, closed):
    """Draw an open door: its leaf, and the arc on which it swings."""
    h, a, b = (ezdxf.math.Vec2(point) * MM for point in (hinge, leaf, closed))
    space.add_line(h, a, dxfattribs={"layer": "DOORS"})
    first, last = (a, b) if (a - h).det(b - h) > 0 else (b, a)
    space.add_arc(
        h, (a - h).magnitude, (first - h).angle_deg, (last - h).angle_deg,
        dxfattribs={"layer": "DOORS"},
    )  # fmt: skip


def department():
    """Return the drawing."""
    drawing = ezdxf.new("R2010")
    drawing.units = ezdxf.units.MM
    for name, color in LAYERS.items():
        drawing.layers.add(name, color=color)
    space = drawing.modelspace()
    for a, b in [*OUTER_WALLS, *inner_walls()]:
        rectangle(space, a, b, "WALLS")
    corner = [(0.3, 16.7, -QUARTER), (3.3, 19.7, 0), (0.3, 19.7, 0)]  # the hall's, rounded
    points = [(x * MM, y * MM, bulge) for x, y, bulge in corner]
    space.add_lwpolyline(points, format="xyb", close=True, dxfattribs={"layer": "WALLS"})
    cabin, screen = (29.7 * MM, 19.7 * MM), [(27.5 * MM, 4.2 * MM), (29.7 * MM, 4.2 * MM)]
    space.add_arc(cabin, 2.5 * MM, 180, 270, dxfattribs={"layer": "WALLS"})
    space.add_line(*screen, dxfattribs={"layer": "WALLS"})
    blocks(drawing)
    for block, (x, y), angle, scale in FURNITURE:
        attributes = {"layer": "FURNITURE", "rotation": angle, "xscale": scale, "yscale": scale}
        space.add_blockref(block, (x * MM, y * MM), dxfattribs=attributes)
    for each in DOORS:
        door(space, *each)
    for name, (x, y) in ROOMS.items():
        label = space.add_text(name, height=0.35 * MM, dxfattribs={"layer": "TEXT"})
        label.set_placement((x * MM, y * MM), align=TextEntityAlignment.MIDDLE_CENTER)
    for a, b, angle in (((0, 0), (30, 0), 0), ((0, 0), (0, 20), 90)):
        p, q = ((x * MM, y * MM) for x, y in (a, b))
        base = (-1.5 * MM, -1.5 * MM)
        space.add_linear_dim(
            base, p, q, angle=angle, override={"dimtxt": 0.35 * MM, "dimasz": 0.2 * MM},
            dxfattribs={"layer": "DIMENSIONS"},
        ).render()  # fmt: skip
    return drawing


def outlines(path):
    """Return the outlines of a drawing as GeoJSON: a feature a line."""
    features = [
        {"type": "Feature", "properties": {"layer": p.layer}, "geometry": mapping(p.geometry)}
        for p in maps.read(path, tolerance=0).pieces
    ]
    lines = ",\n".join(json.dumps(feature, separators=(",", ":")) for feature in features)
    return f'{{"type":"FeatureCollection","features":[\n{lines}\n]}}\n'


if __name__ == "__main__":
    ezdxf.options.write_fixed_meta_data_for_testing = True  # no dates in the file
    file = Path(__file__).with_name("department.dxf")
    department().saveas(file)
    file.with_suffix(".geojson").write_text(outlines(file), encoding="utf-8")
