"""The properties of the selection, as rows of the panel, and how each is changed."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from math import floor, log10
from pathlib import Path
from typing import Any

from mars2d.bodies.joints.base import Joint
from mars2d.core.description import Description
from mars2d.core.errors import InputError, counted
from mars2d.core.files import file_beside
from mars2d.core.materials import Coefficient
from mars2d.core.scene import PALETTE
from mars2d.core.usercode import name_of
from mars2d.scenario import serialize
from mars2d.scenario.code_file import law_in
from mars2d.scenario.controllers import Controller, FollowRobot, FollowWaypoints, standing_still
from mars2d.scenario.law_reference import Reference
from mars2d.scenario.options import parse_option
from mars2d.scenario.registry import members
from mars2d.scenario.robot import Robot
from mars2d.sensors.base import Sensor
from mars2d.window.editor.chrome import Answer, Prompt
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.dialogs import Dialogs
from mars2d.window.editor.document import Document
from mars2d.window.editor.draft import Draft
from mars2d.window.editor.item import Item
from mars2d.window.editor.panel import Row
from mars2d.window.editor.readout import described
from mars2d.window.widgets.menu import Entry, Menu
from mars2d.window.widgets.text_field import TextField

Pixel = tuple[int, int]

SEVERAL = "several"
"""Shown where the selected bodies have different values."""
CHOSEN = "✓"
"""Marks the entry of a menu that holds now."""
BODY = ("mass", "diameter", "length", "width", "friction", "restitution", "ground_friction")
"""The fields of robots and props that have a row."""
TEAM = ("title", "stop_time", "sampling_time", "on_exit", "physics")
"""The fields of a scenario that have a row when nothing is selected."""
COLORS = ("blue", "vermilion", "green", "pink", "orange", "sky blue", "violet", "dark grey")
"""The colours of the palette, in words."""
AUTOMATIC = "automatic"
"""The colour that a body has if it is given none."""
NO_LAW = "none: it stands still"
GIVEN = 0.5
"""The value of a sensor's number that has no default."""
MAX_IDLE = 6
"""The most robots that are listed because they stand still."""


class Properties:
    """The rows about the selection; each opens a menu, or a field to type in.

    choose: takes up a tool by its name. tie: lets a person choose what some items are tied to.
    """

    def __init__(
        self,
        desk: Desk,
        dialogs: Dialogs,
        document: Document,
        menu: Menu,
        choose: Callable[[str], None],
        tie: Callable[[type[Joint], tuple[Item, ...]], None],
    ) -> None:
        """Take the parts of the editor that it works with."""
        self._desk, self._dialogs, self._document = desk, dialogs, document
        self._menu, self._choose, self._tie = menu, choose, tie

    # -- rows -----------------------------------------------------------------------------------

    def rows(self) -> list[Row]:
        """Return the rows about the selection, or about the scenario."""
        if not self._desk.selection:
            return self._rows_of_scenario()
        first, *others = described(self._desk)
        rows = [Row(first, kind="title"), *(Row(line) for line in others)]
        bodies = self._bodies()
        robots = tuple(item for item in bodies if item.kind == "robot")
        if bodies and len(robots) == len(bodies):
            rows += [*self._rows_of_law(robots), *self._rows_of_drive(robots)]
        rows += [*self._rows_of_body(bodies)]
        if robots and len(robots) == len(bodies):
            rows += self._rows_of_sensors(robots)
        return rows + self._rows_of_joints(bodies)

    def _bodies(self) -> tuple[Item, ...]:
        return tuple(item for item in self._desk.selection if item.kind in ("robot", "prop"))

    def _rows_of_scenario(self) -> list[Row]:
        base = self._desk.draft.base
        rows = [Row("The scenario", kind="title")]
        for name in TEAM:
            field = base.__dataclass_fields__[name]
            rows.append(self._row(field, [base], self._set_scenario))
        idle = self.idle(self._desk.draft)
        for i, want in list(idle.items())[:MAX_IDLE]:
            item = Item("robot", i)
            words = f"{self._desk.draft.name(item)} lacks {want}"
            rows.append(Row(words, act=partial(self._select, item), kind="warning"))
        if len(idle) > MAX_IDLE:
            more = counted(len(idle) - MAX_IDLE, "more robot")
            rows.append(Row(f"and {more} that stand still", kind="warning"))
        return rows

    def idle(self, draft: Draft) -> dict[int, str]:
        """Return what each robot of a draft lacks to be moved, by its number."""
        return standing_still(draft.sketch, self._document.control)

    def _rows_of_law(self, robots: tuple[Item, ...]) -> list[Row]:
        draft = self._desk.draft
        laws = [draft.robots[item.number].controller for item in robots]
        title = _alike([self._title_of(law) for law in laws])
        rows = [Row("Law", title, partial(self._offer_laws, robots))]
        kinds = {type(law) for law in laws}
        if len(kinds) == 1 and isinstance(laws[0], Controller):
            change = partial(self._set_part, robots, "controller")
            fields = dataclasses.fields(laws[0])
            rows += [self._row(field, laws, change, level=1) for field in fields]
        idle = self.idle(draft)
        wants = [idle[item.number] for item in robots if item.number in idle]
        if wants:
            rows.append(Row(f"stands still: it lacks {wants[0]}", level=1, kind="warning"))
        return rows

    def _title_of(self, law: object) -> str:
        """Return a law in words."""
        if isinstance(law, Controller):
            return law.title
        if callable(law):
            return name_of(law)
        return "that of the team" if self._document.control is not None else NO_LAW

    def _rows_of_drive(self, robots: tuple[Item, ...]) -> list[Row]:
        drives = [self._desk.draft.robots[item.number].drive for item in robots]
        kind = _alike([type(drive).__name__ for drive in drives])
        speed = drives[0].__dataclass_fields__["max_linear_speed"]
        change = partial(self._set_part, robots, "drive")
        return [
            Row("Drive", kind, partial(self._offer_drives, robots)),
            self._row(speed, drives, change, level=1),
        ]

    def _rows_of_body(self, bodies: tuple[Item, ...]) -> list[Row]:
        if not bodies:
            return []
        parts = [self._desk.draft.value(item) for item in bodies]
        rows = []
        for name in BODY:
            fields = [part.__dataclass_fields__.get(name) for part in parts]
            shaped = any(isinstance(part, Robot) and part.shape is not None for part in parts)
            if fields[0] is not None and all(fields) and not (shaped and name == "diameter"):
                rows.append(self._row(fields[0], parts, partial(self._set_bodies, bodies)))
        colors = [part.color for part in parts]
        words = _alike([_color_in_words(color) for color in colors])
        seen = self._seen_color(bodies[0]) if words != SEVERAL else ""
        return [*rows, Row("Colour", words, partial(self._offer_colors, bodies), color=seen)]

    def _seen_color(self, item: Item) -> str:
        """Return the colour in which a body is drawn."""
        draft = self._desk.draft
        if item.kind == "robot":
            return draft.sketch.colors[item.number]
        return draft.props[item.number].color or ""

    def _rows_of_sensors(self, robots: tuple[Item, ...]) -> list[Row]:
        rows = [Row("Sensors", "add one", partial(self._offer_new_sensors, robots))]
        carried = [self._desk.draft.robots[item.number].sensors for item in robots]
        for sensor in carried[0]:
            if all(any(each.key == sensor.key for each in sensors) for sensors in carried):
                act = partial(self._offer_sensor, robots, sensor.key)
                rows.append(Row(sensor.key, type(sensor).__name__, act, level=1))
        return rows

    def _rows_of_joints(self, bodies: tuple[Item, ...]) -> list[Row]:
        if not bodies:
            return []
        rows = [Row("Joints", "add one", partial(self._offer_new_joints, bodies))]
        if len(bodies) == 1:
            name = self._desk.draft.value(bodies[0]).name
            for joint in self._desk.draft.joints_of(bodies[0]):
                other = joint.b if joint.a == name else joint.a
                words = f"{type(joint).__name__} to {other or 'the floor'}"
                rows.append(Row(words, act=partial(self._offer_joint, joint), level=1))
        return rows

    def _row(
        self,
        field: dataclasses.Field[Any],
        parts: Sequence[Any],
        change: Callable[..., None],
        level: int = 0,
    ) -> Row:
        """Return the row of a field of some parts; change: sets it by name and value."""
        values = [getattr(part, field.name) for part in parts]
        act = partial(self._ask, field, parts, change)
        numeric = all(isinstance(v, float | int) and not isinstance(v, bool) for v in values)
        step = partial(self._step, field.name, values[0], change) if numeric else None
        words = _alike([_in_words(value, field.metadata.get("unit", "")) for value in values])
        title = _title(field.name)
        return Row(title if level else title.capitalize(), words, act, step, level=level)

    # -- asking ---------------------------------------------------------------------------------

    def _ask(
        self,
        field: dataclasses.Field[Any],
        parts: Sequence[Any],
        change: Callable[..., None],
        pixel: Pixel,
    ) -> None:
        """Let a person change a field: by a menu of its values, or by typing."""
        value, choices = getattr(parts[0], field.name), self._choices(field, parts[0])
        if isinstance(value, bool):
            change(field.name, not value)
        elif choices:
            entries = [
                Entry(
                    _in_words(each),
                    partial(change, field.name, each),
                    value=CHOSEN * (each == value),
                )
                for each in choices
            ]
            self._open(_title(field.name), entries, pixel)
        else:
            unit = field.metadata.get("unit", "")
            label = f"{_title(field.name)}{f' [{unit}]' if unit else ''} ="
            text = repr(value) if isinstance(value, float) else _in_words(value)
            self._type(label, field.metadata.get("doc", ""), text, field.name, change)

    def _choices(self, field: dataclasses.Field[Any], part: Any) -> Sequence[Any]:
        """Return the values that a field may have, if they are few."""
        draft, chosen = self._desk.draft, {item.number for item in self._bodies()}
        if isinstance(part, FollowRobot) and field.name == "leader":
            return [None, *(r.name for i, r in enumerate(draft.robots) if i not in chosen)]
        if isinstance(part, Controller) and field.name == "sensor":
            return [sensor.key for i in chosen for sensor in draft.robots[i].sensors]
        choices: Sequence[Any] = field.metadata.get("of", ())
        return choices

    def _type(
        self, label: str, doc: str, text: str, name: str, change: Callable[..., None]
    ) -> None:
        """Ask for a value by a field to type in."""

        def answer(typed: str) -> None:
            _, value = parse_option(f"{name}={typed}")
            change(name, None if value in ("", "none") else value)
            self._prompted()

        field = TextField(text)
        field.select_all()
        enter = Answer("Enter", "apply", answer)
        self._dialogs.prompt = Prompt(label, enter, field=field, doc=doc)

    def _prompted(self) -> None:
        """Clear the last message."""
        self._desk.say("")

    def _step(self, name: str, value: float, change: Callable[..., None], way: int) -> None:
        """Change a number by half a power of ten that fits it."""
        if isinstance(value, int):
            changed: float = value + way
        else:
            size = abs(value) * (1 if way > 0 else 0.999)
            step = 0.5 * 10.0 ** floor(log10(size)) if size else 0.1
            changed = round((value + way * step) / step) * step
        try:
            change(name, round(changed, 12))
        except InputError as error:
            self._desk.say(str(error), warns=True)

    def _open(self, title: str, entries: Sequence[Entry], pixel: Pixel) -> None:
        listed = [Entry(title), *entries]
        self._menu.open(title, lambda: listed, pixel)

    def _select(self, item: Item, _: Pixel) -> None:
        self._desk.select([item])

    # -- laws -----------------------------------------------------------------------------------

    def _offer_laws(self, robots: tuple[Item, ...], pixel: Pixel) -> None:
        now = {type(self._desk.draft.robots[item.number].controller) for item in robots}
        entries = []
        for kind in members("controllers").values():
            assert issubclass(kind, Controller)
            mark = CHOSEN if now == {kind} else ""
            act = partial(self._give_law, robots, kind, pixel)
            entries.append(Entry(kind.title, act, value=mark))
        entries.append(Entry("from a file …", partial(self._ask_for_file, robots)))
        without = "as the team's law says" if self._document.control is not None else NO_LAW
        mark = CHOSEN if now == {type(None)} else ""
        stop = partial(self._set_bodies, robots, "controller", None)
        entries.append(Entry(without, stop, value=mark))
        self._open("Law", entries, pixel)

    def _give_law(self, robots: tuple[Item, ...], kind: type[Controller], pixel: Pixel) -> None:
        """Give robots a ready-made law, with the sensors that it needs."""

        def change(robot: Robot) -> Robot:
            carried = {sensor.key for sensor in robot.sensors}
            added = [sensor for sensor in kind.needs if sensor.key not in carried]
            return robot.replace(controller=kind(), sensors=[*robot.sensors, *added])

        self._desk.put(self._desk.draft.with_members(robots, change))
        needs = " and ".join(sensor.key for sensor in kind.needs)
        if kind is FollowWaypoints and self.idle(self._desk.draft).get(robots[0].number):
            self._choose("waypoint")
            self._desk.say("click its waypoints, one after the other")
        elif kind is FollowRobot and len(self._desk.draft.robots) > len(robots):
            law = self._desk.draft.robots[robots[0].number].controller
            field = FollowRobot.__dataclass_fields__["leader"]
            self._ask(field, [law], partial(self._set_part, robots, "controller"), pixel)
        elif needs:
            self._desk.say(f"it goes by its sensor {needs}")

    def _ask_for_file(self, robots: tuple[Item, ...]) -> None:
        def change(_: str, typed: object) -> None:
            reference = Reference.read("law", typed)
            beside = self._document.path or Path("scenario.toml")
            file = file_beside(Path(reference.file), beside, "a law", [".py"])
            # Each robot gets the law loaded again, so that robots share nothing.
            self._desk.put(
                self._desk.draft.with_members(
                    robots, lambda robot: robot.replace(controller=law_in(file, reference.name))
                )
            )

        doc = "a file of Python and a function in it, such as walk.py:walk"
        self._type("Law =", doc, "", "law", change)

    # -- drives, colours, sensors, joints -------------------------------------------------------

    def _offer_drives(self, robots: tuple[Item, ...], pixel: Pixel) -> None:
        drives = [self._desk.draft.robots[item.number].drive for item in robots]
        kinds = {type(drive) for drive in drives}

        def take(kind: type[Description]) -> None:
            def change(robot: Robot) -> Robot:
                known = kind.__dataclass_fields__
                kept = {k: v for k, v in serialize.changed(robot.drive).items() if k in known}
                return robot.replace(drive=kind(**kept))

            self._desk.put(self._desk.draft.with_members(robots, change))

        entries = [
            Entry(name, partial(take, kind), value=CHOSEN * (kinds == {kind}))
            for name, kind in members("bodies").items()
        ]
        if len(kinds) == 1:
            change = partial(self._set_part, robots, "drive")
            entries += [Entry("Fields"), *self._entries(drives, change, pixel)]
        self._open("Drive", entries, pixel)

    def _entries(
        self, parts: Sequence[Description], change: Callable[..., None], pixel: Pixel
    ) -> Iterable[Entry]:
        """Return an entry for each field of some parts of one kind."""
        for field in dataclasses.fields(parts[0]):
            row = self._row(field, parts, change)
            if row.act is not None and _is_plain(getattr(parts[0], field.name)):
                yield Entry(row.title, partial(row.act, pixel), value=row.value)

    def _offer_colors(self, bodies: tuple[Item, ...], pixel: Pixel) -> None:
        entries = [
            Entry(words, partial(self._set_bodies, bodies, "color", color), colors=[color])
            for words, color in zip(COLORS, PALETTE, strict=True)
        ]
        field = self._desk.draft.value(bodies[0]).__dataclass_fields__["color"]
        parts = [self._desk.draft.value(item) for item in bodies]
        other = partial(self._ask, field, parts, partial(self._set_bodies, bodies), pixel)
        entries.append(Entry("another …", other))
        entries.append(Entry(AUTOMATIC, partial(self._set_bodies, bodies, "color", None)))
        self._open("Colour", entries, pixel)

    def _offer_new_sensors(self, robots: tuple[Item, ...], pixel: Pixel) -> None:
        def add(kind: type[Description]) -> None:
            needed = {f.name: GIVEN for f in dataclasses.fields(kind) if _is_needed(f)}

            def change(robot: Robot) -> Robot:
                sensor = kind(**needed)
                assert isinstance(sensor, Sensor)
                taken = {each.key for each in robot.sensors}
                names = (f"{sensor.key}{k}" for k in range(2, len(taken) + 3))
                if sensor.key in taken:
                    sensor = sensor.replace(name=next(n for n in names if n not in taken))
                return robot.replace(sensors=[*robot.sensors, sensor])

            self._desk.put(self._desk.draft.with_members(robots, change))

        kinds = members("sensors").items()
        self._open("Add a sensor", [Entry(n, partial(add, kind)) for n, kind in kinds], pixel)

    def _offer_sensor(self, robots: tuple[Item, ...], key: str, pixel: Pixel) -> None:
        """Open the menu of a sensor's fields."""
        draft = self._desk.draft
        sensors = [draft.robots[item.number].sensor(key) for item in robots]
        kind = type(sensors[0])

        def put(change: Callable[[Sensor], list[Sensor]]) -> None:
            def changed(robot: Robot) -> Robot:
                listed = [change(s) if s.key == key else [s] for s in robot.sensors]
                return robot.replace(sensors=[sensor for part in listed for sensor in part])

            self._desk.put(self._desk.draft.with_members(robots, changed))

        def set_field(name: str, value: object) -> None:
            put(lambda sensor: [sensor.replace(**{name: value})])

        entries = [Entry("Remove it", partial(put, lambda _: []))]
        found = [sensor for sensor in sensors if sensor is not None]
        if all(type(sensor) is kind for sensor in found):
            entries += [Entry("Fields"), *self._entries(found, set_field, pixel)]
        self._open(key, entries, pixel)

    def _offer_new_joints(self, bodies: tuple[Item, ...], pixel: Pixel) -> None:
        entries = [
            Entry(name, partial(self._tie, kind, bodies))  # type: ignore[arg-type]
            for name, kind in members("joints").items()
        ]
        self._open("Tie it by a", entries, pixel)

    def _offer_joint(self, joint: Joint, pixel: Pixel) -> None:
        """Open the menu of a joint's fields."""

        def change(name: str, value: object) -> None:
            draft = self._desk.draft
            self._desk.put(draft.with_joint(joint.replace(**{name: value}), instead=joint))

        def remove() -> None:
            self._desk.put(self._desk.draft.with_joint(None, instead=joint))

        entries = [Entry("Remove it", remove), Entry("Fields")]
        entries += self._entries([joint], change, pixel)
        self._open(type(joint).__name__, entries, pixel)

    # -- changes --------------------------------------------------------------------------------

    def _set_scenario(self, name: str, value: object) -> None:
        draft = self._desk.draft
        base = draft.base.replace(**{name: value})
        self._desk.put(dataclasses.replace(draft, base=base))

    def _set_bodies(self, bodies: tuple[Item, ...], name: str, value: object) -> None:
        """Set a field of bodies."""
        change = self._desk.draft.with_members(bodies, lambda body: body.replace(**{name: value}))
        self._desk.put(change)

    def _set_part(self, robots: tuple[Item, ...], part: str, name: str, value: object) -> None:
        """Set a field of a part of robots, such as their drive."""

        def change(robot: Robot) -> Robot:
            return robot.replace(**{part: getattr(robot, part).replace(**{name: value})})

        self._desk.put(self._desk.draft.with_members(robots, change))


def _alike(words: Sequence[str]) -> str:
    """Return the words that are the same for all parts, or that they are several."""
    return words[0] if len({*words}) == 1 else SEVERAL


def _title(name: str) -> str:
    """Return a field's name in words."""
    return name.replace("_", " ")


def _in_words(value: object, unit: str = "") -> str:
    """Return a value as it is shown, and as it can be typed if there is no unit."""
    if value is None:
        return "none"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, Coefficient):
        return value.material
    if isinstance(value, float):
        return f"{value:.4g} {unit}".strip()
    return f"{value} {unit}".strip() if isinstance(value, int) else str(value)


def _color_in_words(color: str | None) -> str:
    if color is None:
        return AUTOMATIC
    return COLORS[PALETTE.index(color)] if color in PALETTE else color


def _is_plain(value: object) -> bool:
    """Return whether a value can be typed: no part, and no function."""
    if isinstance(value, tuple):
        return all(isinstance(each, float | int | str) for each in value)
    return value is None or isinstance(value, bool | float | int | str)


def _is_needed(field: dataclasses.Field[Any]) -> bool:
    missing = dataclasses.MISSING
    return field.default is missing and field.default_factory is missing
