"""Tournaments: play the laws of one role against those of the other, each match in a process."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import Any

from mars2d.core.interrupt import interrupts
from mars2d.core.progress import progress
from mars2d.study.work import Failure, each_done, leave_if_imported_again, worker_count
from mars2d.tournaments.folder import Folder
from mars2d.tournaments.isolation.limits import LIMITS, OUT_OF_TIME, Limits
from mars2d.tournaments.league import Tournament
from mars2d.tournaments.match import Match, Played, play, settled
from mars2d.tournaments.page import league_page, save_page
from mars2d.tournaments.schedule import Files, Schedule, schedule

PAGE = "league.html"
"""The page in a tournament's folder."""


class TournamentInterrupted(KeyboardInterrupt):
    """Ctrl-C during a tournament; `tournament` holds the matches that were done by then."""

    def __init__(self, message: str, tournament: Tournament) -> None:
        super().__init__(message)
        self.tournament = tournament


def tournament(
    experiment: str | Path,
    roles: Mapping[str, Files] | None = None,
    players: Files | None = None,
    *,
    seeds: int | Sequence[int] = 10,
    first_seed: int = 0,
    options: Mapping[str, Any] | None = None,
    stop_time: float | None = None,
    limits: Limits = LIMITS,
    executor: Executor | None = None,
    workers: int | None = None,
    out: str | Path | None = None,
    show_progress: bool = True,
) -> Tournament:
    """Let each law of one role play each law of the other, and return the standings and matches.

    experiment: a file, or the name of an example, with one add-on that decides who has won. roles:
    the files of each role's laws, also folders or patterns, such as {"pursuer": "pursuers/*.py"}.
    players: files of laws that play every role; no law plays itself. seeds: how many matches each
    pairing plays, from first_seed on, or a list of seeds, which are the same for all pairings.
    options: of the experiment, as for `mars2d.run`. stop_time: seconds, in place of the scenario's.
    limits: those of each law; a law that exceeds them or raises forfeits the match. executor,
    workers: see `mars2d.sweep`. out: a folder to which matches are written as they are played, and
    at the end the tables and the page; if interrupted, the same call goes on. show_progress:
    whether a terminal shows a bar.

    Raises InputError, before any match, for anything that can't be played;
    TournamentInterrupted after Ctrl-C.
    """
    leave_if_imported_again()
    planned = schedule(
        experiment,
        roles,
        players,
        seeds=seeds,
        first_seed=first_seed,
        options=options,
        stop_time=stop_time,
        limits=limits,
    )
    return play_schedule(
        planned,
        None if out is None else Path(out),
        executor=executor,
        workers=workers,
        show_progress=show_progress,
    )


def play_schedule(
    planned: Schedule,
    out: Path | None = None,
    *,
    executor: Executor | None = None,
    workers: int | None = None,
    show_progress: bool = True,
) -> Tournament:
    """Play the matches of a schedule that its folder `out` does not hold; save and return all.

    The arguments are those of `mars2d.tournament`. After Ctrl-C the matches so far are saved, then
    TournamentInterrupted is raised.
    """
    if executor is None:
        worker_count(workers)
    function = partial(play, limits=planned.limits)
    with nullcontext() if out is None else Folder(out, planned) as folder:
        done = [] if folder is None else [*folder.before]
        bar = progress(len(planned.matches), "match", len(done), show=show_progress)
        interrupted = False
        try:
            with bar as update, interrupts() as check:
                for played in _each_played(planned, done, function, executor, workers):
                    done.append(played)
                    if folder is not None:
                        folder.keep(played)
                    update(len(done))
                    check()
        except KeyboardInterrupt:
            interrupted = True
    result = Tournament(planned, tuple(settled(planned.matches, done)))
    if out is not None:
        for table in ("matches", "league", "grades"):
            result.save_csv(out / f"{table}.csv", table)
        save_page(league_page(result), out / PAGE)
    if interrupted:
        where = "were played" if out is None else f"are in {out}; the same command goes on"
        said = f"{len(result.matches)} of {len(planned.matches)} matches {where}"
        raise TournamentInterrupted(said, result)
    return result


def _each_played(
    planned: Schedule,
    done: Sequence[Played],
    function: Callable[[Match], Played],
    executor: Executor | None,
    workers: int | None,
) -> Iterator[Played]:
    """Yield matches as they are played, until none is missing; the caller adds them to `done`.

    When a law is out of time for good, the matches that are left to it are not begun.
    """
    while left := missing(planned, done):
        for count, (index, played) in enumerate(each_done(function, left, executor, workers), 1):
            if isinstance(played, Failure):
                yield Played.without_result(left[index], played.error)
                continue
            yield played
            late = any(verdict.kind in OUT_OF_TIME for verdict in played.verdicts.values())
            if late and len(missing(planned, done)) < len(left) - count:
                break


def missing(planned: Schedule, played: Sequence[Played]) -> list[Match]:
    """Return the matches that are still to be played."""
    known = {each.match.number for each in settled(planned.matches, played)}
    return [match for match in planned.matches if match.number not in known]
