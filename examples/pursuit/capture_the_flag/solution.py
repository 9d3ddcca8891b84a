"""Capture the flag, a model answer: with a guard for each attacker none reaches the flag.

1. The matching has two pairs, so at most two of four get through. Against `region` guards do
   better: who has caught one takes the next. Against `decoys`, who prevent that, two do get there.
2. `nearest` loses 12 of 12 against `region`: both guards may run after the same attacker, and they
   run to where it is, not to where it is going.
3. Guards who stand a metre before the flag win 5 of 12 against `region`: each has the shortest way,
   but both may be needed on the same side. `decoys` can't lead them away: they win 12 of 12.
4. Below, three guards against three: the matching has three pairs, so none gets through.
"""

from mars2d.scenario import open_module

base = open_module("capture_the_flag")


def scenario(seed: int = 1):
    return base.scenario(guards=3, attackers=3, seed=seed)


checks = base.checks
