"""The verb ``paper``: the figures, the page that shows them, its errors, and the browser's view."""

from __future__ import annotations

import json
import math
import re
import shlex
from html import unescape
from pathlib import Path

import pytest

import mars2d
from mars2d.cli import command_line as cli
from mars2d.cli.verbs import paper as verb
from mars2d.reports.paper.figures import FIGURES, Figure, Run
from mars2d.reports.paper.make import MARK, setting_of
from mars2d.scenario.experiment import open_module
from tests.cases import each_case
from tests.processes import mars

FAILS = """
from mars2d import Prediction, Scenario

scenario = Scenario(stop_time=1)


def control(world):
    return 0.5, 0.0


def checks(record):
    yield Prediction("way <of> \\"it\\" & more", 1.0, record.pose[-1, 0, 0], 0.1, "m")
"""

BREAKS = """
from mars2d import Scenario

scenario = Scenario(stop_time=1)


def control(world):
    raise ValueError("no law today")
"""


def figure(*runs, number=2):
    return Figure(
        number=number, title="A figure", section="4", paper="Reports this.", theory="x &lt; 2.",
        law=("v = k r",), source="Somebody", runs=runs,
    )  # fmt: skip


def files_of(figure):
    """The names of a figure's files: a .png and a .pdf of each picture."""
    return [f"{each.stem}{suffix}" for each in figure.runs for suffix in (".png", ".pdf")]


def written(folder, name, code):
    path = folder / name
    path.write_text(code, encoding="utf-8")
    return str(path)


@pytest.fixture(scope="module")
def cheap(tmp_path_factory):
    """The page of Figure 2 alone, made by the command as it is typed."""
    folder = tmp_path_factory.mktemp("cheap") / "out"
    done = mars("paper", folder, "--only", "2")
    assert (done.returncode, done.stderr) == (0, "")
    return folder


def check_page(folder, figures):
    """Check what a page holds, and return its text as a reader sees it."""
    text = (folder / "index.html").read_text(encoding="utf-8")
    assert MARK in text
    files = [name for f in FIGURES if f.number in figures for name in files_of(f)]
    assert re.findall(r'<img src="([^"]+)"', text) == files[::2]
    assert re.findall(r'id="(figure-\d)"', text) == [f"figure-{n}" for n in figures]
    for name in files:
        data = (folder / name).read_bytes()
        assert data.startswith(b"%PDF-" if name.endswith(".pdf") else b"\x89PNG")
    assert "http" not in text
    return seen(text)


def seen(text):
    """What a browser shows of a page."""
    return unescape(re.sub(r"<[^>]*>", " ", text))


def check_numbers(folder, seed=0):
    """Check that all numbers are finite, and return them by the figures' numbers."""
    text = (folder / "numbers.json").read_text(encoding="utf-8")
    numbers = json.loads(text)
    assert numbers["seed"] == seed
    for made in numbers["figures"]:
        for picture in made["pictures"]:
            for check in picture["checks"]:
                for key in ("predicted", "measured", "tolerance"):
                    assert math.isfinite(check[key]), (made["figure"], check)
    return {made["figure"]: made for made in numbers["figures"]}


@pytest.mark.slow
def test_one_figure_alone_makes_its_page_its_pictures_and_its_numbers(cheap, typed):
    found = check_page(cheap, [2])
    (made,) = check_numbers(cheap).values()
    assert made["ok"]
    assert made["pictures"][0]["digest"] == mars2d.run("random_walk").digest
    assert made["pictures"][0]["digest"] in found
    assert {path.name for path in cheap.iterdir()} == {
        "index.html", "numbers.json", "fig2_random_walk.pdf", "fig2_random_walk.png",
    }  # fmt: skip
    (cheap / "notes.txt").write_text("mine")  # other files in it are left
    assert typed("paper", cheap, "--only", "2")[0] == 0
    check_page(cheap, [2])
    assert (cheap / "notes.txt").read_text() == "mine"


@pytest.mark.nightly
def test_the_command_under_a_picture_makes_the_same_file_alone(cheap, tmp_path, monkeypatch):
    (made,) = check_numbers(cheap).values()
    words = shlex.split(made["pictures"][0]["command"])
    assert words[0] == "mars2d"
    monkeypatch.chdir(tmp_path)
    assert cli.main(words[1:]) == 0
    name = "fig2_random_walk.pdf"
    assert (tmp_path / name).read_bytes() == (cheap / name).read_bytes()


@pytest.mark.nightly
def test_the_whole_paper_is_made_on_one_page_and_every_number_holds(tmp_path):
    done = mars("paper", tmp_path / "out")
    assert (done.returncode, done.stderr) == (0, "")
    folder, every = tmp_path / "out", list(range(2, 10))
    found = check_page(folder, every)
    numbers = check_numbers(folder)
    assert list(numbers) == every
    assert [made["figure"] for made in numbers.values() if not made["ok"]] == []
    assert found.count("NOT OK") == 0
    lines = done.stdout.splitlines()
    assert [line.split()[1] for line in lines[:-1]] == [str(n) for n in every]
    assert lines[-1] == f"page: {folder / 'index.html'}"
    assert stated_in_the_documents() <= set(re.findall(r"[\d.]*\d", found))
    for made in numbers.values():
        assert made["pictures"][0]["checks"], made["figure"]
        for picture in made["pictures"]:
            parsed = cli.parse(shlex.split(picture["command"])[1:])
            assert parsed.figure == Path(f"{picture['picture']}.pdf")
            assert parsed.headless
    files = {path.name for path in folder.iterdir()}
    assert files == {name for f in FIGURES for name in files_of(f)} | {"index.html", "numbers.json"}


def stated_in_the_documents():
    """The numbers that the table in docs/paper.md states, as they stand there."""
    text = (Path(__file__).parents[2] / "docs" / "paper.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d) \|.*\|([^|]*)\|$", text, flags=re.M)
    assert [int(number) for number, _ in rows] == list(range(2, 10))
    return {number for _, cell in rows for number in re.findall(r"`([\d.]+)`", cell)}


def test_figures_are_those_of_the_paper_and_each_experiment_states_its_setting():
    assert [f.number for f in FIGURES] == list(range(2, 10))
    files = [name for f in FIGURES for name in files_of(f)]
    assert len(files) == len(set(files))
    for each in FIGURES:
        for run in each.runs:
            assert re.match("(C|c)entralised|(D|d)istributed", setting_of(run.experiment))
            assert open_module(run.experiment).checks
        assert all(text.endswith(".") for text in (each.paper, each.theory))


# -- the folder -------------------------------------------------------------------------------


@each_case("name", ["notes.txt", "index.html"])
def test_a_folder_of_something_else_is_refused_and_left_as_it_is(typed, name):
    folder = Path(name).with_suffix(".d")
    folder.mkdir()
    (folder / name).write_text("<html>mine</html>")
    code, out, err = typed("paper", folder, "--only", "2")
    assert (code, out) == (2, "")
    assert f"holds {name}, and no page of `mars2d paper`" in err
    assert {p.name: p.read_text() for p in folder.iterdir()} == {name: "<html>mine</html>"}


@each_case(
    "arguments, words",
    [
        ((), "OUT"),
        (("file.txt",), "file.txt: this is a file; expected a folder"),
        (("missing/out",), "missing/out: can't be written: No such file or directory"),
        (("file.txt/out",), "file.txt/out: can't be written: Not a directory"),
        (("out", "--only", "1"), "expected numbers of figures from 2 to 9, such as 4,7"),
        (("out", "--only", "two"), "'two': expected numbers"),
        (("out", "--only", ""), "'': expected numbers"),
        (("out", "--seed", "-1"), "seed"),
        (("out", "--onyl", "2"), "did you mean '--only'?"),
    ],
)
def test_what_can_not_be_done_is_said_in_one_line(typed, arguments, words):
    Path("file.txt").write_text("a file")
    code, out, err = typed("paper", *arguments)
    assert (code, out) == (2, "")
    assert words in err
    assert len(err.splitlines()) == 1
    assert not Path("out").exists()
    assert Path("file.txt").read_text() == "a file"


# -- what fails -------------------------------------------------------------------------------


def test_a_prediction_that_does_not_hold_is_red_and_named_and_is_no_error(
    typed, tmp_path, monkeypatch
):
    short = written(tmp_path, "short.py", FAILS)
    run = Run("fig2_short", short, "Too short", "It goes half as far.")
    monkeypatch.setattr(verb, "FIGURES", (figure(run),))
    code, out, err = typed("paper", "out")
    assert (code, err) == (0, "")
    assert "0 of 1 prediction ok" in out
    assert 'NOT OK: Too short: way <of> "it" & more' in out
    assert "1 prediction does not hold\n" in out
    text = Path("out/index.html").read_text(encoding="utf-8")
    assert "Not as predicted: 1 of 1 number is outside of its tolerance" in text
    assert "way &lt;of&gt;" in text
    assert "✗ NOT OK" in text


@pytest.mark.slow
def test_a_figure_that_can_not_be_made_is_named_and_the_others_are_made(
    typed, tmp_path, monkeypatch
):
    broken = Run("fig2_broken", written(tmp_path, "broken.py", BREAKS), "Broken", "Nothing.")
    walk = Run("fig3_random_walk", "random_walk", "Walk", "Short.", settings=["stop_time=5"])
    every = (figure(broken), figure(walk, number=3))
    monkeypatch.setattr(verb, "FIGURES", every)
    code, out, err = typed("paper", "out")
    assert code == 1
    assert "not all was made: see figure 2 above" in err
    assert "ValueError: no law today" in out
    text = Path("out/index.html").read_text(encoding="utf-8")
    assert "no law today" in text
    assert re.findall(r'<img src="([^"]+)"', text) == ["fig3_random_walk.png"]


def test_times_after_the_end_of_a_run_show_its_end():
    run = Run("stem", "pursuit_voronoi", "P", "S.", times=(0, 50, 70, 98))
    assert run.times_until(60.0) == [0, 50, 60]
    assert run.times_until(500.0) == [0, 50, 70, 98]
    assert run.command(0, 97.1).endswith("--figure stem.pdf --at 0,50,70,97.1")
    moved = Run("other", "path_planning", "P", "S.", settings=["detour=(22, 9.8)"])
    assert cli.parse(shlex.split(moved.command(3, 1.0))[1:]).seed == 3
    assert "--set 'detour=(22, 9.8)'" in moved.command(3, 1.0)
