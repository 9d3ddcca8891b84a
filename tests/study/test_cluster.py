"""A Dask cluster of real processes does many tasks, also while these are killed."""

from __future__ import annotations

import argparse
import os
import re
import signal
import socket
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

import mars2d
from mars2d.cli.arguments import add_workers, workers_of
from mars2d.core.errors import InputError, MissingExtraError
from mars2d.core.extras import pip_line
from mars2d.scenario.examples import examples
from mars2d.study import cluster as clusters
from mars2d.study.cluster import cluster
from mars2d.study.work import each_done
from mars2d.study.workers import Failure

pytest.importorskip("distributed")

import dask
from distributed import Client, LocalCluster

from tests.processes import wait_until

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


@pytest.mark.nightly
def test_a_task_that_ends_its_worker_is_a_failure_and_the_rest_goes_on(executor, tasks):
    done = list(each_done(tasks.ends_at_seven, range(20), executor))
    assert sorted(index for index, _ in done) == list(range(20))
    found = dict(done)
    assert found.pop(7) == Failure("the process that ran it ended, on 2 workers in turn")
    assert found == {k: k * k for k in range(20) if k != 7}


def test_functions_need_no_module(executor):
    assert dict(each_done(lambda x: x + 1, [1, 2], executor)) == {0: 2, 1: 3}


def test_sweeps_and_tournaments_come_to_the_same_as_here(executor):
    there = mars2d.sweep("random_walk", seeds=2, stop_time=5, executor=executor)
    with ThreadPoolExecutor(1) as here:
        again = mars2d.sweep("random_walk", seeds=2, stop_time=5, executor=here)
    assert there == again
    players = sorted((examples()["sumo"].parent / "sumo_players").glob("*.py"))[:2]
    matches = mars2d.tournament(
        "sumo", players=players, seeds=1, stop_time=2, executor=executor, replays=False
    ).matches
    assert [(match.steps, match.verdicts, match.error) for match in matches] == [(100, {}, "")] * 2


def test_what_still_waits_when_a_cluster_is_left_is_forgotten(local, tasks):
    with cluster(local.scheduler_address) as executor:
        done = each_done(tasks.pid_after_a_moment, range(1000), executor)
        next(done)
        done.close()
    wait_until(lambda: not local.scheduler.tasks)


def test_tasks_of_a_cluster_that_is_left_are_an_error_and_do_not_hang(local, tasks):
    with cluster(local.scheduler_address) as executor:
        done = each_done(tasks.pid_after_a_moment, range(100), executor)
        next(done)
    with pytest.raises(InputError, match="takes no more tasks, or has lost them"):
        list(done)


def test_a_worker_of_another_version_is_refused(local, monkeypatch):
    whole = Client.get_versions

    def older(client, **asked):
        versions = whole(client, **asked)
        for worker in versions["workers"].values():
            worker["packages"]["mars2d"] = None
        return versions

    monkeypatch.setattr(Client, "get_versions", older)
    with (
        pytest.raises(InputError, match=r"a worker of tcp:.*: mars2d is not installed; expected"),
        cluster(local.scheduler_address),
    ):
        pass


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


def test_a_cluster_without_workers_is_waited_for_and_says_so(capsys):
    with LocalCluster(n_workers=0, processes=False, dashboard_address=":0") as empty:
        address = empty.scheduler_address
        said = f"{address}: no worker yet: runs wait until there is one"
        with pytest.warns(UserWarning, match=re.escape(said)):
            with_cluster(address)
        capsys.readouterr()
        with chosen("--cluster", address):
            assert capsys.readouterr().err == f"mars2d: {said}\n"


@pytest.fixture(params=[1, 3])
def unguarded(request):
    """The address of a scheduler with two workers that nobody restarts, and the workers."""
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": request.param}),
        LocalCluster(n_workers=0, dashboard_address=":0", silence_logs=100) as bare,
    ):
        workers = [_worker(bare.scheduler_address) for _ in range(2)]
        try:
            wait_until(lambda: len(bare.scheduler.workers) == 2)
            yield bare.scheduler_address, workers
        finally:
            for worker in workers:
                worker.kill()
                worker.wait()


def _worker(address):
    program = [sys.executable, "-m", "distributed.cli.dask_worker", address]
    options = ["--no-nanny", "--nthreads", "1", "--no-dashboard"]
    return subprocess.Popen(
        [*program, *options], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        cwd=Path(__file__).parents[2],  # where this module is found
    )  # fmt: skip


def kills_its_process(x):
    os.kill(os.getpid(), signal.SIGKILL)


@pytest.mark.nightly
def test_a_task_that_ends_all_workers_is_a_failure(unguarded, monkeypatch, capsys):
    monkeypatch.setattr(clusters, "SOON", 0.5)
    monkeypatch.setattr(clusters, "ABSENCE", 1.0)
    address, _ = unguarded
    with cluster(address) as executor:
        found = dict(each_done(kills_its_process, [1], executor))
    said = "the process that ran it ended, on 2 workers in turn; no worker is left"
    assert found == {0: Failure(said)}
    told = f"mars2d: {address}: all workers have ended: waits 1 s for others\n"
    assert capsys.readouterr().err == told


@pytest.mark.nightly
def test_tasks_for_which_no_worker_is_left_are_an_error(unguarded, monkeypatch):
    monkeypatch.setattr(clusters, "ABSENCE", 1.0)
    found = []
    with cluster(unguarded[0]) as executor, pytest.raises(InputError, match="Start workers: the"):
        for _, outcome in each_done(kills_its_process, range(20), executor):
            found.append(outcome)
    assert 0 < len(found) < 20
    assert all(failure.error.endswith("; no worker is left") for failure in found)


@pytest.mark.nightly
def test_workers_that_come_in_time_go_on(unguarded, monkeypatch, capsys):
    monkeypatch.setattr(clusters, "SOON", 0.5)
    address, workers = unguarded
    with cluster(address) as executor, ThreadPoolExecutor(1) as beside:
        tasks = iter(each_done(lambda x: time.sleep(0.5) or x, range(20), executor))
        found = dict([next(tasks)])
        for worker in workers:
            worker.kill()
        rest = beside.submit(dict, tasks)
        said = []
        wait_until(lambda: said.append(capsys.readouterr().err) or "have ended" in "".join(said))
        workers += [_worker(address) for _ in range(2)]
        assert found | rest.result() == {k: k for k in range(20)}


def test_without_dask_the_line_is_printed_that_installs_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(MissingExtraError, match=re.escape(pip_line("cluster")) + "$"):
        with_cluster("tcp://10.0.0.5:8786")


def chosen(*words):
    parser = argparse.ArgumentParser()
    add_workers(parser)
    return workers_of(parser.parse_args(words))


def test_the_command_line_chooses_who_does_the_runs(local):
    with chosen() as (executor, workers):
        assert (executor, workers) == (None, None)
    with chosen("--workers", "3") as (executor, workers):
        assert (executor, workers) == (None, 3)
    with chosen("--cluster", local.scheduler_address) as (executor, workers):
        assert workers is None
        assert list(each_done(abs, [-3], executor)) == [(0, 3)]
    for words, said in (
        (["--workers", "0"], "workers=0: expected a whole number from 1 to"),
        (["--workers", "2", "--cluster", "tcp://10.0.0.5:8786"], "give it or --cluster"),
    ):
        with pytest.raises(InputError, match=said), chosen(*words):
            pass
