"""What holds for each format: all comes back to the last bit, or is refused in one clear line."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import mars2d
from mars2d import InputError, Robot, Scenario
from mars2d.core.extras import pip_line
from mars2d.output import formats
from mars2d.output.formats.columns import KEYWORDS, MAX_NAME, plain_names
from mars2d.output.formats.header import as_text
from tests.cases import each_case
from tests.output.formats.records import FORMATS, cut_to, everything, records, refused

each_format = each_case("suffix", FORMATS)


@each_case("suffix", formats.FORMATS)
def test_a_formats_module_has_what_its_line_in_the_table_says(suffix):
    format_ = formats.FORMATS[suffix]
    module = import_module(f"mars2d.output.formats.{format_.module}")
    assert hasattr(module, "read") == (suffix in formats.SUFFIXES)
    assert callable(module.write)
    assert hasattr(module, "require") == bool(format_.extra)
    assert hasattr(module, "Log") == format_.streamed == formats.is_streamed(Path(f"run{suffix}"))


# -- what is saved comes back ---------------------------------------------------------------


@each_format
def test_a_record_with_everything_comes_back_to_the_last_bit(suffix, tmp_path):
    record = everything()
    assert len(record.contacts) > 5
    assert len(record.contents) > 5
    again = mars2d.load(record.save(tmp_path / f"run{suffix}"))
    assert again.digest == record.digest
    for name, column in record.columns().items():
        found = again.columns()[name]
        assert (found.dtype, found.shape) == (column.dtype, column.shape), name
        assert found.tobytes() == column.tobytes(), name
    for name in ("seed", "over_message", "finished", "filename", "versions", "sensor_robots",
                 "contents", "interventions"):  # fmt: skip
        assert getattr(again, name) == getattr(record, name)
    assert [robot.name for robot in again.scenario.robots] == ["robot0", 'größe, "x"', "robot2"]
    assert again.missing == ("sensor Grid",)
    twice = again.save(tmp_path / f"twice{suffix}")
    assert mars2d.load(twice).digest == record.digest


@each_format
@each_case("rows", [0, 1, 2])
def test_a_record_of_few_rows_comes_back(suffix, rows, tmp_path):
    record = cut_to(everything(), rows)
    again = mars2d.load(record.save(tmp_path / f"run{suffix}"))
    assert (len(again), again.digest) == (rows, record.digest)


@pytest.mark.slow
@settings(max_examples=30)
@given(record=records())
def test_any_bits_come_back(record, tmp_path_factory):
    for suffix in FORMATS:
        again = mars2d.load(record.save(tmp_path_factory.getbasetemp() / f"any{suffix}"))
        assert again.digest == record.digest
        assert (again.contents, again.seed) == (record.contents, record.seed)


@given(names=st.lists(st.text(), unique=True))
def test_names_for_other_programs_are_plain_and_differ(names):
    plain = plain_names([*names, 70 * "a", 70 * "a" + "b", *KEYWORDS])
    assert len(set(plain.values())) == len(plain)
    for name in plain.values():
        assert name.isascii()
        assert name.isidentifier()
        assert name[0].isalpha()
        assert name not in KEYWORDS
        assert len(name) <= MAX_NAME


# -- what is no record ----------------------------------------------------------------------


@each_format
@each_case(
    "content",
    [b"", b"hello", b"PK\x03\x04", b"\x93NUMPY", b"\x80\x04K\x01.", bytes(1000), b"CDF\x01",
     b"time,body\n1,2\n", b'"', b"\xff\xfe\x00", b"CDF\x02" + 99 * b"\xff", b"[" * 10**6],
)  # fmt: skip
def test_a_foreign_file_is_refused(suffix, content, tmp_path):
    path = tmp_path / f"foreign{suffix}"
    path.write_bytes(content)
    refused(path, "not a record of MARS2D, or damaged")


@each_case("path", [None, 3, b"run.npz", "run\0.npz", ["run.npz"]])
def test_what_is_no_name_of_a_file_is_refused(path):
    for call in (mars2d.load, everything().save):
        with pytest.raises(InputError, match=r"expected the name of a file, such as 'run.npz'"):
            call(path)


@each_format
def test_a_pipe_is_refused(suffix, tmp_path):
    if not hasattr(os, "mkfifo"):
        pytest.skip("there are no pipes in folders here")
    os.mkfifo(tmp_path / f"pipe{suffix}")
    refused(tmp_path / f"pipe{suffix}", "not a file; expected a record")


@each_format
def test_a_misspelt_name_is_answered_with_the_nearest_one(suffix, tmp_path):
    (tmp_path / f"pursuit{suffix}").write_bytes(b"")
    refused(tmp_path / f"persuit{suffix}", f"no such file; did you mean '.*pursuit{suffix}'")


@each_format
@each_case("other", FORMATS)
def test_a_record_under_a_wrong_name_is_refused(suffix, other, tmp_path):
    if suffix != other:
        path = tmp_path / f"run{other}"
        everything().save(tmp_path / f"run{suffix}").rename(path)
        refused(path, "not a record of MARS2D, or damaged")


@each_format
def test_a_truncated_file_is_refused(suffix, tmp_path):
    whole = everything().save(tmp_path / f"whole{suffix}").read_bytes()
    path = tmp_path / f"cut{suffix}"
    few = [0, 1, 3, 4, 100, 127, 128, 130, len(whole) - 30]
    for size in [*few, *np.linspace(0, len(whole) - 5, 30, dtype=int)]:
        path.write_bytes(whole[:size])
        refused(path)


@each_format
def test_a_file_with_a_flipped_bit_is_refused_or_unharmed(suffix, tmp_path):
    record = everything()
    whole = record.save(tmp_path / f"whole{suffix}").read_bytes()
    path = tmp_path / f"flipped{suffix}"
    rng = np.random.default_rng(0)
    refusals, places = 0, rng.choice(len(whole), 100, replace=False)
    for place in [*range(8), *places]:
        damaged = bytearray(whole)
        damaged[place] ^= 1 << int(rng.integers(8))
        path.write_bytes(damaged)
        try:
            assert mars2d.load(path).digest == record.digest
        except InputError as error:
            refusals += 1
            assert str(error).startswith(str(path))  # noqa: PT017 - both outcomes are right
    assert refusals > 50


@each_format
@each_case("version, words", [(9, "a newer"), (1, "an older")])
def test_a_file_of_another_version_says_so(suffix, version, words, tmp_path):
    path = everything().save(tmp_path / f"run{suffix}")
    _rewrite_header(path, {"format": version, "versions": {"mars2d": "7.7"}, "scenario": "gone"})
    refused(path, f"written by {words} version of MARS2D, 7.7: ")


@each_format
@each_case(
    "change",
    [
        {"format": "1"}, {"format": None}, {"scenario": None}, {"scenario": {"type": "Robot"}},
        {"scenario": {"type": ["x"]}}, {"scenario": {"type": "Scenario", "robts": 3}},
        {"sensor_robots": []}, {"sensor_robots": {"beams": 3}}, {"digest": "0"}, {"digest": None},
        {"over_message": 5}, {"versions": None}, {"seed": -1}, {"messages": False},
    ],
)  # fmt: skip
def test_a_header_that_makes_no_sense_is_refused(suffix, change, tmp_path):
    path = everything().save(tmp_path / f"run{suffix}")
    _rewrite_header(path, change)
    refused(path)


@each_format
@each_case(
    "change",
    [
        {"format": True}, {"format": 3.0}, {"format": float("nan")}, {"seed": 2**63},
        {"over_message": "caf\udce9"}, {"filename": "caf\udce9.py"},
        {"sensor_robots": {"proximity": [0], "grid": [2, 2], "x": [2], "größe": [2]}},
    ],
)  # fmt: skip
def test_a_header_that_no_run_has_is_refused(suffix, change, tmp_path):
    path = everything().save(tmp_path / f"run{suffix}")
    _rewrite_header(path, change)
    refused(path)


@each_case(
    "number, change",
    [
        (0, {"body": 5}), (0, {"body": -1}), (0, {"body": "robot0"}), (0, {"body": True}),
        (0, {"pose": [1, 2]}), (0, {"pose": [1, 2, float("nan")]}), (0, {"pose": None}),
        (0, {"row": -1}), (0, {"row": 3}), (1, {"grip": None}), (1, {"target": [1]}),
        (1, {"force": "strong"}), (1, {"speed": float("inf")}), (2, {"robot": 3}),
        (2, {"driven": "yes"}), (3, {"scenario": 5}), (3, {"moved": [[7, [0, 0, 0]]]}),
        (3, {"moved": ["ab"]}), (3, {"row": 22}), (3, {"type": "Burst"}),
    ],
)  # fmt: skip
def test_what_cannot_have_been_done_to_a_run_is_refused(number, change, tmp_path):
    path = everything().save(tmp_path / "run.npz")
    done = _header(path)["interventions"]
    done[number] |= change
    _rewrite_header(path, {"interventions": done})
    refused(path, "not a record of MARS2D, or damaged")


@each_case(
    "column",
    [["<f8", [-1, 3, 3]], ["<f8", [3, 3]], ["|O", [21, 3, 3]], ["<f8", "x"], 5, None],
)  # fmt: skip
def test_a_header_that_lies_about_a_column_is_refused(column, tmp_path):
    path = everything().save(tmp_path / "run.csv")
    header = _header(path)
    header["columns"]["pose"] = column
    _rewrite_header(path, header)
    refused(path, "not a record of MARS2D, or damaged|digest")


def test_a_record_of_a_robot_with_a_long_name_comes_back(tmp_path):
    record = mars2d.run(mars2d.Scenario(robots=[mars2d.Robot(name="r" * 140_000)], stop_time=0.2))
    assert mars2d.load(record.save(tmp_path / "run.csv")).digest == record.digest


def _header(path: Path) -> dict:
    if path.suffix == ".npz":
        with np.load(path) as data:
            return json.loads(data["header"].tobytes())
    return json.loads(_cells(path)["record"])


def _cells(path: Path) -> dict:
    import pandas as pd

    table = pd.read_csv(path, dtype=str, keep_default_na=False)
    return {"table": table, "record": "".join(table["record"])}


def _rewrite_header(path: Path, change: dict, write=as_text) -> None:
    """Change some of a file's header, all else stays; write: by whom, by default with its sums."""
    text = write(_header(path) | change)
    if path.suffix == ".npz":
        with np.load(path) as data:
            np.savez(path, **{**data, "header": np.frombuffer(text.encode(), np.uint8)})
    else:
        table = _cells(path)["table"]
        table["record"] = ["".join(text[i * 30000 :][:30000]) for i in range(len(table))]
        table.to_csv(path, index=False)


def test_what_rewrites_headers_here_leaves_the_rest_of_a_file_as_it_is(tmp_path):
    for suffix in FORMATS:
        path = everything().save(tmp_path / f"run{suffix}")
        _rewrite_header(path, {})
        assert mars2d.load(path).digest == everything().digest


# -- what somebody changed ------------------------------------------------------------------


def _swapped(header):
    first, second = header["scenario"]["robots"][:2]
    names = first.get("name"), second.get("name")
    first["name"], second["name"] = names[::-1]
    return {"scenario": header["scenario"]}


EDITS = [
    (_swapped, "its scenario"),
    (lambda header: {"seed": header["seed"] + 1}, "its seed"),
    (lambda header: {"finished": not header["finished"]}, "whether it was finished"),
    (lambda header: {"filename": "other.py"}, "the name of its experiment"),
    (lambda header: {"versions": header["versions"] | {"numpy": "1"}}, "the versions"),
    (lambda header: {"sensor_robots": {}}, "which robots carry its sensors"),
    (lambda header: {"interventions": []}, "what was done by hand"),
    (lambda header: {"digest": "0" * 64}, "its digest"),
    (lambda header: {"over_message": "the other one won"}, "why it ended"),
    (lambda _: {"signed": "by me"}, "'signed'"),
]  # fmt: skip


@each_case("edit, said", EDITS)
@each_format
def test_an_edit_of_a_header_is_refused_and_named(suffix, edit, said, tmp_path):
    path = everything().save(tmp_path / f"run{suffix}")
    _rewrite_header(path, edit(_header(path)), json.dumps)
    refused(path, f"damaged: {said}.*changed since it was saved")


@each_case("physics", ["contact", "stop"])
def test_an_edit_of_the_physics_is_refused(physics, tmp_path):
    path = everything().save(tmp_path / "run.npz")
    header = _header(path)
    if header["scenario"].get("physics", "contact") == physics:
        physics = "ideal"
    _rewrite_header(path, {"scenario": header["scenario"] | {"physics": physics}}, json.dumps)
    refused(path, "its scenario")


def test_without_its_check_sums_a_header_is_refused(tmp_path):
    path = everything().save(tmp_path / "run.npz")
    header = _header(path)
    del header["sums"]
    with np.load(path) as data:
        text = np.frombuffer(json.dumps(header).encode(), np.uint8)
        np.savez(path, **{**data, "header": text})
    refused(path, "damaged")


@each_case("change", [("robot1", "robot9"), ("0.1,", "0.2,")])
def test_a_table_whose_bodies_or_times_were_mixed_up_is_refused(change, tmp_path):
    scenario = Scenario(robots=[Robot(), Robot(pose=(2, 0, 0))], stop_time=0.3)
    path = mars2d.run(scenario, control=lambda world: [[0.1] * 2, [0] * 2]).save(tmp_path / "r.csv")
    lines = path.read_text().split("\n")
    lines[4] = lines[4].replace(*change)
    path.write_text("\n".join(lines))
    refused(path, "damaged")


# -- where it can't be written --------------------------------------------------------------


@each_format
def test_where_nothing_can_be_written_it_says_so(suffix, tmp_path):
    with pytest.raises(InputError, match="can't be written: No such file or directory"):
        everything().save(tmp_path / "missing" / f"run{suffix}")
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="can't be written: Not a directory"):
        everything().save(tmp_path / "file" / f"run{suffix}")
    (tmp_path / f"folder{suffix}").mkdir()
    with pytest.raises(InputError, match="can't be written: this is a folder"):
        everything().save(tmp_path / f"folder{suffix}")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", f"folder{suffix}"]


@pytest.fixture
def small_disk(tmp_path) -> Iterator[Path]:
    """A disk of 8 kB."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=8k", "tmpfs", str(folder)]
    if shutil.which("mount") is None or os.name != "posix":
        pytest.skip("there is no mount")
    if subprocess.run(mount, capture_output=True, check=False).returncode:
        pytest.skip("disks can't be mounted here")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


@pytest.mark.parametrize("suffix", FORMATS)
def test_on_a_full_disk_it_says_so_and_the_file_before_stays(suffix, small_disk):
    path = small_disk / f"run{suffix}"
    path.write_bytes(b"before")
    with pytest.raises(InputError, match="can't be written: No space left on device"):
        _large().save(path)
    assert [each.name for each in small_disk.iterdir()] == [path.name]
    assert path.read_bytes() == b"before"
    path.unlink()


def _large() -> mars2d.Record:
    rng, robots = np.random.default_rng(0), 2
    return mars2d.Record(
        mars2d.Scenario(robots=robots), 0, np.arange(1000.0), rng.normal(size=(1000, 3, robots)),
        rng.normal(size=(1000, 2, robots)), np.arange(1000.0), np.empty((1000, 3, 0)),
        rng.normal(size=(1000, robots)),
    )  # fmt: skip


# -- what is installed ----------------------------------------------------------------------

BLOCKED = """
import sys
for name in ("pandas", "xarray", "mcap"):
    sys.modules[name] = None
import mars2d
from mars2d.core.errors import MissingExtraError
record = mars2d.run(mars2d.Scenario(stop_time=0.5))
def said(call, *arguments):
    try:
        call(*arguments)
    except MissingExtraError as error:
        print(error)
"""


def test_without_extras_all_but_netcdf_can_be_written(child, tmp_path):
    code = BLOCKED + (
        f"for suffix in ('.npz', '.csv', '.mat'):\n"
        f"    print(record.save({str(tmp_path)!r} + '/run' + suffix).exists())\n"
        f"said(record.save, {str(tmp_path)!r} + '/run.nc')\n"
        "said(record.to_xarray)\nsaid(record.to_frame)\n"
    )
    result = child(code)
    needed = f"netCDF needs xarray: {pip_line('data')}; .npz, .mat and .csv need nothing"
    assert result.stdout.splitlines() == [
        "True", "True", "True",
        f"{tmp_path}/run.nc: {needed}",
        f'datasets need xarray: {pip_line("data")}',
        f'tables need pandas: {pip_line("data")}',
    ], result.stderr  # fmt: skip


def test_exports_are_written_for_others_and_not_read_back(tmp_path):
    for name in ("run.mat", "run.nc"):
        with pytest.raises(InputError, match=rf"{name}: an export for other programs; expected a"):
            mars2d.load(everything().save(tmp_path / name))


@each_case("suffix", FORMATS)
def test_a_file_larger_than_asked_for_is_refused_and_told_how_to_read(suffix, tmp_path):
    path = everything().save(tmp_path / f"run{suffix}")
    text = refused(path, "holds, or claims to hold, .* more than the 200 bytes", largest=200)
    enough = float(text.split("largest=")[1].rstrip(")"))
    assert 200 < enough < 100 * path.stat().st_size
