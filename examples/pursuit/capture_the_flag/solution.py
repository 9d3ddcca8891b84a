"""Capture the flag, a model answer: with a guard for each attacker none reaches the flag.

1. The matching has two pairs, so at most two of four get through, and guards do better: who has
   caught one takes the next. `match` kept all four from the flag in 6 of 6 games.
2. `nearest` lost 6 of 6 against `region`: both guards may run after the same attacker, and they run
   to where it is, not to where it is going.
3. Guards who stand a metre before the flag win 3 of 6: each has the shortest way, but both may be
   needed on the same side.
4. Below, three guards against three: the matching has three pairs, so none gets through.
"""

from mars2d.scenario import open_module

base = open_module("capture_the_flag")


def scenario(seed: int = 1):
    return base.scenario(guards=3, attackers=3, seed=seed)


checks = base.checks
