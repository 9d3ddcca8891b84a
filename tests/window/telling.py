"""Tells the state of an observed window as lines of JSON."""

import json
import signal

PICTURES = 3
"""How many pictures after a question comes the answer: the last ones show all events before it."""


class Teller:
    """Prints a state whenever it has changed, and in answer to SIGUSR1."""

    def __init__(self):
        self._told, self._state = "", None
        self._answers = self._asked = 0
        if hasattr(signal, "SIGUSR1"):
            signal.signal(signal.SIGUSR1, self._ask)

    def _ask(self, *_):
        self._asked = PICTURES

    def shown(self):
        """Tell the state of the picture that is on the screen by now."""
        if self._asked:
            self._asked -= 1
            self._answers += not self._asked
        if self._state is None:
            return
        told = json.dumps(self._state | {"answers": self._answers})
        if told != self._told:
            self._told = told
            print(told, flush=True)

    def drawn(self, state):
        """Take the state of a picture that is drawn, and on the screen at the next one."""
        self._state = state
