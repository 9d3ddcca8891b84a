"""Many cases of one test as one item, which lists those that fail."""

from __future__ import annotations

import inspect
import traceback
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import wraps
from typing import Any

import pytest


def each_case(
    names: str | Sequence[str], cases: Iterable[Any]
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Let a test go through all cases and tell, at the end, in which of them it failed.

    It is written like `pytest.mark.parametrize`. Each case has a folder, a monkeypatch and an empty
    capsys of its own, if the test asks for them; other fixtures are shared.
    """
    arguments = [name.strip() for name in names.split(",")] if isinstance(names, str) else [*names]
    every = list(cases)

    def wrap(test: Callable[..., None]) -> Callable[..., None]:
        @wraps(test)
        def run(**fixtures: Any) -> None:
            failures = []
            for number, case in enumerate(every):
                values = dict(zip(arguments, case if len(arguments) > 1 else [case], strict=True))
                try:
                    with _own(fixtures, number) as own:
                        test(**own, **values)
                except pytest.skip.Exception:
                    continue
                except (Exception, pytest.fail.Exception) as error:
                    told = "".join(traceback.format_exception(error, limit=-3))
                    failures.append(f"{values}\n{told}")
            assert not failures, f"{len(failures)} of {len(every)} cases\n\n" + "\n".join(failures)

        signature = inspect.signature(test)
        left = [each for name, each in signature.parameters.items() if name not in arguments]
        run.__signature__ = signature.replace(parameters=left)  # type: ignore[attr-defined]
        return run

    return wrap


@contextmanager
def _own(fixtures: dict[str, Any], number: int) -> Iterator[dict[str, Any]]:
    own = dict(fixtures)
    if "tmp_path" in own:
        own["tmp_path"] = own["tmp_path"] / f"case{number}"
        own["tmp_path"].mkdir()
    if "capsys" in own:
        own["capsys"].readouterr()
    with pytest.MonkeyPatch.context() as patch:
        if "monkeypatch" in own:
            own["monkeypatch"] = patch
        yield own
