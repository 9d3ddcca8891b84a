"""Contacts as data: the rows of a pair, when it met, and the episodes that they make."""

from __future__ import annotations

import numpy as np

from mars2d.record.contact import CONTACT, episodes, met


def rows_of(*given: tuple) -> np.ndarray:
    """Rows by their time, duration, a, b and whether they began; each has pushed with 1 N s."""
    rows = np.zeros(len(given), dtype=CONTACT)
    for row, (time, duration, a, b, began) in zip(rows, given, strict=True):
        row["time"], row["duration"], row["a"], row["b"], row["began"] = time, duration, a, b, began
        row["speed"], row["normal_impulse"] = (time if began else 0.0), 1.0
    return rows


WALK = rows_of(
    (0.05, 0.05, 0, -1, True),  # along one wall
    (0.1, 0.06, 0, -1, False),  # and over to the next, in touch with both
    (0.14, 0.06, 0, -1, True),
    (0.14, 0.0, 1, -1, True),  # another body, in a corner at once
    (0.14, 0.0, 1, -1, True),
    (0.2, 0.05, 0, -1, False),
    (0.25, 0.01, 0, -1, True),  # which another normal takes over
    (0.28, 0.02, 0, -1, True),  # it had parted
)


def test_a_pair_meets_where_it_did_not_touch_by_another_normal():
    assert np.flatnonzero(met(WALK)).tolist() == [0, 3, 7]
    assert met(WALK[:0]).tolist() == []


def test_a_single_control_step_tells_as_much_as_the_whole():
    """A row of what goes on is there in each control step, even where it ends at its beginning."""
    steps = [0, 1, 1, 1, 1, 2, 2, 2]
    alone = [met(WALK[np.equal(steps, k)]) for k in range(3)]
    assert np.concatenate(alone).tolist() == met(WALK).tolist()


def test_an_episode_is_of_a_pair_from_its_first_touch_until_no_normal_touches():
    found = episodes(WALK)
    assert found["began"].tolist() == [0.05, 0.14, 0.28]
    assert found["ended"].tolist() == [0.26, 0.14, 0.28 + 0.02]
    assert found["a"].tolist() == [0, 1, 0]
    assert found["speed"].tolist() == [0.05, 0.14, 0.28]  # of the first row
    assert found["normal_impulse"].tolist() == [5, 2, 1]
    assert len(episodes(WALK[:0])) == 0


def test_an_episode_ends_with_the_last_of_its_normals_that_touches():
    found = episodes(rows_of((0.1, 0.09, 0, 1, True), (0.12, 0.01, 0, 1, True)))
    assert found["ended"].tolist() == [0.1 + 0.09]


def test_what_parted_at_the_end_of_a_control_step_and_meets_again_are_two_episodes():
    found = episodes(rows_of((0.05, 0.05, 0, 1, True), (0.12, 0.01, 0, 1, True)))
    assert len(found) == 2


def test_times_that_are_off_by_rounding_do_not_part_a_pair():
    late = np.nextafter(0.2, 1.0)
    rows = rows_of((0.1, 0.1, 0, 1, True), (late, 0.0, 0, 1, True), (0.2, 0.1, 0, 1, False))
    assert met(rows).tolist() == [True, False, False]
    assert len(episodes(rows)) == 1
