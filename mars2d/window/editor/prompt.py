"""A question at the foot of the window, with a field to type in or without."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from mars2d.core.errors import Mars2dError

__all__ = ["Prompt"]

LONGEST = 200
"""So many characters can be typed."""


class Prompt:
    """Asks until one of its keys is pressed; Esc closes it without an answer.

    answers: what keys do, by their names, with what was typed. field: whether there is something to
    type. Where an answer raises, what is wrong is shown, and the prompt stays open.
    """

    def __init__(
        self,
        label: str,
        hint: str,
        answers: Mapping[str, Callable[[str], None]],
        *,
        text: str = "",
        field: bool = False,
    ) -> None:
        """Ask `label`; hint: which keys there are; text: what stands in the field at first."""
        self.label, self.hint, self.text, self.field = label, hint, text, field
        self.error = ""
        self.open = True
        self._answers = answers

    def press(self, name: str, character: str) -> None:
        """Take a key: its name, and what it types."""
        name = "return" if name == "enter" else "shift+return" if name == "shift+enter" else name
        if name == "escape":
            self.open = False
        elif name in self._answers:
            self._answer(self._answers[name])
        elif self.field and name == "backspace":
            self.text, self.error = self.text[:-1], ""
        elif self.field and character.isprintable() and len(self.text) < LONGEST:
            self.text, self.error = self.text + character, ""

    def _answer(self, answer: Callable[[str], None]) -> None:
        self.open = False  # unless what is done asks anew
        try:
            answer(self.text)
        except Mars2dError as error:
            self.open, self.error = True, str(error)
