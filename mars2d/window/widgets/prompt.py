"""Questions over a picture, which are answered by a choice, or by a line of text."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

from mars2d.core.errors import Mars2dError
from mars2d.window.widgets.menu import Entry, Menu
from mars2d.window.widgets.text_field import TextField


class Answer(NamedTuple):
    """A way to answer a prompt, by Enter, a click, or a key of its own.

    act: takes the text that was typed; if it raises Mars2dError, the error is shown and the prompt
    stays open.
    """

    words: str
    act: Callable[[str], None] = lambda _: None
    key: str = ""


@dataclass
class Prompt:
    """A question over which nothing else can be done.

    field: to type in, if there is one. doc: says more about it. fault: an error, and the text that
    it is about.
    """

    label: str
    field: TextField | None
    doc: str
    fault: tuple[str, str] = "", ""

    @property
    def text(self) -> str:
        """What was typed so far."""
        return "" if self.field is None else self.field.text

    @property
    def error(self) -> str:
        """Why what was typed can't be taken, "" if it has not been refused."""
        return self.fault[0] if self.fault[1] == self.text else ""


class Prompts:
    """Asks in a menu.

    prompt: the open question.
    """

    def __init__(self, menu: Menu) -> None:
        """Start without a question."""
        self.prompt: Prompt | None = None
        self._menu = menu

    def ask(
        self,
        label: str,
        *answers: Answer,
        text: str | None = None,
        doc: str = "",
        escape: str = "cancel",
    ) -> None:
        """Open a prompt, of which Enter gives the first answer.

        text: stands in a field to type in, selected; None for no field. escape: what Esc does, in
        words.
        """
        field = None if text is None else TextField(text, opened_by_key=True)
        if field is not None:
            field.select_all()
        self._show(Prompt(label, field, doc), [*answers, Answer(escape, key="Esc")])

    def _show(self, prompt: Prompt, answers: Sequence[Answer]) -> None:
        self.prompt = prompt

        def answer(chosen: Answer) -> None:
            self.prompt = None
            try:
                chosen.act(prompt.text)
            except Mars2dError as error:
                prompt.fault = str(error), prompt.text
                self._show(prompt, answers)

        def entries() -> list[Entry]:
            words, tone = prompt.error or prompt.doc, "warning" if prompt.error else "note"
            told = [Entry(words, tone=tone)] if words else []
            ways = [
                Entry(each.words, partial(answer, each), each.key, value="Enter" * (not each.key))
                for each in answers
            ]
            return [Entry(prompt.label, field=prompt.field), *told, *ways]

        self._menu.open("prompt", entries, (0, 0), asks=True)
