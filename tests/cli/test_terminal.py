"""What is printed: on any terminal, whatever titles, laws and files say."""

from __future__ import annotations

import io
import json
import re
import sys

import numpy as np
import pytest

import mars2d
from mars2d import InputError, Scenario
from mars2d.cli import command_line as cli
from mars2d.core.terminal import tell, warn
from mars2d.output.formats.header import as_text

EVIL = "\x1b]0;owned\x07\x9b31m\u202egnp\u2066\r\nmars2d: all is well\ud800"
"""Codes of a terminal, text that is turned round, a line that is forged, half a character."""

UNSEEN = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069]")


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
