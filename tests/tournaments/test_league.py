"""How laws stand after matches."""

from __future__ import annotations

from math import log10
from types import MappingProxyType

import pytest

from mars2d.tournaments.isolation import Verdict
from mars2d.tournaments.league import league
from mars2d.tournaments.league_text import league_text
from mars2d.tournaments.match import Match, Played, settled
from mars2d.tournaments.page import league_page
from mars2d.tournaments.rating import ratings
from tests.tournaments.leagues import ROLES, tournament_of


def played(number, pursuer, evader, winner, payoff=None, **more) -> Played:
    """A match that went as is said; its options, seed and record do not matter."""
    seed, options = more.pop("seed", 0), more.pop("options", {})
    match = Match(number, "chase.py", options, seed, {"pursuer": pursuer, "evader": evader})
    more = {"digest": f"{number}", **more}
    return Played(match, winner=winner, payoff=payoff, **more)


SLOW = MappingProxyType({"pursuer": Verdict("slow", "c.py, line 7: no command after 1 s", 2.0)})
BOTH = {**SLOW, "evader": Verdict("error", "y.py, line 2: it raised", 2.0)}


def test_each_role_has_its_own_table_and_points_are_1_for_a_match_won_and_a_half_for_a_draw():
    standings = league(
        [
            played(1, "a", "x", "pursuer", 3.0),
            played(2, "a", "y", None),
            played(3, "b", "x", "evader"),
            played(4, "b", "y", "evader"),
        ],
        ROLES,
    )
    table = [(s.role, s.law, s.points, s.played, s.won, s.drawn, s.lost) for s in standings]
    assert table == [
        ("pursuer", "a", 1.5, 2, 1, 1, 0),
        ("pursuer", "b", 0.0, 2, 0, 0, 2),
        ("evader", "y", 1.5, 2, 1, 1, 0),
        ("evader", "x", 1.0, 2, 1, 0, 1),
    ]
    best = standings[0]
    assert best.share == 0.75
    assert 0 < best.share_low < 0.75 < best.share_high < 1


def test_a_law_that_ran_out_of_time_twice_forfeits_the_rest_in_whatever_order_they_are_done():
    slow = [played(k, "c", "y", "evader", verdicts=SLOW) for k in (1, 2)]
    others = [played(k, law, "y", "pursuer") for k, law in ((3, "c"), (4, "c"), (5, "a"))]
    planned = [each.match for each in (*slow, *others)]
    for done in ([*slow, others[0], others[2]], [others[2], *slow[::-1]]):
        result = settled(planned, done)
        assert [each.winner for each in result] == [*4 * ["evader"], "pursuer"]
        kinds = [verdict.kind for each in result for verdict in each.verdicts.values()]
        assert kinds == ["slow", "slow", "late", "late"]
    assert result[3].message == (
        "c forfeits as pursuer: late: ran out of time in 2 matches before, and forfeits the rest; "
        "evader wins"
    )
    assert [each.match.number for each in settled(planned, [slow[1], others[0]])] == [2, 3]


def test_the_league_says_where_it_was_not_protected():
    for protected in (True, False):
        found = tournament_of([played(1, "a", "x", "pursuer", protected=protected)])
        page = league_page(found)
        for text in (league_text(found), page):
            assert ("not protected on this system" in text) is not protected


def test_a_forfeit_is_lost_and_where_both_fail_both_lose():
    a, b = league([played(1, "c", "y", "evader", verdicts=SLOW)], ROLES)
    assert (a.lost, a.forfeits, a.points, b.won, b.forfeits) == (1, 1, 0, 1, 0)
    a, b = league([played(1, "c", "y", None, verdicts=BOTH)], ROLES)
    assert (a.lost, a.forfeits, a.drawn, b.lost, b.forfeits, b.drawn) == (1, 1, 0, 1, 1, 0)


def test_a_match_without_a_result_counts_for_nobody():
    match = played(1, "a", "x", None).match
    first, second = league([Played.without_result(match, "the process died")], ROLES)
    assert (first.played, first.points, second.played) == (0, 0, 0)


def test_of_equal_points_the_quicker_hunter_and_the_evader_that_lasts_longer_stand_higher():
    matches = [
        played(1, "a", "x", "pursuer", 9.0),
        played(2, "a", "y", "pursuer", 4.0),
        played(3, "b", "x", "pursuer", 8.0),
        played(4, "b", "y", "pursuer", 3.0),
    ]
    standings = league(matches, ROLES)
    assert [s.law for s in standings] == ["b", "a", "x", "y"]
    assert [s.payoff for s in standings] == [5.5, 6.5, 8.5, 3.5]
    never = played(5, "a", "z", "evader", 20.0), played(6, "b", "z", "evader", 20.0)
    assert [s.law for s in league([*matches, *never], ROLES)][2:] == ["z", "x", "y"]


def test_equal_points_share_a_place_in_table_page_and_csv(tmp_path):
    winners = {"a": ["pursuer", "evader"], "b": ["evader", "pursuer"], "c": ["evader"] * 2}
    winners["d"] = ["pursuer"] * 2
    matches = [
        played(2 * k + j, law, rival, won[j], 9.0 - k)
        for k, (law, won) in enumerate(winners.items())
        for j, rival in enumerate("xy")
    ]
    result = tournament_of(matches)
    hunters = {s.law: s.place for s in result.standings if s.role == "pursuer"}
    assert hunters == {"d": 1, "b": 2, "a": 2, "c": 4}
    assert [row["place"] for row in result.table("league")] == [1, 2, 2, 4, 1, 1]
    lines = league_text(result).splitlines()
    assert [line.split()[:2] for line in lines[1:5]] == [
        ["1", "d"], ["2", "b"], ["2", "a"], ["4", "c"],
    ]  # fmt: skip
    csv = result.save_csv(tmp_path / "league.csv", "league").read_text().splitlines()
    assert [line.split(",")[1] for line in csv[1:5]] == ["1", "2", "2", "4"]
    page = league_page(result)
    assert page.count('<td class="number">2</td><th') == 2


def test_laws_that_play_both_roles_stand_in_one_table_with_the_time_that_they_hunted():
    matches = [played(1, "a", "b", "pursuer", 2.0), played(2, "b", "a", "evader")]
    first, second = league(matches, ROLES)
    assert (first.law, first.role, first.played, first.won, first.payoff) == (
        "a",
        "",
        2,
        2,
        2,
    )
    assert (second.law, second.lost, second.payoff) == ("b", 2, None)


def test_ratings_take_out_what_a_role_is_better_by_and_more_matches_narrow_them():
    for count in (4, 40):
        swapped = [("a", "b", 1.0), ("b", "a", 1.0)] * count  # the first role always wins
        found = ratings(swapped)
        assert found["a"][0] == pytest.approx(1500, abs=1e-6)
        better = ratings([*swapped, *[("b", "a", 0.0), ("a", "b", 1.0)] * count])
        assert better["a"][0] > 1500 > better["b"][0]
        assert better["a"][0] + better["b"][0] == pytest.approx(3000, abs=1e-6)
    assert ratings(3 * swapped)["a"][1] < found["a"][1]


def test_a_rating_says_the_share_of_points_where_there_are_many_matches():
    games = [("a", "b", 1.0)] * 750 + [("a", "b", 0.0)] * 250
    games += [("b", "a", 0.0)] * 750 + [("b", "a", 1.0)] * 250
    found = ratings(games)
    assert found["a"][0] - found["b"][0] == pytest.approx(400 * log10(3), abs=5)


def test_points_of_one_against_the_other_do_not_count_what_has_no_result():
    draw, lost = played(1, "a", "x", None), played(2, "a", "x", "evader")
    error = Played.without_result(draw.match, "no")
    assert tournament_of([draw, lost, error]).head_to_head() == {"a": {"x": [0.5, 0.0]}}
    both = played(1, "a", "x", None, verdicts=BOTH)
    assert tournament_of([both]).head_to_head() == {"a": {"x": [0.0]}}
    back = [played(1, "a", "b", "pursuer"), played(2, "b", "a", "evader")]
    assert tournament_of(back).head_to_head() == {
        "a": {"a": [], "b": [1.0, 1.0]}, "b": {"a": [0.0, 0.0], "b": []},
    }  # fmt: skip


# -- in words --------------------------------------------------------------------------------------


def test_the_text_has_tables_points_of_pairings_and_faults():
    text = league_text(
        tournament_of(
            [
                played(1, "a", "x", "pursuer", 2.5),
                played(2, "c", "x", "evader", verdicts=SLOW),
                played(3, "a", "x", "pursuer", 3.5),
                played(4, "c", "x", "evader", verdicts=SLOW),
            ]
        )
    )
    assert (
        text
        == """\
   pursuer  points         share (95 %)  played  won  lost  forfeits         Elo  free for
1  a             2  1.00 (0.34 to 1.00)       2    2     0         0  1759 ± 549     3.0 s
2  c             0  0.00 (0.00 to 0.66)       2    0     2         2  1241 ± 549         -

   evader  points         share (95 %)  played  won  lost         Elo  free for
1  x            2  0.50 (0.15 to 0.85)       4    2     2  1500 ± 556     3.0 s

Points of each pursuer against each evader:
pursuer \\ evader  x
a                 2
c                 0

c forfeits: slow in 2 matches, first in match 2: c.py, line 7: no command after 1 s"""
    )
