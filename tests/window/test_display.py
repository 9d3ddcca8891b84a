"""A window opens on a display that is there, and what was typed before is not for it."""

import pygame

from mars2d.window.screen import display


def test_keys_pressed_while_a_window_made_way_for_the_next_one_are_forgotten(monkeypatch):
    monkeypatch.setattr(display, "open_display", pygame.display.init)
    pygame.display.init()
    pygame.event.clear()
    pygame.event.post(pygame.Event(pygame.KEYDOWN, key=pygame.K_RETURN, unicode="\r", mod=0))
    pygame.event.post(pygame.Event(pygame.QUIT))
    with display.started_display():
        assert [event.type for event in pygame.event.get()] == [pygame.QUIT]
