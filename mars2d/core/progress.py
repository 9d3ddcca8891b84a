"""A progress bar on a terminal and in a notebook."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Update = Callable[..., None]
"""Shows how many are done, and what else there is to say, if anything."""


@contextmanager
def progress(total: int, unit: str, done: int = 0, *, show: bool = True) -> Iterator[Update]:
    """Yield what shows how many of `total` are done, with rate and time left; silent elsewhere.

    done: how many are done before. show: False shows nothing.
    """
    notebook = type(sys.stderr).__module__.startswith("ipykernel.")
    if not (show and (sys.stderr.isatty() or notebook)):
        yield lambda _done, _said="": None
        return
    with warnings.catch_warnings():  # a notebook without ipywidgets has a bar of letters
        warnings.simplefilter("ignore")
        from tqdm.auto import tqdm
    look: dict[str, Any] = {"unit": unit, "leave": False, "dynamic_ncols": True}
    with tqdm(total=total, initial=done, **look) as bar:

        def update(done: int, said: str = "") -> None:
            if said:
                bar.set_postfix_str(said, refresh=False)
            bar.update(done - bar.n)

        yield update
