"""Contact forces are summed in one place: they change momenta, and stand against other forces."""

from __future__ import annotations

import numpy as np
import pytest

import mars2d
from mars2d import Robot, Scenario, Unicycle
from mars2d.record.contact import CONTACT, net_forces, pair_forces

SQUARE = [(-1, -1), (1, -1), (1, 1), (-1, 1)]


def ahead(world):
    return [[0.2] * len(world.robots), [0.0] * len(world.robots)]


def forces_on(record, *bodies):
    """The net contact forces, (T, 2, k) newtons."""
    return net_forces(record.pair_forces, bodies, range(len(record)))


def test_a_pair_has_one_force_a_control_step_by_all_its_normals():
    contacts, rows = np.zeros(4, dtype=CONTACT), np.array([2, 1, 1, 1])
    contacts["a"], contacts["b"] = 0, [1, -1, -1, 1]
    contacts["normal"] = [(1, 0), (-1, 0), (0, -1), (1, 0)]
    contacts["normal_impulse"] = [0.1, 0.3, 0.4, 0.5]
    contacts["tangential_impulse"] = [0.2, 0, 0, 0]  # along the normal turned by +90 degrees
    contacts["time"], contacts["duration"] = [0.1, 0.02, 0.0, 0.05], [0.1, 0.01, 0.1, 0.0]
    found = pair_forces(contacts, rows, 0.1)
    assert found[["row", "a", "b"]].tolist() == [(1, 0, -1), (1, 0, 1), (2, 0, 1)]
    np.testing.assert_allclose(found["force"], [(-3, -4), (5, 0), (1, 2)])
    np.testing.assert_allclose(found["normal_force"], [7, 5, 1])
    assert found["time"].tolist() == [0.0, 0.05, 0.1]
    assert found["until"].tolist() == [0.1, 0.05, 0.2]
    net = net_forces(found, [1, 0], range(1, 4))
    np.testing.assert_allclose(net[..., 0], [(5, 0), (1, 2), (0, 0)])
    np.testing.assert_allclose(net[..., 1], [(-2, 4), (-1, -2), (0, 0)])
    assert len(pair_forces(contacts[:0], rows[:0], 0.1)) == 0
    assert net_forces(found[:0], [], range(2)).shape == (2, 2, 0)


def test_a_robot_that_stalls_presses_on_both_walls_of_a_corner_with_its_drives_bound():
    robot = Robot(pose=(0.5, 0.5, np.pi / 4), friction=0.0, drive=Unicycle(max_force=5))
    scenario = Scenario(robots=[robot], workspace=SQUARE, on_exit="wall", stop_time=5)
    record = mars2d.run(scenario, control=ahead)
    np.testing.assert_allclose(forces_on(record, 0)[-10:, :, 0], -5 / np.sqrt(2), rtol=1e-3)
    (last,) = record.pair_forces[record.pair_forces["row"] == len(record) - 1]
    assert (last["a"], last["b"]) == (0, -1), "a wall is one thing, with two normals here"
    assert last["normal_force"] == pytest.approx(2 * 5 / np.sqrt(2), rel=1e-3)
