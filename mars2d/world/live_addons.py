"""The add-ons of one running world: found by name, and called at their hooks."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import SimpleNamespace
from typing import Any, NoReturn

import numpy as np

from mars2d.addons.base import HOOKS, Addon, hooks_of
from mars2d.core.errors import UnknownNameError, nearest
from mars2d.core.usercode import called

__all__ = ["Addons", "Hooks"]


class Addons(SimpleNamespace):
    """The add-ons of a world by name: ``world.addons.map``."""

    def __getattr__(self, name: str) -> NoReturn:
        raise UnknownNameError(f"this world has no add-on {name!r}{nearest(name, vars(self))}")

    @classmethod
    def of(
        cls,
        described: Sequence[Addon],
        there: Mapping[str, Addon],
        stream: Callable[[str], np.random.Generator],
    ) -> Addons:
        """Return live copies of a scenario's add-ons.

        there: live add-ons by name that go on. stream: returns a random stream by its name.
        """
        return cls(
            **{
                addon.key: there.get(addon.key) or addon.live(rng=stream(f"add-on {addon.key}"))
                for addon in described
            }
        )


class Hooks:
    """Calls the hooks that live add-ons define, in the order of the add-ons."""

    def __init__(self, addons: Addons) -> None:
        self._hooks = {
            hook: [
                (key, getattr(a, hook)) for key, a in vars(addons).items() if hook in hooks_of(a)
            ]
            for hook in HOOKS
        }

    def call(self, hook: str, *args: Any) -> None:
        """Call a hook of all add-ons. Raises LawError, which names the add-on that raised."""
        for key, method in self._hooks[hook]:
            with called(f"add-on {key!r}", method):
                method(*args)
