"""Laws in processes of their own, which a broken law can't leave.

On this side `guard` puts the laws on their robots, `nursery` starts and ends the processes,
`process` talks to one, `ears` tells who has answered, `sight` says what a law may see. On the other
side `host` runs the law, and `mirror` is the world to it. `frames` and `briefing` are what passes
between them.
"""

from mars2d.study.isolation.guard import Guard
from mars2d.study.isolation.limits import Limits, Verdict

__all__ = ["Guard", "Limits", "Verdict"]
