"""Run the core and the examples within Pyodide, and print a line of JSON about each."""

import json
import sys
import tempfile
import tomllib
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, "/mars2d")


def say(kind: str, **more: object) -> None:
    print(json.dumps({"kind": kind, **more}), flush=True)


# What an installer notes of MARS2D's libraries.
about = Path(tempfile.mkdtemp(), "mars2d-0.dist-info")
about.mkdir()
project = tomllib.loads(Path("/mars2d/pyproject.toml").read_text())["project"]
lines = [f"Requires-Dist: {line}\n" for line in project["dependencies"]]
(about / "METADATA").write_text("".join(["Name: mars2d\nVersion: 0\n", *lines]))
sys.path.append(str(about.parent))

await load("numpy pymunk")  # noqa: F704, F821, PLE1142 - by run.mjs

import mars2d  # noqa: E402
from mars2d.reports.doctor import examine  # noqa: E402
from mars2d.scenario.examples import examples  # noqa: E402
from tests.house.goldens import SETTINGS, Golden  # noqa: E402

record = mars2d.run("head_on")
with tempfile.TemporaryDirectory() as folder:
    kept = {}
    for name in ("run.npz", "run.csv"):
        record.save(Path(folder) / name)
        kept[name] = mars2d.load(Path(folder) / name).digest
    page = record.save_html(Path(folder) / "run.html").read_text()
say(
    "core",
    digest=record.digest,
    kept=kept,
    page="<canvas" in page,
    svg=record._repr_svg_()[:4],
    absent=[n for n in ("scipy", "shapely", "matplotlib", "pygame") if n not in sys.modules],
    broken=[found.name for found in examine() if found.ok is False],
    said={found.name: found.text for found in examine() if found.ok is not True},
)

await load("scipy")  # noqa: F704, F821, PLE1142
for name in examples():
    try:
        run = mars2d.run(name, options=SETTINGS.get(name))
    except mars2d.InputError as error:
        say("example", name=name, error=str(error))
    else:
        say("example", name=name, digest=run.digest, excess=Golden.read(name).excess(run))
