"""Make all figures, several at a time, and the page that shows them."""

from __future__ import annotations

import json
import multiprocessing
import os
import signal
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

from mars2d.core.errors import Mars2dError
from mars2d.core.files import atomic_write
from mars2d.core.interrupt import interrupts_blocked
from mars2d.reports.paper.figure import Figure
from mars2d.reports.paper.folder import NUMBERS, PAGE
from mars2d.reports.paper.make import make
from mars2d.reports.paper.page import page
from mars2d.reports.paper.result import Result

__all__ = ["make_all", "processors", "write_page"]

Watch = Callable[[int, Sequence[int]], None]
"""Called now and then with how many figures are done, and the numbers of those being made."""


def make_all(
    figures: Sequence[Figure],
    folder: Path,
    seed: int,
    done: dict[int, Result],
    watch: Watch,
    processes: int | None = None,
) -> None:
    """Make figures in a folder, each in one of some processes, and put what was made into `done`.

    done: filled as figures are done, by their numbers; what it holds after Ctrl-C is complete.
    processes: by default one a processor; with 1, or for one figure, no other process is started.
    The results do not depend on it.
    """
    count = min(processors() if processes is None else processes, len(figures))
    if count <= 1:
        for figure in figures:
            watch(len(done), [figure.number])
            done[figure.number] = make(figure, folder, seed)
        return
    others = multiprocessing.active_children()
    context = multiprocessing.get_context("spawn")  # a fork would copy threads half way
    with ProcessPoolExecutor(count, context, initializer=_ignore_interrupts) as pool:
        try:
            _share(figures, folder, seed, done, watch, pool, count)
        except BaseException:
            for child in multiprocessing.active_children():
                if child not in others:
                    child.terminate()  # else we would wait for what nobody wants any more
            raise


def _share(
    figures: Sequence[Figure],
    folder: Path,
    seed: int,
    done: dict[int, Result],
    watch: Watch,
    pool: ProcessPoolExecutor,
    count: int,
) -> None:
    """Keep all processes at work, the longest figures first."""
    waiting = sorted(figures, key=lambda figure: -figure.work)
    active: dict[Future[Result], int] = {}
    while waiting or active:
        while waiting and len(active) < count:
            figure = waiting.pop(0)
            with interrupts_blocked():  # a process may be started for it
                future = pool.submit(make, figure, folder, seed)
            active[future] = figure.number
        watch(len(done), sorted(active.values()))
        for future in wait(active, timeout=0.2, return_when=FIRST_COMPLETED).done:
            number = active.pop(future)
            try:
                done[number] = future.result()
            except BrokenProcessPool:
                raise Mars2dError(f"figure {number}: its process was ended from outside") from None


def _ignore_interrupts() -> None:
    """Leave Ctrl-C to the process that started this one."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def processors() -> int:
    """Return how many processors this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not on every system
        return os.cpu_count() or 1


def write_page(folder: Path, figures: Sequence[Figure], done: dict[int, Result], seed: int) -> Path:
    """Write the page and the numbers of those figures that were made; return the page's path."""
    results = [done[figure.number] for figure in figures if figure.number in done]
    numbers = {"seed": seed, "figures": [result.as_dict() for result in results]}
    texts = {
        NUMBERS: json.dumps(numbers, indent=1, allow_nan=False) + "\n",
        PAGE: page(figures, done, seed),
    }
    for name, text in texts.items():
        with atomic_write(folder / name) as file:
            file.write(text.encode())
    return folder / PAGE
