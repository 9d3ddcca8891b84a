"""How long a start takes: importing the package, the help, and a whole run from shell to shell.

    python benchmarks/start.py [--json OUT.json] [--rounds N]

Each figure is the median of several new processes, with modules compiled as pip compiles them.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import outcome

ROUNDS = 9

EVERY: dict[str, Sequence[str]] = {
    "bare python": ("-c", "pass"),
    "import numpy": ("-c", "import numpy"),
    "import mars2d": ("-c", "import mars2d"),
    "mars2d --help": ("-m", "mars2d", "--help"),
    "mars2d list": ("-m", "mars2d", "list"),
    "mars2d run random_walk --headless": ("-m", "mars2d", "run", "random_walk", "--headless"),
}
"""What is timed, as arguments of Python."""


def seconds(arguments: Sequence[str], environment: dict[str, str]) -> float:
    """Return how long Python takes with these arguments, from its start to its end."""
    start = time.perf_counter()
    command = [sys.executable, *arguments]
    subprocess.run(command, check=True, env=environment, stdout=subprocess.DEVNULL)
    return time.perf_counter() - start


def main() -> None:
    """Run the commands in turns, print the medians, and write JSON where it is asked for."""
    parser = argparse.ArgumentParser(description="How long a start takes.")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    parser.add_argument("--rounds", type=int, default=ROUNDS, help="how often all are timed")
    arguments = parser.parse_args()
    times: dict[str, list[float]] = {name: [] for name in EVERY}
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    with TemporaryDirectory() as folder:
        environment["PYTHONPYCACHEPREFIX"] = folder
        for round_ in range(arguments.rounds + 1):
            for name, command in EVERY.items():
                taken = seconds(command, environment)
                if round_ > 0:  # the first compiles, and fills the disk's cache
                    times[name].append(taken)
    medians = {name: round(statistics.median(taken), 4) for name, taken in times.items()}
    python = medians["bare python"]
    for name, median in medians.items():
        print(f"{name:<36}{median:7.3f} s   {median - python:+7.3f} s over bare python")
    outcome.write(medians, arguments.json)


if __name__ == "__main__":
    main()
