"""The code of runs: hashes of the files that decide them, and a watch on these files."""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TypeGuard

from mars2d.scenario.experiment import Experiment

CODE_DIGITS = 8
"""How many digits of a hash tell the code of runs apart."""


def code_of(experiment: Experiment, otherwise: str = "") -> str:
    """Return the first digits of a hash of all files of an experiment and of MARS2D's version.

    Files count by name and content, wherever they lie. otherwise: returned if there are no files.
    """
    if not experiment.source.written:
        return otherwise
    return _hash(experiment, _content)[:CODE_DIGITS]


def code_of_run(experiment: Experiment) -> str:
    """Return a hash as `code_of` does, but of all that decides a run: without the measures.

    These are functions of the experiment's file whose only parameter is ``record``, and which
    nothing else in it mentions.
    """
    return _hash(experiment, lambda file: _content(file, measures=file != experiment.source.path))


def _hash(experiment: Experiment, content: Callable[[Path], bytes | None]) -> str:
    import mars2d

    sha = hashlib.sha256(mars2d.__version__.encode())
    for file in sorted(experiment.source.written, key=lambda path: (path.name, str(path))):
        sha.update(f"\n{file.name} ".encode(errors="backslashreplace"))
        sha.update(content(file) or b"")
    return sha.hexdigest()


class WatchedFiles:
    """Files that must not change while a study runs."""

    def __init__(self) -> None:
        self._files: dict[Path, tuple[object, bytes | None]] = {}

    def add(self, files: Iterable[Path]) -> None:
        """Watch more files for changes from now on."""
        for file in files:
            if file not in self._files:
                self._files[file] = _stamp(file), _content(file)

    def changed(self) -> Path | None:
        """Return a file whose content has changed, or None."""
        for file, (stamp, content) in self._files.items():
            now = _stamp(file)
            if now != stamp:
                if _content(file) != content:
                    return file
                self._files[file] = now, content
        return None


def _stamp(file: Path) -> object:
    try:
        stat = file.stat()
    except OSError:
        return None
    return stat.st_mtime_ns, stat.st_size, stat.st_ino


def _content(file: Path, *, measures: bool = True) -> bytes | None:
    """Return a hash of a file, if asked for without its measures; None if it can't be read."""
    try:
        data = file.read_bytes()
    except OSError:
        return None
    if not measures and file.suffix == ".py":
        data = _without_measures(data)
    return hashlib.sha256(data).digest()


def _without_measures(source: bytes) -> bytes:
    """Return a program without comments and measures, which does the same otherwise."""
    tree = ast.parse(source)
    measures = [node for node in tree.body if _is_measure(node)]
    while True:
        tree.body, whole = [node for node in tree.body if node not in measures], tree.body
        mentioned = set(map(_word, ast.walk(tree)))
        alone = [node for node in measures if node.name not in mentioned]
        if alone == measures:
            return ast.dump(tree).encode()
        tree.body, measures = whole, alone


def _is_measure(node: ast.stmt) -> TypeGuard[ast.FunctionDef]:
    """Return whether a statement defines a function whose only parameter is ``record``."""
    if not isinstance(node, ast.FunctionDef):
        return False
    arguments = node.args
    others = [*arguments.posonlyargs, *arguments.kwonlyargs, arguments.vararg, arguments.kwarg]
    return [each.arg for each in arguments.args] == ["record"] and not any(others)


def _word(node: ast.AST) -> str:
    """Return the name or text that a part of a program is, or an empty text."""
    for field in ("id", "attr", "value"):
        word = getattr(node, field, None)
        if isinstance(word, str):
            return word
    return ""
