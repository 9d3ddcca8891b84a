"""The folders of the window: each imports only from those below it."""

import ast
from pathlib import Path

import mars2d.window

FOLDER = Path(mars2d.window.__file__).parent
ORDER = ["widgets", "screen", "panels", "editor", "run"]


def test_each_folder_imports_only_from_those_below_and_widgets_know_nothing_of_robots():
    wrong = []
    for path in sorted(FOLDER.rglob("*.py")):
        own = path.relative_to(FOLDER).parts[0]
        if own not in ORDER:
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.ImportFrom) or not str(node.module).startswith("mars2d."):
                continue
            _, room, *part = str(node.module).split(".")
            below = room != "window" or part[0] in ORDER[: ORDER.index(own) + 1]
            if not below or (own == "widgets" and room not in ("core", "output", "window")):
                wrong.append(f"{own}/{path.name}: {node.module}")
    assert not wrong
