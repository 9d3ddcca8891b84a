"""kill -9 while something is saved: what was there before stays whole."""

from __future__ import annotations

import sys

import pytest

import mars2d

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX"),
]

DYING = """
import os, signal, sys
import mars2d
from pathlib import Path

record = mars2d.load("run.npz")

class Dying:
    "A file that kills its process once so many bytes were written."
    def __init__(self, file, most):
        self.file, self.left = file, most
    def __getattr__(self, name):
        return getattr(self.file, name)
    def write(self, data):
        data = memoryview(data).cast("B")
        part = data[:max(0, self.left)]
        self.left -= len(data)
        self.file.write(part)
        if self.left <= 0:
            self.file.flush()
            os.kill(os.getpid(), signal.SIGKILL)
        return len(data)

opened = Path.open
def dying(self, *words, **more):
    file = opened(self, *words, **more)
    return Dying(file, MOST) if self.is_relative_to("/proc/self/fd") else file
Path.open = dying

Dying.__enter__ = lambda self: self
Dying.__exit__ = lambda self, *error: self.file.close()
for most in (1, 1000, 3000):
    pid = os.fork()
    if pid == 0:
        MOST = most
        record.save(sys.argv[1])
        os._exit(0)
    _, status = os.waitpid(pid, 0)
    assert os.waitstatus_to_exitcode(status) == -signal.SIGKILL, (most, status)
    print(Path(sys.argv[1]).read_text())
"""


def test_a_file_that_is_being_replaced_stays_as_it_was(tmp_path, child) -> None:
    record = mars2d.run("random_walk", stop_time=200)
    record.save(tmp_path / "run.npz")
    target = tmp_path / "kept.npz"
    target.write_text("older")
    begin = f"import os, sys; os.chdir({str(tmp_path)!r}); sys.argv[1:] = [{target.name!r}]\n"
    done = child(begin + DYING)
    assert done.stdout == "older\n" * 3, done.stderr
    # Nothing of the part is left, and a file is written as ever.
    assert mars2d.load(record.save(target)).digest == record.digest
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted({"run.npz", target.name})
