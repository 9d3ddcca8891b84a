"""The roles of a game, the robots that play a role, and touches that end a run, by names."""

from __future__ import annotations

from collections.abc import Sequence

from mars2d.addons.contest import Contest
from mars2d.core.checks import items_of
from mars2d.core.description import accepts, wrong
from mars2d.core.errors import InputError, likely, nearest
from mars2d.core.interfaces import ScenarioLike

MOST_PEOPLE = 2
"""How many people one keyboard has keys for."""


def contests_of(scenario: ScenarioLike) -> list[Contest]:
    """Return a scenario's contests: the add-ons that decide who has won."""
    return [addon for addon in scenario.addons if isinstance(addon, Contest)]


def contest_of(scenario: ScenarioLike, name: str) -> Contest:
    """Return a scenario's contest. Raises InputError if there is none, or several, or no outcome.

    name: the experiment's name in messages.
    """
    contests = contests_of(scenario)
    if len(contests) != 1:
        found = f"{len(contests)}" if contests else "none"
        raise InputError(
            f"{name}: a game needs one add-on that says who has won, such as "
            f"Game({{'pursuer': ['red'], 'evader': ['blue']}}); this experiment has {found}"
        )
    kind = type(contests[0])
    if kind.outcome is Contest.outcome:
        problem = f"{kind.__name__} has no outcome(record), which says who has won"
        raise InputError(f"{name}: {problem}{likely('outcome', vars(kind))}")
    return contests[0]


def roles_of(scenario: ScenarioLike) -> dict[str, tuple[int, ...]]:
    """Return the robots of each role of all contests, by index."""
    return {
        role: team
        for contest in contests_of(scenario)
        for (role, _), team in zip(contest.roles, contest.teams(scenario), strict=True)
    }


def role_of(scenario: ScenarioLike, robot: int) -> str:
    """Return the role that a robot, by its index, plays; "" for none."""
    return next((role for role, team in roles_of(scenario).items() if robot in team), "")


def robots_named(
    scenario: ScenarioLike, named: str | int | Sequence[str | int] | None, field: str
) -> tuple[int, ...]:
    """Return the robots, by index, that people drive: each by a name, an index, or a role.

    Who names a role gets its first robot that nobody has yet. Raises InputError, which begins with
    `field` and ends with the nearest name, if there is none, if two would drive one robot, and for
    more than `MOST_PEOPLE`.
    """
    people = () if named is None else (named,) if isinstance(named, (str, int)) else tuple(named)
    if len(people) > MOST_PEOPLE:
        keys = "one by the arrow keys, the other by W, A, S and D"
        raise InputError(f"{field} {', '.join(map(str, people))}: two people at most, {keys}")
    taken: list[int] = []
    for who in people:
        team = _named(scenario, who, field)
        free = [robot for robot in team if robot not in taken]
        if not free:
            all_of = "its robot" if len(team) == 1 else f"each of its {len(team)} robots"
            raise InputError(f"{field} {who}: somebody drives {all_of} already")
        taken.append(free[0])
    return tuple(taken)


def _named(scenario: ScenarioLike, who: str | int, field: str) -> tuple[int, ...]:
    """Return the robots that a name, an index or a role stands for."""
    names, roles = [str(robot.name) for robot in scenario.robots], roles_of(scenario)
    if who in roles and who not in names:
        return roles[str(who)]
    try:
        return (scenario.index_of(field, who),)
    except InputError:
        known = nearest(who, {*names, *roles})
        raise InputError(f"{field} {who}: there is no such robot or role{known}") from None


CONTACT = "contact"
"""Ends a run with the first touch of any two bodies, or of a body and an obstacle."""

WALL = "wall"
"""What all obstacles, and the workspace's wall, are called in a pair."""

Pairs = tuple[tuple[str, str], ...]

_TEXT = {"type": "string"}
_PAIR = {"items": _TEXT, "minItems": 2, "maxItems": 2}


@accepts(
    {
        "type": ["string", "array"],
        "if": {"type": "string"},
        "then": {"enum": [CONTACT]},
        "else": {
            "if": {"items": _TEXT},
            "then": _PAIR,
            "else": {"items": {"type": "array", **_PAIR}},
        },
    }
)
def stop_on(name: str, value: object) -> str | Pairs:
    """Check what ends a run: "contact", or pairs of names; one pair may stand alone."""
    if value == CONTACT:
        return CONTACT
    expected = "'contact', or pairs of names, such as [('red', 'blue'), ('red', 'wall')]"
    pairs = items_of(name, value, expected)
    if len(pairs) == 2 and all(isinstance(item, str) for item in pairs):
        pairs = [pairs]
    if not pairs or not all(
        isinstance(pair, (tuple, list)) and [*map(type, pair)] == [str, str] for pair in pairs
    ):
        raise wrong(name, value, expected)
    return tuple((a, b) for a, b in pairs)


def bodies_named(
    scenario: ScenarioLike, pairs: Pairs, bodies: dict[str, int], obstacles: int
) -> tuple[tuple[frozenset[int], frozenset[int]], ...]:
    """Return the bodies of each pair, by index, as contacts have them.

    bodies: all indices by name. obstacles: how many there are, -1, -2 and so on. Raises InputError
    for a name that is neither of a body nor of a role, with the nearest, and for a pair that can't
    touch.
    """
    known = {WALL: frozenset(range(-obstacles, 0))}
    known |= {role: frozenset(team) for role, team in roles_of(scenario).items()}
    known |= {name: frozenset([body]) for name, body in bodies.items()}
    for name in {name for pair in pairs for name in pair}:
        if name not in known:
            raise InputError(f"Scenario.stop_on: nothing is called {name!r}{nearest(name, known)}")
    for a, b in pairs:
        if WALL in (a, b) and not obstacles:
            why = "there is no wall; write on_exit='wall', or add a Map"
            raise InputError(f"Scenario.stop_on = {(a, b)}: {why}")
        if a == b and len(known[a]) < 2:
            raise InputError(f"Scenario.stop_on = {(a, b)}: nothing touches itself")
    return tuple((known[a], known[b]) for a, b in pairs)
