"""The window that test_hands_in_window.py starts as a process of its own: a robot, a crate, a wall.

Arguments: the speed, and a robot that is driven by hand, if any.
"""

import sys

from mars2d import Robot, Scenario
from mars2d.addons import Map
from mars2d.bodies.props import Box
from mars2d.scenario.experiment import Experiment
from mars2d.window.memory import Memory
from mars2d.window.player import MAX_GAP
from mars2d.window.window import Window
from mars2d.world.timeline import Timeline
from tests.window.telling import Teller, unseen
from tests.worlds import ahead

SCENARIO = Scenario(
    title="Hands",
    robots=[Robot(name="red", controller=ahead), Robot(name="blue", pose=(-2, -1, 0))],
    props=[Box(name="crate", pose=(-2, 1, 0), length=0.4, width=0.4, mass=2.0)],
    workspace=[(-3, -2), (3, -2), (3, 2), (-3, 2)],
    addons=[Map([[(2.5, -1), (2.5, 1)]])],
    stop_time=1000.0,
)


class Observed(Window):
    """A window that prints where everything is whenever that has changed."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.teller = Teller()
        self.passed = 0.0  # seconds of the wall clock that the player was given
        pass_time = self.player.pass_time

        @unseen
        def count(wall):
            self.passed += min(wall, MAX_GAP)
            pass_time(wall)

        self.player.pass_time = count

    @unseen
    def draw(self, surface):
        self.teller.shown()
        super().draw(surface)
        frame = self.player.frame
        shown = self.grab.shown(frame)
        self.teller.drawn(
            {
                "passed": self.passed,
                "time": round(frame.time, 3),
                "paused": self.player.paused,
                "over": self.grab.over,
                "busy": self.grab.busy,
                "selected": self.selected,
                "driving": next(iter(self.director.driven), None),
                "status": self.director.status,
                "robots": shown.pose.round(4).T.tolist(),
                "props": shown.prop_pose.round(4).T.tolist(),
                "pulls": len(self.director.timeline.world.operator.pulls),
                "branches": len(self.director.timeline.branches),
                "past": self.player.past,
                "camera": [self.camera.scale, self.camera.x, self.camera.y],
            }
        )


def main():
    window = Observed(Timeline(Experiment(SCENARIO)), float(sys.argv[1]), (800, 600))
    if len(sys.argv) > 2:
        window.play(Memory(), "hands", [int(sys.argv[2])])
    window.run()


if __name__ == "__main__":
    main()
