"""The documentation site: its doors, its gallery and reference, and that it needs no network."""

import importlib
import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from mars2d.scenario.examples import examples
from tests.cases import each_case
from tests.processes import served

ROOT = Path(__file__).parents[2]
DOORS = {"student": 5, "teacher": 6, "researcher": 7}
MOST_WORDS = 30_000

needs_mkdocs = pytest.mark.skipif(
    any(importlib.util.find_spec(name) is None for name in ("material", "mkdocstrings")),
    reason="mkdocs-material and mkdocstrings are not installed",
)


def way(door):
    """The pages that a door leads through, in their order."""
    page = ROOT / "docs" / "doors" / f"{door}.md"
    numbered = re.findall(r"^\d\. \[[^]]+\]\(([^)]+)\)", page.read_text("utf-8"), flags=re.M)
    return [page, *((page.parent / each).resolve() for each in numbered)]


@each_case("door, most", DOORS.items())
def test_the_way_through_a_door_is_short(door, most):
    pages = way(door)
    assert 3 <= len(pages) - 1 <= most
    assert sum(len(page.read_text("utf-8").split()) for page in pages) < MOST_WORDS


def test_the_readme_is_short_and_has_six_doors():
    text = (ROOT / "README.md").read_text("utf-8")
    assert len(text.split()) < 1000
    assert len(re.findall(r"^- \*\*", text.partition("## Six doors")[2], flags=re.M)) == 6


def missing_pictures(site, pages):
    """Yield the pages with a picture that is not there, and its address."""
    for page in pages:
        for address in re.findall(r'<img[^>]* src="([^"]+)"', page.read_text("utf-8")):
            at = page.parent if not address.startswith("/") else site
            if not address.startswith("data:") and not (at / address.lstrip("/")).is_file():
                yield page.relative_to(site), address


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    folder = tmp_path_factory.mktemp("site")
    build = "-m", "mkdocs", "build", "--strict", "-d", folder
    for words in (["docs/make/pages.py"], build):
        done = subprocess.run(
            [sys.executable, *words], cwd=ROOT, check=False, capture_output=True, text=True,
            env=os.environ | {"NO_MKDOCS_2_WARNING": "1"},
        )  # fmt: skip
        assert done.returncode == 0, done.stdout + done.stderr
    return folder


@needs_mkdocs
@pytest.mark.slow
@pytest.mark.nightly
def test_the_site_is_built_and_has_all_of_it(site, browser):
    gallery = (site / "gallery" / "index.html").read_text("utf-8")
    assert [name for name in examples() if f"mars2d demo {name}<" not in gallery] == []
    modules = re.findall(
        r"^    \"(mars2d[\w.]*)\"", (ROOT / "docs" / "make" / "pages.py").read_text()
    )
    contents = (site / "reference" / "index.html").read_text("utf-8")
    for module in modules:
        for name in importlib.import_module(module).__all__:
            assert name.startswith("__") or f">{name}</code>" in contents, (module, name)
    assert (site / "try" / "index.html").is_file()
    assert len([*(site / "try").glob("mars2d-*-none-any.whl")]) == 1
    pages = list(site.rglob("*.html"))
    assert len(pages) > 200
    assert [*missing_pictures(site, pages)] == []

    with served(site) as here:
        page, asked = browser.new_page(), []
        page.on("request", lambda request: asked.append(request.url))
        page.goto(here)
        page.click(".md-search__input")
        page.keyboard.type("RandomStarts", delay=20)
        page.wait_for_selector("article:has-text('from mars2d import RandomStarts')")
        page.goto(f"{here}gallery/")
        page.wait_for_selector("img[src*=plan_push]", state="attached")
        page.close()
    assert [url for url in asked if not url.startswith((here, "data:", "blob:"))] == []
