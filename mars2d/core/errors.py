"""The errors that MARS2D raises, and the wording of their messages."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from typing import Any

CONTROLS = re.compile(r"[\x00-\x1f\u007f-\x9f\u2028\u2029]")
"""Line breaks and the control characters of terminals."""

UNSEEN = re.compile(
    r"[\x00-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff\ufeff]"
)
"""`CONTROLS`, and characters that reverse text; halves of characters; byte order marks."""

ADDRESS = re.compile(r" at 0x[0-9a-f]+|_mars2d_experiment_\d+_\w+\.")
"""What is in the texts of objects and says nothing: addresses, and the names of loaded files."""

MAX_TEXT = 2000
"""The most characters of a text that are printed in one line."""


class Mars2dError(Exception):
    """The base of all errors of this package.

    where: the file and line that the error points at, such as ``walk.py, line 12``, or None.
    record: the record up to the error if it ended a run, else None.
    """

    where: str | None = None
    record: Any = None  # a Record, whose class lies above

    def __str__(self) -> str:
        text = super().__str__()
        return f"{self.where}: {text}" if self.where else text


class InputError(Mars2dError, ValueError):
    """An input can't be used; the message names it and says what was expected."""


class Late(BaseException):
    """The user's code is broken off; a BaseException, so that few `except` in it catch it.

    why: what the call did, for the `LawError` that it becomes; "" for whoever set the limit to say.
    """

    why = ""


class LawError(InputError):
    """The user's control law, sensor or add-on raised an error or returned something unusable.

    robot: whose law or sensor it is, or "". time: of the world then, seconds; None before the run.
    """

    robot: str = ""
    time: float | None = None

    def __str__(self) -> str:
        when = "" if self.time is None else f"at {self.time:g} s"
        told = ", ".join(filter(None, (self.robot, when)))
        return f"{super().__str__()} ({told})" if told else super().__str__()


class UnknownNameError(LawError, AttributeError):
    """A law asked for something that does not exist."""


class MissingExtraError(InputError, ImportError):
    """An optional library is not installed; the message contains the pip command."""


CERTAIN = 0.85
"""How near a name is that can only be meant."""

LIKENESS = 0.72
"""How near a name must be to be meant, from 0 to 1: 'speed' is not 'sees', 'psoe' is 'pose'."""


def likely(name: object, known: Iterable[str], likeness: float = LIKENESS) -> str:
    """Return ``"; did you mean 'known'?"`` for the known name that is nearest, or ``""``.

    likeness: how near it must be, from 0 to 1.
    """
    names = sorted(known)
    lower, word = {each.lower(): each for each in names}, str(name).lower()
    if len(word) < 5 and likeness == LIKENESS:  # 'rde' is 'red', 'icy' is 'ice'
        likeness = 0.66
    close = difflib.get_close_matches(str(name), names, n=1, cutoff=likeness)
    close = close or [lower[k] for k in difflib.get_close_matches(word, lower, 1, likeness)]
    return f"; did you mean {close[0]!r}?" if close else ""


def nearest(name: object, known: Iterable[str], likeness: float = LIKENESS, most: int = 12) -> str:
    """Return the nearest known name like `likely`, or else a list of at most `most` known names.

    >>> nearest("diametr", ["diameter", "mass"])
    "; did you mean 'diameter'?"
    >>> nearest("xyz", ["diameter", "mass"])
    '; known: diameter, mass'
    """
    names = sorted(known)
    listed = f"; known: {', '.join(names)}" if 0 < len(names) <= most else ""
    return likely(name, names, likeness) or listed


def counted(count: int, thing: str) -> str:
    """Return a number with its noun, such as ``1 step`` or ``2 steps``."""
    return f"{count} {thing}" if count == 1 else f"{count} {thing}s"


def escaped(text: str) -> str:
    """Return a text in which everything that a terminal would obey, or not show, is escaped."""
    shown = UNSEEN.sub(lambda found: ascii(found[0])[1:-1], text)
    return shown.replace(r"\x7f", r"\u007f")  # JSON leaves this one as it is, and has no \x


def one_line(text: object, most: int = MAX_TEXT) -> str:
    r"""Return a text as one line, its line breaks and control characters escaped.

    most: of a longer text the end is left out.

    >>> one_line("two\nlines")
    'two\\nlines'
    """
    whole = str(text)
    rest = len(whole) - most
    return escaped(whole) if rest <= 0 else f"{escaped(whole[:most])}... ({rest:,} letters more)"


def shown(value: Any, limit: int = 60) -> str:
    """Return `value` as quoted in a message: its repr, cut to `limit` characters."""
    try:
        text = ADDRESS.sub("", " ".join(repr(value).split()))
    except Exception as error:  # such as a number of too many digits
        text = f"<{type(value).__name__}: {error}>"
    return text if len(text) <= limit else text[: limit - 3] + "..."
