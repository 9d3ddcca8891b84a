"""The scenario file that the editor saves to."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from mars2d.core.errors import InputError
from mars2d.scenario import toml_file
from mars2d.scenario.scenario import Scenario
from mars2d.window.screen.saving import free_name

UNTITLED = Scenario.__dataclass_fields__["title"].default


class Document:
    """A scenario file, which may not have a name yet.

    path: the file to open or to create, if it ends in .toml; of other paths only the stem is used.
    control: the law of the team.
    """

    def __init__(self, path: Path | None, control: Callable[[Any], Any] | None = None) -> None:
        """Start without reading or writing anything."""
        toml = path is not None and path.suffix.lower() == toml_file.SUFFIX
        self.path = path if toml else None
        self.new = self.path is None or not self.path.exists()  # no file exists yet
        self.control = control
        wanted = Path("scenario.toml") if path is None else path
        self._wanted = wanted.with_suffix(toml_file.SUFFIX)

    @property
    def name(self) -> str:
        """The file's name, or a proposal."""
        return self._wanted.name if self.path is None else self.path.name

    @property
    def proposal(self) -> str:
        """A path that is still free."""
        stem, k = self._wanted.stem, 1
        path = self._wanted
        while path.exists():
            k += 1
            path = self._wanted.with_stem(f"{stem}_{k}")
        return str(path)

    def named(self, text: str) -> Path:
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

    def is_another(self, path: Path) -> bool:
        """Return whether a path is an existing file other than the one that was opened."""
        mine = self.path is not None and path.absolute() == self.path.absolute()
        return path.exists() and (self.new or not mine)

    def rescue(self, scenario: Scenario) -> Path | None:
        """Save to a new file, beside the own one or in the temporary folder; return its path."""
        wanted = self.path or self._wanted
        for folder in (wanted.parent, Path(tempfile.gettempdir())):
            with suppress(InputError):
                path = free_name(folder, f"{wanted.stem}_unsaved", toml_file.SUFFIX)
                toml_file.save_scenario(scenario, path, self.control)
                return path
        return None

    def save(self, scenario: Scenario, path: Path) -> tuple[Scenario, str]:
        """Save a scenario to a file, which is the open one from now on.

        Return it with the title that it has got if it had none, and a text about it.
        """
        if scenario.title == UNTITLED:
            scenario = scenario.replace(title=path.stem.replace("_", " ").capitalize())
        missing = toml_file.save_scenario(scenario, path, self.control)
        self.path, self._wanted, self.new = path, path, False
        if missing:
            return scenario, f"Saved {path}, without what is code: {', '.join(missing)}"
        return scenario, f"Saved {path}"
