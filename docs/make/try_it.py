"""Assemble the page "Try it", on which experiments run in a browser.

    python docs/make/try_it.py OUT [--pyodide FOLDER]

OUT gets the page and a wheel of MARS2D. Serve it with any web server, such as
`python -m http.server -d OUT`. With a folder of Pyodide and its packages the page needs no network;
else Pyodide comes from its usual server.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

DOCS = Path(__file__).parents[1]
CDN = "https://cdn.jsdelivr.net/pyodide/v314.0.3/full/"


def main(words: list[str] | None = None) -> None:
    """Build the wheel without the compiled engine, and put all files into one folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--pyodide", type=Path, help="a folder of Pyodide and its packages")
    given = parser.parse_args(words)
    out = given.out.absolute()
    shutil.copytree(DOCS / "try", out, dirs_exist_ok=True)
    for old in out.glob("mars2d-*.whl"):
        old.unlink()
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", out],
        cwd=DOCS.parent, env={**os.environ, "MARS2D_PLAIN": "1"}, check=True,
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    if given.pyodide is not None:
        shutil.copytree(given.pyodide, out / "pyodide", dirs_exist_ok=True)
    place = CDN if given.pyodide is None else "pyodide/"
    settings = {"pyodide": place, "wheel": next(out.glob("mars2d-*.whl")).name}
    (out / "settings.json").write_text(json.dumps(settings) + "\n")


if __name__ == "__main__":
    main()
