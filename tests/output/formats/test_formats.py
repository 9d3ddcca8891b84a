"""What holds for each format: all comes back to the last bit, or is refused in one clear line."""

from __future__ import annotations

import json
import random
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings

import mars2d
from mars2d import InputError
from mars2d.core.extras import pip_line
from mars2d.output.formats.header import as_text
from tests.cases import each_case
from tests.output.formats.records import FORMATS, cut_to, everything, records, refused

each_format = each_case("suffix", FORMATS)


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


@pytest.mark.nightly
@settings(max_examples=30)
@given(record=records())
def test_any_bits_come_back(record, tmp_path_factory):
    for suffix in FORMATS:
        again = mars2d.load(record.save(tmp_path_factory.getbasetemp() / f"any{suffix}"))
        assert again.digest == record.digest
        assert (again.contents, again.seed) == (record.contents, record.seed)


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


@each_format
def test_a_misspelt_name_is_answered_with_the_nearest_one(suffix, tmp_path):
    (tmp_path / f"pursuit{suffix}").write_bytes(b"")
    refused(tmp_path / f"persuit{suffix}", f"no such file; did you mean '.*pursuit{suffix}'")


@each_format
def test_a_truncated_file_is_refused(suffix, tmp_path):
    whole = everything().save(tmp_path / f"whole{suffix}").read_bytes()
    path = tmp_path / f"cut{suffix}"
    few = [0, 1, 3, 4, 100, 127, 128, 130, len(whole) - 30]
    for size in [*few, *np.linspace(0, len(whole) - 5, 30, dtype=int)]:
        path.write_bytes(whole[:size])
        refused(path)


@each_case("version, words", [(9, "a newer"), (1, "an older")])
def test_a_file_of_another_version_says_so(version, words, tmp_path):
    path = everything().save(tmp_path / "run.npz")
    _rewrite_header(path, {"format": version, "versions": {"mars2d": "7.7"}, "scenario": "gone"})
    refused(path, f"written by {words} version of MARS2D, 7.7: ")


def _header(path: Path) -> dict:
    with np.load(path) as data:
        return json.loads(data["header"].tobytes())


def _rewrite_header(path: Path, change: dict, write=as_text) -> None:
    """Change some of a file's header, all else stays; write: by whom, by default with its sums."""
    text = write(_header(path) | change)
    with np.load(path) as data:
        np.savez(path, **{**data, "header": np.frombuffer(text.encode(), np.uint8)})


# -- what somebody changed ------------------------------------------------------------------


def _swapped(header):
    first, second = header["scenario"]["robots"][:2]
    names = first.get("name"), second.get("name")
    first["name"], second["name"] = names[::-1]
    return {"scenario": header["scenario"]}


EDITS = [
    (_swapped, "scenario"),
    (lambda header: {"seed": header["seed"] + 1}, "seed"),
    (lambda header: {"interventions": []}, "interventions"),
    (lambda header: {"digest": "0" * 64}, "digest"),
    (lambda _: {"signed": "by me"}, "signed"),
]


@each_case("edit, said", EDITS)
def test_an_edit_of_a_header_is_refused_and_named(edit, said, tmp_path):
    path = everything().save(tmp_path / "run.npz")
    _rewrite_header(path, edit(_header(path)), json.dumps)
    refused(path, f"damaged: {said}.*changed since it was saved")


@each_format
def test_a_flipped_bit_is_noticed_unless_it_changes_nothing(suffix, tmp_path):
    path = cut_to(everything(), 3).save(tmp_path / f"run{suffix}")
    whole, good = path.read_bytes(), mars2d.load(path)
    chosen, noticed = random.Random(1), 0
    for _ in range(60):
        data = bytearray(whole)
        data[chosen.randrange(len(data))] ^= 1 << chosen.randrange(8)
        path.write_bytes(data)
        try:
            again = mars2d.load(path)
        except InputError:
            noticed += 1
        else:
            assert (again.digest, again.scenario) == (good.digest, good.scenario)
    assert noticed > 30


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


@pytest.mark.slow
def test_without_extras_records_can_be_written(child, tmp_path):
    code = BLOCKED + (
        f"for suffix in ('.npz', '.csv', '.mat'):\n"
        f"    print(record.save({str(tmp_path)!r} + '/run' + suffix).exists())\n"
        "said(record.to_xarray)\n"
    )
    result = child(code)
    assert result.stdout.splitlines() == [
        "True", "True", "True",
        f'datasets need xarray: {pip_line("data")}',
    ], result.stderr  # fmt: skip


def test_exports_are_written_for_others_and_not_read_back(tmp_path):
    with pytest.raises(InputError, match=r"run\.mat: an export for other programs; expected a"):
        mars2d.load(everything().save(tmp_path / "run.mat"))


@each_case("suffix", FORMATS)
def test_a_file_larger_than_asked_for_is_refused_and_told_how_to_read(suffix, tmp_path):
    path = everything().save(tmp_path / f"run{suffix}")
    text = refused(path, "holds, or claims to hold, .* more than the 200 bytes", largest=200)
    enough = float(text.split("largest=")[1].rstrip(")"))
    assert 200 < enough < 100 * path.stat().st_size
