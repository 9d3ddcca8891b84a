"""Which laws keep nothing in the variables around them?"""

from functools import partial
from math import sin

import numpy as np

from mars2d.core.plane import wrap
from mars2d.core.usercode import keeps_nothing
from tests.cases import each_case

GAIN, PLACES, LIMITS = 2.0, [1.0, 2.0], (0.5, (1.0, None))
note = PLACES.append


class Count:
    n = 0

    def __call__(self, robot):
        return 0, 0


def plain(robot, most=1.0):
    robot.memory.turn = wrap(GAIN * np.sum(LIMITS[0]) + sin(robot.time))
    return min(most, sum(sin(k) for k in range(3))), helped(robot)


def helped(robot):
    return 0.0 if robot.time > 1 else plain(robot)[1]


def with_list(robot):
    return PLACES[0], 0


def with_a_list_within(robot):
    return sum(PLACES[k] for k in range(2)), 0


def with_helper(robot):
    return with_list(robot)


def with_method(robot):
    note(1.0)


def with_class(robot):
    Count.n += 1


def rebinding(robot):
    global GAIN  # noqa: PLW0603
    GAIN += 1


def by_default(robot, seen=[]):  # noqa: B006
    return len(seen), 0


def closure():
    count = 0

    def law(robot):
        nonlocal count
        count += 1
        return count, 0

    return law


@each_case(
    ("law", "nothing"),
    [
        (plain, True),
        (partial(plain, most=2.0), True),
        *((law, False) for law in (with_list, with_a_list_within, with_helper, with_method)),
        *((law, False) for law in (with_class, rebinding, by_default, closure(), Count())),
        (partial(plain, most=[2.0]), False),
    ],
)
def test_what_can_not_change_is_told_from_what_a_law_may_keep(law, nothing):
    assert keeps_nothing(law) is nothing
