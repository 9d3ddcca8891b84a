"""Scenarios as TOML files, for people to read and edit.

``format = 1`` stands first, then the scenario's fields by their names. A part is a table with its
`type`; robots and other lists are tables in ``[[ ]]``. A law is named as ``walk.py:walk``.
"""

from __future__ import annotations

import dataclasses
import json
import re
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from mars2d.core.description import Description, wrong
from mars2d.core.errors import InputError, likely, nearest, one_line, shown
from mars2d.core.files import atomic_write, file_beside
from mars2d.core.materials import Coefficient
from mars2d.core.picture import image_file
from mars2d.core.usercode import name_of
from mars2d.scenario import serialize
from mars2d.scenario.code_file import Reference, law_in, located, seen_from
from mars2d.scenario.controllers import Controller
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.scenario.serialize import Place

SUFFIX = ".toml"

FORMAT = 1

MAX_BYTES = 5_000_000
"""The size of the largest file."""

SCHEMA_FILE = "mars2d.schema.json"
"""The file beside a scenario in which editors look for its schema: `mars2d doctor --schema`."""

HEADS = ("format", "control")
"""The keys of a file that are no fields of its scenario."""

WIDTH = 100
"""Columns of a line with a table or a list; a longer one takes several."""

NONE = "none"
"""The text that stands for None."""


Node = str | list[Any] | dict[str, Any]
"""A value as text, a list of values, or a table."""

Law = Callable[[Any], Any]

READY_MADE = Place(Controller)


# -- writing -----------------------------------------------------------------------------------


def save_scenario(
    scenario: Scenario, path: str | Path, control: Law | str | None = None
) -> tuple[str, ...]:
    """Write a scenario to a file, and return the parts left out, such as ``add-on Lamps``.

    control: the law of the team, a function or ``team.py:control``. The file names the place of a
    law, so only a function at the top of a file can be written. Other code is left out, or replaced
    as in a loaded record (see `Record.missing`); comments in the file say so. A file that exists is
    replaced. Raises InputError if it can't be written.
    """
    path = Path(path)
    if path.suffix.lower() != SUFFIX:
        raise InputError(f"{path}: a scenario is saved as {SUFFIX}, this ends in {path.suffix!r}")
    writer = _Writer(path.parent)
    text = writer.text(scenario, path.name, control).encode(errors="replace")
    with atomic_write(path) as file:
        file.write(text)
    return tuple(dict.fromkeys(writer.missing))


class _Writer:
    """Turns a scenario into the text of a file in a folder.

    missing: the parts that were left out.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.missing: list[str] = []

    def text(self, scenario: Scenario, filename: str, control: Law | str | None) -> str:
        """Return the whole file."""
        kept, lost = serialize.without_code(scenario)
        self.missing += lost
        team = "" if control is None else self._law("control", control)
        whole = {"format": plain(FORMAT), **({"control": team} if team else {})}
        lines = tables(whole | self._table(kept, Place(Scenario)))
        if not team and not any(robot.controller for robot in kept.robots):
            hint = "a law of the team; without one it stands still"
            lines.insert(1, f'# control = "my_law.py:control"  # {hint}')
        head = [f"A scenario of MARS2D. Run it: mars2d run {filename}"]
        head += [f"{serialize.LOST}: {name}" for name in dict.fromkeys(self.missing)]
        if any(name.startswith("law ") for name in self.missing):
            head.append('A law is named by its place: controller = "file.py:function"')
        head = [f"#:schema {SCHEMA_FILE}", *(f"# {one_line(each)}" for each in head), ""]
        return "\n".join([*head, *lines]) + "\n"

    def _table(self, part: Description, place: Place, index: int = 0) -> dict[str, Any]:
        """Return a part as a table; its type stands in it unless only one is possible there.

        index: its place in its list.
        """
        kind = type(part)
        fields, places = serialize.changed(part, index), serialize.parts_of(kind)
        table: dict[str, Any] = {} if kind is place.base else {"type": quoted(kind.__name__)}
        for name in sorted(fields, key=lambda field: field != "name"):
            value, check = fields[name], kind.__dataclass_fields__[name].metadata.get("check")
            if check is image_file and value is not None and Path(value).is_absolute():
                table[name] = quoted(seen_from(value, self.folder))
            elif not callable(value) or serialize.is_ready_made(type(value)):
                table[name] = self._node(value, places.get(name, Place(Description)))
            elif law := self._law(name, value):
                table[name] = law
        return table

    def _node(self, value: Any, place: Place) -> Node:
        """Return a value in TOML. place: where it stands."""
        if isinstance(value, Description):
            return self._table(value, place)
        if isinstance(value, (list, tuple)):
            return [
                self._table(item, place, i) if place.many else self._node(item, place)
                for i, item in enumerate(value)
            ]
        return plain(value)

    def _law(self, field: str, law: Law | str) -> str:
        """Return the place of a law in TOML, or "" where it has none."""
        if isinstance(law, str):
            Reference.read(field, law)
            return quoted(law)
        if (found := Reference.of(law)) is None:
            self.missing.append(f"law {name_of(law)}")
            return ""
        return quoted(f"{seen_from(found.file, self.folder)}:{found.name}")


def tables(table: dict[str, Any], path: str = "") -> list[str]:
    """Return the lines of a table, and of those in it that fit in no line, below their headers.

    path: its name and a full stop; empty for that of the whole file.
    """
    lines, below = list[str](), list[str]()
    for name, value in table.items():
        line, inner = f"{name} = {flat(value)}", list[Any]()
        if isinstance(value, list) and any(isinstance(item, dict) for item in value):
            inner, header = value, f"[[{path}{name}]]"
        elif isinstance(value, dict) and (len(line) > WIDTH or ("{" in line and not path)):
            inner, header = [value], f"[{path}{name}]"
        elif isinstance(value, list) and len(line) > WIDTH:
            lines += [f"{name} = [", *(f"    {flat(item)}," for item in value), "]"]
        else:
            lines.append(line)
        for item in inner:
            below += ["", header, *tables(item, f"{path}{name}.")]
    return lines + below


def flat(node: Node) -> str:
    """Return a node as text in one line; a table of a type alone is its type."""
    if isinstance(node, dict):
        items = ", ".join(f"{name} = {flat(value)}" for name, value in node.items())
        return flat(node["type"]) if [*node] == ["type"] else f"{{ {items} }}"
    return node if isinstance(node, str) else f"[{', '.join(map(flat, node))}]"


def plain(value: Any) -> str:
    """Return a number, a word or a material as text; numbers are read back bit for bit."""
    if value is None:
        return quoted(NONE)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, Coefficient):
        return quoted(value.material)
    return repr(float(value) if isinstance(value, float) else int(value))


def quoted(text: str) -> str:
    r"""Return text in double quotes.

    >>> print(quoted('a "wall"\n'))
    "a \"wall\"\n"
    """
    return json.dumps(str(text), ensure_ascii=False).replace("\x7f", r"\u007f")


# -- reading -----------------------------------------------------------------------------------


def read(path: str | Path) -> tuple[Scenario, Law | None]:
    """Return the scenario in a file, and the law of its team or None.

    Laws and images that it names lie beside it or in the current folder. Each robot gets its law
    loaded again, as by `load_law`. Raises InputError, which says what is wrong, in which line, and
    what was expected.
    """
    path = Path(path)
    if path.suffix.lower() != SUFFIX:
        raise InputError(f"{path}: expected a scenario, a file that ends in {SUFFIX}")
    try:
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
        text = data.decode("utf-8-sig")  # some editors write a mark first
    except OSError as error:
        raise InputError(f"{path}: can't be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise located(f"{path.name}, line {line}", "expected text in UTF-8; save it so") from None
    if len(data) > MAX_BYTES:
        raise InputError(f"{path}: expected at most {MAX_BYTES / 1e6:g} MB, it is larger")
    return _Reader(path, text).scenario(_parsed(path, text))


def _parsed(path: Path, text: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise located(path.name, "brackets stand in each other too deeply") from None
    except ValueError as error:  # also of a number with too many digits
        message, _, place = str(error).partition(" (at ")
        number = re.match(r"line (\d+)", place)
        if number is None:
            lines = enumerate(text.split("\n"), 1)
            *_, last = 0, *(k for k, line in lines if line.count("[") > line.count("]"))
            at_end = f"line {last}" if last else "at its end"
            raise located(f"{path.name}, {at_end}" if place else path.name, message) from None
        before = text.split("\n")[: int(number[1])]
        line = before[-1].strip()
        hint = next((f"; {hint}" for code, hint in HINTS.items() if re.search(code, line)), "")
        problem = f"{message}: {shown(line)[1:-1]}{hint}" if line else message
        *_, table = "", *_lines_of("\n".join(filter(HEADER.fullmatch, map(str.strip, before))))
        where = f"{path.name}, line {number[1]}"
        raise located(f"{where}, {table}" if table else where, problem) from None


HINTS = {
    r"(^|\s)//|^[%;]|/\*": "a comment begins with #",
    r"^\w+\s*:|\{[^=}]*:": "a field is NAME = VALUE",
    r"=\s*\{[^}]*$": "a table in braces has one line; a longer one has a head, [robots.drive]",
    r",\s*\}": "no comma stands before }",
    r"^\[\w+\]$": "a list of tables has double brackets, [[robots]]",
    r"[\u2018-\u201d]": "quotes are straight: 'red'",
    r"=\s*(\"[^\"]*|'[^']*)$": "a text has a quote at both ends",
    r"=\s*[-+]?\d+,\d+$": "decimals have a point: 0.5",
    r"[,;]$": "nothing stands between lines",
    r"[=\[,]\s*[-+]?\.\d": "a digit stands before the point: 0.5",
    r"\d\.($|[\s,\]])": "a digit stands behind the point: 5.0",
    r"=\s*(\(|[-+.\d]+\s*,|\{[-+.\d]|\[[-+.\d]+[\s;])": "a list has brackets and commas: [1, 2]",
    r"\b(True|False)\b": "TOML writes true and false",
    r"\b(null|None|nil)\b": "what is None is left out, or is 'none'",
    r"\d\s*(deg|\u00b0)": "angles are in radians: 90 degrees are 1.5708",
    r"\d\s*[cm]?(m|s|kg|N)\b": "numbers have no units: they are in m, s, kg and N",
    r"\bpi\b|\u03c0|\d\s*[*/+]": "TOML does not calculate: pi is 3.14159265, pi/2 is 1.57079633",
    r"=\s*[A-Za-z]": "text stands in quotes: 'red'",
}
"""What to write, by what people write in files of this kind."""


class _Reader:
    """Makes the scenario of a file, with errors that point at the line.

    Tables have names such as ``robots[2].drive``; that of the scenario is empty.
    """

    def __init__(self, path: Path, text: str) -> None:
        self.path = path
        self._lines = _lines_of(text)

    def scenario(self, data: dict[str, Any]) -> tuple[Scenario, Law | None]:
        """Return the scenario, and the law of its team."""
        if "format" not in data:
            raise located(
                self.path.name, f"no scenario: the first line should be format = {FORMAT}"
            )
        with self._pointing("", "format"):
            if data["format"] != FORMAT:
                raise wrong("format", data["format"], f"{FORMAT}, which this MARS2D reads")
        fields = {name: value for name, value in data.items() if name not in HEADS}
        scenario = self._part(Place(Scenario, default=Scenario), fields, "")
        assert isinstance(scenario, Scenario)
        control = data.get("control")
        with self._pointing("", "control"):
            law = None if control is None else self._law("control", control, "the world")
        return scenario, law

    @contextmanager
    def _pointing(self, table: str, field: str = "") -> Iterator[None]:
        """Give errors their place: the file, the line if it is known, and the table."""
        try:
            yield
        except InputError as error:
            place = _inside(table, field) if field else table
            while place and place not in self._lines:  # the line of a table around it
                place = place[: max(place.rfind("."), place.rfind("["), 0)]
            line = f"line {self._lines[place]}" if place else ""
            error.where = error.where or ", ".join(filter(None, [self.path.name, line, table]))
            raise

    def _part(self, place: Place, value: Any, at: str) -> Description:
        """Return the part that a table describes, or the name of its type alone."""
        if isinstance(value, str):
            value = {"type": value}
        if not isinstance(value, dict):
            example = place.default or min(serialize.kinds_of(place.base).values(), key=repr)
            expected = f"a table, as {{ type = {quoted(example.__name__)} }}"
            raise wrong(at.rpartition(".")[2], value, expected)
        with self._pointing(at, "type"):
            kind = _kind(place, value.get("type"))
        fields = {field.name: field for field in dataclasses.fields(kind)}
        values = {}
        for name, item in value.items():
            with self._pointing(at, name):
                if name in fields:
                    values[name] = self._field(kind, fields[name], item, _inside(at, name))
                elif name != "type":
                    known = [*fields, *(HEADS if kind is Scenario else ["type"])]
                    above = "; the fields of the scenario stand above the first table"
                    above = above if name in Scenario.__dataclass_fields__ else ""
                    near = likely(name, known) or above or kind.meant(name)
                    raise InputError(f"{kind.__name__} has no field {name!r}{near}")
        try:
            return kind(**values)
        except InputError as error:
            error.args = (error.args[0].replace("True or False", "true or false"),)
            named = re.match(rf"{kind.__name__}\.(\w+(?:\[\d+\])*)", str(error))
            with self._pointing(at, named[1] if named else ""):
                raise

    def _field(
        self, kind: type[Description], field: dataclasses.Field[Any], value: Any, at: str
    ) -> Any:
        """Return the value of a field, before it is checked."""
        if value == NONE and takes_none(field):
            return None
        place = serialize.parts_of(kind).get(field.name)
        if place is not None and not place.many:
            return self._part(place, value, at)
        if place is not None:
            if isinstance(value, dict):
                header = re.sub(r"\[\d+\]", "", at)
                expected = f"expected a list of tables; write [[{header}]] above each"
                raise InputError(f"{header}: {expected}")
            if not isinstance(value, list):
                return value  # such as robots = 5, or refused later
            return [self._part(place, item, f"{at}[{i}]") for i, item in enumerate(value)]
        if field.name == "controller" and issubclass(kind, Robot):
            return self._controller(at, value)
        if field.metadata.get("check") is image_file and isinstance(value, str):
            beside = self.path.absolute().parent / value
            return str(beside) if beside.is_file() else value
        return self._plain(value, at)

    def _plain(self, value: Any, at: str) -> Any:
        """Return a value of lists, text and numbers; a table with a type becomes a part."""
        if isinstance(value, list):
            return [self._plain(item, at) for item in value]
        if isinstance(value, dict):
            if "type" in value:
                return self._part(Place(Description), value, at)
            return {name: self._plain(item, at) for name, item in value.items()}
        return value

    def _controller(self, at: str, value: Any) -> Any:
        """Return a robot's own law: a ready-made one, or one that stands in a file of Python."""
        known = serialize.kinds_of(Controller)
        if isinstance(value, dict) or (isinstance(value, str) and value in known):
            return self._part(READY_MADE, value, at)
        if isinstance(value, str) and (near := likely(value, known)):
            raise InputError(f"controller = {shown(value)}: no such law{near}")
        return self._law("controller", value, "the robot")

    def _law(self, field: str, value: Any, subject: str) -> Law:
        reference = Reference.read(field, value)
        file = file_beside(Path(reference.file), self.path, "a law", [".py"])
        try:
            return law_in(file, reference.name, subject)
        except InputError as error:  # its place there, and the line that names it
            raise InputError(str(error)) from error


def _kind(place: Place, name: object) -> type[Description]:
    """Return the class that the name of a type means, or the default without a name."""
    if name is None and place.default is not None:
        return place.default
    kinds = serialize.kinds_of(place.base)
    if name is None:
        example = f"as type = {quoted(min(kinds))}"
        raise InputError(f"its type is missing, {example}{nearest('', kinds)}")
    if not isinstance(name, str) or name not in kinds:
        problem = f"type = {shown(name)}: no {place.base.__name__} is called so"
        raise InputError(problem + nearest(name, kinds))
    return kinds[name]


def _inside(at: str, name: str) -> str:
    return f"{at}.{name}" if at else name


def takes_none(field: dataclasses.Field[Any]) -> bool:
    """Return whether the text "none" stands for None in a field, which takes None, not text."""
    if not field.metadata.get("optional"):
        return False
    try:
        field.metadata["check"]("", NONE)
    except InputError:
        return True
    return False


HEADER = re.compile(r"(\[\[?)\s*([A-Za-z_]\w*(?:\s*\.\s*\w+)*)\s*\]\]?\s*(?:#.*)?")
KEY = re.compile(r"([A-Za-z_]\w*)\s*[.=]")


def _lines_of(text: str) -> dict[str, int]:
    r"""Return the line in which each table and each field begins, by their places.

    >>> _lines_of('format = 1\n[[robots]]\npose = [1, 2]\n[robots.drive]')
    {'format': 1, 'robots': 2, 'robots[0]': 2, 'robots[0].pose': 3, 'robots[0].drive': 4}
    """
    found: dict[str, int] = {}
    last: dict[str, int] = {}  # the index of the last table in each list
    table = ""
    for number, line in enumerate(map(str.strip, text.split("\n")), 1):
        header, key = HEADER.fullmatch(line), KEY.match(line)
        if header is not None:
            table, names = "", re.split(r"\s*\.\s*", header[2])
            for name in names:
                table = _inside(table, name)
                found.setdefault(table, number)
                if header[1] == "[[" and name is names[-1]:
                    last[table] = last.get(table, -1) + 1
                table += f"[{last[table]}]" if table in last else ""
            found.setdefault(table, number)
        elif key is not None:
            found.setdefault(_inside(table, key[1]), number)
    return found
