"""Mutation testing: change the program in one place at a time, and see whether a test fails.

``python -m tests.mutants --help``. The mutants are those of mutmut, properties included. They lie
beside each other in a copy of the package; tests are collected once, and each mutant is tried in a
fork of that process, by the tests that call its function, the quickest first.
"""

from __future__ import annotations

import argparse
import difflib
import json
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from fnmatch import fnmatch
from itertools import zip_longest
from pathlib import Path
from random import Random
from typing import Any

import libcst
import pytest
from _pytest.runner import runtestprotocol
from mutmut.mutation import file_mutation

TARGETS = ("core/plane.py", "bodies/drives/*.py", "bodies/team.py", "sensors/*.py", "world/loop.py")
LEFT_OUT = ("sensors/error_model.py", "sensors/sensing.py")
TESTS = (
    "core/test_plane", "bodies/test_drives", "sensors/test_sensing", "sensors/test_sensors",
    "sensors/test_sensors_bearing", "sensors/test_sensors_motion", "sensors/test_sensors_rays",
    "addons/test_floor_addon", "world/test_world", "world/test_session", "output/formats/test_mcap",
)  # fmt: skip
QUIET = (
    "-q", "-p", "no:cacheprovider", "-m", "not nightly",
    "-k", "not in_no_time",  # a busy machine kills nobody
)  # fmt: skip
ASLEEP = 600
"""After so long a mutant that waits for something is out of time, seconds."""
SURVIVED, KILLED, OUT_OF_TIME, UNTESTED = "survived", "killed", "timeout", "untested"
VERDICTS = (KILLED, SURVIVED, OUT_OF_TIME, UNTESTED)


class _Visitor(file_mutation.MutationVisitor):
    """mutmut leaves out whatever is decorated; here that is properties, which can be mutated."""

    def _skip_node_and_children(self, node: libcst.CSTNode) -> bool:
        if isinstance(node, libcst.FunctionDef):
            if any(param.name.value == "scene" for param in node.params.params):
                return True  # reference pictures tell whether it draws right
            if node.decorators:
                return False
        return super()._skip_node_and_children(node)


file_mutation.MutationVisitor = _Visitor


class Mutants:
    """All mutants of the targets, in a copy of the package."""

    def __init__(self, folder: Path) -> None:
        """Write the copy into `folder`."""
        package = Path("mars2d")
        shutil.copytree(package, folder / package)
        (folder / "examples").symlink_to(Path("examples").absolute())
        shutil.copy(Path(__file__).with_name("trampoline.py"), folder / package)
        self.file: dict[str, Path] = {}
        self._source: dict[str, list[str]] = {}
        for path in _targets():
            made = file_mutation.mutate_file_contents(str(path), path.read_text())
            code = made.code.replace("from mutmut.mutation.", "from mars2d.")
            (folder / path).write_text(code)
            lines = code.splitlines()
            module = ".".join(path.with_suffix("").parts)
            for name in made.mutant_names:
                self.file[f"{module}.{name}"] = path
            for name, span in made.line_span_by_function_name.items():
                text = lines[span.start - 1 : span.end]
                self._source[f"{module}.{name}"] = [line.replace(name, "") for line in text]

    def sample(self, size: int | None) -> list[str]:
        """Return so many mutants of each file, or all: the first of each, the second, ..."""
        each: dict[Path, list[str]] = {}
        for name, file in self.file.items():
            each.setdefault(file, []).append(name)
        for names in each.values():
            Random(1).shuffle(names)
        turns = zip_longest(*(names[:size] for names in each.values()))
        return [name for turn in turns for name in turn if name]

    def difference(self, name: str) -> str:
        """Return what a mutant changes, as a diff without its surroundings."""
        was, now = self._source[f"{_function(name)}_orig"], self._source[name]
        changed = difflib.unified_diff(was, now, n=0, lineterm="")
        return "\n".join(line for line in changed if line[:3] not in ("---", "+++", "@@ "))


def _function(mutant: str) -> str:
    return mutant.rpartition("_")[0]


class Trial:
    """A pytest plugin: in place of running the tests, tries each mutant by them."""

    def __init__(self, names: list[str], seconds: float, processes: int, file: Path) -> None:
        """Take the mutants, for how many seconds of tests each one is tried, and a file."""
        self.names, self.seconds, self.processes, self.file = names, seconds, processes, file
        self.calm = file.with_suffix(".calm")
        self.verdict: dict[str, str] = {}

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Try all."""
        from mars2d import trampoline  # of the copy

        self._trampoline, self._imported = trampoline, set(trampoline.called)
        took, calls = self._calm(session.items)
        took = {item.nodeid: took[item.nodeid] for item in session.items}
        items = dict(zip((item.nodeid for item in session.items), session.items, strict=True))
        running: dict[int, str] = {}
        for name in self.names:
            if len(running) == self.processes:
                self._await(running)
            who = [i for i in sorted(took, key=took.__getitem__) if _function(name) in calls[i]]
            if not who and _function(name) in self._imported:
                running[self._fresh(name)] = name
                continue
            if not who:
                self._note(name, UNTESTED)
                continue
            chosen, total = [], 0.0
            for i in who:
                chosen.append(items[i])
                total += took[i]
                if total > self.seconds:
                    break
            running[self._fork(name, chosen, 10 + 10 * total)] = name
        while running:
            self._await(running)
        return True

    def _calm(self, items: list[pytest.Item]) -> tuple[dict[str, float], dict[str, set[str]]]:
        """Return how long each test takes and what it calls while nothing is mutated.

        In a fork, as what tests leave behind may hide what a mutant does.
        """
        if not _newer(self.calm, [Path(__file__), *_targets(), *map(Path, _files())]):
            if (child := os.fork()) == 0:
                self._calmly(items)
                os._exit(0)
            os.waitpid(child, 0)
        known: dict[str, Any] = json.loads(self.calm.read_text())
        took = {test: seconds for test, (seconds, _) in known.items()}
        self._unfit = [test for test, (_, calls) in known.items() if calls is None]
        return took, {test: set(calls or ()) for test, (_, calls) in known.items()}

    def _calmly(self, items: list[pytest.Item]) -> None:
        """Run the tests and write how long each takes and what it calls; None where it fails."""
        known = {}
        for item, following in zip(items, [*items[1:], None], strict=True):
            self._trampoline.called.clear()
            start = time.process_time()
            fails = _fails(item, following)  # as it looks at the code itself, say
            calls = None if fails else sorted(self._trampoline.called)
            known[item.nodeid] = time.process_time() - start, calls
        self.calm.write_text(json.dumps(known))

    def _fork(self, name: str, items: list[pytest.Item], limit: float) -> int:
        """Start a process that tries a mutant, and return its id."""
        if (child := os.fork()) == 0:
            resource.setrlimit(resource.RLIMIT_CPU, (int(limit), int(limit)))
            signal.alarm(ASLEEP)
            self._trampoline.alive = name
            pairs = zip(items, [*items[1:], None], strict=True)
            os._exit(any(_fails(item, following) for item, following in pairs))
        return child

    def _fresh(self, name: str) -> int:
        """Start a process that tries a mutant from the import on, and return its id."""
        run = [sys.executable, "-P", "-m", "pytest", *QUIET, "-x", *_files()]
        run += [f"--deselect={test}" for test in self._unfit]
        path = os.pathsep.join(sys.path[:2])
        quiet = [(os.POSIX_SPAWN_OPEN, out, os.devnull, os.O_WRONLY, 0) for out in (1, 2)]
        environment = {**os.environ, "MUTANT": name, "PYTHONPATH": path}
        return os.posix_spawn(run[0], run, environment, file_actions=quiet)

    def _await(self, running: dict[int, str]) -> None:
        """Wait for one process to end."""
        child, status = os.wait()
        code = os.waitstatus_to_exitcode(status)
        name = running.pop(child)
        late = code in (-signal.SIGXCPU, -signal.SIGALRM)
        self._note(name, SURVIVED if code == 0 else OUT_OF_TIME if late else KILLED)

    def _note(self, name: str, verdict: str) -> None:
        self.verdict[name] = verdict
        with self.file.open("a") as file:
            file.write(f"{name} {verdict}\n")


def _fails(item: pytest.Item, following: pytest.Item | None) -> bool:
    return any(report.failed for report in runtestprotocol(item, log=False, nextitem=following))


def _targets() -> list[Path]:
    package = Path("mars2d")
    found = {path for target in TARGETS for path in package.glob(target)}
    return sorted(found - {package / name for name in LEFT_OUT})


def _newer(file: Path, than: list[Path]) -> bool:
    """Return whether a file is there and was written after all others."""
    changed = max(path.stat().st_mtime for path in than)
    return file.exists() and file.stat().st_mtime > changed


def _files() -> Iterator[str]:
    return (f"tests/{name}.py" for name in TESTS)


def main() -> None:
    """Try mutants, print the survivors and the score of each file."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutants", description=__doc__)
    parser.add_argument("names", nargs="*", default=["*"], help="patterns of mutants' names")
    parser.add_argument("--seconds", type=float, default=60.0, help="of tests for one mutant")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--sample", type=int, help="so many of each file, by a fixed seed")
    parser.add_argument("--verdicts", type=Path, required=True, help="where they are kept; those "
                        "killed there are not tried again")  # fmt: skip
    options: Any = parser.parse_args()
    if not _newer(options.verdicts, _targets()):  # else its names may be those of other mutants
        options.verdicts.write_text("")
    kept = dict(line.rsplit(" ", 1) for line in options.verdicts.read_text().splitlines())
    with tempfile.TemporaryDirectory() as folder:
        mutants = Mutants(Path(folder))
        names = [n for n in mutants.sample(options.sample) if kept.get(n) != KILLED]
        names = [n for n in names if any(fnmatch(n, each) for each in options.names)]
        sys.path.insert(0, folder)
        trial = Trial(names, options.seconds, options.processes, options.verdicts)
        if pytest.main([*QUIET, *_files()], plugins=[trial]) not in (0, 5):
            sys.exit("the tests can't be run")
    verdict = {**kept, **trial.verdict}
    for name, said in sorted(verdict.items()):
        if said in (SURVIVED, UNTESTED):
            print(f"\n{name}: {said}\n{mutants.difference(name)}")
    print(f"\n{'':28}", *(f"{each:>9}" for each in VERDICTS))
    for file in [*dict.fromkeys(mutants.file.values()), None]:
        mine = [said for name, said in verdict.items() if file in (mutants.file[name], None)]
        score = Counter(mine)
        print(f"{file or 'all'!s:28}", *(f"{score[each]:9}" for each in VERDICTS))


if __name__ == "__main__":
    main()
