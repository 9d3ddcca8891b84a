"""What a person can do in a window: one table of actions makes keys, buttons and help."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import pygame

CONTROL = pygame.KMOD_CTRL | pygame.KMOD_META
MODIFIERS = frozenset(
    f"{side} {key}" for side in ("left", "right") for key in ("shift", "ctrl", "alt", "meta", "gui")
) | {"caps lock", "numlock", "scroll lock", "alt gr", "menu", "print screen", ""}
"""Keys that only modify other keys."""
LABELS = {
    "escape": "Esc", "delete": "Del", "return": "Enter",  "left": "←", "right": "→", "up": "↑",
    "down": "↓", "page up": "PgUp", "page down": "PgDn", "-": "\N{MINUS SIGN}",
}  # fmt: skip
"""The labels of keys that differ from their names by more than the case."""


@dataclass(frozen=True, slots=True)
class Action:
    """Something a person can do: by a key, a button, or both.

    name: one word. help: a line of the help, "" for none. labels: those of its keys, as `label_of`
    returns them; also: of further keys, which the help does not list. act: its effect; None for
    what the window handles itself, such as drags. title, icon: of its button; lit_icon: while it is
    on. on: whether what it switches is on. when: whether it can be done now. repeats: whether a
    held key repeats it.
    """

    name: str
    help: str = ""
    labels: tuple[str, ...] = ()
    act: Callable[[], object] | None = None
    also: tuple[str, ...] = ()
    title: str = ""
    icon: str = ""
    lit_icon: str = ""
    on: Callable[[], bool] | None = None
    when: Callable[[], bool] | None = None
    repeats: bool = False

    @property
    def tip(self) -> str:
        """What is shown beside the pointer over its button."""
        return f"{self.title} ({self.labels[0]})" if self.labels else self.title

    @property
    def lit(self) -> bool:
        """Whether its button shows that it is on."""
        return self.on is not None and self.on()

    @property
    def works(self) -> bool:
        """Whether it does anything now."""
        return self.when is None or self.when()


def label_of(event: pygame.Event) -> str:
    """Return the label of a pressed key as menus and the help write it: ``L``, ``Ctrl Shift Z``.

    A digit or sign is what it types, wherever it lies on the keyboard.
    """
    name, typed = pygame.key.name(event.key), str(event.unicode)
    control = event.mod & CONTROL
    if typed.strip() and typed.isprintable() and not typed.isalpha() and not control:
        return LABELS.get(typed, typed)
    held = [*["Ctrl"] * bool(control), *["Shift"] * bool(event.mod & pygame.KMOD_SHIFT)]
    return " ".join([*held, LABELS.get(name, name.capitalize())])


def action_of(event: pygame.Event, actions: Iterable[Action]) -> Action | None:
    """Return the action of a pressed key, if there is one; with Shift also the one without it."""
    by_label = {label: action for action in actions for label in (*action.labels, *action.also)}
    label: str = label_of(event)
    return by_label.get(label) or by_label.get(label.replace("Shift ", ""))
