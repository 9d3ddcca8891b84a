"""The live run: the control step, the views of laws, the operator, the timeline."""

from mars2d.world.world import World

__all__ = ["World"]
