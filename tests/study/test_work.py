"""Many tasks: each comes once, whatever becomes of it and of the process that does it."""

from __future__ import annotations

import os
import pickle
import sys
import threading
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context

import pytest

from mars2d.core.errors import InputError
from mars2d.study.work import Failure, each_done, worker_count
from tests.processes import running, wait_until

TASKS = '''
"""What the workers of these tests do."""

import os
import signal
import sys
import time
from pathlib import Path


def do(task):
    kind, value = task
    return globals()[kind](value)


def square(x):
    return x * x


def threads(_):
    return os.environ["OPENBLAS_NUM_THREADS"]


def fails(x):
    raise ValueError(f"no\\n{x}")


def leaves(code):
    sys.exit(code)


def ends(code):
    os._exit(code)


def is_killed(_):
    os.kill(os.getpid(), signal.SIGKILL)


def cannot_be_sent(_):
    return (k for k in range(3))


def hangs(file):
    Path(file).write_text(str(os.getpid()))
    time.sleep(1000)


def sums_for_ever(_):
    return sum(range(10**12))
'''


@pytest.fixture(scope="module")
def do(tmp_path_factory):
    """The function of these tests, in a module that other processes find."""
    folder = tmp_path_factory.mktemp("tasks")
    (folder / "tasks_of_test_work.py").write_text(TASKS)
    sys.path.insert(0, str(folder))
    import tasks_of_test_work

    yield tasks_of_test_work.do
    sys.path.remove(str(folder))


def pid_in(file) -> int:
    wait_until(lambda: file.exists() and file.read_text())
    return int(file.read_text())


class Counted(Sequence):
    """Tasks that are made when they are asked for, and counted."""

    def __init__(self, length):
        self.length, self.asked = length, 0

    def __len__(self):
        return self.length

    def __getitem__(self, index):
        if index >= self.length:
            raise IndexError(index)
        self.asked += 1
        return ("square", index)


@pytest.mark.slow
def test_each_task_comes_once_whatever_becomes_of_it(do):
    odd = {
        2: ("threads", None),
        3: ("fails", "nine"),
        4: ("leaves", 3),
        5: ("ends", 7),
        6: ("is_killed", None),
        8: ("cannot_be_sent", None),
    }
    tasks = [odd.get(k, ("square", k)) for k in range(30)]
    before = dict(os.environ)
    done = list(each_done(do, tasks, workers=2))
    assert sorted(index for index, _ in done) == list(range(30))
    assert dict(os.environ) == before
    found = dict(done)
    assert {k: v for k, v in found.items() if k not in odd} == {
        k: k * k for k in range(30) if k not in odd
    }
    assert found[2] == os.environ.get("OPENBLAS_NUM_THREADS", "1")
    assert found[3] == Failure("ValueError: no nine")
    assert found[4] == Failure("SystemExit: 3")
    assert found[5] == found[6] == Failure("the process that ran it ended, twice")
    assert found[8] == Failure("TypeError: cannot pickle 'generator' object")


def test_tasks_are_made_as_they_are_needed_and_workers_end_with_the_iterator(do):
    tasks = Counted(100_000)
    done = each_done(do, tasks, workers=2)
    assert [next(done)[1] in (0, 1), next(done)[1] in (0, 1, 4)] == [True, True]
    assert tasks.asked < 10
    done.close()
    wait_until(lambda: not get_context("spawn").active_children())


def test_workers_that_are_busy_are_ended_promptly(do, tmp_path):
    file = tmp_path / "hangs"
    done = each_done(do, [("hangs", str(file)), ("square", 2)], workers=2)
    assert next(done) == (1, 4)
    pid = pid_in(file)
    done.close()
    assert not running(pid)


def test_functions_of_no_module_and_tasks_that_no_process_can_have():
    gain, tasks = 2, [3, threading.Lock()]
    done = dict(each_done(lambda x: gain * x, tasks, workers=1))
    assert done[0] == 6
    assert done[1].error.startswith("can't be sent to another process: TypeError: cannot pickle")


def test_without_a_number_there_is_a_worker_a_core():
    assert 1 <= worker_count(None) <= (os.cpu_count() or 1)
    assert worker_count(7) == 7


def test_threads_do_tasks_as_they_are_and_are_left_open():
    def law(x):
        if x == 3:
            raise KeyError("gain")
        return pickle.dumps(x)

    with ThreadPoolExecutor(2) as pool:
        done = dict(each_done(law, range(10), pool))
        assert done[3] == Failure("KeyError: 'gain'")
        assert {k: v for k, v in done.items() if k != 3} == {
            k: pickle.dumps(k) for k in range(10) if k != 3
        }
        assert pool.submit(abs, -1).result() == 1


def test_processes_of_another_pool_do_tasks_and_a_pool_that_breaks_ends_the_study(do):
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        assert dict(each_done(do, Counted(20), pool)) == {k: k * k for k in range(20)}
        with pytest.raises(InputError, match=r"takes no more tasks, or has lost them .*Broken"):
            list(each_done(do, [("ends", 1), *Counted(2000)], pool))
        with pytest.raises(InputError, match=r"takes no more tasks, or has lost them .*Broken"):
            list(each_done(do, [("square", 1)], pool))
