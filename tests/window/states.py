"""What windows show, as plain data; and windows of given sources."""

from pathlib import Path

import pygame

from mars2d.output.figures.comparison import MODES
from mars2d.output.layers.table import LAYERS
from mars2d.scenario import save_scenario
from mars2d.scenario.animation import Animation
from mars2d.scenario.controllers import Controller
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.scenario import Scenario
from mars2d.window.compare_window import CompareWindow
from mars2d.window.editor import Editor
from mars2d.window.editor_window import play
from mars2d.window.run.window import Window
from mars2d.window.screen.display import Preferences
from mars2d.window.screen.looks import Looks
from mars2d.window.screen.source import Playback, Trio
from mars2d.world.record import load
from mars2d.world.timeline import Timeline
from tests.window.circling import Circling, circling_scenario


class Quiet(Window):
    """A window that counts its notes, and may show none."""

    silent = False

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.said, say = 0, self.notes.say

        def count(*words, **more):
            self.said += 1
            say(*words, **more)

        self.notes.say = count

    def draw(self, surface, **options):
        if self.silent:
            self.notes.clear()
        super().draw(surface, **options)


def made_window(
    speed, dark=False, text=1.0, silent=False, asks=False, people=None, compare=None, **options
):
    """Return a window of `experiment`, with options `set`, of `record`, or else of Circling.

    asks: whether a changed run is asked for at the end. people: the robots that people play, none
    for roles that they choose. compare: an experiment by each physics.
    """
    look = Preferences(dark=dark, text=text)
    if compare is not None:
        runs = {mode: Timeline(open_experiment(compare, {"physics": mode})) for mode in MODES}
        return CompareWindow(Trio(runs), speed, (800, 600), look)
    made = Quiet(_source(options), speed, (800, 600), look)
    made.silent, made.asks = silent, asks
    if people is not None:
        made.play(people)
    return made


def _source(options):
    if "experiment" in options:
        return Timeline(open_experiment(options["experiment"], options.get("set"), seed=1))
    if "record" in options:
        return Playback(load(options["record"]))
    changes = options.pop("scenario", {})
    if "animation" in changes:
        changes["animation"] = Animation(**changes["animation"])
    return Circling(circling_scenario(rows=options.get("rows", 100), **changes), **options)


def made_editor(source, folder, path=None, **options):
    """Return an editor of a scenario, a file, or of nothing yet: "-"."""
    if isinstance(source, Scenario):
        save_scenario(source, folder / "given.toml")
        source = folder / "given.toml"
    empty = source == "-"
    scenario = Scenario() if empty else open_experiment(source).scenario
    path = path or (None if empty else source)
    path = None if path is None else Path(path)
    return Editor(scenario, Looks(), path=path, empty=empty, play=play, **options)


def of_window(window):
    """Return what a window of a run or of a comparison shows."""
    size = {"size": pygame.display.get_surface().get_size()}
    return (of_comparison if isinstance(window, CompareWindow) else of_run)(window) | size


def of_run(window):
    player, director = window.player, window.director
    frame, source, timeline = player.frame, player.source, director.timeline
    seen = window.grab.shown(frame)
    bar, slider = window.time_bar, window.slider
    banner = window._ending.banner()
    scopes, plots = window.dock.scopes, window.dock.scopes._plots
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
        "slider": [slider._line.left, slider._line.right, slider._line.centery],
        "robots": seen.pose.T.round(4).tolist(),
        "props": seen.prop_pose.T.round(4).tolist(),
        "pulls": 0 if timeline is None else len(timeline.world.operator.pulls),
        "over_body": window.grab.over,
        "busy": window.grab.busy,
        "driving": next(iter(director.driven), None),
        "selected": window.selected,
        "following": window.viewpoint.following,
        "scale": round(window.camera.scale, 3),
        "origin": [round(window.camera.x, 1), round(window.camera.y, 1)],
        "layers": {layer.name: layer.name in window.layers.on for layer in LAYERS},
        "text": window.looks.text,
        "dark": window.looks.painter.theme.dark,
        "help": window.help.page,
        "notes": [note.text for note in window.notes._notes],
        "said": window.said,
        "banner": None if banner is None else banner.text,
        "line": None if banner is None or banner.excerpt is None else banner.excerpt.line,
        "buttons": {name: place.center for name, place in window.toolbar.places.items()},
        "menu": {title: at.center for title, at in window.menu.places.items()},
        "chosen": window.menu.chosen,
        "closes": {name: place.center for name, place in window.dock.closes.items()},
        "scopes": {
            getattr(what, "__name__", what): [*bodies] for what, bodies in scopes.traces.items()
        },
        "areas": {each.signal.name: [*scopes._on_surface(each).area] for each in plots},
        "panels": {name: [*plate] for name, plate in window.dock.plates.items()},
        "plot": [*window.layout.plot],
        "sliders": sliders_of(window.dock.parameters) if window.dock.parameters.is_open else {},
        "predictions": predictions_of(window.dock.predictions),
        "filming": window.saver._film is not None,
        "game": None if window.game is None else game_of(window),
        "editor": None if window.editor is None else of_editor(window.editor),
    }


def sliders_of(panel):
    lines = {name: slider._line for name, slider in panel._sliders.items()}
    return {
        "values": {name: each.value for name, each in panel.parameters().items()},
        "places": {name: [*lines[name]] for name in panel.places},
        "resets": {name: place.center for name, place in panel.resets.items()},
        "typed": panel.typed.text,
        "said": panel._words()[0],
    }


def predictions_of(panel):
    """Return how many predictions are ok, and of how many; None where they are not shown."""
    found = panel.found
    return [sum(bool(each.ok) for each in found), len(found)] if panel.is_open else None


def marks_of(window):
    return window.time_bar.marks()


def game_of(window):
    game = window.game
    return {
        "counting": game.counting > 0,
        "seats": [seat.robot for seat in game.seats],
        "result": None if game.result is None else game.result.words,
        "panel": [*window.dock.plates.get("score", ())],
    }


def of_comparison(window):
    player, trio = window.player, window.trio
    bar = window.time_bar
    return {
        "time": round(player.frame.time, 3),
        "row": trio.row,
        "rows": {mode: run.row for mode, run in trio.runs.items()},
        "newest": trio.newest,
        "playing": player.playing,
        "over": player.over,
        "scale": round(window.viewpoint.camera.scale, 3),
        "bar": [round(bar.x_of(0), 1), round(bar.x_of(trio.newest), 1), bar._line.centery],
        "arenas": {mode: plot.center for mode, plot in window.plots.items()},
        "graph": [*window.plot.area],
        "buttons": {name: place.center for name, place in window.toolbar.places.items()},
        "dark": window.looks.painter.theme.dark,
        "text": window.looks.text,
        "forces": window.layers.forces,
        "help": window.help.page,
        "notes": [note.text for note in window.notes._notes],
    }


def of_editor(editor):
    desk, draft, prompt = editor.desk, editor.desk.draft, editor.dialogs.prompt
    menu = {title: place.center for title, place in editor.menu.places.items()}
    return {
        "tool": editor.tool_name,
        "robots": [robot.pose for robot in draft.base.robots],
        "props": [[type(p).__name__, *p.pose, *_sizes(p)] for p in draft.base.props],
        "outlines": draft.listed["outline"],
        "walls": draft.listed["wall"],
        "routes": draft.listed["route"],
        "beacons": [beacon.position for beacon in draft.listed["beacon"]],
        "workspace": draft.base.workspace,
        "selection": desk.selection,
        "corner": desk.corner,
        "notice": desk.notice,
        "fault": desk.settled.verdict.text,
        "culprits": sorted(desk.settled.verdict.culprits),
        "prompt": None if prompt is None else prompt.label,
        "typed": None if prompt is None or prompt.field is None else prompt.text,
        "error": None if prompt is None else prompt.error,
        "laws": [law_of(robot) for robot in draft.base.robots],
        "drives": [repr(robot.drive) for robot in draft.base.robots],
        "members": [[b.mass, b.friction, b.color] for b in (*draft.base.robots, *draft.base.props)],
        "sensors": [[repr(sensor) for sensor in robot.sensors] for robot in draft.base.robots],
        "joints": [[type(j).__name__, j.a, j.b, j.anchor_b] for j in draft.base.joints],
        "base": [draft.base.title, draft.base.stop_time, draft.base.on_exit],
        "idle": editor.properties.idle(draft),
        "panel": {title: place.center for title, place in editor.panel.places.items()},
        "rows": [[row.title, row.value or row.more] for row in editor.properties.rows()],
        "menu": menu,
        "chosen": (editor.menu if editor.menu.is_open else editor.panel).chosen,
        "focused": editor.panel.focused,
        "step": desk.step,
        "changed": desk.changed,
        "corners": len(getattr(editor.tool, "corners", ())),
        "scale": round(desk.viewpoint.camera.scale, 3),
        "origin": [round(desk.viewpoint.camera.x, 2), round(desk.viewpoint.camera.y, 2)],
    }


def law_of(robot):
    law = robot.controller
    return law if law is None else repr(law) if isinstance(law, Controller) else law.__name__


def _sizes(prop):
    return [getattr(prop, name) for name in ("length", "width", "diameter") if hasattr(prop, name)]


def left_editor(editor):
    """Return the outcome of an editor that was left."""
    outcome = editor.dialogs.outcome
    return {
        "left": True,
        "when": None if outcome is None else outcome.when,
        "poses": None if outcome is None else [robot.pose for robot in outcome.scenario.robots],
    }
