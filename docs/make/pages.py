"""Write the pages of the documentation site: those of docs/, the gallery, and the reference.

    python docs/make/pages.py
    mkdocs build --strict

The gallery has all examples; the reference has a page for each public name, with its fields and
the places that use it. Both follow from the package, so nothing is kept by hand. The pages are
written to build/pages, so that any generator can make the site of them.
"""

from __future__ import annotations

import importlib
import importlib.util
import re
import shutil
import tomllib
from collections.abc import Iterator
from functools import cache
from html import escape
from pathlib import Path
from types import ModuleType
from typing import Any

from mars2d.core.description import Description
from mars2d.scenario.examples import (
    courses,
    examples,
    experiment_name,
    thumbnail_of,
    title_of,
)
from mars2d.scenario.registry import summary

DOCS = Path(__file__).parents[1]
ROOT = DOCS.parent
PAGES = ROOT / "build" / "pages"

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
REPOSITORY = PROJECT["urls"]["Homepage"]

MODULES = (
    "mars2d", "mars2d.bodies", "mars2d.sensors", "mars2d.addons", "mars2d.geometry",
    "mars2d.scenario", "mars2d.record", "mars2d.rl", "mars2d.testing", "mars2d.study",
)  # fmt: skip
"""The modules whose names are public, in the order in which people meet them."""


def main() -> None:
    """Write all pages, their pictures, and the page on which experiments run in a browser."""
    shutil.rmtree(PAGES, ignore_errors=True)
    beside = shutil.ignore_patterns("make", "__pycache__", "try")
    shutil.copytree(DOCS, PAGES, ignore=beside)
    for picture in (ROOT / "examples").rglob("*.png"):
        there = PAGES / picture.relative_to(ROOT)
        there.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(picture, there)
    made = {"gallery.md": gallery(), "reference/index.md": contents()}
    made |= {page_of(module, name): reference(module, name) for module, name in public_names()}
    made |= {str(page.relative_to(DOCS)): page.read_text("utf-8") for page in DOCS.rglob("*.md")}
    for name, text in made.items():
        page = PAGES / name
        page.parent.mkdir(parents=True, exist_ok=True)
        page.write_text(led_on(text, Path(name)), "utf-8")
    neighbour("try_it").main([str(PAGES / "try")])


def led_on(markdown: str, name: Path) -> str:
    """Lead links to files beside docs/ to the repository, and thumbnails to those of the site."""
    folder = (DOCS / name).parent

    def led(match: re.Match[str]) -> str:
        path, _, anchor = match[2].partition("#")
        goal = (folder / path).resolve()
        if re.match(r"[a-z]+:", match[2]) or not path or goal.is_relative_to(DOCS):
            return match[0]
        kind = "tree" if goal.is_dir() else "blob"
        target = f"{REPOSITORY}/{kind}/main/{goal.relative_to(ROOT)}"
        return f"{match[1]}{target}{'#' if anchor else ''}{anchor})"

    up = "../" * (len(name.parts) - (name.stem == "index"))
    markdown = re.sub(r'src="[./]*(examples/[^"]+)"', rf'src="{up}\1"', markdown)
    return re.sub(r"(\]\()([^)\s]+)\)", led, markdown)


# -- the gallery ----------------------------------------------------------------------------------


def gallery() -> str:
    """Return the page of all examples, by course."""
    text = (
        "# Gallery\n\nAll examples, by course. `mars2d demo NAME` plays one, `mars2d copy NAME` "
        'copies it for you to change, and <a href="../try/index.html">Try it</a> runs it in your '
        "browser.\n"
    )
    for course, names in courses().items():
        cards = "\n".join(card(name) for name in names)
        text += f'\n## {course}\n\n<div class="gallery" markdown>\n\n{cards}\n</div>\n'
    return text


def card(name: str) -> str:
    """Return the card of an example: its picture, its line, its command, its page and film."""
    title, line = title_of(name)
    pictures = "".join(
        f'<img class="{looks}-picture" loading="lazy" alt="" '
        f'src="../{thumbnail_of(name, looks).relative_to(ROOT)}">'
        for looks in ("light", "dark")
    )
    links = [
        f"[source](../{examples()[name].relative_to(ROOT)})",
        f'<a href="../try/index.html?example={name}">try it</a>',
    ]
    for folder in ("experiments", "pursuit"):
        if (DOCS / folder / f"{name}.md").exists():
            links.insert(0, f"[page]({folder}/{name}.md)")
    if (DOCS / "pictures" / f"{name}.gif").exists():
        links.append(f"[film](pictures/{name}.gif)")
    return (
        f"<figure markdown>\n{pictures}\n<figcaption markdown>\n"
        f"**{escape(title)}.** {escape(line)}\n"
        f"`mars2d demo {name}`<br>{' · '.join(links)}\n</figcaption>\n</figure>\n"
    )


# -- the reference --------------------------------------------------------------------------------


@cache
def public_names() -> tuple[tuple[str, str], ...]:
    """Return the module and the name of everything public, each thing once."""
    seen: set[Any] = set()
    found = []
    for module in MODULES:
        held = importlib.import_module(module)
        for name in held.__all__:
            key = id(getattr(held, name)) if callable(getattr(held, name)) else (module, name)
            if key not in seen and not name.startswith("__"):
                seen.add(key)
                found.append((module, name))
    return tuple(found)


def page_of(module: str, name: str) -> str:
    """Return the page of a public name."""
    return f"reference/{module}.{name}.md"


def contents() -> str:
    """Return the first page of the reference."""
    text = "# Reference\n\nEvery public name, by the module from which it is imported.\n"
    for module in MODULES:
        rows = [
            f"| [`{name}`]({module}.{name}.md) | {line_of(module, name)} |\n"
            for held, name in public_names()
            if held == module
        ]
        if rows:
            text += f"\n## {module}\n\n| name | |\n|---|---|\n{''.join(rows)}"
    return text


def line_of(module: str, name: str) -> str:
    """Return the first line about a public name."""
    held = getattr(importlib.import_module(module), name)
    return summary(held).replace("|", "\\|") if callable(held) else ""


def reference(module: str, name: str) -> str:
    """Return the page of a public name: its docstring, fields, and uses."""
    held = getattr(importlib.import_module(module), name)
    text = f"# {name}\n\n```python\nfrom {module} import {name}\n```\n\n"
    text += f"::: {module}.{name}\n"
    if isinstance(held, type) and issubclass(held, Description):
        made = neighbour("fields")
        lines = "".join(made.line(held, field) + "\n" for field in made.fields_of(held))
        base = made.base_of(held)
        if base is not None:
            text += f"\n## Fields\n\nThose of `{base.__name__}`{', and' if lines else '.'}\n"
        if lines:
            text += ("" if base else "\n## Fields\n") + "\n" + lines
    found = [*uses(name)]
    if found:
        text += f"\n## Used in\n\n{' · '.join(found)}\n"
    return text


def uses(name: str) -> Iterator[str]:
    """Yield links to the documents and examples in whose code a name occurs."""
    word = re.compile(rf"\b{re.escape(name)}\b")
    for path, text in documents():
        if word.search(text):
            title = str(path.relative_to(DOCS))[:-3] if path.suffix == ".md" else None
            lies = f"../../{path.relative_to(ROOT)}" if title is None else f"../{title}.md"
            yield f"[{title or experiment_name(path)}]({lies})"


@cache
def documents() -> tuple[tuple[Path, str], ...]:
    """Return the code in the documents, and the examples."""
    pages = [path for path in sorted(DOCS.rglob("*.md")) if path.name != "fields.md"]
    block = re.compile(r"^```python$.*?^```$|`[^`\n]+`", flags=re.M | re.S)
    found = [(path, "\n".join(block.findall(path.read_text("utf-8")))) for path in pages]
    found += [(path, path.read_text("utf-8")) for path in sorted(examples().values())]
    return tuple(found)


@cache
def neighbour(name: str) -> ModuleType:
    """Return a script beside this one as a module."""
    spec = importlib.util.spec_from_file_location(name, Path(__file__).with_name(f"{name}.py"))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


if __name__ == "__main__":
    main()
