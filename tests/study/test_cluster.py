"""A Dask cluster of real processes does many tasks, also while these are killed."""

from __future__ import annotations

import os
import re
import signal
import socket
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest

import mars2d
from mars2d.cli.arguments import workers_of
from mars2d.cli.command_line import parser_of
from mars2d.core.errors import InputError, MissingExtraError
from mars2d.core.extras import pip_line
from mars2d.scenario.examples import examples
from mars2d.study import cluster as clusters
from mars2d.study.cluster import cluster
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
    local.wait_for_workers(2)  # one that was killed takes a moment to come back
    with cluster(local.scheduler_address) as executor:
        yield executor


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


def test_a_sweep_comes_to_the_same_bytes_by_whoever_does_it(executor, local, tmp_path):
    with Client(local, set_as_default=False) as client, ThreadPoolExecutor(2) as threads:
        ways = {
            "one": {"workers": 1},
            "two": {"workers": 2},
            "threads": {"executor": threads},
            "cluster": {"executor": executor},
            "client": {"executor": client},
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
        "sumo", players=players, seeds=1, stop_time=2, executor=executor, replays=False
    ).matches
    assert [(match.steps, match.verdicts, match.error) for match in matches] == [(100, {}, "")] * 2


def test_where_no_scheduler_answers_there_is_one_line_soon(local, monkeypatch, capfd):
    monkeypatch.setattr(clusters, "ANSWER_TIMEOUT", 0.3)
    with socket.socket() as closed, socket.create_server(("127.0.0.1", 0)) as silent:
        closed.bind(("127.0.0.1", 0))
        addresses = [f"tcp://127.0.0.1:{each.getsockname()[1]}" for each in (closed, silent)]
        for address in [*addresses, "nonsense", "foo://somewhere:1"]:
            with pytest.raises(InputError, match=f"^{address}: no Dask scheduler") as caught:
                with_cluster(address)
            assert "\n" not in str(caught.value)
    [worker, *_] = local.scheduler_info["workers"]
    with pytest.raises(InputError, match="a Dask worker; expected the address of its scheduler"):
        with_cluster(worker)
    assert capfd.readouterr() == ("", "")


def with_cluster(address):
    with cluster(address):
        pass


def test_without_dask_the_line_is_printed_that_installs_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(MissingExtraError, match=re.escape(pip_line("cluster")) + "$"):
        with_cluster("tcp://10.0.0.5:8786")


def chosen(*words):
    return workers_of(parser_of("sweep").parse_args(["walk.py", *words]))


def test_the_command_line_chooses_who_does_the_runs(local):
    with chosen() as (executor, workers):
        assert (executor, workers) == (None, None)
    with chosen("--workers", "3") as (executor, workers):
        assert (executor, workers) == (None, 3)
    with chosen("--cluster", local.scheduler_address) as (executor, workers):
        assert workers is None
        assert list(each_done(abs, [-3], executor)) == [(0, 3)]
    both = chosen("--workers", "2", "--cluster", "tcp://10.0.0.5:8786")
    with pytest.raises(InputError, match="give it or --cluster"), both:
        pass


def test_a_task_that_ends_each_of_its_workers_is_the_one_that_fails(executor, tasks):
    found = dict(each_done(tasks.ends_at_seven, range(12), executor))
    assert found.pop(7).error.startswith("the process that ran it ended")
    assert found == {k: k * k for k in range(12) if k != 7}
