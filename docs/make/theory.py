"""Write docs/theory.md: what the physics predicts, and what is measured, in one table.

python docs/make/theory.py
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from math import cos, inf, pi, sin, sqrt, tan
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mars2d import Car, Differential, Holonomic, Prediction, Robot, Scenario, Unicycle, World
from mars2d.addons import Map
from mars2d.bodies import Ball, Box, Gate, Joint, Prop, Puck, Rope, Spring
from mars2d.core.materials import GRAVITY
from mars2d.record import episodes
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.prediction import SIGNS
from mars2d.world.loop import simulate
from mars2d.world.record import Record

Float = NDArray[np.float64]

CROWD_SEEDS = range(8)

HEAD = """\
# Theory and measurement

Predictions of textbooks, and what the simulator measures. `docs/make/theory.py` writes this page,
and tests run everything again and fail if a number leaves its tolerance. Tolerances are absolute,
in the unit given; one of more than a tenth of the predicted number is marked as rough: a rule of
thumb, or the scatter of a few samples. If 0 is predicted, the measured value is a rounding error.
"""

EXAMPLES = """
## The examples

Of each example that checks itself, the prediction that uses most of its tolerance, and how many it
has. `mars2d run NAME --headless` prints all of them.

"""


def run(
    robots: Sequence[Robot],
    command: Sequence[Sequence[float]],
    seconds: float,
    *,
    props: Sequence[Prop] = (),
    joints: Sequence[Joint] = (),
    walls: Sequence[Sequence[tuple[float, float]]] = (),
    friction: float = 1.0,
    friction_rule: str = "product",
    sampling_time: float = 0.1,
) -> Record:
    """Run robots under a constant command, in a plane without limits."""
    scenario = Scenario(
        robots=robots, props=props, joints=joints, workspace=None, stop_time=seconds,
        addons=[Map(walls, friction=friction)], sampling_time=sampling_time,
        friction_rule=friction_rule,
    )  # fmt: skip
    world = World(scenario)
    while not world.over:
        world.step(command)
    return world.record


def velocity(record: Record) -> Float:
    """Return the props' mean velocities (T - 1, 3, p) between rows."""
    return np.diff(record.prop_pose, axis=0) / record.scenario.sampling_time


# -- single facts ---------------------------------------------------------------------------------


def free_arcs() -> Iterator[Prediction]:
    """Compare drives that nothing touches with the circles that they command."""
    seconds = 100.0
    turning = {
        "unicycle": (Unicycle(), (0.2, 0.5), (0.2, 0.5)),
        "differential drive by wheel speeds": (
            Differential(command="wheels", wheel_radius=0.05, wheel_semiaxis=0.1),
            (3.0, 5.0), (0.2, 0.5),
        ),
        "car": (Car(wheelbase=0.3), (0.3, 0.4), (0.3, 0.3 * tan(0.4) / 0.3)),
    }  # fmt: skip
    for name, (drive, command, (v, omega)) in turning.items():
        pose = run([Robot(drive=drive)], [[c] for c in command], seconds).pose[-1, :, 0]
        angle = omega * seconds
        exact = v / omega * np.array([sin(angle), 1 - cos(angle)])
        error = float(np.hypot(*(pose[:2] - exact)))
        yield Prediction(f"{name}: off its arc after 100 s", 0.0, error, 1e-9, "m")


def stalemate() -> Iterator[Prediction]:
    """Let two equal robots push each other for a minute."""
    pair = [Robot(pose=(-0.3, 0, 0)), Robot(pose=(0.3, 0, pi))]
    pose = run(pair, [[0.2, 0.2], [0, 0]], 60).pose
    drift = float(np.abs(pose[:, :2].mean(axis=2)).max())
    yield Prediction("two equal robots head-on: drift of the middle", 0.0, drift, 1e-6, "m")


def acceleration() -> Iterator[Prediction]:
    """Push a box without friction by a drive that is far from its speed."""
    force, mass, load = 4.0, 1.0, 3.0
    robot = Robot(mass=mass, drive=Unicycle(max_force=force, max_linear_speed=50.0))
    box = Box(pose=(0.3501, 0, 0), mass=load, ground_friction=0.0)
    v = velocity(run([robot], [[50.0], [0]], 2, props=[box]))[:, 0, 0]
    predicted = force / (mass + load)
    measured = (v[-1] - v[-11]) / 1.0
    yield Prediction(
        "pushed box: acceleration F / m", predicted, measured, 0.005 * predicted, "m/s^2"
    )


def run_up() -> Iterator[Prediction]:
    """Let a robot gather speed alone, and rows of robots push what they can't move."""
    force, mass = 0.7, 1.9
    cart = Robot(mass=mass, drive=Unicycle(max_force=force, force_limited=True))
    x = run([cart], [[0.5], [0]], 1.2).pose[-1, 0, 0]
    path = force * 1.2**2 / (2 * mass)
    yield Prediction("force_limited: path F t^2 / (2 m)", path, x, 1e-9, "m")
    most = 0.0
    for n in (1, 3, 8):
        for gap in (0.0, 1e-12, 1e-6):
            robot = Robot(drive=Unicycle(max_force=2.0, force_limited=True))
            team = [robot.at(-0.35 - gap - i * (0.3 + gap), 0) for i in range(n)]
            box = Box(mass=4.0, ground_friction=1.05 * 2 * n / (4 * GRAVITY))
            record = run(team, [[0.2] * n, [0.0] * n], 3, props=[box])
            most = max(most, float(np.abs(record.prop_pose[:, 0]).max()))
    yield Prediction("1 to 8 robots push a box 5 % too heavy: its path", 0.0, most, 1e-3, "m")


def friction_threshold() -> Iterator[Prediction]:
    """Find the largest coefficient of friction at which a robot still moves a box."""
    force, mass = 5.0, 1.5
    low, high = 0.2, 0.6
    while high - low > 1e-3:
        mu = (low + high) / 2
        box = Box(pose=(0.36, 0, 0), mass=mass, ground_friction=mu)
        x = run([Robot()], [[0.2], [0]], 20, props=[box]).prop_pose[:, 0, 0]
        low, high = (mu, high) if x[-1] - x[-11] > 0.01 else (low, mu)
    predicted = force / (mass * GRAVITY)
    yield Prediction("box that just moves: mu = F / (m g)", predicted, low, 0.02 * predicted)


def wall_slide() -> Iterator[Prediction]:
    """Slide along a frictionless wall, at an angle."""
    for degrees in (20, 45, 70):
        a, v = degrees * pi / 180, 0.2
        robot = Robot(pose=(0, 0.1501, -a), drive=Holonomic(), friction=0.0)
        command = [[v * cos(a)], [-v * sin(a)]]
        x = run([robot], command, 10, walls=[[(-5, 0), (9, 0)]]).pose[:, 0, 0]
        measured = (x[-1] - x[-51]) / 5.0
        predicted = v * cos(a)
        yield Prediction(
            f"frictionless wall at {degrees} degrees: v cos a", predicted, measured,
            0.001 * predicted, "m/s",
        )  # fmt: skip


def wall_seams() -> Iterator[Prediction]:
    """Throw boxes along a wall of forty pieces, and discs up a bend."""
    still, command = Robot(pose=(0, 40, 0)), [[0], [0]]
    pieces = [(-9 + 0.45 * k, 0.0) for k in range(41)]
    walls = list(pairwise(pieces))
    lost = 0.0
    for k in range(60):
        fast, down = 0.5 + 3 * (k * 0.618 % 1), -0.1 - 0.4 * (k * 0.414 % 1)
        box = Box(
            pose=(-3, 0.2, 0), length=0.3, width=0.3, velocity=(fast, down, 0), friction=0.0,
            ground_friction=0.0,
        )  # fmt: skip
        v = velocity(run([still], command, 3, props=[box], walls=walls, sampling_time=0.03))
        lost = max(lost, 1 - float(v[-1, 0, 0]) / fast)
    yield Prediction("frictionless wall of 40 pieces: speed lost, relative", 0.0, lost, 1e-6)
    for degrees in (1, 10):
        a = degrees * pi / 180
        puck = Puck(
            pose=(-1, 0.0751, 0), diameter=0.15, velocity=(1, -1e-3, 0), friction=0.0,
            ground_friction=0.0, restitution=0.0,
        )  # fmt: skip
        bent = [[(-9, 0), (0, 0)], [(0, 0), (9 * cos(a), 9 * sin(a))]]
        v = velocity(run([still], command, 2, props=[puck], walls=bent))
        speed = float(np.hypot(*v[-1, :2, 0]))
        yield Prediction(
            f"frictionless bend of {degrees} degrees: v cos a", cos(a), speed, 1e-4, "m/s"
        )


def billiard_table(seed: int, restitution: float, friction: float) -> Record:
    """Let balls and boxes that the floor does not hold meet each other at random."""
    rng = np.random.default_rng(seed)
    props: list[Prop] = []
    for k in range(12):
        place = (0.6 * (k % 4) + 1, 0.6 * (k // 4), float(rng.uniform(-pi, pi)))
        v = (*rng.uniform(-1, 1, 2).tolist(), float(rng.uniform(-2, 2)))
        kind = Ball if k % 2 else Box
        size = {"diameter": 0.2} if k % 2 else {"length": 0.25, "width": 0.15}
        props.append(kind(
            pose=place, velocity=v, mass=float(rng.uniform(1, 3)), friction=sqrt(friction),
            restitution=sqrt(restitution), ground_friction=0.0, **size,
        ))  # fmt: skip
    return run([Robot(pose=(-50, 0, 0))], [[0], [0]], 4, props=props, sampling_time=0.05)


def momentum_and_energy() -> Iterator[Prediction]:
    """Add up the momentum and the energy of what collides with motors off."""
    most_momentum = most_energy = 0.0
    for restitution, friction in ((0.0, 0.3), (0.5, 0.3), (0.8, 0.3), (1.0, 0.0), (1.0, 1.0)):
        for seed in range(3):
            record = billiard_table(seed, restitution, friction)
            inertia = [prop.inertia for prop in record.scenario.props]
            mass, moment = (np.array(column) for column in zip(*inertia, strict=True))
            still = touching_rows(record)
            v = velocity(record)[~still]
            momentum = (v[:, :2] * mass).sum(axis=2)
            drift = np.abs(momentum - momentum[0]).max() / np.abs(v[:, :2] * mass).sum()
            energy = (mass * (v[:, :2] ** 2).sum(axis=1) + moment * v[:, 2] ** 2).sum(axis=1) / 2
            most_momentum = max(most_momentum, float(drift))
            most_energy = max(most_energy, float((energy / energy[0] - 1).max()))
    yield Prediction("motors off: change of momentum, relative", 0.0, most_momentum, 1e-9)
    yield Prediction("motors off: growth of energy, relative", 0.0, max(most_energy, 0.0), 1e-9)


def touching_rows(record: Record) -> NDArray[np.bool_]:
    """Return in which control steps something touched, (T - 1,)."""
    rows = np.floor(record.contacts["time"] / record.scenario.sampling_time - 1e-9).astype(int)
    return np.isin(np.arange(len(record) - 1), rows)


def restitution() -> Iterator[Prediction]:
    """Let pucks hit a wall."""
    for e in (0.0, 0.5, 1.0):
        puck = Puck(velocity=(1, 0, 0), ground_friction=0.0, restitution=e)
        walls = [[(0.5, -1), (0.5, 1)]]
        v = velocity(run([Robot(pose=(-50, 0, 0))], [[0], [0]], 2, props=[puck], walls=walls))
        yield Prediction(f"restitution {e:g}: speed after / before", e, -v[-1, 0, 0], 0.02)


def sliding() -> Iterator[Prediction]:
    """Let a puck slide to rest, and spin to rest."""
    mu, v, omega = 0.1, 1.0, 3.0
    pucks = [
        Puck(velocity=(v, 0, 0), ground_friction=mu),
        Puck(pose=(0, 5, 0), velocity=(0, 0, omega), ground_friction=mu),
    ]
    pose = run([Robot(pose=(-50, 0, 0))], [[0], [0]], 10, props=pucks).prop_pose[-1]
    way = v**2 / (2 * mu * GRAVITY)
    yield Prediction("sliding puck: v^2 / (2 mu g)", way, pose[0, 0], 1e-9, "m")
    (mass, moment), lever = pucks[1].inertia, pucks[1].shape.plate.lever
    turned = omega**2 * moment / (2 * mu * mass * GRAVITY * lever)
    yield Prediction("spinning puck: angle until it rests", turned, pose[2, 1], 1e-9, "rad")


def joints() -> Iterator[Prediction]:
    """Tow by a rope; let a spring swing."""
    rope = Rope(a="robot0", b="box0", length=1.2)
    box = Box(pose=(-1, 0, 0), ground_friction=0.3)
    record = run([Robot()], [[0.2], [0]], 20, props=[box], joints=[rope])
    apart = record.pose[:, 0, 0] - record.prop_pose[:, 0, 0]
    yield Prediction("rope of 1.2 m: its longest", 1.2, float(apart.max()), 1e-3, "m")
    share = 0.3 * GRAVITY / 5.0
    yield Prediction("towing: share of the drive's force, mu m g / F", share,
                     float(record.effort[-1, 0]), 0.01 * share)  # fmt: skip
    k, m = 20.0, 1.0
    spring = Spring(a="puck0", anchor_b=(0, 0), rest_length=0.0, stiffness=k)
    puck = Puck(velocity=(1, 0, 0), mass=m, ground_friction=0.0)
    x = run([Robot(pose=(-50, 0, 0))], [[0], [0]], 20, props=[puck], joints=[spring],
            sampling_time=0.01).prop_pose[:, 0, 0]  # fmt: skip
    crossings = np.flatnonzero((x[:-1] < 0) & (x[1:] >= 0))
    times = 0.01 * (crossings - x[crossings] / (x[crossings + 1] - x[crossings]))
    period = 2 * pi * sqrt(m / k)
    measured = float(np.diff(times).mean())
    yield Prediction("spring: period 2 pi sqrt(m / k)", period, measured, 0.01 * period, "s")


def limits() -> Iterator[Prediction]:
    """Let gates swing against their limits."""
    for e in (0.0, 0.5, 1.0):
        gate = Gate(pose=(0.5, 0, 0), velocity=(0, 1, 2), damping=0.0, limit_restitution=e)
        record = run([Robot(pose=(-50, 0, 0))], [[0], [0]], 1.2, props=[gate])
        spin = float(record.prop_pose[-1, 2, 0] - record.prop_pose[-2, 2, 0]) / 0.1
        yield Prediction(f"gate at its limit, {e:g}: spin after / before", e, -spin / 2, 2e-3)


def wedge() -> Iterator[Prediction]:
    """Drive a robot between two walls that meet at two degrees, without friction."""
    tip = 0.15 / sin(pi / 180) + 1
    walls = [[(-4, side * (tip + 4) * tan(pi / 180)), (tip, 0.0)] for side in (1, -1)]
    record = run([Robot(friction=0)], [[0.5], [0]], 6, walls=walls)
    speeds = np.diff(record.pose[:, 0, 0]) / 0.1
    yield Prediction(
        "wedge of 2 degrees: speed back", 0.0, max(float(-speeds.min()), 0), 0.02, "m/s"
    )


def impulse() -> Iterator[Prediction]:
    """Read off the impulse with which a ball bounces off a wall, and a robot's push."""
    ball = Ball(velocity=(2, 0, 0), mass=1.5, restitution=0.5)
    walls = [[(0.5, -1), (0.5, 1)]]
    record = run([Robot(pose=(-50, 0, 0))], [[0], [0]], 1, props=[ball], walls=walls)
    hit = float(episodes(record.contacts)["normal_impulse"][0])
    predicted = 1.5 * 2 * (1 + 0.5)
    yield Prediction("bounce: impulse m v (1 + e)", predicted, hit, 0.005 * predicted, "N s")
    record = run([Robot()], [[0.2], [0]], 5, walls=[[(0.3, -1), (0.3, 1)]])
    force = float(record.contacts["normal_impulse"][-1]) / 0.1
    yield Prediction("robot against a wall: its drive's force", 5.0, force, 0.05, "N")


def surfaces() -> Iterator[Prediction]:
    """Let a wall drag a robot by each rule for two surfaces, and hold one that rests."""
    p, q = 0.4, 0.9
    made = {
        "product": p * q,
        "minimum": p,
        "mean": (p + q) / 2,
        "geometric": sqrt(p * q),
        "maximum": q,
    }
    for rule, mu in made.items():
        slider = Robot(pose=(0, 0.15, -0.7), drive=Unicycle(max_torque=1000), friction=p)
        row = run(
            [slider], [[0.2], [0]], 5, walls=[[(-5, 0), (9, 0)]], friction=q, friction_rule=rule
        ).contacts[-1]
        found = row["tangential_impulse"] / row["normal_impulse"]
        yield Prediction(f"wall, rule {rule}: drag / press", mu, found, 0.001 * mu)
    mu, static, mass = 0.3, 0.5, 1.2
    for share, acceleration in ((0.98, 0.0), (1.02, (1.02 * static - mu) * mass * GRAVITY)):
        force = share * static * mass * GRAVITY
        robot = Robot(mass=0.8, drive=Unicycle(max_force=force, max_linear_speed=50.0))
        box = Box(pose=(0.3499, 0, 0), mass=mass, ground_friction=mu, static_ground_friction=static)
        v = velocity(run([robot], [[50.0], [0]], 2, props=[box]))[:, 0, 0]
        yield Prediction(
            f"box pushed with {share:g} mus m g: acceleration", acceleration / 2, v[-1] - v[-11],
            0.01, "m/s^2",
        )  # fmt: skip


def crowds() -> Iterator[Prediction]:
    """Let ten robots push each other about in a box, and look how deep they overlap."""
    deepest = out = 0.0
    for seed in CROWD_SEEDS:
        rng = np.random.default_rng(seed)
        places = rng.permutation(16)[:10]
        robots = [
            Robot(pose=(0.36 * (k % 4), 0.36 * (k // 4), float(rng.uniform(-pi, pi))))
            for k in places
        ]
        room = [(-0.2, -0.2), (1.3, -0.2), (1.3, 1.3), (-0.2, 1.3)]
        scenario = Scenario(
            robots=robots, workspace=room, on_exit="wall", sampling_time=0.05, stop_time=10
        )
        world = World(scenario)
        while not world.over:
            world.step(np.array([rng.uniform(-0.5, 0.5, 10), rng.uniform(-3, 3, 10)]))
        x, y = world.record.pose[:, 0], world.record.pose[:, 1]
        i, j = np.triu_indices(10, 1)
        gaps = np.hypot(x[:, i] - x[:, j], y[:, i] - y[:, j]) - 0.3
        walls = np.minimum.reduce([x + 0.2, 1.3 - x, y + 0.2, 1.3 - y]) - 0.15
        deepest = max(deepest, float(-gaps.min()), float(-walls.min()))
        out += float((walls < -0.15).sum())
    runs = f"{len(CROWD_SEEDS)} crowds of 10 robots"
    yield Prediction(f"{runs}: deepest overlap", 0.0, deepest, 1e-3, "m")
    yield Prediction(f"{runs}: robots that left the box", 0.0, out, 0.0)


STRAYING = 500
"""How many robots drive straight ahead: of a sample of them a deviation is right to 3 %."""


def straying() -> Iterator[Prediction]:
    """Let noisy robots drive straight ahead for ten seconds, in control steps short and long."""
    v, b, noise, seconds = 0.3, 0.1, 0.0158, 10.0
    deviation = v * noise * sqrt(seconds / 2) / b
    for period in (0.4, 0.025):
        team = [Robot(pose=(0, k, 0), drive=Unicycle(noise=noise)) for k in range(STRAYING)]
        world = World(
            Scenario(
                robots=team, workspace=None, physics="ideal", sampling_time=period,
                stop_time=seconds,
            ), seed=1,
        )  # fmt: skip
        while not world.over:
            world.step([[v] * STRAYING, [0] * STRAYING])
        name = f"noise of wheels: spread of headings after 10 s at T = {period:g} s"
        tolerance = 4 * deviation / sqrt(2 * STRAYING)
        yield Prediction(name, deviation, float(world.pose[2].std()), tolerance, "rad")


FACTS: tuple[Callable[[], Iterator[Prediction]], ...] = (
    free_arcs, stalemate, acceleration, run_up, friction_threshold, wall_slide, wall_seams,
    momentum_and_energy, restitution, limits, wedge, sliding, joints, impulse, surfaces, crowds,
    straying,
)  # fmt: skip


# -- the page -------------------------------------------------------------------------------------


def facts() -> list[Prediction]:
    """Return what is predicted and measured of single facts."""
    return [prediction for fact in FACTS for prediction in fact()]


def of_examples() -> dict[str, list[Prediction]]:
    """Return what the examples predict and measure, by their names."""
    found = {}
    for name, path in examples().items():
        experiment = open_experiment(path)
        if experiment.source.checks is not None:
            found[name] = list(experiment.source.checks(simulate(experiment).record))
    return found


def document() -> str:
    """Return the text of docs/theory.md."""
    page = HEAD + "\n## The physics\n\n" + table([("", p) for p in facts()], "fact")
    found = of_examples()
    rows = [
        (f"`{name}` of {len(checks)}: ", max(checks, key=used)) for name, checks in found.items()
    ]
    return page + EXAMPLES + table(rows, "example")


def used(p: Prediction) -> float:
    """Return the share of a tolerance that a measured number uses, 0 if it is within its bound."""
    beyond = {"at most": p.measured - p.predicted, "at least": p.predicted - p.measured}
    off = max(beyond.get(p.bound, abs(p.measured - p.predicted)), 0.0)
    return off / p.tolerance if p.tolerance else 0.0


def table(rows: Sequence[tuple[str, Prediction]], first: str) -> str:
    """Return predictions as a table of Markdown."""
    lines = [f"| {first} | predicted | measured | tolerance |", "|---|---|---|---|"]
    for name, p in rows:
        unit = f" {p.unit}" if p.unit else ""
        rough = p.bound == "equal" and p.predicted and p.tolerance > 0.1 * abs(p.predicted)
        mark = ", rough" * bool(rough) if p.ok else f", **{p.verdict}**"
        lines.append(
            f"| {name}{p.name} | {SIGNS[p.bound]}{p.predicted:.5g}{unit} | {measured(p)}{unit} "
            f"| {p.tolerance:.2g}{mark} |"
        )
    return "\n".join(lines) + "\n"


def measured(p: Prediction) -> str:
    """Return a measured number; of one that ought to be 0 its size alone is of interest."""
    if p.predicted == 0 and 0 < abs(p.measured) < inf:
        return f"{p.measured:.0e}"
    return f"{p.measured:.5g}"


if __name__ == "__main__":
    (Path(__file__).parents[1] / "theory.md").write_text(document(), encoding="utf-8")
