"""The mouse on the bodies of the picture: the one under it, and the one that it grabs."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from math import dist

import pygame

from mars2d.core.errors import InputError, LawError
from mars2d.core.plane import Point
from mars2d.core.scene import Scene, Shape, faded
from mars2d.output.raster.theme import LIGHT
from mars2d.record.frame import Frame
from mars2d.window.run.drags import (
    GOOD,
    Act,
    Drag,
    Placement,
    Pull,
    draw_label,
    draw_ring,
    local_point,
    with_pose,
)
from mars2d.window.run.mouse import Handle, Mouse, Pixel
from mars2d.window.run.push import Aim
from mars2d.window.screen.picking import body_at
from mars2d.window.screen.player import Player
from mars2d.window.screen.viewpoint import Viewpoint
from mars2d.world.operator import fixed, forceless

CLICK = 5.0
"""A press that moves by less than this is a click, points."""
LONG = 0.3
"""A press that lasts longer than this, while time passes, grabs the body, seconds."""


class Grab(Mouse):
    """The mouse on a picture with bodies.

    handles, place: as for `Mouse`. change: does something to the world and returns whether that was
    possible; an InputError that it raises is shown. say: shows a text to the person. clicks: called
    with the point [m] that was clicked, by the button. click: how far a click may move, pixels.
    over: the body under the pointer, of `Scenario.bodies`.
    """

    def __init__(
        self,
        player: Player,
        viewpoint: Viewpoint,
        handles: Sequence[Handle],
        place: Callable[[Pixel], Pixel | None],
        change: Callable[[Act], bool],
        say: Callable[[str], None],
        clicks: Mapping[int, Callable[[Point], None]],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(viewpoint, handles, place)
        self._player, self._change, self._say = player, change, say
        self._clicks, self._clock = clicks, clock
        self.click = CLICK
        self.over: int | None = None
        self._gripped: tuple[int, str, float] | None = None  # body, "carry", "push", "turn"; since
        self._grip: Point = (0.0, 0.0)  # where the body was pressed, in its own frame
        self._drag: Drag | None = None
        self._running = False  # when the drag began
        self._pixel: Pixel | None = None  # where the pointer is in the picture

    @property
    def busy(self) -> bool:
        """Whether a button is held on a body."""
        return self._gripped is not None or self._drag is not None

    # -- events ---------------------------------------------------------------------------------

    def handle(self, event: pygame.Event) -> None:
        """Handle an event of pygame, if it is one of the mouse."""
        super().handle(event)
        if event.type == pygame.WINDOWLEAVE:
            self.leave()

    def grips(self, pixel: Pixel, button: int) -> bool:
        """Grip the body at a pixel; return whether there is one that can be dragged so."""
        self._hover(pixel)
        if self.busy:
            return True
        left = "push" if pygame.key.get_mods() & pygame.KMOD_SHIFT else "carry"
        kind = {pygame.BUTTON_LEFT: left, pygame.BUTTON_RIGHT: "turn"}.get(button)
        if self.over is None or kind is None or (kind == "turn" and self._player.playing):
            return False
        self._gripped = self.over, kind, self._clock()
        self._grip = local_point(self._player.frame, self.over, self._point(pixel))
        return True

    def move(self, pixel: Pixel, by: Pixel) -> None:
        """Move to a pixel; a pressed body is dragged from a few pixels on."""
        super().move(pixel, by)
        if self.dragged is None and not self.pans and (self.busy or self.place(pixel) is not None):
            self._hover(pixel)
        else:
            self.leave()

    def release(self, pixel: Pixel, button: int) -> None:
        """End a drag; a press without a drag is a click."""
        drag, self._drag, self._gripped = self._drag, None, None
        if drag is not None:
            drag.move(self._player.frame, self._point(pixel))
            drag.end()
        clicked = self.pressed is not None and dist(self.pressed, pixel) < self.click
        free = self.dragged is None and drag is None and self.place(pixel) is not None
        super().release(pixel, button)
        if free:
            self._hover(pixel)
        if clicked and free and button in self._clicks:
            self._clicks[button](self._point(pixel))

    def leave(self) -> None:
        """Move the pointer out of the picture; a drag goes on."""
        if not self.busy:
            self._pixel = self.over = None

    def tick(self) -> None:
        """Go on with a drag, once a picture: bodies may have moved under the pointer."""
        running = self._player.playing
        if self._drag is not None and self._running != running:
            self.cancel()
        if self._gripped is not None and running and self._clock() - self._gripped[-1] > LONG:
            self._begin()
        if self._pixel is not None:
            self._hover(self._pixel)

    def cancel(self) -> None:
        """End the drag of a body; one that was moved or turned is back where it was."""
        drag, self._drag, self._gripped = self._drag, None, None
        if drag is not None and drag.keeps:
            drag.end()

    def let_go(self) -> None:
        """End any drag."""
        self.cancel()
        super().release((0, 0), 0)

    def _hover(self, pixel: Pixel) -> None:
        """Drag to a pixel of the picture, or find what is there."""
        self._pixel = pixel
        moved = self.pressed is not None and dist(pixel, self.pressed) >= self.click
        if self._gripped is not None and moved:
            self._begin()
        frame, point = self._player.frame, self._point(pixel)
        if self._drag is not None:
            self._drag.move(frame, point)
        else:
            self.over = body_at(frame, point, self.click / self.viewpoint.camera.scale)

    def _begin(self) -> None:
        """Begin the drag that the held button asks for, if it is possible."""
        assert self._gripped is not None
        assert self.pressed is not None
        (body, kind, _), self._gripped = self._gripped, None
        frame, running = self._player.frame, self._player.playing
        scenario, start, self._running = frame.scenario, self._point(self.pressed), running
        if running or kind == "push":
            fault = forceless(scenario, body)
            if running:
                fault = fault.replace("put it elsewhere", "pause, and put it elsewhere")
        else:
            fault = fixed(scenario, body)
        if fault:
            self._say(fault)
        elif kind == "push":
            self._drag = Aim(self._do, scenario, body, self._grip)
        elif running:
            self._drag = Pull(self._do, scenario, body, self._grip, start)
        else:
            self._drag = Placement(self._do, frame, body, start, turns=kind == "turn")

    def _do(self, act: Act) -> bool:
        """Do something to the world; show an InputError, and end a pull that is refused."""
        try:
            done = self._change(act)
        except LawError:
            raise
        except InputError as error:
            self._say(str(error))
            done = False
        if not done and self._drag is not None and self._drag.keeps:
            self._drag = None
        return done

    def _point(self, pixel: Pixel) -> Point:
        ((x, y),) = self.viewpoint.camera.to_world([pixel]).tolist()
        return x, y

    # -- drawing --------------------------------------------------------------------------------

    def shown(self, frame: Frame) -> Frame:
        """Return a frame with the dragged body at the pointer."""
        if isinstance(self._drag, Placement):
            return with_pose(frame, self._drag.body, self._drag.now)
        return frame

    def marks(self, frame: Frame, *, named: bool = False, more: str = "") -> list[Shape]:
        """Return shapes that show the drag, or the body under the pointer.

        named: whether all bodies are drawn with their names. more: said of the body under it.
        """
        scene, camera = Scene(), self.viewpoint.camera
        if self._drag is not None:
            self._drag.draw(scene, frame, camera)
        elif self.over is not None:
            draw_ring(scene, frame, self.over, faded(GOOD, 0.8), 1.5)
            if more or not named:
                name = f"{frame.scenario.bodies[self.over].name}  {more}".strip()
                draw_label(scene, frame, camera, self.over, name, LIGHT.ink)
        return scene.shapes
