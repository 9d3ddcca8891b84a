"""What windows remember from one time to the next: size, colours, panels, files last opened."""

from __future__ import annotations

import hashlib
import json
import os
from contextlib import suppress
from pathlib import Path
from typing import Any

import pygame

from mars2d.core.errors import InputError
from mars2d.core.files import atomic_write
from mars2d.window.screen.display import Preferences

VARIABLE = "MARS2D_MEMORY"
"""The environment variable that names the folder; if it is empty, nothing is remembered."""
WINDOWS = "windows.json"
"""The file of how windows looked, and of the files last opened."""
RECENT = 8
"""How many files are remembered."""
SIZE = (1280, 720)
"""The size of the first window, points."""
PICTURE = (320, 200)
"""The size of a remembered file's picture, pixels."""


class Memory:
    """Small files in the folder of the user's settings.

    They are a help, not data: one that can't be read is empty, one that can't be written stays.
    """

    def __init__(self) -> None:
        """Find the folder; make none yet."""
        chosen = os.environ.get(VARIABLE)
        self._folder = Path(chosen) if chosen else None
        if chosen is None:
            with suppress(pygame.error, AttributeError):  # a home that can't be written
                self._folder = Path(pygame.system.get_pref_path("MARS2D", "windows"))

    @property
    def recent(self) -> list[Path]:
        """The files last opened that are still there, the last one first."""
        paths = [Path(each) for each in self._known.get("recent", []) if isinstance(each, str)]
        return [path for path in paths if path.is_file()][:RECENT]

    def preferences(self, *, dark: bool | None = None, text: float | None = None) -> Preferences:
        """Return how windows looked last; arguments take precedence."""
        looks = {name: self._known[name] for name in ("dark", "text") if name in self._known}
        try:
            last = Preferences(**looks)
        except InputError:  # a file that was edited
            last = Preferences()
        return Preferences(dark=last.dark if dark is None else dark, text=text or last.text)

    @property
    def size(self) -> tuple[int, int]:
        """The size of the last window, points."""
        match self._known.get("size"):
            case [int(width), int(height)] if 400 <= width <= 8000 and 300 <= height <= 8000:
                return width, height
        return SIZE

    @property
    def panels(self) -> list[str]:
        """The names of the panels that were open in the last window; at first the lesson is."""
        known = self._known.get("panels", ["lesson"])
        return [name for name in known if isinstance(name, str)] if isinstance(known, list) else []

    def keep(self, **looks: Any) -> None:
        """Remember how a window looks, if the folder can be written."""
        if self._folder is None:
            return
        with suppress(InputError, OSError):
            self._folder.mkdir(parents=True, exist_ok=True)
            with atomic_write(self._folder / WINDOWS) as file:
                file.write(json.dumps(self._known | looks, indent=1).encode())

    def opened(self, path: Path, picture: pygame.Surface | None = None) -> None:
        """Remember that a file was opened, and its picture."""
        path = path.absolute()
        others = [str(each) for each in self.recent if each != path]
        self.keep(recent=[str(path), *others][:RECENT])
        file = self.picture(path)
        if picture is not None and file is not None:
            with suppress(InputError), atomic_write(file) as png:
                pygame.image.save(_small(picture), png, "x.png")

    def picture(self, path: Path) -> Path | None:
        """Return where the picture of a file is kept, if pictures are."""
        if self._folder is None:
            return None
        return self._folder / f"{hashlib.sha256(str(path).encode()).hexdigest()[:16]}.png"

    @property
    def _known(self) -> dict[str, Any]:
        """What is remembered; empty if it can't be read."""
        if self._folder is None:
            return {}
        try:
            known = json.loads((self._folder / WINDOWS).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return {}
        return known if isinstance(known, dict) else {}


def _small(picture: pygame.Surface) -> pygame.Surface:
    """Return the middle of a picture, as large as pictures of files are."""
    width, height = picture.get_size()
    share = min(width / PICTURE[0], height / PICTURE[1])
    part = pygame.Rect(0, 0, int(share * PICTURE[0]), int(share * PICTURE[1]))
    part.center = width // 2, height // 2
    return pygame.transform.smoothscale(picture.subsurface(part), PICTURE)
