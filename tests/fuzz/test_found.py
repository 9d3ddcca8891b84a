"""Files that once broke a reader, found by `readers.py` or by hand: each is read, or refused."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.fuzz.readers import KINDS

FOUND = sorted((Path(__file__).parent / "found").iterdir())

READ = """
import importlib.util, json, os, resource, sys
import mars2d, mars2d.addons.maps.svg, svgelements

spec = importlib.util.spec_from_file_location("readers", sys.argv[1])
readers = importlib.util.module_from_spec(spec)
spec.loader.exec_module(readers)
told = {}
for path in map(readers.Path, sys.argv[2:]):
    process = os.fork()
    if process == 0:
        code = 1
        resource.setrlimit(resource.RLIMIT_CPU, (5, 6))
        resource.setrlimit(resource.RLIMIT_AS, (2**31, 2**31))
        try:
            readers.read(path)
            code = 0
        except mars2d.InputError as error:
            code = 1 if "\\n" in str(error) else 0
        finally:
            os._exit(code)
    told[path.name] = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
print(json.dumps(told))
"""


def test_each_file_is_read_or_refused_in_one_line_within_seconds_and_two_gigabytes(child) -> None:
    pytest.importorskip("resource", reason="limits are those of Linux and macOS")
    arguments = ["", str(Path(__file__).with_name("readers.py")), *map(str, FOUND)]
    done = child(f"import sys; sys.argv = {arguments!r}\n{READ}", timeout=300)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == {path.name: 0 for path in FOUND}


def test_files_end_with_their_kind_and_are_small() -> None:
    assert len(FOUND) >= 1
    for path in FOUND:
        assert path.suffix[1:] in KINDS, path
        assert path.stat().st_size <= 200_000, path
