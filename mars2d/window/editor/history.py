"""What can be undone and done again."""

from __future__ import annotations

from mars2d.window.editor.draft import Draft

__all__ = ["History"]

MOST = 500
"""So many drafts are kept."""


class History:
    """Drafts one after the other, and the place among them."""

    def __init__(self, draft: Draft) -> None:
        """Start with one draft, which is as it is kept elsewhere."""
        self._drafts = [draft]
        self._place = 0
        self._tag = ""
        self._kept: Draft | None = draft

    @property
    def draft(self) -> Draft:
        """The draft of now."""
        return self._drafts[self._place]

    @property
    def changed(self) -> bool:
        """Whether it differs from what is kept elsewhere."""
        return self.draft is not self._kept and self.draft != self._kept

    def put(self, draft: Draft, tag: str = "") -> None:
        """Go on with a draft. Changes with the same tag, one after the other, are undone as one."""
        if draft == self.draft:
            return
        merges = bool(tag) and tag == self._tag and self._place + 1 == len(self._drafts)
        end = self._place if merges else self._place + 1
        self._drafts[end:] = [draft]
        del self._drafts[:-MOST]
        self._place, self._tag = len(self._drafts) - 1, tag

    @property
    def can_undo(self) -> bool:
        """Whether there is anything to undo."""
        return self._place > 0

    @property
    def can_redo(self) -> bool:
        """Whether there is anything to do again."""
        return self._place + 1 < len(self._drafts)

    def undo(self) -> bool:
        """Go one back; return whether there was anything to undo."""
        return self._go(self._place - 1)

    def redo(self) -> bool:
        """Go one on again; return whether there was anything to do again."""
        return self._go(self._place + 1)

    def _go(self, place: int) -> bool:
        self._tag = ""
        if not 0 <= place < len(self._drafts):
            return False
        self._place = place
        return True

    def keep(self) -> None:
        """Take note that the draft of now is kept elsewhere."""
        self._kept, self._tag = self.draft, ""

    def lose(self) -> None:
        """Take note that nothing is kept elsewhere."""
        self._kept = None
