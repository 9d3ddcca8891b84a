"""Many tasks: each comes once, whatever becomes of it and of the process that does it."""

from __future__ import annotations

import os
import pickle
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context

import pytest

from mars2d.core.errors import InputError
from mars2d.study import work, workers
from mars2d.study.work import Failure, each_done, worker_count
from tests.cases import each_case
from tests.processes import PATIENCE, running, wait_until

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


class Unreadable:
    def __reduce__(self):
        return int, ("no number",)


def cannot_be_read(_):
    return Unreadable()


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
        9: ("cannot_be_read", None),
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
    assert "can't be sent back: TypeError: cannot pickle 'generator' object" in found[8].error
    assert found[9].error.startswith("what it returned can't be read: ValueError")


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


def test_a_task_in_c_code_is_ended_some_seconds_after_its_limit(do, monkeypatch):
    monkeypatch.setattr(workers, "BREAKING_OFF", 0.0)
    done = dict(each_done(do, [("sums_for_ever", 0), ("square", 3)], workers=1, limit=0.5))
    assert done[1] == 9
    assert "perhaps in code in C at the time limit of 0.5 s" in done[0].error


SCRIPT = """
import sys
from tasks_of_test_work import do
from mars2d.study.work import each_done

if __name__ == "__main__":
    try:
        list(each_done(do, [("hangs", file) for file in sys.argv[1:]], workers=2))
    except KeyboardInterrupt:
        print("interrupted")
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@each_case("number", [signal.SIGINT, signal.SIGKILL])
def test_no_process_outlives_the_one_that_started_it(do, tmp_path, number):
    script, files = tmp_path / "study.py", [tmp_path / "a", tmp_path / "b"]
    script.write_text(SCRIPT)
    parent = subprocess.Popen(
        [sys.executable, str(script), *map(str, files)],
        env=os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    pids = [pid_in(file) for file in files]
    if number == signal.SIGINT:
        os.killpg(parent.pid, number)  # as a terminal does: to all of them
    else:
        parent.kill()
    out, err = parent.communicate(timeout=PATIENCE)
    if number == signal.SIGINT:
        assert (out, err) == ("interrupted\n", "")
    wait_until(lambda: not any(map(running, pids)))


@each_case(
    "script, said",
    [
        (
            "",
            'put what runs many runs under `if __name__ == "__main__":`',
        ),
        (
            "if __name__ != '__main__': raise SystemExit(5)",
            "a worker process ended before it had begun",
        ),
    ],
)
def test_a_script_that_its_workers_cannot_import_is_told_so_once(tmp_path, script, said):
    path = tmp_path / "study.py"
    path.write_text(
        f"from mars2d.study.work import each_done\n{script}\n"
        "print(list(each_done(abs, [1, -2, 3], workers=1)))\n"
    )
    done = subprocess.run(
        [sys.executable, str(path)], capture_output=True, text=True, timeout=PATIENCE, check=False
    )
    assert said in done.stderr.splitlines()[-1]
    assert (done.returncode, done.stdout, done.stderr.count("Traceback")) == (1, "", 1)


def test_what_cannot_be_sent_to_a_process_is_refused(do):
    for function, tasks in ((lambda x: x, [1]), (do, [threading.Lock()])):
        with pytest.raises(InputError, match=r"can't be sent to another process .*ThreadPool"):
            list(each_done(function, tasks, workers=1))


def test_a_function_that_workers_do_not_find_is_an_error_and_no_row_of_failures(do, monkeypatch):
    module = sys.modules[do.__module__]
    monkeypatch.setattr(module, "new", lambda x: x, raising=False)
    module.new.__qualname__, module.new.__module__ = "new", module.__name__
    with pytest.raises(InputError, match=r"a worker process does not find the function .*'new'"):
        list(each_done(module.new, [1, 2], workers=1))


@each_case("workers", [0, -1, 1001, 2.0, "2", True])
def test_a_number_of_workers_that_cannot_be_is_refused_at_once(workers):
    with pytest.raises(InputError, match=re.escape(f"workers={workers!r}: expected a whole num")):
        each_done(abs, [1], workers=workers)


def test_without_a_number_there_is_a_worker_a_core():
    assert 1 <= worker_count(None) <= (os.cpu_count() or 1)
    assert worker_count(7) == 7


def test_no_tasks_start_no_process():
    assert list(each_done(abs, [], workers=1000)) == []


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


def test_an_executor_holds_a_part_of_the_tasks_and_what_waits_is_cancelled(monkeypatch):
    monkeypatch.setattr(work, "IN_FLIGHT", 8)
    begun, go = [], threading.Event()

    def law(task):
        begun.append(task)
        return go.wait(20) if len(begun) > 1 else True

    with ThreadPoolExecutor(1) as pool:
        tasks = Counted(100_000)
        done = each_done(law, tasks, pool)
        assert next(done) == (0, True)
        assert tasks.asked == 8
        done.close()
        go.set()
    assert len(begun) <= 2


def test_processes_of_another_pool_do_tasks_and_a_pool_that_breaks_ends_the_study(do):
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        assert dict(each_done(do, Counted(20), pool)) == {k: k * k for k in range(20)}
        with pytest.raises(InputError, match=r"takes no more tasks, or has lost them .*Broken"):
            list(each_done(do, [("ends", 1), *Counted(2000)], pool))
        with pytest.raises(InputError, match=r"takes no more tasks, or has lost them .*Broken"):
            list(each_done(do, [("square", 1)], pool))


def test_an_executor_that_is_shut_down_or_none_is_refused():
    pool = ThreadPoolExecutor(1)
    pool.shutdown()
    with pytest.raises(InputError, match=r"takes no more tasks.* after shutdown"):
        list(each_done(abs, [1], pool))
    with pytest.raises(InputError, match=r"executor=4: expected an Executor of concurrent.futures"):
        each_done(abs, [1], 4)
