"""How fast MARS2D is beside its peers: the same scenes, in turns, in one run.

    python benchmarks/peers/run.py --install DIR [--peer NAME ...]
    python benchmarks/peers/run.py --peer navground=DIR/navground/bin/python --peer ...
        [--scenes S1 ...] [--rounds N] [--steps N] [--json OUT.json] [--markdown README.md]

Each simulator has a process of its own, in which its script from this folder runs; at any time one
of them works, and the others wait. After the same number of steps to warm up, all are timed a short
time each, round by round, so that what else the machine does falls on all of them alike, and each
round is about the same simulated time. Ratios are those within a round. At last each is looked at:
are the robots where they should be, and how deep do they overlap?

What is too slow for its steps gets its time: the table shows how many steps it did.
"""

from __future__ import annotations

import argparse
import contextlib
import difflib
import json
import platform
import shutil
import statistics
import subprocess
import sys
import tempfile
import venv
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent

ROUNDS = 5

WARM_UP, TIMED, LOOKED_AT = 5.0, 1.0, 2.5
"""How many seconds a simulator may take to warm up, for each timing, and to be looked at."""


@dataclass(frozen=True)
class Kind:
    """A simulator that can be compared: its package, the version that was tried, its script.

    settings: the ways to run it. without: why it is not run in a scene, by the scene's name.
    """

    package: str
    version: str
    script: str
    settings: tuple[str, ...] = ("",)
    without: Mapping[str, str] = field(default_factory=dict)

    @property
    def requirement(self) -> str:
        """What pip installs."""
        return f"{self.package}=={self.version}"


CONTACTS = ("P1", "P2", "P3")
"""The scenes in which bodies touch all the time."""

ROBOTS_ALONE = dict.fromkeys(CONTACTS, "its script builds neither square robots nor crates")

PEERS = {
    "pymunk": Kind("pymunk", "7.3.1", "pymunk_peer.py", ("1 mm", "15 substeps")),
    "Box2D": Kind(
        "Box2D",
        "2.3.10",
        "box2d_peer.py",
        ("1 mm", "15 substeps"),
        without=dict.fromkeys(("S1", "S3"), "its queries call Python back for each shape"),
    ),
    "navground": Kind(
        "navground", "0.7.0", "navground_peer.py", ("each step", "when changed"), ROBOTS_ALONE
    ),
    "ir-sim": Kind("ir-sim", "2.12.0", "irsim_peer.py", ("contact", "stop"), ROBOTS_ALONE),
    "vmas": Kind("vmas", "1.5.2", "vmas_peer.py", without=ROBOTS_ALONE),
    "aitk.robots": Kind(
        "aitk.robots",
        "2.0.0",
        "aitk_peer.py",
        without={"S4": "it takes half a minute to build, and some 4 s a step"} | ROBOTS_ALONE,
    ),
}
"""The peers by name."""

OURS = Kind("mars2d", "", "mars2d_peer.py", ("default", "loose"))

STEPS = {"S1": (200, 1000), "S2": (200, 100), "S3": (100, 50), "S4": (200, 20)}
STEPS |= dict.fromkeys(CONTACTS, (200, 50))
"""The steps of each scene to warm up, and those of each timing."""

TABLES = {"S": "robots", "P": "contacts"}
"""The tables of a Markdown file: the first letter of their scenes, and their names.

A table is replaced between the lines ``<!-- NAME: start -->`` and ``<!-- NAME: end -->``.
"""


class PeerError(Exception):
    """What people can put right: a wrong name or path, or a package that is missing."""


class Child:
    """A process in which one simulator runs one scene."""

    def __init__(self, name: str, kind: Kind, python: str, setting: str) -> None:
        self.label = f"{name}, {setting}" if setting else name
        self._errors = tempfile.TemporaryFile("w+", encoding="utf-8")  # noqa: SIM115
        self._process = subprocess.Popen(
            [python, str(HERE / kind.script), "--serve"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            text=True,
        )

    def ask(self, **order: Any) -> dict[str, Any]:
        """Give an order and return the answer. Raises PeerError when it fails."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.write(json.dumps(order) + "\n")
            self._process.stdin.flush()
        line = self._process.stdout.readline()
        while line and not line.startswith("{"):  # packages print when they are imported
            line = self._process.stdout.readline()
        if not line:
            self._errors.seek(0)
            raise PeerError(f"{self.label} broke off:\n{self._errors.read().strip()}")
        answer: dict[str, Any] = json.loads(line)
        if "error" in answer:
            raise PeerError(f"{self.label} is not fit to be timed: {answer['error']}")
        return answer

    def close(self) -> None:
        """End the process."""
        with contextlib.suppress(BrokenPipeError):
            self._process.communicate()
        self._errors.close()


@contextlib.contextmanager
def children(scene: str, pythons: dict[str, str]) -> Iterator[list[Child]]:
    """Start MARS2D and the peers, each with the scene; end them afterwards."""
    started: list[Child] = []
    kinds = [("MARS2D", OURS, sys.executable)]
    kinds += [(name, PEERS[name], python) for name, python in pythons.items()]
    try:
        for name, kind, python in kinds:
            if scene not in kind.without:
                for setting in kind.settings:
                    child = Child(name, kind, python, setting)
                    started.append(child)
                    child.ask(scene=scene, setting=setting)
        yield started
    finally:
        for child in started:
            child.close()


def compare(
    scene: str, pythons: dict[str, str], rounds: int, steps: int | None
) -> dict[str, dict[str, Any]]:
    """Run a scene in all simulators in turns; return what was measured, by label."""
    warm, timed = STEPS[scene] if steps is None else (steps, steps)
    with children(scene, pythons) as all_of_them:
        began = {c.label: c.ask(do="time", steps=warm, seconds=WARM_UP) for c in all_of_them}
        rows: dict[str, list[dict[str, Any]]] = {child.label: [] for child in all_of_them}
        for _ in range(rounds):
            for child in all_of_them:
                rows[child.label].append(child.ask(do="time", steps=timed, seconds=TIMED))
        seen = {c.label: c.ask(do="look", steps=warm, seconds=LOOKED_AT) for c in all_of_them}
    speeds = {label: [row["steps"] / row["seconds"] for row in rows[label]] for label in rows}
    ours = [label for label in rows if label.startswith("MARS2D")]
    return {
        label: {
            "steps_per_s": statistics.median(speed),
            "steps": sum(row["steps"] for row in rows[label]),
            "looked_at": seen[label]["steps"],
            "lost": seen[label]["lost"],
            "overlap_mm": {k: round(1e3 * seen[label][k], 3) for k in ("bodies", "walls")},
            "warm_up": {k: began[label][k] for k in ("steps", "robots", "crates")},
            "ratios": {
                mine: spread([a / b for a, b in zip(speeds[mine], speed, strict=True)])
                for mine in ours
            },
        }
        for label, speed in speeds.items()
    }


def spread(values: list[float]) -> list[float]:
    """Return the median, the least and the most."""
    return [round(value, 3) for value in (statistics.median(values), min(values), max(values))]


# -- which peers, and where they are --------------------------------------------------------------


def known(name: str) -> str:
    """Return the name of a peer. Raises PeerError, with the nearest one, for another."""
    if name not in PEERS:
        close = difflib.get_close_matches(name, PEERS, n=1)
        hint = f"; did you mean {close[0]!r}?" if close else "."
        raise PeerError(f"--peer: there is no peer {name!r}{hint} There are {', '.join(PEERS)}.")
    return name


def interpreter(text: str) -> tuple[str, str]:
    """Return the peer and the interpreter of ``NAME=PYTHON``. Raises PeerError."""
    name, _, python = text.partition("=")
    kind = PEERS[known(name)]
    if not python:
        raise PeerError(
            f"--peer {name}: say which interpreter has it, {name}=DIR/bin/python; "
            f"--install DIR makes one"
        )
    if shutil.which(python) is None:
        raise PeerError(
            f"--peer {name}: there is no interpreter {python}\n"
            f"  --install DIR makes environments for the peers, or by hand:\n"
            f"  python -m venv DIR && DIR/bin/python -m pip install {kind.requirement}"
        )
    return name, python


def version(name: str, python: str) -> str:
    """Return which version of a peer an interpreter has. Raises PeerError if it has none."""
    kind = PEERS[name]
    code = f"import importlib.metadata as m; print(m.version({kind.package!r}))"
    try:
        found = subprocess.run([python, "-c", code], capture_output=True, text=True, check=False)
    except OSError as error:
        raise PeerError(f"--peer {name}: {python} does not run: {error}") from error
    if found.returncode:
        raise PeerError(
            f"--peer {name}: {python} has no {kind.package}\n"
            f"  {python} -m pip install {kind.requirement}"
        )
    return found.stdout.strip()


def install(folder: Path, names: list[str]) -> list[str]:
    """Make an environment for each peer in a folder; return NAME=PYTHON of each."""
    made = []
    for name in names:
        requirement = PEERS[known(name)].requirement
        home = folder / name
        print(f"installing {requirement} in {home}", flush=True)
        venv.create(home, with_pip=True)
        python = home / ("Scripts/python.exe" if sys.platform == "win32" else "bin/python")
        command = [str(python), "-m", "pip", "install", "--quiet", requirement, "numpy"]
        if subprocess.run(command, check=False).returncode:
            raise PeerError(f"pip could not install {requirement} in {home}")
        made.append(f"{name}={python}")
    return made


# -- what is shown --------------------------------------------------------------------------------


def short(number: float) -> str:
    """Return a number to three digits, thousands apart."""
    return f"{float(f'{number:.3g}'):,g}".replace(",", " ")


def rows_of(scenes: dict[str, Any]) -> Iterator[tuple[str, ...]]:
    """Return the table's rows; see `HEADER`."""
    for scene, measured in scenes.items():
        complete = max(row["warm_up"]["steps"] for row in measured.values())
        for label, row in measured.items():
            ratios = [
                "1" if mine == label else f"{short(mid)} ({short(low)} to {short(high)})"
                for mine, (mid, low, high) in row["ratios"].items()
            ]
            overlap, way = row["overlap_mm"], row["warm_up"]
            yield (
                scene,
                label,
                short(row["steps_per_s"]),
                *ratios,
                f"{overlap['bodies']:.2f} / {overlap['walls']:.2f}",
                f"{row['lost']}",
                f"{row['steps']} / {row['looked_at']}",
                f"{way['robots']:.2f} / {way['crates']:.2f}" if way["steps"] == complete else "-",
            )


HEADER = (
    "scene",
    "simulator",
    "steps/s",
    "MARS2D by default is so many times as fast",
    "MARS2D, loose",
    "deepest overlap of bodies / with walls, mm",
    "lost",
    "steps timed / looked at",
    "way of robots / crates, m",
)


def table(result: dict[str, Any], letter: str) -> str:
    """Return the table in Markdown of the scenes with a letter, and what it was measured on."""
    scenes = {name: rows for name, rows in result["scenes"].items() if name.startswith(letter)}
    rows = [HEADER, ("---",) * len(HEADER), *rows_of(scenes)]
    there = {label.partition(",")[0].lower() for rows in scenes.values() for label in rows}
    versions = ", ".join(
        f"{name} {number}" for name, number in result["versions"].items() if name.lower() in there
    )
    note = (
        f"{result['rounds']} rounds on {result['machine']}; {versions}. Ratios: the median of "
        "those within a round (the least to the most)."
    )
    return "\n".join([*("| " + " | ".join(row) + " |" for row in rows), "", note])


def replace(file: Path, result: dict[str, Any]) -> None:
    """Put the tables of all scenes that were run into a Markdown file.

    Raises PeerError where it has no lines that mark them.
    """
    text = file.read_text(encoding="utf-8") if file.is_file() else ""
    for letter in dict.fromkeys(scene[0] for scene in result["scenes"]):
        start, end = (f"<!-- {TABLES[letter]}: {where} -->" for where in ("start", "end"))
        if start not in text or end not in text:
            raise PeerError(f"--markdown {file}: no such file with the lines {start} and {end}")
        head, _, rest = text.partition(start)
        text = f"{head}{start}\n{table(result, letter)}\n{end}{rest.partition(end)[2]}"
    file.write_text(text, encoding="utf-8")


def processor() -> str:
    """Return the kind of the processor and what runs on it."""
    name = platform.processor() or platform.machine()
    with contextlib.suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                name = line.partition(":")[2].strip()
                break
    return f"{name}, Python {platform.python_version()}"


def measure(arguments: argparse.Namespace) -> dict[str, Any]:
    """Run what was asked for, printing rows as they come, and return all of it."""
    import mars2d

    pythons = dict(interpreter(text) for text in arguments.peer)
    versions = {"mars2d": mars2d.__version__}
    for name, python in pythons.items():
        versions[name] = version(name, python)
        if versions[name] != PEERS[name].version:
            print(f"note: {name} is {versions[name]}; {PEERS[name].version} was tried")
    result: dict[str, Any] = {
        "machine": processor(),
        "rounds": arguments.rounds,
        "versions": versions,
        "scenes": {},
    }
    for scene in arguments.scenes:
        measured = compare(scene, pythons, arguments.rounds, arguments.steps)
        result["scenes"][scene] = measured
        for row in rows_of({scene: measured}):
            print(
                "{:<4}{:<26}{:>9} steps/s  x {:<26} x {:<26} {:>15} mm  {:>3} lost  {:>12}"
                "  {} m".format(*row)
            )
        for name in pythons:
            if scene in PEERS[name].without:
                print(f"{scene:<4}{name:<26} left out: {PEERS[name].without[scene]}")
        sys.stdout.flush()
    return result


def main() -> None:
    """Install peers, or compare with them; print, and write what is asked for."""
    parser = argparse.ArgumentParser(description="How fast MARS2D is beside its peers.")
    which = f"a peer and the interpreter that has it: {', '.join(PEERS)}"
    parser.add_argument("--peer", action="append", default=[], metavar="NAME=PYTHON", help=which)
    parser.add_argument("--install", type=Path, metavar="DIR", help="make the peers' environments")
    parser.add_argument("--scenes", nargs="+", choices=STEPS, default=list(STEPS))
    parser.add_argument("--rounds", type=int, default=ROUNDS, help="how often all are timed")
    parser.add_argument("--steps", type=int, help="steps of a timing, instead of the scenes' own")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    parser.add_argument("--markdown", type=Path, metavar="FILE.md", help="replace its tables")
    arguments = parser.parse_args()
    try:
        if arguments.install is not None:
            made = install(arguments.install, arguments.peer or list(PEERS))
            print("now: python", *sys.argv[:1], *(f"--peer {text}" for text in made))
            return
        result = measure(arguments)
        if arguments.json is not None:
            arguments.json.write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")
        if arguments.markdown is not None:
            replace(arguments.markdown, result)
    except PeerError as error:
        print(error, file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()
