"""Files that are no records, or damaged, foreign or newer ones."""

from __future__ import annotations

import io
import json
import os
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from tests.cli.bad_inputs.case import Case, Content, script

__all__ = ["CASES", "RECORDS", "save", "saved"]

RECORDS = "MARS2D_TEST_RECORDS"
"""The environment's variable that says in which folder the sound ones lie."""

SUFFIXES = (".npz", ".csv", ".mcap")

GARBAGE = bytes((91 * k * k + 7 * k + k // 9) % 256 for k in range(3000))


def saved(name: str) -> bytes:
    """Return the bytes of a sound record: run.npz, run.csv, and so on."""
    return Path(os.environ[RECORDS], name).read_bytes()


def save(folder: Path) -> None:
    """Make the sound records, of a short run in each format."""
    from mars2d.output.formats.mcap import Log
    from mars2d.scenario.experiment import open_experiment
    from mars2d.world.loop import simulate

    log = Log(folder / "run.mcap")
    record = simulate(open_experiment("go_to_point", {"stop_time": 0.5}), log=log).record
    for suffix in SUFFIXES:
        if suffix != ".mcap":
            record.save(folder / f"run{suffix}")


Change = Callable[[bytes], bytes]

DAMAGE: dict[str, Change] = {
    "empty": lambda _: b"",
    "garbage": lambda _: GARBAGE,
    "of text": lambda _: b"time, x, y\nnot, a, run\n",
    "cut in half": lambda data: data[: len(data) // 2],
    "cut after its start": lambda data: data[:60],
    "overwritten in its middle": lambda data: (
        data[: len(data) // 2] + b"\xff" * 200 + data[len(data) // 2 + 200 :]
    ),
}
"""What may have happened to a file, of any format."""

WHOLE = {
    ("overwritten in its middle", ".mcap"),
    ("cut in half", ".mcap"),
    ("cut after its start", ".mcap"),
}
"""A log that breaks off is read as far as it goes: that is what it is for."""


def _damaged() -> list[Case]:
    cases = []
    for suffix in SUFFIXES:
        name = f"run{suffix}"
        for damage, change in DAMAGE.items():
            if (damage, suffix) not in WHOLE:
                content = _changed(name, change)
                verb = "replay run --html a.html" if damage == "cut in half" else "check run"
                command = "mars2d " + verb.replace("run", name)
                cases.append(Case(f"a {suffix} {damage}", command, (name,), {name: content}))
    return cases


def _changed(name: str, change: Change) -> Callable[[], bytes]:
    return lambda: change(saved(name))


def _npz(**columns: object) -> Callable[[], bytes]:
    """Return what makes the file of a run in which some columns, or the header, are others."""

    def make() -> bytes:
        with np.load(io.BytesIO(saved("run.npz"))) as file:
            data = dict(file)
        for name, value in columns.items():
            data[name] = value(data[name]) if callable(value) else np.asarray(value)
        out = io.BytesIO()
        np.savez(out, **data)
        return out.getvalue()

    return make


def _npz_of_others() -> bytes:
    out = io.BytesIO()
    np.savez(out, x=np.eye(3))
    return out.getvalue()


def _zip_of(name: str, data: bytes) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as file:
        file.writestr(name, data)
    return out.getvalue()


def _header(**changes: object) -> Callable[[np.ndarray], np.ndarray]:
    """Return what changes entries of the header of a run's file; to ... they are left out."""

    def make(text: np.ndarray) -> np.ndarray:
        from mars2d.output.formats.header import as_text

        header = json.loads(text.tobytes()) | changes
        kept = {name: value for name, value in header.items() if value is not ...}
        return np.frombuffer(as_text(kept).encode(), np.uint8)

    return make


def _renamed(suffix: str) -> Callable[[], bytes]:
    return lambda: saved(f"run{suffix}")


OTHERS: list[tuple[str, str, Content, tuple[str, ...]]] = [
    ("a record from a newer version", "run.npz", _npz(header=_header(format=9)), ("newer",)),
    ("a record with a word for a seed", "run.npz", _npz(header=_header(seed="one")), ("seed",)),
    ("a record with a header of a list", "run.npz", _npz(header=np.frombuffer(b"[]", np.uint8)),
     ("damaged",)),
    ("a record with poses of objects", "run.npz", _npz(pose=lambda _: np.array([None])),
     ("damaged",)),
    ("a record with a pose moved", "run.npz", _npz(pose=lambda pose: pose + 1), ("digest",)),
    ("arrays of another program", "run.npz", _npz_of_others, ("not a record of MARS2D",)),
    ("a table in the name of arrays", "run.npz", _renamed(".csv"), ("run.npz",)),
    ("a record in a spreadsheet's name", "run.xlsx", _renamed(".npz"), ("run.xlsx", ".npz")),
    ("a table without its end", "run.csv", "time,body,x,y,theta,record\n", ("run.csv",)),
]  # fmt: skip


def _others() -> list[Case]:
    return [Case(n, f"mars2d check {name}", (name, *words), {name: content})
            for n, name, content, words in OTHERS]  # fmt: skip


def _of_run(name: str, code: str, *words: str) -> Case:
    return script(name, code, *words, run__npz=lambda: saved("run.npz"))


CASES = [
    *_damaged(),
    *_others(),
    script("a record that is a number", "load(5)", "path = 5", "'run.npz'"),
    script("a record that is one's scenario", "load(Scenario())", "path = Scenario("),
    _of_run("a record that is larger than allowed", "load('run.npz', largest=10)", "run.npz", "10"),
    _of_run("a record that is misspelt", "load('rnu.npz')", "rnu.npz", "'run.npz'"),
    _of_run("a record saved as text", "load('run.npz').save('a.txt')", "a.txt", ".npz"),
    _of_run("a record saved nowhere", "load('run.npz').save('no/a.npz')", "no/a.npz",
          "No such file"),
    _of_run("a replay saved as PDF", "load('run.npz').save_html('a.pdf')", "a.pdf", ".html"),
    _of_run("a record's signal that is none", "load('run.npz').plot_signals('sped')", "sped"),
    _of_run("a record's snapshots after its end", "load('run.npz').plot_snapshots([9])", "9"),
]  # fmt: skip
