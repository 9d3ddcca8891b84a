"""The editor: draw a scenario with the mouse, on any surface."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from math import radians
from pathlib import Path
from typing import Any

import pygame

from mars2d.core.errors import InputError, Mars2dError
from mars2d.core.plane import Point, rectangle
from mars2d.core.scene import Scene, faded
from mars2d.output.layers.table import Layers
from mars2d.output.raster.bars import Banner, draw_footer, footer_height
from mars2d.output.raster.layout import Layout
from mars2d.output.raster.stage import Stage
from mars2d.output.raster.theme import LIGHT
from mars2d.scenario.scenario import Scenario
from mars2d.window.editor.actions import TOOLS, actions_of
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.dialogs import Dialogs
from mars2d.window.editor.draft import Draft, Item, Motion
from mars2d.window.editor.grips import NOTCH, ring_of
from mars2d.window.editor.properties import Properties
from mars2d.window.editor.tools import MARK, PAPER, Tool, draw_outline
from mars2d.window.screen.looks import Looks
from mars2d.window.screen.viewpoint import Viewpoint, wheel_notches
from mars2d.window.widgets.actions import action_of, label_of
from mars2d.window.widgets.buttons import Buttons
from mars2d.window.widgets.help import Help
from mars2d.window.widgets.menu import Menu
from mars2d.window.widgets.prompt import Answer
from mars2d.window.widgets.rows import Word, minus, width_of, write_line
from mars2d.window.widgets.slider import draw_tooltip

NUDGES = {"←": (-1, 0), "→": (1, 0), "↑": (0, 1), "↓": (0, -1)}
HEADER = ("undo", "redo", "start", "now", "save", "run")
"""The actions with buttons in the header, where they are offered."""
BUTTONS = 0.5
"""The share of the header in which buttons begin; the rest is for the title."""
WIDTH, SIDE = 58.0, 46.0
"""The widths of the toolbar and of its buttons, points."""
TALL, MAX_SHARE, NARROW = 560.0, 0.11, 96.0
"""The height from which on the toolbar has one column, points; its largest share of the window's
width, and the width that it may always have, pixels."""
PANEL, MAX_PANEL, ARENA = 268.0, 0.34, 0.405
"""The width of the panel, points, its largest share of the window's width, and the share of the
window that it leaves to the drawing."""
PANEL_HINT = "Arrows choose a row, Enter opens it, Esc leaves"
IDLE, IDLE_SIZE, RED = LIGHT.waiting.ink, 12.0, LIGHT.error.ink
LAYERS = Layers(trails=False, sensors=False, messages=False)
MAX_NAMED = 40
"""With more robots and props than this, names are hidden at first."""


class Editor:
    """Edits a scenario: handles pygame's events, and draws itself on any surface.

    path: the scenario's file; one that is not .toml only lends its name. live: whether a paused run
    is edited, which can continue with the outcome. control: the team's law, for the file. empty:
    start without robots. changed: the scenario differs from the file. play: runs a file in a window
    that looks as this one does. dialogs: save or apply the draft. names: whether names are shown.
    """

    def __init__(
        self,
        scenario: Scenario,
        looks: Looks,
        *,
        path: Path | None = None,
        live: bool = False,
        control: Callable[[Any], Any] | None = None,
        empty: bool = False,
        changed: bool = False,
        play: Callable[[Path, Looks, Viewpoint], object] = lambda *_: None,
    ) -> None:
        """Open a scenario; nothing is drawn yet."""
        self.looks, self.live, self.help, self._play = looks, live, Help(), play
        painter = self.painter = looks.painter
        draft = Draft(scenario)
        if empty:  # no scenario can be without robots
            draft = draft.without([item for item in draft.items() if item.kind == "robot"])
        self.viewpoint = Viewpoint(draft.sketch, looks.layout((1280, 720)))
        self.desk = Desk(draft, self.viewpoint)
        if changed:
            self.desk.saved = None
        self.menu, self.panel = Menu(), Menu(docked=True)
        self.dialogs = Dialogs(self, path, control)
        self.properties = Properties(self)
        self._stage = Stage(painter)
        self._pointer = (-1, -1)
        self._panning, self._held = False, set[int]()
        self.names = len(draft.base.robots) + len(draft.base.props) <= MAX_NAMED
        self._addons = True  # whether add-ons are drawn
        self.tool_name, self.tool = "", Tool(self.desk)
        self.choose("select")
        self.groups = actions_of(self)
        self._actions = {action.name: action for group in self.groups.values() for action in group}
        tools = [self.groups["Tools"], [self._actions["snap"]]]
        self._toolbar = Buttons(tools, side=SIDE, lettered=True)
        in_header = [self._actions[name] for name in HEADER if name in self._actions]
        self._header = Buttons([in_header])

    @property
    def title(self) -> str:
        """The text of the header."""
        return self.desk.draft.base.title if self.live else self.dialogs.wanted.name

    @property
    def layout(self) -> Layout:
        """The layout."""
        return self.viewpoint.layout

    # -- events ---------------------------------------------------------------------------------

    def handle(self, event: pygame.Event) -> None:
        """Handle an event of pygame."""
        try:
            self._take(event)
        except Mars2dError as error:  # a value that does not go with the others, a run that fails
            self.desk.say(str(error), warns=True)

    def _take(self, event: pygame.Event) -> None:
        self.desk.shift = not self._held.isdisjoint((pygame.K_LSHIFT, pygame.K_RSHIFT))
        if self.menu.handle(event):
            pass
        elif event.type == pygame.QUIT:
            self.dialogs.leave()
        elif event.type == pygame.KEYDOWN:
            if not self.panel.handle(event):
                self._press_key(event)
        elif event.type == pygame.KEYUP:
            self._held.discard(event.key)
        elif event.type == pygame.WINDOWFOCUSLOST:
            self._held.clear()
            self._panning = False
            if self.tool.drag is not None:
                self.tool.cancel()
        elif event.type == pygame.MOUSEWHEEL and self.panel.plate.collidepoint(self._pointer):
            self.panel.handle(event)
        elif event.type == pygame.MOUSEWHEEL:
            self.zoom(wheel_notches(event))
        elif event.type == pygame.MOUSEMOTION:
            self.panel.handle(event)
            self._move(event)
        elif event.type == pygame.MOUSEBUTTONDOWN:
            self._press(event)
        elif event.type == pygame.MOUSEBUTTONUP:
            self._panning = False
            if event.button == pygame.BUTTON_LEFT:
                self.tool.release()

    def _press_key(self, event: pygame.Event) -> None:
        again = event.key in self._held
        self._held.add(event.key)
        action = action_of(event, self._actions.values())
        drags = self.tool.drag is not None and event.key != pygame.K_ESCAPE
        if drags or (again and not (action is not None and action.repeats)):
            return
        if action is None or action.name not in ("help", "escape"):
            self.help.close()
        if event.key in (pygame.K_RETURN, pygame.K_KP_ENTER) and self.tool.confirm():
            return
        if event.key == pygame.K_BACKSPACE and self.tool.back():
            return
        if action is None:
            return
        self.desk.say("")
        dx, dy = NUDGES.get(label_of(event).split()[-1], (0, 0))
        if action.name == "nudge":
            self.desk.nudge(dx, dy)
        elif action.name == "rotate":
            self._turn(-dx)
        elif action.act is not None:
            action.act()

    def _press(self, event: pygame.Event) -> None:
        if self.help.is_open:
            self.help.close()
            return
        self._pointer = event.pos
        self.desk.say("")
        if self.panel.plate.collidepoint(event.pos):
            self.panel.handle(event)
        elif self._toolbar.handle(event) or self._header.handle(event):
            pass
        elif event.button == pygame.BUTTON_MIDDLE or pygame.K_SPACE in self._held:
            self._panning = True
        elif event.button == pygame.BUTTON_LEFT and self.layout.plot.collidepoint(event.pos):
            self.panel.focused = False
            self.tool.press(self._world(event.pos))
        elif event.button == pygame.BUTTON_RIGHT and not self.tool.confirm():
            self.tool.cancel()

    def _move(self, event: pygame.Event) -> None:
        self._pointer = event.pos
        if self._panning:
            self.viewpoint.pan(*event.rel)
        elif self.tool.drag is not None or self.layout.plot.collidepoint(event.pos):
            self.tool.move(self._world(event.pos))
        else:
            self.tool.pointer = None

    def _world(self, pixel: tuple[int, int]) -> Point:
        ((x, y),) = self.viewpoint.camera.to_world([pixel]).tolist()
        return x, y

    # -- tools and changes ----------------------------------------------------------------------

    def choose(self, name: str) -> None:
        """Take up a tool of the toolbar."""
        words, make = next((words, make) for tool, _, words, make, _ in TOOLS if tool == name)
        self.take_up(name, make(self.desk))
        self.tool.hint = f"{words[0].upper()}{words[1:]}"

    def take_up(self, name: str, tool: Tool) -> None:
        """Take up a tool that has been made."""
        self.tool.cancel()
        self.panel.focused = False
        self.tool_name, self.tool = name, tool
        if self.layout.plot.collidepoint(self._pointer):
            self.tool.pointer = self._world(self._pointer)

    def select(self, items: Iterable[Item]) -> None:
        """Take up the arrow, and select items."""
        self.choose("select")
        self.desk.select(items)

    def select_workspace(self) -> None:
        """Select the workspace; make one round all that there is if there is none."""
        draft, item = self.desk.draft, Item("workspace")
        if item not in draft.things:
            self.desk.put(draft.changed({item: rectangle(*draft.sketch.bounds)}))
        self.select([item])

    def select_next(self, *, too: bool = False) -> None:
        """Select the item after that selected last, after the last the first; too: one more."""
        items, chosen = self.desk.draft.items(), self.desk.selection
        place = items.index(chosen[-1]) + 1 if chosen and chosen[-1] in items else 0
        self.select([*chosen * too, *items[place % max(1, len(items)) :][:1]])

    def ask_pose(self) -> None:
        """Ask where to put the selection, or a new item."""
        if self.tool_name == "select" and not self.desk.selection:
            raise InputError("select something first, or choose a tool that places items")
        doc, here = "such as 1.5 2 90, or the name of a thing that is there", self.tool.place
        self.dialogs.ask("x y [degrees] =", Answer("apply", self._put), text=here, doc=doc)

    def _put(self, text: str) -> None:
        """Put the selection, or a new item, at typed numbers or where a thing of a name is."""
        draft = self.desk.draft
        named = {draft.name(item): draft.place(item) for item in draft.items()}
        if text and text == self.tool.place:
            return  # no digit changes
        if text.strip() in named:
            self.tool.put(*named[text.strip()], None)
            return
        try:
            x, y, *rest = map(float, text.replace(",", " ").split())
            (angle,) = rest or (None,)
        except ValueError:
            raise InputError(f"{text!r}: expected x y in metres, x y degrees, or a name") from None
        self.tool.put(x, y, None if angle is None else radians(angle))

    def _turn(self, way: int) -> None:
        """Turn the selection: 1 is counter-clockwise, -1 clockwise; with Shift by one degree."""
        ring, desk = ring_of(self.desk), self.desk
        if ring is None:
            raise InputError("select something that has a direction first")
        motion = Motion(radians(way * (1.0 if desk.shift else NOTCH)), ring.center)
        desk.put(desk.draft.moved(desk.selection, motion), tag="turn")

    def undo(self) -> None:
        """Remove the last corner of the outline being drawn, or else undo the last change."""
        if not self.tool.back():
            self.desk.go(-1)

    def run(self) -> None:
        """Save the file, and run it in a window in the place of this one until that is closed."""
        path = self.dialogs.path
        if path is None or self.desk.changed or self.dialogs.new:
            self.dialogs.save(then=self.run)
            return
        try:
            self._play(path, self.looks, self.viewpoint)
        finally:
            pygame.event.clear()
            self._held.clear()

    # -- the view -------------------------------------------------------------------------------

    def switch_names(self) -> None:
        """Show names, or hide them."""
        self.names = not self.names

    def zoom(self, notches: float) -> None:
        """Zoom about the pointer, or else about the middle, by notches of the wheel."""
        plot = self.layout.plot
        there = plot.collidepoint(self._pointer)
        self.viewpoint.zoom(notches, self._pointer if there else plot.center)

    def _arrange(self, size: tuple[int, int]) -> None:
        """Lay out tools, drawing and panel on a surface of a size, pixels."""
        layout = self.looks.layout(size)
        room, columns = layout.plot.copy(), 1.0 if layout.plot.height >= TALL * layout.ui else 1.6
        left = round(min(columns * WIDTH * layout.ui, max(MAX_SHARE * size[0], NARROW)))
        room.left, room.width = left, max(1, room.width - left)
        free = room.width - ARENA * size[0] * size[1] / room.height
        room.width -= round(max(1, min(PANEL * layout.ui, MAX_PANEL * size[0], free)))
        room.width = max(1, room.width)
        layout, self.painter.ui = replace(layout, plot=room), layout.ui
        if layout != self.layout:  # it does not follow the workspace while that is drawn
            self.viewpoint.arrange(layout, self.desk.draft.sketch)

    def escape(self) -> None:
        """Close the help, leave the tool, select nothing, or go back to the paused run."""
        if self.help.is_open:
            self.help.close()
        elif self.tool.cancel():
            pass
        elif self.tool_name != "select" or self.desk.selection:
            self.select(())
        elif self.live:
            self.dialogs.leave()
        else:
            self.desk.say("Ctrl Q closes the editor")

    # -- drawing --------------------------------------------------------------------------------

    def draw(self, surface: pygame.Surface) -> None:
        """Draw the editor; the layout follows the surface's size."""
        self._arrange(surface.get_size())
        self._draw_plot(surface)
        plot, bar = self.layout.plot, self.layout.header
        left = pygame.Rect(0, bar.bottom, plot.left, plot.height)
        surface.fill(self.painter.theme.bar, left)
        surface.fill(self.painter.theme.edge, (left.right - 1, left.top, 1, left.height))
        self._toolbar.draw(surface, left, self.painter, self._pointer)
        right = pygame.Rect(plot.right, plot.top, surface.get_width() - plot.right, plot.height)
        self.panel.draw(surface, right, self.painter)
        self._draw_header(surface)
        self._draw_foot(surface)
        if self.tool.remark:
            x, y = (each + round(16 * self.layout.ui) for each in self._pointer)
            draw_tooltip(surface, self.painter, self.tool.remark, topleft=(x, y))
        if self.tool.drag is None and not self.help.is_open:
            self._toolbar.draw_tip(surface, self.painter, self._pointer)
        self.menu.draw(surface, surface.get_rect(), self.painter)
        self.help.draw(surface, self.layout, self.painter, self.groups.items())

    def _draw_header(self, surface: pygame.Surface) -> None:
        """Draw the title, what is to be said of it, and buttons at the right as far as they fit."""
        painter, theme, ui = self.painter, self.painter.theme, self.painter.ui
        bar, fonts, pad = self.layout.header, painter.fonts, round(20 * ui)
        surface.fill(theme.bar, bar)
        surface.fill(theme.edge, (bar.left, bar.bottom - 1, bar.width, 1))
        right, places = bar.right - pad, self._header.places
        note = "not saved yet" if self.desk.changed else "new" * self.dialogs.new
        note = "the run is paused" if self.live else note
        places.clear()
        for name in reversed([name for name in HEADER if name in self._actions]):
            action = self._actions[name]
            if right < (1 - BUTTONS) * bar.width:
                break  # the keys have all of them
            first, works = action.lit, action.works
            color = theme.running.ink if first else theme.text if works else theme.key_edge
            wide = fonts.width(action.title, 15 * ui, bold=first) + 22 * ui
            place = places[name] = pygame.Rect(0, 0, round(wide), round(32 * ui))
            place.midright = (right, bar.centery)
            hover = works and place.collidepoint(self._pointer)
            fill = theme.running.pale if first or hover else theme.key
            painter.panel(surface, place, fill, 7 * ui, theme.selected if hover else theme.key_edge)
            painter.write(surface, action.title, 15 * ui, color, bold=first, center=place.center)
            right = place.left - round(8 * ui)
        words = [Word(self.title, theme.ink, 20, bold=True), Word(note, theme.muted, 14)]
        room = pygame.Rect(pad, bar.top, right - pad, bar.height)
        fits = width_of(painter, words) < room.width
        write_line(surface, room, painter, words if fits else words[:1])

    def _draw_plot(self, surface: pygame.Surface) -> None:
        scene, draft = Scene(), self.desk.draft
        for item in self.desk.selection:
            draw_outline(draft, item, scene, PAPER, 4.5)
            draw_outline(draft, item, scene, MARK, 2.2)
        for item in self.desk.settled.verdict.culprits & draft.things.keys():
            draw_outline(draft, item, scene, RED, 3.0, faded(RED, 0.3))
        self.tool.draw(scene)
        if self.names:
            self._draw_remarks(draft, scene)
        layers = LAYERS.switched(names=self.names, addons=self._addons)
        try:
            self._stage.draw(
                surface, draft.frame(), self.viewpoint.camera, layers, self.layout.plot,
                marks=scene.shapes, hurried=self.viewpoint.hurried,
            )  # fmt: skip
        except Mars2dError as error:  # raised by an add-on's drawing
            if not self._addons:
                raise
            self._addons = False
            self.desk.say(f"Add-ons are not drawn: {error}", warns=True)
            self._draw_plot(surface)

    def _draw_remarks(self, draft: Draft, scene: Scene) -> None:
        """Write below each robot what it lacks to be moved, and whether it starts at random."""
        idle = self.properties.idle(draft)
        for i, robot in enumerate(draft.base.robots):
            words = ["at random"] if draft.starts_at_random(Item("robot", i)) else []
            if i in idle:
                words.append("no law" if idle[i] == "a law" else f"lacks {idle[i]}")
            (x, y), radius = robot.rigid.bound
            text, below = ", ".join(words), (x, y - radius)
            if text:
                scene.text(below, text, color=IDLE, size=IDLE_SIZE, anchor="below", halo=PAPER)

    def _draw_foot(self, surface: pygame.Surface) -> None:
        """Draw what to do, or over the foot of the drawing a message of any length."""
        desk, verdict, layout = self.desk, self.desk.settled.verdict, self.layout
        text = PANEL_HINT if self.panel.focused else self.tool.hint
        banner = Banner(desk.notice, error=desk.warns) if desk.notice else None
        if banner is None and verdict.text and desk.draft.base.robots:
            banner = Banner(verdict.text, error=True)
        elif verdict.text and self.tool_name == "select":
            text = verdict.text[:1].upper() + verdict.text[1:]
        hints = [*[("Esc", "leaves")] * self.live, ("F1", "all keys")]
        if layout.plot.collidepoint(self._pointer):
            x, y = desk.snapped(self._world(self._pointer))
            hints = [("", minus(f"x {x:g} m   y {y:g} m"))]
        if self.tool_name != "select" and not self.panel.focused:
            hints = [("=", "types a place"), *hints]
        size, looks = surface.get_size(), self.looks
        points = footer_height(banner, size, self.painter, looks.text, looks.scale)
        height = round(points * layout.ui)
        bar = pygame.Rect(0, layout.footer.bottom - height, size[0], height)
        draw_footer(surface, replace(layout, footer=bar), self.painter, banner, text, hints)
