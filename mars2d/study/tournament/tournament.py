"""Tournaments: play the laws of one role against those of the other, each match in a process."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import Any

from mars2d.core.interrupt import interrupts
from mars2d.study.isolation.limits import Limits
from mars2d.study.progress import progress
from mars2d.study.tournament.folder import Folder
from mars2d.study.tournament.league import Tournament
from mars2d.study.tournament.match import Match, Played, play
from mars2d.study.tournament.page import save_html
from mars2d.study.tournament.schedule import Files, Schedule, law_code, schedule
from mars2d.study.tournament.watch import WatchedFiles
from mars2d.study.work import Failure, each_done, leave_if_imported_again, worker_count

MATCHES, LEAGUE, PAGE = "matches.csv", "league.csv", "league.html"
"""The files that are written to a tournament's folder at the end."""

LIMITS = Limits()
"""The default limits of a law."""


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
    settings: Mapping[str, Any] | None = None,
    stop_time: float | None = None,
    limits: Limits = LIMITS,
    executor: Executor | None = None,
    workers: int | None = None,
    replays: bool = True,
    out: str | Path | None = None,
    show_progress: bool = True,
) -> Tournament:
    """Let each law of one role play each law of the other, and return the standings and matches.

    experiment: a file, or the name of an example, with one add-on that decides who has won. roles:
    the files of each role's laws, also folders or patterns, such as {"pursuer": "pursuers/*.py"}.
    players: files of laws that play every role; no law plays itself. seeds: how many matches each
    pairing plays, from first_seed on, or a list of seeds, which are the same for all pairings.
    settings: options of the experiment; lists of values make rounds, in each of which every pairing
    plays. stop_time: seconds, in place of the scenario's. limits: those of each law; a law that
    exceeds them or raises forfeits the match. executor, workers: see `mars2d.sweep`. replays:
    whether the page has replays. out: a folder to which matches are written as they are played, and
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
        settings=settings,
        stop_time=stop_time,
    )
    return play_schedule(
        planned,
        limits,
        None if out is None else Path(out),
        executor=executor,
        workers=workers,
        replays=replays,
        show_progress=show_progress,
    )


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
    """Play the matches of a schedule that its folder `out` does not hold; save and return all.

    The arguments are those of `mars2d.tournament`. After Ctrl-C the matches so far are saved, then
    TournamentInterrupted is raised.
    """
    if executor is None:
        worker_count(workers)
    with nullcontext() if out is None else Folder(out, planned, limits, replays) as folder:
        done = [] if folder is None else [*folder.before]
        missing = matches_without(planned.matches, done)
        interrupted = False
        bar = progress(len(missing), unit="match", show=show_progress)
        try:
            with interrupts() as check:
                for played in play_all(missing, limits, replays, executor, workers):
                    done.append(played)
                    if folder is not None:
                        folder.keep(played)
                    bar.update()
                    check()
        except KeyboardInterrupt:
            interrupted = True
        finally:
            bar.close()
    result = Tournament.of(planned, done)
    if out is not None:
        save_all(result, out)
    if interrupted:
        where = "were played" if out is None else f"are in {out}; the same command goes on"
        said = f"{len(done)} of {len(planned.matches)} matches {where}"
        raise TournamentInterrupted(said, result)
    return result


def save_all(result: Tournament, folder: Path) -> None:
    """Write both tables and the page of a tournament to a folder."""
    result.save_csv(folder / MATCHES)
    result.save_csv(folder / LEAGUE, "league")
    save_html(result, folder / PAGE)


def matches_without(matches: Iterable[Match], played: Iterable[Played]) -> list[Match]:
    """Return the matches that were not played."""
    done = {each.match.number for each in played}
    return [match for match in matches if match.number not in done]


def play_all(
    matches: Sequence[Match],
    limits: Limits,
    replays: bool,
    executor: Executor | None = None,
    workers: int | None = None,
) -> Iterator[Played]:
    """Play each match in another process, and yield results as they come.

    A match has no result if its process fails, or if the file of one of its laws changes meanwhile.
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


def _watched(matches: Sequence[Match]) -> dict[str, WatchedFiles]:
    """Return a watch on the files of each law."""
    watched = {file: WatchedFiles() for match in matches for file in match.files.values()}
    for file, watch in watched.items():
        watch.add(law_code(Path(file)))
    return watched
