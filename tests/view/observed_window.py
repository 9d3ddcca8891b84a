"""The window that test_window.py starts as a process of its own: it tells what it shows.

Arguments: speed, then fields of Circling as JSON.
"""

import dataclasses
import json
import sys

from mars2d.animation import Animation
from mars2d.errors import LawError
from mars2d.view.window import Window
from tests.view.circling import Circling, circling_scenario


class Observed(Window):
    """A window that prints its state as a line of JSON whenever that has changed."""

    told = state = ""

    def draw(self, surface):
        if self.told != self.state:  # of the picture before, which is on the screen by now
            self.told = self.state
            print(self.told, flush=True)
        super().draw(surface)
        frame = self.player.frame
        state = {
            "time": round(frame.time, 3),
            "row": self.player.source.row,
            "status": self.player.status()[0],
            "speed": str(self.player.speed),
            "over": self.player.over,
            "newest": self.player.source.newest,
            "text": self.text,
            "dark": self._painter.theme.dark,
            "notes": [note.text for note in self.notes._notes],
            "restarts": self.player.source.restarts,
            "help": self.help,
            "selected": self.selected,
            "layers": dataclasses.asdict(self.layers),
            "scale": round(self.camera.scale, 3),
            "origin": [round(self.camera.x, 1), round(self.camera.y, 1)],
            "size": surface.get_size(),
        }
        self.state = json.dumps(state)


def main():
    speed, options = sys.argv[1], json.loads(sys.argv[2])
    scenario = options.pop("scenario", {})
    if "animation" in scenario:
        scenario["animation"] = Animation(**scenario["animation"])
    windows = options.pop("windows", 1)
    rows = options.get("rows", 100)
    for _ in range(windows):
        source = Circling(circling_scenario(rows=rows, **scenario), **options)
        try:
            Observed(source, speed if speed == "max" else float(speed), (800, 600)).run()
        except LawError as error:
            print(json.dumps({"raised": str(error)}), flush=True)
    print(json.dumps({"left": True}), flush=True)


if __name__ == "__main__":
    main()
