"""The editor that test_editor.py starts as a process of its own: it tells what it holds.

Arguments: a scenario file, or nothing but "-" for an empty one; then options as JSON.
"""

import json
import sys
from pathlib import Path

from mars2d.scenario.controllers import Controller
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.scenario import Scenario
from mars2d.window.editor import Editor
from mars2d.window.editor_window import EditorWindow
from mars2d.window.looks import Looks
from tests.window.telling import Teller, unseen


class Observed(EditorWindow):
    """A window that prints its state as a line of JSON whenever that has changed."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.teller = Teller()

    @unseen
    def draw(self, surface):
        self.teller.shown()
        super().draw(surface)
        self.teller.drawn(state_of(self.editor))


def state_of(editor):
    desk, draft = editor.desk, editor.desk.draft
    return {
        "tool": editor.tool_name,
        "robots": [robot.pose for robot in draft.robots],
        "props": [[type(p).__name__, *p.pose, *_sizes(p)] for p in draft.props],
        "outlines": draft.outlines,
        "walls": draft.walls,
        "routes": draft.routes,
        "beacons": [beacon.position for beacon in draft.beacons],
        "workspace": draft.workspace,
        "selection": desk.selection,
        "corner": desk.corner,
        "notice": desk.notice,
        "fault": editor.judge.verdict.text,
        "culprits": sorted(editor.judge.verdict.culprits),
        "prompt": None if editor.dialogs.prompt is None else editor.dialogs.prompt.label,
        "typed": None if editor.dialogs.prompt is None else editor.dialogs.prompt.text,
        "error": None if editor.dialogs.prompt is None else editor.dialogs.prompt.error,
        "help": editor.help.is_open,
        "laws": [law_of(robot) for robot in draft.robots],
        "drives": [repr(robot.drive) for robot in draft.robots],
        "members": [[b.mass, b.friction, b.color] for b in (*draft.robots, *draft.props)],
        "sensors": [[repr(sensor) for sensor in robot.sensors] for robot in draft.robots],
        "joints": [[type(j).__name__, j.a, j.b, j.anchor_b] for j in draft.joints],
        "base": [draft.base.title, draft.base.stop_time, draft.base.on_exit],
        "idle": editor.properties.idle(draft),
        "panel": {title: place.center for title, place in editor.panel.places.items()},
        "rows": [[row.title, row.value] for row in editor.properties.rows()],
        "signs": {title: place.center for title, place in editor.panel.signs.items()},
        "menu": {title: place.center for title, place in editor.menu.places.items()},
        "snaps": desk.snaps,
        "step": desk.step,
        "changed": desk.history.changed,
        "title": editor.title,
        "corners": len(getattr(editor.tool, "corners", ())),
        "scale": round(desk.camera.scale, 3),
        "origin": [round(desk.camera.x, 2), round(desk.camera.y, 2)],
    }


def law_of(robot):
    law = robot.controller
    return law if law is None else repr(law) if isinstance(law, Controller) else law.__name__


def _sizes(prop):
    return [getattr(prop, name) for name in ("length", "width", "diameter") if hasattr(prop, name)]


def main():
    source, options = sys.argv[1], json.loads(sys.argv[2])
    scenario = Scenario() if source == "-" else open_experiment(source).scenario
    path = options.pop("path", None if source == "-" else source)
    editor = Editor(
        scenario, Looks(), path=None if path is None else Path(path),
        empty=source == "-", **options,
    )  # fmt: skip
    Observed(editor, (800, 600)).run()
    outcome = editor.dialogs.outcome
    print(json.dumps({
        "left": True,
        "when": None if outcome is None else outcome.when,
        "poses": None if outcome is None else [robot.pose for robot in outcome.scenario.robots],
    }), flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
