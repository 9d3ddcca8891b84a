"""The properties of the selection, as rows of the panel, and how each is changed."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from mars2d.bodies.joints.base import Joint
from mars2d.core.description import Description, schema_of
from mars2d.core.errors import counted
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
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.base import Sensor
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.dialogs import Dialogs
from mars2d.window.editor.document import Document
from mars2d.window.editor.draft import Draft
from mars2d.window.editor.item import Item
from mars2d.window.editor.readout import described, minus
from mars2d.window.widgets.menu import Entry, Menu
from mars2d.window.widgets.prompt import Answer
from mars2d.window.widgets.text_field import TextField

Items = tuple[Item, ...]
Field = dataclasses.Field[Any]

SEVERAL = "several"
"""Shown where the selected bodies have different values."""
CHOSEN = "✓"
"""Marks the entry of a menu that holds now."""
BODY = ("mass", "diameter", "length", "width", "friction", "restitution", "ground_friction")
"""The fields of robots and props that have a row of their own."""
ELSEWHERE = ("name", "color", "pose", "shape", "controller", "a", "b", "workspace")
"""The fields that are changed in other ways."""
COLORS = ("blue", "vermilion", "green", "pink", "orange", "sky blue", "violet", "dark grey")
"""The colours of the palette, in words."""
AUTOMATIC = "automatic"
"""What a value is called that follows from others, or that nobody has given."""
NO_LAW = "none: it stands still"
GIVEN = 0.5
"""The value of a sensor's number that has no default."""
MAX_IDLE = 6
"""The most robots that are listed because they stand still."""


class Subject(NamedTuple):
    """Parts of the drawing that are shown and changed together, such as the drives of robots.

    change: puts what a function returns in the place of each part.
    """

    parts: Sequence[Any]
    change: Callable[[Callable[[Any], Any]], None]

    def set(self, name: str, value: object) -> None:
        """Set a field."""
        self.change(lambda part: part.replace(**{name: value}))

    def part(self, name: str) -> Subject:
        """Return a part of each, such as their drives."""
        parts = [getattr(whole, name) for whole in self.parts]
        return Subject(
            parts, lambda f: self.change(lambda r: r.replace(**{name: f(getattr(r, name))}))
        )

    @property
    def fields(self) -> dict[str, Field]:
        """The fields that all parts have, by their names."""
        known = [{field.name: field for field in dataclasses.fields(part)} for part in self.parts]
        return {name: f for name, f in known[0].items() if all(name in each for each in known)}

    @property
    def plain(self) -> list[str]:
        """The names of the fields that can be typed or chosen."""
        return [
            name
            for name in self.fields
            if name not in ELSEWHERE and all(_is_plain(getattr(p, name)) for p in self.parts)
        ]

    def in_words(self, name: str) -> str:
        """Return a field's value in words."""
        return _alike([_shown(part, self.fields[name]) for part in self.parts])


class Properties:
    """The rows about the selection; each opens a menu, or a field to type in.

    panel: shows them. menu: opens below one of them. choose: takes up a tool by its name. tie: lets
    a person choose what some items are tied to. touch: asks where a corner of the selection lies.
    """

    def __init__(
        self,
        desk: Desk,
        dialogs: Dialogs,
        document: Document,
        menu: Menu,
        panel: Menu,
        choose: Callable[[str], None],
        tie: Callable[[type[Joint], Items], None],
        touch: Callable[[int], None],
    ) -> None:
        """Take the parts of the editor that it works with."""
        self._desk, self._dialogs, self._document = desk, dialogs, document
        self._menu, self._panel = menu, panel
        self._choose, self._tie, self._touch = choose, tie, touch
        panel.open("properties", self.rows, (0, 0), stays=True)

    # -- subjects -------------------------------------------------------------------------------

    def _scenario(self) -> Subject:
        draft, put = self._desk.draft, self._desk.put
        names = Subject([draft.base], lambda _: None).plain
        alone = Scenario(workspace=None, **{name: getattr(draft.base, name) for name in names})

        def change(f: Callable[[Scenario], Scenario]) -> None:
            changed = f(alone)  # checked without the bodies, which may not go together yet
            put(draft.with_base(**{name: getattr(changed, name) for name in names}))

        return Subject([alone], change)

    def _members(self, items: Items) -> Subject:
        draft, put = self._desk.draft, self._desk.put
        parts = [draft.value(item) for item in items]
        return Subject(parts, lambda f: put(draft.with_members(items, f)))

    def _sensors(self, robots: Items, key: str) -> Subject:
        """Return the sensors of robots with a name; a change to None removes them."""
        whole = self._members(robots)

        def changed(f: Callable[[Sensor], Sensor | None], robot: Robot) -> Robot:
            found = (f(sensor) if sensor.key == key else sensor for sensor in robot.sensors)
            return robot.replace(sensors=[sensor for sensor in found if sensor is not None])

        parts = [robot.sensor(key) for robot in whole.parts]
        return Subject(parts, lambda f: whole.change(partial(changed, f)))

    def _joint(self, joint: Joint) -> Subject:
        draft, put = self._desk.draft, self._desk.put
        return Subject([joint], lambda f: put(draft.with_joint(f(joint), instead=joint)))

    def _named(self, item: Item) -> Subject:
        """Return a body whose new name is put wherever the old one is mentioned."""
        draft, put = self._desk.draft, self._desk.put
        body = draft.value(item)
        return Subject([body], lambda f: put(draft.renamed(item, (f(body).name or "").strip())))

    # -- rows -----------------------------------------------------------------------------------

    def rows(self) -> list[Entry]:
        """Return the rows about the selection, or about the scenario."""
        if not self._desk.selection:
            return self._rows_of_scenario()
        first, *others = described(self._desk)
        rows = [Entry(first), *(Entry(line, tone="note") for line in others)]
        bodies = tuple(item for item in self._desk.selection if item.kind in ("robot", "prop"))
        robots = tuple(item for item in bodies if item.kind == "robot")
        if not bodies:
            return [*rows, *self._rows_of_corners()]
        if robots == bodies:
            rows += [*self._rows_of_law(robots), *self._rows_of_drive(robots)]
        rows += self._rows_of_body(bodies)
        if robots == bodies:
            rows += self._rows_of_sensors(robots)
        return rows + self._rows_of_joints(bodies)

    def _rows_of_scenario(self) -> list[Entry]:
        draft, team = self._desk.draft, self._scenario()
        rows = [Entry("The scenario"), *(self._row(team, name) for name in team.plain)]
        idle = self.idle(draft)
        for i, want in list(idle.items())[:MAX_IDLE]:
            words, select = f"{draft.robots[i].name} lacks {want}", self._desk.select
            rows.append(Entry(words, partial(select, [Item("robot", i)]), tone="warning"))
        if len(idle) > MAX_IDLE:
            more = counted(len(idle) - MAX_IDLE, "more robot")
            rows.append(Entry(f"and {more} that stand still", tone="warning"))
        return rows

    def idle(self, draft: Draft) -> dict[int, str]:
        """Return what each robot of a draft lacks to be moved, by its number."""
        return standing_still(draft.sketch, self._document.control)

    def _rows_of_corners(self) -> list[Entry]:
        item = self._desk.only
        corners = None if item is None else self._desk.draft.corners(item)
        return [
            Entry(f"Corner {k}", partial(self._touch, k), value=minus(f"{x:.4g}, {y:.4g} m"))
            for k, (x, y) in enumerate(corners or ())
        ]

    def _rows_of_law(self, robots: Items) -> list[Entry]:
        laws = self._members(robots).part("controller")
        title = _alike([self._title_of(law) for law in laws.parts])
        rows = [Entry("Law", partial(self._offer_laws, robots), value=title)]
        if isinstance(laws.parts[0], Controller) and len({*map(type, laws.parts)}) == 1:
            rows += [self._row(laws, name, level=1) for name in laws.fields]
        idle = self.idle(self._desk.draft)
        wants = [idle[item.number] for item in robots if item.number in idle]
        if wants:
            rows.append(Entry(f"stands still: it lacks {wants[0]}", level=1, tone="warning"))
        return rows

    def _title_of(self, law: object) -> str:
        """Return a law in words."""
        if isinstance(law, Controller):
            return law.title
        if callable(law):
            return name_of(law)
        return "that of the team" if self._document.control is not None else NO_LAW

    def _rows_of_drive(self, robots: Items) -> list[Entry]:
        drives = self._members(robots).part("drive")
        kind = _alike([type(drive).__name__ for drive in drives.parts])
        return [
            Entry("Drive", partial(self._offer_drives, drives), value=kind),
            self._row(drives, "max_linear_speed", level=1),
        ]

    def _rows_of_body(self, bodies: Items) -> list[Entry]:
        owners = self._members(bodies)
        shaped = any(getattr(part, "shape", None) is not None for part in owners.parts)
        rows = [
            self._row(owners, name)
            for name in BODY
            if name in owners.fields
            and not (name == "diameter" and shaped and bodies[0].kind == "robot")
        ]
        known = dict(zip(PALETTE, COLORS, strict=True))
        words = _alike([known.get(part.color, part.color or AUTOMATIC) for part in owners.parts])
        seen = [part.color for part in owners.parts[:1] if part.color and words != SEVERAL]
        if bodies[0].kind == "robot" and words == AUTOMATIC:
            seen = [self._desk.draft.sketch.colors[bodies[0].number]]
        color = partial(self._offer_colors, owners)
        rows.append(Entry("Colour", color, value=words, colors=seen))
        if len(bodies) == 1:
            rows.insert(0, self._row(self._named(bodies[0]), "name"))
        more = partial(self._open, "More", list(self._fields(owners, BODY)))
        return [*rows, Entry("More", more, value="all other fields")]

    def _rows_of_sensors(self, robots: Items) -> list[Entry]:
        rows = [Entry("Sensors", partial(self._offer_new_sensors, robots), value="add one")]
        first, *others = (self._desk.draft.robots[item.number] for item in robots)
        for sensor in first.sensors:
            if all(robot.sensor(sensor.key) for robot in others):
                act = partial(self._offer_part, sensor.key, self._sensors(robots, sensor.key))
                rows.append(Entry(sensor.key, act, value=type(sensor).__name__, level=1))
        return rows

    def _rows_of_joints(self, bodies: Items) -> list[Entry]:
        rows = [Entry("Joints", partial(self._offer_new_joints, bodies), value="add one")]
        if len(bodies) == 1:
            name = self._desk.draft.name(bodies[0])
            for joint in self._desk.draft.joints_of(bodies[0]):
                kind, other = type(joint).__name__, joint.b if joint.a == name else joint.a
                act = partial(self._offer_part, kind, self._joint(joint))
                rows.append(Entry(f"{kind} to {other or 'the floor'}", act=act, level=1))
        return rows

    def _row(self, subject: Subject, name: str, level: int = 0) -> Entry:
        """Return the row of a field."""
        title, act = _title(name), partial(self._ask, subject, name)
        title = title if level else title.capitalize()
        return Entry(title, act, value=subject.in_words(name), level=level)

    # -- asking ---------------------------------------------------------------------------------

    def _ask(self, subject: Subject, name: str) -> None:
        """Let a person change a field: by a menu of its values, or by typing."""
        field, part = subject.fields[name], subject.parts[0]
        value, choices = getattr(part, name), self._choices(field)
        if isinstance(value, bool):
            subject.set(name, not value)
        elif choices:
            give = partial(subject.set, name)
            self._offer(_title(name), {_in_words(each): each for each in choices}, give, value)
        else:
            unit = field.metadata.get("unit", "")
            label = f"{_title(name)}{f' [{unit}]' if unit else ''} ="
            exact = isinstance(value, float) and not isinstance(value, Coefficient)
            text = repr(value) if exact else _in_words(value)
            doc = field.metadata.get("doc", "")
            self._type(label, doc, text, lambda typed: subject.set(name, _typed(field, typed)))

    def _choices(self, field: Field) -> Sequence[Any]:
        """Return the values that a field may have, if they are few."""
        robots = self._desk.draft.robots
        chosen = {item.number for item in self._desk.selection if item.kind == "robot"}
        mentions = field.metadata.get("names")
        if mentions == "robot" and schema_of(field).get("type") == "string":
            return [None, *(r.name for i, r in enumerate(robots) if i not in chosen)]
        if mentions == "sensor":
            return [sensor.key for i in chosen for sensor in robots[i].sensors]
        words = schema_of(field).get("enum", [])
        return [None, *words] if words and field.default is None else words

    def _type(self, label: str, doc: str, text: str, take: Callable[[str], None]) -> None:
        """Ask for a value by a field to type in."""

        def answer(typed: str) -> None:
            take(typed)
            self._desk.say("")

        field = TextField(text)
        field.select_all()
        self._dialogs.ask(label, Answer("apply", answer), field=field, doc=doc)

    def _open(self, title: str, entries: Sequence[Entry]) -> None:
        listed = [Entry(title), *entries]
        self._menu.open(title, lambda: listed, self._panel.below)

    def _offer(
        self,
        title: str,
        choices: Mapping[str, Any],
        give: Callable[[Any], object],
        now: object = None,
        more: Sequence[Entry] = (),
    ) -> None:
        """Open a menu of choices, by their words; now: the present one."""
        entries = [
            Entry(words, partial(give, each), value=CHOSEN * (each == now))
            for words, each in choices.items()
        ]
        self._open(title, [*entries, *more])

    def _fields(self, subject: Subject, but: Sequence[str] = ()) -> Iterator[Entry]:
        """Return an entry for each field that can be typed."""
        for name in subject.plain:
            if name not in but:
                act = partial(self._ask, subject, name)
                yield Entry(_title(name).capitalize(), act, value=subject.in_words(name))

    def _offer_part(self, title: str, subject: Subject) -> None:
        """Open the menu of a part that can be removed."""
        entries = [Entry("Remove it", partial(subject.change, lambda _: None))]
        if len({*map(type, subject.parts)}) == 1:
            entries += [Entry("Fields"), *self._fields(subject)]
        self._open(title, entries)

    # -- laws -----------------------------------------------------------------------------------

    def _offer_laws(self, robots: Items) -> None:
        owners = self._members(robots)
        now = _only({type(robot.controller) for robot in owners.parts})
        laws: list[Any] = [*members("controllers").values()]
        without = "as the team's law says" if self._document.control is not None else NO_LAW
        stop = partial(owners.set, "controller", None)
        more = [
            Entry("from a file …", partial(self._ask_for_file, owners)),
            Entry(without, stop, value=CHOSEN * (now is type(None))),
        ]
        titled = {law.title: law for law in laws}
        self._offer("Law", titled, partial(self._give_law, robots), now, more)

    def _give_law(self, robots: Items, kind: type[Controller]) -> None:
        """Give robots a ready-made law, with the sensors that it needs."""

        def change(robot: Robot) -> Robot:
            carried = {sensor.key for sensor in robot.sensors}
            added = [sensor for sensor in kind.needs if sensor.key not in carried]
            return robot.replace(controller=kind(), sensors=[*robot.sensors, *added])

        self._members(robots).change(change)
        needs = " and ".join(sensor.key for sensor in kind.needs)
        if kind is FollowWaypoints and self.idle(self._desk.draft).get(robots[0].number):
            self._choose("waypoint")
            self._desk.say("click its waypoints, one after the other")
        elif kind is FollowRobot and len(self._desk.draft.robots) > len(robots):
            self._ask(self._members(robots).part("controller"), "leader")
        elif needs:
            self._desk.say(f"it goes by its sensor {needs}")

    def _ask_for_file(self, robots: Subject) -> None:
        def take(typed: str) -> None:
            reference = Reference.read("law", typed)
            beside = self._document.path or Path("scenario.toml")
            file = file_beside(Path(reference.file), beside, "a law", [".py"])
            # Each robot gets the law loaded again, so that robots share nothing.
            robots.change(lambda robot: robot.replace(controller=law_in(file, reference.name)))

        doc = "a file of Python and a function in it, such as walk.py:walk"
        self._type("Law =", doc, "", take)

    # -- drives, colours, sensors, joints -------------------------------------------------------

    def _offer_drives(self, drives: Subject) -> None:
        now = _only({type(drive) for drive in drives.parts})

        def give(kind: type[Description]) -> None:
            def taken(drive: Description) -> Description:
                known, given = kind.__dataclass_fields__, serialize.changed(drive)
                return kind(**{k: v for k, v in given.items() if k in known})

            drives.change(taken)

        fields = [] if now is None else [Entry("Fields"), *self._fields(drives)]
        self._offer("Drive", members("bodies"), give, now, fields)

    def _offer_colors(self, bodies: Subject) -> None:
        entries = [
            Entry(words, partial(bodies.set, "color", color), colors=[color])
            for words, color in zip(COLORS, PALETTE, strict=True)
        ]
        entries.append(Entry("another …", partial(self._ask, bodies, "color")))
        entries.append(Entry(AUTOMATIC, partial(bodies.set, "color", None)))
        self._open("Colour", entries)

    def _offer_new_sensors(self, robots: Items) -> None:
        def added(kind: type[Any], robot: Robot) -> Robot:
            needed = (
                f.name
                for f in dataclasses.fields(kind)
                if f.default is f.default_factory is dataclasses.MISSING
            )
            sensor = kind(**dict.fromkeys(needed, GIVEN))
            taken = {each.key for each in robot.sensors}
            if sensor.key in taken:
                names = (f"{sensor.key}{k}" for k in range(2, len(taken) + 3))
                sensor = sensor.replace(name=next(n for n in names if n not in taken))
            return robot.replace(sensors=[*robot.sensors, sensor])

        def give(kind: type[Any]) -> None:
            self._members(robots).change(partial(added, kind))

        self._offer("Add a sensor", members("sensors"), give)

    def _offer_new_joints(self, bodies: Items) -> None:
        self._offer("Tie it by a", members("joints"), lambda kind: self._tie(kind, bodies))


def _alike(words: Sequence[str]) -> str:
    """Return the words that are the same for all parts, or that they are several."""
    return words[0] if len({*words}) == 1 else SEVERAL


def _only(kinds: set[type]) -> type | None:
    """Return the kind of all parts, None if they are of several."""
    return kinds.pop() if len(kinds) == 1 else None


def _title(name: str) -> str:
    """Return a field's name in words."""
    return name.replace("_", " ")


def _shown(part: object, field: Field) -> str:
    """Return a field's value in words; in place of None the value that follows from others."""
    value, unit = getattr(part, field.name), field.metadata.get("unit", "")
    if value is not None or "None: " not in field.metadata.get("doc", ""):
        return _in_words(value, unit)
    wholes = (getattr(part, name, None) for name in ("inertia", "surface"))
    found = (getattr(whole, field.name, None) for whole in wholes)
    follows = next((each for each in found if each is not None), None)
    return AUTOMATIC if follows is None else f"{AUTOMATIC} ({_in_words(follows, unit)})"


def _typed(field: Field, text: str) -> object:
    """Return the value of a field that was typed: as text, or as a number, a tuple, a word."""
    if field.default is None and text.strip().lower() in ("", "none", AUTOMATIC):
        return None
    as_text = schema_of(field).get("type") == "string"
    return text if as_text else parse_option(f"{field.name}={text}")[1]


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


def _is_plain(value: object) -> bool:
    """Return whether a value can be typed: no part, and no function."""
    if isinstance(value, tuple):
        return bool(value) and all(isinstance(each, float | int | str) for each in value)
    return value is None or isinstance(value, bool | float | int | str)
