"""The window that the tests start as a process of its own: it tells what it shows.

Arguments: speed, then options as JSON: `experiment` or `record`, a file, or
else fields of Circling. `dark`, `text` and `silent`, without notes, are how it looks; `windows` is
how many come one after the other; `asks`: whether a changed run is asked for at the end. `people`:
the robots that people play, none for roles that they choose.
"""

import json
import sys

import pygame

from mars2d.core.errors import LawError
from mars2d.output.layers.table import LAYERS
from mars2d.scenario.animation import Animation
from mars2d.scenario.experiment import open_experiment
from mars2d.window.display import Preferences
from mars2d.window.memory import Memory
from mars2d.window.source import Playback
from mars2d.window.window import Window
from mars2d.world.record import load
from mars2d.world.timeline import Timeline
from tests.window.circling import Circling, circling_scenario
from tests.window.telling import Teller, unseen


class Observed(Window):
    """A window that prints its state as a line of JSON whenever that has changed."""

    said = 0  # how many notes there were
    silent = False  # without notes, which fade

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.teller = Teller()
        say = self.notes.say

        def count(*words, **more):
            self.said += 1
            say(*words, **more)

        self.notes.say = count

    @unseen
    def draw(self, surface, **options):
        self.teller.shown()
        if self.silent:
            self.notes.clear()
        super().draw(surface, **options)
        self.teller.drawn(state_of(self) | {"size": surface.get_size()})


def state_of(window):
    player, director = window.player, window.director
    frame, source, timeline = player.frame, player.source, director.timeline
    seen = window.grab.shown(frame)
    bar, slider = window._controls.time_bar, window._controls.slider
    banner = window._ending.banner()
    return {
        "time": round(frame.time, 3),
        "row": source.row,
        "newest": source.newest,
        "status": player.status()[0],
        "chip": window._status().text,
        "speed": str(player.speed),
        "over": player.over,
        "past": player.past,
        "playing": player.playing,
        "restarts": getattr(source, "restarts", 0),
        "branches": 0 if timeline is None else len(timeline.branches),
        "marks": {} if timeline is None else {k: [*v] for k, v in marks_of(window).items()},
        "bar": [round(bar.x_of(0), 1), round(bar.x_of(source.newest), 1), bar._line.centery],
        "span": [*bar.span],
        "show_all": bar._all.center,
        "slider": [slider._line.left, slider._line.right, slider._line.centery],
        "robots": seen.pose.T.round(4).tolist(),
        "props": seen.prop_pose.T.round(4).tolist(),
        "pulls": 0 if timeline is None else len(timeline.world.operator.pulls),
        "over_body": window.grab.over,
        "busy": window.grab.busy,
        "driving": next(iter(director.driven), None),
        "selected": window.selected,
        "following": window.viewpoint.following is not None,
        "scale": round(window.camera.scale, 3),
        "origin": [round(window.camera.x, 1), round(window.camera.y, 1)],
        "layers": {layer.name: layer.name in window.layers.on for layer in LAYERS},
        "text": window.looks.text,
        "dark": window._painter.theme.dark,
        "help": window.help.page,
        "notes": [note.text for note in window.notes._notes],
        "said": window.said,
        "banner": None if banner is None else banner.text,
        "line": None if banner is None or banner.excerpt is None else banner.excerpt.line,
        "buttons": {name: place.center for name, place in window.toolbar.places.items()},
        "menu": {title: at.center for title, at in window.toolbar.menu.places.items()},
        "closes": {name: place.center for name, place in window.dock.closes.items()},
        "scopes": {trace.name: [*trace.bodies] for trace in window.scopes.traces},
        "areas": {name: [*area] for name, area in window.scopes.areas.items()},
        "on_scopes": {name: place.center for name, place in window.scopes.places.items()},
        "panels": {name: [*plate] for name, plate in window.dock.plates.items()},
        "plot": [*window.layout.plot],
        "sliders": sliders_of(window.parameters) if window.parameters.is_open else {},
        "predictions": predictions_of(window._predictions),
        "loop": player.loop,
        "full": pygame.display.is_fullscreen(),
        "filming": window.saver._film is not None,
        "game": None if window.game is None else game_of(window),
        "editor": None if window.editor is None else editor_of(window.editor),
    }


def sliders_of(panel):
    lines = {name: slider._line for name, slider in panel._sliders.items()}
    return {
        "values": {name: each.value for name, each in panel.parameters().items()},
        "places": {name: [*lines[name]] for name in panel.places},
        "resets": {name: place.center for name, place in panel.resets.items()},
        "focus": panel.focus,
        "typed": panel.typed,
        "said": panel._words()[0],
    }


def predictions_of(panel):
    """Return how many predictions are ok, and of how many; None where they are not shown."""
    found = panel.reading.predictions
    return [sum(each.ok for each in found), len(found)] if panel.is_open else None


def marks_of(window):
    return window._controls.time_state().marks


def game_of(window):
    game = window.game
    return {
        "counting": game.counting > 0,
        "seats": [seat.robot for seat in game.seats],
        "result": None if game.result is None else game.result.words,
        "news": None if game.result is None else game.result.news,
        "choices": {number: at.center for number, at in window._before.places.items()},
        "tally": game.tally(game.seats[0].role).in_words if game.seats else "",
        "panel": [*window.dock.plates.get("score", ())],
    }


def editor_of(editor):
    desk = editor.desk
    return {
        "tool": editor.tool_name,
        "robots": [robot.pose for robot in desk.draft.robots],
        "walls": desk.draft.walls,
        "outlines": desk.draft.outlines,
        "selection": desk.selection,
        "corners": len(getattr(editor.tool, "corners", ())),
        "prompt": None if editor.dialogs.prompt is None else editor.dialogs.prompt.label,
        "fault": editor.judge.verdict.text,
        "notice": desk.notice,
        "camera": [desk.camera.scale, desk.camera.x, desk.camera.y],
    }


def source_of(options):
    if "experiment" in options:
        return Timeline(open_experiment(options["experiment"], options.get("set", {}), seed=1))
    if "record" in options:
        return Playback(load(options["record"]))
    changes = options.pop("scenario", {})
    if "animation" in changes:
        changes["animation"] = Animation(**changes["animation"])
    scenario = circling_scenario(rows=options.get("rows", 100), **changes)
    return Circling(scenario, **options)


def main():
    speed, options = sys.argv[1], json.loads(sys.argv[2])
    silent = options.pop("silent", False)
    windows, people = options.pop("windows", 1), options.pop("people", None)
    asks = options.pop("asks", False)
    look = Preferences(dark=options.pop("dark", False), text=options.pop("text", 1.0))
    for _ in range(windows):
        source = source_of({**options})
        window = Observed(source, speed if speed == "max" else float(speed), (800, 600), look)
        window.silent, window.asks = silent, asks
        if people is not None:
            window.play(Memory(), "observed", people)
        try:
            window.run()
        except LawError as error:
            print(json.dumps({"raised": str(error)}), flush=True)
    print(json.dumps({"left": True}), flush=True)


if __name__ == "__main__":
    main()
