"""The islands in Python, where there is no compiler."""

# ruff: noqa: F401, what the islands offer, as the compiled module does
from mars2d.physics.islands.body import Body
from mars2d.physics.islands.floor import Glide
from mars2d.physics.islands.island import Accuracy
from mars2d.physics.islands.mover import Mover
from mars2d.physics.islands.pair import Wall
from mars2d.physics.islands.piece import Piece
from mars2d.physics.islands.rays import Caster, Things
from mars2d.physics.islands.seams import Seams
from mars2d.physics.islands.surfaces import Surfaces
from mars2d.physics.islands.tie import Tie
