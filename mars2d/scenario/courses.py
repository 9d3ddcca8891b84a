"""The shipped examples by course, and the games among them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from mars2d.scenario.experiment import examples

__all__ = ["COURSES", "GAMES", "Game", "courses", "title_of"]

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
    "First laws and games": ("go_to_point", "corner_game"),
}  # fmt: skip
"""The names of all examples, by course."""


class Game(NamedTuple):
    """An example that a person plays: the robot to drive, and what to do."""

    example: str
    human: str
    task: str


GAMES = (
    Game("corner_game", "evader", "Get away"),
    Game("pursuit_voronoi", "red", "Catch the evader"),
    Game("sumo", "red", "Push blue out"),
    Game("herding", "dog", "Pen the flock"),
)
"""The games, easiest to understand first."""


def courses() -> dict[str, list[str]]:
    """Return the names of the examples that are installed, by course."""
    known = examples()
    return {course: [name for name in names if name in known] for course, names in COURSES.items()}


def title_of(name: str) -> tuple[str, str]:
    """Return the title of an example, and its line: the first of its file."""
    first = examples()[name].read_text(encoding="utf-8").partition("\n")[0].strip('" ')
    title = name.replace("_", " ").replace("voronoi", "Voronoi")
    return title[0].upper() + title[1:], first
