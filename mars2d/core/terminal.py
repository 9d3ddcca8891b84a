"""What is printed for people: no text and no terminal can break it."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from typing import Any, TextIO

from mars2d.core.errors import InputError, escaped, one_line


def tell(*values: object, sep: str = " ", end: str = "\n") -> None:
    """Print values on stdout, as `print` does, without codes of a terminal that may be in them.

    Raises InputError where stdout can't be written, BrokenPipeError where its reader has ended.
    """
    try:
        _write(sys.stdout, sep.join(map(str, values)) + end)
    except BrokenPipeError:
        raise
    except OSError as error:
        raise InputError(f"stdout can't be written: {error.strerror or error}") from error


def warn(text: object) -> None:
    """Print one line on stderr, if it can be written."""
    with suppress(OSError, ValueError):
        _write(sys.stderr, f"mars2d: {one_line(text)}\n")


def _write(stream: TextIO, text: str) -> None:
    text, encoding = "\n".join(map(escaped, text.split("\n"))), stream.encoding or "utf-8"
    stream.write(text.encode(encoding, "backslashreplace").decode(encoding))
    stream.flush()


def aligned(rows: Sequence[Sequence[str]], left: int) -> list[str]:
    """Return rows as lines; the first `left` columns are flush left, the others flush right."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  ".join(
            cell.ljust(width) if k < left else cell.rjust(width)
            for k, (cell, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]


def usable_standard_files() -> None:
    """Let stdin be empty: nobody answers a law that asks. Open stdout and stderr if closed.

    Else the first file that is opened would take the number of one that is closed, and libraries in
    C write on number 2. Processes that are started inherit them.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if number and getattr(sys, name) is not None:
            continue
        nowhere = os.open(os.devnull, os.O_RDWR)
        os.dup2(nowhere, number)
        os.set_inheritable(number, True)
        if nowhere > 2:
            os.close(nowhere)
        stream = open(number, "w" if number else "r", encoding="utf-8", closefd=False)  # noqa: SIM115
        setattr(sys, name, stream)


def legible() -> None:
    r"""Let stdout and stderr escape letters that the terminal does not have.

    So a law's own `print` does not fail on a terminal for ASCII: it prints ``\u4e2d``.
    """
    streams: list[Any] = [sys.stdout, sys.stderr]
    for stream in streams:
        with suppress(OSError, ValueError, AttributeError):  # closed, full, or not a file
            stream.reconfigure(errors="backslashreplace")
