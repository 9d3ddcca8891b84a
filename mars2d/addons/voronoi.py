"""Voronoi cells of the robots: the part of the workspace to which each is nearest."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.base import Addon
from mars2d.core.description import number
from mars2d.core.errors import InputError
from mars2d.core.interfaces import FrameLike, ScenarioLike, WorldLike
from mars2d.core.plane import Outline
from mars2d.core.scene import THEORY, Scene, faded
from mars2d.geometry.voronoi import Tessellation, Weight

EDGE = "#5b6470b0"


class Voronoi(Addon):
    """The workspace divided among the robots: each cell holds the points nearest to its robot.

    >>> from mars2d import Robot, Scenario, World
    >>> team = [Robot(pose=(-2, 0)), Robot(pose=(2, 0))]
    >>> World(Scenario(robots=team, addons=[Voronoi()])).addons.voronoi.now.centroids.tolist()
    [[-2.5, 2.5], [0.0, 0.0]]

    Laws find the cells of this instant in ``world.addons.voronoi.now``, a
    `mars2d.geometry.voronoi.Tessellation`; those of a record are ``voronoi.of(record.frame(row))``.
    The workspace may be of any shape. With a Density in the scenario masses, centroids and the
    cost are weighted by it.

    The cells are drawn in their robots' colours, and the centroids where theory is shown. A saved
    record has no functions: a Density is lost with it, and the cells of the loaded record are not
    weighted.
    """

    resolution: float | None = number(
        default=None, above=0, high=1e6, unit="m", optional=True,
        doc="of sums over a density, see Tessellation; None: 1/12 of the workspace's longer side",
    )  # fmt: skip

    def of(self, frame: FrameLike) -> Tessellation:
        """Return the cells at one instant, live or of a record."""
        return self._weighed(frame.scenario, frame.pose[:2])

    def on_start(self, world: WorldLike) -> None:
        """Take the world, and refuse a scenario that can't be divided."""
        self._world, self._found = world, (0, self._weighed(world.scenario, world.position))

    @property
    def now(self) -> Tessellation:
        """The cells at this instant, computed once a control step."""
        if "_world" not in self.__dict__:
            raise InputError(
                "Voronoi has cells in a world only, as world.addons.voronoi.now; those of a record "
                "are voronoi.of(record.frame(row))"
            )
        if self._found[0] != (now := self._world.iteration):
            self._found = now, self._weighed(self._world.scenario, self._world.position)
        return self._found[1]

    def _weighed(self, scenario: ScenarioLike, position: NDArray[np.float64]) -> Tessellation:
        weight = next((addon for addon in scenario.addons if isinstance(addon, Weight)), None)
        return Tessellation(position, _region(scenario), weight, self.resolution)

    def draw(self, scene: Scene, frame: FrameLike) -> None:
        """Draw the cells, each in its robot's colour."""
        import shapely

        found = Tessellation(frame.pose[:2], _region(frame.scenario))
        for cell, color in zip(found.cells, frame.scenario.colors, strict=True):
            for piece in shapely.get_parts(cell):
                scene.polygon(shapely.get_coordinates(piece)[:-1], fill=faded(color, 0.14))
        for pieces in found.edges.values():
            for ends in pieces:
                scene.line(ends, stroke=EDGE, width=0.8)

    def theory(self, scene: Scene, frame: FrameLike) -> None:
        """Draw the centroids, each with a line to its robot."""
        try:
            centroids = self.of(frame).centroids
        except InputError:  # a saved record has no functions, and so perhaps not its Density
            return
        for place, centroid in zip(frame.pose[:2].T, centroids.T, strict=True):
            scene.line([place, centroid], stroke=THEORY, width=1.2, style="--")
            scene.circle(centroid, 0.0, fill="#ffffff", stroke=THEORY, width=1.4, pixels=3.0)


def _region(scenario: ScenarioLike) -> Outline:
    if scenario.workspace is None:
        raise InputError(
            "Scenario.workspace = None: expected a polygon, which Voronoi divides among the "
            "robots; with on_exit='ignore' they may leave it"
        )
    return scenario.workspace
