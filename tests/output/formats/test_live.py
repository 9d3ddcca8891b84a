"""A run that is watched by Foxglove's websocket while it goes on: a real client reads it."""

import asyncio
import socket
import struct
import threading

import numpy as np
import pytest

from mars2d import InputError, Robot, Scenario, World
from mars2d.bodies import Box
from mars2d.cli import command_line as cli
from mars2d.record.contact import mean_forces
from mars2d.sensors import RangeFinder
from tests.output.formats.records import foxglove_message
from tests.processes import wait_until

pytest.importorskip("foxglove")
websockets = pytest.importorskip("websockets")


def pushing():
    """A robot that scans and pushes a box."""
    robot = Robot(name="red", sensors=[RangeFinder(beams=5, range=3.0, name="eye")])
    return Scenario(
        robots=[robot], props=[Box(name="crate", pose=(0.5, 0, 0))], workspace=None, stop_time=1e5
    )


class Client(threading.Thread):
    """Subscribes to all topics, and keeps the newest messages by topic."""

    def __init__(self, address):
        super().__init__(daemon=True)
        self.address, self.found, self.schemas = address, {}, {}
        self.ended = threading.Event()
        self.start()

    def run(self):
        asyncio.run(self.read())

    async def read(self):
        import json

        topics = {}
        connect = websockets.connect(
            self.address, subprotocols=["foxglove.sdk.v1", "foxglove.websocket.v1"], max_size=None
        )
        async with connect as connection:
            async for message in connection:
                if isinstance(message, str):
                    told = json.loads(message)
                    if told["op"] != "advertise":
                        continue
                    new = [each for each in told["channels"] if each["id"] not in topics]
                    topics |= {each["id"]: each["topic"] for each in new}
                    self.schemas |= {each["topic"]: each["schemaName"] for each in new}
                    asked = [{"id": each["id"], "channelId": each["id"]} for each in new]
                    await connection.send(json.dumps({"op": "subscribe", "subscriptions": asked}))
                elif message[0] == 1:  # the data of a message
                    number, nanoseconds = struct.unpack_from("<IQ", message, 1)
                    self.found[topics[number]] = nanoseconds, message[13:]
                if self.ended.is_set():
                    return


def test_a_client_sees_poses_scans_contacts_and_the_scene_as_they_are():
    from mars2d.output.formats.mcap.live import Live

    with Live(0) as live:
        world = World(pushing(), watch=live)
        while not len(world.contacts):  # then all topics are there before somebody asks for them
            world.step([[0.3], [0.0]])
        world.step([[0.3], [0.0]])
        client = Client(live.address)
        wanted = {"/poses", "/tf", "/scene", "/contacts", "/red/eye"}

        def all_seen():
            world.step([[0.3], [0.0]])
            return wanted <= client.found.keys()

        wait_until(all_seen)
        assert client.found.keys() == wanted
        nanoseconds, data = client.found["/poses"]
        row = round(nanoseconds / 1e8)
        found = foxglove_message("PosesInFrame", data).poses
        for pose, shown in zip(world.record.pose[row].T, found, strict=False):
            assert (shown.position.x, shown.position.y) == tuple(pose[:2])
        assert found[1].position.x == world.record.prop_pose[row, 0, 0]
        scan = foxglove_message("LaserScan", client.found["/red/eye"][1])
        assert len(scan.ranges) == 5
        names = {
            entity.id
            for entity in foxglove_message("SceneUpdate", client.found["/scene"][1]).entities
        }
        assert names == {"ground", "body red", "body crate"}
        nanoseconds, data = client.found["/contacts"]
        [entity] = foxglove_message("SceneUpdate", data).entities
        frame = world.record.frame(round(nanoseconds / 1e8) + 1)
        lengths = 0.01 * np.linalg.norm(mean_forces(frame.contacts, 0.1), axis=1)
        assert [arrow.shaft_length for arrow in entity.arrows] == pytest.approx(lengths)
        assert client.schemas["/tf"] == "foxglove.FrameTransforms"
        client.ended.set()


def test_a_port_in_use_and_one_that_is_none_are_named(capsys):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        words = ["run", "random_walk", "--headless", "--stop-time", "2", "--foxglove", str(port)]
        assert cli.main(words) == cli.BAD_INPUT
        told = capsys.readouterr().err
        assert f"--foxglove {port}: " in told
        assert "Address already in use" in told
    assert cli.main([*words[:-1], "70000"]) == cli.BAD_INPUT
    assert "--foxglove 70000" in capsys.readouterr().err
    with pytest.raises(InputError, match="name another port"):
        from mars2d.output.formats.mcap.live import Live

        Live(-1)


def test_a_run_without_a_window_is_served_in_the_time_that_it_takes(capsys, tmp_path):
    words = ["run", "go_to_point", "--headless", "--stop-time", "1", "--foxglove", "0"]
    assert cli.main([*words, "--record", str(tmp_path / "a.npz")]) == 0
    assert "Foxglove: open ws://127.0.0.1:" in capsys.readouterr().err
