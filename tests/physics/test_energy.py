"""Energy and momentum: works add up to what there is, and neither contacts nor joints add any."""

from __future__ import annotations

from itertools import pairwise
from math import cos, hypot, pi, radians, sin, sqrt, tan

import numpy as np
import pytest

from mars2d import Holonomic, Robot, Unicycle, World
from mars2d.addons import Map
from mars2d.bodies import Car, Differential
from mars2d.bodies.joints import Hinge, Rod, Rope, Spring
from mars2d.bodies.props import Ball, Bar, Box, Gate, Prop, Puck, Solid
from mars2d.core.materials import GRAVITY, MATERIALS
from mars2d.geometry.shapes import Compound, Disc, Polygon
from tests.cases import each_case
from tests.worlds import ELL, endless

FAR = Robot(pose=(60, 60, 0))
DRIVES, FLOOR, FRICTION, IMPACTS, JOINTS, HANDS = range(6)
DUMBBELL = Compound([Disc(0.12).moved(-0.1, 0), Disc(0.12).moved(0.1, 0)])


def work(world: World) -> np.ndarray:
    """The work since the start, J."""
    return world.energy.work


def kinetic(world: World) -> float:
    """The kinetic energy of all bodies, J: about each one's centre of mass."""
    total = 0.0
    velocities = np.hstack([world.velocity, world.prop_velocity]).T
    poses = np.hstack([world.pose, world.prop_pose]).T
    for body, (vx, vy, spin), (_, _, theta) in zip(
        world.scenario.bodies, velocities, poses, strict=True
    ):
        lead = body.lead
        x, y = vx - spin * lead * sin(theta), vy + spin * lead * cos(theta)
        total += (body.inertia.mass * (x * x + y * y) + body.inertia.moment * spin**2) / 2
    return float(total)


def balanced(world: World, seconds: float, command: object = None) -> np.ndarray:
    """Run a world, and look at each control step whether the account is right; return energies.

    command: of robots, (2, n); None: they stand.
    """
    command = np.zeros((2, len(world.robots))) if command is None else command
    found = [kinetic(world)]
    start, largest = found[0] - work(world).sum(), 1e-12
    for _ in range(round(seconds / world.scenario.sampling_time)):
        world.step(command)
        found.append(kinetic(world))
        largest = max(largest, found[-1], np.abs(work(world)).max())
        assert abs(found[-1] - start - work(world).sum()) <= 1e-9 * largest
    return np.array(found)


def assert_never_grows(found: np.ndarray, *, falls: bool = True) -> None:
    assert np.diff(found).max() <= 1e-9 * found[0]
    assert found[-1] < found[0] or not falls  # something did happen


# -- nothing adds any -------------------------------------------------------------------------


def rack(restitution: float, friction: float) -> list[Prop]:
    """A ball that flies at fifteen others, which lie as at the start of a game of billiards."""
    looks = {"restitution": restitution, "friction": friction, "ground_friction": 0.0}
    places = [
        (0.1 * sqrt(3) * row, 0.1 * (2 * k - row)) for row in range(5) for k in range(row + 1)
    ]
    lying = [Puck(diameter=0.2, pose=(x, y * (1 + 1e-9), 0), **looks) for x, y in places]
    return [Puck(diameter=0.2, pose=(-1, 0.03, 0), velocity=(3, 0, 0), **looks), *lying]


@each_case("sampling_time", [0.005, 0.02, 0.1])
@each_case(("restitution", "friction"), [(1.0, 1.0), (1.0, 0.2), (0.9, 1.0)])
def test_a_rack_of_discs_gains_no_energy(restitution, friction, sampling_time):
    world = endless([FAR], rack(restitution, friction), sampling_time=sampling_time)
    before = world.momentum.total
    assert_never_grows(balanced(world, 1.2))
    assert world.momentum.total == pytest.approx(before, abs=1e-9)


def tangle(seed: int, restitution: float, friction: float) -> list[Prop]:
    """Props without friction on the floor that fly into each other."""
    rng = np.random.default_rng(seed)
    kinds = [
        Ball(diameter=0.25), Box(length=0.3, width=0.2), Puck(diameter=0.2), Solid(ELL),
        Bar(length=0.5), Solid(DUMBBELL), Box(length=0.2, width=0.2), Ball(diameter=0.15),
        Solid(Polygon([(0, 0), (0.3, 0), (0.1, 0.25)])),
    ]  # fmt: skip
    props = []
    for k, kind in enumerate(kinds):
        x, y = 0.8 * (k % 3 - 1), 0.8 * (k // 3 - 1)
        velocity = -0.8 * np.array([x, y]) + rng.uniform(-0.5, 0.5, 2)
        props.append(
            kind.replace(
                name=f"p{k}", ground_friction=0, friction=friction, restitution=restitution,
                mass=float(rng.choice([1.0, 2.0, 5.0])), pose=(x, y, rng.uniform(-3, 3)),
                velocity=(*velocity, rng.uniform(-5, 5)),
            )
        )  # fmt: skip
    return props


def hinge(a: Prop, b: Prop, **limits) -> Hinge:
    """A hinge half way between two props."""
    ends = []
    for (x, y, theta), (p, q, _) in ((a.pose, b.pose), (b.pose, a.pose)):
        dx, dy = (p - x) / 2, (q - y) / 2
        ends.append((cos(theta) * dx + sin(theta) * dy, cos(theta) * dy - sin(theta) * dx))
    return Hinge(a=a.name, b=b.name, anchor_a=ends[0], anchor_b=ends[1], **limits)


@each_case(
    ("restitution", "friction"),
    [(0.0, 0.0), (0.0, 0.5), (0.7, 0.5), (1.0, 0.0), (1.0, 1.0)]
    + [(MATERIALS[name].restitution, MATERIALS[name].friction) for name in ("glass", "rubber")],
)
@each_case("around", ["nothing", "ties", "walls"])
def test_no_tangle_of_shapes_gains_energy_or_loses_momentum(restitution, friction, around):
    """Angular momentum is kept but for how deep a blow finds bodies, and what joints are off by."""
    for seed, sampling_time in enumerate((0.5, 0.1, 0.02)):
        props, joints, addons = tangle(seed, restitution, friction), [], []
        if around == "ties":
            joints = [Rope(a="p0", b="p3", length=1.2), Rod(a="p1", b="p2"), hinge(*props[6:8]),
                      hinge(*props[4:6], limits=(-1, 1))]  # fmt: skip
        if around == "walls":
            corners = [(-1.5, -1.4), (1.3, -1.3), (1.3, 1.3), (-1.3, 1.3), (-1.5, -1.4)]
            addons = [Map(list(pairwise(corners)))]
        world = endless([FAR], props, joints, addons=addons, sampling_time=sampling_time)
        world.step([[0], [0]])  # a joint takes what does not fit it at the start
        mass, moment = np.array([prop.inertia for prop in props]).T
        (x, y, _), (vx, vy, spin) = world.prop_pose, world.prop_velocity
        angular = (moment * spin + mass * (x * vy - y * vx)).sum()
        linear, scale = mass @ world.prop_velocity[:2].T, mass @ np.hypot(vx, vy)
        assert world.momentum.total == pytest.approx(linear)
        assert world.momentum.angular == pytest.approx(angular)
        assert_never_grows(balanced(world, 3), falls=restitution < 1 or friction > 0)
        assert len(world.record.contacts) > 3
        if around != "walls":
            assert world.momentum.total == pytest.approx(linear, abs=1e-9)
            near = (5e-4 if joints else 1e-5 if restitution else 5e-5) * scale
            assert world.momentum.angular == pytest.approx(angular, abs=near)


# -- several at once --------------------------------------------------------------------------


def row(count: int, gap: float) -> World:
    """A ball that flies at others in a row, all alike, some time later."""
    look = {"diameter": 0.2, "restitution": 1.0, "friction": 0.0, "ground_friction": 0.0}
    lying = [Ball(pose=(k * (0.2 + gap), 0, 0), **look) for k in range(count - 1)]
    balls = [Ball(pose=(-0.5, 0, 0), velocity=(1, 0, 0), **look), *lying]
    world = endless([FAR], balls, sampling_time=0.05)
    balanced(world, 1.5)
    return world


@each_case("gap", [1e-8, 1e-6, 1e-3])
@each_case("count", [3, 5])
def test_balls_in_a_row_with_gaps_are_hit_one_after_the_other(gap, count):
    wanted = [0.0] * (count - 1) + [1.0]
    assert row(count, gap).prop_velocity[0] == pytest.approx(wanted, abs=1e-3)


@each_case("gap", [0.0, 1e-12])
@each_case("count", [3, 4, 5])
def test_balls_that_touch_are_hit_at_once(count, gap):
    """Momentum and energy are kept, but the first one flies back; a gap of 1e-9 m is none."""
    v = row(count, gap).prop_velocity[0]
    assert v[0] < -0.3
    assert v.sum() == pytest.approx(1.0, abs=1e-9)
    assert 0.99 < (v**2).sum() <= 1.0 + 1e-9
    assert np.diff(v).min() > -2e-4  # nobody moves into another, but for what the solver leaves


def wedge(half_angle: float, radius: float) -> Map:
    """Two walls that meet on the x axis, where a disc about the origin touches both at x = 1."""
    tip = radius / sin(half_angle) + 1.0
    return Map([[(-4.0, side * (tip + 4.0) * tan(half_angle)), (tip, 0.0)] for side in (1, -1)])


@each_case("degrees", [0.5, 5.0])
@each_case(("force", "speed"), [(5.0, 0.3), (50.0, 1.0)])
def test_a_shallow_wedge_throws_no_robot_back(degrees, force, speed):
    half = radians(degrees)
    for friction in (0.0, 0.5 * tan(half)):
        robot = Robot(drive=Unicycle(max_force=force), friction=friction)
        world = endless([robot], addons=[wedge(half, 0.15)], sampling_time=0.05, max_overlap=1e-3)
        for _ in range(80):
            world.step([[speed], [0.0]])
            assert world.velocity[0, 0] > -0.05 * speed
            # In overlap d with both walls it stands d / sin(half) further ahead.
            assert world.pose[0, 0] <= 1.0 + 1e-3 / sin(half)
        assert world.pose[0, 0] > 1.0 - 1e-3
        assert world.pose[1, 0] == pytest.approx(0.0, abs=1e-3)


@each_case("restitution", [0.0, 0.5, 1.0])
@each_case("degrees", [0.5, 2.0, 10.0, 20.0, 45.0])
def test_a_ball_comes_out_of_a_wedge_at_its_restitution_at_most(degrees, restitution):
    ball = Ball(
        diameter=0.2, velocity=(1, 0, 0), friction=0.0, restitution=restitution, ground_friction=0
    )
    world = endless([FAR], [ball], addons=[wedge(radians(degrees), 0.1)], sampling_time=0.05)
    balanced(world, 1.5)
    rebound = -world.prop_velocity[0, 0]
    # Between nearly parallel walls the solver leaves a little more.
    assert -0.01 <= rebound <= restitution + (2e-2 if degrees < 1 else 1e-2)
    if degrees >= 20:  # the solver settles: both normal speeds are turned round, times e
        assert rebound == pytest.approx(restitution, abs=2e-3)


# -- limits -----------------------------------------------------------------------------------


@each_case("restitution", [0.0, 0.3, 0.8, 1.0])
@each_case("spin", [0.1, -2.0, 30.0])
def test_a_gate_turns_back_from_its_limit_at_its_restitution(restitution, spin):
    for share in (0.03, 0.17, 0.9):  # of the time to the limit: the sampling time
        gate = Gate(
            pose=(0.5, 0, 0), velocity=(0, 0.5 * spin, spin), limits=(-0.5, 0.5), damping=0.0,
            limit_restitution=restitution,
        )  # fmt: skip
        world = endless([FAR], [gate], sampling_time=share * 0.5 / abs(spin), stop_time=1e3)
        start, turned = kinetic(world), 0.0
        for _ in range(round(1.4 / share) + 1):
            balanced(world, world.scenario.sampling_time)
            turned = max(turned, abs(world.prop_pose[2, 0]))
        assert world.prop_velocity[2, 0] == pytest.approx(-restitution * spin, abs=2e-3 * abs(spin))
        assert turned <= 0.5 + 1e-3  # 1 mm at its tip
        lost = (1 - restitution**2) * start
        assert work(world)[JOINTS] == pytest.approx(-lost, abs=5e-3 * start)


@each_case("restitution", [0.0, 0.6, 1.0])
def test_two_boxes_on_a_hinge_part_at_the_restitution_of_its_limit(restitution):
    """Their spins change at the limit as momentum, a hinge that holds, and the limit demand.

    A pair of impulses (p, q) acts at the pin and a pair of torques t between the bodies: five
    unknown velocities and three impulses follow from eight linear equations.
    """
    size = {"length": 1.0, "width": 0.4, "ground_friction": 0.0}
    first = Box(name="a", pose=(0, 0, 0), mass=2.0, **size)
    second = Box(name="b", pose=(1, 0, 0), velocity=(0, 0.5, 1.0), mass=1.0, **size)
    limits = {"limits": (-0.4, 0.4), "limit_restitution": restitution}
    world = endless([FAR], [first, second], [hinge(first, second, **limits)], sampling_time=1e-3)
    before = after = world.prop_velocity
    for _ in range(2000):
        before, pose = world.prop_velocity, world.prop_pose
        world.step([[0], [0]])
        after = world.prop_velocity
        if (after[2, 1] - after[2, 0]) < (before[2, 1] - before[2, 0]) - 0.05:
            break
    found = after - before
    inverse = [[1 / prop.inertia.mass] * 2 + [1 / prop.inertia.moment] for prop in (first, second)]
    c, s = np.cos(pose[2]), np.sin(pose[2])
    arm_a, arm_b = 0.5 * np.array([c[0], s[0]]), -0.5 * np.array([c[1], s[1]])
    rows = np.array(
        [  # the point on b less that on a, along x and y, and the spin of b less that of a
            [-1, 0, arm_a[1], 1, 0, -arm_b[1]],
            [0, -1, -arm_a[0], 0, 1, arm_b[0]],
            [0, 0, -1, 0, 0, 1],
        ]
    )
    state = before.T.ravel()
    wanted = np.array([0, 0, -restitution * (rows @ state)[2]]) - rows @ state
    weights = np.diag(np.ravel(inverse))
    change = weights @ rows.T @ np.linalg.solve(rows @ weights @ rows.T, wanted)
    assert found.T.ravel() == pytest.approx(change, abs=0.02 * np.abs(change).max())


# -- who has done how much --------------------------------------------------------------------


def test_a_slide_loses_all_to_the_floor():
    world = endless([FAR], [Box(velocity=(2, 0, 0), mass=3.0, ground_friction=0.4)])
    balanced(world, 2)
    assert work(world) == pytest.approx([0, -0.5 * 3 * 4, 0, 0, 0, 0], abs=1e-9)


@each_case("mu", [0.1, 0.25])
def test_an_oblique_impact_of_a_disc_loses_to_friction_what_it_slides(mu):
    """It slides all the time: the friction's impulse is mu (1 + e) m v_n."""
    e, m, vn, vt = 0.5, 2.0, 1.0, 3.0
    puck = Puck(
        diameter=0.2, pose=(0, 0.5, 0), velocity=(vt, -vn, 0), mass=m, friction=mu,
        restitution=e, ground_friction=0.0,
    )  # fmt: skip
    world = endless([FAR], [puck], addons=[Map([[(-9, 0), (9, 0)]])])
    balanced(world, 1)
    push = (1 + e) * m * vn
    after, spin = vt - mu * push / m, mu * push * 0.1 / puck.inertia.moment
    assert after - spin * 0.1 > 0  # it does slide until the end
    assert world.prop_velocity[:, 0] == pytest.approx([after, e * vn, -spin], rel=1e-3)
    change = m * (after**2 - vt**2) / 2 + puck.inertia.moment * spin**2 / 2
    assert work(world)[FRICTION] == pytest.approx(change, rel=1e-3)
    assert work(world)[IMPACTS] == pytest.approx(-(1 - e**2) * m * vn**2 / 2, rel=1e-3)
    [contact] = world.record.contacts
    # On the wall, along its normal (0, -1) turned by +90 degrees: (1, 0).
    assert contact["tangential_impulse"] == pytest.approx(mu * contact["normal_impulse"], rel=1e-6)
    assert (contact["slip"], contact["speed"]) == pytest.approx((-vt, vn), rel=1e-6)


@each_case(
    ("drive", "command"),
    [
        (Unicycle(max_force=4, max_torque=1), (0.4, 0.8)),
        (Unicycle(max_force=4, max_torque=1, force_limited=True), (0.4, 0.8)),
        (Unicycle(max_acceleration=0.4, max_linear_speed=2), (1.5, 0.0)),
        (Differential(max_acceleration=0.4, command="twist"), (0.4, 0.5)),
        (Car(max_acceleration=0.4, max_linear_speed=2), (1.0, 0.3)),
        (Car(max_steering_rate=0.3), (0.4, 0.5)),
    ],
)
def test_what_a_drive_does_in_the_open_is_the_energy_of_its_robot(drive, command):
    world = endless([Robot(mass=2.0, drive=drive)])
    whole = balanced(world, 3, np.reshape(command, (2, 1)))[-1]
    assert work(world)[DRIVES] == pytest.approx(whole, rel=1e-9)
    assert whole > 0.1


def test_a_steady_push_gives_the_floor_what_the_drive_does():
    """mu m g v a second, once box and robot have their speed, by mu m g at the face's middle."""
    box = Box(pose=(0.5, 0, 0), mass=1.0, ground_friction=0.3)
    shape = Polygon([(-0.15, -0.1), (0.15, -0.1), (0.15, 0.1), (-0.15, 0.1)])
    world = endless([Robot(drive=Unicycle(max_force=20), shape=shape)], [box], sampling_time=0.05)
    balanced(world, 3, [[0.4], [0]])
    before = work(world)
    balanced(world, 2, [[0.4], [0]])
    gained = work(world) - before
    rate = 0.3 * GRAVITY * 0.4
    assert gained[DRIVES] == pytest.approx(2 * rate, rel=5e-3)
    assert gained[FLOOR] == pytest.approx(-2 * rate, rel=5e-3)
    assert np.abs(gained[[FRICTION, IMPACTS, JOINTS, HANDS]]).max() < 0.01 * rate
    [contact] = world.contacts
    assert contact["normal_impulse"] / 0.05 == pytest.approx(0.3 * GRAVITY, rel=1e-3)
    assert contact["normal"] == pytest.approx([1, 0], abs=5e-3)
    assert contact["point"][1] == pytest.approx(0, abs=2e-3)
    assert 0.13 - 1e-3 < contact["point"][0] - world.pose[0, 0] < 0.15 + 1e-3  # early in the step


def test_a_ropes_jerk_loses_what_an_inelastic_impact_does():
    first = Ball(name="a", velocity=(-1, 0, 0), mass=1.0, ground_friction=0.0)
    second = first.replace(name="b", pose=(0.5, 0, 0), velocity=(2, 0, 0), mass=2.0)
    world = endless([FAR], [first, second], joints=[Rope(a="a", b="b", length=1.0)])
    balanced(world, 2)
    assert work(world)[JOINTS] == pytest.approx(-0.5 * (1 * 2 / 3) * 3**2, rel=1e-3)
    assert work(world)[IMPACTS] == pytest.approx(0, abs=1e-9)


def test_a_spring_takes_and_gives_back():
    """Its work is minus what is stored, k x^2 / 2."""
    k = 20.0
    ball = Ball(name="a", pose=(1.3, 0, 0), mass=0.5, ground_friction=0.0)
    spring = Spring(a="a", anchor_b=(0, 0), rest_length=1.0, stiffness=k, damping=0.0)
    world = endless([FAR], [ball], joints=[spring], sampling_time=0.01)
    stored = k * 0.3**2 / 2
    for _ in range(100):
        balanced(world, 0.01)
        left = k * (world.prop_pose[0, 0] - 1.0) ** 2 / 2
        assert work(world)[JOINTS] == pytest.approx(stored - left, abs=0.05 * stored)


def test_a_pull_from_outside_is_the_work_of_hands():
    world = endless([FAR], [Puck(mass=2.0, ground_friction=0.0)], sampling_time=0.01)
    engine = world.simulation.engine
    engine.pull(1, (3.0, 4.0), 0.0)
    engine.drive(np.zeros((3, 1)), 0.5, 0.0)
    engine.let_go()
    speed = 5.0 / 2.0 * 0.5
    engine.look()
    assert engine.seen_work[HANDS] == pytest.approx(2.0 * speed**2 / 2, rel=1e-6)
    assert hypot(*engine.velocity[:2, 1]) == pytest.approx(speed, rel=1e-6)


@each_case("seed", range(3))
def test_a_tangle_of_all_of_it_adds_up(seed):
    """Robots of all drives, also with a centre of mass elsewhere; props, ropes, rods, a wall."""
    rng = np.random.default_rng(seed)
    kinds = [
        Unicycle(max_force=8), Unicycle(force_limited=True), Holonomic(grip=0.5),
        Car(no_load_speed=1.0),
    ]  # fmt: skip
    look = {"friction": 0.5, "restitution": 0.5}
    robots = [
        Robot(
            pose=(0.7 * (k % 3), 0.7 * (k // 3), rng.uniform(-pi, pi)), drive=kinds[k % 4],
            name=f"r{k}", mass_offset=0.05 * (k % 2), **look,
        )
        for k in range(6)
    ]  # fmt: skip
    props = [
        (Box, Puck, Ball)[k % 3](
            name=f"p{k}", pose=(0.7 * (k % 3), 1.5 + 0.7 * (k // 3), 1.0 * k),
            velocity=(*rng.uniform(-1, 1, 2), 2.0), **look,
        )
        for k in range(6)
    ]  # fmt: skip
    joints = [Rope(a="r0", b="p0", length=1.8), Rod(a="r1", b="r2"), Rod(a="p4", b="p5")]
    walls = Map(walls=[[(-0.5, -0.5), (2.0, -0.5), (2.0, 3.2), (-0.5, 3.2), (-0.5, -0.5)]])
    world = endless(robots, props, joints=joints, addons=[walls], sampling_time=0.05)
    for _ in range(20):
        balanced(world, 0.3, np.array([rng.uniform(-0.5, 0.5, 6), rng.uniform(-0.5, 0.5, 6)]))


def test_the_energy_of_a_world_has_that_of_each_body():
    robot = Robot(mass=2.0, drive=Car(), mass_offset=0.1)
    puck = Puck(pose=(3, 0, 0), velocity=(0.5, 0, 3), mass=0.4, ground_friction=0.0)
    world = endless([robot], [puck])
    balanced(world, 1, [[0.3], [0.4]])
    spin = world.velocity[2, 0]
    moment = world.scenario.bodies[0].inertia.moment
    first = (2.0 * (0.3**2 + (0.1 * spin) ** 2) + moment * spin**2) / 2
    second = (0.4 * 0.5**2 + puck.inertia.moment * 3**2) / 2
    assert world.energy.kinetic == pytest.approx([first, second])
    assert world.energy.total == pytest.approx(kinetic(world))
    assert world.energy.by("drives") == pytest.approx(first)


def test_what_is_put_elsewhere_has_lost_its_energy_to_hands():
    puck = Puck(name="puck", velocity=(1, 0, 0), mass=2.0, ground_friction=0.0)
    world = endless([FAR], [puck])
    balanced(world, 0.5)
    world.operator.place("puck", (2.0, 2.0, 0.0))
    assert world.energy.by("hands") == pytest.approx(-1.0)
    balanced(world, 0.5)
    assert world.energy.total == 0.0


@each_case("physics", ["stop", "ideal"])
def test_without_forces_drives_do_all_and_what_stops_has_lost_it_in_the_impact(physics):
    puck = Puck(pose=(1, 0, 0), velocity=(-0.5, 0, 0), mass=2.0, ground_friction=0.0)
    world = endless([Robot(mass=3.0)], [puck], physics=physics)
    balanced(world, 2, [[0.4], [0]])
    lost = -2.0 * 0.5**2 / 2 if physics == "stop" else 0.0
    assert world.energy.by("impacts") == pytest.approx(lost)


@each_case("angle", [0.0, 30.0])
def test_a_robot_that_presses_against_a_wall_does_no_work(angle):
    robot = Robot(pose=(-0.3, 0, 0), drive=Unicycle(max_force=5), friction=2.0)
    a = radians(90 - angle)
    walls = Map([[(-3 * cos(a), -3 * sin(a)), (3 * cos(a), 3 * sin(a))]])
    world = endless([robot], addons=[walls])
    balanced(world, 2, [[0.3], [0]])
    before = work(world)
    balanced(world, 2, [[0.3], [0]])
    assert np.abs(work(world) - before).max() < 1e-4
