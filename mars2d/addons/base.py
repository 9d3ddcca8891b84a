"""The base of all add-ons, and the hooks that a simulation calls."""

from __future__ import annotations

from collections.abc import Mapping
from inspect import isfunction
from typing import Any, ClassVar

import numpy as np

from mars2d.core import checks
from mars2d.core.description import Stateful, entry, number, snake_case
from mars2d.core.errors import InputError, nearest
from mars2d.core.materials import check_static, surface_friction, surface_restitution
from mars2d.core.plane import Outline, Point
from mars2d.core.scene import Scene
from mars2d.core.words import instead

Color = tuple[float, float, float]
"""Red, green and blue from 0 to 1."""

HOOKS = ("on_start", "on_step", "on_sensed", "on_contact", "on_draw", "on_stop")
"""All hooks: MARS's Initialize, Loop and Plot of an add-on; for sensing, touches and the end."""


class Addon(Stateful):
    """The base of all add-ons: derive, declare fields, and write the hooks that you need.

    >>> class Counter(Addon):
    ...     def on_start(self, world):
    ...         self.steps = 0
    ...     def on_step(self, world):
    ...         self.steps += 1

    A hook is a method named as in `HOOKS`; any other ``on_...`` is an error. In a scenario an
    add-on is frozen. Each world works on a copy of its own, on which hooks may set attributes; laws
    find it as ``world.addons.<name>``. The hooks get the
    `World`, see `mars2d.core.interfaces.WorldLike`; `draw` and `theory` a `Frame`, see `FrameLike`.
    """

    name: str | None = entry(
        default=None, check=checks.identifier("world.addons."), optional=True,
        doc="the name in world.addons",
    )  # fmt: skip

    friction: float = entry(
        default=1.0, check=surface_friction,
        doc="of its obstacles; a contact has the product of both",
    )  # fmt: skip
    restitution: float = entry(
        default=1.0, check=surface_restitution,
        doc="of its obstacles; a contact has the product of both",
    )  # fmt: skip
    static_friction: float | None = number(
        default=None, low=0, high=1e3, optional=True,
        doc="friction at rest; None: as friction",
    )  # fmt: skip
    only_one: ClassVar[str] = ""
    """Why a scenario has no two of them, as "robots talk over one"; "": it may have several."""
    carries_messages: ClassVar[bool] = False
    """Whether robots talk over it: the inspector then shows their inboxes."""

    rng: ClassVar[np.random.Generator]
    """Its own random stream; only the copy that a world works on has one."""

    def __init_subclass__(cls, **kwargs: Any) -> None:
        ours = [(name, each) for name, each in vars(Addon).items() if isfunction(each)]
        idle = all(getattr(cls, name) is each for name, each in ours)
        for attribute, value in vars(cls).items():
            hint = instead(attribute, "a hook")
            if attribute.startswith("on_") and attribute not in HOOKS:
                hint = hint or nearest(attribute, HOOKS)
                raise InputError(f"{cls.__name__}.{attribute} is no hook of an add-on{hint}")
            if idle and hint and callable(value):
                raise InputError(f"{cls.__name__}.{attribute} is never called{hint}")
        super().__init_subclass__(**kwargs)

    @property
    def key(self) -> str:
        """The name in ``world.addons``: `name`, or that of the class in snake case."""
        return self.name or snake_case(type(self).__name__)

    def _validate(self) -> None:
        check_static(f"{type(self).__name__}.static_friction", self.static_friction, self.friction)

    @property
    def acts(self) -> bool:
        """Whether a run depends on it by more than its obstacles."""
        return bool(hooks_of(self))

    def obstacles(self) -> tuple[Outline, ...]:
        """Return the outlines of its obstacles: two vertices a wall, more a closed polygon."""
        return ()

    def beacons(self) -> Mapping[str, Point]:
        """Return the beacons' positions now, by name, for the sensor Beacon; by default none."""
        return {}

    def ground(self, point: Point) -> Color | None:  # noqa: ARG002
        """Return the colour of the floor at a point, red, green and blue from 0 to 1.

        None: it gives the floor no colour there. The last add-on that gives one counts.
        """
        return None

    def paint(self, scene: Scene, area: Outline) -> None:
        """Paint the floor of an area, beneath all else, from its fields alone.

        area: the workspace, or the part of the plane that is shown. Called once for many frames.
        """

    def draw(self, scene: Scene, frame: Any) -> None:
        """Draw from its fields and the frame alone, so that replays of a record show it, too.

        frame: one instant: its time [s], pose (3, n), the path (k, 3, n) before, its scenario.
        """

    def theory(self, scene: Scene, frame: Any) -> None:
        """Draw the prediction of theory for a frame; shown by a key, and by ``--theory``."""

    def on_start(self, world: Any) -> None:
        """Prepare: called once, before the first step."""

    def on_step(self, world: Any) -> None:
        """Act at each control step, before the sensors are read."""

    def on_sensed(self, world: Any) -> None:
        """Act at each control step, after the sensors are read and before the laws are asked."""

    def on_contact(self, world: Any, contact: Any) -> None:
        """Act where two bodies have come to touch, or have parted, before `on_step`.

        contact: the row of `world.contacts`, with the time, the bodies `a` and `b`, the impulses,
        and whether it `began` and `ended` in the last control step; a bounce does both.
        """

    def on_draw(self, world: Any, scene: Scene) -> None:
        """Add shapes to the picture of the world, beneath the robots."""

    def on_stop(self, world: Any) -> None:
        """Finish: called once, when the experiment is over."""


def hooks_of(addon: Addon) -> tuple[str, ...]:
    """Return the hooks that an add-on's class overrides: only these are called."""
    return tuple(hook for hook in HOOKS if getattr(type(addon), hook) is not getattr(Addon, hook))
