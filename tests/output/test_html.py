"""What a replay holds of a record: how precisely, how much at most, and what it says it lacks."""

import base64
import json
import zlib
from dataclasses import replace

import numpy as np
import pytest

import mars2d
from mars2d import Robot, Scenario
from mars2d.addons import Communication
from mars2d.bodies.props import Box
from mars2d.core.errors import InputError, LawError
from mars2d.core.scene import Scene
from mars2d.output.pages.replay import page
from mars2d.record.rows import COLUMNS
from mars2d.sensors import Proximity, RangeFinder
from mars2d.sensors.base import Sensor

ROOM = [(-6, -6), (6, -6), (6, 6), (-6, 6)]


def circles(world):
    t, i = world.time, np.arange(len(world.robots))
    return np.array([0.3 + 0.1 * np.sin(t + i), 0.5 + 0.2 * np.sin(0.3 * t * (1 + i % 5) + i)])


def held(text):
    """Return what a page holds: its plain data, and its columns as they are decoded by the book."""
    data = text.partition('type="text/plain">')[2].partition("</script>")[0]
    head, body = (base64.b64decode(part) for part in data.split(" "))
    content = json.loads(zlib.decompress(head))
    columns = {}
    for name, entry in content["columns"].items():
        raw = zlib.decompress(body[entry["at"] : entry["at"] + entry["bytes"]])
        columns[name] = decoded(entry, np.frombuffer(raw, dtype=np.uint8))
    return content, columns


def decoded(entry, raw):
    shape = entry["shape"]
    if not np.prod(shape):
        return np.empty(shape)
    series = raw.view("<i4").reshape(-1, shape[0])
    for _ in range(entry["order"]):
        series = np.cumsum(series, axis=1)
    return series.T.reshape(shape) * entry.get("step", 1)


def crowd(steps):
    """Ten robots that scan and talk among boxes, for some control steps."""
    robots = [
        Robot(pose=(2 * (k % 5) - 4, 3 * (k // 5) - 1.5, 0.3 * k), sensors=[RangeFinder()])
        for k in range(10)
    ]
    boxes = [Box(pose=(-3 + 2 * k, 0, 0.3)) for k in range(4)]
    scenario = Scenario(
        robots=robots, props=boxes, workspace=ROOM, on_exit="wall", stop_time=0.1 * (steps - 1),
        addons=[Communication()],
    )  # fmt: skip

    def law(world):
        world.robots[0].send({"x": float(world.robots[0].position[0])})
        return circles(world)

    return mars2d.run(scenario, control=law)


@pytest.fixture(scope="module")
def crowded():
    return crowd(200)


@pytest.fixture(scope="module")
def crowded_page(crowded):
    return page(crowded)


def test_positions_are_within_micrometres_and_headings_within_a_hundredth_of_a_degree(
    crowded, crowded_page
):
    content, columns = held(crowded_page)
    poses = np.concatenate([crowded.pose, crowded.prop_pose], axis=2)
    low = np.array(content["columns"]["places"]["low"])[:, None]
    assert np.abs(columns["places"] + low - poses[:, :2]).max() < 7e-6
    assert np.degrees(np.abs(columns["headings"] - poses[:, 2]).max()) < 0.01
    upright = {layer for layer, it in content["drawn"].items() if it["drawings"][0]["upright"]}
    assert upright == {"names"}  # all else turns with its body


# -- long runs ------------------------------------------------------------------------------------


def circling(rows, turn):
    """Return a record of robots on circles of 0.6 m that stand still in the second half.

    turn: rad a row, of each robot.
    """
    short = mars2d.run(Scenario(robots=len(turn), workspace=ROOM, stop_time=0.1), control=circles)
    time = np.arange(rows) * 0.1
    angle = np.minimum(np.arange(rows), rows // 2)[:, None] * turn
    pose = np.stack([0.6 * np.cos(angle), 0.6 * np.sin(angle), angle + np.pi / 2], axis=1)
    return replace(
        short, time=time, pose=pose, command=np.zeros((rows, 2, len(turn))), command_time=time,
        prop_pose=np.zeros((rows, 3, 0)), effort=np.zeros((rows, len(turn))),
        velocity=np.zeros_like(pose), prop_velocity=np.zeros((rows, 3, 0)),
        work=np.zeros((rows, 6)),
    )  # fmt: skip


def test_the_lines_of_a_long_run_are_those_of_its_path_and_there_is_none_across_a_bend(monkeypatch):
    monkeypatch.setattr("mars2d.output.pages.replay.content.POSES", 15_000)
    record = circling(20_001, np.array([0.03, 0.5]))
    content, columns = held(page(record))
    rows = columns["rows"].astype(int)
    assert rows[[0, -1]].tolist() == [0, 20_000]
    assert (rows < 10_000).mean() > 0.7  # where they move
    places = columns["places"] + np.array(content["columns"]["places"]["low"])[:, None]
    middle = np.hypot(*((places[1:] + places[:-1]) / 2).swapaxes(0, 1))
    gaps = np.zeros(middle.shape, dtype=bool)
    gaps[columns["leaps:row"] - 1, columns["leaps:body"]] = True
    assert (middle[~gaps] > 0.6 * np.cos(np.pi / 4)).all()  # a chord of less than 90 degrees
    assert gaps[:, 1].sum() > 100
    assert not gaps[:, 0].any()
    assert any(f"{len(rows)} of 20001 rows are in this file" in note for note in content["notes"])
    assert any(note.startswith("paths have gaps") for note in content["notes"])


def test_a_replay_of_the_same_record_is_the_same_text(crowded, crowded_page):
    assert page(crowded) == crowded_page


def test_words_of_an_experiment_cannot_become_code():
    evil = "</script><img src=x onerror=alert(1)><!--"
    scenario = Scenario(robots=[Robot(pose=(0, 0, 0), name=evil)], title=evil, stop_time=0.2)
    text = page(mars2d.run(scenario, control=circles))
    assert "onerror" not in text.replace("&lt;img src=x onerror=alert(1)&gt;", "")
    content, _ = held(text)
    assert content["bodies"][0]["name"] == content["title"] == evil


def test_a_page_loads_nothing():
    text = page(mars2d.run(Scenario(robots=1, stop_time=0.1), control=circles))
    assert "://" not in text.partition('type="text/plain">')[0]


class Whisker(Sensor):
    """Draws a line ahead."""

    def read(self, robot, world, rng):
        return float(robot.position[0])

    def draw(self, scene: Scene, pose, reading, color):
        x, y, theta = pose
        scene.line([(x, y), (x + np.cos(theta), y + np.sin(theta))], stroke=color)


class Broken(Sensor):
    """Can't draw."""

    def read(self, robot, world, rng):
        return 1.0

    def draw(self, scene: Scene, pose, reading, color):
        raise ValueError("no pencil")


def run_with(*sensors):
    robots = [Robot(pose=(1, 2, 0.5), sensors=sensors)]
    return mars2d.run(Scenario(robots=robots, stop_time=2), control=circles)


def test_a_sensor_of_ones_own_is_drawn():
    content, columns = held(page(run_with(Whisker())))
    assert content["drawn"]["sensors"]["drawings"][0]["scenes"] == 21
    drawn = columns["sensors:numbers"][:4] * content["drawn"]["sensors"]["step"]
    assert drawn == pytest.approx([1, 2, 1 + np.cos(0.5), 2 + np.sin(0.5)], abs=1e-3)


def test_a_sensor_whose_code_is_not_in_a_file_is_named(tmp_path):
    record = mars2d.load(run_with(Whisker(), Proximity(range=1)).save(tmp_path / "run.npz"))
    content, _ = held(page(record))
    assert "not drawn, since their code is not in the record: sensor Whisker" in content["notes"]
    assert len(content["drawn"]["sensors"]["drawings"]) == 1


def test_an_error_in_a_sensors_drawing_says_which():
    with pytest.raises(LawError, match=r"broken.*no pencil"):
        page(run_with(Broken()))


def test_a_record_of_one_row_has_a_replay_and_one_without_rows_none():
    record = mars2d.run(Scenario(robots=1, stop_time=0.1), control=circles)
    one, empty = (replace(record, **{c: getattr(record, c)[:k] for c in COLUMNS}) for k in (1, 0))
    content, columns = held(page(one))
    assert len(columns["places"]) == content["rows"] == 1
    with pytest.raises(InputError, match="no rows"):
        page(empty)
