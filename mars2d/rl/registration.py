"""The names under which gymnasium knows the environments of `mars2d.rl.tasks`."""

from __future__ import annotations

import gymnasium

IDS = {
    "mars2d/Pursuit-v0": "pursuit",
    "mars2d/Push-v0": "push",
    "mars2d/Sumo-v0": "sumo",
}
"""The names of the environments, and the functions that make them."""


def register() -> None:
    """Make the environments known to gymnasium; again does nothing."""
    for name, function in IDS.items():
        if name not in gymnasium.registry:
            task = f"mars2d.rl.tasks:{function}"
            gymnasium.register(id=name, entry_point=task, vector_entry_point=task)
