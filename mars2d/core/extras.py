"""Optional libraries, which an extra of the installation brings."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager

from mars2d.core.errors import MissingExtraError


def pip_line(name: str) -> str:
    """Return the command that installs the libraries of an extra, wherever MARS2D came from.

    >>> pip_line("video")
    'pip install "av>=17"'
    """
    from importlib.metadata import PackageNotFoundError, requires

    try:
        declared = requires("mars2d") or []
    except PackageNotFoundError:  # it runs from its folder without being installed
        return f'pip install ".[{name}]"'
    wanted = [each for each in declared if re.search(rf"""extra == ['"]{name}['"]""", each)]
    return " ".join(["pip install", *(f'"{each.partition(";")[0].strip()}"' for each in wanted)])


@contextmanager
def extra(name: str, needs: str, otherwise: str = "") -> Iterator[None]:
    """Turn an import that fails within into a MissingExtraError with the pip line.

    name: the extra. needs: what needs which library, for example "tables need pandas".
    otherwise: what works without it.
    """
    try:
        yield
    except MissingExtraError:
        raise
    except ImportError:
        hint = f"; {otherwise}" if otherwise else ""
        raise MissingExtraError(f"{needs}: {pip_line(name)}{hint}") from None
