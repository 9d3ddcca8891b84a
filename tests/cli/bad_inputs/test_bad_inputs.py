"""Bad inputs as users make them: each ends in a named error with exit code 2, whatever it is.

What is tried stands in a module for each kind.
"""

from __future__ import annotations

import runpy
import shlex
import sys
from pathlib import Path

import pytest

from mars2d.cli.command_line import main
from tests.cases import each_case
from tests.cli.bad_inputs import files, maps, options, records

KINDS = (options, files, records, maps)

MOST_LINES = 3

LONGEST = 600
"""Characters of a line that is still one to be read."""


@pytest.fixture(autouse=True)
def sound_records(tmp_path_factory, monkeypatch):
    folder = tmp_path_factory.mktemp("records")
    records.save(folder)
    monkeypatch.setenv(records.RECORDS, str(folder))
    monkeypatch.delenv("DISPLAY", raising=False)


def exit_code(command: str) -> int:
    """Do what a user types in the current folder, and return the exit code."""
    program, *arguments = shlex.split(command)
    try:
        if program == "mars2d":
            return main(arguments)
        runpy.run_path(arguments[0], run_name="__main__")
    except SystemExit as leaving:
        return leaving.code
    return 0


@each_case("case", [case for kind in KINDS for case in kind.CASES])
def test_a_bad_input_is_a_named_error_with_exit_code_2(tmp_path, monkeypatch, capsys, case):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    for name, content in case.files.items():
        if content is None:
            Path(name).mkdir(parents=True)
            continue
        data = content() if callable(content) else content
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).write_bytes(data.encode() if isinstance(data, str) else data)
    code = exit_code(case.command)
    out, err = capsys.readouterr()
    lines = err.splitlines()
    assert code == 2, err
    assert "Traceback" not in out + err
    assert 1 <= len(lines) <= MOST_LINES, err
    assert max(map(len, lines)) <= LONGEST, err
    assert err.replace("\n", "").isprintable(), err
    assert [word for word in case.words if word not in err] == [], err
    if case.command.startswith("mars2d"):
        assert all(line.startswith("mars2d: ") for line in lines), err
