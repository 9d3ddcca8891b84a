"""``.npz``: what is in it, and what is not taken for it."""

from __future__ import annotations

import io
import json
import zipfile

import numpy as np
import pytest

import mars2d
from tests.output.formats.records import everything, refused


@pytest.fixture
def record() -> mars2d.Record:
    return everything()


def test_it_holds_arrays_that_numpy_opens(record, tmp_path):
    with np.load(record.save(tmp_path / "run.npz")) as data:
        assert np.array_equal(data["pose"], record.pose)
        assert np.array_equal(data["contact:impulse"], record.contacts["impulse"])
        assert data["sensor:größe"].dtype == bool
        assert json.loads(data["header"].tobytes())["digest"] == record.digest


def test_pickled_objects_are_never_loaded(record, tmp_path):
    class Trap:
        def __reduce__(self):
            return pytest.fail, ("it was unpickled",)

    path = tmp_path / "trap.npz"
    np.savez(path, header=np.array([Trap()], dtype=object))
    refused(path, "not a record")
    good = record.save(tmp_path / "good.npz")
    _rewrite(good, path, {"sensor:x.npy": _npy(np.array([Trap()], dtype=object))})
    refused(path, "not a record")


def _npy(array: np.ndarray) -> bytes:
    buffer = io.BytesIO()
    np.lib.format.write_array(buffer, array, allow_pickle=True)
    return buffer.getvalue()


def _rewrite(source, target, changes: dict[str, bytes | None]) -> None:
    """Copy a file with some of its parts exchanged, or left out."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for name in {*old.namelist(), *changes}:
            content = changes.get(name, old.read(name) if name in old.namelist() else None)
            if content is not None:
                new.writestr(name, content)


def test_a_file_whose_columns_were_changed_is_refused(record, tmp_path):
    good = record.save(tmp_path / "good.npz")
    _rewrite(good, tmp_path / "bad.npz", {"pose.npy": _npy(record.pose + 1e-12)})
    refused(tmp_path / "bad.npz", "do not have the digest that it states")
    _rewrite(good, tmp_path / "bad.npz", {"effort.npy": _npy(record.effort + 1e-12)})
    refused(tmp_path / "bad.npz", "do not have the digest that it states")
    _rewrite(good, tmp_path / "bad.npz", {"prop_pose.npy": _npy(record.prop_pose[:, :, :1])})
    refused(tmp_path / "bad.npz", "damaged")
    _rewrite(good, tmp_path / "bad.npz", {"contact:a.npy": _npy(np.zeros((3, 3)))})
    refused(tmp_path / "bad.npz", "damaged")
