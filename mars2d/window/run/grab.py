"""The mouse on the bodies of the picture: it pulls, pushes, moves or turns the one under it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import atan2, cos, dist, hypot, pi, sin

import numpy as np
import pygame

from mars2d.core.plane import Point
from mars2d.core.scene import Scene, Shape, faded
from mars2d.output.layers.bodies import draw_prop, draw_robot
from mars2d.output.layers.forces import FORCE, in_newtons
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.theme import LIGHT
from mars2d.record.frame import Frame
from mars2d.record.interventions import Push
from mars2d.scenario.changes import obstruction
from mars2d.window.panels.readout import in_both_units
from mars2d.window.run.marks import (
    BAD,
    GOOD,
    HALO,
    draw_dot,
    draw_label,
    draw_ring,
    draw_words,
    local_point,
    within,
    world_point,
)
from mars2d.window.run.mouse import Drag, Handle, Mouse, Pixel
from mars2d.window.run.push import SECONDS, draw_pushes, pull_of, stiffness_of
from mars2d.window.screen.picking import body_at
from mars2d.window.screen.player import Player
from mars2d.window.screen.viewpoint import Viewpoint
from mars2d.world.operator import fixed
from mars2d.world.world import World

CLICK = 5.0
"""A press that moves by less than this is a click, points."""


class Grab(Mouse):
    """The mouse on a picture with bodies.

    handles, place: as for `Mouse`. change: does something to the world, and returns whether that
    was possible, or says why not. clicks: called with the point [m] that was clicked, by the
    button. click: how far a click may move, pixels. over: the body under the pointer, of
    `Scenario.bodies`.
    """

    def __init__(
        self,
        player: Player,
        viewpoint: Viewpoint,
        handles: Sequence[Handle],
        place: Callable[[Pixel], Pixel | None],
        change: Callable[[Callable[[World], None]], bool],
        clicks: Mapping[int, Callable[[Point], None]],
    ) -> None:
        super().__init__(viewpoint, handles, place)
        self.player, self.change, self._clicks = player, change, clicks
        self.click = CLICK
        self.over: int | None = None

    @property
    def busy(self) -> bool:
        """Whether a button is held on a body."""
        return isinstance(self.drag, Hold)

    # -- events ---------------------------------------------------------------------------------

    def grip(self, pixel: Pixel, button: int) -> Drag:
        """Return the drag of the body at a pixel, or of the picture."""
        self.move(pixel)
        kind: type[Hold] | None = None
        if button == pygame.BUTTON_LEFT:
            pushes = pygame.key.get_mods() & pygame.KMOD_SHIFT
            kind = Aim if pushes else Pull if self.player.playing else Placement
        elif button == pygame.BUTTON_RIGHT and not self.player.playing:
            kind = Turn
        if self.over is None or kind is None:
            return super().grip(pixel, button)
        return kind(self, self.over, pixel)

    def move(self, pixel: Pixel) -> None:
        """Move to a pixel; without a drag, find the body there."""
        super().move(pixel)
        if not self.busy:
            free = self.drag is None and self.place(pixel) is not None
            point, slack = self.viewpoint.point_at(pixel), self.click / self.viewpoint.camera.scale
            self.over = body_at(self.player.frame, point, slack) if free else None

    def release(self, pixel: Pixel, button: int) -> None:
        """End a drag; a press without a drag is a click."""
        drag = self.drag
        super().release(pixel, button)
        self.move(pixel)
        near = dist(self.pressed, pixel) < self.click and self.place(pixel) is not None
        if drag is not None and not drag.begun and near and button in self._clicks:
            self._clicks[button](self.viewpoint.point_at(pixel))

    def tick(self, pointer: Pixel | None) -> None:
        """Go on with a drag, once a picture: bodies may have moved under the pointer."""
        if isinstance(self.drag, Hold) and self.drag.running != self.player.playing:
            self.let_go()
        if pointer is not None:
            self.move(pointer)
        elif not self.busy:
            self.over = None

    def let_go(self) -> None:
        """End the drag of a body; one that was moved or turned is back where it was."""
        if self.busy:
            self.cancel()

    # -- drawing --------------------------------------------------------------------------------

    def shown(self, frame: Frame) -> Frame:
        """Return a frame with the dragged body at the pointer."""
        return self.drag.shown(frame) if isinstance(self.drag, Hold) else frame

    def marks(self, frame: Frame, *, named: bool = False, more: str = "") -> list[Shape]:
        """Return shapes that show the drag, or the body under the pointer.

        named: whether all bodies are drawn with their names. more: said of the body under it.
        """
        scene, camera = Scene(), self.viewpoint.camera
        if isinstance(self.drag, Hold) and self.drag.begun:
            self.drag.draw(scene, frame, camera)
        elif self.over is not None:
            draw_ring(scene, frame, self.over, faded(GOOD, 0.8), 1.5)
            if more or not named:
                name = f"{frame.scenario.bodies[self.over].name}  {more}".strip()
                draw_label(scene, frame, camera, self.over, name, LIGHT.ink)
        return scene.shapes


class Hold(Drag):
    """A drag of a body of the picture.

    grip: where the body was pressed, in its own frame. running: whether time passes.
    """

    def __init__(self, grab: Grab, body: int, pixel: Pixel) -> None:
        frame, self.start = grab.player.frame, grab.viewpoint.point_at(pixel)
        self._grab, self.body, self.running = grab, body, grab.player.playing
        self.before = self.now = frame.body_pose(body)
        self.grip = within(frame.scenario.bodies[body], local_point(frame, body, self.start))
        self.begun = False

    def move(self, pixel: Pixel) -> None:
        """Move to a pixel; it begins a few pixels from the press."""
        self.begun = self.begun or dist(pixel, self._grab.pressed) >= self._grab.click
        if self.begun:
            self.go(self._grab.viewpoint.point_at(pixel))

    def end(self) -> None:
        """Do to the body what was shown."""
        if self.begun:
            self.act()

    def go(self, point: Point) -> None:
        """Move the pointer to a point [m]."""
        raise NotImplementedError

    def act(self) -> None:
        """Release the body."""
        raise NotImplementedError

    def shown(self, frame: Frame) -> Frame:
        """Return a frame with the body where it is dragged."""
        return frame

    def draw(self, scene: Scene, frame: Frame, camera: Camera) -> None:  # noqa: ARG002
        """Draw what is dragged."""
        draw_ring(scene, frame, self.body, GOOD, 2.0)


class Pull(Hold):
    """Pulls a body by a spring from the point where it was gripped to the pointer."""

    target: Point
    newtons = 0.0
    _world: World | None = None  # in which the body is pulled

    def go(self, point: Point) -> None:
        """Pull towards a point; where that is refused, end."""
        self.target = point
        force, speed = pull_of(self._grab.player.frame.scenario, self.body)

        def pull(world: World) -> None:
            self._world = world
            world.operator.pull(self.body, self.grip, point, force, speed)
            self.newtons = world.operator.force(self.body)

        if not self._grab.change(pull):
            self._grab.drag = None

    def act(self) -> None:
        """Release the body in the world in which it is pulled: that makes no branch."""
        if self._world is not None and not self._world.over:
            self._world.operator.pull(self.body, self.grip, None)

    cancel = Hold.end

    def draw(self, scene: Scene, frame: Frame, camera: Camera) -> None:
        """Draw the spring and its force."""
        super().draw(scene, frame, camera)
        start = world_point(frame.body_pose(self.body), self.grip)
        for color, width in ((HALO, 5.0), (FORCE, 2.5)):
            scene.line([start, self.target], stroke=color, width=width)
        for point in (start, self.target):
            draw_dot(scene, point, FORCE)
        if self.newtons > 0.005:
            draw_words(scene, camera, self.target, in_newtons(self.newtons))


class Aim(Hold):
    """Aims a push from the point where a body was gripped to the pointer; the end lets it act."""

    force: Point = (0.0, 0.0)

    def go(self, point: Point) -> None:
        """Aim at a point."""
        frame = self._grab.player.frame
        start = world_point(frame.body_pose(self.body), self.grip)
        newtons = float(f"{stiffness_of(frame.scenario, self.body) * dist(start, point):.2g}")
        angle = atan2(point[1] - start[1], point[0] - start[0])
        self.force = newtons * cos(angle), newtons * sin(angle)

    def act(self) -> None:
        """Push."""
        if any(self.force):
            push = self.body, self.force, SECONDS, self.grip
            self._grab.change(lambda world: world.operator.push(*push))

    def draw(self, scene: Scene, frame: Frame, camera: Camera) -> None:
        """Draw the force that it would be."""
        super().draw(scene, frame, camera)
        if any(self.force):
            draw_pushes(scene, frame, [Push(0, self.body, self.grip, self.force, SECONDS)], camera)


class Placement(Hold):
    """Moves a body while time stands still; at the end it gets its new pose, `now`."""

    def go(self, point: Point) -> None:
        """Move the body by as much as the pointer."""
        (x, y, theta), (u, v) = self.before, self.start
        self.now = x + point[0] - u, y + point[1] - v, theta

    def act(self) -> None:
        """Place the body, if its pose has changed."""
        if self.now != self.before:
            self._grab.change(lambda world: world.operator.place(self.body, self.now))

    def shown(self, frame: Frame) -> Frame:
        """Return a frame with the body at its new pose."""
        if not self.begun:
            return frame
        robots, props, n = frame.pose.copy(), frame.prop_pose.copy(), frame.pose.shape[1]
        if self.body < n:
            robots[:, self.body] = self.now
        else:
            props[:, self.body - n] = self.now
        sensed = frame.pose if frame.sensed is None else frame.sensed
        leaps = (*frame.leaps, (len(frame.path), self.body))
        return replace(frame, pose=robots, prop_pose=props, sensed=sensed, leaps=leaps)

    def draw(self, scene: Scene, frame: Frame, camera: Camera) -> None:
        """Draw the former place, and the new one with why the body can't stay there."""
        scenario, there = frame.scenario, self.shown(frame)
        held, fault = fixed(scenario, self.body), obstruction(scenario, there.all_poses, self.body)
        color = BAD if held or fault else GOOD
        draw_ring(scene, there, self.body, color, 2.5)
        words = held or (f"would {fault}" if fault else self.words())
        draw_label(scene, there, camera, self.body, words, color, "below")  # names are above
        self.draw_way(scene, frame, color)

    def draw_way(self, scene: Scene, frame: Frame, color: str) -> None:
        """Draw the former place, and the way from there."""
        scenario, n, ghost = frame.scenario, len(frame.scenario.robots), np.array(self.before)
        if self.body < n:
            draw_robot(scene, scenario.robots[self.body], ghost, None, faded(color, 0.6))
        else:
            draw_prop(scene, scenario.props[self.body - n], ghost, color, hollow=True)
        scene.line([self.before[:2], self.now[:2]], stroke=faded(color, 0.5), width=1.2)

    def words(self) -> str:
        """Return the new position."""
        return "({:.2f}, {:.2f}) m".format(*self.now).replace("-", "\N{MINUS SIGN}")


class Turn(Placement):
    """Turns a body towards the pointer, the shorter way round."""

    _reach = 0.0  # how far the pointer is away, metres

    def go(self, point: Point) -> None:
        """Turn the body to a point."""
        x, y, theta = self.before
        angle = atan2(point[1] - y, point[0] - x)
        self._reach = hypot(point[0] - x, point[1] - y)
        self.now = x, y, theta + (angle - theta + pi) % (2 * pi) - pi

    def draw_way(self, scene: Scene, frame: Frame, color: str) -> None:  # noqa: ARG002
        """Draw a line to the pointer."""
        end = world_point(self.now, (self._reach, 0.0))
        scene.line([self.now[:2], end], stroke=faded(color, 0.7), width=1.5)
        draw_dot(scene, end, color)

    def words(self) -> str:
        """Return the new heading."""
        return in_both_units((self.now[2] + pi) % (2 * pi) - pi)
