"""The window of a comparison in a process of its own: it tells what it shows.

Arguments: an experiment, and the speed.
"""

import json
import sys

from mars2d.scenario.experiment import open_experiment
from mars2d.window.compare_window import CompareWindow
from mars2d.window.trio import Trio
from tests.window.telling import Teller, unseen


class Observed(CompareWindow):
    """A window that prints its state as a line of JSON whenever that has changed."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.teller = Teller()

    @unseen
    def draw(self, surface, **options):
        self.teller.shown()
        super().draw(surface, **options)
        self.teller.drawn(state_of(self) | {"size": surface.get_size()})


def state_of(window):
    player, trio = window.player, window.trio
    bar = window._controls.time_bar
    return {
        "time": round(player.frame.time, 3),
        "row": trio.row,
        "rows": {mode: timeline.row for mode, timeline in trio.timelines.items()},
        "newest": trio.newest,
        "playing": player.playing,
        "over": player.over,
        "collisions": trio.collisions,
        "scale": round(window.viewpoint.camera.scale, 3),
        "bar": [round(bar.x_of(0), 1), round(bar.x_of(trio.newest), 1), bar._line.centery],
        "span": [*bar.span],
        "arenas": {arena.mode: arena.plot.center for arena in window.arenas},
        "graph": [*window.plot.area],
        "buttons": {name: place.center for name, place in window.toolbar.places.items()},
        "dark": window.looks.painter.theme.dark,
        "text": window.looks.text,
        "forces": window.layers.forces,
        "help": window.help.page,
        "notes": [note.text for note in window.notes._notes],
    }


def main():
    name, speed = sys.argv[1:]
    trio = Trio(lambda mode: open_experiment(name, {"physics": mode}))
    Observed(trio, speed if speed == "max" else float(speed), (800, 600)).run()
    print(json.dumps({"left": True}), flush=True)
