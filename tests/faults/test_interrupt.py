"""Ctrl-C at any moment: one line, exit code 130, nothing lost, nothing half made, nobody left."""

from __future__ import annotations

import random
import shutil
import signal
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import mars2d
from mars2d.output.formats import SUFFIXES
from tests.faults.commands import Command, Ended, Forking, started
from tests.processes import PATIENCE

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="processes are looked for in /proc"),
]
pytest.importorskip("av")
pytest.importorskip("mcap")
pytest.importorskip("pygame")

LAW = """
from mars2d import Robot, Scenario
from mars2d.addons import Game

scenario = Scenario(robots=[Robot(pose=(x, 0, x)) for x in (-2, 0, 2)], stop_time=60,
                    sampling_time=0.05, on_exit="wall")

def control(world):
    return [[0.3, 0.2, 0.1], [0.5, 0.1, -0.5]]
"""

OLD = b"what was there before"

RUN = ("run", "law.py", "--headless")

OUTPUTS = {
    "npz": "record", "mat": "record", "csv": "record", "nc": "record", "mcap": "record",
    "png": "figure", "html": "html", "gif": "video", "mp4": "video",
}  # fmt: skip

SMALL = ("--size", "160x120", "--speed", "20")


def saving(suffix: str) -> tuple[str, ...]:
    """Return the command that runs and saves one kind of file."""
    option = OUTPUTS[suffix]
    more = SMALL if option == "video" else ()
    return (*RUN, f"--{option}", f"out.{suffix}", *more)


COMMANDS = {
    **{suffix: saving(suffix) for suffix in OUTPUTS},
    "all": (*RUN, "--record", "out.npz", "--figure", "out.png", "--html", "out.html"),
    "sweep": ("sweep", "law.py", "--set", "stop_time=5,10,20", "--seeds", "4", "--workers", "2",
              "--out", "out.csv"),
    "tournament": ("tournament", "sumo", "--players", "sumo_players/*.py", "--seeds", "1",
                   "--stop-time", "3", "--workers", "2", "--out", "league"),
    "plot": ("plot", "whole.npz", "signals", "--figure", "out.png"),
    "replay a film": ("replay", "whole.npz", "--video", "out.gif", *SMALL),
    "replay a page": ("replay", "whole.npz", "--html", "out.html"),
    "compare": ("compare", "law.py", "--figure", "out.png", "--video", "out.gif", "--speed", "20"),
    "check": ("check", "whole.npz"),
    "check a law": ("check", "law.py"),
    "paper": ("paper", "pages", "--only", "2,3"),
    "bench": ("bench", "S1", "--quick", "--save", "out.json"),
    "demo": ("demo", "random_walk", "--headless"),
}  # fmt: skip


class Bench(NamedTuple):
    """Where commands are tried, and the record of the whole run."""

    place: Path
    whole: mars2d.Record
    forking: Forking


@pytest.fixture(scope="module")
def bench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Bench]:
    place = tmp_path_factory.mktemp("interrupted")
    (place / "law.py").write_text(LAW)
    whole = mars2d.run(place / "law.py")
    whole.save(place / "whole.npz")
    forking = Forking()
    yield Bench(place, whole, forking)
    forking.close()


def folder(bench: Bench, name: str) -> Path:
    """Return a folder with the experiment, its record, and older files in place of all outputs."""
    new = bench.place / "here"
    if new.exists():
        shutil.rmtree(new)
    new.mkdir()
    for file in ("law.py", "whole.npz"):
        shutil.copy(bench.place / file, new)
    for word in COMMANDS[name]:
        if word.startswith("out.") and name not in ("sweep", "mcap"):
            (new / word).write_bytes(OLD)
    return new


def is_whole(path: Path, whole: mars2d.Record) -> None:
    """Check that a file is complete; of a record, that it is the beginning of the whole one."""
    data = path.read_bytes()
    assert data
    if path.suffix in SUFFIXES and not data.startswith(b"row,experiment"):
        try:
            record = mars2d.load(path)
        except mars2d.InputError as error:  # of a log
            if "the run ended before its first" in str(error):
                return
            raise
        n = len(record)
        for mine, other in ((record.pose, whole.pose), (record.command, whole.command)):
            np.testing.assert_array_equal(mine, other[:n])
    elif path.suffix == ".html":
        assert data.rstrip().endswith(b"</html>")
    elif path.suffix in (".png", ".gif"):
        from PIL import Image

        with Image.open(path) as image:
            for k in range(getattr(image, "n_frames", 1)):
                image.seek(k)
                image.load()
    elif path.suffix == ".mp4":
        import av

        with av.open(str(path)) as film:
            assert sum(1 for _ in film.decode(video=0))


def check(bench: Bench, name: str, here: Path, command: Command, ended: Ended) -> None:
    """Check what an interrupted command has left behind."""
    told = f"{name}: exit code {ended.code}\n{ended.out}\n{ended.err}"
    assert ended.code in (0, 130), told
    lines = [line for line in ended.err.splitlines() if "there is no display" not in line]
    assert all(line.startswith("mars2d: ") for line in lines), told
    assert len(lines) <= 4, told
    assert (ended.code == 130) <= bool(lines), told
    assert command.left() == [], told
    files = [path for path in here.rglob("*") if path.is_file()]
    assert [path.name for path in files if path.name.startswith((".", "tmp"))] == [], told
    for path in files:
        if path.read_bytes() != OLD and path.name != "played.jsonl":
            is_whole(path, bench.whole)
    recorded = [word for word in COMMANDS[name] if word.startswith("out.")]
    if "what was recorded until" in ended.err or "one moment: the run" in ended.err:
        assert (here / recorded[0]).read_bytes() != OLD, told


def interrupted(bench: Bench, name: str, after: float, times: int, *, forked: bool) -> Ended:
    """Interrupt a command so many seconds after its start, and check what it leaves behind."""
    here = folder(bench, name)
    start = bench.forking.started if forked else started
    command = start(here, *COMMANDS[name])
    time.sleep(after)
    command.interrupt(times)
    ended = command.end()
    if not forked and too_early(ended):
        return ended
    check(bench, name, here, command, ended)
    return ended


def too_early(ended: Ended) -> bool:
    """Return whether Ctrl-C came before Python had begun to import the package."""
    return ended.code == -signal.SIGINT or (
        "Traceback" in ended.err and "/mars2d/" not in ended.err.replace("\\", "/")
    )


def lasting(bench: Bench, name: str, *, forked: bool) -> float:
    """Return how long a command takes that nobody interrupts."""
    here = folder(bench, name)
    begun = time.monotonic()
    ended = (bench.forking.started if forked else started)(here, *COMMANDS[name]).end()
    assert ended.code == 0, ended
    return time.monotonic() - begun


@pytest.mark.parametrize("share", [0.05, 0.3, 0.6])
def test_ctrl_c_while_the_libraries_are_imported_is_one_line(bench, share) -> None:
    here = folder(bench, "npz")
    command = started(here, "--version")
    begun = time.monotonic()
    while not imports_numpy(command.pid):
        assert time.monotonic() < begun + PATIENCE
    time.sleep(share * 0.2)
    command.interrupt()
    ended = command.end()
    assert (ended.code, ended.err) in ((130, "mars2d: interrupted\n"), (0, "")), ended


def imports_numpy(pid: int) -> bool:
    """Return whether a process has loaded numpy, so that importing the package has begun."""
    try:
        return "numpy" in Path(f"/proc/{pid}/maps").read_text()
    except OSError:
        return False


@pytest.mark.parametrize("name", ["npz", "gif", "all", "sweep", "plot", "mcap"])
def test_ctrl_c_leaves_whole_files_and_nobody_behind(bench, name) -> None:
    chosen = random.Random(name)
    for times in (1, 3):
        interrupted(bench, name, chosen.uniform(0.02, 0.8), times, forked=True)


@pytest.mark.nightly
@pytest.mark.parametrize("name", COMMANDS)
def test_ctrl_c_at_many_moments_of_each_command(bench, name) -> None:
    chosen = random.Random(name)
    codes: dict[int, int] = {}
    for forked, count in ((False, 6), (True, 14)):
        longest = min(lasting(bench, name, forked=forked), 12.0)
        for _ in range(count):
            after, times = chosen.uniform(0.0, 1.05 * longest), chosen.choice((1, 1, 2, 5))
            ended = interrupted(bench, name, after, times, forked=forked)
            codes[ended.code] = codes.get(ended.code, 0) + 1
    print(f"{name}: exit codes {codes}")
    assert codes.get(130, 0) > 3


# -- what is saved is not interrupted -------------------------------------------------------------


IN_THE_MIDST = """
import os, signal, sys
import mars2d.cli.command_line, mars2d.core.files
from mars2d.output.formats import npz

def slowly(record, path):
    os.kill(os.getpid(), signal.SIGINT)
    os.kill(os.getpid(), signal.SIGINT)
    write(record, path)

write, npz.write = npz.write, slowly
sys.exit(mars2d.cli.command_line.main(sys.argv[1:]))
"""


def test_ctrl_c_while_a_run_is_saved_waits_for_that(tmp_path, child) -> None:
    (tmp_path / "law.py").write_text(LAW)
    arguments = ["run", str(tmp_path / "law.py"), "--headless", "--record", "out.npz"]
    code = f"import os, sys; os.chdir({str(tmp_path)!r}); sys.argv[1:] = {arguments!r}\n"
    done = child(code + IN_THE_MIDST)
    said = "mars2d: one moment: the run is being saved in out.npz\nmars2d: interrupted\n"
    assert (done.returncode, done.stderr) == (130, said)
    assert mars2d.load(tmp_path / "out.npz").digest == mars2d.run(tmp_path / "law.py").digest


def test_in_python_too_a_run_is_saved_before_ctrl_c_comes_through(tmp_path, child) -> None:
    code = (
        "import mars2d, os, signal\n"
        "from mars2d.output.formats import npz\n"
        "write = npz.write\n"
        "def slowly(record, path):\n"
        "    os.kill(os.getpid(), signal.SIGINT)\n"
        "    write(record, path)\n"
        "npz.write = slowly\n"
        "before = signal.getsignal(signal.SIGINT)\n"
        "try:\n"
        f"    mars2d.run('random_walk', stop_time=5, record={str(tmp_path / 'a.npz')!r})\n"
        "except KeyboardInterrupt:\n"
        f"    print(len(mars2d.load({str(tmp_path / 'a.npz')!r})))\n"
        "    print(signal.getsignal(signal.SIGINT) is before)\n"
    )
    assert child(code).stdout.split() == ["6", "True"]


def test_a_ctrl_c_that_python_drops_comes_again(child) -> None:
    code = (
        "import os, signal, sys, time, mars2d.cli.command_line, mars2d.cli.verbs.doctor as doctor\n"
        "class Tidied:\n"
        "    def __del__(self): os.kill(os.getpid(), signal.SIGINT); time.sleep(0)\n"
        "def execute(arguments):\n"
        "    Tidied()\n"
        "    time.sleep(100)\n"
        "doctor.execute = execute\n"
        "sys.exit(mars2d.cli.command_line.main(['doctor']))\n"
    )
    done = child(code, timeout=90)
    assert (done.returncode, done.stderr) == (130, "mars2d: interrupted\n")


def test_ctrl_c_while_a_row_is_logged_comes_when_it_is_written(tmp_path, child) -> None:
    path = tmp_path / "run.mcap"
    code = (
        "import mars2d, os, signal, sys, numpy as np\n"
        "from mars2d import Scenario, World\n"
        "from mars2d.output.formats.mcap import Log\n"
        "from mars2d.output.formats.mcap.writing import Tape\n"
        "begin = Tape.begin\n"
        "def slowly(self, *args):\n"
        "    os.kill(os.getpid(), signal.SIGINT)\n"
        "    begin(self, *args)\n"
        "Tape.begin = slowly\n"
        "try:\n"
        f"    with Log({str(path)!r}) as log:\n"
        "        world = World(Scenario(), storage=log.storage)\n"
        "        while True:\n"
        "            world.step([[0.1], [0.2]])\n"
        "            log.follow(world)\n"
        "except KeyboardInterrupt:\n"
        f"    print(world.iteration, len(mars2d.load({str(path)!r})))\n"
        "    print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)\n"
    )
    assert child(code).stdout.split() == ["1", "1", "True"]


def test_a_ctrl_c_of_which_a_library_makes_another_error_is_one_line(child) -> None:
    code = (
        "import os, signal, sys, mars2d.cli.command_line, mars2d.cli.verbs.doctor as doctor\n"
        "def execute(arguments):\n"
        "    try:\n"
        "        os.kill(os.getpid(), signal.SIGINT)\n"
        "    except KeyboardInterrupt as error:\n"
        "        raise ImportError('initialization failed') from error\n"
        "doctor.execute = execute\n"
        "sys.exit(mars2d.cli.command_line.main(['doctor']))\n"
    )
    done = child(code)
    assert (done.returncode, done.stderr) == (130, "mars2d: interrupted\n")
