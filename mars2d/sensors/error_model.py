"""The errors of a device: noise, outliers, limits, resolution, drop-outs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import LawError, shown
from mars2d.core.quantity import FLAG, Quantity
from mars2d.core.streams import Random


def as_numbers(name: str, reading: Any, example: str) -> NDArray[Any]:
    """Return a reading of sensor `name` as an array of truth values or floats.

    example: what it may be, for the message. Raises LawError for anything else.
    """
    try:
        given = np.asarray(reading)
    except ValueError:  # rows of different lengths
        given = np.empty(0, dtype=object)
    if given.dtype.kind not in "bifu":
        raise LawError(f"sensor {name!r} read {shown(reading)}: a reading is {example}")
    return given if given.dtype.kind == "b" else given.astype(float, copy=False)


@dataclass(frozen=True)
class Imperfection:
    """Turns perfect readings into those of a device.

    name: of the sensor, for messages. noise, resolution: one for each quantity. top: its range,
    metres.
    """

    name: str
    quantities: Sequence[Quantity]
    noise: Sequence[float]
    resolution: Sequence[float]
    outliers: float
    dropouts: float
    top: float

    @cached_property
    def none(self) -> bool:
        """Whether the device has no errors."""
        return not (self._spreads or self.outliers or self.dropouts)

    @cached_property
    def _spreads(self) -> bool:
        """Whether values have noise or are rounded."""
        return any(self.noise) or any(self.resolution)

    @cached_property
    def _limited(self) -> bool:
        """Whether a quantity of the reading has limits."""
        return any(quantity.kind not in ("number", "flag") for quantity in self.quantities)

    def of(self, reading: Any, rng: Random) -> Any:
        """Return a perfect reading with errors; or those of many devices, see `Sensor.measured`."""
        true = self._checked(reading)
        if self.none and not self._limited:
            return reading
        if len(self.quantities) == 1:
            result = self._disturbed(true, 0, rng)
        else:
            columns = [self._disturbed(true[..., k], k, rng) for k in range(true.shape[-1])]
            result = np.stack(columns, axis=-1)
        if self.dropouts:
            result = np.array(result)
            result[rng.random(self._rows(result)) < self.dropouts] = self._missing(result)
        return result if result.ndim else result.item()

    def lost(self, reading: Any) -> Any:
        """Return the reading in place of one that has not arrived."""
        result = np.array(self._checked(reading))
        result[...] = self._missing(result)
        return result if result.ndim else result.item()

    def _missing(self, result: NDArray[Any]) -> Any:
        if result.dtype == bool:
            return False
        missing = [quantity.missing for quantity in self.quantities]
        return missing[0] if len(missing) == 1 else np.array(missing)

    def _rows(self, result: NDArray[Any]) -> tuple[int, ...]:
        """Return the shape of the parts that are lost as a whole: values, pixels, or rows."""
        whole = len(self.quantities) > 1 or (self.quantities[0].kind == "color" and result.ndim)
        return result.shape[:-1] if whole else result.shape

    def _checked(self, reading: Any) -> NDArray[Any]:
        example = "a number, True or False, or an array of them, of a shape that stays"
        true = as_numbers(self.name, reading, example)
        count = len(self.quantities)
        if count > 1 and (true.ndim == 0 or true.shape[-1] != count):
            raise LawError(
                f"sensor {self.name!r} read {shown(reading)}: it measures {count} quantities, so "
                f"the last axis of its reading must have {count} entries"
            )
        if self._spreads and true.dtype == bool:
            raise LawError(
                f"sensor {self.name!r} read {shown(reading)}: True or False has neither noise nor "
                "resolution; give it outliers or drop-outs"
            )
        return true

    def _disturbed(self, true: NDArray[Any], k: int, rng: Random) -> NDArray[Any]:
        """Return true values of quantity k with noise, outliers, limits and resolution."""
        quantity = FLAG if true.dtype == bool else self.quantities[k]
        noise, step = self.noise[k], self.resolution[k]
        values = true + noise * rng.standard_normal(true.shape) if noise else true
        if self.outliers:
            pixels = quantity.kind == "color" and true.ndim > 0
            shape = (*true.shape[:-1], 1) if pixels else true.shape
            # A missing value stays missing; but a distance may be read where there is nothing.
            struck = (rng.random(shape) < self.outliers) & ~np.isnan(true)
            values = np.where(struck, quantity.outlier(true, noise, self.top, rng), values)
        values = quantity.limited(values, self.top)
        return quantity.rounded(values, step, self.top) if step else np.asarray(values)
