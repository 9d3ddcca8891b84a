"""The doorway, a model answer: a third one that pushes is worth as much as each of the others.

1. The guard pushes with 4 N times `strength`, the row with 8 N: equal at 2.
2. `alone` pushes with 4 N, so that it needs a guard weaker than 1.
3. Before the door there is room: `meet` is pushed aside, not back, and the prey is past it.
4. Below, a third one pushes at the end of the row, against a guard of 2.8.
"""

from mars2d.scenario import open_module

base = open_module("doorway")


def push(robot):
    return 100, -1000 * robot.position[1]


def scenario(strength: float = 2.8):
    plain = base.scenario(strength)
    guard, escort, prey = plain.robots
    other = prey.replace(name="other", controller=push).at(-2, 0)
    roles = {"guard": ["guard"], "escort": ["escort", "prey", "other"]}
    game = plain.addons[1].replace(roles=roles)
    addons = [plain.addons[0], game, plain.addons[2]]
    return plain.replace(robots=[guard, escort, prey, other], addons=addons)


checks = base.checks
