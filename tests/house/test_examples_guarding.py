"""The games of guarding, hiding and herds: their closed forms, laws, and what contact changes."""

import inspect
import itertools
from math import hypot, pi
from pathlib import Path

import numpy as np
import pytest

from mars2d.core.scene import Scene
from mars2d.scenario.examples import examples, games
from mars2d.scenario.experiment import open_experiment, open_module
from mars2d.scenario.roles import contest_of
from tests.cases import each_case
from tests.worlds import played

pytestmark = [pytest.mark.slow, pytest.mark.nightly]

PHYSICS = ("contact", "stop", "ideal")


def outcome(name, seed=0, **options):
    """Play a game; a law by its name alone. Return the record and the outcome."""
    words = {role: f"{role}s/{law}.py" for role, law in options.items() if isinstance(law, str)}
    return played(name, seed, **options | words)[:2]


# -- the laws -----------------------------------------------------------------------------------


def laws_of(name):
    """The laws of a game by the options that choose them: those beside the default's file."""
    options = inspect.signature(open_module(name).scenario).parameters.values()
    defaults = {o.name: Path(o.default) for o in options if str(o.default).endswith(".py")}
    folder = examples()[name].parent
    return {
        option: [f"{law.parent.name}/{law.name}" for law in (folder / file.parent).glob("*.py")]
        for option, file in defaults.items()
    }


@each_case("name", games())
def test_all_laws_of_a_game_play_each_other(name):
    laws = laws_of(name)
    roles = [role for role, _ in contest_of(open_experiment(name).scenario, name).roles]
    assert len(laws) == len(roles) == 2
    for k, pairing in enumerate(itertools.product(*laws.values())):
        options = {**dict(zip(laws, pairing, strict=True)), "physics": PHYSICS[k % 3]}
        result = played(name, 1, **options, stop_time=6.0)[1]
        assert result is None or result.winner in (None, *roles)


# -- guard the line, capture the flag ------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "share", "options"),
    [
        ("guard_the_line", 0.67, {"mu": 0.7}),
        ("capture_the_flag", 0.67, {"guards": 1, "attackers": 1, "mu": 0.8, "seed": 1}),
        ("straight_chase", 0.67, {"evader": "evaders/away.py", "seed": 1}),
        ("homicidal_chauffeur", 0.99, {"ratio": 0.7, "reach": 0.6, "seed": 1}),
    ],
)
def test_the_rings_of_the_best_play_are_about_those_who_play_it(name, share, options):
    record, _, _ = played(name, **options)
    frame, scene = record.frame(int(len(record) * share)), Scene()
    record.scenario.addons[1].theory(scene, frame)
    sizes = {robot.radius for robot in frame.scenario.robots}
    rings = [shape.center for shape in scene.shapes if getattr(shape, "radius", 0) in sizes]
    assert np.array(rings) == pytest.approx(frame.pose[:2].T, abs=0.1)
    assert np.hypot(*(frame.pose - frame.scenario.initial_pose)[:2]).min() > 0.5


def test_who_leaves_the_best_way_loses_by_it():
    """The height is a saddle point: a worse guard lets it fall, a worse attacker lets it rise."""
    for seed in (1, 2, 5):
        heights = {}
        for guard in ("lowest", "straight", "shadow"):
            for attacker in ("lowest", "straight", "aside"):
                record, _ = outcome("guard_the_line", seed, mu=0.7, guard=guard, attacker=attacker)
                heights[guard, attacker] = record.pose[-1, 1, 1]
        value = heights["lowest", "lowest"]
        assert all(h >= value - 0.05 for (g, _), h in heights.items() if g == "lowest")
        assert all(h <= value + 0.05 for (_, a), h in heights.items() if a == "lowest")


def test_more_than_the_matching_reach_the_flag_only_past_worse_guards():
    winners = {
        guard: [outcome("capture_the_flag", seed, guard=guard)[1].winner for seed in range(4)]
        for guard in ("match", "nearest")
    }
    assert winners["match"].count("guard") > winners["nearest"].count("guard") == 0


def test_a_relay_carries_the_flag_home_past_guards_that_follow_its_decoys_alone():
    options = {"carry": True, "attacker": "relay"}
    for guard, winner in (("match", "attacker"), ("home", "guard")):
        for seed in (1, 2, 3):
            assert outcome("capture_the_flag", seed, guard=guard, **options)[1].winner == winner


def test_either_role_wins_the_games_at_their_defaults():
    """By chance alone one of two equals wins all of 12 games once in 2048 times."""
    for name in ("escort", "pinned", "doorway", "round_a_pillar", "guard_the_line", "corner_game"):
        winners = {played(name, seed)[1].winner for seed in range(8)}
        assert len(winners) == 2, name


# -- round obstacles ----------------------------------------------------------------------------


def test_the_time_round_a_pillar_does_not_depend_on_which_law_runs_away_on_the_circle():
    times = [
        outcome("round_a_pillar", 1, mu=1.25, evader=e)[1].capture_time
        for e in ("opposite", "round")
    ]
    assert times[0] == pytest.approx(times[1], abs=0.3)


def test_the_shortest_way_round_a_pillar_is_that_of_a_fine_polygon():
    shapely = pytest.importorskip("shapely")
    module = open_module(examples()["round_a_pillar"])
    rng = np.random.default_rng(0)
    disc = shapely.Point(0, 0).buffer(1.75, quad_segs=400)
    for _ in range(20):
        places = [
            np.array(module.circle(angle, radius))
            for angle, radius in zip(rng.uniform(-pi, pi, 2), rng.uniform(1.76, 4, 2), strict=True)
        ]
        way = shapely.LineString(module.shortest(*places, 1.75))
        assert way.buffer(-0).length < 12
        if shapely.LineString(places).intersects(disc.buffer(-1e-3)):
            hull = shapely.MultiPoint([*disc.exterior.coords, *places]).convex_hull.exterior
            along = sorted(hull.project(shapely.Point(p)) for p in places)
            ways = along[1] - along[0], hull.length - along[1] + along[0]
            assert way.length == pytest.approx(min(ways), rel=1e-3)
        else:
            assert way.length == pytest.approx(hypot(*(places[0] - places[1])), rel=1e-3)


def test_a_bulky_seeker_has_to_be_quicker_by_the_ratio_of_the_circles():
    for mu, winner in ((1.1, "hider"), (1.35, "seeker")):
        assert outcome("hide_and_seek", 0, mu=mu)[1].winner == winner


# -- escort -------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", [0, 1])
def test_a_guard_half_as_quick_as_the_hunter_is_enough_and_needs_a_body(seed):
    for mu, winner in ((0.49, "hunter"), (0.56, "escort")):
        assert outcome("escort", seed, mu=mu)[1].winner == winner
    assert played("escort", seed, mu=0.56, physics="ideal")[1].winner == "hunter"


# -- the selfish herd ----------------------------------------------------------------------------


def test_the_risk_of_one_is_one_over_the_number():
    for number in (4, 8, 16):
        runs = 120
        options = {"number": number, "wanted": 1}
        first = [outcome("selfish_herd", s, **options)[1].captures[0].evader for s in range(runs)]
        share = first.count(1) / runs
        assert share == pytest.approx(1 / number, abs=3 * ((1 / number) / runs) ** 0.5)
