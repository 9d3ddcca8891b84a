"""Hints: the keys that are useful now, which the footer of the run window shows."""

from __future__ import annotations

from collections.abc import Sequence

from mars2d.window.run.play import Play
from mars2d.window.screen.player import Player

Hints = Sequence[tuple[str, str]]
"""Keys and their effects."""

USUAL = (
    ("Space", "pause"), ("← →", "step"), ("+ \N{MINUS SIGN}", "speed"), ("F1", "help"),
)  # fmt: skip
BY_HAND = (("↑ ↓ ← →", "drive"), ("Shift", "slowly"), ("H", "let go"), ("F1", "help"))
MANUAL = (("Space", "step"), ("+", "play"), ("F1", "help"))


def hints_of(player: Player, game: Play | None, *, drives: bool, score_shown: bool) -> Hints:
    """Return the keys that are useful now, and their effects.

    game: that people play, if they do. drives: whether a robot is driven by hand. score_shown:
    whether the panel of the score, which names the players' keys, has room.
    """
    if game is not None:
        return _of_game(game, player, score_shown=score_shown)
    go_on, (drive, slowly, *rest) = ("Space", "go on"), BY_HAND
    if drives:
        return (go_on, drive, *rest) if player.paused else (drive, slowly, *rest)
    if player.manual:
        return MANUAL
    return (go_on, *USUAL[1:]) if player.paused else USUAL


def _of_game(game: Play, player: Player, *, score_shown: bool) -> Hints:
    if not game.seats:
        return (*((str(each.number), each.title) for each in game.choices), ("Ctrl Q", "leave"))
    if game.counting:
        return ("Space", "start at once"), ("F1", "help")
    pause = "go on" if player.paused else "pause"
    if score_shown:
        return ("Space", pause), ("R", "begin again"), ("Shift", "slowly"), ("F1", "help")
    keys = [(" ".join(seat.keys), seat.role or "drive") for seat in game.seats]
    return (*keys, ("Space", pause), ("R", "begin again"))
