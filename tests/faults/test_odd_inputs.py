"""Names, settings and variables that are odd: each works, or is one named error."""

import numpy as np

import mars2d
from mars2d import Scenario
from mars2d.output.formats import SUFFIXES

NAMES = [
    "a b", "-a", "--set", "a;b", "$HOME", "a'b", 'a"b', "a*b", "[a]", "{0}", "~", "a,b", "a=b",
    "a:b", "%s", "a\\b", "#a", "\u4e2d\u6587", "e\u0301", "\U0001f916", ".hidden", "a.csv.npz",
    "x" * 200,
]  # fmt: skip


def test_a_record_is_found_again_under_any_name(tmp_path):
    record = mars2d.run(Scenario(robots=2, stop_time=0.3), control=lambda world: np.zeros((2, 2)))
    lost = []
    for suffix in SUFFIXES:
        for name in NAMES:
            saved = record.save(tmp_path / (name + suffix))
            if mars2d.load(saved).digest != record.digest:
                lost.append(saved)
    assert lost == []
