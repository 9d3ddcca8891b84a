"""What the numbers of a run depend on beside its scenario: settings of the solver, versions.

Changing a setting changes every digest.
"""

from __future__ import annotations

import platform

import numpy as np

from mars2d.physics.kernel import reason_without

# -- the engine's solver ------------------------------------------------------------------------

SLOP = 1e-4
"""The overlap that the solver leaves in steady contact, metres."""

ITERATIONS = 15
ITERATIONS_UNEQUAL = 20  # with masses more than three times apart
ITERATIONS_JOINTS = 60  # with joints: several may hold the same bodies

JOINT_BIAS = 0.7**1000
"""What is left of a joint's error after a second: 30 % of it go in 1 ms."""

TAUT = 1e-6
"""By how much the solver's rope is shorter than said, metres: so it pulls once it is straight."""

# -- substeps -----------------------------------------------------------------------------------

SLACK = 1.25
"""How much further than at its present speed a body may be thrown before gaps are asked anew."""

GROWTH = 2.0
"""How much longer or shorter a substep may be than the one before, with the same joints.

The solver begins with what they did in the substep before. Where the next one has to be shorter
than that, they begin anew.
"""

PRESSED = 0.25
"""How deep bodies that press against each other overlap at least, in parts of the slop."""

STRETCH = 1 / 15
"""How much longer a rope may be when it jerks, in parts of how deep bodies may enter.

The solver draws it in again, and what it pulls at bounces by that much more than nothing.
"""

BENT = 0.75
"""How far a joint may be pulled apart in one substep, in parts of the stretch allowed."""

SWING = 0.05
"""The longest substep, in periods of a spring over 2 pi."""

# -- drives -------------------------------------------------------------------------------------

LINGER = 3
"""For how many substeps a drive stays engaged after its robot has followed its command again."""

TURNED = 0.01
"""How far a rim may turn on while its drive stops it, in parts of the overlap allowed.

It keeps slides along walls with friction within half a percent of the formula. Where more overlap
is allowed than by default, a larger part of it is: speed is wanted then.
"""

DEFAULT_OVERLAP = 1e-3
"""The overlap that is allowed by default, metres."""

# -- the kernel's groups ------------------------------------------------------------------------

GROUP = 64
"""About how many robots of a large team are stepped together: each group as finely as it needs."""

MAX_GROUP_RATIO = 2.0
"""The largest ratio of masses in a team that is stepped in groups.

Groups can't wait for one of which a robot is thrown further than was thought possible.
"""

GROUP_SLACK = 1.5
"""`SLACK` in groups, with equal masses: two robots that squeeze a third give it no more."""


def versions() -> dict[str, str]:
    """Return the versions of the software that a run's numbers depend on."""
    from importlib.metadata import version

    from mars2d import __version__

    return {
        "mars2d": __version__,
        "kernel": "no" if reason_without() else "yes",
        "pymunk": version("pymunk"),
        "numpy": np.__version__,
        "python": platform.python_version(),
        "platform": f"{platform.system()} {platform.machine()}",
    }
