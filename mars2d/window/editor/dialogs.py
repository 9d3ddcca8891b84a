"""The editor's dialogs: save, go on with a paused run, leave."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import chain, count
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from mars2d.core.errors import InputError
from mars2d.scenario import toml_file
from mars2d.scenario.changes import check_same
from mars2d.scenario.scenario import Scenario
from mars2d.window.screen.saving import free_name
from mars2d.window.widgets.prompt import Answer, Prompts

if TYPE_CHECKING:
    from mars2d.window.editor.editor import Editor

UNTITLED = Scenario.__dataclass_fields__["title"].default
Then = Callable[[], None]


@dataclass(frozen=True)
class Outcome:
    """The scenario drawn in a paused run, and whether the run continues from now or the start."""

    scenario: Scenario
    when: Literal["now", "start"]


class Dialogs(Prompts):
    """Asks whether to save or apply a draft, and does it; keeps the file that it is saved to.

    wanted: the file, or a proposal for its name. path: of the file, None if it has no name yet.
    control: the law of the team. new: whether no file exists yet. done: whether the editor is left.
    outcome: of a paused run.
    """

    def __init__(self, editor: Editor, path: Path | None, control: Any = None) -> None:
        """Start without a question, and without reading or writing anything.

        path, control: as for the editor.
        """
        super().__init__(editor.menu)
        self.done = False
        self.outcome: Outcome | None = None
        self._editor, self._desk, self.control = editor, editor.desk, control
        self._before = editor.desk.draft.base
        self.wanted = (path or Path("scenario.toml")).with_suffix(toml_file.SUFFIX)
        toml = path is not None and path.suffix.lower() == toml_file.SUFFIX
        self.path = path if toml else None
        self.new = self.path is None or not self.path.exists()

    @property
    def proposal(self) -> str:
        """A path that is still free."""
        others = (self.wanted.with_stem(f"{self.wanted.stem}_{k}") for k in count(2))
        return str(next(path for path in chain([self.wanted], others) if not path.exists()))

    def _valid(self, doing: str) -> Scenario:
        """Return the scenario. Raises InputError if the draft is not valid."""
        self._editor.tool.confirm()
        verdict = self._desk.draft.verdict
        if verdict.scenario is None:
            raise InputError(f"{doing}: {verdict.text}")
        return verdict.scenario

    # -- save -----------------------------------------------------------------------------------

    def save(self, then: Then = lambda: None) -> None:
        """Save the draft, ask for a name first if there is none; then: called after saving."""
        scenario = self._valid("Not saved")
        if self.path is None:
            answer = Answer("save", lambda text: self._save_to(_named(text), scenario, then))
            self.ask("Save as", answer, text=self.proposal, doc="a scenario file, in TOML")
        else:
            self._save_to(self.path, scenario, then)

    def _save_to(self, path: Path, scenario: Scenario, then: Then) -> None:
        """Save to a file; ask first if it is another scenario's."""
        answer = Answer("overwrite it", lambda _: self._write(scenario, path, then))
        if self.new and path.exists():
            self.ask(f"{path} is there already.", answer)
        else:
            answer.act("")

    def _write(self, scenario: Scenario, path: Path, then: Then) -> None:
        if scenario.title == UNTITLED:
            scenario = scenario.replace(title=path.stem.replace("_", " ").capitalize())
        missing = toml_file.save_scenario(scenario, path, self.control)
        self.path, self.wanted, self.new = path, path, False
        if not self._editor.live:
            self._desk.save(self._desk.draft.with_base(title=scenario.title))
        without = f", without what is code: {', '.join(missing)}" if missing else ""
        self._desk.say(f"Saved {path}{without}")
        then()

    def rescue(self) -> Path | None:
        """Save unsaved work to a new file, for when the person can no longer be asked.

        Return the file with the last valid draft; None if there is nothing to save.
        """
        desk = self._desk
        while desk.settled.verdict.scenario is None and desk.has(-1):
            desk.go(-1)
        scenario = desk.settled.verdict.scenario
        if scenario is None or not desk.changed:
            return None
        path = free_name(self.wanted.parent, f"{self.wanted.stem}_unsaved", toml_file.SUFFIX)
        toml_file.save_scenario(scenario, path, self.control)
        return path

    # -- go on, leave ---------------------------------------------------------------------------

    def apply(self, when: Literal["now", "start"]) -> None:
        """Leave, and continue the paused run with the draft."""
        scenario = self._valid("Not yet")
        if when == "now":
            try:
                check_same(self._before, scenario)
            except InputError as error:
                raise InputError(f"{error} (Shift+Enter)") from None
        self.outcome, self.done = Outcome(scenario, when), True

    def leave(self) -> None:
        """Leave; ask first if work would be lost, but not a second time."""
        discard = Answer("discard", lambda _: self._discard(), "Backspace")
        if self.prompt is not None or not self._desk.changed:
            self._discard()
        elif self._editor.live:
            now = Answer("from now", lambda _: self.apply("now"))
            anew = Answer("from the start", lambda _: self.apply("start"), "Shift Enter")
            self.ask("Use what was drawn?", now, anew, discard, escape="stay")
        else:
            save = Answer("save", lambda _: self.save(then=self._discard))
            self.ask("Not saved yet.", save, discard, escape="stay")

    def _discard(self) -> None:
        self.done = True


def _named(text: str) -> Path:
    """Return the path for a typed text. Raises InputError if it is no path of a file."""
    if not text.strip():
        raise InputError("expected a name, such as room.toml")
    path = Path(text.strip()).expanduser()
    if path.suffix.lower() != toml_file.SUFFIX:
        path = path.with_name(path.name + toml_file.SUFFIX)
    if path.is_dir():
        raise InputError(f"{path}: this is a folder")
    if not path.parent.is_dir():
        raise InputError(f"{path}: there is no folder {path.parent}")
    return path
