"""The layers of a picture in drawing order, and which of them are switched on."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import takewhile
from operator import attrgetter
from typing import Self

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Scene
from mars2d.output.layers.addons import addons, floor, sensors, theory
from mars2d.output.layers.bodies import (
    draw_name,
    initial_poses,
    joints,
    place_prop,
    place_ring,
    place_robot,
)
from mars2d.output.layers.forces import forces
from mars2d.output.layers.ground import edge, obstacles, workspace
from mars2d.output.layers.impulses import impulses
from mars2d.output.layers.messages import messages
from mars2d.output.layers.neighbours import neighbours, place_range
from mars2d.output.layers.trails import trails
from mars2d.output.layers.velocities import velocities
from mars2d.record.frame import Frame
from mars2d.scenario.animation import Animation
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]


def _of_scenario(shapes: Callable[[Scenario], Scene]) -> Callable[[Frame], Scene]:
    """Return a layer's function of the frame, for a layer that depends on the scenario alone."""
    return lambda frame: shapes(frame.scenario)


def of_bodies(each: Callable[[Scene, Scenario, int, Float], None]) -> Callable[[Frame], Scene]:
    """Return a layer's function of the frame, for one that draws body by body; see `Layer.each`."""

    def shapes(frame: Frame) -> Scene:
        scene, bodies, n = Scene(), [*enumerate(frame.all_poses.T)], frame.pose.shape[1]
        for body, pose in (*bodies[n:], *bodies[:n]):  # the last name is never left out
            each(scene, frame.scenario, body, pose)
        return scene

    return shapes


@dataclass(frozen=True, kw_only=True)
class Layer:
    """One layer of a picture.

    name: in code. title: for people. shapes: returns the shapes of a frame; None for the grid,
    whose lines depend on the scale, so that each painter draws its own. key: the letter that
    switches the layer, if one does. switch: whether people may switch it; others are drawn as
    the animation says. at_first: whether it is on at first. stands: whether it is the same in all
    frames of a scenario; a painter may keep it. each: in place of shapes, draws one body's part of
    the layer, given its index in `Scenario.bodies` and its pose (3,), if it depends on nothing
    else. upright: whether that does not turn with the body. along: other layers that its key
    switches with it, by name.
    """

    name: str
    title: str
    shapes: Callable[[Frame], Scene] | None = None
    key: str = ""
    switch: bool = True
    at_first: Callable[[Animation], bool] = lambda _: True
    stands: bool = False
    each: Callable[[Scene, Scenario, int, Float], None] | None = None
    upright: bool = False
    along: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.each is not None:
            object.__setattr__(self, "shapes", of_bodies(self.each))


LAYERS: list[Layer] = [
    Layer(
        name="workspace", title="Workspace", shapes=_of_scenario(workspace), stands=True,
        switch=False,
    ),
    Layer(name="floor", title="Floor", shapes=_of_scenario(floor), stands=True, switch=False),
    Layer(
        name="grid", title="Grid", shapes=None, key="g", at_first=attrgetter("grid"), stands=True
    ),
    Layer(name="edge", title="Edge", shapes=_of_scenario(edge), stands=True, switch=False),
    Layer(
        name="obstacles", title="Obstacles", shapes=_of_scenario(obstacles), stands=True,
        switch=False,
    ),
    Layer(
        name="starts", title="Initial poses", shapes=initial_poses, stands=True,
        switch=False, at_first=attrgetter("show_initial_pose"),
    ),
    Layer(name="trails", title="Trails", shapes=trails, key="t", at_first=attrgetter("wake")),
    Layer(name="sensors", title="Sensors", shapes=sensors, key="s"),
    Layer(
        name="ranges", title="Ranges", at_first=attrgetter("ranges"),
        each=place_range,
    ),
    Layer(
        name="neighbours", title="Neighbours", shapes=neighbours,
        at_first=attrgetter("neighbours"),
    ),
    Layer(name="addons", title="Add-ons", shapes=addons, key="o"),
    Layer(name="theory", title="Theory", shapes=theory, key="y", at_first=attrgetter("theory")),
    Layer(name="messages", title="Messages", shapes=messages, key="m", along=("neighbours",)),
    Layer(name="props", title="Props", switch=False, each=place_prop),
    Layer(name="rings", title="Rings", switch=False, each=place_ring),
    Layer(name="robots", title="Robots", switch=False, each=place_robot),
    Layer(name="joints", title="Joints", shapes=joints, switch=False),
    Layer(
        name="velocities", title="Velocities", shapes=velocities, key="u", at_first=lambda _: False,
    ),
    Layer(
        name="impulses", title="Impulses", shapes=impulses, at_first=attrgetter("forces"),
    ),
    Layer(
        name="forces", title="Forces", shapes=forces, key="x", at_first=attrgetter("forces"),
        along=("impulses",),
    ),
    Layer(
        name="names", title="Names", key="i", at_first=attrgetter("names"),
        each=draw_name, upright=True,
    ),
]  # fmt: skip
"""All layers, the lowest first. A new one is a function in a file of its own, and a line here."""


FIRST_BODIES, LAST_BODIES = "props", "joints"
"""The lowest and the highest of the layers that show bodies."""


def standing() -> list[Layer]:
    """Return the lowest layers, those that all stand still: a painter may keep their picture."""
    return list(takewhile(lambda layer: layer.stands, LAYERS))


@dataclass(frozen=True, init=False)
class Layers:
    """The switches of a picture: one attribute for each layer that people may switch.

    >>> Layers(grid=False).grid, Layers().grid, Layers().names
    (False, True, False)
    """

    on: frozenset[str]

    def __init__(self, on: frozenset[str] | None = None, **switches: bool) -> None:
        """Start with `on`, by default the layers that are on at first; switches: by name."""
        if on is None:
            on = Layers.of(Animation()).on
        unknown = switches.keys() - {layer.name for layer in LAYERS if layer.switch}
        if unknown:
            raise TypeError(f"no layer to switch: {', '.join(sorted(unknown))}")
        now_on = {name for name, wanted in switches.items() if wanted}
        object.__setattr__(self, "on", (on - switches.keys()) | now_on)

    @classmethod
    def of(cls, animation: Animation, **switches: bool) -> Self:
        """Return the switches that an experiment starts with, but for some."""
        first = (layer.name for layer in LAYERS if layer.switch and layer.at_first(animation))
        return cls(frozenset(first), **switches)

    def __getattr__(self, name: str) -> bool:
        """Return whether the layer of this name is on."""
        if any(layer.name == name and layer.switch for layer in LAYERS):
            return name in self.on
        raise AttributeError(name)

    def switched(self, **switches: bool) -> Self:
        """Return the same but for some switches, each by its layer's name."""
        return type(self)(self.on, **switches)

    def toggled(self, name: str, *, alone: bool = False) -> Self:
        """Return the same, but a layer the other way round, and those along with it or `alone`."""
        along = () if alone else next(layer.along for layer in LAYERS if layer.name == name)
        return self.switched(**dict.fromkeys((name, *along), not getattr(self, name)))

    def seen(self, animation: Animation) -> Iterator[Layer]:
        """Yield the layers that are drawn, the lowest first."""
        for layer in LAYERS:
            if layer.name in self.on if layer.switch else layer.at_first(animation):
                yield layer
