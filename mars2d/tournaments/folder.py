"""A tournament's folder, to which matches are written as they are played."""

from __future__ import annotations

import hashlib
import itertools
import json
import os
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from mars2d.core.errors import InputError
from mars2d.core.files import growing, writing
from mars2d.physics.versions import versions
from mars2d.tournaments.isolation.limits import Verdict
from mars2d.tournaments.match import Played
from mars2d.tournaments.schedule import Schedule

PLAYED = "played.jsonl"
"""The file that is written while matches are played."""

FORMAT = 3
"""The version of the file's format; a folder with another version is refused."""


def _prints(schedule: Schedule) -> dict[int, str]:
    """Return a hash for each match, by number, of everything that determines its result.

    That is the experiment, laws, options, seed, limits and versions, but not the match's number.
    """
    laws = {Path(file) for match in schedule.matches for file in match.files.values()}
    others = [path.read_bytes() for path in sorted(schedule.files - laws)]
    common = _hash([f"{versions()} {schedule.limits}".encode(), *others])
    prints = {}
    for match in schedule.matches:
        settings = f"{common} {match.options} {match.seed} {match.laws}".encode()
        code = itertools.chain(*(each.values() for each in match.code.values()))
        prints[match.number] = _hash([settings, *code])
    return prints


def _hash(parts: Iterable[bytes]) -> str:
    """Return a hash of a sequence of bytes objects."""
    sha = hashlib.sha256()
    for part in parts:
        sha.update(f"{len(part)} ".encode() + part)
    return sha.hexdigest()


class Folder:
    """Writes each match to a file when it is done, and finds matches that were played before.

    Each line is a match, as JSON; if the process is killed within a line, only that match is lost.
    A match is played again if its experiment, a law, a limit or a version has changed, or if it had
    no result. A line that was changed after it was written is refused, by its checksum. Raises
    InputError for a folder that holds anything else, or can't be written.
    """

    def __init__(self, path: Path, schedule: Schedule) -> None:
        self._path, self._head = path / PLAYED, _head(schedule)
        self._prints = _prints(schedule)
        if path.exists() and not path.is_dir():
            raise InputError(f"{path}: this is a file; expected a folder")
        if not path.absolute().parent.is_dir():
            raise InputError(f"{path}: there is no folder {path.parent}")
        with writing(path):
            path.mkdir(exist_ok=True)
        self.before = _known(path, schedule, self._prints)

    def keep(self, played: Played) -> None:
        """Write a match that is done; its hash identifies it."""
        number = played.match.number
        row = {"print": self._prints[number], **vars(played), "match": number}
        self._write({"sum": _sum(row), **row})

    def __enter__(self) -> Folder:
        self._file = growing(self._path)
        if not self._file.seek(0, os.SEEK_END):
            self._write(self._head)
        return self

    def __exit__(self, *_: object) -> None:
        with suppress(OSError):  # a full disk, which `keep` has reported already
            self._file.close()

    def _write(self, row: Mapping[str, Any]) -> None:
        """Begin a line, since the one before may not have been written to its end."""
        with writing(self._path):
            self._file.write(b"\n" * bool(self._file.tell()) + json.dumps(row).encode())
            self._file.flush()


def played_before(path: Path, schedule: Schedule) -> tuple[Played, ...]:
    """Return the matches of a schedule that a folder holds; the folder need not exist."""
    return _known(path, schedule, _prints(schedule)) if path.is_dir() else ()


def _known(path: Path, schedule: Schedule, prints: Mapping[int, str]) -> tuple[Played, ...]:
    """Return the matches of a schedule that a log holds with a result, found by their hash."""
    log = path / PLAYED
    if not log.exists():
        others = sorted(each.name for each in path.iterdir() if not each.name.startswith("."))
        if others:
            raise InputError(
                f"{path}: holds {others[0]}, which is not of a tournament; nothing was changed. "
                "Name a new folder by --out, or an empty one"
            )
        return ()
    with writing(log):
        lines = log.read_text(encoding="utf-8", errors="replace").splitlines()
    head, expected = _json(lines[0]) if lines else {}, _head(schedule)
    if lines and head != expected:
        other = head.get("experiment") if isinstance(head, dict) else None
        same = other and head == {**expected, "experiment": other}
        of = f"of a tournament of {other}" if same else "not of this version"
        raise InputError(f"{path}: is {of}; name another folder by --out")
    known = {}
    for number, line in enumerate(lines[1:], 2):
        kept = _json(line)
        if kept is None:
            continue
        if not isinstance(kept, dict) or kept.pop("sum", "") != _sum(kept):
            raise InputError(
                f"{log}, line {number}: was changed after it was written, so its match is not "
                "counted; delete this line, and the match is played again"
            )
        if not kept["error"]:
            known[kept.pop("print")] = kept
    played = []
    for match in schedule.matches:
        if kept := known.get(prints[match.number]):
            verdicts = {role: Verdict(*each) for role, each in kept["verdicts"].items()}
            played.append(Played(**{**kept, "match": match, "verdicts": verdicts}))
    return tuple(played)


def _sum(row: Mapping[str, Any]) -> str:
    """Return the checksum of a line. It is no signature: who recomputes it is not detected."""
    return _hash([json.dumps(row).encode()])


def _head(schedule: Schedule) -> dict[str, Any]:
    return {"mars2d tournament": FORMAT, "experiment": Path(schedule.experiment).name}


def _json(line: str) -> Any:
    try:
        return json.loads(line)
    except ValueError:
        return None  # a line that was not written to its end
