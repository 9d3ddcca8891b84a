"""An examination of this machine: versions, extras, display, engine, physics."""

from __future__ import annotations

import os
import platform
import re
import shlex
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import (
    PackageNotFoundError,
    distributions,
    requires,
    version,
)
from pathlib import Path

import numpy as np

from mars2d.core.errors import MissingExtraError
from mars2d.core.extras import pip_line
from mars2d.output.raster import ONLY_CE

PURPOSES = {
    "cluster": "sweeps and tournaments on Dask clusters",
    "completion": "the Tab key in bash, zsh, tcsh, fish and PowerShell",
    "data": "tables of pandas, arrays of xarray",
    "live": "a run that Foxglove shows as it goes on",
    "log": "logs, .mcap",
    "maps": "maps of DXF, SVG, and grids of ROS",
    "rl": "environments for learners, laws that were learned",
    "video": "films as .mp4",
}
"""What the extras of the installation are for."""


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
    declared = _declared()
    yield from map(_library, declared.pop("", ()))
    yield _display()
    if not declared:
        yield Finding("libraries", "not known: mars2d is not installed: pip install .", ok=None)
    every = {*declared.pop("all", ())}
    for name, packages in sorted(declared.items()):
        if every.issuperset(packages):  # the others are for developers
            yield _extra(name, packages)
    yield _engine()
    yield _physics()


def _declared() -> dict[str, list[str]]:
    """Return the packages that the installed MARS2D asks for by extra; "" needs them always."""
    packages: dict[str, list[str]] = {}
    try:
        declared = "\n".join(requires("mars2d") or ())
    except PackageNotFoundError:
        return packages
    lines = re.findall(r"""^([\w.-]+)(?:.*extra == ['"](\w+))?""", declared, flags=re.M)
    for package, extra in lines:
        packages.setdefault(extra, []).append(package)
    return packages


def _library(name: str) -> Finding:
    try:
        found = version(name)
        if name == "pygame-ce" and any(distributions(name="pygame")):
            found += f", and pygame {version('pygame')} in the same folder: {ONLY_CE}"
            return Finding(name, found, ok=None)
        return Finding(name, found)
    except PackageNotFoundError:
        if sys.platform != "emscripten":
            return Finding(name, "is missing: pip install --force-reinstall mars2d", ok=False)
    if name == "pygame-ce":
        return Finding(name, "none: windows and films need it, replays and SVG don't", ok=None)
    return Finding(name, f'is missing: await micropip.install("{name}")', ok=False)


def _display() -> Finding:
    from mars2d.window.screen.display import display_available

    try:
        if display_available():
            return Finding("display", "yes: windows open")
    except MissingExtraError as error:
        return Finding("display", str(error), ok=False)
    return Finding("display", "none: runs are without a window, pictures and films work", ok=None)


def _extra(name: str, packages: list[str]) -> Finding:
    """Return the purpose of an extra and its libraries, or the command that installs them."""
    found, purpose = [], PURPOSES.get(name, ", ".join(packages))
    for package in packages:
        try:
            found.append(f"{package} {version(package)}")
        except PackageNotFoundError:
            return Finding(name, f"for {purpose}: {pip_line(name)}", ok=None)
    return Finding(name, f"{purpose} ({', '.join(found)})")


def _engine() -> Finding:
    from mars2d.physics.islands import reason_without

    why = reason_without()
    if why and sys.platform == "emscripten":
        return Finding("engine", "in Python: a browser has no compiler", ok=None)
    if why:
        return Finding("engine", f"in Python, much slower: {why}. To mend it: {remedy()}", ok=None)
    return Finding("engine", "compiled")


def remedy() -> str:
    """Return how the engine gets compiled on this machine."""
    import mars2d

    if os.environ.get("MARS2D_PLAIN") == "1":
        return "set MARS2D_PLAIN=" if sys.platform == "win32" else "unset MARS2D_PLAIN"
    folder = Path(mars2d.__file__).parents[1]
    ours = (folder / "pyproject.toml").exists()
    again = f"-e {shlex.quote(str(folder))}" if ours else "--force-reinstall --no-cache-dir mars2d"
    return f"install a C compiler and Python's headers, then pip install --no-deps {again}"


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
