"""Scripts for the Robotarium's Python simulator run unchanged; its utilities keep their laws."""

import signal
import sys

import numpy as np
import pytest
import scipy.optimize

import mars2d
from mars2d import InputError
from mars2d.cli import command_line as cli
from mars2d.world.robotarium import barriers, controllers, graphs, mappings, placement
from mars2d.world.robotarium.arena import Robotarium
from mars2d.world.robotarium.script import run_script

SWAP = """
import rps.robotarium as robotarium
from rps.utilities.transformations import *
from rps.utilities.barrier_certificates import *
from rps.utilities.misc import *
from rps.utilities.controllers import *
import numpy as np

N = 4
angle = 2 * np.pi * np.arange(N) / N
initial_conditions = np.array([0.8 * np.cos(angle), 0.6 * np.sin(angle), np.zeros(N)])
r = robotarium.Robotarium(
    number_of_robots=N, show_figure=True, initial_conditions=initial_conditions,
    sim_in_real_time=True,
)
goals = np.roll(initial_conditions, 1, axis=1)
go = create_clf_unicycle_position_controller()
safe = create_unicycle_barrier_certificate()
for k in range(900):
    x = r.get_poses()
    if np.size(at_position(x[:2], goals[:2], 0.05)) == N:
        break
    r.set_velocities(np.arange(N), safe(go(x, goals[:2]), x))
    r.step()
r.call_at_scripts_end()
"""


@pytest.fixture
def script(tmp_path):
    path = tmp_path / "swap.py"
    path.write_text(SWAP)
    return path


def test_a_script_runs_unchanged_and_its_run_is_a_record(script, tmp_path, capsys):
    kept = tmp_path / "kept.npz"
    assert cli.main(["robotarium", str(script), "--headless", "--record", str(kept)]) == 0
    assert "no collision, and nobody left the arena" in capsys.readouterr().out
    record = mars2d.load(kept)
    assert record.scenario.sampling_time == 0.033
    goals = np.roll(record.pose[0, :2], 1, axis=1)
    assert np.hypot(*(record.pose[-1, :2] - goals)).max() < 0.06
    assert np.abs(np.diff(record.pose[:, :2], axis=0)).max() <= 0.2 * 0.033 + 1e-12
    assert cli.main(["check", str(kept)]) == 0
    assert "rps" not in sys.modules


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("    r.step()\n", "    r.step(); r.step()\n", "step() was called without get_poses()"),
        ("x = r.get_poses()", "x = r.get_poses(); r.get_poses()", "get_poses() was called twice"),
        ("number_of_robots=N", "number_of_robots=70", "expected 1 to 50"),
        ("number_of_robots=N", "number_of_robots=3", "expected (3, 3), x, y and theta"),
        ("np.arange(N), safe(", "np.arange(2), 0 * safe(", ""),
        ("safe(go(x, goals[:2]), x)", "np.ones((3, N))", "expected (2, 4)"),
        ("safe(go(x, goals[:2]), x)", "np.full((2, N), np.nan)", "not finite"),
        ("import rps.robotarium as robotarium", "import rps.robotariums", "rps.robotariums"),
        (SWAP, "x = 1", "makes no Robotarium"),
    ],
)
def test_a_mistake_is_one_line(script, capsys, old, new, said):
    assert old in SWAP
    script.write_text(SWAP.replace(old, new))
    code = cli.main(["robotarium", str(script), "--headless"])
    errors = capsys.readouterr().err
    assert code == (cli.BAD_INPUT if said else 0), errors
    assert said in errors
    assert "Traceback" not in errors


def test_a_fault_keeps_what_was_recorded(script, tmp_path, capsys):
    script.write_text(SWAP.replace("    r.step()\n", "    r.step()\n    1 / (k - 20)\n"))
    kept = tmp_path / "kept.npz"
    assert cli.main(["robotarium", str(script), "--headless", "--record", str(kept)]) == 2
    assert "ZeroDivisionError" in capsys.readouterr().err
    assert len(mars2d.load(kept)) > 20


def test_mappings_are_inverse_and_points_ahead_move_so():
    rng = np.random.default_rng(0)
    poses, dxi = rng.normal(size=(3, 5)), 0.01 * rng.normal(size=(2, 5))
    commands, points = mappings.create_si_to_uni_mapping(0.05, 1e9)
    back = mappings.create_uni_to_si_dynamics(0.05)
    assert back(commands(dxi, poses), poses) == pytest.approx(dxi)
    v, omega = commands(dxi, poses)
    dt = 1e-7
    moved = poses + dt * np.array([v * np.cos(poses[2]), v * np.sin(poses[2]), omega])
    assert (points(moved) - points(poses)) / dt == pytest.approx(dxi, abs=1e-6)


def test_certified_velocities_are_the_nearest_safe_ones():
    """Held against another solver of the same quadratic programme."""
    rng = np.random.default_rng(1)
    for _ in range(20):
        rows, limits = rng.normal(size=(7, 4)), rng.uniform(0.05, 1, 7)
        wanted = 2 * rng.normal(size=4)
        found = barriers.nearest_within(wanted, rows, limits)
        other = scipy.optimize.minimize(
            lambda u, wanted=wanted: ((u - wanted) ** 2).sum(), np.zeros(4), method="SLSQP",
            constraints={"type": "ineq", "fun": lambda u, a=rows, b=limits: b - a @ u},
            options={"ftol": 1e-12},
        )  # fmt: skip
        assert (rows @ found <= limits + 1e-9).all()
        assert found == pytest.approx(other.x, abs=1e-4)


def test_robots_that_would_meet_stay_apart_by_barriers():
    safe = barriers.create_single_integrator_barrier_certificate_with_boundary()
    x = np.array([[-0.5, 0.5, 1.5], [0.0, 0.001, 0.0]])
    least, right = np.inf, 0.0
    for _ in range(3000):
        x = x + 0.01 * safe(np.array([[0.2, -0.2, 0.2], [0.0, 0.0, 0.0]]), x)
        least = min(least, float(np.hypot(*(x[:, 0] - x[:, 1]))))
        right = max(right, float(x[0, 2]))
    assert 0.17 < least < 0.3
    assert right < 1.6


def test_where_nothing_is_safe_the_script_is_told_once_who_is_too_near():
    x, there = np.array([[0.3, 0.3, -0.5], [0.2, 0.2, 0.0]]), np.full((2, 3), 0.1)
    safe = barriers.create_single_integrator_barrier_certificate()
    said = r"no velocities are safe.* robots 0 and 1 are 0 m apart, less than 0.17 m"
    with pytest.warns(UserWarning, match=said) as caught:
        found = [safe(there, x) for _ in range(2)]
    assert np.array_equal(found, [there, there])
    assert len(caught) == 1
    assert caught[0].filename == __file__
    poses = np.vstack([x, np.zeros(3)])
    unicycles = barriers.create_unicycle_barrier_certificate()
    with pytest.warns(UserWarning, match="0 and 1 are 0 m apart, less than 0.22 m") as caught:
        unicycles(there, poses)
    assert caught[0].filename == __file__


def test_the_backend_of_pyplot_is_the_same_after_a_script(tmp_path):
    import matplotlib as mpl

    path = tmp_path / "draws.py"
    path.write_text(
        "from rps.robotarium import Robotarium\nfrom rps.utilities.misc import *\n"
        "import matplotlib\nassert matplotlib.get_backend().lower() == 'agg'\nRobotarium(2)\n"
    )
    before = mpl.get_backend()
    mpl.use("svg")
    try:
        run_script(path)
        assert mpl.get_backend() == "svg"
    finally:
        mpl.use(before)


def test_controllers_arrive():
    go = controllers.create_clf_unicycle_pose_controller()
    poses, goals = np.array([[0.0], [0.0], [2.0]]), np.array([[1.0], [0.5], [-1.0]])
    for _ in range(2000):
        if len(placement.at_pose(poses, goals)):
            break
        v, omega = go(poses, goals)
        poses = poses + 0.01 * np.array([v * np.cos(poses[2]), v * np.sin(poses[2]), omega])
    assert list(placement.at_pose(poses, goals)) == [0]
    slow = controllers.create_si_position_controller(velocity_magnitude_limit=0.15)
    assert np.hypot(*slow(np.zeros((2, 1)), np.array([[3.0], [4.0]]))) == pytest.approx(0.15)


@pytest.mark.parametrize("graph", [graphs.cycle_GL, graphs.lineGL, graphs.completeGL])
@pytest.mark.parametrize("count", [1, 2, 3, 6])
def test_laplacians_have_zero_rows_and_are_connected(graph, count):
    laplacian = graph(count)
    assert laplacian.sum(axis=1) == pytest.approx(0)
    assert (laplacian == laplacian.T).all()
    assert np.linalg.matrix_rank(laplacian) == count - 1  # of a connected graph
    for i in range(count):
        neighbours = graphs.topological_neighbors(laplacian, i)
        assert len(neighbours) == laplacian[i, i]


def test_random_graphs_have_so_many_edges():
    for edges in range(12):
        laplacian = graphs.randomGL(5, edges)
        assert np.trace(laplacian) == 2 * min(edges, 10)
        connected = graphs.random_connectedGL(5, edges)
        assert np.trace(connected) == 2 * min(4 + edges, 10)
        assert np.linalg.matrix_rank(connected) == 4
        for each in (laplacian, connected):
            assert (each == each.T).all()
            assert each.sum(axis=1) == pytest.approx(0)


def test_starts_are_apart_and_others_at_each_call():
    poses = placement.generate_initial_conditions(20)
    assert not (poses == placement.generate_initial_conditions(20)).all()
    apart = np.hypot(*(poses[:2, :, None] - poses[:2, None]))
    assert apart[np.triu_indices(20, 1)].min() > 0.299
    assert Robotarium(number_of_robots=20).get_poses().shape == (3, 20)
    with pytest.raises(InputError, match="places"):
        placement.generate_initial_conditions(100)


ALL = """
import rps.robotarium as robotarium
from rps.utilities.transformations import *
from rps.utilities.graph import *
from rps.utilities.barrier_certificates import *
from rps.utilities.misc import *
from rps.utilities.controllers import *
"""
"""How the scripts of the Robotarium begin; numpy and pyplot come with the utilities."""

POSES = """
N = 3
r = robotarium.Robotarium(number_of_robots=N)
goals = generate_initial_conditions(N)
go, safe = create_hybrid_unicycle_pose_controller(), create_unicycle_barrier_certificate2()
x = r.get_poses()
r.step()
assert np.size(at_pose(x, goals, rotation_error=100)) < N, "the goals are the starts"
size, font = determine_marker_size(r, 0.2), determine_font_size(r, 0.1)
assert np.isclose(size, 4 * font**2), "square points, and points"
spots = r.axes.scatter(goals[0], goals[1], s=size)
caption = plt.text(0, 0, "G", fontsize=font)
assert np.isclose(r.max_wheel_velocity * r.wheel_radius, r.max_linear_velocity)
while np.size(at_pose(x, goals)) < N:
    x = r.get_poses()
    r.set_velocities(np.arange(N), safe(go(x, goals), x))
    r.step()
r.call_at_scripts_end()
"""


def test_numpy_drawing_and_random_goals_are_there_as_scripts_expect(tmp_path, capsys):
    path = tmp_path / "poses.py"
    path.write_text(ALL + POSES)
    digests = set()
    for k in range(2):
        np.random.rand(k)  # noqa: NPY002 - a script starts from seed 0 whatever came before
        kept = tmp_path / "kept.npz"
        assert cli.main(["robotarium", str(path), "--headless", "--record", str(kept)]) == 0
        digests.add(mars2d.load(kept).digest)
    assert len(digests) == 1
    assert "no collision" in capsys.readouterr().out


def test_a_marker_is_as_wide_as_it_is_said_to_be():
    arena = Robotarium(number_of_robots=2)
    size = placement.determine_marker_size(arena, 0.2)
    pixels = size**0.5 * arena.figure.dpi / 72
    left, right = arena.axes.transData.inverted().transform([(0, 0), (pixels, 0)])[:, 0]
    assert right - left == pytest.approx(0.2)


def test_gains_are_those_of_the_formulas():
    pose, goal = np.array([[0.0], [0.0], [0.3]]), np.array([[1.0], [0.5], [-0.4]])
    rho, bearing = np.hypot(1.0, 0.5), np.arctan2(0.5, 1.0)
    alpha, theta = bearing - 0.3, bearing + 0.4
    found = controllers.create_clf_unicycle_pose_controller(2, 3, 5)(pose, goal)[:, 0]
    omega = 3 * alpha + 2 * np.cos(alpha) * np.sin(alpha) / alpha * (alpha + 5 * theta)
    assert found == pytest.approx([2 * rho * np.cos(alpha), omega])
    found = controllers.create_clf_unicycle_position_controller(2, 3)(pose, goal[:2])[:, 0]
    assert found == pytest.approx([2 * rho * np.cos(alpha), 3 * rho * np.sin(alpha)])


def test_pairs_that_are_too_near_are_driven_apart_by_the_other_gain():
    x, still = np.array([[-0.07, 0.07], [0.0, 0.0]]), np.zeros((2, 2))
    h = 0.14**2 - 0.17**2
    wanted = 1e6 * -(h**3) / (2 * 0.14)  # h' = 2 (x1 - x2)(v1 - v2) = -gain h^3
    left, right = barriers.create_single_integrator_barrier_certificate2()(still, x)[0]
    assert (left - right, right - left) == pytest.approx((-wanted, wanted))


INTERRUPTED = """
import signal
r = robotarium.Robotarium(number_of_robots=2)
for k in range(200):
    x = r.get_poses()
    r.step()
    if k == 50:
        signal.raise_signal(signal.SIGINT)
"""


def test_ctrl_c_ends_a_script_and_keeps_what_was_recorded(tmp_path):
    path, kept = tmp_path / "long.py", tmp_path / "kept.npz"
    path.write_text(ALL + INTERRUPTED)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        code = cli.main(["robotarium", str(path), "--headless", "--record", str(kept)])
    finally:
        signal.signal(signal.SIGINT, before)
    assert code == cli.INTERRUPTED
    record = mars2d.load(kept)
    assert record.over_message == "Interrupted by Ctrl-C"
    assert len(record) == 51
