"""Where the engine is not compiled, the line that mends it is one that does so here."""

from __future__ import annotations

import json
import re
import sys
import tomllib
from importlib.metadata import PackageNotFoundError
from pathlib import Path

import pytest

import mars2d
from mars2d.cli.command_line import main
from mars2d.cli.verbs import run
from mars2d.physics import islands
from mars2d.reports import doctor
from mars2d.reports.doctor import examine, remedy
from tests.cases import each_case

PACKAGE = Path(mars2d.__file__).parent


class Installed:
    """An installed distribution: what pip has noted of where it came from."""

    def __init__(self, told: dict | None) -> None:
        self.told = told

    def read_text(self, name: str) -> str | None:
        assert name == "direct_url.json"
        return None if self.told is None else json.dumps(self.told)


@pytest.fixture
def tools(monkeypatch):
    """Say which programs there are; MARS2D_PLAIN is not set, and the sources are elsewhere."""
    monkeypatch.delenv("MARS2D_PLAIN", raising=False)
    monkeypatch.setenv("CC", "gcc -pthread")

    def there_are(*names: str, headers: bool = True) -> None:
        monkeypatch.setattr(doctor.shutil, "which", lambda name: name if name in names else None)
        monkeypatch.setattr(doctor.Path, "exists", lambda path: headers and path.suffix == ".h")

    there_are("gcc", "apt-get")
    return there_are


GIT = {"vcs": "git", "commit_id": "abc"}


@each_case(
    "told, source",
    [
        ({"url": "file:///a/my%20code"}, "file:///a/my%20code"),
        ({"url": "https://x.org/m", "vcs_info": GIT}, "git+https://x.org/m"),
        (None, "--no-binary mars2d mars2d"),
    ],
)
@pytest.mark.usefixtures("tools")
def test_it_installs_again_from_where_it_was_installed(told, source, monkeypatch):
    monkeypatch.setattr(doctor, "distribution", lambda _: Installed(told))
    assert remedy() == f"pip install --force-reinstall --no-deps --no-cache-dir {source}"


def test_what_compiles_is_installed_first_where_it_is_missing(tools):
    version = ".".join(map(str, sys.version_info[:2]))
    debian = f"apt-get install gcc python{version}-dev && pip install "
    for program, headers, first in [
        (["apt-get"], True, debian),
        (["gcc", "apt-get"], False, debian),
        (["dnf"], False, "dnf install gcc python3-devel && pip install "),
        (["winget"], False, "winget install Microsoft.VisualStudio.2022.BuildTools && "),
    ]:
        tools(*program, headers=headers)
        assert remedy().startswith(first)


def test_doctor_names_all_libraries_and_the_line_for_extras_that_are_missing(monkeypatch):
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text("utf-8"))[
        "project"
    ]
    extras = {*project["optional-dependencies"]} - {"all", "dev", "docs", "test"}
    findings = {finding.name: finding for finding in examine()}
    assert extras <= {*findings}
    assert not {"dev", "docs", "test"} & {*findings}

    def version(name):
        if name == "av":
            raise PackageNotFoundError
        return "1"

    monkeypatch.setattr("mars2d.reports.doctor.version", version)
    findings = {finding.name: finding for finding in examine()}
    assert findings["video"].text == 'for films as .mp4: pip install "av>=17"'
    assert findings["video"].ok is None
    assert findings["maps"].ok
    monkeypatch.setattr("mars2d.reports.doctor.requires", lambda _: project["dependencies"])
    names = {finding.name for finding in examine()}
    assert {re.split("[<>=]", line)[0] for line in project["dependencies"]} <= names


def test_doctor_and_long_runs_say_it(capsys, monkeypatch, tmp_path):
    monkeypatch.setenv("MARS2D_PLAIN", "1")
    [finding] = [finding for finding in examine() if finding.name == "engine"]
    assert finding.ok is None
    assert finding.text.endswith("variable MARS2D_PLAIN is 1. To mend it: unset MARS2D_PLAIN")
    monkeypatch.chdir(tmp_path)
    line = "Compiled it is many times quicker: unset MARS2D_PLAIN"
    command = ["run", "head_on", "--headless"]
    main(command)
    assert line not in capsys.readouterr().err  # it took less than 20 s
    monkeypatch.setattr(run, "LONG", 0.0)
    main(command)
    assert capsys.readouterr().err.count(line) == 1
    if islands._loaded()[0]:
        monkeypatch.delenv("MARS2D_PLAIN")
        main(command)
        assert line not in capsys.readouterr().err
