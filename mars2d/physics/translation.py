"""Translation: a scenario in terms of the islands, which know numbers alone."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from math import pi, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.constraints import (
    Constraint,
    FixedDistance,
    MaxDistance,
    Pin,
    SpringDamper,
    TurningRange,
    TurningSpring,
)
from mars2d.bodies.joints.base import AttachedJoint
from mars2d.bodies.props.base import Prop
from mars2d.bodies.rigid import Rigid, Surface
from mars2d.core.arithmetic import cosines_sines, norm
from mars2d.core.materials import GRAVITY, material_of
from mars2d.physics.islands import islands, library, settings
from mars2d.physics.walls import Wall, walls_of
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Obstacle, Scenario

Float = NDArray[np.float64]


def mover_of(scenario: Scenario) -> Any:
    """Return the motion of the bodies of a scenario."""
    module = islands()
    parts: tuple[Robot | Prop, ...] = (*scenario.robots, *scenario.props)
    bodies = [
        _body(module, i, rigid, part, scenario.physics == "contact")
        for i, (rigid, part) in enumerate(zip(scenario.bodies, parts, strict=True))
    ]
    thinnest = min(body.shape.thickness for body in scenario.bodies)
    swings = [  # the longest substeps that resolve how springs swing, s
        settings.SWING / tie.frequency(spring, scenario.bodies)
        for tie in scenario.ties
        for spring in tie.constraints
        if isinstance(spring, SpringDamper | TurningSpring) and spring.stiffness
    ]
    return module.Mover(
        module.Accuracy(float(scenario.max_overlap), float(thinnest), min(swings, default=1e300)),
        module.Glide(*_quadrature(20)),
        bodies,
        _walls(module, scenario),
        [_tie(module, tie, bodies) for tie in scenario.ties],
        set(scenario.joined),
        _surfaces(module, scenario, bodies),
    )


def _body(module: Any, number: int, rigid: Rigid, part: Robot | Prop, forces: bool) -> Any:
    shape, inertia = rigid.shape, rigid.inertia
    (x, y), radius = shape.bound
    pieces = [
        module.Piece(
            [(float(x), float(y)) for x, y in piece.vertices], _sides(piece.vertices),
            float(piece.radius),
        )
        for piece in shape.pieces
    ]  # fmt: skip
    body = module.Body(number, isinstance(part, Robot), pieces, _values(rigid.surface))
    what: dict[str, Any] = {
        "mass": inertia.mass, "moment": inertia.moment, "com": rigid.lead, "radius": radius,
        "offset_x": x, "offset_y": y, "is_disc": rigid.is_disc and not (x or y),
    }  # fmt: skip
    if isinstance(part, Prop):
        body.describe(what | {
            "grip": part.ground_friction * inertia.mass * GRAVITY,
            "rest_grip": part.resting_friction * inertia.mass * GRAVITY, "lever": shape.plate.lever,
        })  # fmt: skip
    else:
        drive = part.drive
        force, torque = drive.strength(inertia.mass * GRAVITY)
        body.describe(what)
        body.describe_drive({
            "force": force, "torque": torque,
            "in_robot_frame": drive.frame == "robot", "limited": drive.force_limited and forces,
            "no_load_speed": 1e300 if drive.no_load_speed is None else drive.no_load_speed,
            "grips": [1e300 if g is None else g * inertia.mass * GRAVITY for g in drive.grips],
        })  # fmt: skip
    body.move([float(number) for number in (*rigid.pose, *rigid.velocity)])
    return body


def _walls(module: Any, scenario: Scenario) -> list[Any]:
    surfaces = scenario.surfaces
    return [
        module.Wall(
            number, [(float(far), -1 - k) for far, k in wall.owners], -1 - len(surfaces) - number,
            list(map(float, (*wall.start, *wall.end))), wall.surface, _seams(module, wall),
            [tuple(map(float, (*end, *away, far))) for end, away, far in wall.shades],
        )
        for number, wall in enumerate(_walls_in(scenario))
    ]  # fmt: skip


def _walls_in(scenario: Scenario) -> tuple[Wall, ...]:
    """Return the walls of obstacles and workspace; pieces of different surfaces stay apart."""
    solid = len(scenario.obstacles)  # the workspace, which has its room inside, comes after these
    skin = _skin if _settles(scenario) else _values
    return walls_of(
        tuple(
            (surface.outline, skin(surface), k < solid)
            for k, surface in enumerate(scenario.surfaces)
        )
    )


def _settles(scenario: Scenario) -> bool:
    """Return whether friction or restitution of a contact may be no mere product."""
    rules = {scenario.friction_rule, scenario.restitution_rule}
    static = [body.surface.static_friction for body in scenario.bodies]
    static += [surface.static_friction for surface in scenario.surfaces]
    asked = any(each is not None for each in static)
    return rules != {"product"} or bool(scenario.material_pairs) or asked


def _values(surface: Surface | Obstacle) -> tuple[float, ...]:
    """Return the factors that the engine multiplies: friction and restitution."""
    return float(surface.friction), float(surface.restitution)


def _skin(surface: Surface | Obstacle) -> tuple[Any, ...]:
    """Return these, static friction, and the materials by whose names they were given."""
    friction, restitution, static = surface.friction, surface.restitution, surface.static_friction
    return *_values(surface), static, material_of(friction), material_of(restitution)


def _surfaces(module: Any, scenario: Scenario, bodies: Sequence[Any]) -> Any:
    """Return what settles friction and restitution; None where both are products."""
    if not _settles(scenario):
        return None
    count, walls = len(scenario.surfaces), _walls_in(scenario)

    def of(first: int, second: int) -> tuple[float, float, float]:
        b, a = sorted((first, second))
        if b < -count:  # a wall of several obstacles, which have the same surface
            b = -1 - walls[-1 - count - b].owners[0][1]
        friction = scenario.friction_between
        return friction(a, b, slides=True), friction(a, b), scenario.restitution_between(a, b)

    return module.Surfaces(list(bodies), of, settings.STICK_SPEED)


def _seams(module: Any, wall: Wall) -> Any:
    """Return what contacts need to know of a wall's ends; None if nothing meets it there."""
    if not any(wall.seams):
        return None
    (x, y), (to_x, to_y) = wall.start, wall.end
    far = norm(to_x - x, to_y - y)
    numbers = [x, y, (to_x - x) / far, (to_y - y) / far, far]
    for seam in wall.seams:
        numbers += (0.0, 0.0, 0.0) if seam is None else (1.0 + (not seam.bulges), *seam.way)
    return module.Seams(list(map(float, numbers)))


def _tie(module: Any, attached: AttachedJoint, bodies: Sequence[Any]) -> Any:
    a = bodies[attached.a]
    b = bodies[attached.b] if attached.b >= 0 else None
    anchors = [*attached.joint.anchor_a, *attached.joint.anchor_b]
    kinds = [type(each) for each in attached.constraints]
    is_what = {
        "is_rope": MaxDistance in kinds,
        "always": any(kind is not MaxDistance for kind in kinds),
        "rigid": any(kind in (MaxDistance, FixedDistance, Pin) for kind in kinds),
        "pinned": attached.pinned,
        "springy": any(
            isinstance(each, SpringDamper | TurningSpring) and each.stiffness > 0
            for each in attached.constraints
        ),
    }
    return module.Tie(
        a, b, list(map(float, anchors)), float(attached.length), is_what, _limits(attached),
        [_translated(attached, each) for each in attached.constraints],
    )  # fmt: skip


def _limits(attached: AttachedJoint) -> list[float]:
    """Return the least and largest angle of a joint as the islands measure it, and restitution."""
    turned = attached.turned if attached.b >= 0 else -attached.turned
    for each in attached.constraints:
        if isinstance(each, TurningRange):
            return [turned + each.least, turned + each.largest, float(each.restitution)]
    return [-1e300, 1e300, 0.0]


@lru_cache
def _sides(corners: tuple[tuple[float, float], ...]) -> list[tuple[float, float]]:
    """Return the outward normals of a polygon's sides; none for a disc."""
    if len(corners) < 2:
        return []
    ends = zip(corners, (*corners[1:], corners[0]), strict=True)
    ways = [(x2 - x1, y2 - y1) for (x1, y1), (x2, y2) in ends]
    lengths = [sqrt(x * x + y * y) for x, y in ways]
    return [(y / far, -x / far) for (x, y), far in zip(ways, lengths, strict=True) if far > 0]


@lru_cache
def _quadrature(count: int) -> tuple[list[float], list[float]]:
    """Return nodes and weights for integrals from 0 to 1 of functions that bend sharply at 0.

    They are those of Gauss and Legendre in t, where the variable of the integrals is t^3. numpy's
    are eigenvalues, whose last bits depend on the processor.
    """
    x = -cosines_sines(pi * (np.arange(count) + 0.75) / (count + 0.5))[0]
    for _ in range(8):  # Newton's method
        before, value = np.ones(count), x
        for k in range(2, count + 1):
            before, value = value, ((2 * k - 1) * x * value - (k - 1) * before) / k
        slope = count * (x * value - before) / (x * x - 1)
        x = x - value / slope
    t, weight = (x + 1) / 2, 2 / ((1 - x * x) * (slope * slope))
    return (t * t * t).tolist(), (1.5 * weight * (t * t)).tolist()


def _translated(
    attached: AttachedJoint, constraint: Constraint
) -> tuple[int, bool, tuple[float, float, float]]:
    """Return the engine's joint for a constraint: kind, whether b is first, and numbers."""
    turned = attached.turned if attached.b >= 0 else -attached.turned
    world_first = attached.b < 0  # it is a that turns against the world
    match constraint:
        case MaxDistance(length=length):
            return library.SLIDE, False, (0.0, float(length) - settings.ROPE_TOLERANCE, 0.0)
        case FixedDistance(length=length):
            return library.PIN, False, (float(length), 0.0, 0.0)
        case SpringDamper(length=length, stiffness=k, damping=c):
            return library.DAMPED_SPRING, False, (float(length), float(k), float(c))
        case Pin():
            return library.PIVOT, False, (0.0, 0.0, 0.0)
        case TurningRange(least=least, largest=largest):
            numbers = float(turned + least), float(turned + largest), 0.0
            return library.ROTARY_LIMIT, world_first, numbers
        case TurningSpring(stiffness=k, damping=c):
            return library.ROTARY_SPRING, world_first, (float(-turned), float(k), float(c))
    raise TypeError(f"{constraint!r} is unknown to the physics")
