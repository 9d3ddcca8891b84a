"""Try bad inputs, each in a process of its own: python forked.py FOLDER third|rest.

One process imports what the command line may need, and forks a child for each input, which takes
milliseconds. So an abort or a hang is that of one input, and is seen in its exit status. For each,
a line of JSON with its name, status, stdout and stderr goes to FOLDER/outcomes. The records that
inputs are made of lie where the environment says, see records.py.
"""

from __future__ import annotations

import contextlib
import gc
import importlib
import json
import os
import runpy
import shlex
import shutil
import signal
import sys
import time
import traceback
from pathlib import Path

LIMIT = 60.0
"""Seconds of the clock that an input may take until it counts as a hang."""

AT_A_TIME = 2

PRELOADED = (
    "mars2d.cli.command_line",
    "mars2d.addons.maps.dxf",
    "mars2d.addons.maps.svg",
    "mars2d.output.films.film",
    "mars2d.study.tournament.tournament",
    "mars2d.window.show",
    "matplotlib.backends.backend_agg",
    "scipy.spatial",
    "shapely",
    "ezdxf",
    "mcap.writer",
)
"""What is imported once: what the inputs would import again and again."""


def main(folder: Path, part: str) -> None:
    """Try every third input or the rest, some at a time, and write down what became of each."""
    from tests.cli.bad_inputs.table import KINDS

    for module in PRELOADED:
        with contextlib.suppress(ImportError):
            importlib.import_module(module)
    gc.collect()
    gc.freeze()  # else each child would look through all of this, and so copy it
    every = [case for kind in KINDS.values() for case in kind]
    cases = [c for k, c in enumerate(every) if (k % 3 == 0) == (part == "third")]
    running: dict[int, tuple[str, Path, float]] = {}
    with (folder / "outcomes").open("w", encoding="utf-8") as out:
        for number, case in enumerate(cases):
            if len(running) == AT_A_TIME:
                out.write(reaped(running))
            place = folder / f"case{number}"
            place.mkdir()
            running[child(case, place)] = case.name, place, time.monotonic()
        while running:
            out.write(reaped(running))


def child(case, place: Path) -> int:
    """Fork a process that does what the user does, and return its id."""
    sys.stdout.flush()
    pid = os.fork()
    if pid == 0:
        status = 70
        try:
            os.setsid()
            signal.setitimer(signal.ITIMER_REAL, LIMIT)  # which ends it, unless it ends before
            status = as_user(case, place)
        finally:
            os._exit(status)
    return pid


def as_user(case, place: Path) -> int:
    """Make the case's files, do what its user types, and return the exit code."""
    here = place / "here"
    here.mkdir()
    os.chdir(here)
    for name, content in case.files.items():
        if content is None:
            Path(name).mkdir(parents=True)
            continue
        data = content() if callable(content) else content
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).write_bytes(data.encode() if isinstance(data, str) else data)
    for number, name in ((1, "stdout"), (2, "stderr")):
        os.dup2(os.open(place / name, os.O_WRONLY | os.O_CREAT), number)
    sys.stdout, sys.stderr = (os.fdopen(n, "w", encoding="utf-8") for n in (1, 2))
    try:
        program, *arguments = shlex.split(case.command)
        if program == "mars2d":
            from mars2d.cli.command_line import main as mars2d

            return mars2d(arguments)
        sys.path.insert(0, str(here))
        runpy.run_path(arguments[0], run_name="__main__")
    except SystemExit as leaving:
        return leaving.code if isinstance(leaving.code, int) else 1
    except BaseException:
        traceback.print_exc()
        return 1
    else:
        return 0
    finally:
        sys.stdout.flush()
        sys.stderr.flush()


def reaped(running: dict[int, tuple[str, Path, float]]) -> str:
    """Wait for one of the children, and return what became of it as a line of JSON."""
    pid, status, used = os.wait3(0)
    name, place, start = running.pop(pid)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(pid, signal.SIGKILL)  # what it may have left running
    said = {n: (place / n).read_bytes().decode("utf-8", "replace") for n in ("stdout", "stderr")}
    shutil.rmtree(place)
    code = os.waitstatus_to_exitcode(status)  # below 0: the signal that ended it
    took = {"seconds": time.monotonic() - start, "cpu": used.ru_utime + used.ru_stime}
    return json.dumps({"name": name, "code": code, **took, **said}) + "\n"


if __name__ == "__main__":
    import mars2d  # noqa: F401 - what is installed, before the folder of the tests is in the path

    sys.path.append(str(Path(__file__).parents[3]))
    os.environ.pop("DISPLAY", None)
    os.environ.pop("WAYLAND_DISPLAY", None)
    main(Path(sys.argv[1]), sys.argv[2])
