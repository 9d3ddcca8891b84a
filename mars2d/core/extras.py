"""Optional libraries, which an extra of the installation brings."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from mars2d.core.errors import MissingExtraError

__all__ = ["extra", "pip_line"]


def pip_line(name: str) -> str:
    """Return the command that installs an extra.

    >>> pip_line("video")
    'pip install "mars2d[video]"'
    """
    return f'pip install "mars2d[{name}]"'


@contextmanager
def extra(name: str, needs: str, otherwise: str = "") -> Iterator[None]:
    """Turn an import that fails within into a MissingExtraError with the pip line.

    name: the extra. needs: what needs which library, for example "tables need pandas".
    otherwise: what works without it.
    """
    try:
        yield
    except ImportError:
        hint = f"; {otherwise}" if otherwise else ""
        raise MissingExtraError(f"{needs}: {pip_line(name)}{hint}") from None
