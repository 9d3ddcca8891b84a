"""What docs/theory.md says is measured again: every number is within its tolerance."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path

import pytest

pytestmark = [pytest.mark.slow, pytest.mark.nightly]

ROOT = Path(__file__).parents[2]
_spec = importlib.util.spec_from_file_location("theory", ROOT / "docs" / "make" / "theory.py")
make_theory = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(make_theory)

PAGE = (ROOT / "docs" / "theory.md").read_text(encoding="utf-8")
ROW = re.compile(
    r"^\| (?P<what>.+?) \| (?:[<>]= )?(?P<predicted>\S+)[^|]* "
    r"\| (?P<measured>\S+).* \| [^,|]+(, rough)? \|$"
)


def rows(section: str) -> dict[str, float]:
    """Return what a section of the page predicts, by what it is."""
    part = PAGE.partition(f"## {section}")[2].partition("\n## ")[0]
    found = [ROW.match(line) for line in part.splitlines() if line.startswith("|")][2:]
    assert all(found), "every number of the page is within its tolerance"
    return {match["what"]: float(match["predicted"]) for match in found}


@pytest.mark.parametrize("fact", make_theory.FACTS)
def test_a_fact_of_the_page_holds(fact):
    stated = rows("The physics")
    predictions = list(fact())
    assert predictions
    for prediction in predictions:
        assert prediction.ok, prediction
        assert stated[prediction.name] == pytest.approx(prediction.predicted, rel=1e-4, abs=1e-12)


def test_what_examples_say_of_themselves_holds_and_one_of_each_is_on_the_page():
    stated = rows("The examples")
    measured = make_theory.of_examples()
    assert len(measured) >= 9
    assert [p for found in measured.values() for p in found if not p.ok] == []
    for row, (name, found) in zip(stated, measured.items(), strict=True):
        named = {f"`{name}` of {len(found)}: {p.name}": p for p in found}
        assert stated[row] == pytest.approx(named[row].predicted, rel=1e-4, abs=1e-12)
