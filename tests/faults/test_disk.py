"""Disks that are full, folders that go, files that change: one clear error, and no data lost."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import mars2d
from mars2d import InputError
from mars2d.cli import command_line as cli

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="disks of Linux"),
]

ROOM = 200  # kB

LAW = """
from mars2d import Robot, Scenario

scenario = Scenario(robots=[Robot(pose=(x, 0, x)) for x in (-2, 0, 2)], stop_time=60,
                    sampling_time=0.05, on_exit="wall")

def control(world):
    return [[0.3, 0.2, 0.1], [0.5, 0.1, -0.5]]
"""


@pytest.fixture(scope="module")
def disk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A small disk."""
    folder = tmp_path_factory.mktemp("small")
    made = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", f"size={ROOM}k", "tmpfs", folder],
        capture_output=True, check=False,
    )  # fmt: skip
    if made.returncode:
        pytest.skip("a small disk can't be mounted here")
    yield folder
    subprocess.run(["umount", "-l", folder], check=True)


@pytest.fixture
def here(tmp_path, monkeypatch) -> Path:
    """A folder with an experiment, in which rescued records are kept as well."""
    (tmp_path / "law.py").write_text(LAW)
    (tmp_path / "kept").mkdir()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "kept"))
    return tmp_path


def fill(disk: Path, left: int = 0) -> None:
    """Leave so many bytes on the disk, and nothing else than what fills it."""
    for path in disk.iterdir():
        path.unlink()
    with (disk / "filled").open("wb", buffering=0) as file:
        try:
            while True:
                file.write(bytes(4096))
        except OSError:
            file.truncate(max(0, file.tell() - left))


def said(capsys, *argv: object) -> str:
    """Run a command that fails for want of room, and return its errors."""
    code = cli.main([str(word) for word in argv])
    told = capsys.readouterr().err
    lines = [line for line in told.splitlines() if "there is no display" not in line]
    assert code == 2, told
    assert all(line.startswith("mars2d: ") for line in lines)
    return "\n".join(lines)


def rescued(told: str) -> mars2d.Record:
    """Return the record that was kept elsewhere, as an error says."""
    found = re.search(r"kept as (\S+\.npz)", told)
    assert found, told
    return mars2d.load(found[1])


def test_a_run_that_does_not_fit_is_kept_elsewhere_and_the_older_file_stays(
    disk, here, capsys
) -> None:
    fill(disk, 8192)
    target = disk / "run.npz"
    target.write_bytes(b"older")
    told = said(capsys, "run", "law.py", "--headless", "--record", target)
    assert told.startswith(f"mars2d: {target}: can't be written: No space left on device; the rec")
    assert rescued(told).digest == mars2d.run("law.py").digest
    assert sorted(path.name for path in disk.iterdir()) == ["filled", target.name]
    assert target.read_bytes() == b"older"


def test_nothing_half_written_is_left_on_a_full_disk(disk, here, capsys) -> None:
    fill(disk, 4096)
    told = said(capsys, "run", "law.py", "--headless", "--html", disk / "a.html")
    assert told == f"mars2d: {disk / 'a.html'}: can't be written: No space left on device"
    assert [path.name for path in disk.iterdir()] == ["filled"]


def test_in_python_the_record_is_in_the_error_and_kept_elsewhere(disk, here) -> None:
    fill(disk)
    with pytest.raises(InputError, match=r"run\.npz: can't be written: No space left") as caught:
        mars2d.run("law.py", record=disk / "run.npz")
    assert caught.value.record is not None
    assert rescued(str(caught.value)).digest == caught.value.record.digest
