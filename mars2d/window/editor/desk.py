"""What the tools work at: the draft with its history, what is selected, how it is looked at."""

from __future__ import annotations

from collections.abc import Iterable
from math import floor, hypot, log10

from mars2d.core.errors import InputError
from mars2d.core.plane import Point, grid_step
from mars2d.output.raster.camera import Camera
from mars2d.window.editor.draft import Draft
from mars2d.window.editor.history import History
from mars2d.window.editor.item import Item, Motion, tidy
from mars2d.window.viewpoint import Viewpoint

__all__ = ["Desk", "Gesture"]

SNAP = 9.0
"""The grid that things snap to has steps of at least so many points."""


class Gesture:
    """What a drag does: `to` returns the draft with the pointer at a point."""

    def to(self, point: Point, *, shift: bool) -> Draft:
        """Return what becomes of the draft when the pointer is at a point [m]."""
        raise NotImplementedError


class Desk:
    """A draft under the hands of a person.

    selection: the things selected, in the order in which they were. corner: the number of the
    corner that was touched last, of the one outline that is selected. viewpoint: from where it is
    looked at.
    """

    def __init__(self, draft: Draft, viewpoint: Viewpoint) -> None:
        """Start with nothing selected."""
        self.history = History(draft)
        self.selection: tuple[Item, ...] = ()
        self.corner: int | None = None
        self.viewpoint = viewpoint
        self.snaps = True
        self.notice = ""
        self.warns = False
        self._held: Draft | None = None

    # -- the draft --------------------------------------------------------------------------------

    @property
    def draft(self) -> Draft:
        """The draft as it is seen now, in the middle of a drag, too."""
        return self.history.draft if self._held is None else self._held

    def put(self, draft: Draft, tag: str = "") -> None:
        """Go on with a draft; `tag` as in `History.put`."""
        self._held = None
        self.history.put(draft, tag)
        self._forget()

    def hold(self, draft: Draft) -> None:
        """Show a draft in the middle of a drag."""
        self._held = draft

    def drag(self, gesture: Gesture, point: Point, *, shift: bool) -> None:
        """Show what a drag makes of the draft; what can't be is said and not done."""
        try:
            self.hold(gesture.to(point, shift=shift))
        except InputError as error:
            self.say(str(error), warns=True)

    def settle(self) -> None:
        """Go on with what a drag has made."""
        if self._held is not None:
            self.put(self._held)

    def drop(self) -> bool:
        """Forget what a drag has made; return whether there was any."""
        held, self._held = self._held, None
        return held is not None

    def undo(self) -> None:
        """Undo the last change."""
        if not self.drop() and not self.history.undo():
            self.say("there is nothing to undo")
        self._forget()

    def redo(self) -> None:
        """Do again what was undone."""
        self.drop()
        if not self.history.redo():
            self.say("there is nothing to do again")
        self._forget()

    # -- what is selected -------------------------------------------------------------------------

    def select(self, items: Iterable[Item] = ()) -> None:
        """Select things, and nothing else."""
        self.selection, self.corner = tuple(dict.fromkeys(items)), None

    @property
    def only(self) -> Item | None:
        """The thing selected, if it is one alone."""
        return self.selection[0] if len(self.selection) == 1 else None

    def _forget(self) -> None:
        """Drop from the selection what is no longer there."""
        kept = tuple(item for item in self.selection if self.draft.holds(item))
        if kept != self.selection:
            self.select(kept)
        corners = None if self.only is None else self.draft.corners(self.only)
        if self.corner is not None and self.corner >= len(corners or ()):
            self.corner = None

    def say(self, text: str, *, warns: bool = False) -> None:
        """Say something at the foot of the window, until the next thing is done."""
        self.notice, self.warns = text, warns

    # -- what is done to it -----------------------------------------------------------------------

    def remove(self) -> None:
        """Remove the corner that was touched last, or else what is selected."""
        item = self.only
        corners = None if item is None else self.draft.corners(item)
        if item is None or corners is None or self.corner is None:
            if self.selection:
                self.put(self.draft.without(self.selection))
                self.select()
            return
        least = 2 if item.kind == "wall" or len(corners) == 2 else 3
        if len(corners) == least:
            self.say(f"{self.draft.name(item)} needs {least} corners", warns=True)
            return
        left = (*corners[: self.corner], *corners[self.corner + 1 :])
        self.corner = None
        self.put(self.draft.with_corners(item, left))

    def duplicate(self) -> None:
        """Put a copy of what is selected beside it, and select that."""
        items = [item for item in self.selection if item.kind != "workspace"]
        if items:
            aside = Motion(by=(2 * self.step, -2 * self.step))
            draft, copies = self.draft.copied(items, aside)
            self.put(draft)
            self.select(copies)

    def nudge(self, dx: int, dy: int, *, fine: bool) -> None:
        """Move the corner that was touched last, or what is selected, by steps of the grid.

        fine: by tenths of a step.
        """
        step = self.step * (0.1 if fine else 1.0)
        moved = Motion(by=(dx * step, dy * step))
        if self.corner is not None and self.only is not None:
            corners = list(self.draft.corners(self.only) or ())
            corners[self.corner] = moved.point(corners[self.corner])
            self.put(self.draft.with_corners(self.only, corners), tag="nudge")
        elif self.selection:
            self.put(self.draft.moved(self.selection, moved), tag="nudge")

    # -- how it is looked at ----------------------------------------------------------------------

    @property
    def camera(self) -> Camera:
        """From where the drawing is seen."""
        return self.viewpoint.camera

    @property
    def ui(self) -> float:
        """Pixels a point."""
        return self.viewpoint.layout.ui

    @property
    def step(self) -> float:
        """The step of the grid that things snap to, metres."""
        return grid_step(SNAP * self.ui / self.camera.scale)

    def metres(self, points: float) -> float:
        """Return how long so many points of the screen are, metres."""
        return points * self.ui / self.camera.scale

    def snapped(self, point: Point) -> Point:
        """Return the nearest point of the grid; without it, the point to a tenth of a pixel."""
        step = self.step if self.snaps else 10.0 ** floor(log10(self.metres(1.0)))
        x, y = (tidy(round(value / step) * step) for value in point)
        return x, y

    def near(self, a: Point, b: Point, points: float) -> bool:
        """Return whether two points are so near on the screen."""
        return hypot(a[0] - b[0], a[1] - b[1]) <= self.metres(points)
