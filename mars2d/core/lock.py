"""Locks: a file that grows has one writer."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import BinaryIO

from mars2d.core.errors import InputError

LOCKED_BYTE = 2**40
"""The byte to lock on systems that lock bytes: far behind the end of any file."""


def lock(file: BinaryIO, path: Path, *, shared: bool = False) -> None:
    """Lock a file until it is closed or the process ends.

    shared: others may lock it in this way as well; Windows has no such locks. Raises InputError if
    it is locked already. Does nothing on systems without locks.
    """
    try:
        _lock(file, shared=shared)
    except (BlockingIOError, PermissionError):
        raise InputError(
            f"{path}: another process is writing to it, or another part of this one: wait for its "
            "end, or give another name"
        ) from None
    except (ImportError, OSError):
        return


def _lock(file: BinaryIO, *, shared: bool) -> None:
    if sys.platform == "win32":
        import msvcrt

        os.lseek(file.fileno(), LOCKED_BYTE, os.SEEK_SET)
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
    else:
        import fcntl

        fcntl.flock(file, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
