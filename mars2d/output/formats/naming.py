"""Names for programs that take fewer of them than Python does."""

from __future__ import annotations

import re
from collections.abc import Iterable

__all__ = ["plain_names"]

LONGEST = 63
"""How long the name of a field may be in Matlab."""

KEYWORDS = {
    "case", "catch", "end", "function", "otherwise", "parfor", "persistent", "spmd", "switch",
}  # fmt: skip
"""Words of Matlab that no field can be called, though a sensor can."""


def plain_names(names: Iterable[str]) -> dict[str, str]:
    """Return for each name one that Matlab takes: ASCII, a letter first, at most 63 characters.

    One that is taken then ends in a number.

    >>> plain_names(["scan", "größe", "gr_ße", "end"])
    {'scan': 'scan', 'größe': 'gr__e', 'gr_ße': 'gr__e_2', 'end': 'xend'}
    """
    found: dict[str, str] = {}
    for name in names:
        plain = re.sub("[^A-Za-z0-9_]", "_", name)
        if not plain[:1].isalpha() or plain in KEYWORDS:
            plain = f"x{plain}"
        free, k = plain[:LONGEST], 1
        while free in found.values():
            k += 1
            free = f"{plain[: LONGEST - len(f'_{k}')]}_{k}"
        found[name] = free
    return found
