"""How long a start takes: importing the package, and a whole run from shell to shell.

    python benchmarks/start.py [--json OUT.json] [--rounds N]

Each figure is the median of several new processes.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROUNDS = 9

COMMANDS = {
    "bare python": [sys.executable, "-c", "pass"],
    "import numpy": [sys.executable, "-c", "import numpy"],
    "import mars2d": [sys.executable, "-c", "import mars2d"],
    "mars2d run random_walk --headless": [
        *(sys.executable, "-m", "mars2d", "run", "random_walk", "--headless"),
    ],
}


def seconds(command: list[str]) -> float:
    """Return how long a command takes from its start to its end."""
    start = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - start


def main() -> None:
    """Run the commands in turns, print the medians, and write JSON where it is asked for."""
    parser = argparse.ArgumentParser(description="How long a start takes.")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    parser.add_argument("--rounds", type=int, default=ROUNDS, help="how often all are timed")
    arguments = parser.parse_args()
    times: dict[str, list[float]] = {name: [] for name in COMMANDS}
    for round_ in range(arguments.rounds + 1):
        for name, command in COMMANDS.items():
            taken = seconds(command)
            if round_ > 0:  # the first fills the disk's cache
                times[name].append(taken)
    medians = {name: round(statistics.median(taken), 4) for name, taken in times.items()}
    python = medians["bare python"]
    for name, median in medians.items():
        print(f"{name:<36}{median:7.3f} s   {median - python:+7.3f} s over bare python")
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(medians, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
