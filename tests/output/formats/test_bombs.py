"""Files that claim or hold more than is read: they are refused before memory is taken."""

from __future__ import annotations

import io
import json
import struct
import subprocess
import sys
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from mars2d.output.formats.header import as_text
from tests.output.formats.records import FORMATS, everything, refused

MB = 10**6

ROOM = 100 * MB
"""How much memory there is for reading, beside what an interpreter takes that has read a file."""

READER = """
import resource, sys
import mars2d
for good in sys.argv[2:]:
    mars2d.load(good)
size = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (size + int(sys.argv[1]),) * 2)
print("ready", flush=True)
for line in sys.stdin:
    largest, path = line.rstrip().split(" ", 1)
    try:
        mars2d.load(path, float(largest))
    except mars2d.InputError as error:
        print(error, flush=True)
    else:
        print("read", flush=True)
"""


@pytest.fixture(scope="module")
def said(tmp_path_factory) -> Iterator[Callable[..., str]]:
    """Say of a file what an interpreter says of it that has little memory left to read it."""
    if not Path("/proc/self/statm").exists():
        pytest.skip("memory is limited by Linux here")
    folder = tmp_path_factory.mktemp("good")
    good = [str(everything().save(folder / f"run{suffix}")) for suffix in FORMATS]
    command = [sys.executable, "-c", READER, str(ROOM), *good]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True, bufsize=1) as reader:
        assert reader.stdout.readline() == "ready\n"

        def ask(path: Path, largest: float = 2**31) -> str:
            reader.stdin.write(f"{largest} {path}\n")
            answer = reader.stdout.readline().strip()
            assert answer.startswith(str(path))
            assert "not enough memory" not in answer
            return answer

        yield ask
        reader.stdin.close()


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_file_larger_than_asked_for_is_refused(suffix, tmp_path):
    path = everything().save(tmp_path / f"run{suffix}")
    text = refused(path, "holds, or claims to hold, .* more than the 2 kB", largest=2000)
    enough = float(text.split("largest=")[1].rstrip(")"))
    assert 2000 < enough < 100 * path.stat().st_size


# -- npz ------------------------------------------------------------------------------------


def _npz(path: Path, changes: dict[str, bytes], **options) -> Path:
    """Write a good file with some members exchanged."""
    good = everything().save(path.with_name("good.npz"))
    with zipfile.ZipFile(good) as old, zipfile.ZipFile(path, "w", **options) as new:
        for name in old.namelist():
            new.writestr(name, changes.get(name, old.read(name)))
    return path


def _npy(shape: object, data: bytes = b"", dtype: str = "<f8") -> bytes:
    file = io.BytesIO()
    described = {"descr": dtype, "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(file, described)
    return file.getvalue() + data


@pytest.mark.slow
def test_a_small_npz_with_a_huge_member_is_refused(tmp_path, said):
    zeros = _npy((20 * MB,), bytes(160 * MB))
    path = _npz(tmp_path / "bomb.npz", {"pose.npy": zeros}, compression=zipfile.ZIP_DEFLATED)
    assert path.stat().st_size < 1 * MB
    assert "holds, or claims to hold, 160 MB of data" in said(path, 150 * MB)


@pytest.mark.slow
def test_an_npz_with_a_huge_header_is_refused(tmp_path, said):
    text = b"[" + b"{}," * (40 * MB) + b"{}]"
    header = {"header.npy": _npy((len(text),), text, "|u1")}
    path = _npz(tmp_path / "bomb.npz", header, compression=zipfile.ZIP_DEFLATED)
    assert "claims to hold 1.9 GB of data" in said(path, 150 * MB).replace(",", "")


@pytest.mark.parametrize(
    ("shape", "dtype"),
    [((10**15,), "<f8"), ((-1, -8), "<f8"), ((10**30, 0), "<f8"), ((1,), "|V99999999999"),
     ((2**62, 2**62), "<f8"), ((), "|O")],
)  # fmt: skip
def test_an_array_that_claims_to_be_huge_is_refused(shape, dtype, tmp_path, said):
    path = _npz(tmp_path / "bomb.npz", {"pose.npy": _npy(shape, bytes(64), dtype)})
    assert "not a record of MARS2D, or damaged" in said(path)


@pytest.mark.parametrize("size", [0, 5, 10**9, 2**32 - 2])
def test_an_npz_that_lies_about_a_members_size_is_refused(size, tmp_path, said):
    path = _npz(tmp_path / "bomb.npz", {})
    content = path.read_bytes()
    place = content.rfind(b"pose.npy", 0, content.rfind(b"prop_pose.npy")) - 46  # its entry
    assert content[place : place + 4] == b"PK\x01\x02"
    lie = content[: place + 24] + struct.pack("<I", size) + content[place + 28 :]
    path.write_bytes(lie)
    assert "damaged" in said(path) or "claims to hold" in said(path)


def test_an_encrypted_npz_is_refused(tmp_path, said):
    content = bytearray(_npz(tmp_path / "bomb.npz", {}).read_bytes())
    for magic, flags in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        at = content.find(magic)
        while at >= 0:
            content[at + flags] |= 1
            at = content.find(magic, at + 1)
    (tmp_path / "bomb.npz").write_bytes(content)
    assert "not a record of MARS2D, or damaged" in said(tmp_path / "bomb.npz")


def test_an_npz_of_another_compression_is_refused(tmp_path):
    path = _npz(tmp_path / "odd.npz", {}, compression=zipfile.ZIP_LZMA)
    refused(path, "not a record of MARS2D, or damaged")


def test_an_npz_of_very_many_members_is_refused(tmp_path, said):
    entry = struct.pack("<4s4B4HL2L5H2L", b"PK\1\2", 20, 0, 20, *(0,) * 8, 1, *(0,) * 6) + b"a"
    count = 60_000
    end = struct.pack("<4s4H2LH", b"PK\5\6", 0, 0, count, count, len(entry) * count, 0, 0)
    (tmp_path / "many.npz").write_bytes(entry * count + end)
    assert "not a record of MARS2D, or damaged" in said(tmp_path / "many.npz")


def test_members_of_one_name_are_one_member(tmp_path):
    path = everything().save(tmp_path / "run.npz")
    with (
        pytest.warns(UserWarning, match="Duplicate name"),
        zipfile.ZipFile(path, "a") as file,
    ):
        file.writestr("pose.npy", _npy((1,), bytes(8)))
    refused(path, "damaged")


# -- csv ------------------------------------------------------------------------------------


def test_a_csv_with_a_huge_cell_is_refused(tmp_path):
    path = tmp_path / "bomb.csv"
    path.write_text("time,body,x,record\n0,robot0,0," + "9" * 200_000)
    refused(path, "not a record of MARS2D, or damaged")


@pytest.mark.parametrize(
    "shapes",
    [
        {"time": [10**15], "pose": [10**15, 3, 3]},
        {"pose": [0, 3, 10**12]},
        {"sensor:x": [0, 1, 10**12]},
        {"sensor:x": [2, 1, -(10**12)], "pose": [2, 3, 10**12]},
        {"effort": [10**9, 10**9], "command": [-(10**9), 10**9]},
    ],
)
def test_a_csv_whose_header_claims_many_values_is_refused(shapes, tmp_path, said):
    path = everything().save(tmp_path / "run.csv")
    import pandas as pd

    table = pd.read_csv(path, dtype=str, keep_default_na=False)
    header = json.loads("".join(table["record"]))
    for name, shape in shapes.items():
        header["columns"][name][1] = shape
    text = as_text(header)
    table["record"] = [text[i * 30000 :][:30000] for i in range(len(table))]
    table.to_csv(path, index=False)
    assert "not a record of MARS2D, or damaged" in said(path)
