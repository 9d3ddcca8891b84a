"""Robots talk: what is sent arrives or not, when, and to whom, as the channel says; all is kept."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import mars2d
from mars2d import Holonomic, InputError, LawError, Record, Robot, Scenario, World
from mars2d.addons import Burst, Communication
from mars2d.core.scene import Arrow, Line
from mars2d.output.layers.messages import messages
from mars2d.record.message import (
    DELIVERED,
    LOST,
    MAX_BYTES,
    ON_ITS_WAY,
    OUT_OF_REACH,
    OVER_BANDWIDTH,
    Message,
    as_text,
)
from mars2d.scenario.neighbours import Everyone, Nearest, Neighbourhood, Within
from mars2d.world.verify import rerun
from tests.cases import each_case


class Ahead(Neighbourhood):
    """Each robot sees the two that come after it."""

    def of(self, position):
        n = position.shape[1]
        return [[(i + 1) % n, (i + 2) % n] for i in range(n)]


def team(count=3, gap=1.0, **fields) -> Scenario:
    """Robots in a row along x, without walls."""
    talk = fields.pop("talk", Communication())
    like = Robot(**fields.pop("robot", {}))
    row = [like.at(gap * i, 0) for i in range(count)]
    return Scenario(
        **({"robots": row, "workspace": None, "stop_time": 2.0, "addons": [talk]} | fields)
    )


def stand(world: World) -> None:
    world.step(np.zeros((2, len(world.robots))))


def contents(robot) -> list:
    return [message.content for message in robot.inbox]


def heard(world: World) -> list[list]:
    """What each robot finds in its inbox at the control step that comes."""
    world.observe()
    return [contents(robot) for robot in world.robots]


def talking(scenario: Scenario, say, seed=0) -> Record:
    """Run a scenario; `say(world)` is called at each control step and sends."""

    def law(world):
        say(world)
        return np.zeros((2, len(world.robots)))

    return mars2d.run(scenario, control=law, seed=seed)


def to_one(world):
    world.robots[0].send(world.iteration, to=1)


# -- sending and receiving ------------------------------------------------------------------------


def test_what_is_sent_is_in_the_inbox_at_the_next_control_step_and_at_that_alone():
    world = World(team(2))
    assert heard(world) == [[], []]
    world.robots[0].send("hello")
    assert contents(world.robots[1]) == []  # never in the same control step
    stand(world)
    assert heard(world) == [[], ["hello"]]
    stand(world)
    assert heard(world) == [[], []]


@each_case(
    ("to", "receivers"),
    [
        (None, [0, 2, 3]), (2, [2]), ("robot3", [3]), ([0, "robot2"], [0, 2]), ((3, 3), [3]),
        (np.array([0, 3]), [0, 3]), (np.int64(2), [2]), ({"robot2", "robot0"}, [0, 2]), ([], []),
    ],
)  # fmt: skip
def test_a_message_goes_to_all_or_to_those_named_by_index_or_name(to, receivers):
    world = World(team(4))
    world.robots[1].send("x", to=to)
    stand(world)
    assert [i for i, found in enumerate(heard(world)) if found] == receivers


@each_case(
    ("to", "words"),
    [
        (
            "robot11",
            ["robot.send(to='robot11'): there is no robot 'robot11'; did you mean 'robot1"],
        ),
        (3, ["robot.send(to=3): there is no robot 3; they are 0 to 2"]),
        ("robot0", ["robot0 can't send to itself"]),
        ([[1]], ["robot.send(to=[[1]]): expected a robot's index"]),
    ],
)
def test_a_receiver_that_is_none_is_an_error_of_the_law(to, words):
    with pytest.raises(LawError) as caught:
        World(team(3)).robots[0].send("x", to=to)
    for word in words:
        assert word in str(caught.value)


def test_without_the_addon_robots_cannot_talk():
    world = World(Scenario(robots=2))
    for use in (lambda: world.robots[0].send("x"), lambda: world.robots[0].inbox):
        with pytest.raises(LawError, match=r"add Communication\(\) to Scenario.addons"):
            use()


# -- contents -------------------------------------------------------------------------------------


@each_case(
    ("content", "arrives"),
    [
        (None, None), (True, True), (3, 3), (-0.1, -0.1), ("ü\n€", "ü\n€"), ([], []), ({}, {}),
        ((1, (2, "a")), [1, [2, "a"]]), ({"a": [1, None]}, {"a": [1, None]}), (10**40, 10**40),
        (np.array([[1.5, 2], [3, 4]]), [[1.5, 2.0], [3.0, 4.0]]), (np.arange(3), [0, 1, 2]),
        (np.array([True]), [True]), (np.array(["ab", "c"]), ["ab", "c"]), (np.array(2.5), 2.5),
        (np.float32(0.5), 0.5), (np.int8(-3), -3), (np.bool_(False), False), (np.str_("s"), "s"),
        (np.longdouble(0.25), 0.25), (math.inf, math.inf), ([-math.inf, 0], [-math.inf, 0]),
        ({"pose": np.zeros(3), "to": (1,)}, {"pose": [0.0] * 3, "to": [1]}),
        (Message(0, "a", 0.0, 1), [0, "a", 0.0, 1]),
    ],
)  # fmt: skip
def test_numbers_text_lists_dicts_and_arrays_arrive(content, arrives):
    world = World(team(2))
    world.robots[0].send(content)
    stand(world)
    (found,) = heard(world)[1]
    assert found == arrives
    assert type(found) is type(arrives)


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(
        st.characters(exclude_categories=["Cs"])),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(
        st.text(st.characters(exclude_categories=["Cs"])), inner, max_size=4),
    max_leaves=12,
)  # fmt: skip


@given(JSON)
def test_what_json_knows_arrives_as_it_was(content):
    assert json.loads(as_text(content)) == content


LOOP: list = [1]
LOOP.append({"again": LOOP})


@each_case(
    ("content", "words"),
    [
        ({"goal": object()}, ["it holds <object", "can't be recorded", "lists, tuples and dicts"]),
        (np.array([1j]), ["can't be recorded"]),
        (b"bytes", ["can't be recorded"]),
        (LOOP, ["can't be recorded"]),
        ("x" * MAX_BYTES, [f"{MAX_BYTES + 2} bytes, of at most {MAX_BYTES}"]),
        ("\ud800", ["can't be recorded"]),
    ],
)
def test_what_cannot_be_recorded_cannot_be_sent(content, words):
    with pytest.raises(LawError) as caught:
        World(team(2)).robots[0].send(content)
    for word in words:
        assert word in str(caught.value)
    assert len(str(caught.value)) < 400


def test_each_receiver_has_a_copy_of_its_own():
    world = World(team(3))
    mine = [1, 2]
    world.robots[0].send(mine)
    mine.append(3)  # after it was sent
    stand(world)
    world.observe()
    world.robots[1].inbox[0].content.append("changed")
    assert contents(world.robots[2]) == [[1, 2]]
    assert json.loads(world.record.contents[0]) == [1, 2]


# -- in reach -------------------------------------------------------------------------------------


def test_who_is_in_reach_is_judged_when_the_message_is_sent():
    runner = {"robot": {"drive": Holonomic(max_linear_speed=100.0)}}
    world = World(team(2, talk=Communication(range=1.0, delay=0.3), **runner))
    world.robots[0].send("near", to=1)
    world.step([[0, 50.0], [0, 0]])
    assert world.pose[0, 1] == pytest.approx(6.0)
    world.robots[0].send("far", to=1)
    for _ in range(2):
        stand(world)
    assert heard(world)[1] == ["near"]
    stand(world)
    assert heard(world)[1] == []


@each_case("seed", range(4))
@each_case("rule", [Within(1.2), Nearest(3), Ahead(), Everyone()])
def test_a_message_reaches_those_in_range_whose_neighbour_its_sender_is(rule, seed):
    grid = np.stack(np.divmod(np.arange(169), 13), axis=1) / 4  # many are equally far apart
    places = np.random.default_rng(seed).permutation(grid)[:25]
    robots = [Robot(pose=(x, y, 0), diameter=0.01) for x, y in places.tolist()]
    talk = Communication(range=0.75, neighbours_only=True)
    world = World(team(robots=robots, addons=[talk], neighbours=rule, physics="ideal"))
    for robot in world.robots:
        robot.send("all")
        robot.send("you", to=[i for i in (3, 17) if i != robot.index])
    stand(world)

    def reached(sender, i):
        near = math.dist(places[sender], places[i]) <= 0.75
        return near and sender in world.neighbour_indices(i)

    rows = world.record.messages
    for sender in range(25):
        of = rows[rows["sender"] == sender]
        broadcast = [i for i in range(25) if i != sender and reached(sender, i)]
        named = [i for i in (3, 17) if i != sender]
        assert of["receiver"].tolist() == broadcast + named
        status = [ON_ITS_WAY if reached(sender, i) else OUT_OF_REACH for i in named]
        assert of["status"].tolist() == len(broadcast) * [ON_ITS_WAY] + status


# -- delay ----------------------------------------------------------------------------------------


@each_case(
    ("delay", "steps"),
    [(0.0, 1), (0.05, 1), (0.1, 1), (0.11, 2), (0.2, 2), (0.3, 3), (0.6, 6), (0.65, 7), (1.7, 17)],
)
def test_a_message_arrives_at_the_first_control_step_that_is_a_delay_later(delay, steps):
    world = World(team(2, talk=Communication(delay=delay)))
    stand(world)
    world.robots[0].send("x")
    arrived = []
    for _ in range(19):
        stand(world)
        if heard(world)[1]:
            arrived.append(world.iteration)
    assert arrived == [1 + steps]
    (row,) = world.record.messages
    assert row["time"] == world.history.time[1]
    assert row["arrival"] == world.history.time[1 + steps]
    assert row["status"] == DELIVERED


# -- losses ---------------------------------------------------------------------------------------


def lost(record: Record) -> np.ndarray:
    return record.messages["status"] == LOST


def test_a_lost_message_never_arrives_and_the_sender_is_not_told():
    world = World(team(2, talk=Communication(loss=1.0)))
    assert world.robots[0].send("x") is None
    stand(world)
    assert heard(world) == [[], []]
    assert world.record.messages["status"].tolist() == [LOST]
    assert np.isnan(world.record.messages["arrival"]).all()


BURST = Burst(good=2.5, bad=0.5)
LINKS = 20


@pytest.mark.slow
@pytest.mark.parametrize("dt", [0.1, 0.02])
def test_bursts_lose_as_much_and_last_as_long_at_any_sampling_time(dt):
    """A message goes over each link at each control step."""

    def say(world):
        for i, robot in enumerate(world.robots):
            robot.send(0, to=(i + 1) % LINKS)

    scenario = team(LINKS, talk=Communication(burst=BURST), sampling_time=dt, physics="ideal")
    gone = lost(talking(scenario.replace(stop_time=1500 * dt), say)).reshape(-1, LINKS)
    assert BURST.mean_loss == pytest.approx(1 / 6)
    q = math.exp(-dt * (1 / 0.5 + 1 / 2.5))  # what is left of the knowledge after a step
    # Losses that stick together leave (1 + q) / (1 - q) as much to chance as losses by themselves.
    chance = math.sqrt(5 / 36 / gone.size * (1 + q) / (1 - q))
    assert gone.mean() == pytest.approx(1 / 6, abs=4 * chance)
    edges = np.flatnonzero(np.diff(np.pad(gone, ((1, 1), (0, 0))).T.ravel().astype(int)))
    lengths = (edges[1::2] - edges[::2]) * dt
    end = (1 - q) * 5 / 6  # the probability that a bad link is good a step later
    mean, spread = dt / end, math.sqrt(1 - end) * dt / end  # of a geometric distribution, s
    assert lengths.mean() == pytest.approx(mean, abs=4 * spread / math.sqrt(len(lengths)))
    assert lengths.std() == pytest.approx(spread, rel=0.15)


# -- bandwidth ------------------------------------------------------------------------------------


def test_messages_are_sent_one_after_another_and_what_would_wait_for_over_a_second_is_dropped():
    def say(world):
        if world.iteration in (0, 5):
            world.robots[0].send("12345678")  # 10 bytes with the quotes, though two hear it: 0.5 s
            world.robots[0].send("123456789")  # 11: 1.05 s in all
            world.robots[0].send("12345678")  # 20: just a second
            world.robots[1].send(1)  # the bandwidth is each robot's own

    record = talking(team(3, talk=Communication(bandwidth=20, delay=0.1), stop_time=2.0), say)
    rows = record.messages[::2]  # for the first receiver of each
    assert rows["size"].tolist() == 2 * [10, 11, 10, 1]
    dropped = [False, True, False, False, False, True, True, False]  # 10 bytes were left at 0.5 s
    assert (rows["status"] == OVER_BANDWIDTH).tolist() == dropped
    arrival = [0.6, math.nan, 1.1, 0.2, 1.6, math.nan, math.nan, 0.7]
    assert rows["arrival"].tolist() == pytest.approx(arrival, nan_ok=True)


def test_a_bandwidth_lets_as_many_bytes_through_at_each_sampling_time():
    """Each control step offers 62 bytes: 620 or 6,200 in a second, of which 310 are sent."""
    got = {}
    for dt in (0.1, 0.01):
        talk = Communication(bandwidth=310)
        scenario = team(2, talk=talk, sampling_time=dt, stop_time=20.0)
        rows = talking(scenario, lambda world: world.robots[0].send("x" * 60)).messages
        got[dt] = rows["size"][rows["status"] == DELIVERED].sum()
        late = rows["arrival"] - rows["time"]
        assert np.nanmax(late) == pytest.approx(1.0)  # the last of a full second to be sent
    assert got == {0.1: 20 * 310, 0.01: 20 * 310}


# -- order and seeds ------------------------------------------------------------------------------


def test_an_inbox_is_ordered_by_sender_and_then_as_sent():
    world = World(team(4))
    for i in (2, 0, 1):
        for k in range(2):
            world.robots[i].send((i, k), to=3)
    stand(world)
    assert heard(world)[3] == [[0, 0], [0, 1], [1, 0], [1, 1], [2, 0], [2, 1]]


@pytest.mark.parametrize("talk", [Communication(loss=0.4), Communication(burst=Burst(good=0.8))])
def test_what_is_lost_depends_on_the_seed_and_not_on_the_order_in_which_robots_send(talk):
    def in_order(order, seed=0):
        def say(world):
            for i in order:
                world.robots[i].send((i, world.time))

        return talking(team(3, talk=talk, stop_time=5.0), say, seed)

    records = [in_order(order) for order in ((0, 1, 2), (2, 0, 1), (1, 2, 0))]
    assert len({record.digest for record in records}) == 1
    assert 50 < lost(records[0]).sum() < 306
    assert not np.array_equal(lost(records[0]), lost(in_order((0, 1, 2), seed=1)))


# -- the record -----------------------------------------------------------------------------------


@pytest.fixture
def chatter() -> Record:
    def say(world):
        world.robots[0].send({"at": world.robots[0].pose, "note": "ü"})
        if world.iteration % 4 == 0:
            world.robots[2].send(None, to=[0, 1])

    talk = Communication(range=1.5, delay=0.25, loss=0.2, bandwidth=1000)
    return talking(team(3, talk=talk), say, seed=5)


def test_messages_and_contents_come_back_from_a_file_to_the_last_bit(chatter, tmp_path):
    again = mars2d.load(chatter.save(tmp_path / "a.npz"))
    assert again.messages.tobytes() == chatter.messages.tobytes()
    assert again.contents == chatter.contents
    assert again.digest == chatter.digest
    assert again.scenario.addons == chatter.scenario.addons
    assert rerun(again) is None
    for row in (0, 3, 20):
        ours, theirs = chatter.frame(row).messages, again.frame(row).messages
        assert ours.tobytes() == theirs.tobytes()


# -- descriptions ---------------------------------------------------------------------------------


@each_case(
    ("make", "words"),
    [
        (lambda: Communication(loss=1.5), "Communication.loss = 1.5: expected a number >= 0"),
        (lambda: Communication(delay=-1), "Communication.delay = -1"),
        (lambda: Communication(burst=Burst), "write Burst(...)"),
        (lambda: Burst(good=0), "Burst.good = 0: expected a number > 0 and <= 1e+06 [s]"),
        (lambda: team(addons=[Communication(), Communication(name="a")]), "robots talk over one"),
    ],
)  # fmt: skip
def test_what_makes_no_channel_is_refused(make, words):
    with pytest.raises(InputError) as caught:
        make()
    assert words in str(caught.value)


# -- drawing --------------------------------------------------------------------------------------


def test_a_message_that_arrives_is_an_arrow_from_rim_to_rim():
    world = World(team(2, gap=2.0))
    to_one(world)
    stand(world)
    line, arrow = messages(world.frame).shapes
    assert isinstance(line, Line)
    assert isinstance(arrow, Arrow)
    start, end = line.points
    assert start[0] == pytest.approx(0.15)
    assert end[0] == pytest.approx(1.85)
    assert start[1] == end[1] < 0  # on the right, so that the way back can be seen, too
    assert arrow.tip == pytest.approx(tuple(end))
    assert arrow.fill.startswith(world.scenario.colors[0])
