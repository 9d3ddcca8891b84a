"""The shipped examples, by course: files, and games, which are folders with a ``game.py``."""

from __future__ import annotations

from pathlib import Path

COURSES = ("first", "paper", "contact", "pursuit", "sensing", "teams")
"""The folders of the courses, in the order in which people meet them."""

GAME = "game.py"
"""The file of a game, which is called as its folder is."""


def experiment_name(file: Path) -> str:
    """Return the name of an experiment by its file."""
    return file.absolute().parent.name if file.name == GAME else file.stem


def courses() -> dict[str, dict[str, Path]]:
    """Return the shipped examples by course: each name with its file."""
    found, inside = {}, Path(__file__).parents[1] / "examples"  # of a wheel, or of a checkout
    for course in COURSES:
        folder = (inside if inside.is_dir() else inside.parents[1] / "examples") / course
        files = sorted([*folder.glob("*.py"), *folder.glob(f"*/{GAME}")], key=experiment_name)
        found[course.capitalize()] = {experiment_name(file): file for file in files}
    return found


def examples() -> dict[str, Path]:
    """Return the shipped examples, course by course: name to file."""
    return {name: file for course in courses().values() for name, file in course.items()}


def games() -> list[str]:
    """Return the names of the examples that people play."""
    return [name for name, path in examples().items() if path.name == GAME]


def title_of(name: str) -> tuple[str, str]:
    """Return the title of an example, and its line: the first of its file."""
    first = examples()[name].read_text(encoding="utf-8").partition("\n")[0].strip('" ')
    title = name.replace("_", " ").replace("voronoi", "Voronoi")
    return title[0].upper() + title[1:], first


def thumbnail_of(name: str, looks: str) -> Path:
    """Return the file of an example's small picture; looks: "light" or "dark"."""
    file = examples()[name]
    if file.name == GAME:
        return file.with_name(f"{looks}.png")
    return file.parent / "thumbnails" / f"{name}_{looks}.png"
