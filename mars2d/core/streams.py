"""Random streams: many independent ones from one seed, each with its own name."""

from __future__ import annotations

import hashlib

import numpy as np

from mars2d.core.description import wrong

__all__ = ["check_seed", "stream"]


def check_seed(seed: object) -> int:
    """Return the seed as an int. Raises InputError unless it is an integer, 0 to 2**63 - 1."""
    expected = "a whole number from 0 to 2**63 - 1"
    if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)):
        raise wrong("seed", seed, expected)
    if not 0 <= seed < 2**63:
        raise wrong("seed", seed, expected)
    return int(seed)


def stream(seed: int, name: str) -> np.random.Generator:
    """Return the random stream called `name`: its numbers depend on seed and name alone.

    So an additional sensor, for example, does not change the noise of another one.
    """
    key = np.frombuffer(hashlib.sha256(name.encode()).digest()[:16], dtype=np.uint32)
    return np.random.Generator(np.random.PCG64([seed, *key.tolist()]))
