"""Touches that end a run: any, or those of certain bodies, roles of a game, or walls."""

from __future__ import annotations

from mars2d.core.checks import items_of
from mars2d.core.description import accepts, wrong
from mars2d.core.errors import InputError, nearest
from mars2d.core.interfaces import ScenarioLike
from mars2d.scenario.roles import roles_of

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
def stop_on(name: str, value: object) -> str | Pairs | None:
    """Check what ends a run: "contact", or pairs of names; one pair may stand alone."""
    if value is None or value == CONTACT:
        return value if isinstance(value, str) else None
    expected = "'contact', or pairs of names, such as [('red', 'blue'), ('red', 'wall')]"
    pairs = items_of(name, value, expected)
    if len(pairs) == 2 and all(isinstance(item, str) for item in pairs):
        pairs = [pairs]
    found = []
    for pair in pairs:
        names = () if isinstance(pair, str) else tuple(items_of(name, pair, expected))
        if len(names) != 2 or not all(isinstance(each, str) for each in names):
            raise wrong(name, value, expected)
        found.append((names[0], names[1]))
    if not found:
        raise wrong(name, value, expected)
    return tuple(found)


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
