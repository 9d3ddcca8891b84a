"""The add-on Voronoi: cells as laws and checks find them, weighed, drawn, and refused in words."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

import mars2d
from mars2d import Holonomic, LawError, Robot, Scenario, World
from mars2d.addons import Density, Voronoi
from mars2d.core.scene import Circle, Line, Polygon, Scene
from mars2d.geometry.voronoi import Tessellation

SQUARE = ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0))
STARTS = [(1, 1), (3, 1), (1.5, 3)]


def team(starts=STARTS, addons=(), **fields):
    robots = [Robot(drive=Holonomic()).at(x, y) for x, y in starts]
    fields = {"workspace": SQUARE, "stop_time": 2.0} | fields
    return Scenario(robots=robots, addons=[Voronoi(), *addons], **fields)


def lloyd(world):
    return world.addons.voronoi.now.centroids - world.position


# -- what laws find ---------------------------------------------------------------------------


def test_laws_find_the_cells_of_this_instant():
    world = World(team())
    for _ in range(3):
        cells = world.addons.voronoi.now
        assert world.addons.voronoi.now is cells
        found = Tessellation(world.position, SQUARE)
        assert cells.areas.tolist() == found.areas.tolist()
        assert cells.masses.tolist() == found.areas.tolist()
        assert cells.centroids.tolist() == found.centroids.tolist()
        assert cells.cost == found.cost
        assert shapely.equals(cells.cells, found.cells).all()
        assert [cells.neighbours(i) for i in range(3)] == [(1, 2), (0, 2), (0, 1)]
        assert cells.edge(0, 2) == found.edge(0, 2)
        world.step([[0.3, 0, -0.2], [0.1, 0.3, 0]])


def test_a_record_has_the_cells_that_the_law_saw():
    seen = []

    def law(world):
        seen.append((world.addons.voronoi.now.cost, world.addons.voronoi.now.centroids.tolist()))
        return lloyd(world)

    record = mars2d.run(team(), control=law)
    voronoi = record.scenario.addons[0]
    again = [voronoi.of(record.frame(row)) for row in range(len(record.time))]
    assert [(each.cost, each.centroids.tolist()) for each in again] == seen


def test_a_robot_at_anothers_place_and_one_that_has_left_are_no_error():
    starts = [(0.8, 1), (1.2, 1), (3.9, 1)]
    scenario = team(starts, physics="ideal", on_exit="ignore", stop_time=4.0)
    together = [[0.05, -0.05, 0.5], [0, 0, 0]]
    law = lambda world: together if world.time < 3.95 else lloyd(world)  # noqa: E731
    record = mars2d.run(scenario, control=law)
    assert record.pose[-1, 0] == pytest.approx([1, 1, 5.9])
    cells = record.scenario.addons[0].of(record.frame(-1))
    assert cells.areas == pytest.approx([13.8, 0, 2.2])
    assert cells.centroids[:, 1] == pytest.approx([1, 1])
    assert np.isfinite(record.command).all()


# -- weights ----------------------------------------------------------------------------------


def slope(x, y):
    return 1 + x


def test_the_only_density_of_a_scenario_weighs_the_cells():
    world = World(team(addons=[Density(slope)]))
    found = Tessellation(world.position, SQUARE, slope)
    assert world.addons.voronoi.now.masses.tolist() == found.masses.tolist()
    assert world.addons.voronoi.now.centroids.tolist() == found.centroids.tolist()
    assert world.addons.voronoi.now.areas == pytest.approx(
        Tessellation(world.position, SQUARE).areas
    )
    assert world.addons.voronoi.now.cost == world.scenario.addons[0].of(world.frame).cost


def test_what_a_density_does_wrong_on_the_way_is_an_error_of_its_function():
    def hole(x, y):  # only looked at once robots are at work
        return np.where(np.abs(x - y) < 1e-3, np.nan, 1.0) if len(x) < 20_000 else 1.0 + 0 * x

    scenario = team([(1, 1.1), (3, 3.2)], addons=[Density(hole)])
    world = World(scenario, control=lloyd)
    with pytest.raises(LawError, match=r"Density\.function: expected of phi\(x, y\) .* is nan at"):
        for _ in range(20):
            world.step()


# -- what is seen -----------------------------------------------------------------------------


def drawn(scenario, what="draw"):
    scene = Scene()
    getattr(scenario.addons[0], what)(scene, World(scenario).frame)
    return scene.shapes


def test_cells_are_drawn_in_their_robots_colours_with_an_edge_between_them():
    shapes = drawn(team())
    cells = [shape for shape in shapes if isinstance(shape, Polygon)]
    assert [cell.fill[:7] for cell in cells] == list(team().colors)
    assert sum(shapely.Polygon(cell.points).area for cell in cells) == pytest.approx(16)
    edges = [shape for shape in shapes if isinstance(shape, Line)]
    assert len(edges) == 3


def test_theory_shows_the_centroids():
    scenario = team()
    circles = [shape for shape in drawn(scenario, "theory") if isinstance(shape, Circle)]
    found = Tessellation(np.transpose(STARTS), SQUARE)
    assert [circle.center for circle in circles] == [tuple(c) for c in found.centroids.T.tolist()]
