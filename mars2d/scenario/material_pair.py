"""Friction and restitution of two materials, where measured tables differ from the product."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from mars2d.core.description import Description, choice, number, wrong
from mars2d.core.errors import InputError
from mars2d.core.materials import MATERIALS, check_static


class MaterialPair(Description):
    """Friction and restitution between two materials, in place of the rule's result.

    It counts where both surfaces were given by these names: `friction` of the pair where their
    friction was, `restitution` where their restitution was.

    >>> MaterialPair("steel", "ice", friction=0.03).friction
    0.03
    """

    a: str = choice(of=tuple(MATERIALS), kw_only=False, doc="a material's name")
    b: str = choice(of=tuple(MATERIALS), kw_only=False, doc="the other material, or the same")
    friction: float | None = number(
        default=None, low=0, high=1e3, optional=True,
        doc="coefficient of friction of the contact; None: by the rule",
    )  # fmt: skip
    static_friction: float | None = number(
        default=None, low=0, high=1e3, optional=True,
        doc="friction at rest; None: as friction",
    )  # fmt: skip
    restitution: float | None = number(
        default=None, low=0, high=1, optional=True,
        doc="restitution of the contact; None: by the rule",
    )  # fmt: skip

    def _validate(self) -> None:
        where = f"MaterialPair({self.a!r}, {self.b!r})"
        if self.friction is None and self.restitution is None:
            raise InputError(f"{where}: expected a friction or a restitution, such as friction=0.1")
        if self.friction is None and self.static_friction is not None:
            raise wrong(
                "MaterialPair.static_friction", self.static_friction,
                "None, or the kinetic friction as well",
            )  # fmt: skip
        check_static("MaterialPair.static_friction", self.static_friction, self.friction or 0.0)

    @property
    def names(self) -> frozenset[str]:
        """Both materials, in no order."""
        return frozenset((self.a, self.b))


def check_once(field: str, pairs: Sequence[MaterialPair]) -> None:
    """Refuse two pairs of the same materials."""
    for (i, one), (k, other) in combinations(enumerate(pairs), 2):
        if one.names == other.names:
            twice = f"{other.a!r} and {other.b!r} are also {field}[{i}]"
            raise InputError(f"{field}[{k}]: {twice}; expected each pair once")
