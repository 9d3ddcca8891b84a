"""What examples predict holds at other settings, seeds and laws than their own, too."""

import pytest

from tests.worlds import played

pytestmark = [pytest.mark.slow, pytest.mark.nightly]

OTHERS = [
    ("head_on", {"extra": 0}),
    ("head_on", {"extra": 3}),
    ("head_on", {"force": 2}),
    ("head_on", {"mass": 1}),
    *(
        ("billiards", {"speed": speed, "offset": offset})
        for speed in (0.25, 0.5, 2)
        for offset in (-0.12, 0, 0.05, 0.1)
    ),
    ("shove_and_spin", {"mu": 0.6, "lever": -0.1}),  # the discs' slip ends
    ("shove_and_spin", {"e": 1.0, "v": 0.4}),
    ("tug_of_war", {"blue": 6.3, "tow": 3.0}),
    ("tug_of_war", {"blue": 7.0}),
    ("sumo", {"blue": "players/flanker.py"}),
    ("sumo", {"blue": "players/dodger.py"}),
    ("braitenberg", {"gain": 12.0}),
    ("braitenberg", {"base": 8.0}),
    *((name, {"seed": k}) for name in ("braitenberg", "dead_reckoning") for k in (1, 2)),
    ("wall_follower", {"damping": 0.6, "seed": 1}),
    ("wall_follower", {"damping": 1, "seed": 2}),
    ("wall_follower", {"damping": 1.5}),
    ("wall_follower", {"distance": 0.7, "noise": 0.01}),
    ("obstacle_avoidance", {"stop_time": 30.0}),
    ("obstacle_avoidance", {"stop_time": 20.0, "robots": 40}),
    ("obstacle_avoidance", {"stop_time": 20.0, "horizon": 0.2}),
    ("dead_reckoning", {"drift": 0.002}),
    ("leader_following", {"radius": 1.5}),
    ("leader_following", {"radius": -2.5}),
    ("leader_following", {"speed": 0.15}),
    *(("herding", {"seed": start, "start": start}) for start in range(1, 9)),
    *(
        ("lion_and_man", {"reach": reach, "start": start})
        for reach in (0.8, 0.2, 0.05)
        for start in (0.4, 1.0)
    ),
    ("guard_the_line", {"mu": 0.7, "seed": 3}),
    ("guard_the_line", {"mu": 0.5, "seed": 1}),
    ("guard_the_line", {"mu": 0.6, "seed": 5}),
    ("capture_the_flag", {"seed": 4}),
    ("capture_the_flag", {"attackers": 2, "seed": 1}),
    ("capture_the_flag", {"carry": True, "attacker": "attackers/relay.py", "seed": 1}),
    ("capture_the_flag", {"guards": 1, "attackers": 1, "mu": 0.8}),
    ("round_a_pillar", {"mu": 1.5, "seed": 2}),
    ("round_a_pillar", {"mu": 1.0, "seed": 1}),
    ("round_a_pillar", {"mu": 1.25, "pillar": 1.0}),
    ("hide_and_seek", {"mu": 1.6, "seed": 3}),
    ("hide_and_seek", {"mu": 1.15}),
    ("hide_and_seek", {"mu": 1.4, "pillar": 2.5}),
    ("escort", {"mu": 0.48, "seed": 2}),
    ("escort", {"mu": 0.56, "seed": 4}),
    ("escort", {"mu": 0.6, "seed": 1}),
    ("selfish_herd", {"number": 24, "seed": 5}),
    ("selfish_herd", {"number": 2, "seed": 6}),
    ("selfish_herd", {"number": 12, "seed": 2}),
    ("pinned", {"strength": 1.18}),
    ("pinned", {"strength": 1.27}),
    ("pinned", {"strength": 1.38, "hunter": "hunters/walls.py", "evader": "evaders/between.py"}),
    ("doorway", {"strength": 1.9}),
    ("doorway", {"strength": 2.1}),
    ("doorway", {"strength": 0.9, "escort": "escorts/alone.py"}),
]


@pytest.mark.parametrize(("name", "options"), OTHERS)
def test_an_example_agrees_with_its_predictions(name, options):
    _, _, predictions = played(name, **options)
    assert predictions
    assert [p for p in predictions if p.ok is False] == []
