"""Labels: long names of a figure on several lines, or shortened."""

from __future__ import annotations

import re

BREAK = re.compile(r"(?<=\s)(?<!= )|(?<=_)(?=\w)|(?<=[^\W\d]|\*)(?=\.)|(?<=/)(?=\w)(?![^\[]*\])")
"""Where a name may go on in the next line: after spaces, but not between ``=`` and a
value, and within names and paths."""


def wrapped(text: str, letters: int, lines: int = 6) -> str:
    r"""Return a text on lines of at most so many letters; further lines are left out.

    Names are broken after underscores and slashes, before dots, and elsewhere only if they must be.

    >>> wrapped("mean_square_error [m/s]", 12)
    'mean_square_\nerror [m/s]'
    """
    made = [""]
    for piece in BREAK.split(" ".join(text.split())):
        if made[-1] and len(made[-1]) + len(piece.rstrip()) > letters:
            made.append("")
        made[-1] += piece
        while len(made[-1].rstrip()) > letters:
            made[-1:] = [made[-1][:letters], made[-1][letters:]]
    if len(made) > lines:
        made[lines - 1 :] = [made[lines - 1][: letters - 1] + "…"]
    return "\n".join(line.rstrip() for line in made)


def fits(text: str, letters: int, lines: int) -> bool:
    """Return whether a text has room on so many lines without a word that is cut."""
    longest = max(len(piece.rstrip()) for piece in BREAK.split(text))
    return longest <= letters and wrapped(text, letters, lines + 1).count("\n") < lines


def shortened(text: str, letters: int) -> str:
    """Return a text on one line, without its middle if it has more letters than this.

    >>> shortened("laws/group_a/pursuit.py", 16)
    'laws/g…ursuit.py'
    """
    text = " ".join(text.split())
    if len(text) <= letters:
        return text
    start = (letters - 1) * 2 // 5
    return f"{text[:start]}…{text[len(text) - (letters - 1 - start) :]}"
