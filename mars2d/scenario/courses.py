"""The shipped examples by course, and the games among them."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from pathlib import Path

from mars2d.scenario.experiment import examples

COURSES: Mapping[str, tuple[str, ...]] = {
    "Experiments of the MARS paper": (
        "random_walk", "pursuit_corners", "coverage_square", "coverage_circle",
        "pursuit_voronoi", "cyclic_pursuit", "circular_motion", "path_planning",
    ),
    "Contact": (
        "head_on", "push_box", "many_push_one", "wall_slide", "material_pairs", "stick_slip",
        "billiards", "shove_and_spin", "tug_of_war", "sumo", "crowd",
    ),
    "Pursuit": (
        "straight_chase", "homicidal_chauffeur", "two_cars", "lion_and_man", "encirclement",
        "guard_the_line", "capture_the_flag", "round_a_pillar", "hide_and_seek", "escort",
        "selfish_herd",
    ),
    "Sensing": (
        "obstacle_avoidance", "wall_follower", "dead_reckoning", "braitenberg",
        "own_sensor_and_addon",
    ),
    "Teams": (
        "flocking", "formation", "leader_following", "follow_the_leader", "rendezvous",
        "token_ring", "herding",
    ),
    "Planning": ("plan_push",),
    "First laws and games": ("go_to_point", "corner_game"),
}  # fmt: skip
"""The names of all examples, by course."""


GAMES: Mapping[str, str] = {
    "corner_game": "", "sumo": "", "pursuit_voronoi": "", "herding": "dog",
    "straight_chase": "", "homicidal_chauffeur": "", "two_cars": "", "lion_and_man": "",
    "encirclement": "", "guard_the_line": "", "capture_the_flag": "", "round_a_pillar": "",
    "hide_and_seek": "", "escort": "", "selfish_herd": "",
}  # fmt: skip
"""The games among them, easiest to understand first, and the robot that a person drives where no
contest has roles to choose from."""


def courses() -> dict[str, list[str]]:
    """Return the names of the examples that are installed, by course."""
    known = examples()
    return {course: [name for name in names if name in known] for course, names in COURSES.items()}


def title_of(name: str) -> tuple[str, str]:
    """Return the title of an example, and its line: the first of its file."""
    first = examples()[name].read_text(encoding="utf-8").partition("\n")[0].strip('" ')
    title = name.replace("_", " ").replace("voronoi", "Voronoi")
    return title[0].upper() + title[1:], first


def files_of(name: str) -> list[Path]:
    """Return an example's file, and the files and folders beside it that its text names."""
    path = examples()[name]
    constants = (
        node.value
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    )
    first = {text.partition("/")[0] for text in constants if "/" in text[1:] and "\n" not in text}
    beside = [path.parent / each for each in sorted(first - {""})]
    return [path, *(each for each in beside if each.exists())]
