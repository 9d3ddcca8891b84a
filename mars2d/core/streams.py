"""Random streams: many independent ones from one seed, each with its own name."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mars2d.core.description import wrong

Float = NDArray[np.float64]
Shape = tuple[int, ...]


def check_seed(seed: object) -> int:
    """Return the seed as an int. Raises InputError unless it is an integer, 0 to 2**63 - 1."""
    if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or not 0 <= seed < 2**63:
        raise wrong("seed", seed, "a whole number from 0 to 2**63 - 1")
    return int(seed)


def stream(seed: int, name: str) -> np.random.Generator:
    """Return the random stream called `name`: its numbers depend on seed and name alone.

    So an additional sensor, for example, does not change the noise of another one.
    """
    key = np.frombuffer(hashlib.sha256(name.encode()).digest()[:16], dtype=np.uint32)
    return np.random.Generator(np.random.PCG64([seed, *key.tolist()]))


class Streams:
    """The random streams of many devices: each draws its part of an array from its own stream.

    So a device gets the same numbers as if it drew alone. shape: its first axis has one entry for
    each device.
    """

    def __init__(self, rngs: Sequence[np.random.Generator]) -> None:
        self._rngs = rngs

    def random(self, shape: Shape) -> Float:
        """Return numbers from 0 to 1."""
        return np.array([rng.random(shape[1:]) for rng in self._rngs])

    def uniform(self, low: float, high: float, shape: Shape) -> Float:
        """Return numbers from `low` to `high`."""
        return np.array([rng.uniform(low, high, shape[1:]) for rng in self._rngs])

    def standard_normal(self, shape: Shape) -> Float:
        """Return numbers of the standard normal distribution."""
        return np.array([rng.standard_normal(shape[1:]) for rng in self._rngs])


Random = np.random.Generator | Streams
"""What errors are drawn from: the stream of a device, or those of many."""
