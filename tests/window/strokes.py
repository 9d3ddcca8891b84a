"""Keys pressed by hand, as the events that a desktop makes of them."""

import pygame


def pressed(name, mod=0):
    """Return the events of a key that is pressed and released: a letter types itself."""
    typed = name if len(name) == 1 and not mod & pygame.KMOD_CTRL else ""
    code = pygame.key.key_code(name)
    text = [pygame.Event(pygame.TEXTINPUT, text=typed)] if typed else []
    down, up = (pygame.Event(kind, key=code, unicode=typed, mod=mod)
                for kind in (pygame.KEYDOWN, pygame.KEYUP))  # fmt: skip
    return [down, *text, up]


def press(part, *names, mod=0):
    """Press keys, one after the other; return whether the part has taken the last one."""
    taken = False
    for name in names:
        taken, *_ = [part.handle(event) for event in pressed(name, mod)]
    return taken
