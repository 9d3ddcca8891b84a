"""What the numbers of a run depend on beside its scenario: settings of the solver.

Changing one changes every digest.
"""

from __future__ import annotations

# -- the engine's solver ------------------------------------------------------------------------

SLOP = 1e-4
"""The overlap that the solver leaves in steady contact, metres."""

ITERATIONS = 15
ITERATIONS_UNEQUAL = 21  # with masses more than three times apart
ITERATIONS_JOINTS = 31  # with joints: several may hold the same bodies
"""Odd numbers: where friction is large, the solver may swing between a push and none.

With an even number it can end with none each time, and bodies go through each other.
"""

ITERATION_FACTOR = 5
"""How many times as many iterations an island has while bodies are too deep in each other. Odd."""

BIAS_RATE = 6.32163094
"""The rate at which overlap beyond the slop decays, 1/s: to 0.9 in a sixtieth of a second."""

JOINT_BIAS_RATE = 356.674944
"""That of a joint's error, 1/s: 30 % of it go in 1 ms."""

ROPE_TOLERANCE = 1e-6
"""By how much the solver's rope is shorter than said, metres: so it pulls once it is straight."""

# -- substeps -----------------------------------------------------------------------------------

SLACK = 1.25
"""How much further than at its present speed a body may be thrown before gaps are asked again."""

GROWTH = 2.0
"""How much longer or shorter a substep may be than the one before, with the same joints.

The solver begins with what they did in the substep before. Where the next one has to be shorter
than that, they start again.
"""

PRELOAD = 0.25
"""How deep bodies that press against each other overlap at least, in parts of the slop."""

PUSH_DEPTH = 0.15
"""How deep one robot's push may drive bodies into each other, in parts of the overlap allowed."""

PUSH_ROOM = 0.85
"""How deep the pushes of many may, together with the overlap that there is, in the same parts."""

CLOSED = 1e-9
"""A gap that counts as touching, metres: bodies that are put side by side have one by rounding."""

MEETING = 1.0 / 256.0
"""How deep an accelerating body may be in another when they meet, in parts of the slop.

It has gathered speed over this way too: as small a part of it as substeps allow.
"""

IMPACT_DEPTH = 1.0 / 16.0
"""How deep bodies may be in each other when they hit and no drive pushes, in parts of the slop.

What has turned about the other since they touched is hit along another normal than at the touch:
the blow changes the angular momentum of both by as much.
"""

OVERLOAD = 0.9
"""How deep it is, in parts of how deep bodies may enter, where more pushes add up than thought."""

LOAD_GROWTH = 2.0
LOAD_DECAY = 0.98
"""The factors by which that number changes in a substep that finds them so deep, and in another."""

CONTACT_TURN = 0.005
"""How far the normal of a contact may turn in one substep, rad."""

STRETCH = 1.0 / 15.0
"""How much longer a rope may be when it jerks, in parts of how deep bodies may enter.

The solver draws it in again, and what it pulls at bounces by that much more than nothing.
"""

JOINT_TOLERANCE = 0.75
"""How far a joint may be pulled apart in one substep, in parts of the stretch allowed."""

SWING = 0.05
"""The longest substep, in periods of a spring over 2 pi."""

SEAM_DEPTH = 2.0
"""How deep in a wall, in parts of the overlap allowed, a corner may be that a seam lets in.

At the seam of two walls the engine's contact may point along one of them. It is then that of the
wall's face and the body's corners in it, up to this depth.
"""

# -- surfaces -----------------------------------------------------------------------------------

STICK_SPEED = 1e-3
"""The speed along each other below which two surfaces stick rather than slide, m/s.

Static friction holds up to there. Models of friction use a like speed to tell both apart, as D.
Karnopp, J. Dyn. Syst. Meas. Control 107, 100 (1985).
"""

# -- drives -------------------------------------------------------------------------------------

OFFSET_STEP = 1e-3
"""The longest substep of a robot with `force_limited` and `mass_offset` in the open, seconds."""

LINGER = 3
"""For how many substeps a drive stays engaged after its robot has followed its command again."""

BRAKING_TURN = 0.01
"""How far a rim may turn on while its drive stops it, in parts of the overlap allowed.

It keeps slides along walls with friction within half a percent of the formula. Where more overlap
is allowed than by default, a larger part of it is: speed is wanted then.
"""

DEFAULT_OVERLAP = 1e-3
"""The overlap that is allowed by default, metres."""
