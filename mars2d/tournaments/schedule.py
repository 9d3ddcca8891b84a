"""Schedules: the laws that take part in a tournament, and its matches, in order."""

from __future__ import annotations

import glob
import itertools
import os
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mars2d.core.description import wrong
from mars2d.core.errors import InputError, likely, nearest, shown
from mars2d.scenario.examples import examples, experiment_name
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.scenario.policy import SUFFIX as POLICY
from mars2d.scenario.roles import contest_of, roles_of
from mars2d.study.plan import MAX_RUNS, seeds_of
from mars2d.tournaments.isolation.limits import LIMITS, Limits
from mars2d.tournaments.isolation.source import law_code
from mars2d.tournaments.match import Match

Files = str | Path | Sequence[str | Path]
"""One or several files of laws, folders or patterns."""

TRIALS = 3
"""How many matches try a single law."""

SUFFIXES = (".py", POLICY)
"""The suffixes of the files of laws: in Python, and learned."""

EXPECTED = "expected files of laws (.py or .onnx), a folder of them, or a pattern as laws/*.py"


@dataclass(frozen=True)
class Schedule:
    """All matches of a tournament, in order: pairing by pairing, seed by seed.

    experiment: a file, or the name of an example. roles: those of its contest, in order. limits: of
    each law. files: those that were read for the experiment itself. title: of its scenario. colors:
    those of each role's robots, each once.
    """

    experiment: str
    roles: tuple[str, ...]
    limits: Limits
    matches: tuple[Match, ...] = field(repr=False)
    files: frozenset[Path] = field(repr=False)
    title: str
    colors: Mapping[str, tuple[str, ...]] = field(repr=False)


def schedule(
    experiment: str | Path,
    roles: Mapping[str, Files] | None = None,
    players: Files | None = None,
    *,
    seeds: int | Iterable[int] = 10,
    first_seed: int = 0,
    options: Mapping[str, Any] | None = None,
    stop_time: float | None = None,
    limits: Limits = LIMITS,
) -> Schedule:
    """Return the schedule in which each law of a role plays each of the other, with all seeds.

    The arguments are those of `mars2d.tournament`. The laws' files are read, but not run. Raises
    InputError for anything that can't be played.
    """
    if not isinstance(experiment, (str, Path)):
        raise wrong("experiment", experiment, "a file, or the name of an example")
    seeds = seeds_of(seeds, first_seed)
    options = {**(options or {}), **({} if stop_time is None else {"stop_time": stop_time})}
    opened, names = _opened(experiment, options, seeds[0])
    _check_names(options, names)
    beside = Path(opened.source.path or "").parent
    taking_part = entrants(names, roles or {}, players or (), beside)
    pairings = [
        {role: str(law) for role, law in zip(names, laws, strict=True)}
        for laws in itertools.product(*taking_part.values())
        if len({*laws}) == len(laws)  # a law does not play itself
    ]
    if not pairings:
        raise InputError("there is nobody to play against: a law does not play itself")
    count = len(pairings) * len(seeds)
    if count > MAX_RUNS:
        raise InputError(f"these are {count:,} matches: {MAX_RUNS:,} at most")
    named = str(experiment) if str(experiment) in examples() else str(opened.source.path)
    law_names = names_of(law for laws in taking_part.values() for law in laws)
    code = {law: law_code(Path(law)) for law in law_names}
    matches = tuple(
        Match(
            number=number,
            experiment=named,
            options=options,
            seed=seed,
            laws={role: law_names[law] for role, law in files.items()},
            files=files,
            code={role: code[law] for role, law in files.items()},
        )
        for number, (files, seed) in enumerate(itertools.product(pairings, seeds), 1)
    )
    return Schedule(
        experiment=named,
        roles=names,
        limits=limits,
        matches=matches,
        files=frozenset(opened.source.written),
        title=opened.scenario.title or experiment_name(Path(named)),
        colors={
            role: tuple(dict.fromkeys(opened.scenario.colors[robot] for robot in team))
            for role, team in roles_of(opened.scenario).items()
        },
    )


def trial_matches(
    experiment: str, role: str, laws: Files, options: Mapping[str, Any]
) -> tuple[Match, ...]:
    """Return a few matches of each law in a role, whose rivals are the experiment's own laws.

    Raises InputError for a role or a file that is not there.
    """
    opened, names = _opened(experiment, options)
    if role not in names:
        raise InputError(f"--role {role}: {experiment} has no such role{nearest(role, names)}")
    files = law_files(laws, Path(opened.source.path or "").parent)
    each = itertools.product(files, range(TRIALS))
    return tuple(
        Match(number, experiment, options, seed, {role: file.stem}, {role: str(file)})
        for number, (file, seed) in enumerate(each, 1)
    )


def _opened(
    experiment: str | Path, options: Mapping[str, Any], seed: int | None = None
) -> tuple[Experiment, tuple[str, ...]]:
    """Return an experiment with a contest, and its roles."""
    opened = open_experiment(experiment, options, seed=seed)
    contest_of(opened.scenario, str(experiment))
    return opened, tuple(roles_of(opened.scenario))


def _check_names(options: Iterable[str], roles: Sequence[str]) -> None:
    """Refuse options that differ from match to match."""
    for name in options:
        if name == "seed":
            raise InputError("option 'seed': say how many there are, with --seeds N")
        if name in roles:
            raise InputError(
                f"option {name!r}: this is a role; name its laws by --role {name}=FILES"
            )


# -- entrants --------------------------------------------------------------------------------------


def law_files(named: Files, beside: Path = Path()) -> tuple[Path, ...]:
    """Return the files that names stand for: absolute paths, each once.

    named: a file, a folder (all its laws except those that begin with _), a pattern, or
    several of these, separated by commas or as a list. beside: a folder that is searched for
    relative names after the current one. Raises InputError, with the nearest name, if there is no
    such file.
    """
    given = [named] if isinstance(named, (str, Path)) else named
    if not isinstance(given, Iterable) or not all(isinstance(each, (str, Path)) for each in given):
        raise InputError(f"{shown(named)}: {EXPECTED}")
    parts = [part.strip() for each in given for part in str(each).split(",") if part.strip()]
    if given and not parts:
        raise InputError(f"{named!r}: {EXPECTED}")
    folders = (Path.cwd(), beside)
    return tuple(dict.fromkeys(file for part in parts for file in _files(part, folders)))


def _files(part: str, folders: Sequence[Path]) -> list[Path]:
    """Return the files that one name stands for; their paths have no `..`."""
    for folder in folders:
        path = folder / part
        if path.is_file() and path.suffix in SUFFIXES:
            return [Path(os.path.normpath(path))]
        if path.is_file():
            raise InputError(f"{part}: expected the file of a law, which ends in .py or .onnx")
        inside = path.iterdir() if path.is_dir() else glob.glob(str(path))  # noqa: PTH207 - absolute
        found = [Path(os.path.normpath(each)) for each in inside]
        laws = [each for each in found if each.suffix in SUFFIXES and each.name[0] != "_"]
        if laws:
            return sorted(filter(Path.is_file, laws))
        if path.is_dir():
            raise InputError(f"{part}: no law in this folder; {EXPECTED}")
    parent = Path(part).parent
    others = [path for folder in folders for path in (folder / parent).glob("*")]
    names = [str(parent / path.name) for path in others if path.is_dir() or path.suffix in SUFFIXES]
    raise InputError(f"{part}: no such file; {EXPECTED}{likely(part, names)}")


def entrants(
    roles: Sequence[str],
    given: Mapping[str, Files],
    players: Files = (),
    beside: Path = Path(),
) -> dict[str, tuple[Path, ...]]:
    """Return each role's laws: those given for it, and the players, which play every role.

    beside: see `law_files`. Raises InputError for an unknown role, a role without laws, and missing
    files.
    """
    for role in given:
        if role not in roles:
            raise InputError(f"there is no role {role!r}{nearest(role, roles)}")
    every = law_files(players, beside)
    found = {}
    for role in roles:
        own = law_files(given.get(role, ()), beside)
        laws = tuple(dict.fromkeys((*own, *every)))
        if not laws:
            raise InputError(
                f"no laws for the role {role!r}: name them by --role {role}=FILES, "
                "or by --players FILES those that play every role"
            )
        found[role] = laws
    return found


def names_of(files: Iterable[str | Path]) -> dict[str, str]:
    """Return a name for each law's file: its own, preceded by folders where needed to be unique.

    Characters that nobody sees are escaped, also line breaks.

    >>> names_of(["a/hunt.py", "b/hunt.py", "b/flee.py"])
    {'a/hunt.py': 'a/hunt', 'b/hunt.py': 'b/hunt', 'b/flee.py': 'flee'}
    """
    names = {}
    for file in dict.fromkeys(map(Path, files)):
        parts = file.with_suffix("").parts
        names[str(file)] = ["/".join(parts[-k:]) for k in range(1, len(parts) + 1)]
    counts = Counter(itertools.chain(*names.values()))
    return {
        file: repr(next((name for name in ends if counts[name] == 1), file))[1:-1]
        for file, ends in names.items()
    }
