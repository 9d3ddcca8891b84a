"""Records to be kept: one with everything, and small ones of random bits."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import mars2d
from mars2d import Holonomic, InputError, Record, Robot, Scenario, Sensor
from mars2d.addons import Communication, Map
from mars2d.bodies.props import Box, Puck
from mars2d.record.contact import CONTACT
from mars2d.record.interventions import Change, Place, Pull, Steer
from mars2d.record.message import MESSAGE, STATUS, as_text
from mars2d.record.rows import COLUMNS
from mars2d.scenario import serialize
from mars2d.sensors import Bumper, Proximity

FORMATS = (".npz", ".csv")


class Grid(Sensor):
    """Readings of the user's own (2, 3): with all that is not a number."""

    def read(self, robot, world, rng):
        return np.array([[world.time, robot.index, np.nan], [-np.nan, np.inf, -0.0]])


def talks(robot):
    robot.send({"grüße": "🤖", "t": robot.time, "nothing": float("nan")})
    return 0.3, 0.1 * robot.index


@cache
def everything() -> Record:
    """A run with props, sensors of several shapes, contacts, messages, and parts of one's own."""
    robots = [
        Robot(sensors=[Proximity(range=0.4), Grid()], controller=talks),
        Robot(pose=(1, 0, np.pi), drive=Holonomic(), name='größe, "x"'),
        Robot(pose=(0, 2, 0), controller=talks,
              sensors=[Grid(), Grid(name="x"), Bumper(name="größe")]),
    ]  # fmt: skip
    props = [Puck(pose=(-0.5, 2)), Box(pose=(0.5, 2.0, 0.3), length=0.2, name="load")]
    addons = [Map([[(0.5, -1), (0.5, 1)]]), Communication()]
    scenario = Scenario(
        title="Grüße 🤖", robots=robots, props=props, addons=addons, stop_time=2, command_delay=0.05
    )
    record = mars2d.run(scenario, seed=2**63 - 1)
    changed, _ = serialize.to_scenario(
        serialize.from_description(scenario.replace(title="changed"))
    )
    done = (
        Place(1, 0, (0.1, 0.2, 0.3)),
        Pull(2, 3, (0.0, 0.1), None, 1.0, 2.0),
        Steer(3, 1, True),
        Change(4, changed, ((0, (1.0, 2.0, 3.0)),)),
    )
    return replace(record, interventions=done, filename="walk größe.py")


def cut_to(record: Record, rows: int) -> Record:
    """Return the first rows of a record."""
    sensors = {name: values[:rows] for name, values in record.sensors.items()}
    columns = {name: getattr(record, name)[:rows] for name in COLUMNS}
    nothing = {"contacts": np.empty(0, CONTACT), "messages": np.empty(0, MESSAGE), "contents": ()}
    return replace(record, sensors=sensors, interventions=(), **columns, **nothing)


def refused(path, message: str = "", **options) -> str:
    """Return what is said of a file that is no record: one line, and it names the file."""
    with pytest.raises(InputError, match=message or None) as raised:
        mars2d.load(path, **options)
    text = str(raised.value)
    assert text.startswith(str(path))
    assert "\n" not in text
    return text


def foxglove_message(kind: str, data: bytes):
    """Return a message of Foxglove, read by the schema that is sent along."""
    from foxglove import messages
    from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

    schema, pool = getattr(messages, kind).get_schema(), descriptor_pool.DescriptorPool()
    for file in descriptor_pb2.FileDescriptorSet.FromString(schema.data).file:
        pool.Add(file)
    return message_factory.GetMessageClass(pool.FindMessageTypeByName(schema.name)).FromString(data)


@st.composite
def records(draw) -> Record:
    """Small records of any bits that a record may hold."""
    robots, props = draw(st.integers(1, 3)), draw(st.integers(0, 2))
    rows = draw(st.integers(0, 4))
    scenario = Scenario(
        robots=[Robot(pose=(k, 0, 0)) for k in range(robots)],
        props=[Box(pose=(k, 2, 0)) for k in range(props)],
    )

    def finite(*shape):
        numbers = st.floats(allow_nan=False, allow_infinity=False)
        return draw(arrays(np.float64, shape, elements=numbers))

    def anything(*shape):
        return draw(arrays(np.uint64, shape)).view(np.float64)

    sensors, sensor_robots = {}, {}
    identifiers = st.sampled_from(
        ["scan", "scan_0", "x", "time", "record", "größe", "カメラ", "end"]
    )
    for name in draw(st.lists(st.one_of(identifiers, long_names()), max_size=3, unique=True)):
        carriers = draw(st.lists(st.sampled_from(range(robots)), min_size=1, unique=True))
        shape = (rows, len(carriers), *draw(st.lists(st.integers(0, 2), max_size=2)))
        flags = draw(st.booleans())
        sensors[name] = draw(arrays(np.bool_, shape)) if flags else anything(*shape)
        sensor_robots[name] = tuple(sorted(carriers))

    contacts = np.zeros(draw(st.integers(0, 3)), CONTACT)
    for name in CONTACT.names:
        if CONTACT[name].base == np.float64:
            contacts[name] = anything(*contacts[name].shape)
    contacts["a"] = draw(arrays(np.int32, contacts.shape, elements=st.integers(0, robots - 1)))
    contacts["b"] = draw(arrays(np.int32, contacts.shape, elements=st.integers(-9, robots - 1)))
    contacts["began"] = draw(arrays(np.bool_, contacts.shape))

    contents = tuple(draw(st.lists(st.text(max_size=5).map(_as_sent), max_size=3)))
    messages = np.zeros(draw(st.integers(0, 3)) if contents else 0, MESSAGE)
    messages["arrival"] = anything(*messages.shape)
    for name, end in (("receiver", robots), ("content", len(contents)), ("status", len(STATUS))):
        if len(messages):
            kind, numbers = MESSAGE[name], st.integers(0, end - 1)
            messages[name] = draw(arrays(kind, messages.shape, elements=numbers))
    return Record(
        scenario=scenario,
        seed=draw(st.integers(0, 2**63 - 1)),
        time=np.cumsum(draw(arrays(np.float64, rows, elements=st.floats(1e-3, 10)))),
        pose=finite(rows, 3, robots),
        command=finite(rows, 2, robots),
        command_time=finite(rows),
        prop_pose=finite(rows, 3, props),
        effort=finite(rows, robots),
        velocity=finite(rows, 3, robots),
        prop_velocity=finite(rows, 3, props),
        work=finite(rows, 6),
        sensors=sensors,
        sensor_robots=sensor_robots,
        contacts=contacts,
        messages=messages,
        contents=contents,
        over_message=draw(st.text(st.characters(exclude_categories=["Cs"]), max_size=9)),
        finished=draw(st.booleans()),
        versions={"mars2d": mars2d.__version__},
    )


def long_names() -> st.SearchStrategy[str]:
    """Names that begin alike for longer than Matlab looks."""
    return st.sampled_from("ab").map(lambda last: 70 * "a" + last)


def _as_sent(text: str) -> str:
    return as_text(text.encode("utf-8", "replace").decode())
