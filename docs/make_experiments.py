"""Make the films of the pages of experiments and pursuit games, docs/pictures/NAME.gif.

python docs/make_experiments.py [NAME ...]
"""

from __future__ import annotations

import sys
from pathlib import Path

import mars2d
from mars2d.output.films.film import film_record

DOCS = Path(__file__).parent
SIZE = (480, 400)
FPS = 12
SECONDS = 8
"""How long a film is."""

LIGHTER = {"circular_motion": ((400, 340), 9)}
"""Size and frames a second of films in which much moves; what sensors read is left out, too."""


def make(name: str) -> Path:
    """Run an example and make its film of it."""
    record = mars2d.run(name)
    speed = float(record.time[-1]) / SECONDS
    size, fps = LIGHTER.get(name, (SIZE, FPS))
    path = DOCS / "pictures" / f"{name}.gif"
    return film_record(record, path, speed=speed, size=size, fps=fps, sensors=name not in LIGHTER)


if __name__ == "__main__":
    pages = [*(DOCS / "experiments").glob("*.md"), *(DOCS / "pursuit").glob("*.md")]
    names = sys.argv[1:] or sorted(page.stem for page in pages if page.stem != "index")
    for each in names:
        film = make(each)
        print(f"{film.name}: {film.stat().st_size // 1000} kB")
