"""Quantities that are measured or commanded: units, kinds, limits, missing values, outliers."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, nan, pi
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from mars2d.core.description import wrong
from mars2d.core.errors import likely
from mars2d.core.plane import wrap
from mars2d.core.streams import Random

Values = NDArray[np.float64] | NDArray[np.bool_]

OUTLIER_SCALE = 10.0
"""The spread of outliers of a number without bounds, in units of its noise."""

Kind = Literal["distance", "angle", "color", "flag", "number"]
KINDS: tuple[str, ...] = get_args(Kind)

SYMBOLS = {"omega": "ω", "delta": "δ"}


@dataclass(frozen=True, slots=True)
class Quantity:
    """One number that is measured or commanded: its name, unit and kind.

    kind: "distance" (>= 0, inf if missing), "angle" (in (-pi, pi]), "color" (0 to 1), "flag" (True,
    or False if missing) or "number". A missing angle, color or number is nan. Raises InputError
    for any other kind.
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
        """The name as a symbol: ω for omega."""
        return SYMBOLS.get(self.name, self.name)

    @property
    def missing(self) -> float | bool:
        """The value if there is nothing to measure: inf, nan or False."""
        return {"distance": inf, "flag": False}.get(self.kind, nan)

    def outlier(self, true: Values, noise: float, top: float, rng: Random) -> Values:
        """Return random outliers in place of the true values; top: the largest distance."""
        if self.kind == "flag":
            return ~true.astype(bool)
        if self.kind == "number":
            return np.asarray(true + OUTLIER_SCALE * noise * rng.standard_normal(true.shape))
        low, high = {"distance": (0.0, top), "angle": (-pi, pi), "color": (0.0, 1.0)}[self.kind]
        return rng.uniform(low, high, true.shape)

    def limited(self, values: Values, top: float) -> Values:
        """Return values within the kind's limits: clipped, wrapped, or missing beyond `top`."""
        if self.kind == "distance":
            return np.where(values > top, inf, np.maximum(values, 0.0))
        if self.kind == "color":
            return np.asarray(np.clip(values, 0.0, 1.0), dtype=float)
        return wrap(values) if self.kind == "angle" else values

    def rounded(self, values: Values, step: float, top: float) -> Values:
        """Return values rounded to multiples of a step, within the kind's limits."""
        result = np.round(values / step) * step
        if self.kind == "distance":  # don't round up beyond the range
            beyond = (result > top) & (values <= top)
            result = np.where(beyond, np.floor(values / step) * step, result)
        return self.limited(result, top)


NUMBER = Quantity("value")
DISTANCE = Quantity("distance", "m", "distance")
ANGLE = Quantity("angle", "rad", "angle")
COLOR = Quantity("color", "", "color")
FLAG = Quantity("flag", "", "flag")

UNKNOWN = (Quantity("u₁"), Quantity("u₂"))
"""The command of a drive that does not describe its inputs."""
