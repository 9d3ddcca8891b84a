"""An examination of this machine: versions, extras, display, engine, plug-ins, physics."""

from __future__ import annotations

import importlib.metadata
import platform
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mars2d.core.extras import pip_line

LIBRARIES = (
    "pymunk", "numpy", "scipy", "shapely", "matplotlib", "pygame-ce", "pillow",
)  # fmt: skip


class Extra(NamedTuple):
    """An extra of the installation: its purpose, the features without it and those it adds."""

    extra: str
    name: str
    always: str
    more: str
    packages: tuple[str, ...]


EXTRAS = (
    Extra("video", "films", ".gif", ".mp4", ("av",)),
    Extra("data", "records", ".npz, .mat, .csv", ".nc, pandas, xarray", ("pandas", "xarray")),
    Extra(
        "maps",
        "maps",
        "GeoJSON, WKT, images",
        "DXF, SVG, grids of ROS",
        ("ezdxf", "svgelements", "pyyaml"),
    ),
    Extra("log", "logs", "", ".mcap", ("mcap", "foxglove-schemas-protobuf")),
    Extra("cluster", "workers", "all cores of this machine", "Dask clusters", ("distributed",)),
)


@dataclass(frozen=True)
class Finding:
    """One thing that was examined; `ok` is None if it is optional."""

    name: str
    text: str
    ok: bool | None = True


def examine() -> Iterator[Finding]:
    """Yield the findings one after the other."""
    from mars2d import __version__

    yield Finding("mars2d", __version__)
    yield Finding("python", f"{platform.python_version()}, {sys.executable}")
    yield Finding("system", f"{platform.system()} {platform.release()}, {platform.machine()}")
    for name in LIBRARIES:
        yield _library(name)
    yield _display()
    yield from map(_extra, EXTRAS)
    yield _engine()
    yield from _plugins()
    yield _physics()


def _library(name: str) -> Finding:
    try:
        return Finding(name, importlib.metadata.version(name))
    except importlib.metadata.PackageNotFoundError:
        if sys.platform == "emscripten":
            return _missing_in_browser(name)
        return Finding(name, "is missing: pip install --force-reinstall mars2d", ok=False)


def _missing_in_browser(name: str) -> Finding:
    if name == "pygame-ce":
        return Finding(name, "none: windows and films need it, replays and SVG don't", ok=None)
    return Finding(name, f'is missing: await micropip.install("{name}")', ok=False)


def _display() -> Finding:
    from mars2d.window.screen.display import display_available

    if display_available():
        return Finding("display", "yes: windows open")
    return Finding("display", "none: runs are without a window, pictures and films work", ok=None)


def _extra(extra: Extra) -> Finding:
    """Return the features of an extra's packages, or the command that installs them."""
    found = []
    for package in extra.packages:
        try:
            found.append(f"{package} {importlib.metadata.version(package)}")
        except importlib.metadata.PackageNotFoundError:
            line = f"for {extra.more}: {pip_line(extra.extra)}"
            return Finding(extra.name, "; ".join(filter(None, [extra.always, line])), ok=None)
    offered = ", ".join(filter(None, [extra.always, extra.more]))
    return Finding(extra.name, f"{offered} ({', '.join(found)})")


def _engine() -> Finding:
    from mars2d.physics.islands import reason_without
    from mars2d.reports.remedy import remedy

    why = reason_without()
    if why and sys.platform == "emscripten":
        return Finding("engine", "in Python: a browser has no compiler", ok=None)
    if why:
        return Finding("engine", f"in Python, much slower: {why}. To mend it: {remedy()}", ok=None)
    return Finding("engine", "compiled")


def _plugins() -> Iterator[Finding]:
    """Yield the plug-ins of other packages; a broken one is not a fault of MARS2D."""
    from mars2d.scenario.registry import FAMILIES, misspelt_groups, plugins

    for part in (part for family in FAMILIES for part in plugins(family)):
        text = f"{part.name}, {part.family}, of {part.package} {part.version}"
        problem = f": not usable: {part.problem}" if part.problem else ""
        yield Finding("plug-in", text + problem, ok=None if problem else True)
    for group in misspelt_groups():
        yield Finding("plug-in", f"an entry point of the group {group}", ok=None)


def _physics() -> Finding:
    """Drive one robot along an arc, and compare its pose with the closed form."""
    from mars2d.scenario.robot import Robot
    from mars2d.scenario.scenario import Scenario
    from mars2d.world.world import World

    v, omega, steps = 0.2, 0.5, 1000
    scenario = Scenario(robots=[Robot(pose=(0, 0, 0))], sampling_time=0.1, stop_time=1e3)
    world = World(scenario)
    start = time.perf_counter()
    for _ in range(steps):
        world.step([[v], [omega]])
    rate = steps / (time.perf_counter() - start)
    angle = omega * world.time
    exact = np.array([v / omega * np.sin(angle), v / omega * (1 - np.cos(angle)), angle])
    error = float(np.abs(world.pose[:, 0] - exact).max())
    text = f"an arc of {steps} steps is off by {error:.1e} m; {rate:,.0f} steps/s"
    return Finding("physics", text, ok=error < 1e-9)
