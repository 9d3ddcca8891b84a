"""Columns in files hold what columns in memory hold, and take no memory."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mars2d import Robot, Scenario, World
from mars2d.record.columns import BLOCK, Column, Scratch, Texts, blocks
from mars2d.record.message import MESSAGE
from tests.cases import each_case


@pytest.fixture(params=["memory", "files"])
def storage(request, tmp_path):
    return Column if request.param == "memory" else Scratch(tmp_path)


@each_case("shape", [(), (3, 7), (2, 0)])
def test_a_column_holds_what_was_written(storage, shape) -> None:
    column = storage(shape, float, 10)
    values = np.random.default_rng(1).random((60_000, *shape))
    for k in range(1000):
        column.write(k, values[k])
    early = column.upto(500)
    column.write_block(1000, values[1000:])
    np.testing.assert_array_equal(column.upto(len(values)), values)
    np.testing.assert_array_equal(early, values[:500])
    with pytest.raises(ValueError, match="read-only"):
        early[:] = 0


def test_blocks_of_a_file_leave_the_memory_again(tmp_path, monkeypatch) -> None:
    left = []
    monkeypatch.setattr("mars2d.record.columns._let_go", left.append)
    for kind in (float, MESSAGE):
        column = Scratch(tmp_path)((), kind, 10)
        column.write_block(0, np.zeros(400_000, kind))
        left.clear()
        count = sum(1 for _ in blocks(column.upto(400_000)))
        assert len(left) == count > 1


def test_blocks_are_all_of_an_array(storage) -> None:
    column = storage((5,), float, 10)
    column.write_block(0, np.arange(500_000.0).reshape(-1, 5))
    whole = column.upto(100_000)
    parts = [part.copy() for part in blocks(whole)]
    assert len(parts) > 1
    assert max(part.nbytes for part in parts) <= BLOCK
    np.testing.assert_array_equal(np.concatenate(parts), whole)


def test_texts_are_what_was_appended(storage) -> None:
    told = [f"{k} ünï" * (k % 3) for k in range(2000)]
    texts = Texts(storage)
    for text in told[:1500]:
        texts.append(text)
    early = texts.snapshot()
    for text in told[1500:]:
        texts.append(text)
    assert texts == tuple(told)
    assert early == told[:1500]
    assert (texts[7], texts[-1], early[2:5]) == (told[7], told[-1], tuple(told[2:5]))
    with pytest.raises(IndexError):
        early[1500]


def test_a_world_records_the_same_in_files_as_in_memory(tmp_path) -> None:
    scenario = Scenario(robots=[Robot(pose=(-1, 0, 0)), Robot(pose=(1, 0, 3))], stop_time=30)
    digests = set()
    for storage in (Column, Scratch(Path(tmp_path))):
        world = World(scenario, storage=storage)
        early = None
        while not world.over:
            world.step([[0.3, 0.3], [0.0, 0.1]])
            early = early or world.record
        assert len(early) == 1
        digests.add((world.record.digest, early.digest, len(world.record.contacts)))
    assert len(digests) == 1
