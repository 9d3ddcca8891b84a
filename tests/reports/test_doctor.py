"""What `mars2d doctor` says of libraries, extras and the engine."""

from __future__ import annotations

import re
import tomllib
from importlib.metadata import PackageNotFoundError
from pathlib import Path

from mars2d.reports.doctor import examine


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


def test_doctor_says_how_the_engine_gets_compiled(monkeypatch):
    monkeypatch.setenv("MARS2D_PLAIN", "1")
    [finding] = [finding for finding in examine() if finding.name == "engine"]
    assert finding.ok is None
    assert finding.text.endswith("variable MARS2D_PLAIN is 1. To mend it: unset MARS2D_PLAIN")
