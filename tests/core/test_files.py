"""Output files: whole or not at all, each with one writer, and nothing left behind."""

from __future__ import annotations

import os
import sys
from multiprocessing.pool import ThreadPool
from pathlib import Path

import pytest

import mars2d
from mars2d import InputError, Scenario
from mars2d.cli.command_line import main
from mars2d.core.files import atomic_write
from tests.cases import each_case

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="files of POSIX")


def write(path: Path, data: bytes = b"new") -> None:
    with atomic_write(path) as file:
        file.write(data)


def names(folder: Path) -> list[str]:
    return [path.name for path in folder.iterdir()]


def test_a_file_is_replaced_whole_and_nothing_else_is_left(tmp_path) -> None:
    target = tmp_path / "run.csv"
    write(target, b"older")
    with pytest.raises(ZeroDivisionError), atomic_write(target) as file:
        file.write(b"half")
        raise ZeroDivisionError
    assert target.read_bytes() == b"older"
    write(target)
    assert target.read_bytes() == b"new"
    assert names(tmp_path) == ["run.csv"]


def test_writers_of_one_file_do_not_meet(tmp_path) -> None:
    target = tmp_path / "run.csv"
    texts = [bytes([letter]) * 100_000 for letter in b"abcdefgh"]
    with ThreadPool(len(texts)) as pool:
        for _ in range(20):
            pool.map(lambda text: write(target, text), texts)
            assert target.read_bytes() in texts
    assert names(tmp_path) == ["run.csv"]


def test_permissions_and_symbolic_links_stay(tmp_path) -> None:
    target, link = tmp_path / "there" / "run.csv", tmp_path / "link.csv"
    target.parent.mkdir()
    target.touch(0o600)
    link.symlink_to(Path("there") / "run.csv")
    write(link)
    assert link.is_symlink()
    assert target.read_bytes() == b"new"
    assert target.stat().st_mode & 0o777 == 0o600
    before = os.umask(0o027)
    try:
        write(tmp_path / "other.csv")
    finally:
        os.umask(before)
    assert (tmp_path / "other.csv").stat().st_mode & 0o777 == 0o640


@each_case("suffix", [".npz", ".mcap"])
def test_a_pipe_is_refused_before_the_run(tmp_path, capsys, suffix) -> None:
    pipe = tmp_path / f"run{suffix}"
    os.mkfifo(pipe)
    assert main(["run", "random_walk", "--headless", "--record", str(pipe)]) == 2
    said = f"--record {pipe}: this is a pipe or a device; expected a file"
    assert said in capsys.readouterr().err
    with pytest.raises(InputError, match="this is a pipe or a device; expected a file"):
        mars2d.run(Scenario(stop_time=1), record=pipe)
    assert pipe.is_fifo()
