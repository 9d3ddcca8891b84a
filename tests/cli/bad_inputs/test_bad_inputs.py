"""Bad inputs as users make them: each ends in a named error with exit code 2, whatever it is.

What is tried stands in table.py, and in a module for each kind; how, in forked.py.
"""

from __future__ import annotations

import fcntl
import json
import os
import subprocess
import sys
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

from tests.cli.bad_inputs import forked, records
from tests.cli.bad_inputs.table import KINDS

FLAGS = {"": (), "-O": ("-O",)}

MOST_LINES = 3

LONGEST = 600
"""Characters of a line that is still one to be read."""

ALL = [(kind, case) for kind, cases in KINDS.items() for case in cases]

TRIED = [
    pytest.param(
        flag,
        number % 2,
        case,
        id=f"{kind}: {case.name}{flag and ', '}{flag}",
        marks=pytest.mark.soak if number % 2 != turn else pytest.mark.slow if flag else (),
    )
    for turn, flag in enumerate(FLAGS)
    for number, (kind, case) in enumerate(ALL)
]
"""Each input is tried once, every second one under -O (slow); as soak, the other way round."""


@pytest.fixture(scope="session")
def outcome(tmp_path_factory):
    """Say what became of an input, by flag, part and name; a session's processes share it."""
    shared = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        shared = shared.parent

    @cache
    def outcomes(flag: str, part: int) -> dict:
        return _tried(shared / f"bad_inputs{flag}{part}", flag, part)

    return lambda flag, part, name: outcomes(flag, part)[name]


def _tried(folder: Path, flag: str, part: int) -> dict:
    """Try one half of all inputs, unless another process of this session has or does."""
    folder.mkdir(exist_ok=True)
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "done").exists():
            records.save(folder)
            done = subprocess.run(
                [sys.executable, "-P", *FLAGS[flag], forked.__file__, str(folder), str(part)],
                env=os.environ | {records.RECORDS: str(folder)},
                capture_output=True,
                text=True,
                check=False,
            )
            assert done.returncode == 0, done.stderr
            (folder / "done").touch()
    lines = (folder / "outcomes").read_text(encoding="utf-8").splitlines()
    return {each["name"]: each for each in map(json.loads, lines)}


@pytest.mark.parametrize(("flag", "part", "case"), TRIED)
def test_a_bad_input_is_a_named_error_with_exit_code_2(outcome, flag, part, case):
    became = outcome(flag, part, case.name)
    said = became["stderr"]
    assert became["code"] == 2, (became["code"], said[-2000:], became["stdout"][-500:])
    assert "Traceback" not in said + became["stdout"], said
    lines = said.splitlines()
    assert 1 <= len(lines) <= MOST_LINES, said
    if case.command.startswith("mars2d"):
        assert all(line.startswith("mars2d: ") for line in lines), said
    assert max(map(len, lines)) <= LONGEST, said
    assert said.replace("\n", "").isprintable(), repr(said)
    for word in case.words:
        assert word in said, (word, said)


def test_more_than_500_inputs_are_tried_at_least_20_of_each_of_nine_kinds():
    names = [case.name for _, case in ALL]
    assert len({*names}) == len(names) > 500, Counter(names).most_common(1)
    assert len(KINDS) == 9
    assert [kind for kind, cases in KINDS.items() if len(cases) < 20] == []
