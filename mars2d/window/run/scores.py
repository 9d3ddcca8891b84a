"""Scores: how often a person has won each game, and the best times, kept with the settings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

from mars2d.window.screen.memory import Memory

FILE = "scores.json"


@dataclass(frozen=True, slots=True)
class Tally:
    """What somebody has done in a role of a game.

    played, won, drawn: numbers of games. quickest: the shortest game that was won, seconds.
    longest: the longest game that was lost, seconds.
    """

    played: int = 0
    won: int = 0
    drawn: int = 0
    quickest: float | None = None
    longest: float | None = None

    def after(self, won: bool | None, time: float | None) -> Tally:
        """Return the tally after one more game.

        won: None for a draw. time: its end, seconds; None where that was the stop time.
        """
        played, drawn = self.played + 1, self.drawn + (won is None)
        more = replace(self, played=played, won=self.won + bool(won), drawn=drawn)
        if won is None or time is None:
            return more
        if won:
            return replace(more, quickest=min(time, self.quickest or time))
        return replace(more, longest=max(time, self.longest or 0.0))

    @classmethod
    def of(cls, known: object) -> Tally:
        """Return a tally as it was written; an empty one if it can't be understood."""
        match known:
            case {
                "played": int(played), "won": int(won), "drawn": int(drawn),
                "quickest": float() | None as quickest, "longest": float() | None as longest,
            }:  # fmt: skip
                return cls(played, won, drawn, quickest, longest)
        return cls()

    @property
    def in_words(self) -> str:
        """How many games were won, and the best time; "" without any."""
        if not self.played:
            return ""
        draws = f", {self.drawn} drawn" if self.drawn else ""
        text = f"won {self.won} of {self.played}{draws}"
        if self.quickest is not None:
            return f"{text}, quickest in {self.quickest:.1f} s"
        return text if self.longest is None else f"{text}, held out {self.longest:.1f} s"


class Scores:
    """The tallies of one game, by role, in a file of the memory of windows.

    game: its name and options: with other options it is another game.
    """

    def __init__(self, memory: Memory, game: str) -> None:
        self._memory, self._game = memory, game

    def of(self, role: str) -> Tally:
        """Return the tally of a role."""
        return Tally.of(self._tallies(self._memory.read(FILE)).get(role))

    def add(self, role: str, won: bool | None, time: float | None) -> Tally:
        """Note a game that has ended, as `Tally.after` does; return the tally before it."""
        before, known = self.of(role), self._memory.read(FILE)
        tallies = {
            **self._tallies(known),
            role: asdict(before.after(won, None if time is None else float(time))),
        }
        self._memory.write(FILE, {**known, self._game: tallies})
        return before

    def _tallies(self, known: Mapping[str, Any]) -> Mapping[str, Any]:
        tallies = known.get(self._game)
        return tallies if isinstance(tallies, dict) else {}
