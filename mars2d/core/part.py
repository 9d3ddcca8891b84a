"""Parts that keep something while they run: each user works on a copy of its own."""

from __future__ import annotations

import copy
from typing import Any, ClassVar, Self

from mars2d.core.description import Description

__all__ = ["Live"]


class Live(Description):
    """The base of parts whose methods may set attributes of self while a world runs.

    In a scenario such a part is frozen as every description. `live` makes a copy that is not.
    """

    _live: ClassVar[bool] = False

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        frozen = cls.__setattr__

        def set_attribute(self: Live, attribute: str, value: Any) -> None:
            if self.__dict__.get("_live"):
                object.__setattr__(self, attribute, value)
            else:
                frozen(self, attribute, value)

        cls.__setattr__ = set_attribute  # type: ignore[method-assign, assignment]

    def live(self, **attributes: Any) -> Self:
        """Return a copy that may be written to, with some attributes set."""
        twin = copy.deepcopy(self)
        twin.__dict__.update(_live=True, **attributes)
        return twin
