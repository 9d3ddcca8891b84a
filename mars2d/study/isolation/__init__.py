"""Isolated laws: each runs in a process of its own, so that a broken law can't spoil a match.

In the match's process, `guard` puts the laws on their robots, `process` talks to one of them,
`fork_server` starts and ends the processes, `scale` weighs their memory, and `observation` decides
what a law may see. In the law's process, `host` runs the law, and `mirror_world` stands in for the
world. `protocol` is the format of the messages between them.
"""

from mars2d.study.isolation.guard import Guard
from mars2d.study.isolation.limits import Limits, Verdict

__all__ = ["Guard", "Limits", "Verdict"]
