"""What is printed: on any terminal, whatever titles, laws and files say."""

from __future__ import annotations

import io
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d import InputError, Scenario
from mars2d.cli import command_line as cli
from mars2d.core.terminal import tell, warn
from mars2d.output.formats.header import as_text
from mars2d.study.table import Result, Table, save_table
from mars2d.study.tournament import league
from tests.cases import each_case

EVIL = "\x1b]0;owned\x07\x9b31m\u202egnp\u2066\r\nmars2d: all is well\ud800"
"""Codes of a terminal, text that is turned round, a line that is forged, half a character."""

UNSEEN = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069]")

EXPERIMENT = f"""
from mars2d import Robot, Scenario

scenario = Scenario(title="机器人, façade", robots=[Robot()], stop_time=1)

def control(world):
    print("第 0 步")
    if world.iteration == 3:
        world.stop({EVIL!r})
    return 0.1, 0.2
"""

FAILING = EXPERIMENT.replace("world.stop(", "raise ValueError(")

TERMINALS = {
    "ascii": {"PYTHONIOENCODING": "ascii"},
    "strict": {"PYTHONIOENCODING": "ascii:strict"},
    "cp1252": {"PYTHONIOENCODING": "cp1252"},
    "C": {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
    "utf-8": {"PYTHONIOENCODING": "utf-8"},
}


def mars(*words: object, cwd: Path, **environment: str) -> subprocess.CompletedProcess[bytes]:
    """Run a command line on a terminal of its own kind."""
    return subprocess.run(
        [sys.executable, "-m", "mars2d", *map(str, words)],
        cwd=cwd, capture_output=True, check=False, env=os.environ | environment,
    )  # fmt: skip


def sound(output: bytes, encoding: str = "utf-8") -> str:
    """Return what was printed, in which nothing is obeyed by a terminal."""
    text = output.decode(encoding)
    assert not UNSEEN.search(text), text
    return text


@pytest.mark.slow
@each_case("name", TERMINALS)
def test_on_any_terminal_nothing_breaks(tmp_path, name) -> None:
    encoding = {"cp1252": "cp1252", "utf-8": "utf-8"}.get(name, "ascii")
    (tmp_path / "team.py").write_text(EXPERIMENT, encoding="utf-8")
    (tmp_path / "fails.py").write_text(FAILING, encoding="utf-8")
    environment = TERMINALS[name]
    ran = mars("run", "team.py", "--headless", "--record", "run.npz", cwd=tmp_path, **environment)
    assert ran.returncode == 0, ran.stderr
    told = sound(ran.stdout, encoding)
    assert told.splitlines()[0] == "第 0 步".encode(encoding, "backslashreplace").decode(encoding)
    assert r": \x1b]0;owned\x07\x9b31m\u202egnp\u2066\r\nmars2d: all is well" in told
    for words in (["check", "run.npz"], ["check", "team.py"]):
        done = mars(*words, cwd=tmp_path, **environment)
        assert done.returncode == 0, done.stderr
        assert "façade".encode(encoding, "backslashreplace").decode(encoding) in done.stdout.decode(
            encoding
        )
        sound(done.stdout, encoding)
    failed = mars("run", "fails.py", "--headless", cwd=tmp_path, **environment)
    assert failed.returncode == 2
    told = sound(failed.stderr, encoding)
    assert len(told.splitlines()) == 1
    assert r"raised ValueError: \x1b]0;owned" in told


@each_case("words", [["--help"], ["run", "--help"], ["list"], ["nonsense é"]])
@pytest.mark.slow
def test_help_and_lists_are_printed_in_ascii(tmp_path, words) -> None:
    done = mars(*words, cwd=tmp_path, **TERMINALS["strict"])
    assert done.returncode == (2 if words[0] == "nonsense é" else 0)
    (done.stdout + done.stderr).decode("ascii")


@pytest.mark.skipif(sys.platform != "linux", reason="names of any bytes")
@pytest.mark.slow
def test_names_of_files_are_escaped(tmp_path) -> None:
    name = os.fsencode("team\x1b[31m\u202e") + b"\xff.py"
    (tmp_path / os.fsdecode(name)).write_text(EXPERIMENT, encoding="utf-8")
    ran = mars("run", os.fsdecode(name), "--headless", "--record", "r.npz", cwd=tmp_path)
    assert ran.returncode == 0, ran.stderr
    checked = mars("check", "r.npz", cwd=tmp_path)
    assert checked.returncode in (0, 2)
    assert r"(team\x1b[31m\u202e?.py)" in sound(checked.stdout)
    gone = mars("run", os.fsdecode(name.replace(b"team", b"gone")), cwd=tmp_path)
    assert gone.returncode == 2
    assert r"gone\x1b[31m\u202e\udcff.py: there is no such file" in sound(gone.stderr)


def test_a_foreign_record_is_escaped(tmp_path, capsys) -> None:
    record = mars2d.run(Scenario(stop_time=1))
    with np.load(record.save(tmp_path / "run.npz")) as kept:
        columns = dict(kept)
    header = json.loads(columns["header"].tobytes())
    evil = EVIL[:-1]
    header |= {"filename": evil, "versions": header["versions"] | {evil: evil}}
    columns["header"] = np.frombuffer(as_text(header).encode(), dtype=np.uint8)
    np.savez(tmp_path / "run.npz", **columns)
    cli.main(["check", str(tmp_path / "run.npz")])
    told = capsys.readouterr()
    assert r"(\x1b]0;owned\x07\x9b31m\u202egnp\u2066\r\nmars2d: all is well)" in told.out
    assert not UNSEEN.search(told.out + told.err)


def test_tables_are_escaped(tmp_path) -> None:
    failed = Result(1, {"n": 1}, 0, {}, EVIL)
    saved = save_table(Table("team.py", ("n",), (), (failed,)), tmp_path / "rows.csv").read_bytes()
    assert rb"\x1b]0;owned" in saved
    assert not UNSEEN.search(saved.decode().replace("\r\n", ""))
    assert not UNSEEN.search(league._cell(EVIL))


def test_json_stays_json(capsys) -> None:
    tell(json.dumps({"message": EVIL + "\x7f"}))
    assert json.loads(capsys.readouterr().out)["message"] == EVIL + "\x7f"


def test_half_a_character_in_a_message_breaks_no_record(tmp_path) -> None:
    record = mars2d.run(Scenario(stop_time=1), control=lambda world: world.stop(EVIL) or (0, 0))
    for name in ("run.npz", "run.csv"):
        assert mars2d.load(record.save(tmp_path / name)).digest == record.digest
    record.save_html(tmp_path / "run.html")
    assert record.over_message.endswith("well?")


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="folders that can be removed while in use")
def test_a_current_folder_that_is_gone_is_one_line() -> None:
    code = (
        "import os, sys, tempfile\n"
        "folder = tempfile.mkdtemp(); os.chdir(folder); os.rmdir(folder)\n"
        "from mars2d.cli.command_line import main\n"
        "sys.exit(main(['sweep', 'random_walk', '--set', 'stop_time=1']))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert (done.returncode, done.stderr.count(b"\n")) == (2, 1), done.stderr
    assert done.stderr.startswith(b"mars2d: ")


# -- the writer itself -----------------------------------------------------------------------------


class Stream(io.TextIOWrapper):
    """A stream whose bytes can be looked at."""

    def __init__(self, encoding: str, raw: io.RawIOBase | None = None) -> None:
        super().__init__(raw or io.BytesIO(), encoding=encoding, newline="\n")


class Full(io.RawIOBase):
    """A device without room."""

    def writable(self) -> bool:
        return True

    def write(self, data: object) -> int:
        raise OSError(28, "No space left on device")


def test_every_text_can_be_told_on_every_stream(monkeypatch) -> None:
    for encoding in ("ascii", "cp1252", "utf-8", "utf-16", "cp437"):
        out, err = Stream(encoding), Stream(encoding)
        monkeypatch.setattr(sys, "stdout", out)
        monkeypatch.setattr(sys, "stderr", err)
        tell("中", EVIL, sep="|")
        warn(EVIL)
        assert r"\x1b]0;owned" in out.buffer.getvalue().decode(encoding)
        assert err.buffer.getvalue().decode(encoding).count("\n") == 1


def test_a_full_device_is_one_error_and_stderr_none(monkeypatch) -> None:
    monkeypatch.setattr(sys, "stdout", Stream("utf-8", Full()))
    monkeypatch.setattr(sys, "stderr", Stream("utf-8", Full()))
    with pytest.raises(InputError, match="stdout can't be written: No space left on device"):
        tell("lost")
    warn("lost")


def test_a_long_message_is_cut(capsys) -> None:
    warn("x" * 5_000_000)
    assert capsys.readouterr().err == f"mars2d: {'x' * 2000}... (4,998,000 letters more)\n"
