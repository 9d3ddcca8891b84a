"""Disks that are full, folders that go, files that change: one clear error, and no data lost."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d import InputError, Robot, Scenario
from mars2d.cli import command_line as cli
from mars2d.scenario import save_scenario

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

SMALL = ["--size", "160x120", "--speed", "20"]


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


@pytest.mark.parametrize("suffix", [".npz", ".csv"])
@pytest.mark.parametrize("left", [0, 8192])
def test_a_run_that_does_not_fit_is_kept_elsewhere_and_the_older_file_stays(
    disk, here, capsys, suffix, left
) -> None:
    fill(disk, left + 4096)
    target = disk / f"run{suffix}"
    target.write_bytes(b"older")
    told = said(capsys, "run", "law.py", "--headless", "--record", target)
    assert told.startswith(f"mars2d: {target}: can't be written: No space left on device; the rec")
    assert rescued(told).digest == mars2d.run("law.py").digest
    assert sorted(path.name for path in disk.iterdir()) == ["filled", target.name]
    assert target.read_bytes() == b"older"


def test_outputs_after_one_that_fails_are_made_all_the_same(disk, here, capsys) -> None:
    fill(disk)
    told = said(
        capsys, "run", "law.py", "--headless", "--record", disk / "run.npz", "--figure",
        disk / "run.png", "--html", "run.html", "--video", "run.gif", *SMALL,
    )  # fmt: skip
    assert told.count("\n") == 1
    assert f"{disk / 'run.npz'}: can't be written" in told
    assert f"{disk / 'run.png'}: can't be written: No space left on device" in told
    assert Path("run.html").stat().st_size > 1000
    assert Path("run.gif").stat().st_size > 1000
    assert [path.name for path in disk.iterdir()] == ["filled"]


@pytest.mark.parametrize(
    ("option", "name"),
    [("--figure", "a.svg"), ("--figure", "a.pdf"), ("--html", "a.html"), ("--video", "a.gif"),
     ("--video", "a.mp4")],
)  # fmt: skip
def test_nothing_half_written_is_left_on_a_full_disk(disk, here, capsys, option, name) -> None:
    if name.endswith(".mp4"):
        pytest.importorskip("av")
    fill(disk, 4096)
    more = SMALL if option == "--video" else []
    told = said(capsys, "run", "law.py", "--headless", option, disk / name, *more)
    assert told == f"mars2d: {disk / name}: can't be written: No space left on device"
    assert [path.name for path in disk.iterdir()] == ["filled"]


def test_a_scenario_that_does_not_fit_leaves_the_older_one(disk) -> None:
    fill(disk, 4096)
    target = disk / "team.toml"
    target.write_text("older")
    scenario = Scenario(robots=[Robot(pose=(x, 0, 0)) for x in np.linspace(-2, 2, 12)])
    fill_rest(disk)
    with pytest.raises(InputError, match=r"team\.toml: can't be written: No space left"):
        save_scenario(scenario, target)
    assert target.read_text() == "older"


def fill_rest(disk: Path) -> None:
    with (disk / "rest").open("wb", buffering=0) as file:
        try:
            while True:
                file.write(bytes(4096))
        except OSError:
            return


def test_a_sweep_on_a_full_disk_keeps_the_rows_that_fitted_and_goes_on(disk, here, capsys) -> None:
    fill(disk, 4096)
    out = disk / "rows.csv"
    argv = ["sweep", "law.py", "--set", "stop_time=1", "--seeds", 60, "--workers", 1, "--out", out]
    told = said(capsys, *argv)
    assert told == f"mars2d: {out}: can't be written: No space left on device"
    whole = out.read_bytes().rpartition(b"\r\n")[0]
    rows = whole.count(b"\r\n")
    assert 10 < rows < 60
    (disk / "filled").unlink()
    assert cli.main([str(word) for word in argv]) == 0
    assert out.read_bytes().startswith(whole[: whole.index(b"\r\n")])
    assert out.read_bytes().count(b"\r\n") == 61


def test_a_league_on_a_full_disk_is_one_error(disk, here, capsys) -> None:
    fill(disk, 8192)
    league = disk / "league"
    try:
        told = said(
            capsys, "tournament", "sumo", "--players", "sumo_players/*.py", "--seeds", 1,
            "--stop-time", 2, "--workers", 1, "--out", league,
        )  # fmt: skip
        assert re.fullmatch(
            rf"mars2d: {league}/\S+: can't be written: No space left on device", told
        )
        assert not [path for path in league.iterdir() if path.name.startswith(".")]
    finally:
        for path in league.iterdir():
            path.unlink()
        league.rmdir()


# -- what changes while a run goes on -------------------------------------------------------------

CHANGING = """
import os, pathlib
def control(world):
    if world.iteration == 20:
        {act}
    return 0.1, 0.2
"""


@pytest.mark.parametrize(
    ("act", "why"),
    [
        ("__import__('shutil').rmtree('there')", "No such file or directory"),
        ("os.mkdir('there/run.npz')", "this is a folder"),
        ("pathlib.Path('there/run.npz').write_text(''); os.chmod('there/run.npz', 0o444)",
         "it may only be read"),
    ],
    ids=["folder removed", "a folder in its place", "may only be read"],
)  # fmt: skip
def test_where_a_file_can_not_be_written_any_more_the_run_is_kept_elsewhere(
    here, capsys, monkeypatch, act, why
) -> None:
    Path("there").mkdir()
    Path("law.py").write_text("from mars2d import Scenario\nscenario = Scenario(stop_time=10)\n"
                              + CHANGING.format(act=act))  # fmt: skip
    access = os.access
    monkeypatch.setattr(  # root may write to anything
        "os.access", lambda path, mode: access(path, mode) and
        not (Path(path).is_file() and mode == os.W_OK and not Path(path).stat().st_mode & 0o200),
    )  # fmt: skip
    told = said(capsys, "run", "law.py", "--headless", "--record", "there/run.npz")
    assert told.startswith(f"mars2d: there/run.npz: can't be written: {why}; the record is kept as")
    assert len(rescued(told)) == 101


def test_a_log_that_is_removed_is_kept_elsewhere(here, capsys) -> None:
    pytest.importorskip("mcap")
    Path("law.py").write_text(
        "from mars2d import Scenario\nscenario = Scenario(stop_time=10)\n"
        + CHANGING.format(act="os.unlink('run.mcap')")
    )
    told = said(capsys, "run", "law.py", "--headless", "--record", "run.mcap")
    assert "run.mcap: it was deleted or moved while it was written" in told
    assert len(rescued(told)) == 101


def test_in_python_the_record_is_in_the_error_and_kept_elsewhere(disk, here) -> None:
    fill(disk)
    with pytest.raises(InputError, match=r"run\.npz: can't be written: No space left") as caught:
        mars2d.run("law.py", record=disk / "run.npz")
    assert caught.value.record is not None
    assert rescued(str(caught.value)).digest == caught.value.record.digest


def test_where_there_is_no_room_anywhere_the_error_says_so(disk, here, monkeypatch) -> None:
    fill(disk)
    monkeypatch.setattr("mars2d.output.formats._folders", lambda: iter([disk]))
    with pytest.raises(InputError, match="and nowhere else either") as caught:
        mars2d.run("law.py", record=disk / "run.npz")
    assert len(caught.value.record) == 1201
    assert [path.name for path in disk.iterdir()] == ["filled"]
