"""Figures of columns over time show the columns, and say what they are."""

from __future__ import annotations

import dataclasses
from io import BytesIO

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_hex
from matplotlib.legend import Legend

import mars2d
from mars2d import Car, Holonomic, InputError, Record, Robot, Scenario
from mars2d.bodies.props import Puck
from mars2d.output.signals import signals, signals_of_bodies
from mars2d.record.contact import net_forces
from mars2d.sensors import Bumper, Imu, LineCamera, Proximity, RangeFinder
from tests.cases import each_case


def law(world):
    return [[0.3, 0.2], [0.2 * np.sin(world.time), 0.5]]


@pytest.fixture(scope="module")
def record() -> Record:
    sensors = [Proximity(range=1.0), Imu(), Bumper(sectors=4)]
    scenario = Scenario(
        title="Ann and Bob",
        robots=[
            Robot(pose=(-3, 0, 0), name="ann", sensors=[*sensors, RangeFinder(beams=36, range=6)]),
            Robot(pose=(1, 0, 0), name="bob", sensors=[*sensors, LineCamera(pixels=16)]),
        ],
        props=[Puck(pose=(-2.5, 0, 0), name="puck")],
        stop_time=8,
        on_exit="wall",
    )
    return mars2d.run(scenario, control=law)


def data(ax):
    return [line.get_xydata() for line in ax.lines]


def test_by_default_there_are_the_pose_and_the_command(record):
    axes = record.plot_signals()
    labels = [" ".join(ax.get_ylabel().split()) for ax in axes]
    assert labels == ["x [m]", "y [m]", "theta [rad]", "command v [m/s]", "command omega [rad/s]"]
    for k, ax in enumerate(axes[:3]):
        for i, points in enumerate(data(ax)):
            np.testing.assert_array_equal(points.T, [record.time, record.pose[:, k, i]])
    assert [ax.get_xlabel() for ax in axes] == ["", "", "", "", "time [s]"]
    assert len({ax.get_xlim() for ax in axes}) == 1


def test_robots_have_their_colours_and_names(record):
    (ax,) = record.plot_signals("x")
    assert [to_hex(line.get_color()) for line in ax.lines] == list(record.scenario.colors)
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["ann", "bob"]
    assert ax.get_title(loc="left") == "Ann and Bob"


def test_a_command_holds_until_the_next_and_an_effort_since_the_last(record):
    command, effort = record.plot_signals("command.omega", "effort", robots=["bob"])
    np.testing.assert_array_equal(data(command)[0][:, 1], record.command[:, 1, 1])
    np.testing.assert_array_equal(data(effort)[0][:, 1], record.effort[:, 1])
    assert command.lines[0].get_drawstyle() == "steps-post"
    assert effort.lines[0].get_drawstyle() == "steps-pre"
    assert effort.get_ylim()[1] > 1


def test_the_speed_is_the_way_since_the_row_before_over_the_sampling_time():
    scenario = Scenario(robots=[Robot(drive=Holonomic())], stop_time=1)
    run = mars2d.run(scenario, control=lambda world: [[0.3], [-0.4]])
    (ax,) = run.plot_signals("speed")
    speed = data(ax)[0][:, 1]
    assert np.isnan(speed[0])
    np.testing.assert_allclose(speed[1:], 0.5)


@each_case(
    "drives, names",
    [
        ([Holonomic(), Holonomic()], ["command vx [m/s]", "command vy [m/s]"]),
        ([Car(), Car()], ["command v [m/s]", "command delta [rad]"]),
        ([Car(), Holonomic()], ["command.0 [unit of the drive]", "command.1 [unit of the drive]"]),
    ],
)
def test_commands_have_the_names_on_which_all_drives_agree(drives, names):
    robots = [Robot(pose=(x, 0, 0), drive=drive) for x, drive in enumerate(drives)]
    run = mars2d.run(Scenario(robots=robots, stop_time=1), control=lambda world: 0 * world.command)
    assert [" ".join(ax.get_ylabel().split()) for ax in run.plot_signals("command")] == names


def test_energy_has_a_curve_for_all_that_did_work_and_momentum_its_two_parts(record):
    energy, kinetic = record.plot_signals("energy", "kinetic")
    total, *works = [points[:, 1] for points in data(energy)]
    mass = np.array([body.inertia.mass for body in record.scenario.bodies])
    moment = np.array([body.inertia.moment for body in record.scenario.bodies])
    vx, vy, omega = np.moveaxis(np.concatenate([record.velocity, record.prop_velocity], -1), 1, 0)
    each = (mass * (vx**2 + vy**2) + moment * omega**2) / 2
    np.testing.assert_allclose(total, each.sum(axis=1), atol=1e-12)
    np.testing.assert_allclose(np.transpose([p[:, 1] for p in data(kinetic)]), each, atol=1e-12)
    assert len(works) >= 3, "drives, floor and impacts"
    np.testing.assert_allclose(sum(works), total - total[0], atol=1e-9)
    legends = [child for child in energy.get_children() if isinstance(child, Legend)]
    names = {text.get_text() for legend in legends for text in legend.get_texts()}
    assert {"kinetic, of all", "work of drives", "work of floor", "ann", "puck"} <= names

    linear, angular = record.plot_signals("momentum")
    x, y = (points[:, 1] for points in data(linear))
    np.testing.assert_allclose(x, (mass * vx).sum(axis=1), atol=1e-12)
    np.testing.assert_allclose(y, (mass * vy).sum(axis=1), atol=1e-12)
    np.testing.assert_array_equal(data(angular)[0][:, 1], record.momentum.angular)


def test_quantities_of_a_sensor_have_a_panel_each_or_are_chosen_by_name(record):
    axes = record.plot_signals("imu")
    labels = [" ".join(ax.get_ylabel().split()) for ax in axes]
    assert labels == ["imu ax [m/s^2]", "imu ay [m/s^2]", "imu omega [rad/s]"]
    (one,) = record.plot_signals("imu.omega", robots=["bob"])
    np.testing.assert_array_equal(data(one)[0][:, 1], record.sensors["imu"][:, 1, 2])


def test_flags_are_bars_where_they_are_true(record):
    (ax,) = record.plot_signals("proximity")
    bars = [c for c in ax.collections if isinstance(c, PolyCollection)]
    assert len(bars) == 2
    for k, (bar, color) in enumerate(zip(bars, record.scenario.colors, strict=True)):
        flags = record.sensors["proximity"][:, k]
        length = sum(np.ptp(path.vertices[:, 0]) for path in bar.get_paths())
        assert length == pytest.approx(0.1 * flags.sum(), abs=0.1)
        assert to_hex(bar.get_facecolor()[0]) == color if flags.any() else not bar.get_paths()
    assert [text.get_text() for text in ax.get_yticklabels()] == ["bob", "ann"]
    (ring,) = record.plot_signals("bumper", robots=["ann"])
    assert [t.get_text() for t in ring.get_yticklabels()] == ["ann 3", "ann 2", "ann 1", "ann 0"]


def with_effort(record, effort):
    effort = np.asarray(effort, dtype=float)
    rows = np.zeros(len(effort))
    return dataclasses.replace(
        record,
        scenario=Scenario(robots=1),
        time=0.1 * np.arange(len(effort)),
        pose=np.zeros((len(effort), 3, 1)),
        command=np.zeros((len(effort), 2, 1)),
        prop_pose=np.zeros((len(effort), 3, 0)),
        command_time=rows,
        effort=effort[:, None],
        sensors={},
        sensor_robots={},
        contacts=record.contacts[:0],
    )


def test_from_pi_to_minus_pi_there_is_no_line(record):
    angles = np.array([[3.1], [-3.1], [-3.0]])
    run = with_effort(record, [0, 0, 0])
    scenario = Scenario(robots=[Robot(sensors=[mars2d.sensors.RangeBearing(name="seen")])])
    values = np.stack([np.ones((3, 1)), angles], axis=2)[:, :, None]  # (T, 1, 1, 2)
    run = dataclasses.replace(
        run, scenario=scenario, sensors={"seen": values}, sensor_robots={"seen": (0,)}
    )
    (ax,) = run.plot_signals("seen.bearing")
    np.testing.assert_array_equal(ax.lines[0].get_ydata(), [3.1, np.nan, -3.1, -3.0])


def test_a_million_rows_are_drawn_small_and_without_losing_a_peak(record):
    effort = np.random.default_rng(1).uniform(0, 0.5, 1_000_000)
    effort[123_457] = 1.0
    run = with_effort(record, effort)
    (ax,) = run.plot_signals("effort")
    file = BytesIO()
    ax.figure.savefig(file, format="pdf")
    assert len(file.getvalue()) < 200_000
    points = data(ax)[0]
    assert len(points) < 6000
    np.testing.assert_allclose(points[points[:, 1].argmax()], [12345.7, 1.0])


@each_case(
    "columns, robots, message",
    [
        (["efort"], None, r"columns: there is no 'efort'; did you mean 'effort'\?"),
        (["prop.x", "prop.speed"], ["ann"], r"robots: all columns that were chosen are of props"),
        (["prop.z"], None, r"columns: there is no 'prop.z'; did you mean 'prop.[xy]'\?"),
        ([3], None, "columns = 3: expected names of columns"),
        (["x.y"], None, "x has no parts"),
        (["command.vy"], None, "'command.vy': command has no 'vy'; did you mean 'v'"),
        (["imu.omga"], None, r"'imu.omga': 'omga': expected an index from 0 to 2 or ax or ay"),
        (["range_finder.36"], None, "'36': expected an index from 0 to 35"),
        (["proximity.0"], None, "expected 'proximity' alone"),
        (["range_finder"], None, r"'range_finder' has readings of shape \(36,\): choose a part"),
        (["range_finder"], ["bob"], "none of the robots chosen has it; ann do"),
        (["x"], ["bub"], r"robots: there is no robot 'bub'; did you mean 'bob'\?"),
        (["x"], [2], "robots: there is no robot 2; they are 0 to 1"),
        (["x"], [], "robots = .*: expected names or indices"),
        (["x"], [True], "robots = True: expected the name of a robot or its index"),
        (["x"] * 17, None, "they need 17 panels, and a figure has at most 16"),
    ],
)
def test_what_is_not_there_is_said_with_the_nearest_that_is(record, columns, robots, message):
    with pytest.raises(InputError, match=message):
        record.plot_signals(*columns, robots=robots)


def test_a_part_of_the_run_is_drawn_to_its_own_limits(record):
    columns = ["x", "effort", "proximity", "range_finder.3", "speed"]
    axes = record.plot_signals(*columns, robots=["ann"], start=0.5, end=2)
    axes[0].figure.canvas.draw()
    assert {ax.get_xlim() for ax in axes} == {(0.5, 2.0)}
    part = record.pose[5:21, 0, 0]
    np.testing.assert_array_equal(data(axes[0])[0], np.transpose([record.time[5:21], part]))
    low, high = axes[0].get_ylim()
    assert part.min() - 0.2 < low <= part.min() < part.max() <= high < part.max() + 0.2
    whole = record.plot_signals("speed", robots=["ann"])[0]
    np.testing.assert_array_equal(data(axes[4])[0], data(whole)[0][5:21])


# -- contacts and distances -----------------------------------------------------------------------


def test_force_and_impulse_are_those_of_the_contacts_in_the_step_before(record):
    (force,), (impulse,) = (signals(record, [name], None) for name in ("force", "impulse"))
    np.testing.assert_allclose(impulse.values, force.values * record.scenario.sampling_time)
    net = net_forces(record.pair_forces, force.bodies, range(len(record)))
    np.testing.assert_array_equal(force.values, np.hypot(net[:, 0], net[:, 1]))
    assert force.values.max() > 0.1


def test_signals_of_bodies_are_of_robots_and_props_alike(record):
    n = len(record.scenario.robots)
    (x,) = signals_of_bodies(record, "x", (0, n))
    np.testing.assert_array_equal(x.values[:, 0], record.pose[:, 0, 0])
    np.testing.assert_array_equal(x.values[:, 1], record.prop_pose[:, 0, 0])
    (own,) = signals_of_bodies(record, "momentum.each", (n,))
    expected = np.hypot(*record.momentum.linear[:, :, n].T)
    np.testing.assert_allclose(own.values[:, 0], expected)
    (far,) = signals_of_bodies(record, "distance.ann", (0, 1, n))
    assert far.bodies == (1, n)
    apart = record.pose[:, :2, 1] - record.pose[:, :2, 0]
    np.testing.assert_allclose(far.values[:, 0], np.hypot(*apart.T))
    with pytest.raises(InputError, match="'effort' is of robots"):
        signals_of_bodies(record, "effort", (n,))
    with pytest.raises(
        InputError, match=r"there is no 'distance\.an'; did you mean 'distance\.ann'"
    ):
        signals_of_bodies(record, "distance.an", (1,))
    with pytest.raises(InputError, match="a body other than ann"):
        signals_of_bodies(record, "distance.ann", (0,))
