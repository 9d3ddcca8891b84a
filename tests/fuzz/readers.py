"""Fuzz the readers of files, guided by coverage: ``python tests/fuzz/readers.py npz --minutes 10``.

It needs atheris (``pip install atheris``, Linux). A file that is read, or refused by an InputError,
is fine; anything else that is raised, a hang of ten seconds, or 2 GB of memory, ends the search and
leaves the file beside. Such a file goes to ``tests/fuzz/found``, where `test_found.py` reads it at
each run of the tests. Every kind of file begins with small sound ones, which are made here.
"""

from __future__ import annotations

import argparse
import contextlib
import hashlib
import io
import json
import os
import random
import sys
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path

from mars2d.scenario import load_scenario

KINDS = ("toml", "npz", "mat", "csv", "nc", "mcap", "dxf", "svg", "yaml", "geojson", "wkt")
RECORDS = ("npz", "mat", "csv", "nc", "mcap")

SCENE = """format = 1
title = "A room"
stop_time = 1.0
[[robots]]
pose = [0.0, 0.0, 0.0]
sensors = [{ type = "Proximity", range = 1.0 }, { type = "RangeFinder", beams = 5 }]
drive = { type = "Holonomic", max_linear_speed = 0.4 }
[[robots]]
pose = [1.0, 0.0, 3.14]
shape = { type = "Polygon", outline = [[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1]] }
[[props]]
type = "Box"
pose = [2.0, 1.0, 0.0]
[[joints]]
type = "Rope"
a = "robot0"
b = "box0"
[[addons]]
type = "Map"
outlines = [[[-1.0, 2.0], [1.0, 2.0], [1.0, 3.0]]]
[[addons]]
type = "Communication"
loss = 0.1
"""

SVG = """<svg xmlns="http://www.w3.org/2000/svg" width="4" height="3" viewBox="0 0 40 30">
<g transform="scale(2) rotate(10)"><rect x="1" y="1" width="5" height="4"/>
<path d="M1 1 L5 5 C 6 6 7 5 8 4 A 2 2 0 0 1 10 10 Z"/><circle cx="9" cy="9" r="2"/>
<polyline points="1,2 3,4 5,1"/></g><defs><line id="a" x1="0" y1="0" x2="3" y2="3"/></defs>
<use href="#a" x="4"/></svg>"""

GEOJSON = json.dumps(
    {
        "type": "FeatureCollection",
        "features": [
            {
                "type": "Feature",
                "properties": {"layer": "a"},
                "geometry": {
                    "type": "Polygon",
                    "coordinates": [[[0, 0], [4, 0], [4, 3], [0, 3], [0, 0]]],
                },
            },
            {
                "type": "Feature",
                "properties": None,
                "geometry": {"type": "LineString", "coordinates": [[1, 1], [2, 2]]},
            },
        ],
    }
)

WKT = "POLYGON ((0 0, 4 0, 4 3, 0 3, 0 0), (1 1, 2 1, 2 2, 1 1))\nLINESTRING (0 0, 1 2)\n"


WORDS = [b"0", b"-1", b"1e999", b"null", b"[", b'"', b"9" * 9, b"\x00", b"\xff\xff"]
"""What is put into a file."""


def read(path: Path) -> None:
    """Read a file as its ending says, and use a little of what it holds."""
    import mars2d
    from mars2d.addons.maps import obstacles
    from mars2d.addons.maps import read as read_map

    kind = path.suffix[1:]
    if kind == "toml":
        scenario = load_scenario(path)
        hash(scenario)
    elif kind in RECORDS:
        record = mars2d.load(path, largest=50_000_000)
        assert record.digest
    else:
        obstacles(read_map(path))


def seeds(kind: str, folder: Path) -> list[Path]:
    """Make small sound files of a kind."""
    import mars2d

    if kind in RECORDS:
        (folder / "scene.toml").write_text(SCENE, encoding="utf-8")
        made = []
        for stop_time in (0.2, 1.0):
            record = mars2d.run(folder / "scene.toml", stop_time)
            made.append(record.save(folder / f"seed{stop_time}.{kind}"))
        return made
    path = folder / f"seed.{kind}"
    if kind == "dxf":
        import ezdxf

        drawing = ezdxf.new()
        space = drawing.modelspace()
        space.add_line((0, 0), (4, 1))
        space.add_circle((2, 2), 1)
        space.add_lwpolyline([(0, 0, 0, 0, 0.5), (3, 0), (3, 3)], close=True)
        block = drawing.blocks.new("B")
        block.add_arc((0, 0), 1, 0, 90)
        space.add_blockref("B", (1, 1), dxfattribs={"xscale": 2})
        drawing.saveas(path)
    elif kind == "yaml":
        from PIL import Image

        image = Image.new("L", (8, 6), 254)
        image.putpixel((3, 3), 0)
        image.save(folder / "grid.pgm")
        path.write_text(
            "image: grid.pgm\nresolution: 0.05\norigin: [-1.0, -1.0, 0.0]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.196\nmode: trinary\n"
        )
    else:
        text = {"toml": SCENE, "svg": SVG, "geojson": GEOJSON, "wkt": WKT}[kind]
        path.write_text(text, encoding="utf-8")
    return [path]


def reach_inside(kind: str, data: bytes, chance: random.Random) -> bytes | None:
    """Change what lies inside an archive, and pack it again with right sums; None if it is none.

    So the search gets past the checksums, which refuse nearly all other changes of an npz.
    """
    if kind != "npz":
        return None
    with contextlib.suppress(
        zipfile.BadZipFile, ValueError, EOFError, OSError, KeyError, Exception
    ):
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = {name: archive.read(name) for name in archive.namelist()[:100]}
        name = chance.choice(sorted(members))
        content = bytearray(members[name])
        for _ in range(chance.randint(1, 4)):
            at = chance.randrange(len(content) + 1)
            match chance.randrange(3):
                case 0:
                    content[at : at + 1] = bytes([chance.randrange(256)])
                case 1:
                    del content[at : at + chance.randint(1, 8)]
                case _:
                    content[at:at] = chance.choice(
                        [b"0", b"-1", b"1e999", b"null", b"[", b'"', b"9" * 9]
                    )
        members[name] = bytes(content)
        made = io.BytesIO()
        with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
            for each, content_of in members.items():
                archive.writestr(each, content_of)
        return made.getvalue()
    return None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("kind", choices=KINDS)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--corpus", type=Path, help="a folder that keeps what was found worthwhile")
    arguments = parser.parse_args()
    import atheris

    with atheris.instrument_imports(include=["mars2d", "mcap", "svgelements"]):
        import mars2d
        import mars2d.addons.maps
        import mars2d.output.formats.mcap
        import mars2d.output.formats.npz
        import mars2d.scenario.toml_file

    folder = Path(tempfile.mkdtemp(dir="/dev/shm" if Path("/dev/shm").is_dir() else None))
    corpus = arguments.corpus or folder / "corpus"
    corpus.mkdir(exist_ok=True, parents=True)
    for path in seeds(arguments.kind, folder):
        content = path.read_bytes()
        (corpus / hashlib.sha1(content).hexdigest()).write_bytes(content)
    target = folder / f"fuzzed.{arguments.kind}"

    def once(data: bytes) -> None:
        target.write_bytes(data)
        with contextlib.suppress(mars2d.InputError):
            read(target)

    def mutate(data: bytes, limit: int, seed: int) -> bytes:
        chance = random.Random(seed)
        inside = reach_inside(arguments.kind, data, chance) if chance.random() < 0.7 else None
        return atheris.Mutate(data, limit) if inside is None else inside

    libfuzzer = [
        sys.argv[0], f"-max_total_time={round(60 * arguments.minutes)}", "-timeout=10",
        "-rss_limit_mb=2048", "-max_len=60000", "-len_control=0", "-print_final_stats=1",
        str(corpus),
    ]  # fmt: skip
    custom: dict[str, Callable[..., bytes]] = (
        {"custom_mutator": mutate} if arguments.kind == "npz" else {}
    )
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    atheris.Setup(libfuzzer, once, **custom)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
