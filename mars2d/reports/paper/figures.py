"""Figures 2 to 9 of the paper: the statements of paper and theory, the runs and the studies."""

from __future__ import annotations

from mars2d.reports.paper.figure import Figure, Run
from mars2d.reports.paper.studies.circling import radius_and_gaps
from mars2d.reports.paper.studies.coverage import coverage_cost, two_ends
from mars2d.reports.paper.studies.cycle import cyclic_growth, cyclic_radius
from mars2d.reports.paper.studies.pursuit import cell_area, speed_ratio

CORTES = (
    "Cortes, Martinez, Karatas and Bullo, IEEE Transactions on Robotics and Automation 20(2), 2004"
)
COVER = (
    "v = -k (cos theta, sin theta) . (p - C)",
    "omega = 2 k arctan( (-sin theta, cos theta) . (p - C) / (cos theta, sin theta) . (p - C) )",
    "C: the centroid of the robot's Voronoi cell",
)

FIGURES = (
    Figure(
        number=2,
        title="Random movements",
        section="4",
        paper="Two robots wander for 1000 s among obstacles in a room of 10 m by 10 m. When one "
        "senses something nearer than 0.3 m, it backs off, turns at random, and goes on. This is "
        "the paper's Algorithm 2, of which it gives every number.",
        theory="A turn is even between 90 and 270 degrees, so in the mean it is half a turn. Where "
        "a robot goes is chance; how far is not: 0.2 m in each step, but for those with a turn.",
        law=(
            "something within 0.3 m: v = -0.2, omega = 0",
            "else, after going back: v = 0, omega = pi/2 + pi U(0, 1)",
            "else: v = 0.2, omega = 0",
        ),
        source="Casini and Garulli (2016), Algorithm 2",
        runs=(
            Run(
                "random_walk",
                "Two robots for 1000 s",
                "They wander through the whole room, and back off 0.3 m from what is in the way.",
            ),
        ),
        work=3,
    ),
    Figure(
        number=3,
        title="Pursuit round four corners",
        section="5.1",
        paper="A pursuer heads straight for an evader, which runs between four points near the "
        "corners of a rectangle, away from the pursuer. The evader escapes for 500 s when the "
        "pursuer goes at 0.9 of its speed, and up to that ratio.",
        theory="Who heads straight for somebody on a straight way follows Bouguer's curve of "
        "pursuit. Round after round the two repeat a cycle, in which their least distance is "
        "d (1 - mu^2)^{1/2} ((1 - mu) / (1 + mu))^{mu/2}, with mu the ratio of the speeds and d "
        "the way between two points. It is a capture when that is no more than the robots' size.",
        law=(
            "pursuer: to the evader, at mu times its speed",
            "evader: to the neighbouring point that is farther from the pursuer",
        ),
        source="Casini and Garulli (2016), section 5.1; the curve: Bouguer, 1732",
        choices="The paper gives the ratio and the 500 s; points, speed and size are ours",
        runs=(
            Run(
                "pursuit_corners",
                "At 0.9 of the evader's speed",
                "After 500 s the evader, blue, is still free; the pursuer, red, is in a cycle.",
            ),
        ),
        studies={"speed_ratio": speed_ratio},
        work=25,
    ),
    Figure(
        number=4,
        title="Coverage of a square",
        section="6.1",
        paper="20 robots spread over a square, at 1, 30, 60 and 200 s. At 60 s they are almost at "
        "rest.",
        theory="The cost H = sum int |q - p|^2 dq over the cells has the gradient 2 A (p - C), "
        "with A a cell's area: so H never rises, and robots end where all stand at their "
        "centroids. No arrangement costs less than regular hexagons would: 5 S^2 / (18 n 3^{1/2}), "
        "with S the square's area.",
        law=COVER,
        source=CORTES,
        choices="The paper gives neither gain nor size nor starts: these are ours",
        runs=(
            Run(
                "coverage_square",
                "Twenty robots at 1, 30, 60 and 200 s",
                "From one corner they spread until all cells are about alike.",
                times=(1, 30, 60, 200),
            ),
        ),
        studies={"cost": coverage_cost},
        work=6,
    ),
    Figure(
        number=5,
        title="Coverage of a circle, from two starts",
        section="6.1",
        paper="Eight robots spread over a circle, at 1 and 50 s, twice: A and B differ in one "
        "start, moved by 0.1 m, and end in different arrangements.",
        theory="H never rises, but has several minima: which one is found depends on the starts. "
        "Where one robot ends in the middle of a ring of seven, the ring's radius and H follow "
        "from the centroids of the sectors.",
        law=COVER,
        source=CORTES,
        choices="The paper gives neither gain nor size nor starts: these are ours",
        runs=(
            Run(
                "coverage_circle",
                "A, at 1 and 50 s",
                "Eight robots; violet is the ring of seven, with one in the middle.",
                times=(1, 50),
                name="a",
            ),
            Run(
                "coverage_circle",
                "B, at 1 and 50 s",
                "The same, with one start moved by 0.1 m.",
                times=(1, 50),
                options={"moved": 0.1},
                name="b",
            ),
        ),
        studies={"two_ends": two_ends},
        work=5,
    ),
    Figure(
        number=6,
        title="Pursuit by Voronoi cells",
        section="6.2",
        paper="The pursuer of Figure 3 with another law: at 0.8 of the evader's speed it catches "
        "it. Shown at 0, 50, 70 and 98 s, which is the capture.",
        theory="The pursuer heads for the middle of the edge that its cell shares with the "
        "evader's. At equal speeds the evader's cell then never grows; a slower pursuer can hold "
        "it only as far as the difference of the speeds allows.",
        law=(
            "pursuer: to the middle of the edge shared with the evader, at full speed",
            "without such an edge: to the evader",
            "evader: as in Figure 3",
        ),
        source="Huang, Zhang, Ding, Stipanovic and Tomlin, CDC 2011",
        choices="The paper gives the ratio and the times; points, speed and size are ours",
        runs=(
            Run(
                "pursuit_voronoi",
                "At 0.8 of the evader's speed: 0, 50, 70 s and the capture",
                "The violet outline is the evader's cell; its thick side is the edge shared.",
                times=(0, 50, 70, 98),
            ),
        ),
        studies={"cell_area": cell_area},
        work=4,
    ),
    Figure(
        number=7,
        title="Cyclic pursuit",
        section="6.3",
        paper="Six robots, each of which pursues the next, at 0, 50, 150 and 500 s: they end up "
        "on a circle.",
        theory="k_a / k_r decides: at (2 n / pi) sin(pi / n) the robots circle at the radius that "
        "they happen to have; above it they shrink to a point, below it they grow. With a bound v "
        "on their speed they stop growing at the radius n v / (pi k_a), evenly spread.",
        law=(
            "v = min(v_{max}, k_r r)",
            "omega = k_a alpha",
            "r, alpha: distance and bearing of the next",
        ),
        source="Marshall, Broucke and Francis, IEEE Transactions on Automatic Control 49(11), 2004",
        choices="The paper gives no gains, nor whether the speed is bounded: these are ours",
        runs=(
            Run(
                "cyclic_pursuit",
                "Six robots at 0, 50, 150 and 500 s",
                "The violet circle is the one predicted.",
                times=(0, 50, 150, 500),
            ),
        ),
        studies={"radius": cyclic_radius, "growth": cyclic_growth},
        work=18,
    ),
    Figure(
        number=8,
        title="Collective circular motion",
        section="6.4",
        paper="Robots circle a beacon that moves straight from (3.6, 2.5) to (1.3, 1.3) m and "
        "stays there, at 0, 30, 60 and 200 s, each drawn with its field of view.",
        theory="Once the beacon stands they go round it to the left, at the radius rho_e where "
        "v / rho_e = k_b g(rho_e, rho_0) pi / 2, evenly spread where each just loses the next one "
        "from sight.",
        law=(
            "omega = k_b g(rho, rho_0) alpha_d(gamma) + sum_j k_v g(rho_j, d_0) beta_d(gamma_j)",
            "g(rho, r) = ln( ((c - 1) rho + r) / (c r) )",
            "rho, gamma: range and bearing of the beacon; with j: of a robot in view",
        ),
        source="Ceccarelli, Di Marco, Garulli and Giannitrapani, Automatica 44(12), 2008",
        choices="The paper gives the beacon's way and the times; gains and lengths are ours",
        runs=(
            Run(
                "circular_motion",
                "Four robots at 0, 30, 60 and 200 s",
                "The violet circle about the beacon is the one predicted.",
                times=(0, 30, 60, 200),
            ),
        ),
        studies={"radius_and_gaps": radius_and_gaps},
        work=5,
    ),
    Figure(
        number=9,
        title="Path planning by a potential field",
        section="6.5",
        paper="Three robots on one floor of a department, read from a drawing, each with a list "
        "of waypoints. Two arrive, one is stuck in a room: the known local minimum of potential "
        "fields.",
        theory="The force is -nabla U, so U falls until the force is 0: at a waypoint, or before "
        "it, in a local minimum. Newton's method on F = 0 finds where, without a run.",
        law=(
            "F_{att} = -k_p (q - q_g), no stronger than k_p d*",
            "F_{rep} = eta (1/rho - 1/rho_0) rho^{-2} nabla rho, for rho le rho_0",
            "v = min(v_{max}, |F|) max(0, cos a), omega = k_w a, a = angle(F) - theta",
        ),
        source="Khatib, International Journal of Robotics Research 5(1), 1986",
        choices="The drawing is ours, since that of the paper is not public, and so are the gains",
        runs=(
            Run(
                "path_planning",
                "Two arrive, one is stuck",
                "Solid: the paths; dotted: the waypoints, joined in order.",
            ),
            Run(
                "path_planning",
                "With one more waypoint all arrive",
                "The same, with one waypoint more, in the doorway: it frees the third robot.",
                options={"detour": (22, 9.8)},
                name="freed",
            ),
        ),
        work=4,
    ),
)
"""Figures 2 to 9."""
