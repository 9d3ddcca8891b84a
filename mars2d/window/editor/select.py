"""The tool that selects, moves, turns and resizes."""

from __future__ import annotations

from mars2d.core.errors import InputError
from mars2d.core.plane import Point, bounds_of, rectangle
from mars2d.core.scene import Scene, faded
from mars2d.window.editor.handles import (
    MARK,
    Handle,
    cornering,
    draw_handles,
    handle_at,
    moving,
    ring_of,
    sizing,
    turning,
)
from mars2d.window.editor.item import Item, Motion
from mars2d.window.editor.picking import item_at, items_within
from mars2d.window.editor.tool import Tool


class Select(Tool):
    """Selects, moves, turns and resizes items."""

    hint = "Click or drag to select; drag moves, the ring turns"
    _band: tuple[Point, Point] | None = None
    _kept: tuple[Item, ...] = ()
    _clicked: Item | None = None

    def take(self, handle: Handle, point: Point) -> None:
        """Begin to drag a handle."""
        desk, item, ring = self.desk, self.desk.only, ring_of(self.desk)
        if handle.kind == "turn" and ring is not None:
            self.begin(turning(desk, ring), point)
        elif item is not None and handle.kind == "size":
            self.begin(sizing(desk, item, handle.number), point)
        elif item is not None:
            drag = cornering(desk, item, handle.number, new=handle.kind == "dot")
            self.begin(drag, point)
            if handle.kind == "dot":
                self.moved = True  # a mere click on a dot adds the corner, too
                desk.hold(drag.to, handle.point, shift=False)
            desk.corner = drag.corner

    def put(self, x: float, y: float, heading: float | None) -> None:
        """Put the selection at a point: its corner, a body's pose, or an outline's first corner."""
        desk, draft = self.desk, self.desk.draft
        if not desk.selection:
            raise InputError("nothing is selected")
        held = desk.selection[0]
        corners, pose, place = draft.corners(held), draft.pose(held), draft.place(held)
        if heading is not None and (pose is None or desk.only is None):
            raise InputError("only one robot or prop alone has a heading: expected x y")
        if corners is not None and desk.corner is not None:
            desk.put(draft.with_corner(held, desk.corner, (x, y)))
            return
        angle = 0.0 if heading is None or pose is None else heading - pose[2]
        by = x - place[0], y - place[1]
        desk.put(draft.moved(desk.selection, Motion(angle, place, by)))

    def press(self, point: Point, *, shift: bool) -> None:
        """Begin to drag a handle, an item, or a rectangle round items."""
        desk = self.desk
        handle = handle_at(desk, point)
        if handle is not None:
            self.take(handle, point)
            return
        item = item_at(desk, point)
        self._clicked = None
        if item is None:
            self._kept = desk.selection if shift else ()
            desk.select(self._kept)
            self._band = point, point
            return
        if shift:
            others = tuple(other for other in desk.selection if other != item)
            desk.select(others if item in desk.selection else (*others, item))
        elif item not in desk.selection:
            desk.select([item])
        else:
            self._clicked = item
            desk.corner = None
        if item in desk.selection:
            self.begin(moving(desk, item, point), point)

    def move(self, point: Point, *, shift: bool) -> None:
        """Drag the handle or item, or select the items within the rectangle."""
        super().move(point, shift=shift)
        if self._band is not None:
            self._band = self._band[0], point
            self.desk.select([*self._kept, *items_within(self.desk, *self._band)])

    def release(self, point: Point, *, shift: bool) -> None:
        """End the drag; a click on one of several selected items selects it alone."""
        alone = self._clicked if not self.moved and not shift else None
        super().release(point, shift=shift)
        if alone is not None and len(self.desk.selection) > 1:
            self.desk.select([alone])
        self._band = self._clicked = None

    def cancel(self) -> bool:
        """Cancel the drag."""
        band, self._band = self._band, None
        return super().cancel() or band is not None

    def draw(self, scene: Scene) -> None:
        """Draw the handles and the rectangle."""
        draw_handles(self.desk, scene)
        if self._band is not None:
            area = rectangle(*bounds_of(self._band))
            scene.polygon(area, fill=faded(MARK, 0.08), stroke=MARK, width=1.0)
