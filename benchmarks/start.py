"""How long a start takes: importing the package, and a whole run from shell to shell.

    python benchmarks/start.py [--json OUT.json] [--rounds N]

Each figure is the median of several new processes, with modules compiled as pip compiles them.
"""

from __future__ import annotations

import argparse
import json
import statistics
from pathlib import Path

from mars2d.reports.bench.suite import COMMANDS, seconds, with_bytecode

ROUNDS = 9

EVERY = {"bare python": ("-c", "pass"), "import numpy": ("-c", "import numpy"), **COMMANDS}


def main() -> None:
    """Run the commands in turns, print the medians, and write JSON where it is asked for."""
    parser = argparse.ArgumentParser(description="How long a start takes.")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    parser.add_argument("--rounds", type=int, default=ROUNDS, help="how often all are timed")
    arguments = parser.parse_args()
    times: dict[str, list[float]] = {name: [] for name in EVERY}
    with with_bytecode() as environment:
        for round_ in range(arguments.rounds + 1):
            for name, command in EVERY.items():
                taken = seconds(command, environment)
                if round_ > 0:  # the first compiles, and fills the disk's cache
                    times[name].append(taken)
    medians = {name: round(statistics.median(taken), 4) for name, taken in times.items()}
    python = medians["bare python"]
    for name, median in medians.items():
        print(f"{name:<36}{median:7.3f} s   {median - python:+7.3f} s over bare python")
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(medians, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
