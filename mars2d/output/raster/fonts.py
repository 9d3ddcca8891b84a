"""The typeface of windows and pictures, the same on every machine."""

from __future__ import annotations

import re
from importlib.util import find_spec
from pathlib import Path

import pygame


def _typeface(bold: bool, mono: bool) -> str | None:
    """Return the file of DejaVu Sans, which matplotlib ships, or None for pygame's own font."""
    found = find_spec("matplotlib")  # finds it without importing it, which would be slow
    if found is None or not found.submodule_search_locations:
        return None
    folder = Path(found.submodule_search_locations[0]) / "mpl-data" / "fonts" / "ttf"
    file = folder / f"DejaVuSans{'Mono' if mono else ''}{'-Bold' if bold else ''}.ttf"
    return str(file) if file.exists() else None


class Fonts:
    """Renders text, and caches the rendered texts."""

    KEPT = 512

    def __init__(self) -> None:
        """Start with an empty store; needs no display."""
        pygame.font.init()
        self._fonts: dict[tuple[int, bool, bool], pygame.font.Font] = {}
        self._texts: dict[tuple[str, int, str, bool, bool], pygame.Surface] = {}

    def font(self, size: float, bold: bool = False, mono: bool = False) -> pygame.font.Font:
        """Return the font whose letters are `size` pixels high; mono: all equally wide."""
        key = (max(6, round(size)), bold, mono)
        if key not in self._fonts:
            self._fonts[key] = pygame.font.Font(_typeface(bold, mono), key[0])
        return self._fonts[key]

    def render(
        self, text: str, size: float, color: str, bold: bool = False, mono: bool = False
    ) -> pygame.Surface:
        """Return one line of text on a transparent surface; control characters become blanks."""
        key = (text, max(6, round(size)), color, bold, mono)
        found = self._texts.pop(key, None)
        if found is None:
            clean = "".join(c if c.isprintable() else " " for c in text)
            found = self.font(size, bold, mono).render(clean, True, color[:7])
            if len(color) > 7:
                found.set_alpha(int(color[7:9], 16))
            while len(self._texts) >= self.KEPT:
                del self._texts[next(iter(self._texts))]
        self._texts[key] = found
        return found

    def width(self, text: str, size: float, bold: bool = False, mono: bool = False) -> int:
        """Return the width of a line of text, pixels."""
        return self.font(size, bold, mono).size(text)[0]

    def shorten(
        self, text: str, size: float, room: float, bold: bool = False, mono: bool = False
    ) -> str:
        """Return `text`, cut with an ellipsis where it is wider than `room` pixels."""
        if self.width(text, size, bold, mono) <= room:
            return text
        while text and self.width(f"{text}…", size, bold, mono) > room:
            text = text[:-1].rstrip()
        return f"{text}…"

    def wrap(
        self, text: str, size: float, room: float, lines: int, bold: bool = False
    ) -> list[str]:
        """Return `text` as at most `lines` lines none of which is wider than `room` pixels.

        A path that is wider than a line is broken after one of its folders.
        """
        result: list[str] = []
        for paragraph in text.splitlines() or [""]:
            line = ""
            for word in paragraph.split():
                parts = [word]
                if self.width(word, size, bold) > room:
                    parts = re.findall(r"[^/\\]+[/\\]*|[/\\]+", word)
                for k, part in enumerate(parts):
                    longer = f"{line}{'' if k else ' '}{part}".strip()
                    if line and self.width(longer, size, bold) > room:
                        result.append(line)
                        line = part
                    else:
                        line = longer
            result.append(line)
        if len(result) > lines:
            result = [*result[: lines - 1], " ".join(result[lines - 1 :])]
        return [self.shorten(line, size, room, bold) for line in result]
