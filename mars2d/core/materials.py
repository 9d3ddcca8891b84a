"""Materials: density, friction and restitution by name.

By default the engine multiplies the values of both surfaces in a contact. So each surface has the
square root of the value for a pair of the same material: steel on steel gets 0.76 * 0.76 = 0.58.
Pairs of different materials come out near the tables in most cases, but too high with ice; a table
of pairs states these. In contact with a surface of friction 1 and restitution 1, the default of
obstacles, a body's own values apply. Other rules than the product are those of other engines; the
values of materials are made for the product.

The figures are typical of clean, dry, solid bodies. Real values scatter by a third or more, with
finish, moisture and speed: measure where it matters. Sources:

- density and sliding friction: Marks' Standard Handbook for Mechanical Engineers, sections 6.1 and
  3.2, and the tables of engineeringtoolbox.com; between them, where they differ;
- restitution: round figures for impacts of about 1 m/s, in the order that Newton found (Principia,
  scholium to the laws: glass 15/16, steel and cork about 5/9) and Goldsmith after him (Impact,
  1960). It falls with speed;
- cardboard, felt and foam are of many kinds: estimates.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple, Self

from mars2d.core.description import Check, accepts, real, wrong
from mars2d.core.errors import nearest

GRAVITY = 9.81
"""The acceleration of gravity, m/s^2."""


class Material(NamedTuple):
    """Density [kg/m^3], and the friction and restitution of a surface.

    By default a contact has the product of both surfaces' friction, and of their restitution.
    """

    density: float
    friction: float
    restitution: float


_PAIRS = {
    "aluminium": (2700.0, 0.6, 0.5),
    "cardboard": (150.0, 0.4, 0.1),
    "concrete": (2400.0, 0.65, 0.4),
    "felt": (250.0, 0.5, 0.2),
    "foam": (30.0, 0.6, 0.4),
    "glass": (2500.0, 0.4, 0.9),
    "ice": (917.0, 0.05, 0.5),
    "plastic": (1000.0, 0.3, 0.6),
    "rubber": (1100.0, 1.15, 0.75),
    "steel": (7850.0, 0.58, 0.6),
    "teflon": (2200.0, 0.04, 0.5),
    "wood": (600.0, 0.4, 0.5),
}
"""Density [kg/m^3], and friction and restitution between two bodies of the same material."""

MATERIALS: dict[str, Material] = {
    name: Material(density, round(friction**0.5, 2), round(restitution**0.5, 2))
    for name, (density, friction, restitution) in _PAIRS.items()
}
"""The materials by name."""


RULES = ("product", "minimum", "mean", "geometric", "maximum")
"""How the values of two surfaces make that of their contact; "mean" is (p + q) / 2, "geometric"
sqrt(p q).
"""


def blended(rule: str, p: float, q: float) -> float:
    """Return the coefficient of a contact by one of `RULES`, from those of its surfaces.

    >>> blended("geometric", 0.25, 0.09)
    0.15
    """
    values = {
        "product": p * q, "minimum": min(p, q), "mean": (p + q) / 2, "geometric": sqrt(p * q),
        "maximum": max(p, q),
    }  # fmt: skip
    return values[rule]


class Coefficient(float):
    """A coefficient of friction or restitution that was given by a material's name."""

    material: str

    def __new__(cls, value: float, material: str) -> Self:
        """Take the number and the name."""
        made = super().__new__(cls, value)
        made.material = material
        return made

    def __eq__(self, other: object) -> bool:
        """Tell two materials apart that have the same value; any other number is compared as one.

        >>> wood = Coefficient(0.63, "wood")
        >>> wood == Coefficient(0.63, "glass"), wood == 0.63
        (False, True)
        """
        if isinstance(other, Coefficient) and other.material != self.material:
            return False
        return super().__eq__(other)

    def __ne__(self, other: object) -> bool:
        """Return what `__eq__` does not."""
        return not self == other

    __hash__ = float.__hash__

    def __getnewargs__(self) -> tuple[float, str]:  # type: ignore[override]
        """Return what a copy is made of."""
        return float(self), self.material


def material_of(coefficient: float) -> str | None:
    """Return the name of the material by which a coefficient was given; None: it was a number."""
    return coefficient.material if isinstance(coefficient, Coefficient) else None


def check_static(name: str, static: float | None, kinetic: float) -> None:
    """Refuse a coefficient of static friction below the kinetic one. name: of the field."""
    if static is not None and static < kinetic:
        raise wrong(name, static, f"at least the kinetic coefficient, {kinetic:g}, or None")


@accepts({"enum": list(MATERIALS)})
def material(name: str, value: object) -> str | None:
    """Check a material's name, or None."""
    if value is None:
        return None
    if not isinstance(value, str) or value not in MATERIALS:
        raise wrong(name, value, f"a material's name, or None{_known(value)}")
    return value


def _surface(quantity: str, high: float) -> Check:
    """Return the check of a surface's coefficient: a number up to `high`, or a material's name."""
    expected = f"a number >= 0 and <= {high:g}, or a material's name"
    numeric = {"type": ["number", "string"], "minimum": 0, "maximum": high}

    @accepts(numeric | {"if": {"type": "string"}, "then": {"enum": list(MATERIALS)}})
    def check(name: str, value: object) -> float:
        if isinstance(value, str):
            if value not in MATERIALS:
                raise wrong(name, value, expected + _known(value))
            return Coefficient(getattr(MATERIALS[value], quantity), value)
        if isinstance(value, Coefficient) and getattr(MATERIALS[value.material], quantity) == value:
            return value
        result = real(name, value, expected)
        if not 0 <= result <= high:
            raise wrong(name, value, expected)
        return result

    return check


surface_friction, surface_restitution = _surface("friction", 1e3), _surface("restitution", 1.0)
"""Checks of a surface's coefficients of friction and restitution."""


def _known(value: object) -> str:
    """Return a hint at the nearest material's name, or else a list of all."""
    return nearest(value.lower(), MATERIALS) if isinstance(value, str) else ""
