"""Predictions beside what was measured: the value, its table, and the file that makes them."""

import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

import mars2d
from mars2d import InputError, LawError, Prediction
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.prediction import table
from tests.cases import each_case

HEAD = """\
import numpy as np
from mars2d import Prediction, Scenario
scenario = Scenario(stop_time=1)
"""


# -- one prediction ---------------------------------------------------------------------------


@each_case(
    ("measured", "ok"),
    [(1.0, True), (1.25, True), (0.75, True), (1.26, False), (0.74, False), (-1.0, False),
     (math.nan, False), (math.inf, False), (-math.inf, False)],
)  # fmt: skip
def test_a_prediction_holds_within_its_tolerance(measured, ok):
    assert Prediction("speed", 1.0, measured, 0.25).ok is ok


@each_case(
    ("bound", "measured", "ok"),
    [("at least", 9.0, True), ("at least", 0.75, True), ("at least", 0.74, False),
     ("at most", -9.0, True), ("at most", 1.25, True), ("at most", 1.26, False),
     ("at least", math.inf, False), ("at most", -math.inf, False), ("at least", math.nan, False)],
)  # fmt: skip
def test_a_bound_holds_on_one_side(bound, measured, ok):
    assert Prediction("speed", 1.0, measured, 0.25, bound=bound).ok is ok


def test_where_a_theory_does_not_apply_it_says_why_and_counts_neither_way():
    silent = Prediction.silent("capture", "a wall is nearer than the meeting point")
    assert (silent.ok, silent.verdict) == (None, "not predicted")
    assert silent.as_dict() == {"name": "capture", "reason": silent.reason, "ok": None}
    free = Prediction("free for", 0.87, 1.2, 0.05, "s", bound="at least")
    assert table([free, silent, silent.replace(name="nearest")]).splitlines() == [
        "          predicted  measured  tolerance",
        "free for   >= 0.870     1.200       0.05  s  ok",
        "capture                                      not predicted",
        "nearest                                      not predicted",
        "1 of 1 prediction ok, 2 not predicted",
        "not predicted: a wall is nearer than the meeting point",
    ]


def test_a_share_of_the_predicted_number_is_a_tolerance():
    assert Prediction.within("force", -4.0, -4.1, percent=5, unit="N") == Prediction(
        "force", -4.0, -4.1, 0.2, "N"
    )


@each_case(
    ("make", "words"),
    [
        (lambda: Prediction("n", math.nan, 1, 1), "Prediction.predicted = nan: expected a number"),
        (lambda: Prediction("n", 1, None, 1), "Prediction.measured = None: expected a number, or"),
        (lambda: Prediction("n", 1, True, 1), "Prediction.measured = True"),
        (lambda: Prediction("n", 1, 1, -0.1), "Prediction.tolerance = -0.1: expected a number >= "),
        (lambda: Prediction("n", 1, 1), "Prediction.tolerance is missing"),
        (lambda: Prediction("a\nb", 1, 1, 1), "expected text in one line"),
        (lambda: Prediction("n", 1, 1, 1, 5), "Prediction.unit = 5"),
        (lambda: Prediction("n", 1, 1, 1, bound="at leest"), "did you mean 'at least'?"),
        (lambda: Prediction("n", 1, 1, tolerence=1), "did you mean 'tolerance'?"),
        (lambda: Prediction.within("n", 0, 0, 2), "2 % of 0 is 0"),
        (lambda: Prediction.within("n", 1, 1, 0), "Prediction.within(percent) = 0"),
    ],
)
def test_what_is_no_prediction_is_refused(make, words):
    with pytest.raises(InputError) as caught:
        make()
    assert words in str(caught.value)


# -- the table --------------------------------------------------------------------------------


def test_a_table_shows_the_digits_that_the_tolerance_needs():
    rows = [
        Prediction("path", 2, 1.99996, 0.001, "m"),
        Prediction("speed of the box", 0.2, 0.25, 0.01, "m/s"),
        Prediction("turns", 3, 3, 0),
        Prediction("force", 4.905, math.nan, 0.02, "N"),
    ]
    assert table(rows).splitlines() == [
        "                  predicted      measured  tolerance",
        "path                 2.0000        2.0000      0.001  m    ok",
        "speed of the box      0.200         0.250       0.01  m/s  NOT OK",
        "turns                     3             3          0       ok",
        "force                 4.905  not a number       0.02  N    NOT OK",
        "2 of 4 predictions ok",
    ]


numbers_ = st.floats(allow_nan=False, allow_infinity=False)


@given(
    st.lists(
        st.tuples(st.text("abc ", min_size=1).filter(str.strip), numbers_, st.floats(),
                  st.floats(min_value=0, allow_nan=False, allow_infinity=False)),
        min_size=1, max_size=5,
    )
)  # fmt: skip
def test_any_numbers_make_a_table_of_80_columns_and_json(rows):
    made = [Prediction(*row, "m/s^2") for row in rows]
    lines = table(made).splitlines()
    assert max(map(len, lines)) <= 80
    assert sum(line.endswith((" ok", " NOT OK")) for line in lines[:-1]) == len(rows)
    json.dumps([p.as_dict() for p in made], allow_nan=False)


# -- checks in an experiment's file -----------------------------------------------------------


def opened(tmp_path, text):
    (tmp_path / "mine.py").write_text(HEAD + text)
    return open_experiment(tmp_path / "mine.py")


def finished(experiment):
    return mars2d.run(experiment.scenario)


@each_case(
    "body",
    [
        "    return [Prediction('end', 1, record.time[-1], 1e-9, 's')]\n",
        "    yield Prediction('end', 1, record.time[-1], 1e-9, 's')\n",
    ],
)
def test_checks_are_a_list_or_a_generator_of_predictions(tmp_path, body):
    experiment = opened(tmp_path, "def checks(record):\n" + body)
    made = experiment.predictions(finished(experiment))
    assert made == (Prediction("end", 1, 1, 1e-9, "s"),)
    assert made[0].ok


def test_a_file_without_checks_and_a_scenario_have_no_predictions(tmp_path):
    experiment = opened(tmp_path, "")
    assert experiment.source.checks is None
    assert experiment.predictions(finished(experiment)) == ()
    assert open_experiment(experiment.scenario).predictions(finished(experiment)) == ()


def test_of_a_run_that_was_cut_short_no_checks_are_made(tmp_path):
    experiment = opened(tmp_path, "def checks(record):\n    return 1 / 0\n")
    world = mars2d.World(experiment.scenario)
    world.step()
    world.break_off("The window was closed")
    assert experiment.predictions(world.record) == ()
    with pytest.raises(LawError, match="ZeroDivisionError"):
        experiment.predictions(finished(experiment))


def test_while_a_run_goes_on_what_checks_found_before_its_error_counts(tmp_path, capsys, recwarn):
    body = (
        "    print('here')\n"
        "    yield Prediction('first', 1, record.time[-1], 1e-9, 's')\n"
        "    yield Prediction('mean', 0, np.mean(record.contacts['impulse']), 1)\n"
        "    yield Prediction('never', 0, record.contacts['time'][0], 1)\n"
    )
    experiment = opened(tmp_path, "def checks(record):\n" + body)
    world = mars2d.World(experiment.scenario)
    assert experiment.predictions_so_far(world.record) == ((), None), "not a single step"
    for _ in range(3):
        world.step()
    found, error = experiment.predictions_so_far(world.record)
    assert [each.name for each in found] == ["first", "mean"]
    assert not found[0].ok
    assert "IndexError" in str(error)
    assert error.where == "mine.py, line 8"
    assert capsys.readouterr().out == "", "it would be printed again and again"
    assert not recwarn.list, "and so would numpy's warnings"
    world.operator.place(0, (1, 0, 0))
    world.step()
    assert experiment.predictions_so_far(world.record) == ((), None)


@each_case(
    ("body", "where", "words"),
    [
        ("pass", "mine.py, line 4", "checks returned nothing: expected a list of Prediction("),
        ("return 3", "mine.py, line 4", "checks returned 3: expected a list"),
        ("return Prediction('n', 1, 1, 1)", "mine.py, line 4", "returned Prediction(name='n'"),
        ("return [Prediction('n', 1, 1, 1), 1.5]", "mine.py, line 4", "returned 1.5 as item 1"),
        ("return record.poses", "mine.py, line 5", "did you mean 'pose'?"),
        ("yield Prediction('n', 1, 1, -1)", "mine.py, line 5", "Prediction.tolerance = -1"),
        ("yield np.array([1.0])[record.seed + 9]", "mine.py, line 5", "IndexError"),
        ("import sys; sys.exit(0)", "mine.py, line 5", "SystemExit"),
    ],
)
def test_what_checks_do_wrong_is_named_with_file_and_line(tmp_path, body, where, words):
    experiment = opened(tmp_path, f"def checks(record):\n    {body}\n")
    with pytest.raises(LawError) as caught:
        experiment.predictions(finished(experiment))
    assert caught.value.where == where
    assert words in str(caught.value)


@each_case(
    ("text", "words"),
    [
        ("checks = 3\n", "mine.py: checks = 3: expected a function of one argument, the record"),
        ("def checks():\n    pass\n", "exactly one argument, the record"),
        ("def checks(record, more):\n    pass\n", "checks(record, more)"),
    ],
)
def test_checks_that_are_no_function_of_the_record_are_refused_before_the_run(
    tmp_path, text, words
):
    with pytest.raises(InputError) as caught:
        opened(tmp_path, text)
    assert words in str(caught.value)


def test_an_experiment_keeps_the_first_line_of_its_docstring(tmp_path):
    (tmp_path / "mine.py").write_text('"""How far does it go?\n\nMore.\n"""\n' + HEAD)
    assert open_experiment(tmp_path / "mine.py").source.summary == "How far does it go?"
    assert opened(tmp_path, "").source.summary == ""


def test_an_exact_zero_is_short_where_the_tolerance_is_tiny():
    from mars2d.scenario.prediction import number

    assert number(0.0, 1.44e-10) == number(0.0, 3.49e-11) == "0"
    assert number(0.0, 0.02) == "0.000"
    assert number(3e-12, 1.44e-10) == "0.00000000000"
