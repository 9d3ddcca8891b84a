"""The keys and the game controller that drive one robot by hand."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import pygame

from mars2d.bodies.drives.base import Drive
from mars2d.world.teleop import Stick, ramped


class Keys(NamedTuple):
    """Keys that drive a robot: the stick that each stands for, by its place, and their labels.

    labels: of those for ahead, left, back and right.
    """

    ways: Mapping[int, Stick]
    labels: tuple[str, ...]


ARROWS = Keys(
    {
        pygame.KSCAN_UP: Stick(0, 1), pygame.KSCAN_DOWN: Stick(0, -1),
        pygame.KSCAN_LEFT: Stick(-1, 0), pygame.KSCAN_RIGHT: Stick(1, 0),
        pygame.KSCAN_COMMA: Stick(turn=-1), pygame.KSCAN_PERIOD: Stick(turn=1),
    },
    ("↑", "←", "↓", "→"),
)  # fmt: skip
LETTERS = Keys(
    {
        pygame.KSCAN_W: Stick(0, 1), pygame.KSCAN_S: Stick(0, -1),
        pygame.KSCAN_A: Stick(-1, 0), pygame.KSCAN_D: Stick(1, 0),
        pygame.KSCAN_Q: Stick(turn=-1), pygame.KSCAN_E: Stick(turn=1),
    },
    ("W", "A", "S", "D"),
)  # fmt: skip
"""By their place, W, A, S and D are a cross on every keyboard."""
BOTH = Keys({**ARROWS.ways, **LETTERS.ways}, ARROWS.labels)
"""For one who sits alone at the keyboard."""

SLOW = 0.5
"""The deflection of the stick with Shift."""
DEAD_ZONE = 0.15
"""The deflection of a controller's stick that counts as rest."""
ACROSS, AHEAD = 0, 1
"""The axes of a controller's left stick; the second points backwards."""


class Driver:
    """Drives one robot by keys, or by a controller, which may be plugged in and out at any time.

    keys: those of one person. place, of: which of several people that is; controllers are dealt out
    to them in turn, in the order in which they are plugged in. One that is plugged in later takes
    the place of one that was plugged out; each other one keeps its person.
    """

    def __init__(self, keys: Keys = BOTH, place: int = 0, of: int = 1) -> None:
        """Start without a robot."""
        self.keys = keys
        self._place, self._of = place, of
        self.robot: int | None = None
        self._name = ""
        self._held: set[int] = set()
        self._slow = self._turns = False
        self._stick = Stick()
        self._controllers: dict[int, pygame.joystick.JoystickType] = {}
        self._dealt: list[int | None] = []  # the controllers in turn; None: one was plugged out

    # -- who ------------------------------------------------------------------------------------

    def take(self, robot: int, name: str = "", *, turns: bool = False) -> None:
        """Start to drive a robot; name: for `status`.

        turns: whether it also turns by keys of their own, and by a controller's cross.
        """
        self.robot, self._name, self._turns = robot, name or f"robot {robot}", turns
        self._rest()
        if not pygame.joystick.get_init():
            pygame.joystick.init()  # which posts an event for each controller
            return
        for number in range(pygame.joystick.get_count()):
            self._add(number)

    def release(self) -> None:
        """Stop driving."""
        self.robot = None
        self._rest()

    def _rest(self) -> None:
        self._held.clear()
        self._slow = False
        self._stick = Stick()

    @property
    def status(self) -> str:
        """The driven robot and its controller, in words; "" without a robot."""
        if self.robot is None:
            return ""
        by = " by controller" if self._by_controller else ""
        return f"driving {self._name}{by}"

    # -- how ------------------------------------------------------------------------------------

    def handle(self, event: pygame.Event) -> bool:
        """Handle an event; return whether it is for the driver alone."""
        if event.type in (pygame.JOYDEVICEADDED, pygame.JOYDEVICEREMOVED):
            self._plug(event)
            return True
        if self.robot is None:
            return False
        if event.type in (pygame.KEYDOWN, pygame.KEYUP):
            return self._key(event)
        if event.type == pygame.WINDOWFOCUSLOST:
            self._held.clear()
            self._slow = False
            return False
        return event.type in (pygame.JOYAXISMOTION, pygame.JOYHATMOTION)

    def command(self, drive: Drive, dt: float) -> tuple[float, ...]:
        """Return the command of the driven robot; dt: since the last one, seconds.

        Keys deflect the stick gradually, in a quarter of a second, so that a tap is a nudge.
        """
        self._stick = ramped(self._stick, self._wanted, dt)
        return self._stick.command(drive)

    @property
    def _wanted(self) -> Stick:
        """The stick's target: that of the keys, or else of a controller."""
        if not self._held:
            return self._of_controllers
        ways = {self.keys.ways[key] for key in self._held}
        share = SLOW if self._slow else 1.0
        return Stick(*(share * sum(part) for part in zip(*ways, strict=True)))

    @property
    def _own(self) -> list[int]:
        """The controllers of this person."""
        return [each for each in self._dealt[self._place :: self._of] if each is not None]

    @property
    def _of_controllers(self) -> Stick:
        held = [self._tilt(self._controllers[each]) for each in self._own]
        stick = max(held, key=lambda stick: abs(stick.across) + abs(stick.ahead), default=Stick())
        return stick._replace(turn=max((way.turn for way in held), key=abs, default=0.0))

    @property
    def _by_controller(self) -> bool:
        return bool(self._own) and not self._held

    # -- keys -----------------------------------------------------------------------------------

    def _key(self, event: pygame.Event) -> bool:
        self._slow = bool(event.mod & pygame.KMOD_SHIFT)
        way = self.keys.ways.get(event.scancode)
        if way is None or (way.turn and not self._turns):
            return False
        if event.type == pygame.KEYUP:
            held = event.scancode in self._held
            self._held.discard(event.scancode)
            return held
        self._held.add(event.scancode)
        return True

    # -- controllers ----------------------------------------------------------------------------

    def _plug(self, event: pygame.Event) -> None:
        """Add a controller that is plugged in; remove one that is plugged out."""
        if event.type == pygame.JOYDEVICEADDED:
            self._add(event.device_index)
            return
        gone = event.instance_id
        self._dealt = [None if each == gone else each for each in self._dealt]
        self._controllers.pop(gone, None)

    def _add(self, number: int) -> None:
        controller = pygame.joystick.Joystick(number)
        which = controller.get_instance_id()
        self._controllers[which] = controller
        if which in self._dealt:
            return
        if None not in self._dealt:
            self._dealt.append(None)
        self._dealt[self._dealt.index(None)] = which

    def _tilt(self, controller: pygame.joystick.JoystickType) -> Stick:
        """Return where the left stick of a controller is, or its cross."""
        across, ahead = controller.get_hat(0) if controller.get_numhats() else (0, 0)
        if self._turns or not (across or ahead):
            turn, stick = float(across), Stick(*map(controller.get_axis, (ACROSS, AHEAD))).within()
            out = (stick.across**2 + stick.ahead**2) ** 0.5
            share = 0.0 if out <= DEAD_ZONE else (out - DEAD_ZONE) / (1 - DEAD_ZONE) / out
            return Stick(share * stick.across, -share * stick.ahead, turn if self._turns else 0.0)
        return Stick(across, ahead)
