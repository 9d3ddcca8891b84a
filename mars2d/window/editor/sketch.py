"""A draft as it is drawn."""

from __future__ import annotations

import copy

from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario
from mars2d.window.editor.draft import Draft

__all__ = ["Sketch"]


class Sketch:
    """Returns frames of one draft after the other.

    Their scenario stays the same object as long as nothing has changed but robots, props,
    waypoints and beacons: so what stands still need not be drawn again while they are dragged.
    """

    def __init__(self) -> None:
        """Start without a draft."""
        self._draft: Draft | None = None
        self._bare = False
        self._scenario: Scenario | None = None

    def frame(self, draft: Draft, *, bare: bool) -> Frame:
        """Return the instant before the start; bare: without add-ons that no mouse can draw."""
        if self._scenario is None or draft is not self._draft or bare is not self._bare:
            fresh = copy.copy(draft.bare_sketch if bare else draft.sketch)
            if self._scenario is None or not self._same_ground(draft, bare=bare):
                self._scenario = fresh
            else:  # a copy of our own, which nobody else has
                self._scenario.__dict__.clear()
                self._scenario.__dict__.update(fresh.__dict__)
            self._draft, self._bare = draft, bare
        return draft.frame(self._scenario)

    def _same_ground(self, draft: Draft, *, bare: bool) -> bool:
        """Return whether a draft has the same obstacles and workspace as the last one."""
        last = self._draft
        return (
            last is not None
            and bare is self._bare
            and last.base is draft.base
            and last.outlines is draft.outlines
            and last.walls is draft.walls
            and last.workspace is draft.workspace
        )
