"""Files that claim or hold more than is read: they are refused before memory is taken."""

from __future__ import annotations

import io
import json
import struct
import subprocess
import sys
import zipfile
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from mars2d.output.formats.header import FORMAT, as_text, names_in
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


# -- mat ------------------------------------------------------------------------------------

HEAD = b"MATLAB 5.0".ljust(124) + b"\x00\x01IM"


def _element(kind: int, data: bytes, size: int | None = None) -> bytes:
    return struct.pack("<II", kind, len(data) if size is None else size) + data


def _matrix(class_: int, shape: list[int], *parts: bytes) -> bytes:
    """Return an array called out_data."""
    flags = _element(6, struct.pack("<II", class_, 0))
    dims = struct.pack(f"<{len(shape)}i", *shape)
    dims = _element(5, dims.ljust(-len(dims) % 8 + len(dims), b"\0"), len(dims))
    return _element(14, flags + dims + _element(1, b"out_data") + b"".join(parts))


@pytest.mark.parametrize("size", [2**32 - 1, 150 * MB])
def test_a_mat_that_claims_to_inflate_to_much_is_refused(size, tmp_path, said):
    path = tmp_path / "bomb.mat"
    data = zlib.compress(struct.pack("<II", 14, size))
    path.write_bytes(HEAD + _element(15, data))
    assert "holds, or claims to hold" in said(path, 140 * MB)
    assert "damaged" in said(path, 2**33)


@pytest.mark.parametrize("size", [0, 100_000])
def test_a_mat_that_inflates_to_more_than_it_claims_is_refused(size, tmp_path, said):
    path = tmp_path / "bomb.mat"
    data = zlib.compress(struct.pack("<II", 14, size) + bytes(120 * MB), level=1)
    assert len(data) < MB
    path.write_bytes(HEAD + _element(15, data))
    assert "not a record of MARS2D, or damaged" in said(path)


@pytest.mark.parametrize("class_", [1, 2, 3, 4, 5, 6, 9, 16])
@pytest.mark.parametrize(
    "shape", [[2**31 - 1, 2**31 - 1], [10**9, 1], [-1, 1], [], [1] * 1000, [1, 1]]
)
def test_an_array_in_a_mat_that_claims_to_be_huge_is_refused(class_, shape, tmp_path):
    path = tmp_path / "bomb.mat"
    path.write_bytes(HEAD + _matrix(class_, shape, _element(9, bytes(64))))
    refused(path, "damaged|holds no struct")


def test_a_mat_of_structs_in_structs_in_structs_is_refused(tmp_path, said):
    data = _matrix(6, [1, 1], _element(9, bytes(8)))
    names = struct.pack("<HHi", 5, 4, 8) + _element(1, b"a".ljust(8, b"\0"))
    for _ in range(3000):
        data = _matrix(2, [1, 1], names, data)
    (tmp_path / "deep.mat").write_bytes(HEAD + data)
    assert "not a record of MARS2D, or damaged" in said(tmp_path / "deep.mat")


def test_other_kinds_of_matlab_files_are_refused_in_words(tmp_path):
    path = tmp_path / "other.mat"
    path.write_bytes(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(512, b"\0"))
    refused(path, "a Matlab file of version 7.3; expected one of 'save -v7'")
    path.write_bytes(b"# Created by Octave 7.3.0, Mon\n# name: out_data\n")
    refused(path, "a file of Octave's own format; expected one of 'save -v7'")
    savemat(path, {"pose": np.zeros(3), "out": {"data": 1}})
    refused(path, "holds no struct 'out_data', as records of MARS2D do")
    savemat(path, {"out_data": {"data": 1}})
    refused(path, "not a record of MARS2D, or damaged")


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


# -- netCDF ---------------------------------------------------------------------------------


def _text(text: str) -> bytes:
    data = text.encode()
    return struct.pack(">I", len(data)) + data + bytes(-len(data) % 4)


def _netcdf(sizes: list[int], names: list[str], attribute: bytes = b"") -> bytes:
    dims = b"".join(_text(f"d{k}") + struct.pack(">I", size) for k, size in enumerate(sizes))
    named = struct.pack(">II", 12, 1) + attribute if attribute else bytes(8)
    each = [
        _text(name) + struct.pack(">I", len(sizes))
        + b"".join(struct.pack(">I", d) for d in range(len(sizes)))
        + bytes(8) + struct.pack(">IIQ", 6, 0, 4)
        for name in names
    ]  # fmt: skip
    head = b"CDF\x02" + bytes(4) + struct.pack(">II", 10, len(sizes)) + dims + named
    return head + struct.pack(">II", 11, len(names)) + b"".join(each)


@pytest.mark.parametrize(
    "content",
    [
        _netcdf([2**31, 2**31], ["pose"]),
        _netcdf([10**9], ["pose"]),
        _netcdf([2**32 - 1] * 500, ["pose"]),
        _netcdf([4], ["pose"] * 20_000),
        _netcdf([1], ["pose"], _text("mars2d") + struct.pack(">II", 2, 2**32 - 1)),
        _netcdf([1], ["pose"], struct.pack(">I", 2**31)),
        b"CDF\x01" + bytes(4) + struct.pack(">II", 10, 2**32 - 1),
        b"CDF\x01" + bytes(4) + bytes(8) + struct.pack(">II", 12, 2**32 - 1),
        b"CDF\x01" + bytes(4) + bytes(16) + struct.pack(">II", 11, 2**32 - 1),
        b"CDF\x05" + bytes(100),
    ],
)
def test_a_netcdf_that_claims_to_be_huge_is_refused(content, tmp_path, said):
    (tmp_path / "bomb.nc").write_bytes(content)
    assert "not a record of MARS2D, or damaged" in said(tmp_path / "bomb.nc")


def test_a_netcdf_whose_variables_share_their_values_is_refused(tmp_path, said):
    """A small file of many variables could fill the memory, each a copy of the same bytes."""
    count, sensors = 100_000, [f"s{k}" for k in range(400)]
    names = names_in({"format": FORMAT, "messages": False, "sensor_robots": sensors})
    header = {
        "format": FORMAT, "versions": {}, "messages": False, "contents": [], "scenario": {},
        "sensor_robots": {name: [0] for name in sensors},
        "columns": {name: ["<f8", [count]] for name in names},
    }  # fmt: skip
    text = as_text(header)
    attribute = _text("mars2d") + struct.pack(">I", 2) + _text(text)
    variables = [name.replace(":", "_") for name in names]
    content = _netcdf([count], variables, attribute) + bytes(8 * count)
    assert len(content) < MB
    (tmp_path / "bomb.nc").write_bytes(content)
    assert "not a record of MARS2D, or damaged" in said(tmp_path / "bomb.nc")


def test_netcdf_4_is_refused_in_words(tmp_path):
    (tmp_path / "other.nc").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
    refused(tmp_path / "other.nc", "netCDF 4 .HDF5.; expected netCDF 3: 'nccopy -k nc6' makes it")


@pytest.mark.parametrize(
    "name", ["fp", "use_mmap", "mode", "variables", "dimensions", "_dims", "_attributes", "close"]
)
def test_an_attribute_of_a_netcdf_stays_apart_from_those_of_its_reader(name, tmp_path, capfd):
    attribute = _text(name) + struct.pack(">II", 2, 0)
    (tmp_path / "bomb.nc").write_bytes(_netcdf([4], ["pose"], attribute) + bytes(100))
    refused(tmp_path / "bomb.nc", "not a record of MARS2D, or damaged")
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("start", [-1, -(2**63), 2**63 - 1, 10**6])
def test_a_variable_of_a_netcdf_that_lies_elsewhere_is_refused(start, tmp_path):
    content = _netcdf([4], ["pose"])
    (tmp_path / "bomb.nc").write_bytes(content[:-8] + struct.pack(">q", start) + bytes(100))
    refused(tmp_path / "bomb.nc", "not a record of MARS2D, or damaged")
