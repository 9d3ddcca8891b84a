"""Write docs/notebook.ipynb: a laboratory in ten cells, executed.

python docs/make/notebook.py
"""

from __future__ import annotations

import re
import sys
import tempfile
from pathlib import Path
from typing import Any

TARGET = Path(__file__).parents[1] / "notebook.ipynb"

INTRODUCTION = """\
# A laboratory in a notebook

Three robots chase each other: each steers towards the next one. You change one number, the gain,
and see what it does. This notebook is written and executed by `docs/make/notebook.py`; run its
cells in order. What each of them shows is explained in [Notebooks](notebook.md)."""

CELLS = [
    (
        "What there is: a **scenario**. The last line of a cell is shown, here as a picture.",
        """\
from functools import partial

import matplotlib.pyplot as plt
import numpy as np

import mars2d
from mars2d import Robot, Scenario, World
from mars2d.geometry import wrap
from mars2d.sensors import Proximity

scenario = Scenario(
    title="A chase",
    robots=[
        Robot(name="Ada", pose=(-3, -2, 0), sensors=[Proximity(range=1.2)]),
        Robot(name="Bob", pose=(3, -2, 2), sensors=[Proximity(range=1.2)]),
        Robot(name="Cleo", pose=(0, 3, 4), sensors=[Proximity(range=1.2)]),
    ],
    stop_time=30,
)
scenario""",
    ),
    (
        "What they do: a **law**. It is asked for speed and turning rate of all robots each 0.1 s.",
        """\
def chase(world, gain=0.5):
    \"\"\"Steer each robot towards the next one.\"\"\"
    x, y, theta = world.pose
    dx, dy = np.roll(x, -1) - x, np.roll(y, -1) - y
    bearing = wrap(np.arctan2(dy, dx) - theta)
    return np.array([np.full(3, 0.3), gain * bearing])""",
    ),
    (
        "**Run** it. A record shows itself as a replay: press play, drag the time, pick a robot.",
        """\
record = mars2d.run(scenario, control=chase)
record""",
    ),
    (
        """\
All numbers are **arrays**, with time first. The digest is the fingerprint of the run. Three that
chase each other end on a circle, each with the next one 60 degrees to its left: they turn at
gain pi / 3, so its radius is v / (gain pi / 3), and they are sqrt(3) times as far apart.""",
        """\
print(record.over_message, "-", record.collisions, "collisions")
print("pose", record.pose.shape, "command", record.command.shape)
print("digest", record.digest[:16])

gap = np.hypot(*(record.pose[:, :2] - np.roll(record.pose[:, :2], -1, axis=2)).swapaxes(0, 1))
print(f"apart at the start {gap[0].round(2)} m, at the end {gap[-1].round(2)} m")
print(f"theory: {np.sqrt(3) * 0.3 / (0.5 * np.pi / 3):.2f} m")""",
    ),
    (
        "The same as a **table** of pandas.",
        """\
import pandas as pd

table = pd.read_csv(record.save("chase.csv"))
table.drop(columns="record").head(6)""",
    ),
    ("And as a **figure** of matplotlib, for the report.", "record.plot()"),
    (
        "A **world** is stepped by hand, to look at what a law does: here until 1.5 s...",
        """\
world = World(scenario, chase)
for _ in range(15):
    world.step()
world""",
    ),
    (
        "... and 11 s later. Ask it for anything: poses, readings, contacts.",
        """\
for _ in range(110):
    world.step()
print("t =", round(world.time, 3), "s:", [str(robot.name) for robot in world.robots])
print("something near:", [bool(robot.sense.proximity) for robot in world.robots])
world""",
    ),
    (
        """\
Change the **gain** and compare: two runs, one figure. The higher it is, the smaller is the circle;
where the robots have no room on it, they touch.""",
        """\
figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
for ax, gain in ((left, 0.15), (right, 2.0)):
    run = mars2d.run(scenario, control=partial(chase, gain=gain))
    run.plot(ax)
    ax.set_title(f"gain = {gain}: {run.collisions} collisions")""",
    ),
    (
        "**Save** it: arrays for Python, and one page that plays in any browser.",
        """\
path = record.save("chase.npz")
record.save_html("chase.html")
again = mars2d.load(path)
print(again, again.digest == record.digest)""",
    ),
]
"""What stands before each cell, and its code."""


def written() -> Any:
    """Return the notebook before it is executed."""
    from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

    cells = [new_markdown_cell(INTRODUCTION)]
    for text, code in CELLS:
        cells += [new_markdown_cell(text), new_code_cell(code)]
    for number, cell in enumerate(cells):
        cell.id = f"cell-{number}"  # by chance otherwise
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    return new_notebook(
        cells=cells, metadata={"kernelspec": kernel, "language_info": {"name": "python"}}
    )


def executed(folder: Path) -> Any:
    """Return the notebook with what its cells give, run in a folder, by this very Python."""
    from nbclient import NotebookClient

    notebook = written()
    client = NotebookClient(
        notebook,
        kernel_name="python3",
        timeout=120,
        record_timing=False,
        resources={"metadata": {"path": str(folder)}},
    )
    client.execute()
    notebook.metadata.language_info = {"name": "python"}  # without the version
    for cell in notebook.cells:
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            if "text/plain" in data:  # where it lies in memory
                data["text/plain"] = re.sub(" at 0x[0-9a-f]+", "", data["text/plain"])
    return notebook


def main() -> None:
    """Execute the notebook and write it."""
    import nbformat

    with tempfile.TemporaryDirectory() as folder:
        notebook = executed(Path(folder))
    nbformat.validate(notebook)
    nbformat.write(notebook, TARGET)
    print(f"{TARGET.name}: {TARGET.stat().st_size / 1e3:.0f} kB", file=sys.stderr)


if __name__ == "__main__":
    main()
