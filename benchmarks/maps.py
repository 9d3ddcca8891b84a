"""Maps from files beside the pictures of independent readers: which pixels differ?

    python benchmarks/maps.py FOLDER [--pictures FOLDER]

Reads each .svg, .dxf and .yaml in a folder, paints its walls and areas, and compares them with the
picture of a reader that shares no code with ours: Chromium for SVG, with all strokes a pixel wide
and without texts and images; matplotlib behind ezdxf for DXF, without the kinds of entities that
are not read; the rules of nav2, pixel by pixel, for occupancy grids. A pixel differs if it is
painted in one picture, and nothing within two pixels of it is painted in the other. Needs the
extras maps and test, and Chromium.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from mars2d.addons import Map
from mars2d.addons.maps import described, obstacles, read
from mars2d.core.errors import InputError

Mask = NDArray[np.bool_]
Window = tuple[float, float, float, float]
"""(xmin, xmax, ymin, ymax), metres."""

LONG = 1000
"""The longer side of a picture, pixels."""

NEAR = 2.0
"""How far a painted pixel may be from one that is painted in the other picture."""

FINE = 5e-4
"""The tolerance of drawings, in parts of their size."""

HAIRLINES = """() => {
  const root = document.documentElement;
  const box = root.hasAttribute("viewBox") ? root.viewBox.baseVal : null;
  const given = name => /^[\\d.+e-]+\\s*[a-z]*$/.test(root.getAttribute(name) || "");
  let size = {};
  for (const name of ["width", "height"])
    size[name] = given(name) ? root[name].baseVal.value : null;
  const across = size.width && box ? size.width / box.width : null;
  const along = size.height && box ? size.height / box.height : null;
  const scale = across || along || 1;
  const w = size.width || (box ? box.width * scale : 100);
  const h = size.height || (box ? box.height * scale : 100);
  if (!box) root.setAttribute("viewBox", `0 0 ${w} ${h}`);
  const zoom = LONG / Math.max(w, h);
  root.setAttribute("width", w * zoom);
  root.setAttribute("height", h * zoom);
  for (const e of document.querySelectorAll("*")) {
    if (["text", "image", "foreignObject"].includes(e.localName)) e.style.display = "none";
    if (!(e instanceof SVGGeometryElement)) continue;
    if (parseFloat(getComputedStyle(e).strokeWidth) == 0) continue;
    e.style.setProperty("vector-effect", "non-scaling-stroke", "important");
    e.style.setProperty("stroke-width", "1px", "important");
    e.style.setProperty("stroke-dasharray", "none", "important");
  }
  const fit = root.preserveAspectRatio.baseVal, sides = [across || scale, along || scale];
  if (!box) return [w, h, 1];
  if (fit.align == fit.SVG_PRESERVEASPECTRATIO_NONE) return [w, h, sides[0]];
  return [w, h, fit.meetOrSlice == 2 ? Math.max(...sides) : Math.min(...sides)];
}"""


def painted(found: Map, window: Window, size: tuple[int, int]) -> Mask:
    """Return where a map paints a picture (rows, columns): areas filled, walls as lines."""
    xmin, xmax, ymin, ymax = window
    picture = Image.new("1", size, 0)
    pen = ImageDraw.Draw(picture)
    scale = np.array([size[0] / (xmax - xmin), size[1] / (ymax - ymin)])

    def pixels(points: Any) -> list[tuple[float, float]]:
        x, y = ((np.array(points) - (xmin, ymin)) * scale).T
        return list(zip(x - 0.5, size[1] - y - 0.5, strict=True))

    for outline in found.outlines:
        pen.polygon(pixels(outline), fill=1, outline=1)
    for wall in found.walls:
        pen.line(pixels(wall), fill=1)
    return np.array(picture)


def svg_reference(path: Path, browser: Any) -> tuple[Mask, Window, dict[str, Any]]:
    """Return what Chromium paints of an SVG, the page in metres, and how to read it."""
    page = browser.new_page(viewport={"width": LONG, "height": LONG})
    page.goto(path.resolve().as_uri())
    width, height, scale = page.evaluate(HAIRLINES.replace("LONG", str(LONG)))
    zoom = LONG / max(width, height)
    clip = {"x": 0, "y": 0, "width": round(width * zoom), "height": round(height * zoom)}
    image = Image.open(BytesIO(page.screenshot(clip=clip))).convert("RGB")
    page.close()
    window = (0.0, width / scale, 0.0, height / scale)
    options = {"unit": "m", "tolerance": min(FINE * max(window), 1.0)}
    return np.asarray(image).min(axis=2) < 247, window, options


def dxf_reference(path: Path, _browser: Any) -> tuple[Mask, Window, dict[str, Any]]:
    """Return what matplotlib paints of a DXF, the window in metres, and how to read it."""
    import matplotlib.pyplot as plt
    from ezdxf import recover
    from ezdxf.addons.drawing import config
    from ezdxf.addons.drawing.frontend import Frontend
    from ezdxf.addons.drawing.matplotlib import MatplotlibBackend
    from ezdxf.addons.drawing.properties import RenderContext

    drawing = read(path, unit="m")
    xmin, xmax, ymin, ymax = drawing.bounds
    margin = 0.02 * max(drawing.size)
    window = (xmin - margin, xmax + margin, ymin - margin, ymax + margin)
    wide, tall = window[1] - window[0], window[3] - window[2]
    zoom = LONG / max(wide, tall)
    figure = plt.figure(figsize=(max(wide * zoom, 2) / 100, max(tall * zoom, 2) / 100), dpi=100)
    axes = figure.add_axes((0, 0, 1, 1))
    document, _ = recover.readfile(path)
    document.header["$XCLIPFRAME"] = 0
    for layer in document.layers:
        if not layer.dxf.get("plot", 1):
            layer.off()
    settings = config.Configuration(
        background_policy=config.BackgroundPolicy.WHITE,
        color_policy=config.ColorPolicy.BLACK,
        hatch_policy=config.HatchPolicy.SHOW_SOLID,
        line_policy=config.LinePolicy.SOLID,
        text_policy=config.TextPolicy.IGNORE,
        image_policy=config.ImagePolicy.IGNORE,
        lineweight_scaling=0,
        min_lineweight=1,
        max_flattening_distance=1e-3 * max(drawing.size),
    )
    front = Frontend(RenderContext(document), MatplotlibBackend(axes), settings)
    front.draw_layout(
        document.modelspace(), filter_func=lambda entity: entity.dxftype() not in drawing.skipped
    )
    axes.set_xlim(*window[:2])
    axes.set_ylim(*window[2:])
    axes.set_aspect("auto")
    axes.set_axis_off()
    data = BytesIO()
    figure.savefig(data, dpi=100, facecolor="white")
    plt.close(figure)
    options = {"unit": "m", "tolerance": min(FINE * max(drawing.size), 1.0)}
    return np.asarray(Image.open(data).convert("L")) < 200, window, options


def grid_reference(path: Path, _browser: Any) -> tuple[Mask, Window, dict[str, Any]]:
    """Return the cells that nav2 calls occupied, the window in metres, and how to read it."""
    import yaml

    fields = yaml.load(path.read_text(), Loader=yaml.BaseLoader)
    image = Image.open(path.parent / fields["image"])
    mode, negate = fields.get("mode", "trinary"), fields["negate"] in ("1", "true")
    limit, cell = float(fields["occupied_thresh"]), float(fields["resolution"])
    pixels = np.asarray(image.convert("RGBA")).astype(float) / 255
    clear = image.has_transparency_data
    channels = pixels if mode == "trinary" and clear else pixels[..., :3]
    shade = channels.mean(axis=2)
    occupied = (shade if negate else 1 - shade) > limit
    if mode == "scale":
        occupied &= pixels[..., 3] == 1
    if mode == "raw":
        occupied = (np.rint(255 * shade) <= 100) & (np.rint(255 * shade) > 100 * limit)
    x, y, yaw = (float(value) for value in fields["origin"])
    if yaw:
        raise InputError(f"{path.name}: turned by {yaw:g} rad, which is not compared")
    window = (x, x + cell * image.width, y, y + cell * image.height)
    return occupied, window, {"tolerance": 0}


REFERENCES: dict[str, Callable[[Path, Any], tuple[Mask, Window, dict[str, Any]]]] = {
    ".svg": svg_reference, ".dxf": dxf_reference, ".yaml": grid_reference,
}  # fmt: skip


def differ(one: Mask, other: Mask) -> Mask:
    """Return the painted pixels of a picture that have none near them in the other."""
    from scipy.ndimage import distance_transform_edt

    far: Mask = one & (distance_transform_edt(~other) > NEAR) if other.any() else one
    return far


def compare(path: Path, browser: Any, pictures: Path | None) -> str:
    """Return a row of the table for a file, and save both pictures and their difference."""
    reference, window, options = REFERENCES[path.suffix](path, browser)
    start = time.process_time()
    ours = painted(Map.from_file(path.resolve(), **options), window, reference.shape[::-1])
    seconds = time.process_time() - start
    missing, extra = differ(reference, ours), differ(ours, reference)
    if pictures is not None:
        sides = [np.where(mask[..., None], 0, 255).repeat(3, axis=2) for mask in (reference, ours)]
        sides.append(np.full_like(sides[0], 255))
        sides[2][ours | reference] = 200
        sides[2][missing], sides[2][extra] = (200, 0, 0), (0, 0, 200)
        image = Image.fromarray(np.concatenate(sides, axis=1).astype(np.uint8))
        image.save(pictures / f"{path.name}.png")
    options.pop("tolerance", None)
    drawing = read(path, **options)
    skipped = dict(described(drawing, obstacles(drawing))).get("not read", "")
    counts = f"{reference.sum():8d} {missing.sum():8d} {extra.sum():8d} {seconds:6.1f}"
    return f"{path.name[:36]:36} {counts}  {skipped[:60]}"


def main() -> None:
    """Compare all files of a folder."""
    from playwright.sync_api import sync_playwright

    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--pictures", type=Path, help="a folder for pictures side by side")
    arguments = parser.parse_args()
    if arguments.pictures:
        arguments.pictures.mkdir(parents=True, exist_ok=True)
    print(f"{'file':36} {'painted':>8} {'missing':>8} {'extra':>8} {'s':>6}  not read")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=executable(), args=["--no-sandbox"])
        for path in sorted(arguments.folder.rglob("*")):
            if path.suffix in REFERENCES:
                try:
                    print(compare(path, browser, arguments.pictures), flush=True)
                except Exception as error:  # of any of the readers
                    text = str(error).partition("\n")[0]
                    print(f"{path.name[:36]:36} {type(error).__name__}: {text}", flush=True)


def executable() -> str | None:
    """Return the path of Chromium, or None for that of playwright."""
    import os
    import shutil

    return os.environ.get("MARS2D_CHROMIUM") or shutil.which("chromium")


if __name__ == "__main__":
    main()
