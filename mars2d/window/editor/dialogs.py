"""The editor's dialogs: save, run, go on with a paused run, leave."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from mars2d.core.errors import InputError
from mars2d.scenario.changes import check_same
from mars2d.scenario.scenario import Scenario
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.document import Document
from mars2d.window.widgets.menu import Menu
from mars2d.window.widgets.prompt import Answer, Prompts
from mars2d.window.widgets.text_field import TextField


@dataclass(frozen=True)
class Outcome:
    """The scenario drawn in a paused run, and whether the run continues from now or the start."""

    scenario: Scenario
    when: Literal["now", "start"]


class Dialogs(Prompts):
    """Asks whether to save, run or apply a draft, and does it.

    before: the scenario that was opened. live: whether a paused run is edited. complete: finishes
    the outline that is being drawn. done: whether the editor is left. outcome: of a paused run.
    to_run: a file that is to be run.
    """

    def __init__(
        self,
        desk: Desk,
        menu: Menu,
        document: Document,
        before: Scenario,
        *,
        live: bool,
        complete: Callable[[], object],
    ) -> None:
        """Start without a question."""
        super().__init__(menu)
        self.done = False
        self.outcome: Outcome | None = None
        self.to_run: Path | None = None
        self._desk, self._document = desk, document
        self._before, self._live, self._complete = before, live, complete

    def _valid(self, doing: str) -> Scenario | None:
        """Return the scenario; show why there is none if the draft is not valid."""
        self._complete()
        verdict = self._desk.draft.verdict
        if verdict.scenario is None:
            self._desk.say(f"{doing}: {verdict.text}", warns=True)
        return verdict.scenario

    # -- save -----------------------------------------------------------------------------------

    def save(self, then: Callable[[], None] | None = None) -> None:
        """Save the draft, ask for a name first if there is none; then: called after saving."""
        if self._valid("Not saved") is None:
            return
        if self._document.path is None:
            self.ask(
                "Save as",
                Answer("save", lambda text: self._save_as(text, then)),
                field=TextField(self._document.proposal, opened_by_key=True),
                doc="a scenario file, in TOML",
            )
        elif self._document.new:
            self._save_as(str(self._document.path), then)
        else:
            self._write(self._document.path, then)

    def _save_as(self, text: str, then: Callable[[], None] | None) -> None:
        path = self._document.named(text)
        if not self._document.is_another(path):
            self._write(path, then)
            return
        self.ask(
            f"{path} is there already.",
            Answer("overwrite it", lambda _: self._write(path, then)),
        )

    def _write(self, path: Path, then: Callable[[], None] | None = None) -> None:
        scenario = self._valid("Not saved")
        if scenario is None:
            return
        try:
            scenario, said = self._document.save(scenario, path)
        except InputError as error:
            self._desk.say(str(error), warns=True)
            return
        if not self._live:
            self._desk.history.save(self._desk.draft.with_base(title=scenario.title))
        self._desk.say(said)
        if then is not None:
            then()

    def rescue(self) -> Path | None:
        """Save unsaved work to a new file, for when the person can no longer be asked.

        The last valid draft is saved. Return the file; None if there is nothing to save.
        """
        history = self._desk.history
        if self._live or not history.changed:
            return None
        self._desk.drop()
        while (scenario := history.draft.verdict.scenario) is None:
            if not history.go(-1):
                return None
        return self._document.rescue(scenario)

    # -- run, go on, leave ----------------------------------------------------------------------

    def run(self) -> None:
        """Ask for a run of the file; save it first if need be."""
        if self._desk.history.changed or self._document.new:
            self.save(then=self.run)
        else:
            self.to_run = self._document.path

    def apply(self, when: Literal["now", "start"]) -> None:
        """Leave, and continue the paused run with the draft."""
        scenario = self._valid("Not yet")
        if scenario is None:
            return
        if when == "now":
            try:
                check_same(self._before, scenario)
            except InputError as error:
                self._desk.say(f"{error} (Shift+Enter)", warns=True)
                return
        self.outcome, self.done = Outcome(scenario, when), True

    def leave(self) -> None:
        """Leave; ask first if work would be lost."""
        if not self._desk.history.changed:
            self._discard()
            return
        discard = Answer("discard", lambda _: self._discard(), "Backspace")
        if self._live:
            now = Answer("from now", lambda _: self.apply("now"))
            anew = Answer("from the start", lambda _: self.apply("start"), "Shift Enter")
            self.ask("Use what was drawn?", now, anew, discard, escape="stay")
        else:
            save = Answer("save", lambda _: self.save(then=self._discard))
            self.ask("Not saved yet.", save, discard, escape="stay")

    def _discard(self) -> None:
        self.done = True
