"""Nothing that is read runs: no code in files, and none in words."""

from __future__ import annotations

import json
import os
import pickle
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d import InputError
from mars2d.output.formats.header import as_text, of_record
from mars2d.scenario import load_scenario
from tests.cases import each_case
from tests.output.formats.records import FORMATS, everything, refused
from tests.output.formats.test_npz import _npy, _rewrite

# -- files that would like to run ------------------------------------------------------------------


class Trap:
    """Makes a folder where it is unpickled."""

    def __init__(self, marker: Path) -> None:
        self.marker = str(marker)

    def __reduce__(self):
        return os.mkdir, (self.marker,)


TRAP = "from pathlib import Path\nPath(__file__).with_name('sprung').mkdir()\n"
"""A module that does the same where it is imported."""


@pytest.fixture
def marker(tmp_path, monkeypatch) -> Iterator[Path]:
    """The folder that is made when a trap springs; at the end, none has."""
    path = tmp_path / "sprung"
    (tmp_path / "trap.py").write_text(TRAP)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.chdir(tmp_path)
    yield path
    assert not path.exists(), "what was read has run"


@each_case("suffix", [*FORMATS, ".mcap"])
def test_a_pickle_by_any_name_is_no_record(suffix, marker, tmp_path) -> None:
    for protocol in (0, 2, 5):
        (tmp_path / f"run{suffix}").write_bytes(pickle.dumps(Trap(marker), protocol))
        refused(tmp_path / f"run{suffix}")


NAMES = ["os.system", "trap:Trap", "trap"]


@each_case("name", NAMES)
def test_a_record_names_no_code(name, marker, tmp_path) -> None:
    """Neither as the type of a part, nor of a part of the user's own, nor as a function."""
    text, good = as_text(of_record(everything())), everything().save(tmp_path / "good.npz")
    places = ([], ["robots", 0], ["robots", 0, "drive"], ["robots", 0, "sensors", 0], ["addons", 0])
    for place in places:
        for change in (
            {"type": name},
            {"type": name, "own": "sensor"},
            {"type": "Robot", "controller": name, "shape": {"type": name}},
        ):
            header = json.loads(text)
            part = header["scenario"]
            for step in place:
                part = part[step]
            part.update(change)
            path = tmp_path / "run.npz"
            _rewrite(
                good, path, {"header.npy": _npy(np.frombuffer(as_text(header).encode(), np.uint8))}
            )
            try:
                record = mars2d.load(path)
            except InputError as error:
                assert "\n" not in str(error)  # noqa: PT017
            else:
                assert record.scenario.robots[0].controller is None


@each_case("name", NAMES)
@each_case(
    "scene",
    [
        'type = "NAME"\n[[robots]]',
        '[[robots]]\ntype = "NAME"',
        '[[robots]]\ndrive = "NAME"',
        '[[robots]]\nsensors = ["NAME"]',
        '[[robots]]\nshape = { type = "NAME" }',
        '[[robots]]\n[[addons]]\ntype = "NAME"',
        '[[robots]]\n[[props]]\ntype = "NAME"',
        '[[robots]]\nname = { type = "NAME" }',
        'neighbours = "NAME"\n[[robots]]',
        'control = "NAME"\n[[robots]]',
        '[[robots]]\ncontroller = "NAME"',
    ],
)
def test_a_scenario_file_names_no_code_but_that_of_laws(scene, name, marker, tmp_path) -> None:
    (tmp_path / "scene.toml").write_text("format = 1\n" + scene.replace("NAME", name))
    with pytest.raises(InputError) as caught:
        load_scenario(tmp_path / "scene.toml")
    assert "\n" not in str(caught.value)
