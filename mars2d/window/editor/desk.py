"""The desk that tools work at: the draft with its history, the selection, the view."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from math import floor, hypot, log10

import numpy as np
import shapely

from mars2d.core.errors import InputError
from mars2d.core.plane import Outline, Point, grid_step
from mars2d.window.editor.draft import LEAST, Draft, Item, Motion, tidy
from mars2d.window.screen.viewpoint import Viewpoint

MIN_GRID_STEP = 9.0
"""The smallest step of the grid on the screen, points."""
NEAR, POINT_RADIUS = 5.0, 4.0
"""A point this far from an item still hits it, and the radius of beacons and waypoints, points of
the screen."""


class Desk:
    """The draft with everything that tools need; the drafts so far, to undo and to redo.

    saved: the draft of the file. selection: the selected items, in the order of selection. corner:
    the index of the last touched corner, if one outline alone is selected. snaps: whether points
    snap to the grid. shift: whether Shift is held. notice: a text for the footer; warns: whether it
    is a warning.
    """

    def __init__(self, draft: Draft, viewpoint: Viewpoint) -> None:
        """Start with nothing selected, and with a draft that counts as saved."""
        self.saved: Draft | None = draft
        self._drafts, self._now, self._tag = [draft], 0, ""
        self._held: Draft | None = None
        self.selection: tuple[Item, ...] = ()
        self.corner: int | None = None
        self.viewpoint = viewpoint
        self.snaps, self.shift = True, False
        self.notice, self.warns = "", False

    # -- the draft --------------------------------------------------------------------------------

    @property
    def settled(self) -> Draft:
        """The present draft; in the middle of a drag, that of before."""
        return self._drafts[self._now]

    @property
    def draft(self) -> Draft:
        """The present draft, also in the middle of a drag."""
        return self.settled if self._held is None else self._held

    @property
    def changed(self) -> bool:
        """Whether the draft differs from the saved one."""
        return self.settled is not self.saved and self.settled != self.saved

    def save(self, saved: Draft) -> None:
        """Count the present draft as saved; saved: it, with the title that it has got."""
        self._drafts[self._now] = self.saved = saved
        self._tag = ""

    def put(self, draft: Draft, tag: str = "", *, shows: bool = False) -> None:
        """Continue with a draft. Consecutive changes with the same tag are undone as one.

        shows: select what is new in it.
        """
        before, self._held = self.settled, None
        if draft != before:
            self._now += not tag or tag != self._tag
            self._drafts, self._tag = [*self._drafts[: self._now], draft], tag
        self._see(before if shows else draft)

    def hold(self, to: Callable[[Point], Draft], point: Point) -> None:
        """Show the draft of a drag to a point; an InputError is shown, and it stays as it was."""
        if self.warns:
            self.say("")
        try:
            self._held = to(point)
        except InputError as error:
            self.say(str(error), warns=True)

    def settle(self) -> None:
        """Continue with the draft of the drag."""
        if self._held is not None:
            self.put(self._held, shows=True)

    def drop(self) -> bool:
        """Drop the draft of the drag; return whether there was one."""
        held, self._held = self._held, None
        self._see(self.draft)
        return held is not None

    def has(self, by: int) -> bool:
        """Return whether there is a change to redo, or for a number below 0 to undo."""
        return 0 <= self._now + by < len(self._drafts)

    def go(self, by: int) -> None:
        """Redo a change, or for a number below 0 undo one, if only that of a drag."""
        before, self._tag = self.draft, ""
        if self.drop() and by < 0:
            pass
        elif self.has(by):
            self._now += by
        else:
            self.say(f"there is nothing to {'redo' if by > 0 else 'undo'}")
        self._see(before)

    # -- the selection ----------------------------------------------------------------------------

    def select(self, items: Iterable[Item] = ()) -> None:
        """Select items in place of the present selection."""
        self.selection, self.corner = tuple(dict.fromkeys(items)), None

    @property
    def only(self) -> Item | None:
        """The selected item, if there is exactly one."""
        return self.selection[0] if len(self.selection) == 1 else None

    @property
    def corners(self) -> Outline:
        """The corners of the selected item; none if it has none, or if several are selected."""
        return () if self.only is None else self.draft.corners(self.only)

    def _see(self, before: Draft) -> None:
        """Select what a draft before did not have; select nothing that is no longer there."""
        kept = tuple(item for item in self.selection if item in self.draft.things)
        if kept != self.selection:
            self.select(kept)
        new = self.draft.new_since(before)
        if not set(new) <= set(self.selection):
            self.select(new)
        if self.corner is not None and self.corner >= len(self.corners):
            self.corner = None

    def item_at(self, point: Point, but: Collection[Item] = ()) -> Item | None:
        """Return the uppermost item at a point [m], or None; the workspace is never returned.

        but: items that are looked through.
        """
        shapes = {item: s for item, s in self.draft.shapes.items() if item not in but}
        small = [isinstance(shape, shapely.Point) for shape in shapes.values()]
        gaps = shapely.distance([*shapes.values()], shapely.Point(point))
        gaps = np.maximum(gaps - self.metres(POINT_RADIUS) * np.array(small), 0.0)
        least = gaps.min(initial=self.metres(NEAR))
        hit = [item for item, gap in zip(shapes, gaps, strict=True) if gap <= least]
        return hit[-1] if hit else None

    def items_within(self, a: Point, b: Point) -> list[Item]:
        """Return the items that lie wholly in the rectangle between two corners."""
        shapes = self.draft.shapes
        area = shapely.box(*np.minimum(a, b), *np.maximum(a, b))
        inside = shapely.covers(area, shapely.envelope([*shapes.values()]))
        return [item for item, lies in zip(shapes, inside, strict=True) if lies]

    def say(self, text: str, *, warns: bool = False) -> None:
        """Show a text in the footer, until the next action."""
        self.notice, self.warns = text, warns

    # -- changes ----------------------------------------------------------------------------------

    def remove(self) -> None:
        """Remove the last touched corner, or else the selection; so an item goes with its last."""
        item, number, self.corner = self.only, self.corner, None
        if item is None or number is None or len(self.corners) <= LEAST[item.kind]:
            self.put(self.draft.without(self.selection))
            self.select()
        else:
            self.put(self.draft.with_corner(item, number))

    def duplicate(self) -> None:
        """Put a copy beside the selection, and select it; of a corner, half-way to the next one."""
        if self.only is not None and self.corner is not None:
            a, b = (*self.corners, self.corners[0])[self.corner : self.corner + 2]
            middle = tidy((a[0] + b[0]) / 2), tidy((a[1] + b[1]) / 2)
            self.put(self.draft.with_corner(self.only, self.corner, a, middle))
            self.corner += 1
            return
        items = [item for item in self.selection if item.kind != "workspace"]
        aside = Motion(by=(2 * self.step, -2 * self.step))
        self.put(self.draft.copied(items, aside), shows=True)

    def nudge(self, dx: int, dy: int) -> None:
        """Move the last touched corner, or else the selection, by steps or with Shift by tenths."""
        step = self.step * (0.1 if self.shift else 1.0)
        moved = Motion(by=(dx * step, dy * step))
        if self.corner is not None and self.only is not None:
            place = moved.point(self.corners[self.corner])
            self.put(self.draft.with_corner(self.only, self.corner, place), tag="nudge")
        elif self.selection:
            self.put(self.draft.moved(self.selection, moved), tag="nudge")

    # -- the view ---------------------------------------------------------------------------------

    @property
    def step(self) -> float:
        """The step of the grid to which points snap, metres."""
        return grid_step(self.metres(MIN_GRID_STEP))

    def metres(self, points: float) -> float:
        """Return the length of points of the screen, metres."""
        return points * self.viewpoint.layout.ui / self.viewpoint.camera.scale

    def snapped(self, point: Point) -> Point:
        """Return the nearest grid point; without snapping, the point to a fraction of a pixel."""
        step = self.step if self.snaps else 10.0 ** floor(log10(self.metres(1.0)))
        x, y = (tidy(round(value / step) * step) for value in point)
        return x, y

    def snap_or_not(self) -> None:
        """Let points snap to the grid from now on, or no longer."""
        self.snaps = not self.snaps
        self.say(f"points snap to a grid of {self.step:g} m" if self.snaps else "points are free")

    def near(self, a: Point, b: Point, points: float) -> bool:
        """Return whether two points are at most this near on the screen."""
        return hypot(a[0] - b[0], a[1] - b[1]) <= self.metres(points)
