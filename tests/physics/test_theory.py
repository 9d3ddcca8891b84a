"""Contact physics against the textbook: stalemates, momentum, energy, restitution, impulses."""

from __future__ import annotations

from itertools import pairwise
from math import cos, pi, sin, sqrt

import numpy as np
import pytest

from mars2d import Holonomic, Robot, World
from mars2d.addons import Map
from mars2d.bodies.joints import Hinge, Rod, Rope, Spring
from mars2d.bodies.props import Ball, Bar, Box, Puck, Solid
from mars2d.core.materials import GRAVITY
from mars2d.geometry.shapes import Compound, Disc, Polygon
from mars2d.physics.islands.contacts import Touch
from mars2d.physics.islands.shadow import Doubles
from mars2d.record.contact import episodes
from tests.cases import each_case
from tests.islands import plainly
from tests.worlds import drive, endless

IDLE = Robot(pose=(50, 50, 0))
ELL = Polygon([(0, 0), (0.3, 0), (0.3, 0.1), (0.1, 0.1), (0.1, 0.3), (0, 0.3)])
TEE = Polygon(
    [
        (-0.3, -0.05),
        (0, -0.05),
        (0, -0.2),
        (0.1, -0.2),
        (0.1, 0.2),
        (0, 0.2),
        (0, 0.05),
        (-0.3, 0.05),
    ]
)
SQUARE = Polygon([(-0.15, -0.15), (0.15, -0.15), (0.15, 0.15), (-0.15, 0.15)])
DUMBBELL = Compound([Disc(0.12).moved(-0.1, 0), Disc(0.12).moved(0.1, 0)])


def coast(world: World, seconds: float) -> None:
    drive(world, np.zeros((2, len(world.scenario.robots))), seconds)


# -- stalemates -----------------------------------------------------------------------------


@each_case(
    ("shape", "between"),
    [(None, ()), (None, (Box(),)), (SQUARE, ()), (SQUARE, (Ball(),)), (SQUARE, (Box(),))],
)
def test_two_equal_robots_head_on_do_not_drift_whatever_is_between(shape, between):
    robots = [Robot(pose=(x, 0, pi * (x > 0)), shape=shape) for x in (-0.6, 0.6)]
    world = endless(robots, [prop.replace(ground_friction=0.1) for prop in between])
    drive(world, [[0.3, 0.3], [0, 0]], 5)
    start = np.hstack([world.pose, world.prop_pose])
    drive(world, [[0.3, 0.3], [0, 0]], 15)
    poses = np.hstack([world.pose, world.prop_pose])
    # Three bodies pressed together buckle a little, those with flat faces the most.
    turns = 1e-5 if not between else 2e-4 if shape is None else 5e-3
    assert np.abs(world.pose[:2].mean(axis=1)).max() < turns
    assert np.abs(poses - start).max() < turns
    assert world.effort == pytest.approx([1, 1], abs=1e-3)


# -- walls ----------------------------------------------------------------------------------


@each_case("shape", [None, SQUARE])
@each_case("slope", [0.3, 0.8, 1.2])
def test_along_a_wall_without_friction_a_robot_slides_at_v_cos_a(shape, slope):
    robot = Robot(
        pose=(0, 0.2, 0), shape=shape, friction=0, drive=Holonomic(max_torque=50, max_force=5)
    )
    world = endless([robot], addons=[Map([[(-1, 0), (9, 0)]], friction=0)])
    command = [[0.4 * cos(slope)], [-0.4 * sin(slope)]]
    drive(world, command, 3)
    start = world.pose[0, 0]
    drive(world, command, 3)
    assert (world.pose[0, 0] - start) / 3 == pytest.approx(0.4 * cos(slope), rel=1e-3)


@each_case("shape", [None, SQUARE])
@each_case("mu", [0.3, 0.8])
def test_a_robot_sticks_to_a_wall_within_the_cone_of_friction(shape, mu):
    """The drive pulls against the error of velocity: sticking, along the command."""

    def way(slope: float) -> float:  # of the command against the normal of the wall
        robot = Robot(pose=(0, 0.16, 0), shape=shape, friction=mu, drive=Holonomic(max_torque=50))
        world = endless([robot], addons=[Map([[(-1, 0), (9, 0)]], friction=1)])
        command = [[0.4 * sin(slope)], [-0.4 * cos(slope)]]
        drive(world, command, 2)
        start = world.pose[0, 0]
        drive(world, command, 1)
        return float(world.pose[0, 0] - start)

    limit = np.arctan(mu)
    assert abs(way(0.97 * limit)) < 1e-4
    assert way(1.05 * limit) > 1e-3


# -- what is kept ---------------------------------------------------------------------------


def balance(world: World) -> tuple[np.ndarray, float, float]:
    """Linear momentum [N s], angular momentum [N m s], kinetic energy [J] of the props."""
    inertia = [prop.inertia for prop in world.scenario.props]
    mass, moment = np.array(inertia).T
    vx, vy, spin = world.prop_velocity
    x, y, _ = world.prop_pose
    momentum = np.array([(mass * vx).sum(), (mass * vy).sum()])
    angular = float((moment * spin + mass * (x * vy - y * vx)).sum())
    energy = float((mass * (vx**2 + vy**2) + moment * spin**2).sum() / 2)
    return momentum, angular, energy


def tangle(seed: int, restitution: float, friction: float, *, tied: bool):
    """Props without friction on the floor that fly into each other; joints between some."""
    rng = np.random.default_rng(seed)
    kinds = [
        Ball(diameter=0.25), Box(length=0.3, width=0.2), Puck(diameter=0.2), Solid(ELL),
        Bar(length=0.5), Solid(DUMBBELL), Box(length=0.2, width=0.2), Ball(diameter=0.15),
        Solid(Polygon([(0, 0), (0.3, 0), (0.1, 0.25)])),
    ]  # fmt: skip
    props = []
    for k, kind in enumerate(kinds):
        x, y = 0.7 * (k % 3 - 1), 0.7 * (k // 3 - 1)
        velocity = -0.8 * np.array([x, y]) + rng.uniform(-0.3, 0.3, 2)
        props.append(
            kind.replace(
                name=f"p{k}", ground_friction=0, friction=friction, restitution=restitution,
                mass=float(rng.choice([1.0, 2.0, 5.0])), pose=(x, y, rng.uniform(-3, 3)),
                velocity=(*velocity, rng.uniform(-3, 3)),
            )
        )  # fmt: skip
    if not tied:
        return props, []
    (x0, y0, _), (x1, y1, _) = props[6].pose, props[7].pose
    joint = Hinge(
        a="p6", b="p7",
        anchor_a=into(props[6].pose, ((x0 + x1) / 2, (y0 + y1) / 2)),
        anchor_b=into(props[7].pose, ((x0 + x1) / 2, (y0 + y1) / 2)),
    )  # fmt: skip
    return props, [
        Rope(a="p0", b="p3", length=1.0),
        Rod(a="p1", b="p2"),
        Spring(a="p4", b="p5", rest_length=0.4, stiffness=15),
        joint,
    ]


def into(pose, point) -> tuple[float, float]:
    """A point of the world in the frame of a body."""
    x, y, theta = pose
    dx, dy = point[0] - x, point[1] - y
    return cos(theta) * dx + sin(theta) * dy, -sin(theta) * dx + cos(theta) * dy


@each_case("tied", [False, True])
@each_case("seed", range(2))
def test_linear_momentum_is_kept_to_a_billionth(seed, tied):
    props, joints = tangle(seed, 0.7, 0.5, tied=tied)
    world = endless([IDLE], props, joints=joints)
    before, _, _ = balance(world)
    for _ in range(30):
        coast(world, 0.1)
        assert np.abs(balance(world)[0] - before).max() < 1e-9
    assert len(world.record.contacts) > 3


@each_case("tied", [False, True])
@each_case("seed", range(2))
def test_angular_momentum_is_kept_but_for_how_deep_a_blow_finds_bodies(seed, tied):
    """Of props, that is a sixteenth of the slop; what joints are off by adds to it."""
    props, joints = tangle(seed, 0.7, 0.5, tied=tied)
    for time in (0.005, 0.1, 0.5):
        world = endless([IDLE], props, joints=joints, sampling_time=time)
        _, before, _ = balance(world)
        scale = sum(p.inertia.mass * np.hypot(*p.velocity[:2]) * 1.0 for p in props)
        for _ in range(round(3 / time)):
            world.step(np.zeros((2, 1)))
            off = abs(balance(world)[1] - before)
            assert off < (5e-4 if tied else 1e-5) * scale
        assert len(world.record.contacts) > 3


@each_case(("seed", "friction"), [(0, 0.0), (1, 0.5), (2, 1.0)])
@each_case("restitution", [0.0, 0.5, 1.0])
def test_energy_never_grows(seed, restitution, friction):
    props, _ = tangle(seed, restitution, friction, tied=False)
    world = endless([IDLE], props)
    start = last = balance(world)[2]
    for _ in range(30):
        coast(world, 0.1)
        energy = balance(world)[2]
        assert energy <= last + 1e-9 * start
        last = energy


# -- restitution ----------------------------------------------------------------------------


@each_case("restitution", [0.0, 0.3, 0.7, 1.0])
@each_case("prop", [Ball(), Box(), Solid(TEE), Puck()])
@each_case("speed", [0.1, 2.0])
def test_a_prop_bounces_off_a_wall_at_its_restitution(restitution, prop, speed):
    prop = prop.replace(restitution=restitution, ground_friction=0, velocity=(speed, 0, 0))
    world = endless([IDLE], [prop], addons=[Map([[(0.5, -1), (0.5, 1)]])])
    coast(world, 0.6 / speed)
    assert world.prop_velocity[0, 0] == pytest.approx(-restitution * speed, abs=0.02 * speed)
    assert abs(world.prop_velocity[2, 0]) < 0.05 * speed


def test_a_bar_that_hits_a_wall_with_its_end_is_turned_by_the_impulse_times_its_lever():
    # It lies along the wall but for a small angle; its lower corner hits.
    bar = Bar(
        pose=(0, 0, pi / 2 + 0.05), velocity=(1, 0, 0), ground_friction=0, friction=0,
        restitution=0.5,
    )  # fmt: skip
    world = endless([IDLE], [bar], addons=[Map([[(0.5, -1), (0.5, 1)]])], sampling_time=0.01)
    while not len(world.record.contacts):
        coast(world, 0.01)
    corner = np.array([cos(0.05) * 0.03 + sin(0.05) * 0.5, -cos(0.05) * 0.5 + sin(0.05) * 0.03])
    mass, moment = bar.inertia
    impulse = 1.5 / (1 / mass + corner[1] ** 2 / moment)
    row = world.record.contacts[0]
    assert row["normal_impulse"] == pytest.approx(impulse, rel=0.02)
    assert row["point"][1] == pytest.approx(corner[1], abs=2e-3)
    assert world.prop_velocity[0, 0] == pytest.approx(1 - impulse / mass, abs=0.02)
    # The wall pushes the corner, which lies below the centre, back: that turns it clockwise.
    assert world.prop_velocity[2, 0] == pytest.approx(corner[1] * impulse / moment, rel=0.02)


@each_case("restitution", [0.25, 0.5, 1.0])
@each_case("masses", [(1, 1), (1, 3), (5, 1)])
def test_balls_in_line_part_as_the_laws_of_impact_say(restitution, masses):
    m, n = masses
    balls = [
        Ball(velocity=(1, 0, 0), mass=m, restitution=restitution),
        Ball(pose=(0.55, 0, 0), mass=n),
    ]
    world = endless([IDLE], balls)
    coast(world, 1)
    common = m / (m + n)
    expected = [common - restitution * n / (m + n), common + restitution * m / (m + n)]
    assert world.prop_velocity[0] == pytest.approx(expected, abs=1e-3)
    [row] = world.record.contacts
    assert row["normal_impulse"] == pytest.approx((1 + restitution) * m * n / (m + n), rel=1e-3)
    assert row["impulse"] == pytest.approx(row["normal_impulse"], rel=1e-6)
    assert row["speed"] == pytest.approx(1, rel=1e-6)
    assert abs(row["tangential_impulse"]) < 1e-9
    assert row["began"]
    assert row["ended"]
    assert row["time"] == pytest.approx(0.35, abs=2e-3)
    assert row["normal"] == pytest.approx([1, 0], abs=1e-9)
    assert row["point"] == pytest.approx([0.45, 0], abs=2e-3)


@each_case("restitution", [0.5, 1.0])
@each_case("offset", [0.05, -0.12, 0.17])
def test_balls_that_meet_obliquely_part_along_the_normal_alone(restitution, offset):
    balls = [
        Ball(velocity=(1, 0, 0), restitution=restitution),
        Ball(pose=(0.6, offset, 0), mass=2),
    ]
    world = endless([IDLE], balls, sampling_time=0.02)
    coast(world, 1)
    normal = np.array([sqrt(0.04 - offset**2), offset]) / 0.2
    impulse = (1 + restitution) * normal[0] / (1 + 1 / 2)
    expected = np.array([[1, 0] - impulse * normal, impulse / 2 * normal]).T
    assert world.prop_velocity[:2] == pytest.approx(expected, abs=0.01)


@each_case("mu", [0.05, 0.1, 0.2])
def test_a_rough_ball_that_slides_over_a_wall_is_turned_by_mu_times_the_impulse(mu):
    slope = 1.0
    ball = Ball(
        pose=(0, 0.3, 0), velocity=(sin(slope), -cos(slope), 0), friction=mu, restitution=0.5
    )
    world = endless([IDLE], [ball], addons=[Map([[(-1, 0), (9, 0)]])], sampling_time=0.02)
    coast(world, 1)
    impulse = 1.5 * cos(slope)
    vx, vy, spin = world.prop_velocity[:, 0]
    assert vy == pytest.approx(0.5 * cos(slope), rel=0.02)
    assert vx == pytest.approx(sin(slope) - mu * impulse, rel=0.01)
    assert spin == pytest.approx(-mu * impulse * 0.1 / (0.1**2 / 2), rel=0.02)
    [row] = world.record.contacts
    assert (row["a"], row["b"]) == (1, -1)
    assert row["normal_impulse"] == pytest.approx(impulse, rel=0.02)
    # On the wall, along its normal (0, -1) turned by +90 degrees: (1, 0).
    assert row["tangential_impulse"] == pytest.approx(mu * row["normal_impulse"], rel=1e-6)
    assert row["slip"] == pytest.approx(-sin(slope), rel=1e-6)  # of the wall against the ball
    assert row["speed"] == pytest.approx(cos(slope), rel=1e-6)


# -- steady contacts ------------------------------------------------------------------------


def test_pushing_a_box_steadily_takes_mu_m_g_in_the_contact_and_at_the_middle_of_the_face():
    shape = Polygon([(-0.15, -0.1), (0.15, -0.1), (0.15, 0.1), (-0.15, 0.1)])
    robot = Robot(pose=(-0.4, 0, 0), shape=shape)
    world = endless([robot], [Box(ground_friction=0.3, mass=1.2)])
    drive(world, [[0.2], [0]], 3)
    row = world.contacts[0]
    assert row["normal_impulse"] / 0.1 == pytest.approx(0.3 * 1.2 * GRAVITY, rel=1e-3)
    assert (row["a"], row["b"]) == (0, 1)
    assert row["normal"] == pytest.approx([1, 0], abs=5e-3)
    assert row["point"][1] == pytest.approx(0, abs=2e-3)
    assert 0.13 - 1e-3 < row["point"][0] - world.pose[0, 0] < 0.15 + 1e-3  # early in the step
    assert abs(row["slip"]) < 1e-3


def test_the_times_of_touching_add_up_to_that_between_touch_and_parting():
    world = endless([Robot()], addons=[Map([[(0.5, -1), (0.5, 1)]])])
    drive(world, [[0.2], [0]], 3)
    drive(world, [[-0.2], [0]], 1)
    drive(world, [[0.2], [0]], 3)
    rows = world.record.contacts
    first, second = episodes(rows)
    assert first["began"] == pytest.approx(0.35 / 0.2, abs=1e-2)
    assert first["ended"] == pytest.approx(3, abs=0.03)  # a substep in contact
    assert second["began"] == pytest.approx(5, abs=0.03)
    assert second["ended"] == pytest.approx(7)
    total = sum(float(e["ended"] - e["began"]) for e in (first, second))
    assert rows["duration"].sum() == pytest.approx(total, abs=1e-6)
    assert rows["ended"].sum() == 1
    assert rows["began"].sum() == 2
    assert world.record.collisions == 2


def gained_and_told(world: World, ticks: int) -> tuple[np.ndarray, np.ndarray]:
    """Let props coast; return what momentum they got, and what their contacts tell, (2, p) N s."""
    mass = np.array([prop.inertia.mass for prop in world.scenario.props])
    before = mass * world.prop_velocity[:2]
    told = np.zeros_like(before)
    for _ in range(ticks):
        coast(world, world.scenario.sampling_time)
        for row in world.contacts:
            n = row["normal"]
            impulse = row["normal_impulse"] * n
            impulse = impulse + row["tangential_impulse"] * np.array([-n[1], n[0]])
            told[:, row["a"] - 1] -= impulse
            if row["b"] > 0:
                told[:, row["b"] - 1] += impulse
    return mass * world.prop_velocity[:2] - before, told


def meeting(seed: int, count: int, restitution: float) -> list[Ball]:
    """Rough balls of all masses on a grid, which fly to its middle."""
    rng = np.random.default_rng(seed)
    balls = []
    for k in range(count**2):
        x, y = 0.5 * (k % count - (count - 1) / 2), 0.5 * (k // count - (count - 1) / 2)
        velocity = (*(rng.uniform(-0.3, 0.3, 2) - [x, y]), rng.uniform(-5, 5))
        balls.append(
            Ball(pose=(x, y, 0), velocity=velocity, friction=0.7, restitution=restitution,
                 mass=rng.uniform(1, 5))
        )  # fmt: skip
    return balls


def impulses_of(world: World, ticks: int) -> tuple[np.ndarray, np.ndarray]:
    """Do the same in Python, where a contact's impulse is seen as a vector before it is written."""
    told = np.zeros((2, len(world.scenario.props)))
    original = Touch.write

    def write(touch: Touch, numbers: Doubles, k: int) -> None:
        told[:, touch.a - 1] -= touch.impulse_x, touch.impulse_y
        if touch.b > 0:
            told[:, touch.b - 1] += touch.impulse_x, touch.impulse_y
        original(touch, numbers, k)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Touch, "write", write)
        change, _ = gained_and_told(world, ticks)
    return change, told


@pytest.mark.nightly
@each_case("seed", range(4))
@each_case("restitution", [0.0, 0.7071, 1.0])
def test_in_crowds_between_walls_they_add_up_to_the_last_digits(seed, restitution):
    room = [(-1.6, -1.6), (1.6, -1.6), (1.6, 1.6), (-1.6, 1.6), (-1.6, -1.6)]
    walls = Map(list(pairwise(room)), restitution=restitution)
    balls = meeting(seed, 6, restitution)
    with plainly():
        world = endless([IDLE], balls, addons=[walls], sampling_time=0.02)
    change, told = impulses_of(world, 250)
    assert len(world.record.contacts) > 50
    assert world.record.contacts["b"].min() < 0
    assert np.abs(change).max() > 1
    assert told == pytest.approx(change, abs=1e-12)


@each_case("tied", [False, True])
def test_in_a_tangle_of_shapes_they_add_up_but_for_what_joints_do(tied):
    props, joints = tangle(1, 0.7, 0.5, tied=tied)
    with plainly():
        world = endless([IDLE], props, joints=joints)
    change, told = impulses_of(world, 20)
    loose = [k for k in range(len(props)) if not tied or k == 8]  # all others are tied
    assert told[:, loose] == pytest.approx(change[:, loose], abs=1e-12)
    assert told.sum(axis=1) == pytest.approx(change.sum(axis=1), abs=1e-9)


@each_case("restitution", [0.0, 0.3, 0.7071, 0.9, 1.0])
@each_case("gap", [0.0, 1e-4, 1e-3, 1e-2])
@each_case("count", [1, 2, 4])
def test_a_chain_of_pucks_before_a_wall_tells_of_all_its_momentum_and_wins_no_energy(
    restitution, gap, count
):
    """One is thrown at 2 m/s at others that lie apart by a gap, the last by as much from a wall."""
    still = [(0.5 + (0.2 + gap) * k, 0, 0) for k in range(count)]
    pucks = [
        Puck(diameter=0.2, pose=pose, restitution=restitution, friction=0, ground_friction=0)
        for pose in [(0, 0, 0), *still]
    ]
    pucks[0] = pucks[0].replace(velocity=(2, 0, 0))
    end = still[-1][0] + 0.1 + gap
    wall = Map([[(end, -1), (end, 1)]], restitution=restitution)
    world = endless([IDLE], pucks, addons=[wall], sampling_time=0.05)
    energy = balance(world)[2]
    change, told = gained_and_told(world, 20)
    assert told == pytest.approx(change, abs=1e-6)
    assert balance(world)[2] <= energy * (1 + 1e-9)
    wall_rows = world.record.contacts[world.record.contacts["b"] == -1]
    assert wall_rows["normal_impulse"].sum() == pytest.approx(-change[0].sum(), abs=1e-6)
    assert world.prop_pose[0].max() < end - 0.1 + 1e-3
    assert (np.diff(world.prop_pose[0]) > 0.2 - 1e-3).all()  # nobody passes another


@each_case("gap", [1e-3, 1e-2])
def test_in_a_chain_each_impact_is_that_of_two(gap):
    """With a gap before the wall, the second puck comes back and hits the first once more."""
    e = 0.7071
    pucks = [
        Puck(diameter=0.2, pose=(0, 0, 0), velocity=(2, 0, 0), restitution=e, ground_friction=0),
        Puck(diameter=0.2, pose=(0.5, 0, 0), restitution=1, ground_friction=0),
    ]
    end = 0.6 + gap
    world = endless(
        [IDLE], pucks, addons=[Map([[(end, -1), (end, 1)]], restitution=1)], sampling_time=0.05
    )
    coast(world, 0.6)
    # The first goes on at 2 (1 - e) / 2, the second at 2 (1 + e) / 2 to the wall, and back into it.
    first, second = 1 - e, -(1 + e)
    common, apart = (first + second) / 2, e * (first - second) / 2
    assert world.prop_velocity[0] == pytest.approx([common - apart, common + apart], abs=2e-3)
