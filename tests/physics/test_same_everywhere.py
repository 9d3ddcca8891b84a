"""One experiment, one seed, one digest: however it is run, and by whatever.

The experiment is `tests/physics/bustle/bustle.py`, in which there is a bit of everything.
"""

from __future__ import annotations

import csv
import json
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d import World
from mars2d.scenario.experiment import open_experiment
from mars2d.world.timeline import Timeline
from mars2d.world.verify import rerun
from tests.cases import each_case
from tests.processes import bare_environment

pytestmark = pytest.mark.slow

FOLDER = Path(__file__).parent / "bustle"
BUSTLE, SEED = FOLDER / "bustle.py", 3


@pytest.fixture(scope="module")
def record() -> mars2d.Record:
    return mars2d.run(BUSTLE, seed=SEED)


@pytest.fixture(scope="module")
def digest(record) -> str:
    return record.digest


@pytest.fixture(scope="module")
def discs() -> str:
    """The digest of the bustle of discs."""
    world = bustle(discs=True)
    while not world.over:
        world.step()
    assert world.record.collisions >= 5
    return world.record.digest


def bustle(seed: int = SEED, **options: bool) -> World:
    experiment = open_experiment(BUSTLE, options, seed=seed)
    return World(experiment.scenario, experiment.control, seed=seed)


def test_there_is_a_bit_of_everything_in_the_bustle(record):
    pairs = set(zip(record.contacts["a"].tolist(), record.contacts["b"].tolist(), strict=True))
    robots = len(record.scenario.robots)
    assert any(0 <= b < robots for _, b in pairs), "no robot meets another"
    assert any(b >= robots for _, b in pairs), "no prop is met"
    assert any(b < 0 for _, b in pairs), "no wall is met"
    assert record.collisions >= 5
    assert len(set(record.messages["status"].tolist())) == 3  # some arrive, some don't
    assert all((values != values[0]).any() for values in record.sensors.values())
    assert (np.abs(record.pose[-1] - record.pose[0]).max(axis=0) > 0.01).all()
    assert {type(robot.drive).__name__ for robot in record.scenario.robots} == set(
        mars2d.bodies.drives.__all__
    ) - {"Drive", "Dubins"}  # a unicycle with other bounds


# -- in this process ------------------------------------------------------------------------------


def test_a_world_that_is_looked_at_all_the_time_beside_another_one(digest):
    world, other = bustle(), bustle(seed=4)
    while not world.over:
        world.step()
        assert world.frame.readings
        assert len(world.record) == world.iteration + world.over
        other.step()
        np.random.default_rng().normal()
    assert world.record.digest == digest
    assert other.record.digest != digest


def test_two_threads_neither_of_which_is_the_main_one(digest):
    digests = {}

    def run(seed: int) -> None:
        digests[seed] = mars2d.run(BUSTLE, seed=seed).digest

    threads = [threading.Thread(target=run, args=(seed,)) for seed in (SEED, 4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert digests[SEED] == digest
    assert digests[4] != digest


def test_its_commands_given_again(record):
    assert rerun(record) is None


def test_a_timeline_in_which_somebody_goes_back_and_on(digest):
    timeline = Timeline(open_experiment(BUSTLE, seed=SEED))
    while timeline.newest < 10:
        timeline.advance()
    for row in (2, 9, 0):
        timeline.go(row)
        assert timeline.frame.iteration == row
    timeline.go(10)
    while not timeline.over:
        timeline.advance()
    assert timeline.record.digest == digest


def test_a_log_that_is_written_as_the_run_goes_on_and_read_again(digest, tmp_path):
    pytest.importorskip("mcap")
    log = tmp_path / "log.mcap"
    assert mars2d.run(BUSTLE, seed=SEED, record=log).digest == digest
    assert mars2d.load(log).digest == digest


# -- in other processes ---------------------------------------------------------------------------


def test_the_command_line_which_saves_it_and_says_so(digest, tmp_path):
    out = tmp_path / "out.npz"
    done = subprocess.run(
        [sys.executable, "-m", "mars2d", "run", BUSTLE, "--seed", str(SEED), "--headless",
         "--record", out, "--json"],
        env=bare_environment(PYTHONHASHSEED="77"), capture_output=True, text=True, check=True,
        cwd=tmp_path,
    )  # fmt: skip
    assert json.loads(done.stdout)["digest"] == digest
    assert mars2d.load(out).digest == digest


PRINTED = f"import mars2d; print(mars2d.run({str(BUSTLE)!r}, seed={SEED}).digest)"
BOTH = f"""
import mars2d
for discs in (False, True):
    print(mars2d.run({str(BUSTLE)!r}, seed={SEED}, options={{"discs": discs}}).digest)
"""


@each_case(
    ("flags", "environment"), [((), {"MARS2D_PLAIN": "1"}), (("-OO",), {"OMP_NUM_THREADS": "1"})]
)
def test_a_python_that_is(digest, discs, child, flags, environment):
    done = child(BOTH, *flags, **environment)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [digest, discs]


def test_the_workers_of_a_sweep(digest, discs):
    table = mars2d.sweep(
        BUSTLE, {"discs": [False, True]}, seeds=[SEED], workers=2, show_progress=False
    )
    assert [row.digest for row in table.results] == [digest, discs]


def test_a_match_of_a_tournament_whose_laws_are_isolated(digest, tmp_path):
    mars2d.tournament(
        BUSTLE,
        {"hunter": "hunter.py", "prey": "prey.py"},
        seeds=[SEED],
        workers=1,
        out=tmp_path,
        show_progress=False,
    )
    with (tmp_path / "matches.csv").open(newline="", encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    assert (row["verdict"], row["digest"]) == ("", digest)


def test_a_notebook(digest, tmp_path):
    for module in ("nbclient", "ipykernel"):
        pytest.importorskip(module)
    import nbformat.v4
    from nbclient import NotebookClient

    cells = [nbformat.v4.new_code_cell(text) for text in ("%matplotlib agg", PRINTED)]
    notebook = nbformat.v4.new_notebook(cells=cells)
    client = NotebookClient(
        notebook, kernel_name="python3", timeout=60,
        resources={"metadata": {"path": str(tmp_path)}},
    )  # fmt: skip
    client.execute()
    printed = "".join(output.get("text", "") for output in notebook.cells[1].outputs)
    assert printed.strip() == digest
