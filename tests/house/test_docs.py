"""The documents do what they say: every block of code runs, and prints what stands below it.

How a document is read, from top to bottom, in a folder of its own:

- ``python``: executed, all blocks of a document in one namespace; or, where the sentence before
  says "Save as `NAME`", written to that file.
- ``toml``: the same for a scenario's file; one that is not saved is read, with its first line.
- ``console``: each line is a command, run by the real command line without a display, in this
  process: that of a shell is tried by test_entry_points.py.
- ``text``: what the block before has printed; ``...`` stands for anything. Where it is an error,
  ``mars2d: ...`` or ``SomeError: ...``, the block before must fail with it.
- ``matlab`` and blocks without a language are shown only.
"""

from __future__ import annotations

import contextlib
import doctest
import importlib
import inspect
import io
import os
import re
import shlex
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from PIL import Image

import mars2d
import mars2d.rl
from mars2d import addons, bodies, sensors
from mars2d.bodies import joints, props
from mars2d.cli import command_line as cli
from mars2d.core import scene
from mars2d.core.description import snake_case
from mars2d.core.scene import Scene
from mars2d.geometry import shapes
from mars2d.scenario import load_scenario
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.registry import members
from mars2d.window.run import keys
from mars2d.world.views import PropView, RobotView
from tests.cases import each_case
from tests.house.test_imports import LAYERS
from tests.worlds import solution

ROOT = Path(__file__).parents[2]
SENSORS = sorted((ROOT / "docs" / "sensors").glob("*.md"))
EXPERIMENTS = sorted((ROOT / "docs" / "experiments").glob("*.md"))
PURSUIT = sorted((ROOT / "docs" / "pursuit").glob("*.md"))
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
EVERYTHING = [*DOCUMENTS, ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md"]

SET_UP = ["pip install . && mars2d demo random_walk", 'pip install ".[test]" && pytest -n auto']
"""The set-up of the README, to the letter."""

PIP = {*SET_UP, 'pip install ".[video,maps,data,log,cluster,rl]"'}
"""The only commands that are not executed, but for the part of them that is mars2d."""

MEASURED = {
    "speed_growth.png", "paper_page.png", "replay.png", "league.png",
    "home.png", "straight_chase_bodies.png",
    "homicidal_chauffeur_bodies.png", "homicidal_chauffeur_boundary.png", "two_cars_bodies.png",
    "lion_and_man_bodies.png", "encirclement_bodies.png", "learning_pursuit.png",
    "learning_push.png", "learning_sumo.png",
}  # fmt: skip
"""Pictures that no block makes: `benchmarks/growth.py` and `docs/make/pursuit.py` take minutes, a
page needs a browser."""

sys.path.insert(0, str(ROOT / "docs" / "make"))
DRAWN: dict[str, Callable[[Path], None]] = importlib.import_module("pictures").PICTURES
"""Pictures of windows, which `docs/make/pictures.py` makes."""

NEW = os.environ.get("MARS2D_PICTURES") == "new"
"""Whether the pictures that blocks make are kept as those of the pages."""

LANGUAGES = {"python", "toml", "console", "text", "matlab", ""}


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, its text, its first line's number, the sentence before it."""

    language: str
    text: str
    line: int
    before: str


def blocks(document: Path) -> Iterator[Block]:
    language, start, before = None, 0, ""
    inside: list[str] = []
    for number, line in enumerate(document.read_text(encoding="utf-8").splitlines(), 1):
        if not line.startswith("```"):
            if language is None:
                before = before + " " + line.strip() if line.strip() else before + "\n"
            else:
                inside.append(line)
        elif language is None:
            language, start, inside = line[3:].strip(), number + 1, []
        else:
            yield Block(language, "\n".join(inside), start, before.strip().split("\n")[-1])
            language, before = None, ""
    assert language is None, f"{document.name}: a block is not closed"


class Reader:
    """Does what a document says, in the present folder."""

    def __init__(self, document: Path) -> None:
        self.document = document
        self.namespace: dict[str, Any] = {"__name__": "__main__"}
        self.output = ""

    def read(self) -> None:
        every = list(blocks(self.document))
        for number, block in enumerate(every):
            place = f"{self.document.name}, line {block.line}"
            following = every[number + 1 : number + 2]
            expected = following[0].text if following and following[0].language == "text" else ""
            if block.language == "python":
                self.python(block, expected)
            elif block.language == "toml":
                self.toml(block)
            elif block.language == "console":
                self.output = "".join(self.command(c, expected) for c in block.text.splitlines())
            elif block.language == "text":
                alike = doctest.OutputChecker().check_output(
                    block.text + "\n", self.output, doctest.ELLIPSIS
                )
                assert alike, f"{place}\nexpected:\n{block.text}\nfound:\n{self.output}"

    def saved(self, block: Block) -> bool:
        """Write a block to the file that the sentence before names, if it does."""
        named = re.search(r"[Ss]ave as `([^`]+)`:$", block.before)
        if named:
            Path(named[1]).parent.mkdir(exist_ok=True)
            Path(named[1]).write_text(block.text + "\n", encoding="utf-8")
        return named is not None

    def toml(self, block: Block) -> None:
        if not self.saved(block):
            Path("shown.toml").write_text("format = 1\n" + block.text, encoding="utf-8")
            load_scenario(Path("shown.toml").absolute())

    def python(self, block: Block, expected: str) -> None:
        if self.saved(block):
            return
        # Blank lines in front, so that a traceback shows the document's own line.
        code = compile("\n" * (block.line - 1) + block.text, str(self.document), "exec")
        printed = io.StringIO()
        error = re.match(r"(\w+Error): ", expected)
        with contextlib.redirect_stdout(printed):
            if error is None:
                exec(code, self.namespace)
            else:
                with pytest.raises(mars2d.Mars2dError) as caught:
                    exec(code, self.namespace)
                print(f"{type(caught.value).__name__}: {caught.value}")
        self.output = printed.getvalue()

    def command(self, line: str, expected: str) -> str:
        """Run one command and return what it prints."""
        if line.startswith("pip "):
            assert line in PIP
            parts = [part for part in line.split(" && ") if part.startswith("mars2d")]
            return "".join(self.command(part, expected) for part in parts)
        words = shlex.split(line)
        assert words[0] == "mars2d", f"{self.document.name}: what is {line!r}?"
        arguments = cli.parse(words[1:])
        made = getattr(arguments, "video", None) or getattr(arguments, "html", None)
        needs_window = words[1:2] == ["replay"] and not made
        needs_window |= getattr(arguments, "speed", None) == 0
        needs_window |= bool(getattr(arguments, "human", None)) and not arguments.headless
        needs_window |= words[1:2] == ["play"] and "mars2d: " not in expected and len(words) > 2
        verb = words[1] if len(words) > 1 else ""
        if verb == "sweep" and "--seeds" in words and not expected and not NEW:
            words[words.index("--seeds") + 1] = "1"  # its numbers are not compared
        if verb in ("run", "demo") and not (needs_window or arguments.headless):
            words.append("--headless")  # where it would open a window
        if verb == "replay":
            assert arguments.record.is_file(), line
        printed, said = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(said):
            code = cli.main(words[1:])
        errors = said.getvalue()
        if needs_window:  # all that can be asked of it here
            assert (code, "display" in errors) == (2, True), line + errors
            return errors
        wanted = 2 if re.search("^mars2d: ", expected, flags=re.M) else 0
        assert code == wanted, f"{line}: exit code {code}\n{errors}"
        return printed.getvalue() + errors


SLOW = {
    "README", "addons", "data", "films", "first_experiment", "laws", "logs", "own_sensor_and_addon",
    "paper", "window",
}  # fmt: skip
"""Documents that take a second and more."""

NIGHTLY = {
    "clusters", "commands", "communication", "contact", "editors", "figures", "information",
    "pursuit", "sensing", "speed", "studies", "tournaments",
    *({path.stem for path in EXPERIMENTS} - {"formation", "random_walk"}),
    *(path.stem for path in PURSUIT),
}  # fmt: skip
"""Documents that take many seconds."""


def marks(document: Path) -> list[pytest.MarkDecorator]:
    if document.stem in NIGHTLY:
        return [pytest.mark.slow, pytest.mark.nightly]
    return [pytest.mark.slow] if document.stem in SLOW else []


@pytest.mark.parametrize(
    "document", [pytest.param(p, id=str(p.relative_to(ROOT)), marks=marks(p)) for p in DOCUMENTS]
)
def test_a_document_does_what_it_says(document, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    # So few runs don't pay for a second process.
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0}, raising=False)
    Reader(document).read()
    if document in SENSORS:
        return  # their pictures are made by docs/make/sensors.py
    for name in set(pictures(document)) - MEASURED - {f"{each}.png" for each in DRAWN}:
        assert (tmp_path / name).is_file(), f"{name} was not made"
        if NEW:
            with Image.open(tmp_path / name) as made:
                small = made.convert("RGB").quantize(256, dither=Image.Dither.NONE)
            small.save(ROOT / "docs" / "pictures" / name, optimize=True)


@pytest.mark.slow
@pytest.mark.nightly
@each_case("name", list(DRAWN))
def test_the_pictures_of_windows_are_made(name, tmp_path):
    DRAWN[name](tmp_path / f"{name}.png")
    shown = ROOT / "docs" / "pictures" / f"{name}.png"
    with Image.open(tmp_path / shown.name) as made, Image.open(shown) as kept:
        assert made.size == kept.size


@each_case("document", DOCUMENTS)
def test_no_block_writes_into_the_clone_of_its_reader(document):
    for block in blocks(document):
        written = re.findall(r"(?<![\w./])(docs|examples|tests)/[\w/.-]+", block.text)
        assert block.language not in ("console", "python") or not written, block.text


@each_case("document", EVERYTHING)
def test_blocks_are_of_a_kind_that_is_tested(document):
    allowed = LANGUAGES | ({"sh"} if document.name == "CONTRIBUTING.md" else set())
    for block in blocks(document):
        assert block.language in allowed, f"{document.name}, line {block.line}"


# -- links and pictures -----------------------------------------------------------------------


def prose(document: Path) -> str:
    """The text of a document without its fenced blocks."""
    return re.sub(r"^```.*?^```$", "", document.read_text(encoding="utf-8"), flags=re.M | re.S)


def anchors(document: Path) -> set[str]:
    """The anchors of a document's headings, as GitHub and others make them."""
    titles = re.findall(r"^#+ (.+)$", prose(document), flags=re.M)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


@each_case("document", EVERYTHING)
def test_links_lead_somewhere(document):
    for target in re.findall(r"\]\(([^)\s]+)\)", prose(document)):
        if re.match(r"https?://", target):
            continue
        path, _, anchor = target.partition("#")
        goal = (document.parent / path).resolve() if path else document
        assert goal.exists(), f"{document.name}: {target}"
        if anchor:
            assert anchor in anchors(goal), f"{document.name}: {target}"


def test_each_document_is_on_a_shelf_of_the_site():
    shelves = (ROOT / "mkdocs.yml").read_text(encoding="utf-8").partition("nav:")[2]
    for document in DOCUMENTS[1:]:
        name = document.relative_to(ROOT / "docs").as_posix()
        assert re.search(rf"[ ]{re.escape(name)}$", shelves, flags=re.M), name


@each_case("name", sorted(members("sensors")))
def test_a_sensors_page_has_its_picture_and_its_fields(name):
    made = importlib.import_module("sensors")
    kind = getattr(sensors, name)
    text = made.page(kind).read_text(encoding="utf-8")
    assert text == made.with_fields(text, kind), "run: python docs/make/sensors.py"
    assert kind in made.SCENES
    assert pictures(made.page(kind)) == [f"sensor_{snake_case(name)}.png"]
    titles = re.findall(r"^## (.+)$", prose(made.page(kind)), flags=re.M)
    assert titles == ["Reading", "Model", "Parameters", "In a law", "Source"]


def pictures(document: Path, suffix: str = "png") -> list[str]:
    """The names of the pictures that a document shows, or of the films, which are .gif."""
    shown = re.findall(rf"!\[[^\]]+\]\(([^)]+\.(?:{suffix}))\)", prose(document))
    return [Path(name).name for name in shown]


def test_pictures_are_small_and_each_is_shown():
    files = list((ROOT / "docs" / "pictures").iterdir())
    shown = {name for document in DOCUMENTS for name in pictures(document, "png|gif")}
    assert {file.name for file in files} == shown
    for file in files:
        assert file.stat().st_size < (600_000 if file.suffix == ".gif" else 200_000), file.name


EXPERIMENT_PAGES = [path for path in EXPERIMENTS if path.stem != "index"]
PURSUIT_PAGES = [path for path in PURSUIT if path.stem != "index"]


@pytest.mark.slow
@each_case("page", EXPERIMENT_PAGES)
def test_an_experiments_page_has_a_picture_a_film_exercises_and_their_answer(page):
    name = page.stem
    titles = re.findall(r"^## (.+)$", prose(page), flags=re.M)
    assert titles == ["Run it", "The law", "Theory and measurement", "Exercises", "Model answer"]
    assert f"{name}.png" in pictures(page)
    assert pictures(page, "gif") == [f"{name}.gif"]
    commands = [block.text for block in blocks(page) if block.language == "console"]
    assert any(f"mars2d run {name} " in command for command in commands)
    answer = solution(name).as_posix().rpartition("/examples/")[2]
    assert f"(../../examples/{answer})" in page.read_text(encoding="utf-8")
    assert open_experiment(solution(name)).source.checks is not None


@each_case("page", PURSUIT_PAGES)
def test_a_pursuit_page_has_a_formula_bodies_exercises_and_their_answer(page):
    name = page.stem
    text = page.read_text(encoding="utf-8")
    titles = re.findall(r"^## (.+)$", prose(page), flags=re.M)
    assert titles == ["Play it", "Formula", "With bodies", "Exercises", "Model answer"]
    assert f"{name}.png" in pictures(page)
    assert {f"{name}_bodies.png", f"{name}_physics.png"} & {*pictures(page)}
    assert "**The referee counts" in text
    assert re.search(r"\b(1[6-9]|20)\d\d\b|geometry is our own", text), "whose formula?"
    assert f"(../../examples/pursuit/{name}/solution.py)" in text
    assert open_experiment(solution(name)).source.checks is not None
    assert f"({page.name})" in (page.parent / "index.md").read_text(encoding="utf-8")


LONG = {"circular_motion", "coverage_square", "cyclic_pursuit", "pursuit_voronoi"}
"""Experiments whose model answers take seconds: `pytest -m nightly`."""


@pytest.mark.slow
@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, id=page.stem, marks=[pytest.mark.nightly] if page.stem in LONG else [])
        for page in (*EXPERIMENT_PAGES, *PURSUIT_PAGES)
    ],
)
def test_the_model_answer_of_an_experiment_checks_itself(page):
    answer = open_experiment(solution(page.stem))
    predictions = answer.predictions(mars2d.run(answer.scenario, control=answer.control))
    assert predictions
    assert [p for p in predictions if not p.ok] == []


# -- tables -----------------------------------------------------------------------------------


def table(text: str) -> list[list[str]]:
    """The cells of all rows of the tables in a text, without their rules."""
    rows = [line for line in text.splitlines() if line.startswith("|")]
    cells = [[c.strip() for c in re.split(r"(?<!\\)\|", row)[1:-1]] for row in rows]
    return [row for row in cells if not all(re.fullmatch(r":?-+:?", c) for c in row)]


def test_the_keys_in_its_page_are_those_of_the_window():
    rows = table((ROOT / "docs" / "window.md").read_text(encoding="utf-8"))
    start = rows.index(["Key", "What it does"]) + 1
    wanted = [[" ".join(key.labels), key.help] for key in (*keys.ACTIONS, *keys.MOUSE)]
    assert rows[start : start + len(wanted)] == wanted


def test_the_page_of_fields_is_up_to_date():
    made = importlib.import_module("fields").document()
    assert made == (ROOT / "docs" / "fields.md").read_text(encoding="utf-8"), (
        "run: python docs/make/fields.py"
    )


def verbs() -> dict[str, Any]:
    """The sub-commands and their parsers."""
    return {verb: cli.parser_of(verb) for verb in cli.VERBS}


def test_each_command_has_a_section_and_each_section_a_command():
    text = (ROOT / "docs" / "commands.md").read_text(encoding="utf-8")
    assert re.findall(r"^## mars2d (\w+)$", text, flags=re.M) == list(verbs())
    lines = [[f"[`mars2d {name}`](#mars2d-{name})", line] for name, line in cli.VERBS.items()]
    assert table(text.partition("\n## ")[0])[1:] == lines


@each_case("verb", list(verbs()))
def test_the_options_in_the_commands_document_are_those_of_the_parser(verb):
    text = (ROOT / "docs" / "commands.md").read_text(encoding="utf-8")
    stated, common = (
        options_in(text.partition(f"\n## {title}\n")[2].partition("\n## ")[0])
        for title in (f"mars2d {verb}", "Options of several commands")
    )
    wanted = set()
    for action in verbs()[verb]._actions:
        if "--help" in action.option_strings:
            continue
        names = action.option_strings or [""]
        metavar = action.metavar or ("" if action.nargs == 0 else action.dest)
        wanted |= {f"{name} {metavar}".strip() for name in names}
    assert stated <= wanted <= stated | common


def options_in(section: str) -> set[str]:
    """The options and arguments in the tables of a section."""
    named = (re.fullmatch(r"`(.+)`", row[0]) for row in table(section))
    return {m[1] for m in named if m and (m[1].startswith("--") or m[1].isupper())}


def test_the_exit_codes_in_the_commands_document_are_those_of_the_command_line():
    text = (ROOT / "docs" / "commands.md").read_text(encoding="utf-8")
    section = text.partition("## Exit codes")[2].partition("\n## ")[0]
    stated = {int(row[0]) for row in table(section)[1:]}
    assert stated == {cli.OK, cli.FAULT, cli.BAD_INPUT, cli.INTERRUPTED}


SHAPES = {"cross": scene.Line, "sector": scene.Polygon}
"""What methods of a scene draw that are not called as their shapes."""


def test_what_a_scene_draws_is_documented_with_its_arguments():
    rows = table((ROOT / "docs" / "own_sensor_and_addon.md").read_text(encoding="utf-8"))
    stated = [row[0].strip("`)").split("(") for row in rows[rows.index(["method", "draws"]) + 1 :]]
    drawing = {name for name in vars(Scene) if not name.startswith("_")} - {"extend", "shapes"}
    assert {name for name, _ in stated} == drawing
    for name, call in stated:
        shape = SHAPES.get(name) or getattr(scene, name.capitalize())
        known = {*inspect.signature(getattr(Scene, name)).parameters, *shape.__match_args__}
        assert {word.strip("= ") for word in call.split(",")} <= known, name


def test_each_example_that_checks_itself_is_a_lesson_with_a_picture():
    courses = ("contact.md", "communication.md", "information.md", "laws.md", "sensing.md")
    pages = [*(ROOT / "docs" / name for name in courses), *EXPERIMENTS, *PURSUIT]
    text = "\n".join(page.read_text(encoding="utf-8") for page in pages)
    lessons = set(re.findall(r"^mars2d run (\w+) .*--figure", text, flags=re.M))
    checked = {name for name, path in examples().items() if open_experiment(path).source.checks}
    assert checked <= lessons


def test_the_columns_of_contacts_are_those_of_a_record():
    text = (ROOT / "docs" / "record.md").read_text(encoding="utf-8")
    section = text.partition("## Contacts")[2].partition("\n## ")[0]
    names = [row[0].strip("`") for row in table(section)[1:]]
    assert names == list(mars2d.record.contact.CONTACT.names)


ELSEWHERE = {
    "--version", "--host", "--no-dashboard", "--nworkers", "--nthreads", "--network",
    "--pids-limit", "--read-only",
}  # fmt: skip
"""Options of `mars2d` itself, of Dask and of Docker."""


def test_options_named_anywhere_exist():
    known = {o for sub in verbs().values() for a in sub._actions for o in a.option_strings}
    for document in DOCUMENTS:
        for option in re.findall(r"`(--[a-z-]+)", prose(document)):
            assert option in {*known, *ELSEWHERE}, f"{document.name}: {option}"


def test_files_named_in_the_text_exist():
    for document in EVERYTHING:
        for name in re.findall(
            r"`((?:mars2d|docs|tests|benchmarks|examples)/[^`\s]*)`", prose(document)
        ):
            of_gymnasium = name.endswith("-v0")
            assert of_gymnasium or (ROOT / name).exists(), f"{document.name}: {name}"
    commands = [b.text for b in blocks(ROOT / "CONTRIBUTING.md") if b.language == "sh"]
    for name in re.findall(r"(?:python |^)([\w.]+/[\w./]+)", "\n".join(commands), flags=re.M):
        assert (ROOT / name).exists(), f"CONTRIBUTING.md: {name}"


def test_the_rooms_in_the_design_are_those_of_the_code():
    page = ROOT / "docs" / "design.md"
    drawn = next(b.text for b in blocks(page) if b.text.lstrip().startswith("10 "))
    floors = [line.split() for line in drawn.strip().splitlines()]
    assert [set(rooms) for _, *rooms in reversed(floors)] == LAYERS
    listed = re.findall(r"^\| \[?`(\w+)", page.read_text(encoding="utf-8"), flags=re.M)
    assert sorted(listed) == sorted(set().union(*LAYERS))
    for room in listed:
        assert len((ROOT / "mars2d" / room / "README.md").read_text("utf-8").splitlines()) <= 60


# -- names ------------------------------------------------------------------------------------

OWNERS: dict[str, Any] = {
    "mars2d": mars2d,
    "RobotView": RobotView,
    **{name: getattr(mars2d, name) for name in mars2d.__all__ if name[0].isupper()},
    "PropView": PropView,
    **{kind.__name__: kind for family in (bodies, sensors, props, joints, shapes)
       for kind in vars(family).values() if isinstance(kind, type)},
    **{name: getattr(addons, name) for name in ("Burst", "Communication", "Map")},
}  # fmt: skip


def has(owner: Any, name: str) -> bool:
    """Whether objects of a class, or a module, have an attribute."""
    if hasattr(owner, name):
        return True
    if is_dataclass(owner) and name in {field.name for field in fields(owner)}:
        return True
    if owner is mars2d.World:
        return name in vars(mars2d.World(mars2d.Scenario()))
    if owner is RobotView:
        return name in vars(mars2d.World(mars2d.Scenario()).robots[0])
    return False


@each_case("document", EVERYTHING)
def test_names_in_the_text_exist(document):
    for code in re.findall(r"`([^`\n]+)`", prose(document)):
        named = re.match(r"(\w+)((?:\.\w+)+)", code)
        if named is None or named[1] not in OWNERS:
            continue
        if (ROOT / "mars2d" / code.partition(" ")[0]).exists():
            continue
        owner = OWNERS[named[1]]
        for name in named[2][1:].split("."):
            assert has(owner, name), f"{document.name}: {code}"
            owner = getattr(owner, name, None)
            if owner is None or not isinstance(owner, (type, ModuleType)):
                break
