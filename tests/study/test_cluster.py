"""A Dask cluster of real processes does many tasks, also while these are killed."""

from __future__ import annotations

import os
import signal
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest

import mars2d
from mars2d.scenario.examples import examples
from mars2d.study.work import Failure, each_done

pytest.importorskip("distributed")

import dask
from distributed import Client, LocalCluster

pytestmark = pytest.mark.slow

TASKS = '''
"""What the workers of these tests do."""

import os
import time


def ends_at_seven(x):
    if x == 7:
        os._exit(1)
    return x * x


def pid_after_a_moment(x):
    time.sleep(0.02)
    return os.getpid()
'''

SETTINGS = {"distributed.scheduler.allowed-failures": 1}


@pytest.fixture(scope="module")
def local(tmp_path_factory):
    """Two workers, each a process with one thread."""
    folder = tmp_path_factory.mktemp("tasks")
    (folder / "tasks_of_test_cluster.py").write_text(TASKS)
    sys.path.insert(0, str(folder))
    with (
        dask.config.set(SETTINGS),
        LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0",
            silence_logs=100, local_directory=str(folder),
        ) as local,
    ):  # fmt: skip
        yield local
    sys.path.remove(str(folder))


@pytest.fixture
def tasks(local):
    import tasks_of_test_cluster

    return tasks_of_test_cluster


@pytest.fixture
def executor(local):
    with Client(local, set_as_default=False) as client:
        yield client
        client.wait_for_workers(2)  # closing while one starts again fails


@pytest.mark.nightly
def test_nothing_is_lost_or_counted_twice_where_a_worker_is_killed_half_way(executor, tasks):
    found = {}
    for index, pid in each_done(tasks.pid_after_a_moment, range(60), executor):
        assert index not in found
        found[index] = pid
        if len(found) == 20:
            killed = index
            os.kill(pid, signal.SIGKILL)
    assert sorted(found) == list(range(60))
    assert not [pid for pid in found.values() if isinstance(pid, Failure)]
    with pytest.raises(ProcessLookupError):
        os.kill(found[killed], 0)


def test_a_sweep_comes_to_the_same_bytes_by_whoever_does_it(executor, tmp_path):
    with ThreadPoolExecutor(2) as threads:
        ways = {
            "one": {"workers": 1},
            "two": {"workers": 2},
            "threads": {"executor": threads},
            "client": {"executor": executor},
            "its executor": {"executor": executor.get_executor(pure=False)},
        }
        for name, way in ways.items():
            grid = {"robots.*.diameter": [0.1, 0.2], "stop_time": 5}
            mars2d.sweep("random_walk", grid, 3, "path_length", out=tmp_path / f"{name}.csv", **way)
    tables = {name: (tmp_path / f"{name}.csv").read_text() for name in ways}
    assert tables == dict.fromkeys(ways, tables["one"])
    assert tables["one"].count("\n") == 7


def test_a_tournament_is_played_by_a_cluster(executor):
    players = sorted((examples()["sumo"].parent / "players").glob("*.py"))[:2]
    matches = mars2d.tournament(
        "sumo", players=players, seeds=1, stop_time=2, executor=executor
    ).matches
    assert [(match.steps, match.verdicts, match.error) for match in matches] == [(100, {}, "")] * 2


def test_a_task_that_ends_each_of_its_workers_is_the_one_that_fails(executor, tasks):
    found = dict(each_done(tasks.ends_at_seven, range(12), executor))
    assert found.pop(7).error.startswith("the process that ran it ended")
    assert found == {k: k * k for k in range(12) if k != 7}
