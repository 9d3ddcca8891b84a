"""Many cases of one test as one item, which lists those that fail."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import pytest

Test = Callable[..., None]


def each_case(names: str | Sequence[str], cases: Iterable[Any]) -> Callable[[Test], Test]:
    """Run a test with every case, and name the cases that fail.

    It is written like `pytest.mark.parametrize`, for cases that are quick. A `tmp_path` is a new
    folder for each case; other fixtures are shared.
    """
    words = [name.strip() for name in names.split(",")] if isinstance(names, str) else [*names]
    rows = [case if len(words) > 1 else (case,) for case in cases]

    def decorate(test: Test) -> Test:
        @functools.wraps(test)
        def run(**fixtures: Any) -> None:
            failed = []
            for k, row in enumerate(rows):
                given = fixtures | dict(zip(words, row, strict=True))
                if "tmp_path" in given:
                    given["tmp_path"] = fixtures["tmp_path"] / str(k)
                    given["tmp_path"].mkdir()
                try:
                    test(**given)
                except (Exception, pytest.fail.Exception) as error:
                    failed.append(f"{row}: {type(error).__name__}: {error}")
            assert not failed, "\n\n".join([f"{len(failed)} of {len(rows)} cases fail", *failed])

        signature = inspect.signature(test)
        own = [p for name, p in signature.parameters.items() if name not in words]
        run.__signature__ = signature.replace(parameters=own)  # type: ignore[attr-defined]
        return run

    return decorate
