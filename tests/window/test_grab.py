"""The mouse on the picture: what it is over, what it pulls, puts elsewhere and turns."""

from math import pi
from types import SimpleNamespace

import numpy as np
import pygame
import pytest

from mars2d import Robot, Scenario, World
from mars2d.addons import Map
from mars2d.bodies.joints import Rope
from mars2d.bodies.props import Box
from mars2d.core.errors import InputError
from mars2d.core.scene import Circle, Line, Text
from mars2d.output.raster.camera import Camera
from mars2d.window.run.grab import Grab
from mars2d.window.run.marks import BAD
from mars2d.window.run.push import pull_of
from tests.cases import each_case

LEFT, RIGHT = pygame.BUTTON_LEFT, pygame.BUTTON_RIGHT
pytestmark = pytest.mark.usefixtures("keyboard")

CAMERA = Camera(100.0, 300.0, 200.0)
VIEW = SimpleNamespace(camera=CAMERA, point_at=lambda at: tuple(CAMERA.to_world([at])[0].tolist()))

SCENARIO = Scenario(
    robots=[Robot(name="red"), Robot(name="blue", pose=(1, 0, 0))],
    props=[Box(pose=(-1, 0, 0), length=0.4, width=0.4, mass=2.0, name="crate")],
    addons=[
        Map([[(0, 1), (0.5, 1), (0.5, 1.5)], [(2, 1), (2, -1)]]),
    ],
    on_exit="ignore",
)


class Person:
    """Somebody with a mouse before a world, in which time stands still or passes."""

    def __init__(self, scenario=SCENARIO, playing=False, recording=False):
        self.world, self.playing, self.recording = World(scenario), playing, recording
        self.said, self.clicked = [], []
        clicks = {LEFT: self.clicked.append}
        self.grab = Grab(self, VIEW, [], lambda pixel: pixel, self.change, clicks)

    @property
    def frame(self):
        return self.world.frame

    def change(self, act):
        if self.recording:
            self.said.append("a recording")
            return False
        try:
            act(self.world)
        except InputError as error:
            self.said.append(str(error))
            return False
        return True

    def pixel(self, x, y):
        return tuple(np.rint(CAMERA.to_pixels([(x, y)])[0]).astype(int).tolist())

    def move(self, x, y):
        self.pointer = self.pixel(x, y)
        self.grab.move(self.pointer)

    def press(self, x, y, button=LEFT):
        self.pointer = self.pixel(x, y)
        self.grab.press(self.pointer, button)
        return self.grab.busy

    def release(self, x, y):
        self.grab.release(self.pixel(x, y), LEFT)

    def wait(self, steps):
        """Let time pass, with a picture at each step."""
        for _ in range(steps):
            self.grab.tick(self.pointer)
            self.world.step()

    def shown(self):
        return self.grab.shown(self.frame)

    def marks(self, kind):
        return [shape for shape in self.grab.marks(self.shown()) if isinstance(shape, kind)]

    def words(self):
        return [text.text for text in self.marks(Text)]


# -- what it is over -----------------------------------------------------------------------


@each_case(
    "place, over, words",
    [((0.1, 0.05), 0, ["red"]), ((1.0, -0.14), 1, ["blue"]), ((-1.1, 0.15), 2, ["crate"]),
     ((2.0, 0.3), None, [])],
)  # fmt: skip
def test_it_shows_what_it_is_over_and_its_name(place, over, words):
    person = Person()
    person.move(*place)
    assert person.grab.over == over
    assert person.words() == words
    assert bool(person.marks(Circle)) == (over is not None)


# -- clicks ----------------------------------------------------------------------------------


@each_case("running", [True, False])
def test_a_click_is_left_to_others_and_changes_nothing(running):
    person = Person(playing=running)
    assert person.press(0, 0)
    assert person.grab.busy
    person.move(0.02, 0.0)
    person.release(0.02, 0.0)
    assert person.clicked == [pytest.approx((0.02, 0.0), abs=0.01)]
    assert not person.grab.busy
    assert person.world.operator.log == []


# -- while time passes: pulling ----------------------------------------------------------------


def test_a_drag_pulls_a_robot_to_the_pointer_and_a_line_shows_how_strongly():
    person = Person(playing=True)
    assert person.press(0.05, 0.0)
    person.move(0.0, -1.0)
    person.wait(2)
    lines, (label,) = person.marks(Line), person.words()
    assert lines[0].points[1].tolist() == pytest.approx([0.0, -1.0], abs=0.01)
    assert float(label.removesuffix(" N")) > 1
    person.wait(20)
    assert person.world.pose[:2, 0] == pytest.approx((0, -1), abs=0.06)
    person.release(0.0, -1.0)
    assert person.clicked == []
    assert not person.world.operator.pulls
    person.wait(3)
    assert person.grab.marks(person.frame) != []  # it is over the robot


def test_once_time_stands_still_it_lets_go():
    person = Person(playing=True)
    person.press(0, 0)
    person.move(0.0, -1.0)
    person.playing = False
    person.grab.tick(person.pointer)
    assert not person.world.operator.pulls
    assert not person.grab.busy


def test_the_pull_wins_against_drives_and_floors_and_stays_bounded():
    force, speed = pull_of(SCENARIO, 0)
    assert force == pytest.approx(1.5 * 5.0 + 10.0)
    assert speed == pytest.approx(2.0)
    force, _ = pull_of(SCENARIO, 2)
    assert force == pytest.approx(1.5 * 0.5 * 2.0 * 9.81 + 20.0)
    _, speed = pull_of(Scenario(robots=[Robot()], workspace=None, on_exit="ignore"), 0)
    assert speed == pytest.approx(0.75)
    huge = [(-500, -500), (500, -500), (500, 500), (-500, 500)]
    assert pull_of(SCENARIO.replace(workspace=huge), 0)[1] == 5.0


@each_case("physics", ["stop", "ideal"])
def test_where_no_forces_act_it_says_what_to_do_instead_once_a_drag(physics):
    person = Person(SCENARIO.replace(physics=physics), playing=True)
    person.press(0, 0)
    person.move(0.0, -0.5)
    person.move(0.0, -0.6)
    (words,) = person.said
    assert words.startswith("red can't be pulled: with physics =")
    assert "pause, and put it elsewhere" in words
    assert not person.grab.busy
    assert person.world.operator.log == []


def test_in_a_recording_nothing_is_pulled_and_the_drag_ends():
    person = Person(playing=True, recording=True)
    person.press(0, 0)
    person.move(0.0, -0.5)
    person.move(0.0, -0.6)
    assert person.said == ["a recording"]
    assert not person.grab.busy


# -- while it stands still: putting elsewhere --------------------------------------------------


def test_a_drag_shows_a_body_elsewhere_and_puts_it_there_when_it_ends():
    person = Person()
    person.press(-1.05, 0.0)
    person.move(-1.05, -1.0)
    assert person.shown().prop_pose[:, 0].tolist() == pytest.approx([-1, -1, 0])
    assert person.world.prop_pose[:, 0].tolist() == [-1, 0, 0]
    assert person.shown().leaps[-1][0] == person.world.iteration, "no path leads there"
    assert person.words() == ["(\N{MINUS SIGN}1.00, \N{MINUS SIGN}1.00) m"]
    person.release(-1.05, -1.0)
    assert person.world.prop_pose[:, 0].tolist() == pytest.approx([-1, -1, 0])
    assert person.shown().prop_pose[:, 0].tolist() == pytest.approx([-1, -1, 0])
    assert [type(i).__name__ for i in person.world.operator.log] == ["Place"]


def test_a_drag_of_which_only_press_and_release_are_seen_counts():
    person = Person()
    person.press(-1.05, 0.0)
    person.release(-1.05, -1.0)
    assert person.world.prop_pose[:, 0].tolist() == pytest.approx([-1, -1, 0])
    person.press(-1.05, -1.0)
    person.move(-1.05, 0.0)
    person.release(-1.05, -1.0)
    assert person.clicked == [], "who comes back has not clicked"


def test_where_it_can_not_stay_this_is_said_in_red_and_it_springs_back():
    person = Person()
    person.press(0, 0)
    person.move(0.9, 0.0)
    assert person.words() == ["would overlap blue"]
    assert BAD in {ring.stroke for ring in person.marks(Circle)}
    person.release(0.9, 0.0)
    assert person.said == ["red can't be put there: it would overlap blue"]
    assert person.shown().pose[:, 0].tolist() == [0, 0, 0]


def test_what_a_joint_holds_springs_back_and_this_is_said():
    rope = Rope(a="red", b="blue", length=2.0)
    person = Person(Scenario(robots=SCENARIO.robots, joints=[rope]))
    person.press(0, 0)
    person.move(0, -1)
    words = "red can't be put elsewhere: a joint holds it; it can be pulled"
    assert person.words() == [words]
    person.release(0, -1)
    assert person.said == [words]
    assert person.shown().pose[:, 0].tolist() == [0, 0, 0]


# -- turning -------------------------------------------------------------------------------------


def test_a_right_drag_turns_a_body_to_the_pointer():
    person = Person()
    person.press(0, 0, RIGHT)
    person.move(-0.5, 0.5)
    assert person.words() == ["135\N{DEGREE SIGN} (2.356 rad)"]
    person.release(-0.5, 0.5)
    assert person.world.pose[:, 0] == pytest.approx((0, 0, 3 * pi / 4))
