"""Bad inputs as users make them: each ends in a named error with exit code 2, whatever it is.

What is tried stands in table.py, and in a module for each kind; how, in forked.py.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from tests.cli.bad_inputs import forked, records
from tests.cli.bad_inputs.table import KINDS

MOST_LINES = 3

LONGEST = 600
"""Characters of a line that is still one to be read."""

ALL = [(kind, case) for kind, cases in KINDS.items() for case in cases]


def tried(folder: Path, part: str) -> dict[str, dict]:
    """Try a part of all inputs, and return what became of each."""
    records.save(folder)
    done = subprocess.run(
        [sys.executable, "-P", forked.__file__, str(folder), part],
        env=os.environ | {records.RECORDS: str(folder)}, capture_output=True,
        text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    lines = (folder / "outcomes").read_text(encoding="utf-8").splitlines()
    return {each["name"]: each for each in map(json.loads, lines)}


def faults(case, became: dict) -> list[str]:
    """What is wrong with what became of an input."""
    said, lines = became["stderr"], became["stderr"].splitlines()
    wrong = {
        f"exit code {became['code']}": became["code"] != 2,
        "a traceback": "Traceback" in said + became["stdout"],
        f"{len(lines)} lines": not 1 <= len(lines) <= MOST_LINES,
        "a line too long": max(map(len, lines), default=0) > LONGEST,
        "unprintable": not said.replace("\n", "").isprintable(),
    } | {f"no {word!r}": word not in said for word in case.words}
    if case.command.startswith("mars2d"):
        wrong["who speaks"] = not all(line.startswith("mars2d: ") for line in lines)
    return [f"{case.name}: {what}\n{said[-2000:]}" for what, is_so in wrong.items() if is_so]


@pytest.mark.parametrize("part", ["third", pytest.param("rest", marks=pytest.mark.nightly)])
def test_a_bad_input_is_a_named_error_with_exit_code_2(tmp_path, part):
    became = tried(tmp_path, part)
    assert len(became) > 150
    every = [case for _, case in ALL if case.name in became]
    assert [fault for case in every for fault in faults(case, became[case.name])] == []


def test_more_than_500_inputs_are_tried_at_least_20_of_each_of_nine_kinds():
    names = [case.name for _, case in ALL]
    assert len({*names}) == len(names) > 500, Counter(names).most_common(1)
    assert len(KINDS) == 9
    assert [kind for kind, cases in KINDS.items() if len(cases) < 20] == []
