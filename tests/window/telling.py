"""Tells the state of an observed window as lines of JSON."""

import contextlib
import json
import signal
import threading

import pygame

PICTURES = 3
"""How many pictures after a question comes the answer: the last ones show all events before it."""


def unseen(function):
    """Hide a function from the time limit, which would take it for slow code of the user."""
    function.__code__ = function.__code__.replace(co_filename="<observer>")
    return function


class Teller:
    """Prints a state whenever it has changed, and in answer to SIGUSR1."""

    asked = 0  # pictures of the open window until the answer
    listens = False

    def __init__(self):
        self._told, self._state = "", None
        self._answers = 0
        self._pictures = self._told_pictures = 0
        if hasattr(signal, "SIGUSR1") and not Teller.listens:
            Teller.listens = True
            signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGUSR1})
            threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self):
        """Wake the window, which may wait for events, at each question."""
        while True:
            signal.sigwait({signal.SIGUSR1})
            Teller.asked = PICTURES
            self._wake()

    def _wake(self):
        with contextlib.suppress(pygame.error):
            pygame.event.post(pygame.Event(pygame.USEREVENT))

    def shown(self):
        """Tell the state of the picture that is on the screen by now."""
        self._pictures += 1
        if Teller.asked:
            Teller.asked -= 1
            if not Teller.asked:
                self._answers, self._told_pictures = self._answers + 1, self._pictures
            self._wake()
        if self._state is None:
            return
        told = json.dumps(self._state | {"answers": self._answers, "pictures": self._told_pictures})
        if told != self._told:
            self._told = told
            print(told, flush=True)

    def drawn(self, state):
        """Take the state of a picture that is drawn, and on the screen at the next one."""
        self._state = state
