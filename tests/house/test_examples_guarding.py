"""The games of guarding, hiding and herds: their closed forms, laws, and what contact changes."""

from math import acos, hypot, pi

import numpy as np
import pytest

import mars2d
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_module

pytestmark = [pytest.mark.slow, pytest.mark.nightly]

LAWS = {
    "guard_the_line": {
        "guard": ("guards", "lowest", "straight", "shadow"),
        "attacker": ("attackers", "lowest", "straight", "aside"),
    },
    "capture_the_flag": {
        "guard": ("guards", "match", "nearest", "home"),
        "attacker": ("attackers", "region", "straight", "wings"),
    },
    "round_a_pillar": {
        "pursuer": ("pursuers", "shortest", "straight", "to_and_fro"),
        "evader": ("evaders", "opposite", "round", "away"),
    },
    "hide_and_seek": {
        "seeker": ("seekers", "circle", "to_and_fro", "wide"),
        "hider": ("hiders", "opposite", "still", "late"),
    },
    "escort": {
        "hunter": ("hunters", "round", "straight", "feint"),
        "escort": ("escorts", "between", "ram", "halfway"),
    },
    "selfish_herd": {
        "predator": ("predators", "nearest", "stubborn", "stray"),
        "flock": ("flocks", "away", "selfish", "behind"),
    },
}
"""The folder of each role, and its laws, that of the default first."""


def outcome(name, seed=0, **options):
    """Play a game; a law by its name alone. Return the record and the outcome."""
    for role, (folder, *laws) in LAWS[name].items():
        if options.get(role) in laws:
            options[role] = f"{folder}/{options[role]}.py"
    record = mars2d.run(name, seed=seed, options=options)
    game = next(a for a in record.scenario.addons if a.key == "game")
    return record, game.outcome(record)


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("guard_the_line", {"seed": 3}),
        ("guard_the_line", {"mu": 0.5, "seed": 1}),
        ("guard_the_line", {"mu": 0.6, "seed": 5}),
        ("capture_the_flag", {"seed": 4}),
        ("capture_the_flag", {"attackers": 2, "seed": 1}),
        ("capture_the_flag", {"guards": 1, "attackers": 1, "mu": 0.8}),
        ("round_a_pillar", {"mu": 1.5, "seed": 2}),
        ("round_a_pillar", {"mu": 1.0, "seed": 1}),
        ("round_a_pillar", {"mu": 1.2}),
        ("hide_and_seek", {"mu": 1.6, "seed": 3}),
        ("hide_and_seek", {"mu": 1.15}),
        ("escort", {"mu": 0.48, "seed": 2}),
        ("escort", {"mu": 0.56, "seed": 4}),
        ("selfish_herd", {"number": 24, "seed": 5}),
        ("selfish_herd", {"number": 2, "seed": 6}),
    ],
)
def test_a_game_agrees_with_its_formula(name, options):
    seed = options.pop("seed", 0)
    experiment = mars2d.scenario.open_experiment(name, options, seed=seed)
    record = mars2d.run(experiment.scenario, control=experiment.control, seed=seed)
    predictions = experiment.predictions(record)
    assert predictions
    assert [p for p in predictions if not p.ok] == []


# -- the laws -----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", LAWS)
def test_all_laws_of_a_game_play_each_other(name):
    first, second = LAWS[name].items()
    for one in first[1][1:]:
        for other in second[1][1:]:
            options = {first[0]: one, second[0]: other, "stop_time": 6.0}
            record, result = outcome(name, 1, **options)
            assert len(record) > 1
            assert result.winner in (None, *LAWS[name])


# -- guard the line, capture the flag ------------------------------------------------------------


def test_who_leaves_the_best_way_loses_by_it():
    """The height is a saddle point: a worse guard lets it fall, a worse attacker lets it rise."""
    for seed in (1, 2, 5):
        heights = {}
        for guard in ("lowest", "straight", "shadow"):
            for attacker in ("lowest", "straight", "aside"):
                record, _ = outcome("guard_the_line", seed, guard=guard, attacker=attacker)
                heights[guard, attacker] = record.pose[-1, 1, 1]
        value = heights["lowest", "lowest"]
        assert all(h >= value - 0.05 for (g, _), h in heights.items() if g == "lowest")
        assert all(h <= value + 0.05 for (_, a), h in heights.items() if a == "lowest")


def test_more_than_the_matching_reach_the_flag_only_past_worse_guards():
    winners = {
        guard: [outcome("capture_the_flag", seed, guard=guard)[1].winner for seed in range(4)]
        for guard in ("match", "nearest")
    }
    assert winners["match"] == ["guard"] * 4
    assert winners["nearest"].count("attacker") >= 3


# -- round obstacles ----------------------------------------------------------------------------


def test_the_time_round_a_pillar_does_not_depend_on_which_law_runs_away_on_the_circle():
    times = [outcome("round_a_pillar", 1, evader=e)[1].capture_time for e in ("opposite", "round")]
    assert times[0] == pytest.approx(times[1], abs=0.3)


def test_the_shortest_way_round_a_pillar_is_that_of_a_fine_polygon():
    shapely = pytest.importorskip("shapely")
    module = open_module(examples()["round_a_pillar"])
    rng = np.random.default_rng(0)
    disc = shapely.Point(0, 0).buffer(module.RADIUS, quad_segs=400)
    for _ in range(20):
        places = [
            np.array(module.circle(angle, radius))
            for angle, radius in zip(rng.uniform(-pi, pi, 2), rng.uniform(1.76, 4, 2), strict=True)
        ]
        way = shapely.LineString(module.shortest(*places))
        assert way.buffer(-0).length < 12
        if shapely.LineString(places).intersects(disc.buffer(-1e-3)):
            hull = shapely.MultiPoint([*disc.exterior.coords, *places]).convex_hull.exterior
            along = sorted(hull.project(shapely.Point(p)) for p in places)
            ways = along[1] - along[0], hull.length - along[1] + along[0]
            assert way.length == pytest.approx(min(ways), rel=1e-3)
        else:
            assert way.length == pytest.approx(hypot(*(places[0] - places[1])), rel=1e-3)


def test_the_hider_is_seen_where_the_tangents_say():
    record, _ = outcome("hide_and_seek", 2)
    (x, y), (hx, hy) = record.pose[-1, :2].T
    angle = abs(np.angle(complex(hx, hy) / complex(x, y)))
    assert angle == pytest.approx(acos(1.5 / hypot(x, y)) + acos(1.5 / hypot(hx, hy)), abs=0.01)
    assert record.over_message.startswith("red sees blue")


def test_a_bulky_seeker_has_to_be_quicker_by_the_ratio_of_the_circles():
    assert pytest.approx(1.171, abs=1e-3) == 2.05 / 1.75
    for mu, winner in ((1.1, "hider"), (1.35, "seeker")):
        assert outcome("hide_and_seek", 0, mu=mu)[1].winner == winner


# -- escort -------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_guard_half_as_quick_as_the_hunter_is_enough_and_needs_a_body(seed):
    for mu, winner in ((0.49, "hunter"), (0.56, "escort")):
        assert outcome("escort", seed, mu=mu)[1].winner == winner
    assert outcome("escort", seed, mu=0.56, physics="ideal")[1].winner == "hunter"


# -- the selfish herd ----------------------------------------------------------------------------


def test_the_first_victim_is_the_one_in_whose_cell_the_predator_appears():
    from mars2d.geometry import Tessellation, rectangle

    for seed in range(5):
        record, result = outcome("selfish_herd", seed, wanted=1)
        cells = Tessellation(record.pose[0, :2, 1:], rectangle(-5, 5, -5, 5)).cells
        import shapely

        inside = [cell.contains(shapely.Point(record.pose[0, :2, 0])) for cell in cells]
        assert result.captures[0].evader == inside.index(True) + 1


@pytest.mark.nightly
def test_the_risk_of_one_is_one_over_the_number():
    for number in (4, 8, 16):
        runs = 120
        options = {"number": number, "wanted": 1}
        first = [outcome("selfish_herd", s, **options)[1].captures[0].evader for s in range(runs)]
        share = first.count(1) / runs
        assert share == pytest.approx(1 / number, abs=3 * ((1 / number) / runs) ** 0.5)
