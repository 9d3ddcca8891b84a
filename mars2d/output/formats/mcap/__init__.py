"""``.mcap``: a log that is written while a run goes on, for this program and for Foxglove."""

from __future__ import annotations

from mars2d.output.formats.mcap.log import Log
from mars2d.output.formats.mcap.reading import read
from mars2d.output.formats.mcap.writing import require, write

__all__ = ["Log", "read", "require", "write"]
