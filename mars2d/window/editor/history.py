"""The history of a draft: undo and redo."""

from __future__ import annotations

from mars2d.window.editor.draft import Draft

__all__ = ["History"]

MAX_DRAFTS = 500


class History:
    """A list of drafts, and the index of the present one."""

    def __init__(self, draft: Draft) -> None:
        """Start with a draft that counts as saved."""
        self._drafts = [draft]
        self._place = 0
        self._tag = ""
        self._saved: Draft | None = draft

    @property
    def draft(self) -> Draft:
        """The present draft."""
        return self._drafts[self._place]

    @property
    def changed(self) -> bool:
        """Whether the present draft differs from the saved one."""
        return self.draft is not self._saved and self.draft != self._saved

    def put(self, draft: Draft, tag: str = "") -> None:
        """Continue with a draft. Consecutive changes with the same tag are undone as one."""
        if draft == self.draft:
            return
        merges = bool(tag) and tag == self._tag and self._place + 1 == len(self._drafts)
        end = self._place if merges else self._place + 1
        self._drafts[end:] = [draft]
        del self._drafts[:-MAX_DRAFTS]
        self._place, self._tag = len(self._drafts) - 1, tag

    @property
    def can_undo(self) -> bool:
        """Whether there is anything to undo."""
        return self._place > 0

    @property
    def can_redo(self) -> bool:
        """Whether there is anything to redo."""
        return self._place + 1 < len(self._drafts)

    def undo(self) -> bool:
        """Undo a change; return whether there was one."""
        return self._go(self._place - 1)

    def redo(self) -> bool:
        """Redo a change; return whether there was one."""
        return self._go(self._place + 1)

    def _go(self, place: int) -> bool:
        self._tag = ""
        if not 0 <= place < len(self._drafts):
            return False
        self._place = place
        return True

    def mark_saved(self) -> None:
        """Count the present draft as saved."""
        self._saved, self._tag = self.draft, ""

    def mark_unsaved(self) -> None:
        """Count no draft as saved."""
        self._saved = None
