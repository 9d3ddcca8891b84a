"""The share of a processor that a window takes: while it plays, and paused, drawn on or at rest.

python benchmarks/resting.py [--seconds 5]     (needs a display, or xvfb-run)
"""

from __future__ import annotations

import argparse
import time
from itertools import product

from mars2d.scenario.experiment import open_experiment
from mars2d.window.run.window import Window
from mars2d.window.screen import rest
from mars2d.world.timeline import Timeline

EXAMPLES = "head_on", "push_box", "crowd"


class Watched(Window):
    """A window that measures the processor's share for some seconds, and closes."""

    wait, seconds, share = 2.0, 5.0, 0.0

    def _pass_time(self, seconds: float) -> None:
        super()._pass_time(seconds)
        now, busy = time.perf_counter(), time.process_time()
        if self.player.drawing == 0.0:  # before the first picture
            self._begin = now + self.wait
        elif now < self._begin:
            self._busy = busy
        elif now > self._begin + self.seconds:
            self.share = (busy - self._busy) / (now - self._begin)
            self._open = False


def share(example: str, seconds: float, *, plays: bool, rests: bool, scopes: bool) -> float:
    """Return the processor's share of a window after two seconds; scopes: with speed and force."""
    window = Watched(Timeline(open_experiment(example)))
    robots = tuple(range(len(window.player.source.scenario.robots)))
    for what in ("speed", "force") if scopes else ():
        window.dock.scopes.switch(what, robots)
    window.seconds, window.player.paused = seconds, not plays
    quiet, rest.QUIET = rest.QUIET, rest.QUIET if rests else 1e9
    try:
        window.run()
    finally:
        rest.QUIET = quiet
    return window.share


def main() -> None:
    """Print a row for each example."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=5.0)
    seconds = parser.parse_args().seconds
    print("example     scopes   plays  paused, drawn on  at rest")
    for example, scopes in product(EXAMPLES, (False, True)):
        shares = [
            share(example, seconds, plays=plays, rests=rests, scopes=scopes)
            for plays, rests in ((True, True), (False, False), (False, True))
        ]
        what = "with" if scopes else "none"
        print(
            f"{example:10}  {what}    {shares[0]:6.1%}  {shares[1]:16.1%}  {shares[2]:7.2%}",
            flush=True,
        )


if __name__ == "__main__":
    main()
