"""The environments that gymnasium knows by name, by the entry point ``gymnasium.envs``."""

from __future__ import annotations

from mars2d.core.extras import extra

__all__ = ["IDS", "register"]

IDS = {"Pursuit-v0": "pursuit", "Push-v0": "push", "Sumo-v0": "sumo", "Coverage-v0": "coverage"}
"""The names of the environments, after ``mars2d/``, and the functions that make them."""


def register() -> None:
    """Make the environments known to gymnasium, under ``mars2d/``; again does nothing.

    gymnasium calls this when it is imported, and sets the namespace itself.
    """
    with extra("rl", "environments need gymnasium"):
        from gymnasium.envs.registration import namespace, registry
        from gymnasium.envs.registration import register as add
    with namespace("mars2d"):
        for name, function in IDS.items():
            if f"mars2d/{name}" not in registry:
                add(id=name, entry_point=f"mars2d.rl.tasks:{function}")
