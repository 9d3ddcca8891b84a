"""The mouse on the picture: it pulls bodies while time passes, and puts and turns them else."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from math import atan2, cos, degrees, dist, hypot, pi, radians, sin
from typing import Literal, Protocol

import numpy as np
import pygame
from numpy.typing import NDArray

from mars2d.bodies.rigid import Rigid, Triple
from mars2d.core.errors import InputError, LawError
from mars2d.core.materials import GRAVITY
from mars2d.core.plane import Point
from mars2d.core.scene import Anchor, Scene, Shape, faded
from mars2d.output.layers.bodies import draw_prop, draw_robot
from mars2d.output.layers.forces import FORCE, bounding_circle, in_newtons
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.theme import LIGHT
from mars2d.record.frame import Frame
from mars2d.scenario.placement import obstruction
from mars2d.scenario.scenario import Scenario
from mars2d.window.hover import Finder, Hover
from mars2d.world.operator import fixed, forceless
from mars2d.world.world import World

__all__ = ["CLICK", "Hand", "pull_of"]

Float = NDArray[np.float64]
Pixel = tuple[int, int]

CLICK = 5.0
"""A press that moves by less, in points, is a click."""
LONG = 0.3
"""A press that lasts longer, in seconds, is no click: it holds what moves."""
NOTCH = radians(15)
"""With Ctrl, angles are multiples of this."""
PATIENCE = 0.05
"""How often it is looked whether a place is free, seconds, at most."""

EASE = 10.0
"""How strongly a hand accelerates what it pulls, m/s^2, besides what holds that back."""
FASTEST = 5.0
"""How fast it draws at most, m/s."""

GOOD, BAD = LIGHT.selected, LIGHT.error.ink
HALO = "#ffffff"
LABEL = 13.0


def pull_of(scenario: Scenario, body: int) -> tuple[float, float]:
    """Return how strongly [N] and how fast [m/s] the mouse pulls a body at most.

    It wins against what holds the body back, a drive or the floor, and crosses the workspace in a
    few seconds.
    """
    xmin, xmax, ymin, ymax = scenario.bounds
    speed = 0.2 * max(xmax - xmin, ymax - ymin)
    mass, n = scenario.bodies[body].inertia.mass, len(scenario.robots)
    if body < n:
        drive = scenario.robots[body].drive
        held, speed = drive.max_force, max(speed, 1.5 * drive.max_linear_speed)
    else:
        held = scenario.props[body - n].ground_friction * mass * GRAVITY
    return 1.5 * held + EASE * mass, min(speed, FASTEST)


class Deed(Protocol):
    """What is done by a drag of the mouse."""

    body: int

    def move(self, frame: Frame, point: Point, mods: int) -> None:
        """Take where the pointer is now [m]."""

    def end(self) -> None:
        """Let go."""

    def pose(self, frame: Frame) -> Triple | None:
        """Return where the body is shown instead of where it is."""

    def draw(self, scene: Scene, frame: Frame, camera: Camera) -> None:
        """Draw what goes on."""


class Hand:
    """The mouse on the picture.

    change: is given what is to be done to the world, does it, and returns whether that was
    possible; an InputError of what is done is said, too. say: shows words to the person.
    """

    def __init__(
        self,
        change: Callable[[Callable[[World], None]], bool],
        say: Callable[[str], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._change, self._say, self._clock = change, say, clock
        self.click = CLICK  # pixels
        self._finder = Finder()
        self._hover: Hover | None = None
        self._pressed: tuple[Pixel, int, int, float] | None = None  # pixel, body, button, since
        self._deed: Deed | None = None
        self._running = False  # when the deed began
        self._grip: Point = (0.0, 0.0)  # where it was pressed, in the frame of the body
        self._pixel: Pixel = (0, 0)
        self._inside = False  # the picture
        self._cursor = pygame.SYSTEM_CURSOR_ARROW

    # -- events ---------------------------------------------------------------------------------

    @property
    def over(self) -> int | None:
        """The body under the pointer, by its index in `Scenario.bodies`."""
        return None if self._hover is None else self._hover.body

    @property
    def busy(self) -> bool:
        """Whether a button is held on a body."""
        return self._pressed is not None or self._deed is not None

    def move(self, frame: Frame, camera: Camera, pixel: Pixel, running: bool) -> None:
        """Take where the pointer is."""
        self._pixel, self._inside = pixel, True
        if self._pressed is not None and dist(pixel, self._pressed[0]) >= self.click:
            self._begin(frame, camera, running)
        if self._deed is not None:
            self._deed.move(frame, _world(camera, pixel), _mods())
        else:
            self._hover = self._finder.find(frame, _world(camera, pixel), self.click / camera.scale)
        self._show_cursor()

    def leave(self) -> None:
        """Take that the pointer has left the picture; what it pulls or carries, it keeps."""
        self._inside = False
        if not self.busy:
            self._hover = None
        self._show_cursor()

    def press(
        self, frame: Frame, camera: Camera, pixel: Pixel, button: int, mods: int, running: bool
    ) -> bool:
        """Take a button that goes down; return whether it is one on a body."""
        self.move(frame, camera, pixel, running)
        if self.busy:
            return True
        turns = button == pygame.BUTTON_RIGHT or bool(mods & pygame.KMOD_SHIFT)
        mine = button in (pygame.BUTTON_LEFT, pygame.BUTTON_RIGHT) and not (turns and running)
        if self.over is None or not mine:
            return False
        kind = pygame.BUTTON_RIGHT if turns else pygame.BUTTON_LEFT
        self._pressed = pixel, self.over, kind, self._clock()
        self._grip = _local(_pose(frame, self.over), _world(camera, pixel))
        return True

    def release(self, frame: Frame, camera: Camera, pixel: Pixel, running: bool) -> bool:
        """Take a button that goes up; return whether more was done than a click."""
        self._pixel = pixel
        clicked = self._pressed is not None
        self._pressed = None
        if self._deed is not None:
            deed, self._deed = self._deed, None
            deed.move(frame, _world(camera, pixel), _mods())
            deed.end()
        self.move(frame, camera, pixel, running)
        return not clicked

    def tick(self, frame: Frame, camera: Camera, running: bool) -> None:
        """Go on with what is held, once a picture: what lies under the pointer may have moved."""
        if self._deed is not None and self._running != running:
            self.cancel()
        if self._pressed is not None and running and self._clock() - self._pressed[3] > LONG:
            self._begin(frame, camera, running)
        if self._deed is not None:
            self._deed.move(frame, _world(camera, self._pixel), _mods())
        elif self._inside:
            self.move(frame, camera, self._pixel, running)

    def cancel(self) -> None:
        """Let go: what was carried is back where it was."""
        deed, self._deed, self._pressed = self._deed, None, None
        if isinstance(deed, _Pull):
            deed.end()
        self._show_cursor()

    def _begin(self, frame: Frame, camera: Camera, running: bool) -> None:
        """Begin what the button that is held asks for, if that is possible."""
        assert self._pressed is not None
        (pixel, body, button, _), self._pressed = self._pressed, None
        self._running = running
        scenario, start = frame.scenario, _world(camera, pixel)
        if running:
            fault = forceless(scenario, body)
            fault = fault and fault.replace("put it elsewhere", "pause, and put it elsewhere")
        else:
            fault = fixed(scenario, body)
        if fault:
            self._say(fault)
        elif running:
            grip = _within(scenario.bodies[body], self._grip)
            self._deed = _Pull(self._do, scenario, body, grip, start)
        elif button == pygame.BUTTON_LEFT:
            self._deed = _Carry(self._do, self._clock, frame, body, start)
        else:
            self._deed = _Turn(self._do, self._clock, frame, body, start)

    def _do(self, act: Callable[[World], None]) -> bool:
        """Do something to the world; what is refused is said."""
        try:
            done = self._change(act)
        except LawError:
            raise
        except InputError as error:
            self._say(str(error))
            done = False
        if not done and isinstance(self._deed, _Pull):
            self._deed = None
        return done

    # -- what is seen ---------------------------------------------------------------------------

    def shown(self, frame: Frame) -> Frame:
        """Return a frame with what is carried where the pointer has it."""
        pose = None if self._deed is None else self._deed.pose(frame)
        return frame if self._deed is None or pose is None else _with(frame, self._deed.body, pose)

    def marks(self, frame: Frame, camera: Camera, *, named: bool = False) -> list[Shape]:
        """Return the shapes that show what the pointer is over, and what it does.

        named: the names of all bodies are seen already.
        """
        scene = Scene()
        if self._deed is not None:
            self._deed.draw(scene, frame, camera)
        elif self._hover is not None:
            _draw_hover(scene, frame, camera, self._hover, self._pixel, named=named)
        return scene.shapes

    def _show_cursor(self) -> None:
        """Give the pointer the shape of what it can do."""
        cursor = pygame.SYSTEM_CURSOR_ARROW
        if self._deed is not None:
            cursor = pygame.SYSTEM_CURSOR_SIZEALL
        elif self.over is not None:
            cursor = pygame.SYSTEM_CURSOR_HAND
        if cursor != self._cursor and pygame.display.get_init():
            self._cursor = cursor
            with suppress(pygame.error):  # not every screen has them all
                pygame.mouse.set_cursor(cursor)


class _Pull:
    """The body is pulled by a spring from where it was gripped to the pointer."""

    def __init__(
        self,
        do: Callable[[Callable[[World], None]], bool],
        scenario: Scenario,
        body: int,
        grip: Point,
        target: Point,
    ) -> None:
        self.body, self._do = body, do
        self.grip, self.target = grip, target
        self.force, self.speed = pull_of(scenario, body)
        self.newtons = 0.0
        self._world: World | None = None  # where it is pulled

    def move(self, frame: Frame, point: Point, mods: int) -> None:  # noqa: ARG002
        """Pull there."""
        self.target = point

        def pull(world: World) -> None:
            self._world = world
            world.hands.pull(self.body, self.grip, point, self.force, self.speed)
            self.newtons = world.hands.force(self.body)

        self._do(pull)

    def end(self) -> None:
        """Let go where it is pulled, whatever row is looked at: that takes no branch."""
        if self._world is not None and not self._world.over:
            self._world.hands.pull(self.body, self.grip, None)

    def pose(self, frame: Frame) -> Triple | None:
        """Return None: it is where it is."""

    def draw(self, scene: Scene, frame: Frame, camera: Camera) -> None:
        """Draw the spring, and how strongly it pulls."""
        start = _at(_pose(frame, self.body), self.grip)
        _draw_ring(scene, frame, self.body, GOOD, 2.0)
        scene.line([start, self.target], stroke=HALO, width=5.0)
        scene.line([start, self.target], stroke=FORCE, width=2.5)
        for point in (start, self.target):
            scene.circle(point, 0.0, fill=FORCE, stroke=HALO, width=1.5, pixels=3.5)
        if self.newtons > 0.005:
            place = self.target[0], self.target[1] + 9 / camera.scale
            text = in_newtons(self.newtons)
            scene.text(place, text, color=FORCE, size=LABEL, anchor="above", halo=HALO)


class _Move:
    """The base of what is done while time stands still: the body is shown elsewhere first."""

    def __init__(
        self,
        do: Callable[[Callable[[World], None]], bool],
        clock: Callable[[], float],
        frame: Frame,
        body: int,
        point: Point,
    ) -> None:
        self.body, self._do, self._clock = body, do, clock
        self.before = self.now = _pose(frame, body)
        self.start = point
        self._fault, self._looked, self._at = "", -1.0, self.before

    def pose(self, frame: Frame) -> Triple | None:  # noqa: ARG002
        """Return where it is shown."""
        return self.now

    def end(self) -> None:
        """Put it there."""
        if self.now != self.before:
            self._do(lambda world: world.hands.place(self.body, self.now))

    def fault(self, frame: Frame) -> str:
        """Return why it can't stay there, in words, or ""."""
        now = self._clock()
        if self._at != self.now and now - self._looked >= PATIENCE:
            self._looked, self._at = now, self.now
            there = _with(frame, self.body, self.now)
            poses = np.hstack([there.pose, there.prop_pose])
            self._fault = obstruction(frame.scenario, poses, self.body)
        return self._fault

    def draw(self, scene: Scene, frame: Frame, camera: Camera) -> None:
        """Draw where it was, where it is to be, and what is wrong there."""
        fault = self.fault(frame)
        color = BAD if fault else GOOD
        there = _with(frame, self.body, self.now)
        _draw_ring(scene, there, self.body, color, 2.5)
        words = f"would {fault}" if fault else self.words()
        _draw_label(scene, there, camera, self.body, words, color, "below")  # names are above
        self.draw_more(scene, frame.scenario, color)

    def words(self) -> str:
        """Return what is said of where it is."""
        return _signed(f"({self.now[0]:.2f}, {self.now[1]:.2f}) m")

    def draw_more(self, scene: Scene, scenario: Scenario, color: str) -> None:
        """Draw what leads from where it was to where it is."""


class _Carry(_Move):
    """The body is put elsewhere."""

    def move(self, frame: Frame, point: Point, mods: int) -> None:  # noqa: ARG002
        """Carry it there, by the point where it was taken."""
        dx, dy = point[0] - self.start[0], point[1] - self.start[1]
        self.now = self.before[0] + dx, self.before[1] + dy, self.before[2]

    def draw_more(self, scene: Scene, scenario: Scenario, color: str) -> None:
        """Draw it hollow where it was, and the way."""
        ghost, n = np.array(self.before), len(scenario.robots)
        if self.body < n:
            draw_robot(scene, scenario.robots[self.body], ghost, None, faded(color, 0.6))
        else:
            draw_prop(scene, scenario.props[self.body - n], ghost, color, hollow=True)
        scene.line([self.before[:2], self.now[:2]], stroke=faded(color, 0.5), width=1.2)


class _Turn(_Move):
    """The body is turned towards the pointer."""

    pointer: Point | None = None

    def move(self, frame: Frame, point: Point, mods: int) -> None:  # noqa: ARG002
        """Turn it there, by the shorter way."""
        x, y, theta = self.before
        self.pointer = point
        angle = atan2(point[1] - y, point[0] - x)
        if mods & pygame.KMOD_CTRL:
            angle = NOTCH * round(angle / NOTCH)
        self.now = x, y, theta + (angle - theta + pi) % (2 * pi) - pi

    def words(self) -> str:
        """Return the angle."""
        angle = round(degrees((self.now[2] + pi) % (2 * pi) - pi), 1)
        return _signed(f"{angle:g}\N{DEGREE SIGN}")

    def draw_more(self, scene: Scene, scenario: Scenario, color: str) -> None:  # noqa: ARG002
        """Draw where it looks."""
        if self.pointer is not None:
            x, y, theta = self.now
            way = hypot(self.pointer[0] - x, self.pointer[1] - y)
            end = x + way * cos(theta), y + way * sin(theta)
            scene.line([(x, y), end], stroke=faded(color, 0.7), width=1.5)
            scene.circle(end, 0.0, fill=color, stroke=HALO, width=1.5, pixels=3.5)


# -- where things are, and marks ------------------------------------------------------------------


def _signed(text: str) -> str:
    return text.replace("-", "\N{MINUS SIGN}")


def _mods() -> int:
    """Return the keys that are held for the mouse's sake; none where there is no window."""
    return pygame.key.get_mods() if pygame.display.get_init() else 0


def _world(camera: Camera, pixel: Pixel) -> Point:
    ((x, y),) = camera.to_world([pixel]).tolist()
    return x, y


def _pose(frame: Frame, body: int) -> Triple:
    x, y, theta = np.hstack([frame.pose, frame.prop_pose])[:, body].tolist()
    return x, y, theta


def _with(frame: Frame, body: int, pose: Triple) -> Frame:
    """Return a frame with one body at another pose."""
    robots, props, n = frame.pose.copy(), frame.prop_pose.copy(), frame.pose.shape[1]
    if body < n:
        robots[:, body] = pose
    else:
        props[:, body - n] = pose
    sensed = frame.pose if frame.sensed is None else frame.sensed
    return replace(frame, pose=robots, prop_pose=props, sensed=sensed)


def _local(pose: Triple, point: Point) -> Point:
    """Return a point in a body's own frame."""
    dx, dy, c, s = point[0] - pose[0], point[1] - pose[1], cos(pose[2]), sin(pose[2])
    return c * dx + s * dy, c * dy - s * dx


def _within(rigid: Rigid, point: Point) -> Point:
    """Return a point in a body's frame, brought into the circle round it where it lies beside."""
    (x, y), radius = rigid.shape.bound
    dx, dy = point[0] - x, point[1] - y
    share = min(1.0, radius / max(hypot(dx, dy), 1e-300))
    return x + share * dx, y + share * dy


def _at(pose: Triple, local: Point) -> Point:
    """Return where a point of a body lies."""
    c, s = cos(pose[2]), sin(pose[2])
    return pose[0] + c * local[0] - s * local[1], pose[1] + s * local[0] + c * local[1]


def _draw_ring(scene: Scene, frame: Frame, body: int, color: str, width: float) -> None:
    """Draw a ring round a body."""
    center, radius = bounding_circle(
        frame.scenario.bodies[body].shape, np.array(_pose(frame, body))
    )
    for stroke, more in ((HALO, 2.0), (color, 0.0)):
        scene.circle(center, radius, stroke=stroke, width=width + more, pixels=6.0)


def _draw_label(
    scene: Scene,
    frame: Frame,
    camera: Camera,
    body: int,
    text: str,
    color: str,
    side: Literal["above", "below"] = "above",
) -> None:
    """Write something above or below the ring round a body."""
    shape, pose = frame.scenario.bodies[body].shape, np.array(_pose(frame, body))
    (x, y), radius = bounding_circle(shape, pose)
    off = radius + 12 / camera.scale
    place = x, y + off if side == "above" else y - off
    scene.text(place, text, color=color, size=LABEL, anchor=side, halo=HALO)


def _draw_hover(
    scene: Scene, frame: Frame, camera: Camera, hover: Hover, pixel: Pixel, *, named: bool
) -> None:
    """Draw the name of what the pointer is over, and a ring round it if it is a body."""
    if hover.body is not None:
        _draw_ring(scene, frame, hover.body, faded(GOOD, 0.8), 1.5)
        if not named:
            _draw_label(scene, frame, camera, hover.body, hover.name, LIGHT.ink)
        return
    xmin, xmax, _, _ = frame.scenario.bounds
    left = _world(camera, pixel)[0] < (xmin + xmax) / 2  # the label lies towards the middle
    beside = _world(camera, (pixel[0] + (12 if left else -12), pixel[1]))
    side: Anchor = "left" if left else "right"
    scene.text(beside, hover.name, color=LIGHT.ink, size=LABEL, anchor=side, halo=HALO)
