"""What is measured or commanded: kinds of numbers, how they look when nothing is there, and err."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, nan, pi
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from mars2d.core.description import wrong
from mars2d.core.errors import likely
from mars2d.core.plane import wrap

__all__ = ["ANGLE", "COLOR", "DISTANCE", "FLAG", "NUMBER", "UNKNOWN", "Quantity"]

Values = NDArray[np.float64] | NDArray[np.bool_]

GROSS = 10.0
"""An outlier of a number without bounds is so many times further off than its noise."""

Kind = Literal["distance", "angle", "color", "flag", "number"]
KINDS: tuple[str, ...] = get_args(Kind)

SYMBOLS = {"omega": "ω", "delta": "δ"}


@dataclass(frozen=True, slots=True)
class Quantity:
    """One number that a sensor measures, or a drive is commanded by: its name, unit and kind.

    kind: "distance" (>= 0, inf when nothing is there), "angle" (in (-pi, pi]), "color" (0 to 1),
    "flag" (True or False) or "number". Of all but distances and flags, nan says that nothing is
    there; of a flag, False. Raises InputError for any other kind.
    """

    name: str
    unit: str = ""
    kind: Kind = "number"

    def __post_init__(self) -> None:
        if self.kind not in KINDS:
            expected = "one of " + ", ".join(map(repr, KINDS)) + likely(self.kind, KINDS)
            raise wrong(f"Quantity.kind of {self.name}", self.kind, expected)

    @property
    def symbol(self) -> str:
        """Its name as people write it: ω for omega."""
        return SYMBOLS.get(self.name, self.name)

    @property
    def missing(self) -> float | bool:
        """What is read when nothing is there: inf, nan or False."""
        return {"distance": inf, "flag": False}.get(self.kind, nan)

    def outlier(self, true: Values, noise: float, top: float, rng: np.random.Generator) -> Values:
        """Return values that have nothing to do with the true ones; top: the longest distance."""
        if self.kind == "flag":
            return ~true.astype(bool)
        if self.kind == "number":
            return np.asarray(true + GROSS * noise * rng.standard_normal(true.shape))
        low, high = {"distance": (0.0, top), "angle": (-pi, pi), "color": (0.0, 1.0)}[self.kind]
        return rng.uniform(low, high, true.shape)

    def limited(self, values: Values, top: float) -> Values:
        """Return values as the device gives them: within bounds, angles wrapped, or missing."""
        if self.kind == "distance":
            return np.where(values > top, inf, np.maximum(values, 0.0))
        if self.kind == "color":
            return np.asarray(np.clip(values, 0.0, 1.0), dtype=float)
        return wrap(values) if self.kind == "angle" else values

    def rounded(self, values: Values, step: float, top: float) -> Values:
        """Return values within their limits at multiples of a step, or at the limit itself."""
        result = np.round(values / step) * step
        if self.kind == "distance":  # not up to beyond the range
            beyond = (result > top) & (values <= top)
            result = np.where(beyond, np.floor(values / step) * step, result)
        return self.limited(result, top)


NUMBER = Quantity("value")
DISTANCE = Quantity("distance", "m", "distance")
ANGLE = Quantity("angle", "rad", "angle")
COLOR = Quantity("color", "", "color")
FLAG = Quantity("flag", "", "flag")

UNKNOWN = (Quantity("u₁"), Quantity("u₂"))
"""The command of a drive that does not say what it is."""
