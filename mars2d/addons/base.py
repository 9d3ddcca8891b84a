"""What an add-on is: hooks that the simulation calls at its four moments."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from mars2d.core import checks
from mars2d.core.description import Stateful, entry, snake_case, text
from mars2d.core.errors import InputError, nearest
from mars2d.core.materials import surface_friction, surface_restitution
from mars2d.core.plane import Outline, Point
from mars2d.core.scene import Scene

if TYPE_CHECKING:
    from mars2d.record.frame import Frame
    from mars2d.world.world import World

__all__ = ["HOOKS", "Addon", "Color", "hooks_of"]

Color = tuple[float, float, float]
"""Red, green and blue from 0 to 1."""

HOOKS = ("on_start", "on_step", "on_sensed", "on_draw", "on_stop")
"""All hooks of an add-on: MARS's Addons_suffix Initialize, Loop and Plot; sensing, and the end."""


class Addon(Stateful):
    """The base of all add-ons: derive, declare fields, and write the hooks you need.

    >>> class Counter(Addon):
    ...     def on_start(self, world):
    ...         self.steps = 0
    ...     def on_step(self, world):
    ...         self.steps += 1

    A hook is a method named on_start, on_step, on_sensed, on_draw or on_stop; any other ``on_...``
    is an error. In a scenario an add-on is frozen. Each world works on a copy of its own, on which
    hooks may set attributes; laws find it as ``world.addons.<name>``.
    """

    name: str | None = text(default=None, optional=True, doc="the name in world.addons")

    friction: float = entry(
        default=1.0, check=surface_friction,
        doc="of its obstacles, a number or a material's name; a contact has the product of both",
    )  # fmt: skip
    restitution: float = entry(
        default=1.0, check=surface_restitution,
        doc="of its obstacles, a number or a material's name; a contact has the product of both",
    )  # fmt: skip
    only_one: ClassVar[str] = ""
    """Why a scenario has no two of them, as "robots talk over one"; "": it may have several."""
    carries_messages: ClassVar[bool] = False
    """Whether robots talk over it: the inspector then shows their inboxes."""

    rng: ClassVar[np.random.Generator]
    """Its own random stream, on the copy that a world works on."""

    def __init_subclass__(cls, **kwargs: Any) -> None:
        for attribute in vars(cls):
            if attribute.startswith("on_") and attribute not in HOOKS:
                raise InputError(
                    f"{cls.__name__}.{attribute} is no hook of an add-on{nearest(attribute, HOOKS)}"
                )
        super().__init_subclass__(**kwargs)

    @property
    def key(self) -> str:
        """The name in ``world.addons``: `name`, or that of the class in snake case."""
        return self.name or snake_case(type(self).__name__)

    def _validate(self) -> None:
        checks.identifier(f"{type(self).__name__}.name", self.name, "world.addons.")

    @property
    def acts(self) -> bool:
        """Whether a run depends on it by more than its obstacles."""
        return bool(hooks_of(self))

    def obstacles(self) -> tuple[Outline, ...]:
        """Return the outlines that stand in the way: two vertices a wall, more a closed polygon."""
        return ()

    def beacons(self) -> Mapping[str, Point]:
        """Return where beacons are now, by name, for the sensor Beacon; here, none."""
        return {}

    def named_points(self, frame: Frame) -> list[tuple[str, Point]]:  # noqa: ARG002
        """Return points with their names, which the window shows under the pointer; here, none."""
        return []

    def ground(self, point: Point) -> Color | None:  # noqa: ARG002
        """Return the colour of the floor at a point, red, green and blue from 0 to 1.

        None: it says nothing of it. Of several add-ons the last that says something counts.
        """
        return None

    def paint(self, scene: Scene, area: Outline) -> None:
        """Paint the floor of an area, beneath all else: what its fields alone say.

        area: the workspace, or what stands in for it. It is asked once for many frames.
        """

    def draw(self, scene: Scene, frame: Frame) -> None:
        """Draw what its fields and the frame alone say: so replays of a record show it, too.

        frame: one instant: its time [s], pose (3, n), the path (k, 3, n) before, its scenario.
        """

    def theory(self, scene: Scene, frame: Frame) -> None:
        """Draw what theory predicts of a frame; it is shown by a key, and by ``--theory``."""

    def on_start(self, world: World) -> None:
        """Do what is to be done once, before the first step."""

    def on_step(self, world: World) -> None:
        """Do what is to be done at each control step, before the sensors are read."""

    def on_sensed(self, world: World) -> None:
        """Do what is to be done at each control step once the sensors are read, before the laws."""

    def on_draw(self, world: World, scene: Scene) -> None:
        """Add shapes to what is drawn of the world, beneath the robots."""

    def on_stop(self, world: World) -> None:
        """Do what is to be done once, when the experiment is over."""


def hooks_of(addon: Addon) -> tuple[str, ...]:
    """Return the hooks that an add-on has of its own: only these are called."""
    return tuple(hook for hook in HOOKS if getattr(type(addon), hook) is not getattr(Addon, hook))
