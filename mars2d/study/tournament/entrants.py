"""Entrants: the files of the laws that take part in a tournament, by role."""

from __future__ import annotations

import glob
import os
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from mars2d.core.errors import InputError, likely, nearest, shown

__all__ = ["Files", "entrants", "law_code", "law_files", "names_of"]

IMPORT = re.compile(rb"(?:^|[;:])\s*(?:from|import)\s+([a-zA-Z0-9_., \t]+)", re.MULTILINE)

Files = str | Path | Sequence[str | Path]
"""One or several files of laws, folders or patterns."""

EXPECTED = "expected files of laws (.py), a folder of them, or a pattern as laws/*.py"


def law_files(named: str | Path, beside: Path | None = None) -> tuple[Path, ...]:
    """Return the files that a name stands for: absolute paths, each once.

    named: a file, a folder (all its .py files except those that begin with _), a pattern, or
    several of these, separated by commas. beside: a folder that is searched for relative names
    before the current one. Raises InputError, with the nearest name, if there is no such file.
    """
    parts = [part.strip() for part in str(named).split(",") if part.strip()]
    if not parts:
        raise InputError(f"{named!r}: {EXPECTED}")
    files = [file for part in parts for file in _files(part, beside)]
    return tuple(dict.fromkeys(files))


def _files(part: str, beside: Path | None) -> list[Path]:
    folders = [Path.cwd()] if beside is None else [beside, Path.cwd()]
    for folder in folders:
        path = folder / part
        if path.is_dir():
            inside = _laws(path.glob("*.py"))
            if not inside:
                raise InputError(f"{part}: no law in this folder; {EXPECTED}")
            return inside
        if path.is_file():
            if path.suffix != ".py":
                raise InputError(f"{part}: expected the file of a law, which ends in .py")
            return [_plain(path)]
        found = _laws(map(Path, glob.glob(str(path))))  # noqa: PTH207 - of absolute patterns, too
        if found:
            return found
    raise InputError(f"{part}: no such file; {EXPECTED}{_near(part, folders)}")


def _laws(paths: Iterable[Path]) -> list[Path]:
    """Return those files that can be laws, sorted."""
    return sorted(
        _plain(path)
        for path in paths
        if path.suffix == ".py" and path.is_file() and not path.name.startswith("_")
    )


def _plain(path: Path) -> Path:
    """Return an absolute path without `..`, which is the same however the file was named."""
    return Path(os.path.normpath(path.absolute()))


def _near(part: str, folders: Sequence[Path]) -> str:
    """Return the nearest existing name, as the end of a message."""
    parent = Path(part).parent
    names = {
        str(parent / path.name)
        for folder in folders
        if (folder / parent).is_dir()
        for path in (folder / parent).iterdir()
        if path.suffix == ".py" or path.is_dir()
    }
    return likely(part, names)


def entrants(
    roles: Sequence[str],
    given: Mapping[str, Files],
    players: Files = (),
    beside: Path | None = None,
) -> dict[str, tuple[Path, ...]]:
    """Return each role's laws: those given for it, and the players, which play every role.

    beside: see `law_files`. Raises InputError for an unknown role, a role without laws, and missing
    files.
    """
    for role in given:
        if role not in roles:
            raise InputError(f"there is no role {role!r}{nearest(role, roles)}")
    every = _all_files(players, beside)
    found = {}
    for role in roles:
        laws = tuple(dict.fromkeys((*_all_files(given.get(role, ()), beside), *every)))
        if not laws:
            raise InputError(
                f"no laws for the role {role!r}: name them by --role {role}=FILES, "
                "or by --players FILES those that play every role"
            )
        found[role] = laws
    return found


def _all_files(named: Files, beside: Path | None) -> list[Path]:
    parts = [named] if isinstance(named, (str, Path)) else named
    if not isinstance(parts, Iterable) or not all(isinstance(p, (str, Path)) for p in parts):
        raise InputError(f"{shown(named)}: {EXPECTED}")
    return [file for part in parts for file in law_files(part, beside)]


def names_of(files: Iterable[str | Path]) -> dict[str, str]:
    """Return a name for each law's file: its own, preceded by folders where needed to be unique.

    >>> names_of(["a/hunt.py", "b/hunt.py", "b/flee.py"])
    {'a/hunt.py': 'a/hunt', 'b/hunt.py': 'b/hunt', 'b/flee.py': 'flee'}
    """
    paths = {str(file): Path(file).with_suffix("").parts for file in files}
    names = {}
    for file, parts in paths.items():
        others = [other for key, other in paths.items() if key != file]
        depth = next(
            (k for k in range(1, len(parts)) if all(o[-k:] != parts[-k:] for o in others)),
            len(parts),
        )
        names[file] = "/".join(parts[-depth:])
    return names


def law_code(law: Path) -> dict[Path, bytes]:
    """Return the contents of a law's file and of the files beside it that it imports, by path.

    All .py files of an imported folder count. The files are not run; imports are found in the text.
    """
    contents: dict[Path, bytes] = {}
    waiting = [law]
    while waiting:
        path = waiting.pop()
        if path in contents or not path.is_file():
            continue
        contents[path] = path.read_bytes()
        lines = re.findall(IMPORT, contents[path])
        names = sorted(
            {name.decode() for line in lines for name in re.findall(rb"[a-zA-Z0-9_]+", line)}
        )
        for folder in dict.fromkeys((path.parent, law.parent)):
            for name in names:
                waiting += [folder / f"{name}.py", *sorted((folder / name).rglob("*.py"))]
    return contents
