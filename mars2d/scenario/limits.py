"""The limits of contacts and joints: masses, moments, sizes, speeds, stiffness.

Beyond them bodies would pass through walls, or a run would need so many substeps that it never
ends.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from math import isfinite

import numpy as np

from mars2d.bodies.constraints import FixedDistance, MaxDistance, Pin, SpringDamper, TurningSpring
from mars2d.bodies.drives.base import Drive
from mars2d.bodies.joints.base import AttachedJoint, Joint
from mars2d.bodies.props.base import MAX_SPEED
from mars2d.bodies.rigid import Rigid
from mars2d.core.arithmetic import norm
from mars2d.core.description import wrong
from mars2d.core.errors import InputError, nearest
from mars2d.core.materials import GRAVITY
from mars2d.geometry.shapes import Disc, Shape

MASS_RATIO = 10.0
"""The largest ratio of masses that contacts hold; at 100, crowds push robots through walls."""

SIZE_RATIO = 1e4
"""The largest ratio of a body's length to another one's thickness."""

MIN_MASS, MAX_MASS = 1e-6, 1e6
"""Of a body, kg."""

MIN_CROSSING = 1e-6
"""The shortest time in which a body may cross the largest overlap at the start, seconds."""

MAX_PUSH = 1e9
"""The highest acceleration of the lightest body by a drive, m/s^2 per metre of `max_overlap`."""

MAX_FREQUENCY = 1e3
"""The highest angular frequency of a spring, rad/s; higher ones need ever more substeps."""

MAX_ARM = 10.0
"""The longest lever of a joint, in parts of the body's greatest distance from its origin."""

MIN_LENGTH = 1e-3
"""The length of the shortest rope and rod, metres."""


def check_centred(name: str, shape: Shape) -> None:
    """Refuse the shape of a prop whose pose is not that of its centre of mass."""
    x, y = shape.centroid
    if norm(x, y) > 1e-6 * shape.reach:
        raise InputError(
            f"{name}: its centre of mass lies at ({x:.4g}, {y:.4g}); expected (0, 0), as "
            "shape.moved(-x, -y) makes it"
        )


def check_bodies(
    bodies: Sequence[Rigid],
    max_overlap: float,
    floors: Mapping[str, float],
    push: float,
    force: float,
) -> None:
    """Refuse bodies that contacts can't hold, or that would need too many substeps.

    max_overlap: metres. floors: the friction that holds each prop on the floor, by its name. push:
    of all drives together, newtons. force: the most that one of them may push with, newtons.
    """
    for body in bodies:
        _check_mass(body)
        _check_motion(body, min(MAX_SPEED, max_overlap / MIN_CROSSING))
    lightest = min(bodies, key=lambda body: body.inertia.mass)
    heaviest = max(bodies, key=lambda body: body.inertia.mass)
    least, most = lightest.inertia.mass, heaviest.inertia.mass
    if most > MASS_RATIO * least * (1 + 1e-12):
        allowed = MASS_RATIO * least
        slide = push / (allowed * GRAVITY)
        held = floors.get(heaviest.name, 0.0) > slide
        hint = f"; with {allowed:.3g} kg the drives, {push:.3g} N, push it on a ground_friction"
        raise InputError(
            f"{heaviest.kind}.mass: {heaviest.name} has {most:g} kg and {lightest.name} {least:g} "
            f"kg; contacts hold a ratio of at most {MASS_RATIO:g}: set the mass of {heaviest.name} "
            f"to {allowed:.3g} kg or less, or that of {lightest.name} to "
            f"{most / MASS_RATIO:.3g} kg or more"
            + (f"{hint} of less than {slide:.2g} only" if held else "")
        )
    thinnest = min(bodies, key=lambda body: body.shape.thickness)
    largest = max(bodies, key=lambda body: body.shape.bound[1])
    long, thin = 2 * largest.shape.bound[1], thinnest.shape.thickness
    if long > SIZE_RATIO * thin:
        raise InputError(
            f"{largest.kind} {largest.name} is {long:g} m long and {thinnest.kind} {thinnest.name} "
            f"{thin:g} m thin; contacts hold a ratio of at most {SIZE_RATIO:g}"
        )
    if max_overlap < (needed := force / least / MAX_PUSH):
        expected = f"at least {needed:.3g} m where a drive may push with {force:g} N"
        raise wrong(
            "Scenario.max_overlap", max_overlap, f"{expected} and {lightest.name} has {least:g} kg"
        )


def _check_mass(body: Rigid) -> None:
    """Refuse a mass or moment that is impossible for the shape."""
    mass, moment = body.inertia
    if not MIN_MASS <= mass <= MAX_MASS:
        expected = f"a mass >= {MIN_MASS:g} and <= {MAX_MASS:g} [kg]; give one"
        raise wrong(f"{body.kind}.mass of {body.name}", mass, expected)
    shape = body.shape.moved(-body.lead, 0.0) if body.lead else body.shape
    most = mass * shape.reach**2
    if not 1e-3 * most <= moment <= most * (1 + 1e-9):
        raise wrong(
            f"{body.kind}.moment of {body.name}", moment,
            f"at least {1e-3 * most:.3g} and at most mass x (greatest distance)^2, "
            f"{most:.3g} kg m^2",
        )  # fmt: skip


def _check_motion(body: Rigid, fastest: float) -> None:
    """Refuse a body that starts too fast."""
    vx, vy, omega = body.velocity
    speed = norm(vx, vy) + abs(omega) * body.shape.reach
    if not speed <= fastest:
        why = "" if fastest == MAX_SPEED else f", as max_overlap is {fastest * MIN_CROSSING:g} m"
        raise wrong(
            f"{body.kind}.velocity of {body.name}", body.velocity,
            f"no point of it faster than {fastest:g} m/s{why}; one has {speed:.4g} m/s",
        )  # fmt: skip


def corner(shape: Shape) -> float:
    """Return the largest distance of a corner from the origin, metres; 0 for a centred disc."""
    centred_disc = isinstance(shape, Disc) and shape.center == (0.0, 0.0)
    return 0.0 if centred_disc else shape.reach


def check_drive(name: str, drive: Drive, arm: float) -> None:
    """Refuse a drive that could swing a corner, or a joint's end, too fast for the substeps.

    arm: metres, from the centre of rotation to the corner or end.
    """
    if arm == 0 or not type(drive).__module__.startswith("mars2d."):
        return  # a drive of the user's own is checked when it is asked
    hard = np.array([[a, b] for a in (-1e9, 0.0, 1e9) for b in (-1e9, 0.0, 1e9)]).T
    spin = float(np.abs(drive.twist(drive.saturate(hard))[2]).max())
    if not spin * arm <= MAX_SPEED:
        raise InputError(
            f"{name}.drive: {type(drive).__name__} turns at up to {spin:.4g} rad/s; what lies "
            f"{arm:.4g} m off the centre of rotation goes at {spin * arm:.4g} m/s then, and "
            f"{MAX_SPEED:g} m/s is the most"
        )


def check_ends(where: str, joint: Joint, names: Collection[str]) -> None:
    """Refuse a joint of unknown bodies, of a body with itself, or without constraints."""
    if type(joint).constraints is Joint.constraints:
        raise wrong(where, joint, "a Rope, Rod, Spring or Hinge, or a class with `constraints`")
    for field in ("a", "b"):
        name = getattr(joint, field)
        if name is not None and name not in names:
            near = nearest(name, names)
            raise wrong(f"{where}.{field}", name, f"the name of a robot or prop{near}")
    if joint.a == joint.b:
        raise wrong(f"{where}.b", joint.b, f"another body than a, {joint.a!r}")


def check_joint(where: str, attached: AttachedJoint, bodies: Sequence[Rigid]) -> None:
    """Refuse a joint that would pull its bodies at once, or too fast for the substeps."""
    joint = attached.joint
    for field, index in (("a", attached.a), ("b", attached.b)):
        anchor, body = getattr(joint, f"anchor_{field}"), bodies[index]
        if index >= 0 and norm(*anchor) > (most := MAX_ARM * body.shape.reach):
            expected = f"a point within {most:.4g} m of {body.name}'s centre of mass"
            raise wrong(f"{where}.anchor_{field}", anchor, expected)
    apart, ends = attached.apart(bodies), _ends(attached, bodies)
    for constraint in attached.constraints:
        match constraint:
            case Pin() if apart > 1e-6:
                raise InputError(
                    f"{where}: its anchors, {ends}, lie {apart:.3g} m apart at the start; a hinge "
                    "is one point"
                )
            case MaxDistance(length=length) | FixedDistance(length=length):
                if length < MIN_LENGTH:  # its own, or that of ends that start at one point
                    expected = f"a number >= {MIN_LENGTH:g} [m]; give a length, or use a Hinge"
                    raise wrong(f"{where}.length", length, expected)
                rod = isinstance(constraint, FixedDistance)
                least, most = length * (1 - 1e-9) - 1e-9, length * (1 + 1e-9) + 1e-9
                if apart > most or (rod and apart < least):
                    raise InputError(
                        f"{where}.length = {length:g}: its ends, {ends}, start {apart:.6g} m "
                        f"apart; expected {'just' if rod else 'at least'} that, or None"
                    )
            case SpringDamper(stiffness=stiffness) | TurningSpring(stiffness=stiffness):
                quick = attached.frequency(constraint, bodies)
                if not quick <= MAX_FREQUENCY:
                    raise wrong(
                        f"{where}.stiffness", stiffness,
                        f"at most {stiffness * (MAX_FREQUENCY / quick) ** 2:.3g} for bodies as "
                        f"light as these: they would swing at {quick:.3g} rad/s",
                    )  # fmt: skip
        if isinstance(constraint, SpringDamper):
            speed = abs(apart - constraint.length) * quick
            if not (isfinite(speed) and speed <= MAX_SPEED):
                raise wrong(
                    f"{where}.rest_length", constraint.length,
                    f"nearer to the {apart:.4g} m at the start: it would throw its bodies at "
                    f"{speed:.3g} m/s, and {MAX_SPEED:g} m/s is the most",
                )  # fmt: skip


def _ends(attached: AttachedJoint, bodies: Sequence[Rigid]) -> str:
    a, b = ("({:.6g}, {:.6g})".format(*end) for end in attached.ends(bodies))
    return f"{a} and {b} in the world"
