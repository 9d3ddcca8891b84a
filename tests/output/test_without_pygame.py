"""Where pygame can't be installed, as in a browser, all works but windows, films and pixels.

Each test runs Python in a child process in which pygame is not to be found. What Pyodide, which is
Python in a browser, has not either raises there as well: threads, processes, signals by the clock;
and nothing of the engine is compiled.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import mars2d
from tests.processes import PATIENCE

pytestmark = pytest.mark.slow

BLOCKED = """
import importlib.abc, os, signal, subprocess, sys, threading

class Blocked(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name in ("pygame", "cffi", "fcntl", "pwd", "resource", "termios", "tkinter"):
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

def refuse(*args, **kwargs):
    raise RuntimeError("a browser has neither threads nor processes")

sys.meta_path.insert(0, Blocked())
threading.Thread.start = subprocess.Popen.__init__ = os.fork = refuse
del signal.setitimer, signal.alarm
"""

PIP = "which is not installed: pip install pygame-ce"


def run_in_browser(code: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run code as a browser would; return what it prints."""
    return subprocess.run(
        [sys.executable, "-P", "-c", BLOCKED + code],
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
        cwd=folder,
        env=os.environ | {"MARS2D_PLAIN": "1", "MPLBACKEND": "agg"},
    )


COMMANDS = """
import contextlib, io, json
from mars2d.cli.command_line import main
said = []
for words in {words}:
    out, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
        code = main(words)
    said.append((code, errors.getvalue()))
print(json.dumps(said))
"""


def commands(words: list[list[str]], folder: Path) -> list[tuple[int, str]]:
    """Run command lines as a browser would, one after the other; return codes and errors."""
    done = run_in_browser(COMMANDS.format(words=words), folder)
    assert done.returncode == 0, done.stderr
    return [tuple(each) for each in json.loads(done.stdout)]


def test_the_command_line_runs_saves_draws_and_checks(tmp_path):
    saved = ["--record", "run.npz", "--figure", "paths.pdf", "--html", "run.html"]
    every = [
        ["run", "random_walk", "--headless", "--stop-time", "5", *saved],
        ["list"],
        ["check", "run.npz"],
        ["check", "random_walk"],
        ["demo"],
        ["run", "random_walk", "--stop-time", "2"],
    ]
    said = commands(every, tmp_path)
    assert [code for code, _ in said] == [0] * len(every), said
    assert {"run.npz", "paths.pdf", "run.html"} == {path.name for path in tmp_path.iterdir()}
    assert "this runs without a window" in said[-1][1]


WINDOWS_AND_FILMS = [
    (["run", "random_walk", "--headless", "--stop-time", "2", "--video", "a.gif"], "a film"),
    (["demo", "random_walk", "--headless"], "a film"),
    (["replay", "run.npz"], "a window"),
    (["run", "random_walk", "--speed", "0"], "a window"),
    (["run", "random_walk", "--human", "0"], "a window"),
    (["edit"], "a window"),
]


def test_pygame_over_pygame_ce_is_one_line_where_it_is_first_needed(tmp_path):
    other = tmp_path / "pygame"
    other.mkdir()
    (other / "__init__.py").write_text("from pygame import version\n")
    (other / "version.py").write_text("ver = '2.6.1'\n")
    path = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])
    line = (
        "pygame 2.6.1 has been installed over pygame-ce: "
        "pip uninstall --yes pygame pygame-ce && pip install pygame-ce"
    )

    def done(*words):
        command = [sys.executable, "-m", "mars2d", *words]
        env = os.environ | {"PYTHONPATH": path, "DISPLAY": ":1"}
        return subprocess.run(
            command, check=False, cwd=tmp_path, env=env, capture_output=True, text=True
        )

    for words in (["demo", "random_walk"], ["run", "random_walk"], ["edit"]):
        refused = done(*words)
        assert (refused.returncode, refused.stderr) == (2, f"mars2d: {line}\n"), words
    assert done("run", "random_walk", "--headless", "--stop-time", "2").returncode == 0
    assert f"NO  display     {line}\n" in done("doctor").stdout


def test_a_command_that_needs_pygame_says_so_in_one_line(tmp_path):
    mars2d.run("random_walk", stop_time=1.0).save(tmp_path / "run.npz")
    said = commands([words for words, _ in WINDOWS_AND_FILMS], tmp_path)
    for (words, what), (code, errors) in zip(WINDOWS_AND_FILMS, said, strict=True):
        assert code == 2, (words, errors)
        assert errors.strip().splitlines()[-1] == f"mars2d: {what} needs pygame, {PIP}", words
        assert "Traceback" not in errors
