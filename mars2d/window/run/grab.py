"""The mouse on the bodies of the picture: the one under it, and the one that it grabs."""

from __future__ import annotations

import time
from collections.abc import Callable
from math import dist
from typing import Literal

import pygame

from mars2d.core.errors import InputError, LawError
from mars2d.core.plane import Point
from mars2d.core.scene import Scene, Shape, faded
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.theme import LIGHT
from mars2d.record.frame import Frame
from mars2d.window.run.drags import (
    GOOD,
    Act,
    Placement,
    Pull,
    draw_label,
    draw_ring,
    local_point,
    with_pose,
)
from mars2d.window.run.push import Aim
from mars2d.window.screen.picking import body_at
from mars2d.world.operator import fixed, forceless

Pixel = tuple[int, int]
Drag = Pull | Aim | Placement
"""A drag of the mouse that has begun on a body."""
Kind = Literal["carry", "push", "turn"]

CLICK = 5.0
"""A press that moves by less than this is a click, points."""
LONG = 0.3
"""A press that lasts longer than this, while time passes, grabs the body, seconds."""


class Grab:
    """The mouse on bodies.

    change: does something to the world and returns whether that was possible; an InputError that it
    raises is shown. say: shows a text to the person.
    """

    def __init__(
        self,
        change: Callable[[Act], bool],
        say: Callable[[str], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._change, self._say, self._clock = change, say, clock
        self.click = CLICK  # pixels
        self.over: int | None = None  # the body under the pointer, of `Scenario.bodies`
        self._pressed: tuple[Pixel, int, Kind, float] | None = None  # pixel, body, kind, since
        self._drag: Drag | None = None
        self._running = False  # when the drag began
        self._grip: Point = (0.0, 0.0)  # where the body was pressed, in its own frame
        self._pixel: Pixel = (0, 0)
        self._inside = False  # the picture

    # -- events ---------------------------------------------------------------------------------

    @property
    def busy(self) -> bool:
        """Whether a button is held on a body."""
        return self._pressed is not None or self._drag is not None

    def move(self, frame: Frame, camera: Camera, pixel: Pixel, running: bool) -> None:
        """Move the pointer to a pixel of the picture."""
        self._pixel, self._inside = pixel, True
        if self._pressed is not None and dist(pixel, self._pressed[0]) >= self.click:
            self._begin(frame, camera, running)
        point = _world(camera, pixel)
        if self._drag is not None:
            self._drag.move(frame, point)
        else:
            self.over = body_at(frame, point, self.click / camera.scale)

    def leave(self) -> None:
        """Move the pointer out of the picture; a drag goes on."""
        self._inside = False
        if not self.busy:
            self.over = None

    def press(
        self, frame: Frame, camera: Camera, pixel: Pixel, button: int, mods: int, running: bool
    ) -> bool:
        """Press a button; return whether a body is grabbed by it."""
        self.move(frame, camera, pixel, running)
        if self.busy:
            return True
        kinds: dict[int, Kind] = {
            pygame.BUTTON_LEFT: "push" if mods & pygame.KMOD_SHIFT else "carry",
            pygame.BUTTON_RIGHT: "turn",
        }
        kind = kinds.get(button)
        if self.over is None or kind is None or (kind == "turn" and running):
            return False
        self._pressed = pixel, self.over, kind, self._clock()
        self._grip = local_point(frame, self.over, _world(camera, pixel))
        return True

    def release(self, frame: Frame, camera: Camera, pixel: Pixel, running: bool) -> bool:
        """Release the button; return whether it was more than a click."""
        self._pixel = pixel
        clicked = self._pressed is not None
        self._pressed = None
        if self._drag is not None:
            drag, self._drag = self._drag, None
            drag.move(frame, _world(camera, pixel))
            drag.end()
        self.move(frame, camera, pixel, running)
        return not clicked

    def tick(self, frame: Frame, camera: Camera, running: bool) -> None:
        """Go on with a drag, once a picture: bodies may have moved under the pointer."""
        if self._drag is not None and self._running != running:
            self.cancel()
        if self._pressed is not None and running and self._clock() - self._pressed[3] > LONG:
            self._begin(frame, camera, running)
        if self._drag is not None:
            self._drag.move(frame, _world(camera, self._pixel))
        elif self._inside:
            self.move(frame, camera, self._pixel, running)

    def cancel(self) -> None:
        """End the drag; a body that was moved or turned is back where it was."""
        drag, self._drag, self._pressed = self._drag, None, None
        if drag is not None and drag.keeps:
            drag.end()

    def _begin(self, frame: Frame, camera: Camera, running: bool) -> None:
        """Begin the drag that the held button asks for, if it is possible."""
        assert self._pressed is not None
        (pixel, body, kind, _), self._pressed = self._pressed, None
        self._running = running
        scenario, start = frame.scenario, _world(camera, pixel)
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
            turns = kind == "turn"
            self._drag = Placement(self._do, self._clock, frame, body, start, turns=turns)

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

    # -- drawing --------------------------------------------------------------------------------

    def shown(self, frame: Frame) -> Frame:
        """Return a frame with the dragged body at the pointer."""
        pose = None if self._drag is None else self._drag.pose(frame)
        if self._drag is None or pose is None:
            return frame
        return with_pose(frame, self._drag.body, pose)

    def marks(
        self, frame: Frame, camera: Camera, *, named: bool = False, more: str = ""
    ) -> list[Shape]:
        """Return shapes that show the drag, or the body under the pointer.

        named: whether all bodies are drawn with their names. more: said of the body under it.
        """
        scene = Scene()
        if self._drag is not None:
            self._drag.draw(scene, frame, camera)
        elif self.over is not None:
            draw_ring(scene, frame, self.over, faded(GOOD, 0.8), 1.5)
            if more or not named:
                name = f"{frame.scenario.bodies[self.over].name}  {more}".strip()
                draw_label(scene, frame, camera, self.over, name, LIGHT.ink)
        return scene.shapes


def _world(camera: Camera, pixel: Pixel) -> Point:
    ((x, y),) = camera.to_world([pixel]).tolist()
    return x, y
