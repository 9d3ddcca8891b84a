"""``.mcap``: a log that is written while a run goes on, for this program and for Foxglove."""

from __future__ import annotations

from mars2d.formats.mcap.log import Log
from mars2d.formats.mcap.packing import write
from mars2d.formats.mcap.reading import read
from mars2d.formats.mcap.tape import require

__all__ = ["Log", "read", "require", "write"]
