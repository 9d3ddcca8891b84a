"""Make the pictures of windows, and of neighbours, that the pages show.

python docs/make/pictures.py [NAME ...]
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace

import numpy as np
import pygame
from matplotlib.figure import Figure

from mars2d import Delaunay, Graph, Nearest, Robot, Scenario, Within, World
from mars2d.addons import Map
from mars2d.bodies import Box
from mars2d.output.raster.layout import fitted
from mars2d.output.raster.picture import Artist, save_png
from mars2d.scenario import open_experiment
from mars2d.scenario.controllers import FollowWall
from mars2d.window.compare_window import CompareWindow
from mars2d.window.editor import Editor
from mars2d.window.editor.draft import Item
from mars2d.window.run.ghosts import ghosts
from mars2d.window.run.grab import Grab
from mars2d.window.run.window import Window
from mars2d.window.screen.looks import Looks
from mars2d.window.screen.source import Trio
from mars2d.world.timeline import Timeline


def canvas(size: tuple[int, int]) -> pygame.Surface:
    """Return an empty picture, (width, height) pixels."""
    return pygame.Surface(size, 0, 32)


def advanced(timeline: Timeline, rows: int) -> Timeline:
    """Advance a run by some control steps."""
    for _ in range(rows):
        timeline.advance()
    return timeline


def save_window(window: Window | CompareWindow, path: Path) -> None:
    """Draw a window into a file."""
    picture = canvas(window.size)
    window.draw(picture)
    save_png(picture, path)


def forces(path: Path) -> None:
    """Draw boxes that are pushed, with forces and the inspector."""
    window = Window(advanced(Timeline(open_experiment("push_box")), 60), size=(1100, 720))
    window.select(1)
    save_window(window, path)


def compare(path: Path) -> None:
    """Draw the three physics side by side."""
    trio = Trio(
        {
            physics: Timeline(open_experiment("many_push_one", {"physics": physics}))
            for physics in ("contact", "stop", "ideal")
        }
    )
    for _ in range(80):
        trio.advance()
    window = CompareWindow(trio)
    window.player.pause()
    save_window(window, path)


def branches(path: Path) -> None:
    """Draw a pursuit in which the evader was moved, and the run before that."""
    timeline = advanced(Timeline(open_experiment("pursuit_voronoi")), 900)
    timeline.go(500)
    timeline.change(lambda world: world.operator.place("blue", (-2.0, 2.5, 0.5)))
    advanced(timeline, 250)
    artist = Artist((1000, 640))
    picture = artist.paint(timeline.frame)
    camera = fitted(timeline.scenario.bounds, artist.size, artist.layout)
    artist.painter.paint(picture, ghosts(timeline, timeline.frame).shapes, camera)
    save_png(picture, path)


def walked(path: Path) -> None:
    """Draw the README's first walk, in which a robot was moved, and the inspector."""
    readme = (Path(__file__).parents[2] / "README.md").read_text("utf-8")
    with TemporaryDirectory() as folder:
        walk = Path(folder) / "walk.py"
        walk.write_text(readme.split("```python\n")[1].split("```")[0], "utf-8")
        timeline = advanced(Timeline(open_experiment(walk)), 280)
        timeline.go(220)
        timeline.change(lambda world: world.operator.place("robot0", (-2.3, 2.4, -2.7)))
        window = Window(advanced(timeline, 45), size=(1280, 720))
        window.player.pause()
        window.select(0)
        save_window(window, path)


def play_roles(path: Path) -> None:
    """Draw a game that asks for its person's role."""
    window = Window(Timeline(open_experiment("corner_game")), size=(1000, 600))
    window.play(())
    save_window(window, path)


def play_end(path: Path) -> None:
    """Draw the end of a bout of two people, of whom red drives straight on and blue waits."""
    timeline = Timeline(open_experiment("sumo"))
    window = Window(timeline, size=(1000, 600))
    window.play((0, 1))
    while window.game.counting:
        window.game.pass_time(0.1)
    while not timeline.over:
        timeline.world.operator.steer("red", (0.4, 0.0))
        timeline.world.operator.steer("blue", (0.0, 0.0))
        timeline.advance()
    window.player.settle()
    window.game.pass_time(0.1)
    save_window(window, path)


def parameters(path: Path) -> None:
    """Draw boxes that are pushed after the floor's friction was dragged to another value."""
    timeline = Timeline(open_experiment("push_box"))
    window = Window(timeline, size=(1280, 840))
    window.dock.open(["parameters"])
    advanced(timeline, 30)
    window.select(6)
    window.director.set("mu", 0.45)
    advanced(timeline, 15)
    window.player.pause()
    save_window(window, path)


def predictions(path: Path) -> None:
    """Draw billiards with its predictions."""
    timeline = Timeline(open_experiment("billiards"))
    window = Window(timeline, size=(1280, 720))
    window.dock.open(["predictions"])
    advanced(timeline, 32)
    window.player.pause()
    for panel in window.dock.panels:
        if panel.name == "predictions":
            panel.look(playing=False)
    save_window(window, path)


def scopes(path: Path) -> None:
    """Draw robots that push each other, with their speeds and forces over time."""
    timeline = Timeline(open_experiment("head_on"))
    window = Window(timeline, size=(1100, 640))
    for what in ("speed", "force"):
        window.dock.scopes.switch(what, range(4))
    advanced(timeline, 120)
    window.player.settle()
    save_window(window, path)


def hands(path: Path) -> None:
    """Draw a crate that somebody pulls."""
    ahead = Robot(controller=lambda _: (0.1, 0.0))
    robots = [ahead.at(-0.8 + 0.5 * k, -0.3 + 0.5 * (k % 3)) for k in range(5)]
    crate = Box(name="crate", pose=(-1.2, -0.9, 0.3), length=0.6, width=0.4, mass=4.0)
    room = [(-2.4, -1.4), (2.4, -1.4), (2.4, 1.4), (-2.4, 1.4)]
    crate = crate.replace(material="wood")
    world = World(Scenario(title="A crate is pulled", robots=robots, props=[crate], workspace=room))
    artist = Artist((1000, 640))
    camera = fitted(world.scenario.bounds, artist.size, artist.layout)
    os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
    pygame.display.init()  # for the keys that are held
    player = SimpleNamespace(playing=True, frame=world.frame)
    view = SimpleNamespace(camera=camera, point_at=lambda at: tuple(camera.to_world([at])[0]))
    mouse = Grab(player, view, [], lambda at: at, lambda act: act(world) or True, {})

    def pixel(x: float, y: float) -> tuple[int, int]:
        return tuple(camera.to_pixels([(x, y)])[0].astype(int))

    mouse.press(pixel(-1.0, -0.8), pygame.BUTTON_LEFT)
    for k in range(12):
        mouse.move(pixel(-0.9 + 0.15 * k, -0.7 + 0.1 * k))
        world.step()
        player.frame = world.frame
    picture = artist.paint(world.frame)
    artist.painter.paint(picture, mouse.marks(world.frame), camera)
    save_png(picture, path)


ROOM = Scenario(
    title="Room",
    robots=[Robot(pose=(-3, -2, 0.8)), Robot(pose=(-3, 1, 0))],
    props=[Box(pose=(0, 2, 0.4), length=1.2, width=0.6)],
    addons=[
        Map(
            [[(0.8, -1.2), (2.6, -1.2), (2.6, 0.4)]],
            walls=[[(-4, -3.5), (4, -3.5), (4, 3.5), (-4, 3.5), (-4, -3.5)]],
        )
    ],
)


def editor(path: Path, drags: tuple[list[tuple[float, float]], ...] = ()) -> None:
    """Draw the editor after drags from point to point, the first a click on the pillar."""
    surface, drawn = canvas((1100, 640)), Editor(ROOM, Looks(), path=Path("room.toml"))
    drawn.draw(surface)
    kinds = pygame.MOUSEBUTTONDOWN, pygame.MOUSEMOTION, pygame.MOUSEBUTTONUP
    for points in ([(2, -0.8)] * 3, *drags):
        for kind, point in zip(kinds, points, strict=True):
            (pixel,) = drawn.viewpoint.camera.to_pixels([point]).round().astype(int).tolist()
            buttons = {"buttons": (1, 0, 0), "rel": (0, 0)}
            drawn.handle(pygame.event.Event(kind, pos=tuple(pixel), button=1, **buttons))
        drawn.draw(surface)
    save_png(surface, path)


def editor_panel(path: Path) -> None:
    """Draw the editor's panel of a robot."""
    follower = ROOM.robots[1].replace(controller=FollowWall(), sensors=FollowWall.needs)
    scenario = ROOM.replace(robots=[ROOM.robots[0], follower])
    surface, drawn = canvas((1100, 640)), Editor(scenario, Looks(), path=Path("room.toml"))
    drawn.draw(surface)
    drawn.desk.select([Item("robot", 1)])
    drawn.draw(surface)
    save_png(surface, path)


def neighbours(path: Path) -> None:
    """Draw four rules of who is whose neighbour."""
    position = np.random.default_rng(526).uniform(0, 4, (2, 12)).round(1)
    position = position[:, np.argsort(np.arctan2(*(position - 2)))]  # round the middle
    ring = np.roll(np.eye(12), 1, axis=1)
    rules = {repr(rule): rule for rule in (Within(1.4), Nearest(2), Delaunay())}
    rules["Graph(ring)"] = Graph(ring + ring.T)
    figure = Figure(figsize=(9, 2.7), layout="constrained")
    for axes, (title, rule) in zip(figure.subplots(1, 4), rules.items(), strict=True):
        found = rule.of(position)
        for i, others in enumerate(found):
            for j in others:
                ends = {"xy": position[:, j], "xytext": position[:, i]}
                arrow = {"arrowstyle": "-" if i in found[j] else "-|>", "color": "#0072b2"}
                axes.annotate("", **ends, arrowprops=arrow | {"shrinkA": 0, "shrinkB": 3})
        axes.plot(*position, "o", color="#d55e00", markersize=6, zorder=3)
        axes.set(aspect="equal", xticks=[], yticks=[], xlim=(-0.3, 4.3), ylim=(-0.3, 4.3))
        axes.set_title(title, fontsize=10)
    figure.savefig(path, dpi=110)


PICTURES = {
    "forces": forces,
    "window_compare": compare,
    "branches": branches,
    "window_branch": walked,
    "play_roles": play_roles,
    "play_end": play_end,
    "parameters": parameters,
    "window_predictions": predictions,
    "scopes": scopes,
    "hands": hands,
    "editor": editor,
    "editor_panel": editor_panel,
    "editor_fault": lambda path: editor(path, ([(-3, 1), (-3, -1.8), (-3, -1.8)],)),
    "neighbours": neighbours,
}

if __name__ == "__main__":
    folder = Path(__file__).parents[1] / "pictures"
    for each in sys.argv[1:] or PICTURES:
        PICTURES[each](folder / f"{each}.png")
