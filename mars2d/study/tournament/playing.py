"""Playing a tournament: each match in a process, the folder kept up to date."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager, nullcontext
from functools import partial
from pathlib import Path

from mars2d.core.interrupt import noted_interrupts
from mars2d.core.progress import Progress
from mars2d.study.code import Watched
from mars2d.study.isolation.limits import Limits
from mars2d.study.run import duration
from mars2d.study.tournament.entrants import law_code
from mars2d.study.tournament.folder import Folder
from mars2d.study.tournament.match import Match, Played, play
from mars2d.study.tournament.schedule import Schedule
from mars2d.study.tournament.tournament import Tournament
from mars2d.study.work import Failure, each_done, worker_count

__all__ = ["TournamentInterrupted", "play_all", "play_schedule"]


class TournamentInterrupted(KeyboardInterrupt):
    """Ctrl-C during a tournament; `tournament` holds the matches that were done until then."""

    def __init__(self, message: str, tournament: Tournament) -> None:
        super().__init__(message)
        self.tournament = tournament


def play_schedule(
    planned: Schedule,
    limits: Limits,
    out: Path | None = None,
    *,
    executor: Executor | None = None,
    workers: int | None = None,
    replays: bool = True,
    show_progress: bool = True,
) -> Tournament:
    """Play those matches of a schedule that its folder `out` does not hold; save and return all.

    The arguments are those of `mars2d.tournament`. Raises TournamentInterrupted after Ctrl-C, once
    what was played is saved.
    """
    if executor is None:
        worker_count(workers)
    with nullcontext() if out is None else Folder(out, planned, limits, replays) as folder:
        done = [] if folder is None else [*folder.before]
        missing = matches_without(planned.matches, done)
        interrupted = False
        with _bar(len(missing), show_progress) as advance:
            try:
                with noted_interrupts() as check:
                    for played in play_all(missing, limits, replays, executor, workers):
                        done.append(played)
                        if folder is not None:
                            folder.keep(played)
                        advance()
                        check()
            except KeyboardInterrupt:
                interrupted = True
    result = Tournament.of(planned, done)
    if out is not None:
        result.save_all(out)
    if interrupted:
        where = "were played" if out is None else f"are in {out}; the same command goes on"
        said = f"{len(done)} of {len(planned.matches)} matches {where}"
        raise TournamentInterrupted(said, result)
    return result


def matches_without(matches: Iterable[Match], played: Iterable[Played]) -> list[Match]:
    """Return those matches that were not played."""
    done = {each.match.number for each in played}
    return [match for match in matches if match.number not in done]


@contextmanager
def _bar(total: int, shown: bool) -> Iterator[Callable[[], None]]:
    """Show a progress bar; yield what counts one more match."""
    if not shown:
        yield lambda: None
        return
    bar, start, numbers = Progress(total), time.monotonic(), itertools.count(1)

    def advance() -> None:
        done = next(numbers)
        left = (time.monotonic() - start) / done * (total - done)
        bar.update(done, f"{done}/{total}, {duration(left)} left")

    try:
        yield advance
    finally:
        bar.close()


def play_all(
    matches: Sequence[Match],
    limits: Limits,
    replays: bool,
    executor: Executor | None = None,
    workers: int | None = None,
) -> Iterator[Played]:
    """Play matches, each in another process, and yield how they went, as they come.

    A match has no result where its process fails, and where one of its laws changes meanwhile.
    """
    function: Callable[[Match], Played] = partial(play, limits=limits, replays=replays)
    watched = _watched(matches)
    for index, done in each_done(function, matches, executor, workers):
        match = matches[index]
        changed = [file for role in match.files.values() if (file := watched[role].changed())]
        if changed:
            yield Played.without_result(match, f"{changed[0].name} has changed meanwhile")
        elif isinstance(done, Failure):
            yield Played.without_result(match, done.error)
        else:
            yield done


def _watched(matches: Sequence[Match]) -> dict[str, Watched]:
    """Return for each law what tells whether it changes while matches are played."""
    watched = {file: Watched() for match in matches for file in match.files.values()}
    for file, watch in watched.items():
        watch.add(law_code(Path(file)))
    return watched
