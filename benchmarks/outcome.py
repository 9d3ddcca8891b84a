"""What a benchmark found, as JSON: in a file where one is named, else printed."""

import json
import sys
from pathlib import Path
from typing import Any


def write(result: dict[str, Any], path: Path | None) -> None:
    """Write a result to a file, or else to the standard output."""
    if path is not None:
        path.write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")
    else:
        json.dump(result, sys.stdout)
        print()
