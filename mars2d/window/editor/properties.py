"""The properties of the selection, as rows of the panel, and how each is changed."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from mars2d.core.description import Description, schema_of
from mars2d.core.errors import counted
from mars2d.core.files import file_beside
from mars2d.core.materials import Coefficient
from mars2d.core.scene import PALETTE
from mars2d.core.usercode import name_of
from mars2d.scenario import serialize
from mars2d.scenario.code_file import Reference, law_in
from mars2d.scenario.controllers import FollowRobot, FollowWaypoints, standing_still
from mars2d.scenario.options import parse_option
from mars2d.scenario.registry import members
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.base import Sensor
from mars2d.window.editor.draft import BODIES, Draft, Item
from mars2d.window.editor.tools import Tie
from mars2d.window.widgets.menu import CHOSEN, Entry
from mars2d.window.widgets.prompt import Answer
from mars2d.window.widgets.rows import minus

if TYPE_CHECKING:
    from mars2d.bodies.joints.base import Joint
    from mars2d.window.editor.editor import Editor

Items = tuple[Item, ...]
Field = dataclasses.Field[Any]

SEVERAL = "several"
"""Shown where the selected bodies have different values."""
ELSEWHERE = ("pose", "shape", "controller", "a", "b", "workspace")
"""The fields that are changed in other ways."""
NAMES = ("blue", "vermilion", "green", "pink", "orange", "sky blue", "violet", "dark grey")
COLORS = dict(zip(PALETTE, NAMES, strict=True))
"""The colours of the palette, in words."""
AUTOMATIC, UNSET = "automatic", "not set"
"""What a value is called that follows from others, and one that nobody has given."""
NO_LAW = "none: it stands still"
GIVEN = 0.5
"""The value of a sensor's number that has no default."""
ROOM = 25
"""How many letters of a title and its value stand in one line; longer values stand below it."""


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
    def kind(self) -> type | None:
        """The class of all parts, None if they are of several."""
        kinds = {*map(type, self.parts)}
        return kinds.pop() if len(kinds) == 1 else None

    @property
    def plain(self) -> dict[str, Field]:
        """The fields that all parts have and that can be typed or chosen, by their names."""
        first = self.parts[0]
        return {
            field.name: field
            for field in (dataclasses.fields(first) if dataclasses.is_dataclass(first) else ())
            if field.name not in ELSEWHERE
            and all(_is_plain(getattr(part, field.name, ...)) for part in self.parts)
        }

    def in_words(self, field: Field) -> str:
        """Return a field's value in words."""
        return _alike([_shown(part, field) for part in self.parts])


class Properties:
    """The rows about the selection; each opens a menu, or a field to type in.

    A row shows a plain field, by the field's own metadata, or a part, such as a drive or a sensor:
    its menu offers others in its place, and has the fields of the part.
    """

    def __init__(self, editor: Editor) -> None:
        """Show them in the editor's panel."""
        self._editor, self._desk, self._dialogs = editor, editor.desk, editor.dialogs
        self.focus(keys=False)

    def focus(self, *, keys: bool = True) -> None:
        """Show them from the first one on; keys: and give them the keys."""
        self._editor.panel.open("properties", self.rows, (0, 0), stays=True)
        self._editor.panel.focused = keys

    # -- subjects -------------------------------------------------------------------------------

    def _scenario(self) -> Subject:
        draft, put = self._desk.draft, self._desk.put
        names = Subject([draft.base], lambda _: None).plain
        alone = Scenario(workspace=None, **{name: getattr(draft.base, name) for name in names})

        def change(f: Callable[[Scenario], Scenario]) -> None:
            changed = f(alone)  # checked without the bodies, which may not go together yet
            put(draft.with_base(**{name: getattr(changed, name) for name in names}))

        return Subject([alone], change)

    def _parts(self, *items: Item) -> Subject:
        draft, put = self._desk.draft, self._desk.put
        parts = [draft.things[item] for item in items]
        return Subject(parts, lambda f: put(draft.with_parts(items, f)))

    def _sensors(self, whole: Subject, key: str) -> Subject:
        """Return the sensors of robots with a name; a change to None removes them."""

        def changed(f: Callable[[Sensor], Sensor | None], robot: Robot) -> Robot:
            found = (f(sensor) if sensor.key == key else sensor for sensor in robot.sensors)
            return robot.replace(sensors=[sensor for sensor in found if sensor is not None])

        parts = [robot.sensor(key) for robot in whole.parts]
        return Subject(parts, lambda f: whole.change(partial(changed, f)))

    # -- rows -----------------------------------------------------------------------------------

    def rows(self) -> list[Entry]:
        """Return the rows about the selection, or about the scenario."""
        draft, items, select = self._desk.draft, self._desk.selection, self._desk.select
        if not items:
            return [
                Entry("The scenario"),
                *self._fields(self._scenario()),
                *(
                    Entry(f"{draft.base.robots[i].name} lacks {want}",
                          partial(select, [Item("robot", i)]), tone="warning")
                    for i, want in self.idle(draft).items()
                ),
            ]  # fmt: skip
        rows = [Entry(counted(len(items), "thing"))]
        if len(items) == 1:  # without the size of a body, which has rows of its own
            first, *others = draft.described(items[0])[:3]
            rows = [Entry(first), *(Entry(line, tone="note") for line in others)]
        rows += [
            Entry(f"Corner {k}", partial(self._touch, k), value=minus(f"{x:.4g}, {y:.4g} m"))
            for k, (x, y) in enumerate(self._desk.corners)
        ]
        bodies = tuple(item for item in items if item.kind in BODIES)
        if not bodies:
            return rows
        if all(item.kind == "robot" for item in bodies):
            rows += self._rows_of_robots(bodies)
        owners = self._parts(*bodies)
        known = ["name"] * (len(bodies) > 1)
        known += ["diameter"] * any(getattr(part, "shape", None) for part in owners.parts)
        return [*rows, *self._rows_of_joints(bodies), *self._fields(owners, but=known)]

    def idle(self, draft: Draft) -> dict[int, str]:
        """Return what each robot of a draft lacks to be moved, by its number."""
        return standing_still(draft.sketch, self._dialogs.control)

    def _touch(self, corner: int) -> None:
        """Choose a corner of the selection, and ask where it lies."""
        if self._editor.tool_name != "select":
            self._editor.choose("select")
        self._desk.corner = corner
        self._editor.ask_pose()

    def _tie(self, items: Items, kind: type[Joint]) -> None:
        """Let the person choose what items are tied to by a joint of a kind."""
        tool = Tie(self._desk, kind, items, lambda: self._editor.choose("select"))
        self._editor.take_up("tie", tool)

    def _rows_of_robots(self, robots: Items) -> list[Entry]:
        whole, idle = self._parts(*robots), self.idle(self._desk.draft)
        laws, drives = whole.part("controller"), whole.part("drive")
        without = "that of the team" if self._dialogs.control is not None else NO_LAW
        titles = [getattr(law, "title", law and name_of(law)) or without for law in laws.parts]
        rows = [self._part("Law", _alike(titles), laws, self._laws(robots))]
        wants = [idle[item.number] for item in robots if item.number in idle]
        if wants:
            rows.append(Entry(f"lacks {wants[0]}", level=1, tone="warning"))
        title = _alike([type(drive).__name__ for drive in drives.parts])
        kinds = _listed(members("bodies"), partial(_give_drive, drives), drives.kind)
        rows.append(self._part("Drive", title, drives, kinds))
        kinds = _listed(members("sensors"), partial(_add_sensor, whole))
        rows.append(Entry("Sensors", partial(self._open, "Add a sensor", kinds), value="add one"))
        first, *others = whole.parts
        for sensor in first.sensors:
            if all(robot.sensor(sensor.key) for robot in others):
                kind = type(sensor).__name__ * (sensor.name is not None)
                rows.append(self._part(sensor.key, kind, self._sensors(whole, sensor.key)))
        return rows

    def _rows_of_joints(self, bodies: Items) -> list[Entry]:
        kinds, draft = _listed(members("joints"), partial(self._tie, bodies)), self._desk.draft
        rows = [Entry("Joints", partial(self._open, "Tie it by a", kinds), value="add one")]
        name = draft.name(bodies[0])
        for k, joint in enumerate(draft.base.joints if len(bodies) == 1 else ()):
            if name in (joint.a, joint.b):
                kind, other = type(joint).__name__, joint.b if joint.a == name else joint.a
                subject = self._parts(Item("joint", k))
                rows.append(self._part(f"{kind} to {other or 'the floor'}", "", subject))
        return rows

    def _part(
        self, title: str, value: str, subject: Subject, others: Sequence[Entry] = ()
    ) -> Entry:
        """Return the row of a part, and below it what is unusual about it.

        others: to take in its place; without any, it can be removed.
        """
        fields = self._fields(subject) if subject.kind else []
        changed = serialize.changed(subject.parts[0]) if fields else {}
        words = (
            f"{_title(k)} {subject.in_words(f)}" for k, f in subject.plain.items() if k in changed
        )
        entries = others or [Entry("Remove it", partial(subject.change, lambda _: None))]
        entries = [*entries, *[Entry("Fields")] * bool(fields), *fields]
        act = partial(self._open, title, entries)
        return _row(title, act, value, *map(minus, words), level=not others)

    def _fields(self, subject: Subject, but: Sequence[str] = ()) -> list[Entry]:
        """Return a row for each field that can be typed or chosen."""
        rows = []
        for name, field in subject.plain.items():
            if name not in but:
                words, ask = subject.in_words(field), partial(self._ask, subject, name)
                rows.append(_row(_title(name).capitalize(), ask, words))
        return rows

    # -- asking ---------------------------------------------------------------------------------

    def _ask(self, subject: Subject, name: str) -> None:
        """Let a person change a field: by a menu of its values, or by typing."""
        field, title = subject.plain[name], _title(name)
        value, give = getattr(subject.parts[0], name), partial(subject.set, name)
        choices, unit = self._choices(field), field.metadata.get("unit", "")
        exact = isinstance(value, float) and not isinstance(value, Coefficient)
        ask = partial(
            self._dialogs.ask,
            f"{title}{f' [{unit}]' if unit else ''} =",
            Answer("apply", lambda typed: give(_typed(field, typed))),
            text=repr(value) if exact else _in_words(value),
            doc=field.metadata.get("doc", ""),
        )
        if isinstance(value, bool):
            give(not value)
        elif choices:
            more = [Entry("another …", ask)] * (name == "color")
            named = {UNSET if each is None else _in_words(each): each for each in choices}
            self._open(title, [*_listed(named, give, value), *more])
        else:
            ask()

    def _choices(self, field: Field) -> Sequence[Any]:
        """Return the values that a field may have, if they are few."""
        robots = self._desk.draft.base.robots
        chosen = {item.number for item in self._desk.selection if item.kind == "robot"}
        mentions = field.metadata.get("names")
        if mentions == "robot" and schema_of(field).get("type") == "string":
            return [None, *(r.name for i, r in enumerate(robots) if i not in chosen)]
        if mentions == "sensor":
            return [sensor.key for i in chosen for sensor in robots[i].sensors]
        words = schema_of(field).get("enum", [*COLORS] * (field.name == "color"))
        return [None, *words] if words and field.metadata.get("optional") else words

    def _open(self, title: str, entries: Sequence[Entry]) -> None:
        """Open a menu below the row that was chosen."""
        listed = [Entry(title), *entries]
        self._editor.menu.open(title, lambda: listed, self._editor.panel.below)

    # -- laws and drives ------------------------------------------------------------------------

    def _laws(self, robots: Items) -> list[Entry]:
        """Return what can be chosen as the law of robots."""
        owners = self._parts(*robots)
        laws: list[Any] = [*members("controllers").values()]
        without = "as the team's law says" if self._dialogs.control is not None else NO_LAW
        choices = {law.title: law for law in laws} | {without: type(None)}
        given = owners.part("controller").kind
        return [
            *_listed(choices, partial(self._give_law, robots), given),
            Entry("from a file …", partial(self._ask_for_file, owners)),
        ]

    def _give_law(self, robots: Items, kind: type[Any]) -> None:
        """Give robots a ready-made law or none, and the sensors that it needs."""
        wanted: Sequence[Sensor] = getattr(kind, "needs", ())

        def change(robot: Robot) -> Robot:
            carried = {sensor.key for sensor in robot.sensors}
            added = [sensor for sensor in wanted if sensor.key not in carried]
            return robot.replace(controller=kind(), sensors=[*robot.sensors, *added])

        self._parts(*robots).change(change)
        needs = " and ".join(sensor.key for sensor in wanted)
        if kind is FollowWaypoints and self.idle(self._desk.draft).get(robots[0].number):
            self._editor.choose("waypoint")
            self._desk.say("click its waypoints, one after the other")
        elif kind is FollowRobot and len(self._desk.draft.base.robots) > len(robots):
            self._ask(self._parts(*robots).part("controller"), "leader")
        elif needs:
            self._desk.say(f"it goes by its sensor {needs}")

    def _ask_for_file(self, robots: Subject) -> None:
        def take(typed: str) -> None:
            reference = Reference.read("law", typed)
            beside = self._dialogs.path or Path("scenario.toml")
            file = file_beside(Path(reference.file), beside, "a law", [".py"])
            # Each robot gets the law loaded again, so that robots share nothing.
            robots.change(lambda robot: robot.replace(controller=law_in(file, reference.name)))

        doc = "a file of Python and a function in it, such as walk.py:walk"
        self._dialogs.ask("Law =", Answer("apply", take), text="", doc=doc)


def _row(title: str, act: Callable[[], object], value: str, *more: str, level: int = 0) -> Entry:
    """Return a row with its value beside it, or below where both are long; more: words below."""
    if value and len(title) + len(value) + 3 * level > ROOM:
        value, more = "", (value, *more)
    return Entry(title, act, value=value, more=", ".join(more), level=level)


def _give_drive(drives: Subject, kind: type[Description]) -> None:
    """Put drives of a kind in the place of others, with the fields that both have."""
    known = kind.__dataclass_fields__
    drives.change(
        lambda drive: kind(**{k: v for k, v in serialize.changed(drive).items() if k in known})
    )


def _listed(
    choices: Mapping[str, Any], give: Callable[[Any], object], now: object = None
) -> list[Entry]:
    """Return the entries of choices, by their words; now: the present one."""
    return [
        Entry(
            words,
            partial(give, each),
            value=CHOSEN * (each == now),
            colors=[each] * (each in COLORS),
        )
        for words, each in choices.items()
    ]


def _add_sensor(robots: Subject, kind: type[Any]) -> None:
    """Give robots one more sensor, with a name that is free."""
    no = dataclasses.MISSING
    fields = dataclasses.fields(kind)
    needed = (f.name for f in fields if f.default is f.default_factory is no)
    sensor = kind(**dict.fromkeys(needed, GIVEN))

    def added(robot: Robot) -> Robot:
        names = (sensor.key, *(f"{sensor.key}{k}" for k in range(2, len(robot.sensors) + 3)))
        name = next(name for name in names if robot.sensor(name) is None)
        new = sensor if name == sensor.key else sensor.replace(name=name)
        return robot.replace(sensors=[*robot.sensors, new])

    robots.change(added)


def _alike(words: Sequence[str]) -> str:
    """Return the words that are the same for all parts, or that they are several."""
    return words[0] if len({*words}) == 1 else SEVERAL


def _title(name: str) -> str:
    """Return a field's name in words."""
    return name.replace("_", " ")


def _shown(part: object, field: Field) -> str:
    """Return a field's value in words; in place of None the value that follows from others."""
    value, unit = getattr(part, field.name), field.metadata.get("unit", "")
    if value is not None:
        return _in_words(value, unit)
    wholes = (getattr(part, name, None) for name in ("inertia", "surface"))
    found = (getattr(whole, field.name, None) for whole in wholes)
    follows = next((each for each in found if each is not None), None)
    return UNSET if follows is None else f"{AUTOMATIC} ({_in_words(follows, unit)})"


def _typed(field: Field, text: str) -> object:
    """Return the value of a field that was typed: as text, or as a number, a tuple, a word."""
    words = ("", "none", UNSET, AUTOMATIC)
    if field.metadata.get("optional") and text.strip().lower() in words:
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
    if isinstance(value, tuple) and not any(isinstance(each, str) for each in value):
        return f"{', '.join(map(_in_words, value))} {unit * (',' not in unit)}".strip()
    text = f"{value:.4g}" if isinstance(value, float) else COLORS.get(str(value), str(value))
    return f"{text} {unit}".strip()


def _is_plain(value: object) -> bool:
    """Return whether a value can be typed: no part, and no function."""
    if isinstance(value, tuple):
        return bool(value) and all(isinstance(each, float | int | str) for each in value)
    return value is None or isinstance(value, bool | float | int | str)
