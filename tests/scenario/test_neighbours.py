"""Who is whose neighbour: each rule against its definition, and what is refused."""

import inspect
from itertools import combinations, pairwise
from math import cos, inf, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import mars2d
from mars2d import (
    Delaunay,
    Everyone,
    Graph,
    InputError,
    LawError,
    Nearest,
    Neighbourhood,
    Robot,
    Scenario,
    Within,
)
from mars2d.core.arithmetic import norm, norms
from tests.cases import each_case
from tests.worlds import untimed

SEEDS = range(4)

ROUND = st.integers(-12, 12).map(lambda k: k / 10)  # distances that are equal but for rounding
POINTS = st.lists(st.tuples(ROUND, ROUND), min_size=1, max_size=9)


def scattered(seed, n=25):
    return np.random.default_rng(seed).uniform(-5, 5, (2, n))


def lists(found):
    return [list(row) for row in found]


def edges(found):
    """The pairs of neighbours, both ways, as a set of (i, j)."""
    return {(i, j) for i, row in enumerate(found) for j in row}


def both_ways(pairs):
    return {pair for i, j in pairs for pair in ((i, j), (j, i))}


def row(n):
    """Each robot of a row has the ones before and after it."""
    return both_ways((i, i + 1) for i in range(n - 1))


# -- everyone, in range, nearest --------------------------------------------------------------


def test_everyone_is_all_the_others_in_order():
    assert lists(Everyone().of(np.zeros((2, 4)))) == [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]
    assert lists(Everyone().of(np.zeros((2, 1)))) == [[]]


@each_case("seed", SEEDS)
def test_within_is_whoever_is_no_farther(seed):
    x, y = position = scattered(seed)
    assert lists(Within(2.5).of(position)) == [
        [j for j in range(25) if j != i and norm(x[i] - x[j], y[i] - y[j]) <= 2.5]
        for i in range(25)
    ]


@given(POINTS, st.sampled_from([0.1, 0.3, 0.5, 1.0, 1.3]))
def test_the_bound_of_within_is_included_however_it_is_rounded(points, distance):
    (x, y) = position = np.transpose(points)
    assert edges(Within(distance).of(position)) == {
        (i, j)
        for i in range(len(x))
        for j in range(len(x))
        if i != j and norm(x[i] - x[j], y[i] - y[j]) <= distance + 1e-9
    }


def brute_nearest(position, count):
    """The nearest by sorting all, of those equally far the first."""
    x, y = position
    found = []
    for i in range(len(x)):
        apart = norms(x - x[i], y - y[i])
        apart[i] = inf
        found.append(np.argsort(apart, kind="stable")[: min(count, len(x) - 1)].tolist())
    return found


PLACES = {
    "anywhere": scattered(5, 300),
    "on a grid": np.round(scattered(6, 300)),
    "on a grid of tenths": np.round(scattered(7, 300), 1),
    "in one place": np.ones((2, 200)),
    "nearer than squares can tell": 1e-170 * np.round(scattered(8, 200)),
    "some of them far away": np.append(scattered(9, 150), 1e6 + scattered(10, 60), axis=1),
    "a few": np.round(scattered(11, 20)),
}


@each_case("count", [1, 4, 25, 120, 10_000])
@each_case("where", PLACES)
def test_the_nearest_of_many_are_those_of_sorting_all(where, count):
    assert Nearest(count).of(PLACES[where]) == brute_nearest(PLACES[where], count)


# -- Delaunay ---------------------------------------------------------------------------------


def shared_edges(position, least=1e-9):
    """Which Voronoi cells share an edge, by its definition: no library, no triangle.

    A point of the bisector of i and j is m + t d; that no robot k is nearer to it bounds t.
    """
    points = position.T
    found = set()
    for i, j in combinations(range(len(points)), 2):
        middle, d = (points[i] + points[j]) / 2, (points[j] - points[i])[::-1] * [1, -1]
        low, high = -inf, inf
        for k in set(range(len(points))) - {i, j}:
            to = points[k] - points[i]
            slope = float(to @ d)
            room = float((points[k] @ points[k] - points[i] @ points[i]) / 2 - middle @ to)
            if slope > 0:
                high = min(high, room / slope)
            elif slope < 0:
                low = max(low, room / slope)
            elif room < 0:
                low, high = inf, -inf
        if (high - low) * norm(*d) > least:
            found.add((i, j))
    return found


@each_case("n", [2, 3, 4, 5, 9, 25])
@each_case("seed", SEEDS)
def test_delaunay_neighbours_share_an_edge_of_their_voronoi_cells(seed, n):
    position = scattered(seed, n)
    assert edges(Delaunay().of(position)) == both_ways(shared_edges(position))


@each_case("turn", np.linspace(0, 3, 5))
@each_case("noise", [0, 1e-16, 1e-13])
def test_robots_in_a_row_have_those_before_and_after_them(turn, noise):
    n = 12
    along = 0.5 * np.arange(n) + 3
    across = np.random.default_rng(0).normal(0, noise, n)
    c, s = cos(turn), sin(turn)
    line = np.array([c * along - s * across, s * along + c * across])
    assert edges(Delaunay().of(line)) == row(n)
    order = np.random.default_rng(1).permutation(n)
    mixed = both_ways((order[i], order[i + 1]) for i in range(n - 1))
    back = np.empty_like(line)
    back[:, order] = line
    assert edges(Delaunay().of(back)) == mixed


@each_case("noise", [0, 1e-15])
@each_case("turn", np.linspace(0, 3, 5))
def test_robots_in_ranks_have_no_neighbours_beyond_the_next_in_their_rank(turn, noise):
    """Rounding bends the ranks at the rim: that makes nobody a neighbour of the next but one."""
    x, y = np.meshgrid(np.arange(6.0), [0.0, 1.0, 2.0])
    across = np.random.default_rng(2).normal(0, noise, 18)
    c, s = cos(turn), sin(turn)
    ranks = np.array([c * x.ravel() - s * (y.ravel() + across),
                      s * x.ravel() + c * (y.ravel() + across)])  # fmt: skip
    found = edges(Delaunay().of(ranks))
    apart = {(i, j): norm(*(ranks[:, i] - ranks[:, j])) for i in range(18) for j in range(18)}
    assert {pair for pair, d in apart.items() if 0.9 < d < 1.1} <= found
    assert max(apart[pair] for pair in found) < 1.5  # the diagonals of squares: one of the two


@each_case("seed", range(10))
def test_a_row_and_one_who_watches_it(seed):
    """All flat triangles of the row's far side are taken off, however they lie on each other."""
    rng = np.random.default_rng(seed)
    x, y = np.append(rng.uniform(0, 10, 14), 5.0), np.append(rng.normal(0, 1e-14, 14), 4.0)
    order = np.argsort(x[:14])
    beside = both_ways(pairwise(order))
    assert edges(Delaunay().of(np.array([x, y]))) == beside | both_ways((k, 14) for k in range(14))


def test_a_row_that_is_bent_has_its_ends_as_neighbours():
    """Its outer cells meet far away, but they meet: only rounding is left out."""
    x = np.arange(8.0)
    assert edges(Delaunay().of(np.array([x, 1e-3 * (x - 3.5) ** 2]))) > row(8)


def test_of_robots_in_one_place_one_stands_for_all():
    place = np.array([[0.0, 1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0, 0.0]])
    found = Delaunay().of(place)
    doubles = {0, 3, 4}
    (first,) = (i for i in doubles if len(found[i]) > 1)
    assert set(found[first]) == {1, 2} | doubles - {first}
    assert all(found[i] == [first] for i in doubles - {first})
    assert edges(Delaunay().of(np.zeros((2, 3)))) == row(3)
    assert edges(Delaunay().of(np.array([[0.0, 0, 1, 1], [0, 0, 0, 0]]))) == row(4)


# -- graphs -----------------------------------------------------------------------------------

PATH = [[0, 1, 0], [1, 0, 1], [0, 1, 0]]


@each_case(
    "matrix",
    [
        PATH, tuple(map(tuple, PATH)), np.array(PATH), np.array(PATH, bool),
        np.array(PATH) * 0.5, -np.array(PATH), np.array(PATH, np.uint8),
    ],
)  # fmt: skip
def test_an_adjacency_matrix_of_any_kind_is_a_graph(matrix):
    assert Graph(matrix).of(np.zeros((2, 3))) == [[1], [0, 2], [1]]
    assert Graph(matrix) == Graph(PATH)


def test_a_graph_may_be_given_by_its_edges():
    assert Graph((3, [(0, 1), (1, 0), (1, 2), (2, 1), (0, 1)])) == Graph(PATH)
    assert Graph([3, [[2, 0]]]).of(np.zeros((2, 3))) == [[], [], [0]]
    assert Graph((2, [])).of(np.zeros((2, 2))) == [[], []]


NOT_A_GRAPH = "expected an adjacency matrix (n, n) of numbers, or a pair (n, edges)"


@each_case(
    ("graph", "message"),
    [
        (np.ones((2, 3)), NOT_A_GRAPH),
        ([[0, 1], [1, 1]], "edge = (1, 1): expected two different robots, from 0 to 1"),
        ([[0, np.inf], [1, 0]], NOT_A_GRAPH),
        ([[0, 1], [1]], f"Graph.graph = [[0, 1], [1]]: {NOT_A_GRAPH}"),
        ("ring", f"Graph.graph = 'ring': {NOT_A_GRAPH}"),
        ((0, []), f"Graph.graph = (0, []): {NOT_A_GRAPH}"),
        ((3, 5), f"Graph.graph = (3, 5): {NOT_A_GRAPH}"),
        ((3, [(0, 3)]), "edge = (0, 3): expected two different robots, from 0 to 2"),
        ((3, [(-1, 0)]), "edge = (-1, 0): expected two different robots, from 0 to 2"),
        ((3, [(0, 1.0)]), NOT_A_GRAPH),
    ],
)  # fmt: skip
def test_what_is_no_graph_is_refused_in_words(graph, message):
    with pytest.raises(InputError) as raised:
        Graph(graph)
    assert str(raised.value).startswith("Graph.graph")
    assert message in str(raised.value)


# -- rules in a scenario ----------------------------------------------------------------------


def listed(rule, law=None, n=4, **fields):
    """The indices of each robot's neighbours at the first step of a run."""
    found = {}

    def note(robot):
        found[robot.index] = [neighbour.index for neighbour in robot.neighbours]
        return 0, 0

    robots = [Robot(pose=(k, 0.1 * k * k, 0), controller=law or note) for k in range(n)]
    mars2d.run(Scenario(robots=robots, neighbours=rule, stop_time=0, **fields))
    return [found[i] for i in range(n)]


def test_a_robot_lists_whom_the_scenarios_rule_gives_it():
    assert listed(Everyone()) == [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]
    assert listed(Within(1.1)) == [[1], [0, 2], [1, 3][:1], []]
    assert listed(Nearest(1)) == [[1], [0], [1], [2]]
    assert listed(Graph((4, [(3, 0)]))) == [[], [], [], [0]]


def test_a_rule_is_asked_once_a_control_step_and_a_fixed_one_once():
    asked = []

    class Counting(Neighbourhood):
        def of(self, position):
            asked.append(position[0, 0])
            return [[1], [0]]

    class Fixed(Counting):
        fixed = True

    def law(robot):
        return 0.1 * len(robot.neighbours + robot.neighbours), 0

    robots = [Robot(controller=law).at(0, k) for k in range(2)]
    for rule, times in ((Counting(), 6), (Fixed(), 1)):
        asked.clear()
        mars2d.run(Scenario(robots=robots, neighbours=rule, stop_time=5, sampling_time=1))
        assert len(asked) == times


class Ring(Neighbourhood):
    """The next one, or the one `step` farther on."""

    step: int = 1

    def of(self, position):
        n = position.shape[1]
        return np.array([[(i + self.step) % n] for i in range(n)])


def test_a_rule_of_the_users_own_is_a_class_with_one_method():
    assert listed(Ring()) == [[1], [2], [3], [0]]
    assert listed(Ring(step=2)) == [[2], [3], [0], [1]]


@each_case(
    ("found", "message"),
    [
        (None, "returned None: expected for each robot a list of its neighbours' indices"),
        ([1, 0], "returned [1, 0]: expected for each robot a list of its neighbours' indices"),
        ([[1]], "returned 1 lists: expected 2, one for each robot"),
        ([["robot1"], []], "returned [['robot1'], []]: expected for each robot a list of its"),
        ([[2], []], "for robot 0 lists [2]: expected other robots, each once"),
        ([[], [1]], "for robot 1 lists [1]: expected other robots, each once"),
        ([[1, 1], []], "for robot 0 lists [1, 1]: expected other robots, each once"),
    ],
)
def test_a_rule_that_returns_nonsense_is_an_error_that_points_at_it(found, message):
    class Odd(Neighbourhood):
        def of(self, position):
            return found

    with pytest.raises(LawError) as raised:
        listed(Odd(), n=2)
    line = inspect.unwrap(Odd.of).__code__.co_firstlineno
    said = f"test_neighbours.py, line {line}: Odd.of(position) {message}"
    assert untimed(raised.value).startswith(said)


# -- in a record ------------------------------------------------------------------------------


def test_a_rule_of_the_users_own_is_named_as_missing_and_everyone_stands_for_it(tmp_path):
    mars2d.run(Scenario(robots=3, neighbours=Ring(step=2), stop_time=0)).save(tmp_path / "run.npz")
    record = mars2d.load(tmp_path / "run.npz")
    assert record.scenario.neighbours == Everyone()
    assert record.missing == ("neighbourhood Ring",)
