"""The verb ``paper``: the figures, the page that shows them, its errors, and the browser's view."""

from __future__ import annotations

import json
import math
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import mars2d
from mars2d.cli import command_line as cli
from mars2d.cli.verbs import paper as verb
from mars2d.reports.paper.figure import Figure, Picture, Result, Run
from mars2d.reports.paper.figures import FIGURES
from mars2d.reports.paper.folder import prepare
from mars2d.reports.paper.make import _setting, make, make_all
from mars2d.reports.paper.page import MARK, page, typeset
from mars2d.reports.paper.studies.base import Study
from mars2d.scenario.experiment import open_module
from mars2d.scenario.prediction import Prediction
from tests.cases import each_case
from tests.processes import PATIENCE, mars, wait_until

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


def figure(*runs, number=2, studies=None, title="A figure"):
    return Figure(
        number=number, title=title, section="4", paper="Reports <this>.", theory="x_i < 2.",
        law=("v = -k rho",), source="Somebody & others", runs=runs, studies=studies or {},
    )  # fmt: skip


def written(folder, name, code):
    path = folder / name
    path.write_text(code, encoding="utf-8")
    return str(path)


@pytest.fixture
def paper(tmp_path, monkeypatch, capsys):
    """Run the verb in an empty folder; return exit code, stdout and stderr."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        capsys.readouterr()
        code = cli.main(["paper", *map(str, arguments)])
        return code, *capsys.readouterr()

    return run


@pytest.fixture(scope="module")
def cheap(tmp_path_factory):
    """The page of Figure 2 alone, made by the command as it is typed."""
    folder = tmp_path_factory.mktemp("cheap") / "out"
    done = mars("paper", folder, "--only", "2")
    assert (done.returncode, done.stderr) == (0, "")
    return folder


# -- a page, as a browser and a screen reader find it -----------------------------------------

EMPTY = {"meta", "img", "br", "link", "hr", "input"}


class Page(HTMLParser):
    """Reads a page and keeps what is asked about; raises AssertionError where tags don't match."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.open, self.tags, self.headings, self.text = [], [], [], {}
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        names = [name for name, _ in attributes]
        assert len(names) == len(set(names)), self.get_starttag_text()
        self.tags.append((tag, dict(attributes)))
        if tag not in EMPTY:
            self.open.append(tag)
        if re.fullmatch("h[1-6]", tag):
            self.headings.append(int(tag[1]))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, self.getpos()

    def handle_data(self, data):
        if self.open:
            self.text.setdefault(self.open[-1], []).append(data)

    def all(self, tag):
        return [attributes for name, attributes in self.tags if name == tag]

    def words(self):
        return " ".join(" ".join(data).strip() for data in self.text.values())


def check_page(folder, figures):
    """Check all that a page must be, and return it."""
    text = (folder / "index.html").read_text(encoding="utf-8")
    assert text.startswith("<!DOCTYPE html>\n<html lang=")
    assert MARK in text
    found = Page(text)
    ids = [attributes["id"] for _, attributes in found.tags if "id" in attributes]
    assert len(ids) == len(set(ids))
    assert {f"figure-{number}" for number in figures} <= set(ids)
    assert [i for i in ids if re.fullmatch(r"figure-\d", i)] == [f"figure-{n}" for n in figures]
    images = found.all("img")
    stems = [stem for f in FIGURES if f.number in figures for stem in f.stems]
    assert [image["src"] for image in images] == [f"{stem}.png" for stem in stems]
    for image in images:
        file = folder / image["src"]
        assert len(image["alt"]) > 20
        with Image.open(file) as picture:
            assert picture.size == (int(image["width"]), int(image["height"]))
            assert np.ptp(np.asarray(picture.convert("L"))) > 100  # something is drawn
        assert file.with_suffix(".pdf").read_bytes().startswith(b"%PDF-")
    for link in found.all("a"):
        target = link["href"]
        known = target[1:] in ids if target.startswith("#") else (folder / target).is_file()
        assert known, target
    assert not found.all("script") + found.all("link")
    assert "http" not in text
    assert "url(" not in text
    assert found.headings[0] == 1
    assert found.headings.count(1) == 1
    steps = np.diff(found.headings)
    assert steps.max() <= 1  # no level is left out
    assert len(found.all("caption")) == len(found.all("table"))
    assert all("scope" in cell for cell in found.all("th"))
    assert all(i["aria-labelledby"] in ids for i in found.all("section"))
    return found


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
            lengths = {len(column) for column in picture["columns"].values()}
            assert len(lengths) <= 1
            for name, column in picture["columns"].items():
                assert all(v is not None and math.isfinite(v) for v in column), name
    return {made["figure"]: made for made in numbers["figures"]}


@pytest.mark.slow
def test_one_figure_alone_makes_its_page_its_pictures_and_its_numbers(cheap):
    found = check_page(cheap, [2])
    (made,) = check_numbers(cheap).values()
    assert made["ok"]
    assert made["pictures"][0]["digest"] == mars2d.run("random_walk").digest
    assert made["pictures"][0]["digest"] in found.words()
    assert {path.name for path in cheap.iterdir()} == {
        "index.html", "numbers.json", "fig2_random_walk.pdf", "fig2_random_walk.png",
    }  # fmt: skip


@pytest.mark.slow
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
    assert found.words().count("NOT OK") == 0
    assert not [a for _, a in found.tags if a.get("class") == "wrong"]
    lines = done.stdout.splitlines()
    assert [line.split()[1] for line in lines[:-1]] == [str(n) for n in every]
    assert lines[-1] == f"page: {folder / 'index.html'}"
    assert stated_in_the_documents() <= set(re.findall(r"[\d.]*\d", found.words()))
    for made in numbers.values():
        assert made["pictures"][0]["checks"], made["figure"]
        for picture in made["pictures"]:
            if picture["command"]:
                parsed = cli.parser().parse_args(shlex.split(picture["command"])[1:])
                assert parsed.figure == Path(f"{picture['picture']}.pdf")
                assert parsed.headless
    files = {path.name for path in folder.iterdir()}
    assert files == {name for f in FIGURES for name in f.files} | {"index.html", "numbers.json"}


def stated_in_the_documents():
    """The numbers that the table in docs/paper.md states, as they stand there."""
    text = (Path(__file__).parents[2] / "docs" / "paper.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d) \|.*\|([^|]*)\|$", text, flags=re.M)
    assert [int(number) for number, _ in rows] == list(range(2, 10))
    return {number for _, cell in rows for number in re.findall(r"`([\d.]+)`", cell)}


def test_figures_are_those_of_the_paper_and_each_experiment_states_its_setting():
    assert [f.number for f in FIGURES] == list(range(2, 10))
    stems = [stem for f in FIGURES for stem in f.stems]
    assert len(stems) == len(set(stems))
    for each in FIGURES:
        for run in each.runs:
            assert re.match("(C|c)entralised|(D|d)istributed", _setting(run.experiment))
            assert open_module(run.experiment).checks
        assert all(text.endswith(".") for text in (each.paper, each.theory))


def test_the_index_of_the_experiments_states_each_ones_setting_and_figure():
    index = Path(__file__).parents[2] / "docs" / "experiments" / "index.md"
    rows = re.findall(
        r"^\| \[`(\w+)`\]\(\w+\.md\) \| (\d?) ?\| ([^|]+) \|",
        index.read_text(encoding="utf-8"), flags=re.M,
    )  # fmt: skip
    assert len(rows) == 12
    figures = {run.experiment: f"{f.number}" for f in FIGURES for run in f.runs}
    for name, number, setting in rows:
        assert number == figures.get(name, ""), name
        stated = _setting(name).replace(" with", ",").lower()
        assert stated.startswith(setting), f"{name}: {stated}"


# -- the folder -------------------------------------------------------------------------------


@pytest.mark.slow
def test_the_seed_is_that_of_the_runs(paper):
    code, _, _ = paper("out", "--only", "2", "--seed", "7")
    assert code == 0
    (made,) = check_numbers(Path("out"), seed=7).values()
    assert made["pictures"][0]["digest"] == mars2d.run("random_walk", seed=7).digest
    assert "--seed 7" in made["pictures"][0]["command"]


def test_its_own_folder_is_replaced_with_all_that_was_in_it(paper, cheap):
    shutil.copytree(cheap, "out")
    Path("out/fig7_radius.png").write_bytes(b"of an earlier run")
    Path("out/.hidden").write_text("somebody's")
    assert paper("out", "--only", "2")[0] == 0
    assert not Path("out/fig7_radius.png").exists()
    assert Path("out/.hidden").read_text() == "somebody's"
    for name in ("index.html", "numbers.json", "fig2_random_walk.png", "fig2_random_walk.pdf"):
        assert Path("out", name).read_bytes() == (cheap / name).read_bytes()


@pytest.mark.parametrize(
    "name", ["notes.txt", "fig2_mine.png", "index.html", "fig2_random_walk.png/"]
)
def test_a_folder_with_other_things_in_it_is_refused_and_left_as_it_is(paper, cheap, name):
    shutil.copytree(cheap, "out")
    before = {path.name: path.read_bytes() for path in Path("out").iterdir()}
    other = Path("out", name)
    if name.endswith("/"):
        other.unlink()
        other.mkdir()
        del before[other.name]
    else:
        other.write_text("<html>mine</html>")
        before[name] = b"<html>mine</html>"
    code, out, err = paper("out", "--only", "2")
    assert (code, out) == (2, "")
    assert f"holds {other.name}, which is not of `mars2d paper`" in err
    assert {p.name: p.read_bytes() for p in Path("out").iterdir() if p.is_file()} == before


@each_case(
    "arguments, words",
    [
        ((), "OUT"),
        (("file.txt",), "file.txt: this is a file; expected a folder"),
        (("missing/out",), "missing/out: there is no folder missing"),
        (("file.txt/out",), "file.txt/out: there is no folder file.txt"),
        (("out", "--only", "1"), "expected numbers of figures from 2 to 9, such as 4,7"),
        (("out", "--only", "two"), "'two': expected numbers"),
        (("out", "--only", ""), "'': expected numbers"),
        (("out", "--seed", "-1"), "seed"),
        (("out", "--onyl", "2"), "did you mean '--only'?"),
    ],
)
def test_what_can_not_be_done_is_said_in_one_line(paper, arguments, words):
    Path("file.txt").write_text("a file")
    code, out, err = paper(*arguments)
    assert (code, out) == (2, "")
    assert words in err
    assert len(err.splitlines()) == 1
    assert not Path("out").exists()
    assert Path("file.txt").read_text() == "a file"


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="needs a folder nobody can write")
def test_a_folder_that_can_not_be_written_is_known_before_the_first_run(paper):
    code, out, err = paper("/proc/figures")
    assert (code, out) == (2, "")
    assert "/proc/figures: can't be written" in err


def test_a_folder_of_which_nothing_is_left_but_the_pictures_is_still_its_own(tmp_path):
    for name in FIGURES[0].files:
        (tmp_path / name).write_bytes(b"")
    prepare(tmp_path, FIGURES[0].files)
    assert list(tmp_path.iterdir()) == []


# -- what fails -------------------------------------------------------------------------------


def test_a_prediction_that_does_not_hold_is_red_and_named_and_is_no_error(
    paper, tmp_path, monkeypatch
):
    run = Run(written(tmp_path, "short.py", FAILS), "Too short", "It goes half as far.")
    monkeypatch.setattr(verb, "FIGURES", (figure(run),))
    code, out, err = paper("out")
    assert (code, err) == (0, "")
    assert "0 of 1 prediction ok" in out
    assert 'NOT OK: Too short: way <of> "it" & more' in out
    assert "1 prediction does not hold\n" in out
    found = Page(Path("out/index.html").read_text(encoding="utf-8"))
    (wrong,) = [a for _, a in found.tags if a.get("class") == "wrong"]
    assert wrong["role"] == "alert"
    assert "Not as predicted: 1 of 1 number is outside of its tolerance" in found.words()
    assert 'way <of> "it" & more' in found.words()  # escaped in the page, whole in the browser
    assert "✗ NOT OK" in found.words()


def test_a_figure_that_can_not_be_made_is_named_and_the_others_are_made(
    paper, tmp_path, monkeypatch
):
    broken = Run(written(tmp_path, "broken.py", BREAKS), "Broken", "Nothing.")
    study = {"never": lambda records: pytest.fail("there is no record to study")}
    walk = Run("random_walk", "Walk", "Short.", options={"stop_time": 5})
    every = (figure(broken, studies=study), figure(walk, number=3))
    monkeypatch.setattr(verb, "FIGURES", every)
    monkeypatch.setattr("mars2d.reports.paper.make.worker_count", lambda _: 1)
    code, out, err = paper("out")
    assert code == 1
    assert "not all was made: see figure 2 above" in err
    assert "ValueError: no law today" in out
    assert "never: not made, since it needs a run that failed" in out
    found = Page(Path("out/index.html").read_text(encoding="utf-8"))
    assert "no law today" in found.words()
    assert [image["src"] for image in found.all("img")] == ["fig3_random_walk.png"]


def test_an_experiment_that_is_not_there_is_a_problem_in_words(tmp_path):
    result = make(figure(Run("rendom_walk", "None", "Nothing.")), tmp_path)
    assert not result.pictures
    assert "did you mean 'random_walk'?" in result.problems[0]


def test_a_number_that_is_not_finite_is_null_in_the_json_and_said_on_the_page():
    lost = Prediction("lost", 1.0, math.nan, 0.1)
    picture = Picture(
        "fig2_x", "X", "An x.", "x", (1, 1), predictions=(lost,), columns={"x": [math.inf]}
    )
    result = Result(2, pictures=(picture,))
    assert result.as_dict()["pictures"][0]["checks"][0]["measured"] is None
    assert result.as_dict()["pictures"][0]["columns"] == {"x": [None]}
    assert not result.ok
    assert "not a number" in page([figure()], {2: result}, 0)


@pytest.mark.slow
def test_studies_get_the_records_in_order_and_the_seed_with_them(tmp_path):
    seen = []

    def study(records):
        seen.extend(records)
        from mars2d.reports.paper.studies.base import charts

        return Study("A study", "Shows.", "Two axes.", lambda: charts(2)[0], columns={"a": [1.0]})

    runs = [Run("random_walk", "W", "S.", options={"stop_time": t}, name=f"{t}") for t in (2, 3)]
    result = make(figure(*runs, studies={"study": study}), tmp_path, seed=4)
    assert result.problems == ()
    assert [(r.seed, r.time[-1]) for r in seen] == [(4, 2), (4, 3)]
    assert [p.stem for p in result.pictures] == [
        "fig2_random_walk_2", "fig2_random_walk_3", "fig2_study",
    ]  # fmt: skip


def test_times_after_the_end_of_a_run_show_its_end():
    run = Run("pursuit_voronoi", "P", "S.", times=(0, 50, 70, 98))
    assert run.times_until(60.0) == [0, 50, 60]
    assert run.times_until(500.0) == [0, 50, 70, 98]
    words = run.command("stem", 0, 97.1)
    assert words.endswith("--figure stem.pdf --at 0,50,70,97.1")
    moved = Run("path_planning", "P", "S.", options={"detour": (22, 9.8)})
    assert cli.parser().parse_args(shlex.split(moved.command("stem", 3, 1.0))[1:]).seed == 3
    assert "--set 'detour=(22, 9.8)'" in moved.command("stem", 3, 1.0)


# -- processes --------------------------------------------------------------------------------


@pytest.mark.nightly
def test_what_comes_out_does_not_depend_on_the_number_of_processes(tmp_path):
    every = [
        figure(Run("random_walk", "W", "S.", options={"stop_time": 20}), number=number)
        for number in (2, 3, 4)
    ]
    made = []
    for count in (1, 3):
        folder = tmp_path / f"{count}"
        folder.mkdir()
        done: dict[int, Result] = {}
        seen = []
        make_all(every, folder, 5, done, lambda n, active: seen.append((n, *active)), count)  # noqa: B023
        files = {path.name: path.read_bytes() for path in folder.iterdir()}
        made.append((files, page(every, done, 5)))
        assert seen[0][0] == 0
        assert {number for _, *active in seen for number in active} == {2, 3, 4}
    assert made[0] == made[1]
    assert len(made[0][0]) == 6


def is_group(number):
    """Return whether a group of processes has members."""
    try:
        os.killpg(number, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT for a child there")
@pytest.mark.parametrize(
    "only", [pytest.param("2,4,7", marks=pytest.mark.nightly), "7"]
)  # in processes of their own, and in one
def test_ctrl_c_ends_it_soon_and_says_what_is_there(tmp_path, only):
    folder = tmp_path / "out"
    child = subprocess.Popen(
        [sys.executable, "-m", "mars2d", "paper", str(folder), "--only", only],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    while not list(folder.glob("*.pdf")):
        assert child.poll() is None
        time.sleep(0.002)  # not wait_until: it may end soon after
    os.killpg(child.pid, signal.SIGINT)  # as a terminal does: to all of them
    out, err = child.communicate(timeout=PATIENCE)
    assert child.returncode == 130
    assert err == "mars2d: interrupted\n"
    assert re.search(r"figure 7 .* not made\n", out)
    assert f"page: {folder / 'index.html'}" in out
    found = Page((folder / "index.html").read_text(encoding="utf-8"))
    assert re.search(r"Broken off: figures? .*7 (was|were) not made\.", found.words())
    check_numbers(folder)
    assert not list(folder.glob("fig7*"))  # nor half a picture
    wait_until(lambda: not is_group(child.pid))  # no worker is left behind


# -- formulas, and the browser ----------------------------------------------------------------


@each_case(
    "text, html",
    [
        ("x_i^2", "x<sub>i</sub><sup>2</sup>"),
        ("v_{max} < rho_0", "v<sub>max</sub> &lt; &rho;<sub>0</sub>"),
        ("a - b, (-c), 2^{-1/2}", "a &minus; b, (&minus;c), 2<sup>&minus;1/2</sup>"),
        ("well-known phi, sumo, (a) . (b). So", "well-known &phi;, sumo, (a) &middot; (b). So"),
        ('<b> & "c"', '&lt;b&gt; &amp; "c"'),
    ],
)
def test_formulas_are_set_with_greek_letters_subscripts_and_a_minus(text, html):
    assert typeset(text) == html


CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")


@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="needs chromium")
@pytest.mark.parametrize("width", [1280, 400])
def test_a_browser_shows_the_page_with_its_pictures(cheap, tmp_path, width):
    """The pictures are there, and nothing is wider than the window."""
    probe = """<script>addEventListener("load", () => {
      const broken = [...document.images].filter(i => !i.complete || !i.naturalWidth);
      const wide = document.documentElement.scrollWidth > document.documentElement.clientWidth;
      document.title = `images ${document.images.length} broken ${broken.length} wide ${wide}`;
    })</script></body>"""
    folder = tmp_path / "shown"
    shutil.copytree(cheap, folder)
    text = (folder / "index.html").read_text(encoding="utf-8")
    (folder / "probe.html").write_text(text.replace("</body>", probe), encoding="utf-8")
    options = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'me'}"]
    done = subprocess.run(
        [CHROMIUM, *options, f"--window-size={width},900", "--virtual-time-budget=5000",
         "--dump-dom", (folder / "probe.html").as_uri()],
        capture_output=True, text=True, timeout=120, check=True,
    )  # fmt: skip
    assert "<title>images 1 broken 0 wide false</title>" in done.stdout
