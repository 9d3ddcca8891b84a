"""Figures of contacts show who touched whom from when to when, and how hard."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.collections import PolyCollection

import mars2d
from mars2d import Robot, Scenario
from mars2d.addons import Map
from mars2d.output.figures.contacts import normal_force
from tests.cases import each_case


def meet(**changes):
    """Two that meet at t = 2 s and press on with 5 N each."""
    robots = [Robot(pose=(-0.55, 0, 0), name="ann"), Robot(pose=(0.55, 0, np.pi), name="bob")]
    scenario = Scenario(**({"title": "They meet", "robots": robots, "stop_time": 5} | changes))
    speed = [0.2] * len(scenario.robots)
    return mars2d.run(scenario, control=lambda world: [speed, [0.0] * len(speed)])


def bars(ax):
    (found,) = [c for c in ax.collections if isinstance(c, PolyCollection)]
    return found


def spans(ax):
    """From when to when there are bars on each line, from the top."""
    vertices = [path.vertices for path in bars(ax).get_paths()]
    lines = {}
    for v in vertices:
        begin, end = lines.get(round(v[0, 1], 3), (np.inf, -np.inf))
        lines[round(v[0, 1], 3)] = min(begin, v[:, 0].min()), max(end, v[:, 0].max())
    return [lines[key] for key in sorted(lines, reverse=True)]


def names(ax):
    return [text.get_text() for text in ax.get_yticklabels()][::-1]


def test_a_bar_lasts_as_long_as_the_touch():
    upper, lower = meet().plot_contacts()
    assert names(upper) == ["ann \N{EN DASH} bob"]
    ((begin, end),) = spans(upper)
    assert begin == pytest.approx(2.0, abs=0.01)
    assert end == pytest.approx(5.0, abs=0.03)
    assert (upper.get_xlabel(), lower.get_xlabel()) == ("", "time [s]")
    assert upper.get_title(loc="left") == "They meet"


def test_the_colour_is_the_mean_normal_force_in_newtons():
    record = meet()
    upper, _ = record.plot_contacts()
    forces = bars(upper).get_array()
    assert forces[-1] == pytest.approx(5.0, rel=1e-6), "the drives' bound"
    assert forces.max() == pytest.approx(record.contacts["normal_impulse"].max() / 0.1)
    assert upper.child_axes[0].get_ylabel() == "normal force [N]"


def test_the_sum_is_that_of_all_pairs_over_each_control_step():
    robots = [Robot(pose=(x, y, 0 if x < 0 else np.pi)) for y in (-1, 0, 1) for x in (-0.55, 0.55)]
    record = meet(robots=robots)
    force = normal_force(record)
    assert force[:20].max() == 0
    assert force[-1] == pytest.approx(3 * 5.0)
    _, lower = record.plot_contacts()
    np.testing.assert_array_equal(lower.lines[0].get_ydata(), force)
    assert lower.lines[0].get_drawstyle() == "steps-pre"


def test_obstacles_and_walls_are_named():
    robots = [Robot(pose=(-4.5, 0, np.pi), name="a"), Robot(pose=(0, 0, 0), name="b")]
    record = meet(robots=robots, on_exit="wall", addons=[Map([[(0.4, -1), (0.4, 1)]])])
    upper, _ = record.plot_contacts()
    assert set(names(upper)) == {"a \N{EN DASH} wall", "b \N{EN DASH} obstacle 0"}
    assert record.scenario.body_name(-2) == "wall"


def test_without_contacts_the_figure_says_so():
    (ax,) = meet(stop_time=1).plot_contacts()
    assert "no contacts: nothing touched in 1 s" in [text.get_text() for text in ax.texts]
    assert not ax.axison
    ax.figure.canvas.draw()


@each_case("physics", ["stop", "ideal"])
def test_without_forces_the_bars_stand_alone(physics):
    axes = meet(physics=physics).plot_contacts()
    assert len(axes) == 1
    assert axes[0].child_axes == []
    assert spans(axes[0])[0][0] == pytest.approx(2.0, abs=0.1)
