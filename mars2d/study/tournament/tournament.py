"""Tournaments: the laws of one role against those of the other, and who stands first."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mars2d.core.errors import InputError, MissingExtraError
from mars2d.core.files import atomic_write
from mars2d.study.isolation.limits import Limits

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from concurrent.futures import Executor

    from pandas import DataFrame

    from mars2d.study.tournament.entrants import Files
    from mars2d.study.tournament.league import Standing
    from mars2d.study.tournament.match import Played
    from mars2d.study.tournament.schedule import Schedule

__all__ = ["LEAGUE", "LIMITS", "MATCHES", "PAGE", "Tournament", "tournament"]

LIMITS = Limits()
"""What a law may use, unless something else is said."""

MATCHES, LEAGUE, PAGE = "matches.csv", "league.csv", "league.html"
"""The files in a tournament's folder that are made at the end."""


@dataclass(frozen=True)
class Tournament:
    """What a tournament came to.

    title, experiment: what was played. roles: of its contest. matches: how each went, in order.
    standings: how each law stands, best first, role by role where laws play one only. settings:
    what tells its rounds from one another.
    """

    title: str
    experiment: str
    roles: tuple[str, ...]
    matches: tuple[Played, ...] = field(repr=False)
    standings: tuple[Standing, ...]
    settings: tuple[str, ...] = ()

    @classmethod
    def of(cls, schedule: Schedule, matches: Iterable[Played]) -> Tournament:
        """Return what those matches of a schedule came to that were played, in whatever order."""
        from mars2d.study.tournament.league import league

        done = tuple(sorted(matches, key=lambda played: played.match.number))
        return cls(
            title=schedule.title,
            experiment=schedule.experiment,
            roles=schedule.roles,
            matches=done,
            standings=tuple(league(done, schedule.roles)),
            settings=schedule.settings,
        )

    def rows(self) -> tuple[dict[str, Any], ...]:
        """Return a row a match: its number, settings, seed, laws, and how it went.

        ``verdict`` says of a law that failed in which role and how, as ``pursuer: slow``.
        """
        return tuple(self._row(played) for played in self.matches)

    def _row(self, played: Played) -> dict[str, Any]:
        match = played.match
        settings = {name: match.options.get(name) for name in self.settings}
        verdicts = [f"{role}: {verdict.kind}" for role, verdict in played.verdicts.items()]
        return {
            "match": match.number,
            **settings,
            "seed": match.seed,
            **{role: match.laws[role] for role in self.roles},
            "winner": played.winner,
            **{f"{role}_score": played.score.get(role) for role in self.roles},
            "capture_time": played.capture_time,
            "steps": played.steps,
            "verdict": "; ".join(verdicts),
            "message": played.message,
            "digest": played.digest,
        }

    def standing_rows(self) -> tuple[dict[str, Any], ...]:
        """Return a row a law: its place in its table, and how it stands."""
        places: dict[str, int] = {}
        rows = []
        for standing in self.standings:
            places[standing.role] = places.get(standing.role, 0) + 1
            rows.append(
                {
                    "role": standing.role,
                    "place": places[standing.role],
                    "law": standing.law,
                    "played": standing.played,
                    "won": standing.won,
                    "drawn": standing.drawn,
                    "lost": standing.lost,
                    "forfeits": standing.forfeits,
                    "points": standing.points,
                    "share": standing.share.mean,
                    "share_low": standing.share.low,
                    "share_high": standing.share.high,
                    "capture_time": standing.capture_time,
                }
            )
        return tuple(rows)

    def to_frame(self, table: str = "matches") -> DataFrame:
        """Return a table of pandas: "matches", one row a match, or "league", one row a law."""
        if table not in ("matches", "league"):
            raise InputError(f"to_frame({table!r}): expected 'matches' or 'league'")
        try:
            import pandas as pd
        except ImportError:
            raise MissingExtraError('tables need pandas: pip install "mars2d[data]"') from None
        return pd.DataFrame(self.rows() if table == "matches" else self.standing_rows())

    def save_csv(self, path: str | Path, table: str = "matches") -> Path:
        """Write one row a match, or with table="league" one row a law; return the path."""
        import csv
        import io

        if table not in ("matches", "league"):
            raise InputError(f"save_csv(table={table!r}): expected 'matches' or 'league'")
        rows = self.rows() if table == "matches" else self.standing_rows()
        text = io.StringIO(newline="")
        writer = csv.writer(text)
        writer.writerow(rows[0] if rows else [])
        writer.writerows([_cell(value) for value in row.values()] for row in rows)
        return _write(Path(path), text.getvalue())

    def save_html(self, path: str | Path) -> Path:
        """Write one page with the league, all matches and their replays; return the path."""
        from mars2d.study.tournament.page import league_page

        return _write(Path(path), league_page(self))

    def save_all(self, folder: Path) -> None:
        """Write both tables and the page to a folder."""
        self.save_csv(folder / MATCHES)
        self.save_csv(folder / LEAGUE, "league")
        self.save_html(folder / PAGE)

    def _repr_html_(self) -> str:
        """Return the league as tables, for a notebook."""
        from html import escape

        rows = self.standing_rows()
        lines = [
            list(rows[0]) if rows else [],
            *([_shown(v) for v in row.values()] for row in rows),
        ]
        cells = ("".join(f"<td>{escape(cell)}</td>" for cell in line) for line in lines)
        body = "".join(f"<tr>{row}</tr>" for row in cells)
        return f"<table><caption>{escape(self.title)}</caption>{body}</table>"


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
    """Let the laws of one role play all those of the other, and return how each stands.

    experiment: a file, or the name of an example, with one add-on that says who has won. roles: the
    files of each role's laws, also folders or patterns, as {"pursuer": "pursuers/*.py"}. players:
    those that play every role; no law plays itself. seeds: how many matches each pairing plays,
    from first_seed on, or a list of seeds: the same for all pairings. settings: options of the
    experiment; each list of values makes rounds, in which every pairing plays. stop_time: seconds,
    in place of the scenario's. limits: what a law may use; who takes more forfeits the match, as
    does a law that raises. executor, workers: who plays, see `mars2d.sweep`. replays: whether the
    page has them. out: a folder that takes the matches as they come, and league and page; the same
    call goes on where one was interrupted. show_progress: whether a terminal shows a bar.

    Raises InputError for what can't be played, before anything is; TournamentInterrupted after
    Ctrl-C.
    """
    # Processes take a while to import, and few need them.
    from mars2d.study.tournament.playing import play_schedule
    from mars2d.study.tournament.schedule import schedule
    from mars2d.study.workers import leave_if_imported_again

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


def _shown(value: Any) -> str:
    return f"{value:.3g}" if isinstance(value, float) else "" if value is None else str(value)


def _cell(value: Any) -> str:
    """Return a value as a cell of a table; what a spreadsheet would take for a formula is text."""
    from mars2d.study.plan import cell, word_cell

    if value is None or value != value:  # noqa: PLR0124 - nan
        return ""
    return word_cell(" ".join(value.split())) if isinstance(value, str) else cell(value)


def _write(path: Path, text: str) -> Path:
    if not path.parent.is_dir():
        raise InputError(f"{path}: there is no folder {path.parent}")
    with atomic_write(path) as file:
        file.write(text.encode("utf-8", errors="replace"))
    return path
