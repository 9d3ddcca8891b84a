"""The games of pursuit: their closed forms, over settings and laws, and who wins."""

from math import asin, pi

import numpy as np
import pytest

from mars2d.scenario.experiment import open_module
from tests.worlds import played

pytestmark = [pytest.mark.slow, pytest.mark.nightly]


@pytest.mark.parametrize("ratio", [0.3, 0.6, 0.8])
@pytest.mark.parametrize("law", ["straight", "bearing"])
@pytest.mark.parametrize("evader", ["across", "away"])
def test_a_chase_takes_as_long_as_its_closed_form_says(ratio, law, evader):
    laws = {"pursuer": f"pursuers/{law}.py", "evader": f"evaders/{evader}.py"}
    room = [(-40, -40), (40, -40), (40, 40), (-40, 40)]
    record, outcome, predictions = played("straight_chase", ratio=ratio, workspace=room, **laws)
    assert (outcome.winner == "pursuer") == (outcome.capture_time <= record.scenario.addons[0].par)
    assert len(predictions) == 1
    assert predictions[0].ok


def test_a_chase_that_is_no_textbooks_predicts_nothing():
    others = {"pursuer": "pursuers/halfway.py"}, {"evader": "evaders/zigzag.py"}, {"crates": True}
    for options in (*others, {"ratio": 0.9}, {"ratio": 1.0}, {"stop_time": 5}):
        (capture,) = played("straight_chase", **options)[2]
        assert capture.reason


def test_a_chase_of_wide_discs_takes_as_long_as_its_closed_form_says():
    _, outcome, (capture,) = played("straight_chase", ratio=0.5, **{"robots.*.diameter": 2.0})
    assert outcome.capture_time == pytest.approx(3.53, abs=0.01)
    assert capture.predicted == pytest.approx(3.53, abs=0.01)


@pytest.mark.parametrize("ratio", [0.4, 0.55, 0.7])
@pytest.mark.parametrize(("share", "winner"), [(0.95, "pedestrian"), (1.1, "car")])
def test_the_chauffeur_wins_beyond_isaacs_boundary(ratio, share, winner):
    reach = share * open_module("homicidal_chauffeur").least(ratio)
    _, outcome, predictions = played("homicidal_chauffeur", ratio=ratio, reach=reach)
    assert outcome.winner == winner
    assert len(predictions) == 1
    assert predictions[0].ok


def test_isaacs_boundary_is_the_nearest_pass_of_two_who_do_what_they_can():
    """The largest, over when the pedestrian jumps, of the least distance of the two ways."""
    t, game = np.linspace(0, pi / 2, 4000), open_module("homicidal_chauffeur")
    for g in (0.2, 0.5, 0.8):
        gaps = [
            np.hypot(g * t - 1 + np.cos(t), y - np.sin(t))[: np.searchsorted(t, asin(y)) + 1].min()
            for y in np.linspace(0.02, g, 200)
        ]
        assert max(gaps) == pytest.approx(game.least(g) / game.RADIUS, abs=1e-4)
        assert np.argmax(gaps) == len(gaps) - 1, "the best is y = g"


def test_tyres_and_feet_that_hold_little_lose_the_pedestrian_its_jump():
    narrow = {"seed": 1, "reach": 0.2}
    assert played("homicidal_chauffeur", **narrow)[1].winner == "pedestrian"
    assert played("homicidal_chauffeur", accel=0.6, **narrow)[1].winner == "car"
    ideal = played("homicidal_chauffeur", accel=0.6, physics="ideal", **narrow)
    assert ideal[1].winner == "pedestrian"


@pytest.mark.parametrize(
    ("law", "radius", "winner"),
    [("lead", 0.6, "evader"), ("lead", 0.8, "pursuer"), ("lead", 1.2, "pursuer"),
     ("follow", 0.9, "evader"), ("follow", 1.5, "pursuer")],
)  # fmt: skip
def test_two_cars_need_bend_and_a_law_that_uses_it(law, radius, winner):
    _, outcome, predictions = played("two_cars", radius=radius, pursuer=f"pursuers/{law}.py")
    assert outcome.winner == winner
    assert all(p.ok is not False for p in predictions)


@pytest.mark.parametrize("ratio", [0.5, 0.9, 0.95])
def test_a_matador_gets_clear_of_each_pass_where_isaacs_says_so(ratio):
    for seed in range(4):
        assert (
            played("homicidal_chauffeur", ratio=ratio, reach=0.2, seed=seed)[1].winner
            == "pedestrian"
        )


def test_besicovitchs_man_gains_as_much_for_each_half_and_one_on_a_circle_less_and_less():
    def time(man, reach):
        options = {"reach": reach, "start": 0.5, "sampling_time": 0.01, "man": f"men/{man}.py"}
        return played("lion_and_man", **options)[1].capture_time

    for man, grows in (("besicovitch", True), ("circle", False)):
        times = [time(man, reach) for reach in (0.8, 0.4, 0.2, 0.1)]
        gains = np.diff(times)
        assert (gains.min() > 0.7) == grows
    far = np.hypot(*played("lion_and_man", man="men/besicovitch.py")[0].pose[:, :2, 1].T)
    assert far.max() < 4.0


@pytest.mark.parametrize("ratio", [0.5, 0.7, 0.8, 0.9, 1.0])
@pytest.mark.parametrize("n", [3, 4, 5])
def test_an_evader_that_runs_straight_gets_by_as_far_as_the_formula_says(n, ratio):
    _, outcome, predictions = played("encirclement", n=n, ratio=ratio, uneven=0.2, seed=n)
    (nearest,) = predictions
    assert nearest.ok
    assert (outcome.winner == "pursuers") == (nearest.predicted < 0.21)


def test_three_at_even_gaps_need_the_sine_of_sixty_degrees_less_their_width():
    assert played("encirclement", ratio=0.82, uneven=0.0)[1].winner == "evader"
    assert played("encirclement", ratio=0.87, uneven=0.0)[1].winner == "pursuers"
