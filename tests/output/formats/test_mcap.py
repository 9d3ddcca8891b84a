"""Logs: written tick by tick, read back bit by bit, whatever ended them."""

from __future__ import annotations

import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d import InputError, Record, Robot, Scenario, World
from mars2d.core.extras import pip_line
from mars2d.output.formats.mcap import Log
from mars2d.output.formats.mcap.reading import BROKEN_OFF
from mars2d.output.formats.mcap.row import Row, decoded, encoded
from mars2d.record.contact import CONTACT
from mars2d.record.message import MESSAGE
from mars2d.record.rows import COLUMNS
from mars2d.scenario import serialize
from mars2d.scenario.experiment import open_experiment
from mars2d.world.loop import simulate
from tests.cases import each_case
from tests.output.formats.records import foxglove_message

pytest.importorskip("mcap")

EXAMPLES = ["token_ring", "many_push_one", "wall_follower", "billiards", "sumo"]
"""With messages, contacts and props, a sensor, joints, and add-ons."""


def run(name: str, path: Path, until: float = 8.0) -> Record:
    return simulate(open_experiment(name, {"stop_time": until}, seed=1), log=Log(path)).record


def torn(path: Path, size: int) -> Path:
    """Return a copy of the first bytes of a file."""
    part = path.with_name("torn.mcap")
    part.write_bytes(path.read_bytes()[:size])
    return part


def same_up_to(part: Record, whole: Record) -> None:
    """Check that a record is the beginning of another, to the last bit."""
    n = len(part)
    for name, column in part.columns().items():
        if name.startswith(("contact:", "message:", "content")):
            continue
        np.testing.assert_array_equal(column, whole.columns()[name][:n])
    for mine, other in ((part.contacts, whole.contacts), (part.messages, whole.messages)):
        for name in mine.dtype.names:
            if name != "status":  # of messages that were on their way when it broke off
                np.testing.assert_array_equal(mine[name], other[name][: len(mine)])
    assert tuple(part.contents) == tuple(whole.contents[: len(part.contents)])


def unclosed(name: str, path: Path, until: float = 8.0) -> Record:
    """Run an example with a log that is left as it was at the last step, as by kill -9."""
    log = Log(path)
    experiment = open_experiment(name, {"stop_time": until})
    world = World(experiment.scenario, experiment.control, 1, filename=experiment.source.name)
    while not world.over:
        world.step()
        log.follow(world)
    log._file.close()
    return world.record


@each_case("name", EXAMPLES)
def test_a_log_holds_the_same_bits_as_the_record_of_the_run(name, tmp_path) -> None:
    record = run(name, tmp_path / "run.mcap")
    without = simulate(open_experiment(name, {"stop_time": 8.0}, seed=1)).record
    read = mars2d.load(tmp_path / "run.mcap")
    assert read.digest == record.digest == without.digest
    assert (read.over_message, read.finished, read.seed) == (record.over_message, True, 1)
    other = mars2d.load(without.save(tmp_path / "run.npz"))
    assert serialize.from_description(read.scenario) == serialize.from_description(other.scenario)


@pytest.mark.slow
@pytest.mark.parametrize("library", ["mcap", "foxglove"])
def test_without_a_library_a_log_says_what_to_install(library, child, tmp_path) -> None:
    code = (
        "import sys\n"
        "class Blocked:\n"
        "    def find_spec(self, name, path=None, target=None):\n"
        f"        if name.partition('.')[0] == {library!r}:\n"
        "            raise ModuleNotFoundError(name)\n"
        "sys.meta_path.insert(0, Blocked())\n"
        "from mars2d.cli import command_line as cli\n"
        f"path = {str(tmp_path)!r} + '/a.mcap'\n"
        "sys.exit(cli.main(['run', 'head_on', '--headless', '--record', path]))\n"
    )
    result = child(code)
    told = f"mars2d: {tmp_path}/a.mcap: a log needs mcap: {pip_line('log')}\n"
    assert (result.returncode, result.stderr) == (2, told)
    assert list(tmp_path.iterdir()) == []


def test_wherever_a_log_breaks_off_all_rows_before_are_there(tmp_path) -> None:
    record = unclosed("token_ring", tmp_path / "run.mcap", 30.0)
    whole = (tmp_path / "run.mcap").read_bytes()
    chosen = random.Random(1)
    first = whole.index(b"/mars2d/row") + 20_000  # behind the header
    count = 0
    for size in [*sorted(chosen.randrange(first, len(whole)) for _ in range(40)), len(whole)]:
        read = mars2d.load(torn(tmp_path / "run.mcap", size))
        assert len(read) >= count
        count = len(read)
        same_up_to(read, record)
    assert count == len(record)
    assert len(read.messages) == len(record.messages)
    assert (read.over_message, read.finished) == (BROKEN_OFF, False)


def test_a_row_comes_back_from_the_bytes_in_which_it_is_stored() -> None:
    contacts, messages = np.zeros(1, CONTACT), np.zeros(1, MESSAGE)
    contacts["b"], contacts["point"], contacts["began"] = -7, (0.1, 0.2), True
    messages["arrival"], messages["status"] = np.nan, 4
    columns = {name: np.arange(k) / 7 - 0.0 for k, name in enumerate(COLUMNS)}
    readings = {"sensor:scan": np.array([[0.5, np.inf]]), "sensor:none": np.zeros((1, 0)),
                "sensor:größe": np.array([[True, False]])}  # fmt: skip
    row = Row(3, columns | readings, contacts, messages, ["", "🤖"], ["{}"])
    again = decoded(encoded(row))
    assert (again.row, again.contents, again.changes) == (3, row.contents, row.changes)
    assert (again.contacts.tobytes(), again.messages.tobytes()) == (
        contacts.tobytes(), messages.tobytes(),
    )  # fmt: skip
    assert again.columns.keys() == row.columns.keys()
    for name, values in row.columns.items():
        found = again.columns[name]
        assert (found.tobytes(), found.shape, found.dtype) == (
            values.tobytes(), values.shape, values.dtype,
        )  # fmt: skip


def test_foxglove_gets_poses_frames_scans_and_the_scene(tmp_path) -> None:
    from mcap.reader import make_reader

    from mars2d.sensors import RangeFinder

    scanner = RangeFinder(
        beams=9, range=2.0, field_of_view=np.pi, mount=(0.1, 0.0, 0.3), name="eye"
    )
    robots = [Robot(pose=(0, 0, 0.5), sensors=[scanner]), Robot(pose=(1, 0.5, 2))]
    scenario = Scenario(robots=robots, stop_time=1.0, on_exit="wall")
    record = mars2d.run(scenario, record=tmp_path / "run.mcap")
    found: dict[str, list] = {}
    with (tmp_path / "run.mcap").open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        for told, channel, message in reader.iter_messages():
            package, _, kind = told.name.partition(".") if told else ("", "", "")
            if package == "foxglove":
                shown = foxglove_message(kind, message.data)
                found.setdefault(channel.topic, []).append(shown)
        counts = reader.get_summary().statistics.channel_message_counts
    assert sorted(found) == ["/poses", "/robot0/eye", "/scene", "/tf"]
    assert len(found["/scene"]) == 1
    assert max(counts.values()) == len(record)
    pose = found["/poses"][-1].poses[1]
    assert (pose.position.x, pose.position.y) == (1, 0.5)
    assert 2 * np.arctan2(pose.orientation.z, pose.orientation.w) == pytest.approx(2)
    link = found["/tf"][-1].transforms[0]
    assert (link.parent_frame_id, link.child_frame_id) == ("world", "robot0")
    assert link.timestamp.ToNanoseconds() == 10**9
    scan_ = found["/robot0/eye"][3]
    assert list(scan_.ranges) == record.sensors["eye"][3, 0].tolist()
    assert (scan_.start_angle, scan_.end_angle) == pytest.approx((-np.pi / 2, np.pi / 2))
    assert (scan_.frame_id, scan_.pose.position.x) == ("robot0", 0.1)
    names = {entity.frame_id for entity in found["/scene"][0].entities}
    assert names == {"world", "robot0", "robot1"}


# -- kill -9 --------------------------------------------------------------------------------------

ENDLESS = """
import os, sys
import mars2d
from mars2d.scenario.experiment import open_experiment
from mars2d.output.formats.mcap import Log
from mars2d.world.loop import open_world
experiment = open_experiment("token_ring", {"stop_time": float(sys.argv[2])}, seed=1)
with Log(sys.argv[1]) as log:
    world = open_world(experiment)
    while not world.over:
        world.step()
        log.follow(world)
        os.write(1, world.iteration.to_bytes(8, "little"))
    os.write(1, bytes(8))
"""
"""A run that tells of each step that is finished: how many there are; and 0 before it is packed."""


def killed(path: Path, after: float, until: float) -> int:
    """Kill a run some seconds after its first step; return how many it had finished."""
    process = subprocess.Popen(
        [sys.executable, "-c", ENDLESS, str(path), str(until)], stdout=subprocess.PIPE
    )
    assert process.stdout is not None
    first = process.stdout.read(8)
    assert first, "it did not begin"
    time.sleep(after)
    process.send_signal(signal.SIGKILL)
    told = first + process.stdout.read()
    process.stdout.close()
    process.wait()
    steps = [int.from_bytes(told[i : i + 8], "little") for i in range(0, len(told) // 8 * 8, 8)]
    return max(steps)


@pytest.mark.slow
def test_a_run_that_is_killed_loses_no_finished_step(tmp_path) -> None:
    whole = simulate(open_experiment("token_ring", {"stop_time": 200.0}, seed=1)).record
    chosen = random.Random(3)
    for k in range(3):
        path = tmp_path / f"{k}.mcap"
        finished = killed(path, chosen.uniform(0.0, 0.8), 200.0)
        read = mars2d.load(path)
        # One more may have been written, and not told of.
        assert finished <= len(read) <= finished + 1 or len(read) == len(whole)
        same_up_to(read, whole)


@pytest.mark.slow
def test_a_run_that_is_killed_while_it_is_packed_keeps_all(tmp_path, child) -> None:
    path = tmp_path / "run.mcap"
    code = (
        "import os, signal, mcap.writer as w\n"
        "calls, add = [0], w.ChunkBuilder.add_message\n"
        "def dying(*args, **kwargs):\n"
        "    calls[0] += 1\n"
        "    if calls[0] == 30: os.kill(os.getpid(), signal.SIGKILL)\n"
        "    return add(*args, **kwargs)\n"
        "w.ChunkBuilder.add_message = dying\n"  # only packing uses it
        f"import mars2d; mars2d.run('token_ring', stop_time=20, record={str(path)!r})"
    )
    assert child(code).returncode == -signal.SIGKILL
    read = mars2d.load(path)
    assert read.digest == mars2d.run("token_ring", stop_time=20).digest
    assert read.finished


# -- what is no log of ours -----------------------------------------------------------------------


def test_foreign_files_are_refused_in_one_line(tmp_path) -> None:
    from mcap.writer import Writer

    path = tmp_path / "run.mcap"
    for data, why in (
        (b"", "holds no rows: the run ended before its first one"),
        (b"hello", "this is no MCAP file"),
        (b"\x89MCAP0\r\n", "it has no rows of a run"),
    ):
        path.write_bytes(data)
        with pytest.raises(InputError, match=why):
            mars2d.load(path)
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        channel = writer.register_channel("/imu", "json", 0)
        writer.add_message(channel, 0, b"{}", 0)
        writer.finish()
    with pytest.raises(InputError, match=r"run.mcap: an MCAP file, but not of MARS2D"):
        mars2d.load(path)


def test_a_log_of_a_newer_version_says_so_and_a_large_one_how_to_read_it(tmp_path) -> None:
    path = tmp_path / "run.mcap"
    record = unclosed("token_ring", path, 2.0)
    newer = path.read_bytes().replace(b'"format": 5', b'"format": 9')
    path.with_name("newer.mcap").write_bytes(newer)
    with pytest.raises(InputError, match="written by a newer version of MARS2D"):
        mars2d.load(path.with_name("newer.mcap"))
    with pytest.raises(InputError, match="largest="):
        mars2d.load(path, largest=5000)
    assert len(mars2d.load(path, largest=100_000)) == len(record)


# -- a window's branches --------------------------------------------------------------------------


def test_a_log_follows_the_branches_of_a_timeline(tmp_path) -> None:
    from mars2d.world.timeline import Timeline

    path = tmp_path / "run.mcap"
    log = Log(path)
    timeline = Timeline(open_experiment("many_push_one", {"stop_time": 8.0}, seed=1), log=log)
    for _ in range(50):
        timeline.advance()
    assert len(mars2d.load(path)) == 50
    timeline.go(20)
    timeline.change(lambda world: world.operator.steer(0, (0.0, 0.5)))
    for _ in range(10):
        timeline.advance()
    read = mars2d.load(path)
    assert len(read) == 30
    same_up_to(read, timeline.record)
    assert read.interventions == timeline.record.interventions
    timeline.show(timeline.others[0])
    assert len(mars2d.load(path)) == 50
    timeline.show(timeline.others[0])
    log.close(timeline.record)
    assert mars2d.load(path).digest == timeline.record.digest
    assert mars2d.load(path).over_message == "The window was closed"


def test_a_run_that_begins_anew_begins_its_log_anew(tmp_path) -> None:
    from mars2d.world.timeline import Timeline

    path = tmp_path / "run.mcap"
    log = Log(path)
    timeline = Timeline(open_experiment("token_ring", {"stop_time": 8.0}, seed=1), log=log)
    for _ in range(30):
        timeline.advance()
    timeline.restart()
    assert len(mars2d.load(path)) == 0
    for _ in range(20):
        timeline.advance()
    same_up_to(mars2d.load(path), timeline.record)
    log.close(timeline.record)
    assert mars2d.load(path).digest == timeline.record.digest
