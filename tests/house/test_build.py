"""What `pip install` makes: a wheel with the engine compiled, or not where nothing compiles it."""

from __future__ import annotations

import importlib.util
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[2]
PARTS = ["mars2d", "examples", "hatch_build.py", "pyproject.toml", "README.md", "LICENSE"]

NEEDED = ["hatchling", "setuptools", "Cython"]
MISSING = [name for name in NEEDED if importlib.util.find_spec(name) is None]
COMPILER = (os.environ.get("CC") or sysconfig.get_config_var("CC") or "").split()

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(bool(MISSING), reason=f"it is built by {', '.join(MISSING)}, not installed"),
    pytest.mark.skipif(os.name == "nt", reason="its compiler is found in another way"),
]
compiles = pytest.mark.skipif(
    not COMPILER or shutil.which(COMPILER[0]) is None, reason="there is no C compiler"
)


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A copy of what a package is built of, with nothing compiled in it."""
    folder = tmp_path / "project"
    ignored = shutil.ignore_patterns("*.so", "*.pyd", "__pycache__")
    for part in PARTS:
        source = PROJECT / part
        if source.is_dir():
            shutil.copytree(source, folder / part, ignore=ignored)
        else:
            shutil.copy(source, folder)
    return folder


def built(project: Path, target: str, **environment: str) -> tuple[Path, str]:
    """Build as pip does, without downloading anything; returns the file and what was printed."""
    done = subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", target, "-d", project / "dist"],
        cwd=project, env={**os.environ, **environment},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    printed = done.stdout + done.stderr
    assert done.returncode == 0, printed
    [file] = (project / "dist").iterdir()
    return file, printed


def unpacked(wheel: Path) -> Path:
    """The folder of an installed wheel, as good as."""
    folder = wheel.parent / "site"
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return folder


def engine_of(site: Path) -> str:
    """What `mars2d doctor` says of the engine of the package in a folder."""
    done = subprocess.run(
        [sys.executable, "-P", "-m", "mars2d", "doctor"], cwd=site,
        env={**os.environ, "PYTHONPATH": str(site)}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    [line] = [line for line in done.stdout.splitlines() if line[4:].startswith("engine")]
    return line


@compiles
def test_a_wheel_of_the_source_distribution_brings_the_engine_compiled(project, tmp_path):
    file, _ = built(project, "sdist")
    with tarfile.open(file) as archive:
        archive.extractall(tmp_path / "sources", filter="data")
    [project] = (tmp_path / "sources").iterdir()
    wheel, _ = built(project, "wheel")
    assert not wheel.name.endswith("none-any.whl")  # it is for one kind of machine
    site = unpacked(wheel)
    assert len(list((site / "mars2d" / "physics" / "islands").glob("_compiled.*"))) == 1
    assert not list((project / "mars2d").rglob("_compiled.*"))  # the sources are left as they are
    assert engine_of(site).startswith("ok  engine      compiled")

    source = site / "mars2d" / "physics" / "islands" / "library.pxi"
    source.write_text(source.read_text() + "# changed\n")
    assert "its sources have changed" in engine_of(site)


@pytest.mark.nightly
@compiles
def test_a_wheel_that_is_built_twice_has_the_same_bytes(project, tmp_path):
    again = shutil.copytree(project, tmp_path / "another" / "folder")
    assert built(project, "wheel")[0].read_bytes() == built(again, "wheel")[0].read_bytes()


@pytest.mark.nightly
def test_a_wheel_is_built_without_a_compiler_as_well(project):
    wheel, printed = built(project, "wheel", CC="/nonexistent")
    assert wheel.name.endswith("none-any.whl")
    assert "The engine was not compiled" in printed
    assert "was not compiled" in engine_of(unpacked(wheel))


@pytest.mark.nightly
def test_nothing_is_compiled_where_the_environment_says_so(project):
    wheel, printed = built(project, "wheel", MARS2D_PLAIN="1")
    assert wheel.name.endswith("none-any.whl")
    assert "compiled" not in printed
    [metadata] = [*unpacked(wheel).glob("*.dist-info/METADATA")]
    links = re.findall(r"\]\(([^)]+)\)", metadata.read_text(encoding="utf-8"))
    assert links  # which an index of packages can follow
    assert all(link.startswith("https://") for link in links)


@pytest.mark.nightly
@compiles
def test_an_editable_install_has_the_engine_compiled_beside_its_sources(project):
    pytest.importorskip("editables")
    built(project, "wheel:editable")
    assert len(list((project / "mars2d" / "physics" / "islands").glob("_compiled.*"))) == 1
    assert engine_of(project).startswith("ok  engine      compiled")
