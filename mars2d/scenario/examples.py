"""The shipped examples: each course is a folder of `examples/`."""

from __future__ import annotations

from pathlib import Path

COURSES = ("experiments", "contact", "games", "pursuit", "sensing", "teams", "control")
"""The folders of the courses, in the order in which people meet them."""

GAMES = ("games", "pursuit")
"""The courses whose examples people play."""


def examples_folder() -> Path:
    """Return the folder of the examples, a wheel's or a checkout's."""
    package = Path(__file__).parents[1]
    inside = package / "examples"
    return inside if inside.is_dir() else package.parent / "examples"


def examples() -> dict[str, Path]:
    """Return the shipped examples, course by course: name to file."""
    folders = [examples_folder() / course for course in COURSES]
    return {file.stem: file for folder in folders for file in sorted(folder.glob("*.py"))}


def courses() -> dict[str, list[str]]:
    """Return the names of the examples by course."""
    found: dict[str, list[str]] = {}
    for name, path in examples().items():
        found.setdefault(path.parent.name.capitalize(), []).append(name)
    return found


def games() -> list[str]:
    """Return the names of the examples that people play."""
    return [name for name, path in examples().items() if path.parent.name in GAMES]


def title_of(name: str) -> tuple[str, str]:
    """Return the title of an example, and its line: the first of its file."""
    first = examples()[name].read_text(encoding="utf-8").partition("\n")[0].strip('" ')
    title = name.replace("_", " ").replace("voronoi", "Voronoi")
    return title[0].upper() + title[1:], first
