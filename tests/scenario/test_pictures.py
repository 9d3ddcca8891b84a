"""Pictures in records: they are inside, and no other file is opened."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import mars2d
from mars2d import InputError, Scenario
from mars2d.addons import Floor
from mars2d.output.formats import SUFFIXES
from mars2d.output.formats.header import as_text
from mars2d.scenario import save_scenario

BOUNDS = (0, 3, 0, 2)


@pytest.fixture
def scenario(tmp_path, monkeypatch) -> Scenario:
    """A floor with a picture in the current folder."""
    monkeypatch.chdir(tmp_path)
    values = np.random.default_rng(0).integers(0, 256, (4, 6, 4), dtype=np.uint8)
    Image.fromarray(values).save("a b;c.png")
    floor = Floor(image="a b;c.png", bounds=BOUNDS, color="#0000ff")
    return Scenario(addons=[floor], stop_time=0.2)


def test_a_record_holds_its_pictures(scenario) -> None:
    record = mars2d.run(scenario)
    pixels = [addon.picture for addon in scenario.addons]
    for suffix in SUFFIXES:
        record.save(f"run{suffix}")
    Path("a b;c.png").unlink()
    for suffix in SUFFIXES:
        loaded = mars2d.load(f"run{suffix}")
        assert loaded.digest == record.digest
        assert loaded.missing == ()
        for addon, before in zip(loaded.scenario.addons, pixels, strict=True):
            assert np.array_equal(addon.picture, before)
        again = mars2d.load(loaded.save(f"again{suffix}"))
        assert again.scenario == loaded.scenario


def test_a_scenario_of_a_record_is_saved_with_its_pictures(scenario) -> None:
    mars2d.run(scenario, record="run.npz")
    Path("a b;c.png").unlink()
    save_scenario(mars2d.load("run.npz").scenario, "run.toml")
    again = mars2d.run("run.toml")
    assert again.scenario.addons[0].picture.shape == (4, 6, 3)


def foreign(record: mars2d.Record, image: str) -> Path:
    """Save a record whose pictures are said to be in another file."""
    with np.load(record.save("run.npz")) as kept:
        columns = dict(kept)
    header = json.loads(columns["header"].tobytes())
    for addon in header["scenario"]["addons"]:
        addon["image"] = image
    columns["header"] = np.frombuffer(as_text(header).encode(), dtype=np.uint8)
    np.savez("foreign.npz", **columns)
    return Path("foreign.npz")


def test_a_picture_that_a_record_only_names_is_missing_though_its_file_is_there(scenario) -> None:
    loaded = mars2d.load(foreign(mars2d.run(scenario), str(Path("a b;c.png").absolute())))
    assert loaded.missing == ("picture a b;c.png of Floor",)
    with pytest.raises(InputError, match="the record does not hold this picture"):
        _ = loaded.scenario.addons[0].picture
