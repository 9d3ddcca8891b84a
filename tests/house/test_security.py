"""Nothing that is read runs: no code in files, none in words, and no call that could do it."""

from __future__ import annotations

import ast
import json
import os
import pickle
import struct
import zipfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d import InputError, Robot, Scenario, World
from mars2d.output.formats.header import as_text, of_record
from mars2d.study.table import Result, Table
from tests.browser import Tab
from tests.cases import each_case
from tests.output.formats.records import FORMATS, everything, refused
from tests.output.formats.test_bombs import _npz

ROOT = Path(__file__).parents[2]
CODE = [*(ROOT / "mars2d").rglob("*.py"), ROOT / "hatch_build.py", *ROOT.glob("docs/make_*.py")]

# -- what the code calls ---------------------------------------------------------------------------

RUNS = {
    "eval", "exec", "compile", "__import__", "exec_module", "load_module", "runpy",
    "pickle.load", "pickle.loads", "pickle.Unpickler", "marshal.load", "marshal.loads", "shelve",
    "dill", "cloudpickle.load", "cloudpickle.loads", "joblib", "numpy.load", "numpy.genfromtxt",
    "scipy.io.loadmat", "scipy.io.readsav", "pandas.read_pickle", "pandas.eval",
    "yaml.load", "yaml.load_all", "yaml.full_load", "yaml.full_load_all", "yaml.unsafe_load",
    "yaml.unsafe_load_all", "yaml.Loader", "yaml.UnsafeLoader", "yaml.FullLoader",
    "xml", "lxml", "os.system", "os.popen", "pty", "tempfile.mktemp", "numpy.core.records",
}  # fmt: skip
"""What runs, or could run, what it is given; xml expands entities."""

NETWORK = {
    "socket", "socketserver", "ssl", "http", "urllib", "ftplib", "smtplib", "poplib", "imaplib",
    "xmlrpc", "asyncio", "requests", "httpx", "aiohttp", "distributed", "dask", "webbrowser",
}  # fmt: skip

ALLOWED = {
    ("scenario/experiment.py", "exec_module"): "an experiment is a program, which its user runs",
    ("addons/maps/svg.py", "xml"): "after a DOCTYPE, without which are no entities",
    ("study/workers.py", "pickle.loads"): "from and to our own worker processes",
    ("study/isolation/host.py", "pickle.loads"): "in a law's process, from the match",
    ("study/isolation/mirror_world.py", "pickle.loads"): "in a law's process, from the match",
}
"""Where one of these is right, and why."""

TALKS = {
    ("study/cluster.py", "asyncio"): "a cluster, as docs/clusters.md says",
    ("study/cluster.py", "distributed"): "the same",
    ("study/isolation/fork_server.py", "socket"): "pairs of sockets between a match and its laws",
    ("study/isolation/host.py", "socket"): "the same",
    ("study/isolation/guard.py", "socket"): "the same",
    ("study/isolation/process.py", "socket"): "the same",
    ("output/formats/mcap/live.py", "socket"): "asks whether a port of this machine is free",
}
"""Which modules may talk to other processes, and why."""


def mentioned(nodes: list[ast.AST]) -> Iterator[tuple[str, ast.AST]]:
    """Yield all names in a module, as `numpy.load`, whatever they are imported as."""
    known: dict[str, str] = {}
    for node in nodes:
        if isinstance(node, ast.Import):
            for each in node.names:
                known[each.asname or each.name.partition(".")[0]] = (
                    each.name if each.asname else each.name.partition(".")[0]
                )
                yield each.name, node
        elif isinstance(node, ast.ImportFrom) and not node.level:
            for each in node.names:
                known[each.asname or each.name] = f"{node.module}.{each.name}"
                yield f"{node.module}.{each.name}", node
    for node in nodes:
        if isinstance(node, ast.Name):
            yield known.get(node.id, node.id), node
        elif isinstance(node, ast.Attribute):
            name, inner = node.attr, node.value
            while isinstance(inner, ast.Attribute):
                name, inner = f"{inner.attr}.{name}", inner.value
            if isinstance(inner, ast.Name) and inner.id in known:
                yield f"{known[inner.id]}.{name}", node
            yield f".{node.attr}", node


def runs(name: str) -> str:
    """Return which of RUNS a name is, or lies in; nothing if in none."""
    if name in (".exec_module", ".load_module"):  # a method, of whatever
        return name[1:]
    parts = name.split(".")
    starts = (".".join(parts[:k]) for k in range(1, len(parts) + 1))
    return next((start for start in starts if start in RUNS), "")


def found_in(text: str) -> set[str]:
    """Return what a module mentions that is dangerous, or leads into a network."""
    nodes = list(ast.walk(ast.parse(text)))
    found = set()
    for name, node in mentioned(nodes):
        if isinstance(node, (ast.Import, ast.ImportFrom)) and name.partition(".")[0] in NETWORK:
            found.add(name.partition(".")[0])
        elif runs(name):
            found.add(runs(name))
    for node in nodes:
        if isinstance(node, ast.keyword):
            value = node.value.value if isinstance(node.value, ast.Constant) else None
            if node.arg in ("shell", "allow_pickle") and value is not False:
                found.add(f"{node.arg}=")
            if node.arg in ("verify", "check_hostname") and value is False:
                found.add(f"{node.arg}=")
    return found


def name_of(file: Path) -> str:
    return file.relative_to(ROOT).as_posix().removeprefix("mars2d/")


def test_nothing_in_the_code_runs_what_it_reads_or_uses_a_network_but_where_it_says_why() -> None:
    assert len(CODE) > 250
    found = {(name_of(f), name) for f in CODE for name in found_in(f.read_text(encoding="utf-8"))}
    assert found == {*ALLOWED, *TALKS}


@each_case(
    "line",
    [
        "eval('1')",
        "exec('1')",
        "compile('1', '', 'exec')",
        "__import__('os')",
        "import os\nos.system('true')",
        "from os import system",
        "from os import popen as p",
        "import pickle\nf = cache(pickle.loads)",
        "from pickle import loads as l\nl(b'')",
        "import numpy as np\nnp.load('x')",
        "import yaml as y\ny.load('a', y.Loader)",
        "import subprocess\nsubprocess.run('ls', shell=True)",
        "f(shell=yes)",
        "import numpy as np\nnp.savez(f, allow_pickle=True)",
        "import scipy.io as s\ns.loadmat(f)",
        "from scipy.io import loadmat",
        "import tempfile\ntempfile.mktemp()",
        "import shelve",
        "spec.loader.exec_module(module)",
        "from xml.dom import minidom",
        "get(u, verify=False)",
        "import xml.sax",
        "import ssl",
        "from urllib.request import urlopen",
        "import marshal\nmarshal.loads(b'')",
    ],
)
def test_what_is_looked_for_would_be_found(line) -> None:
    assert found_in(line)


# -- files that would like to run ------------------------------------------------------------------


class Trap:
    """Makes a folder where it is unpickled."""

    def __init__(self, marker: Path) -> None:
        self.marker = str(marker)

    def __reduce__(self):
        return os.mkdir, (self.marker,)


TRAP = "from pathlib import Path\nPath(__file__).with_name('sprung').mkdir()\n"
"""A module that does the same where it is imported."""


@pytest.fixture
def marker(tmp_path, monkeypatch) -> Iterator[Path]:
    """The folder that is made when a trap springs; at the end, none has."""
    path = tmp_path / "sprung"
    (tmp_path / "trap.py").write_text(TRAP)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.chdir(tmp_path)
    yield path
    assert not path.exists(), "what was read has run"


def test_the_traps_spring(tmp_path) -> None:
    pickle.loads(pickle.dumps(Trap(tmp_path / "sprung")))
    assert (tmp_path / "sprung").is_dir()


@each_case("suffix", [*FORMATS, ".mcap"])
def test_a_pickle_by_any_name_is_no_record(suffix, marker, tmp_path) -> None:
    for protocol in (0, 2, 5):
        (tmp_path / f"run{suffix}").write_bytes(pickle.dumps(Trap(marker), protocol))
        refused(tmp_path / f"run{suffix}")


def test_a_pickle_within_an_npz_is_not_read(marker, tmp_path) -> None:
    with zipfile.ZipFile(everything().save(tmp_path / "good.npz")) as good:
        names = good.namelist()
    np.save(tmp_path / "trap.npy", np.array([Trap(marker)], dtype=object), allow_pickle=True)
    array = (tmp_path / "trap.npy").read_bytes()
    for name in ("header.npy", "pose.npy", "contents.npy", names[-1]):
        for content in (array, pickle.dumps(Trap(marker))):
            refused(_npz(tmp_path / "run.npz", {name: content}))


NAMES = ["os.system", "trap.Trap", "trap:Trap", "trap", "__import__('trap')", "builtins.eval"]


@each_case("name", NAMES)
def test_a_record_names_no_code(name, marker, tmp_path) -> None:
    """Neither as the type of a part, nor as a function, nor as what another package ships."""
    text = as_text(of_record(everything()))
    places = ([], ["robots", 0], ["robots", 0, "drive"], ["robots", 0, "sensors", 0], ["addons", 0])
    for place in places:
        for change in (
            {"type": name},
            {"type": name, "own": "sensor", "from": name.partition(".")[0]},
            {"type": "Robot", "controller": name, "shape": {"type": name}},
        ):
            header = json.loads(text)
            part = header["scenario"]
            for step in place:
                part = part[step]
            part.update(change)
            path = _npz(tmp_path / "run.npz", {"header.npy": _npy_of(as_text(header))})
            try:
                record = mars2d.load(path)
            except InputError as error:
                assert "\n" not in str(error)  # noqa: PT017
            else:
                assert record.scenario.robots[0].controller is None


def _npy_of(text: str) -> bytes:
    data = np.frombuffer(text.encode(), dtype=np.uint8)
    head = f"{{'descr': '|u1', 'fortran_order': False, 'shape': ({len(data)},), }}".encode()
    head = head.ljust(-(len(head) + 11) % 64 + len(head)) + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head + data.tobytes()


@each_case("name", NAMES)
@each_case(
    "scene",
    [
        'type = "NAME"\n[[robots]]',
        '[[robots]]\ntype = "NAME"',
        '[[robots]]\ndrive = "NAME"',
        '[[robots]]\nsensors = ["NAME"]',
        '[[robots]]\nshape = { type = "NAME" }',
        '[[robots]]\n[[addons]]\ntype = "NAME"',
        '[[robots]]\n[[props]]\ntype = "NAME"',
        '[[robots]]\nname = { type = "NAME" }',
        'neighbours = "NAME"\n[[robots]]',
        'control = "NAME"\n[[robots]]',
        '[[robots]]\ncontroller = "NAME"',
    ],
)
def test_a_scenario_file_names_no_code_but_that_of_laws(scene, name, marker, tmp_path) -> None:
    (tmp_path / "scene.toml").write_text("format = 1\n" + scene.replace("NAME", name))
    with pytest.raises(InputError) as caught:
        Scenario.from_file(tmp_path / "scene.toml")
    assert "\n" not in str(caught.value)


def test_a_law_that_a_scenario_file_names_runs(tmp_path) -> None:
    """Who opens a scenario with laws runs these laws: this is said, and nothing else of it runs."""
    (tmp_path / "trap.py").write_text(TRAP + "def control(robot):\n    return 0, 0\n")
    path = tmp_path / "scene.toml"
    path.write_text('format = 1\n[[robots]]\ncontroller = "trap.py"\n')
    Scenario.from_file(path)
    assert (tmp_path / "sprung").is_dir()
    words = " ".join((ROOT / "docs" / "scenario_files.md").read_text(encoding="utf-8").split())
    assert "runs the laws that it names" in words


WATCHED = """
import os, sys, warnings
from pathlib import Path
import mars2d
from mars2d.addons.maps import obstacles, read

def read_all():
    for path in sorted(Path(sys.argv[1]).iterdir()):
        try:
            if path.suffix == ".toml":
                mars2d.Scenario.from_file(path)
            elif path.suffix in (".svg", ".dxf", ".wkt", ".geojson", ".yaml"):
                obstacles(read(path))
            elif path.suffix in (".npz", ".csv", ".mcap"):
                mars2d.load(path)
        except mars2d.InputError as error:
            assert path.name.startswith("bad"), error

read_all()  # all is imported now that these files want

def note(event, arguments):
    if event in ("exec", "import", "os.system", "subprocess.Popen", "ctypes.dlopen") or (
        event.startswith(("pickle", "marshal", "socket", "urllib", "http", "os.exec", "os.fork"))
    ):
        print(event, arguments)
    elif event == "open" and not str(arguments[0]).startswith(sys.argv[1]):
        print("open", arguments)

sys.addaudithook(note)
read_all()
print("read")
"""


@pytest.mark.slow
def test_reading_runs_nothing_imports_nothing_and_opens_nothing_else(tmp_path, child) -> None:
    """As Python itself reports it while sound files are read, and some that try to lead off."""
    from tests.fuzz.readers import seeds

    for kind in ("toml", "dxf", "svg", "yaml", "geojson", "wkt"):
        seeds(kind, tmp_path)
    for suffix in (*FORMATS, ".mcap"):
        everything().save(tmp_path / f"run{suffix}")
    svg = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9">'
    rest = '<rect width="5" height="5"/></svg>'
    for k, text in enumerate([
        f'<?xml-stylesheet href="file:///etc/passwd"?>{svg}{rest}',
        f'{svg}<image width="2" height="2" href="/etc/passwd"/>{rest}',
        f'{svg}<image width="2" height="2" href="http://localhost/a.png"/>{rest}',
        f"{svg}<style>@import url(/etc/passwd); rect {{ fill: url(/etc/passwd) }}</style>{rest}",
        f'{svg}<script href="/etc/passwd">alert(1)</script>{rest}',
        f'<!DOCTYPE svg [<!ENTITY % a SYSTEM "file:///etc/passwd"> %a;]>{svg}{rest}',
        f'{svg[:-1]} xmlns:xi="http://www.w3.org/2001/XInclude"><xi:include href="/etc/passwd"/>'
        + rest,
    ]):  # fmt: skip
        (tmp_path / f"bad{k}.svg").write_text(text)
    (tmp_path / "bad.yaml").write_text("image: ../../etc/passwd.pgm\nresolution: 1\n")
    (tmp_path / "bad.npz").write_bytes(pickle.dumps(Trap(tmp_path / "sprung")))
    done = child(f"import sys; sys.argv = ['', {str(tmp_path)!r}]\n{WATCHED}")
    assert done.stderr == ""
    assert done.stdout == "read\n"


# -- files that would like to take all time and memory ---------------------------------------------

SCENE = "format = 1\n[[robots]]\n"


@each_case(
    "text",
    [
        SCENE + ".".join("a" * 100_000) + " = 1\n",
        f"{SCENE}[{'.'.join('a' * 100_000)}]\n",
        SCENE + " . ".join(['"\\""'] * 100_000) + " = 1\n",
        f"{SCENE}x = {{ {'.'.join('a' * 100_000)} = 1 }}\n",
        SCENE + "".join(f"[{'.'.join('a' * k)}]\n" for k in range(1, 1000)),
        SCENE + "x = " + "[" * 100_000,
        SCENE + "x = " + "{ a = " * 100_000,
        SCENE + "mass = " + "9" * 1_000_000,
        SCENE + "mass = 0x" + "f" * 1_000_000,
    ],
)
def test_a_scenario_file_that_would_be_read_for_ever_is_refused(text, child, tmp_path) -> None:
    (tmp_path / "scene.toml").write_text(text)
    with pytest.raises(InputError, match=r"scene\.toml.*(too deeply|too many digits)"):
        Scenario.from_file(tmp_path / "scene.toml")


def test_what_only_looks_deep_is_read(tmp_path) -> None:
    words = "a.b.c. " * 6 + "1.5 2.5 3.5 " * 50 + ", ".join(["0.25"] * 500)
    path = tmp_path / "scene.toml"
    path.write_text(f'{SCENE}\ndrive.max_linear_speed = 0.5\n# {words}\nname = "{words}"\n')
    assert Scenario.from_file(path).robots[0].name == words


# -- words that would like to run ------------------------------------------------------------------

EVIL = "</title></script><script>hacked = 1</script><img src=x onerror='hacked = 1'>\"'&amp;"


def test_words_in_a_notebook_are_text(browser, tmp_path) -> None:
    """Names, titles, measures and errors come from anybody; pages of their own are tested apart."""
    scenario = Scenario(robots=[Robot(name=EVIL)], title=EVIL, stop_time=0.2)
    record = replace(mars2d.run(scenario), over_message=EVIL, filename=EVIL)
    table = Table(EVIL, (EVIL,), (EVIL,), (Result(1, {EVIL: EVIL}, 1, {EVIL: EVIL}, EVIL),))
    pictures = [scenario._repr_svg_(), World(scenario)._repr_svg_(), record._repr_svg_()]
    page = "\n".join([*pictures, record._repr_html_(), table._repr_html_()])
    path = tmp_path / "notebook.html"
    path.write_text(f"<!DOCTYPE html><meta charset=utf-8>{page}<p id=end>", encoding="utf-8")
    tab = Tab(browser, (900, 640))
    tab.page.on("dialog", lambda dialog: tab.complaints.append(dialog.message))
    tab.page.goto(path.as_uri())
    tab.page.locator("#end").wait_for(state="attached")
    tab.settle()
    frames = [frame.evaluate("typeof hacked") for frame in tab.page.frames]
    assert frames == ["undefined"] * len(frames)
    assert tab.page.locator("body img[src=x], body script").count() == 0
    assert "hacked = 1" in tab.page.locator("table").last.inner_text()
    tab.close()
