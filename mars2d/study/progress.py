"""The progress of many runs: a bar on a terminal and in a notebook."""

from __future__ import annotations

import sys
import warnings
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tqdm.std import tqdm as Bar  # noqa: N812


def progress(total: int, done: int = 0, *, unit: str = "run", show: bool = True) -> Bar[Any]:
    """Return a bar that counts up to `total` and estimates the time that is left.

    done: how many are done before. show: False shows nothing; nor does a pipe or a file.
    """
    with warnings.catch_warnings():  # a notebook without ipywidgets has a bar of letters
        warnings.simplefilter("ignore")
        from tqdm.auto import tqdm

    seen = sys.stderr.isatty() or type(sys.stderr).__module__.startswith("ipykernel.")
    bar: Bar[Any] = tqdm(
        total=total, initial=done, unit=unit, disable=not (show and seen), leave=False,
        dynamic_ncols=True,
    )  # fmt: skip
    return bar
