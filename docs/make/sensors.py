"""Draw the pictures of the sensors' pages, and write the tables of their fields.

python docs/make/sensors.py
"""

from __future__ import annotations

import io
import re
import sys
from collections.abc import Callable, Sequence
from functools import partial
from math import pi
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import fields
import numpy as np
from PIL import Image

from mars2d import Robot, Scenario, Unicycle, World, addons, sensors
from mars2d.addons import Addon, Floor, Map
from mars2d.bodies import Ball, Box
from mars2d.core.description import snake_case
from mars2d.core.scene import Scene
from mars2d.geometry import Outline
from mars2d.output.raster.picture import paint_frame, save_png
from mars2d.sensors import (
    Bumper,
    Ground,
    Imu,
    LineCamera,
    Odometry,
    Pose,
    Proximity,
    RangeBearing,
    RangeFinder,
    Sensor,
    SonarRing,
)

DOCS = Path(__file__).parents[1]
SIZE = (760, 560)
COLORS = 128

ROOM: Outline = [(-2.0, -1.5), (-2.0, 1.5), (2.0, 1.5), (2.0, -1.5)]
FURNITURE = [[(1.0, -1.0), (1.5, -1.0), (1.5, -0.3), (1.0, -0.3)], [(-1.4, 0.9), (-0.5, 1.2)]]

BALL = Ball(pose=(0.6, 0.75, 0), diameter=0.35)
BOX = Box(pose=(-1.3, -0.9, 0.4), length=0.5, width=0.3)


def room(*robots: Robot, steps: int = 0) -> World:
    """Return a world in a small room after some control steps at 0.2 m/s."""
    scenario = Scenario(
        title=type(robots[0].sensors[0]).__name__,
        robots=robots,
        workspace=ROOM,
        on_exit="wall",
        props=[BALL, BOX],
        addons=[Map(FURNITURE)],
    )
    world = World(scenario)
    for _ in range(steps):
        world.step([[0.2] + [0.0] * (len(robots) - 1), [0.0] * len(robots)])
    return world


def _proximity() -> World:
    far = Robot(pose=(-0.9, 0.1, 0.6), sensors=[Proximity(range=0.7, field_of_view=2.0)])
    near = Robot(pose=(0.1, -0.55, 0.2), sensors=[Proximity(range=1.1, field_of_view=2.0)])
    return room(near, far)


def _range_finder() -> World:
    robot = Robot(pose=(-0.4, -0.2, 0.3), sensors=[RangeFinder(range=2.0)])
    return room(robot, Robot(pose=(0.3, -0.9, 1)))


def _sonar_ring() -> World:
    robot = Robot(pose=(-0.2, -0.1, 0.3), sensors=[SonarRing(range=1.5)])
    return room(robot, Robot(pose=(0.5, -0.9, 1)))


def _bumper() -> World:
    robot = Robot(pose=(0.53, -0.68, 0.4), sensors=[Bumper(sectors=6)])
    near = [(0.3, -1.0), (0.3, -0.2), (1.5, -0.2), (1.5, -1.0)]
    return alone(robot, steps=20, command=(0.2, 0), things=[Map(FURNITURE[:1])], area=near)


def _line_camera() -> World:
    robot = Robot(pose=(-1.0, 0.1, 0.0), sensors=[LineCamera()])
    return room(robot, Robot(pose=(1.2, 0.4, 2)), Robot(pose=(0.6, -0.35, 1)))


class Believed(Addon):
    """Draws where a sensor took its robot to be, at each control step."""

    sensor: str

    def on_draw(self, world: World, scene: Scene) -> None:
        """Draw dots."""
        for x, y, _ in world.record.sensors[self.sensor][:, 0]:
            scene.circle((x, y), 0.0, fill="#d55e00", pixels=2.0)


def alone(
    *robots: Robot,
    steps: int,
    command: Sequence[float],
    things: Sequence[Addon] = (),
    area: Outline = ROOM,
) -> World:
    """Return a world in the room without furniture, or in another area, after some steps."""
    title = ", ".join(dict.fromkeys(type(s).__name__ for robot in robots for s in robot.sensors))
    world = World(Scenario(title=title, robots=robots, workspace=area, addons=things))
    for _ in range(steps):
        world.step(np.tile(np.reshape(command, (2, 1)), len(robots)))
    return world


def _range_bearing() -> World:
    eyes = RangeBearing(range=2.6, field_of_view=2.0)
    others = [(0.1, 1.0, 2.0), (0.6, -0.9, 1.0), (0.7, 0.3, 3.0), (-1.7, 1.1, 0.0)]
    robots = [Robot(pose=(-1.6, -0.5, 0.3), sensors=[eyes]), *(Robot(pose=at) for at in others)]
    return alone(*robots, steps=0, command=(0, 0), things=[Map([[(-0.2, -0.4), (0.1, 0.5)]])])


def _pose() -> World:
    robot = Robot(pose=(-1.0, -1.0, 0.2), sensors=[Pose(noise=(0.15, 0.15, 0.2))])
    return alone(robot, steps=63, command=(0.35, 0.3), things=[Believed(sensor="pose")])


def _odometry() -> World:
    robot = Robot(pose=(-1.7, -1.0, 0.3), sensors=[Odometry(origin="world", drift=0.015)])
    things = [Believed(sensor="odometry"), Map([[(0.7, -1.2), (0.7, 1.2)]])]
    return alone(robot, steps=85, command=(0.4, 0), things=things)


def _imu() -> World:
    robot = Robot(pose=(-1, -1, 0), drive=Unicycle(max_linear_speed=2), sensors=[Imu()])
    return alone(robot, steps=16, command=(1.4, 1.4))


def _beacon() -> World:
    robot = Robot(pose=(-1.2, -0.6, 0.4), sensors=[sensors.Beacon()])
    things = [
        addons.Beacon(at=(1.5, 0.9), name="lamp"),
        addons.Beacon(at=(1.2, -0.9), name="door"),
        addons.Beacon(path=[(-1.7, 1.0), (0, 1.0)], speed=0.3, name="ferry"),
        Map([[(0.2, -1.3), (0.2, -0.4)]]),
    ]
    return alone(robot, steps=40, command=(0, 0), things=things)


def _ground() -> World:
    turns = np.linspace(0, 2 * pi, 80, endpoint=False)
    ring = np.column_stack([0.5 * np.cos(turns), 0.4 * np.sin(turns)])
    track = Floor(patches=[((1.1 * ring).tolist(), "black"), ((0.9 * ring).tolist(), "white")])
    eyes = [
        Ground(name=name, mount=(0.22, side, 0)) for name, side in (("left", 0.1), ("right", -0.1))
    ]
    robot = Robot(pose=(0.4, -0.35, pi / 2), sensors=eyes)
    near = [(-0.7, -0.55), (-0.7, 0.55), (0.75, 0.55), (0.75, -0.55)]
    return alone(robot, steps=12, command=(0.2, 0), things=[track], area=near)


def _in_a_room(kind: type[Sensor]) -> World:
    """Show a sensor with its default fields, ahead of which stand things."""
    return room(Robot(pose=(-0.6, -0.2, 0.2), sensors=[kind()]))


SCENES: dict[type[Sensor], Callable[[], World]] = {
    kind: globals().get(f"_{snake_case(kind.__name__)}", partial(_in_a_room, kind))
    for kind in fields.shipped("sensors")
}
"""For each sensor a world that shows what it does."""

INDEX = DOCS / "sensors" / "index.md"


def page(kind: type[Sensor]) -> Path:
    """Return the page of a sensor."""
    return DOCS / "sensors" / f"{snake_case(kind.__name__)}.md"


def with_fields(text: str, kind: type[Sensor]) -> str:
    """Return a page's text with the list of the sensor's own fields between its marks."""
    lines = "\n".join(fields.line(kind, field) for field in fields.fields_of(kind))
    made = f"""<!-- fields -->

{lines or "It has the fields of all sensors alone."}

<!-- /fields -->"""
    new, count = re.subn(r"<!-- fields -->.*<!-- /fields -->", lambda _: made, text, flags=re.S)
    assert count == 1, f"{page(kind).name} has no marks for its fields"
    return new


def with_rows(text: str) -> str:
    """Return the index with a row for each sensor, as its page says in a comment."""
    rows = ""
    for kind in SCENES:
        found = re.search(r"<!-- index (.*) -->", page(kind).read_text(encoding="utf-8"))
        assert found is not None, f"{page(kind).name} has no comment for the index"
        rows += f"| [`{kind.__name__}`]({page(kind).name}) {found[1]}\n"
    head, mark, rest = text.partition("|---|---|---|---|\n")
    return head + mark + rows + rest[rest.index("\n\n") + 1 :]


def draw(kind: type[Sensor]) -> None:
    """Save the picture of a sensor at work."""
    world = SCENES[kind]()
    world.observe()
    png = DOCS / "pictures" / f"sensor_{snake_case(kind.__name__)}.png"
    save_png(paint_frame(world.frame, SIZE, sensors=True), png)
    few = Image.open(io.BytesIO(png.read_bytes())).convert("RGB").quantize(COLORS, kmeans=1)
    few.save(png, optimize=True)


if __name__ == "__main__":
    for kind in SCENES:
        path = page(kind)
        path.write_text(with_fields(path.read_text(encoding="utf-8"), kind), encoding="utf-8")
        draw(kind)
    INDEX.write_text(with_rows(INDEX.read_text(encoding="utf-8")), encoding="utf-8")
