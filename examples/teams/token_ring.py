"""Token ring: one robot at a time has its turn, although messages are lost.

Setting: distributed, sensors only: a robot knows what it hears, and nothing else.
Question: how do robots take turns, never two at once, and never none for long?
Law: who has the token spins round once, then sends it to the next one, until that acknowledges it.
Tokens are numbered: who gets one again acknowledges it again, and takes it once. Source: Bartlett,
Scantlebury and Wilkinson, Communications of the ACM 12(5), 1969.
Prediction: never two spin. At a loss p < 1 the token is sent 1 / (1 - p) times, on the average, so
a turn lasts SPIN + FLIGHT + REPEAT p / (1 - p) steps. Not acknowledged, it is soon lost.
"""

from itertools import count

import numpy as np

from mars2d import Prediction, Robot, Scenario
from mars2d.addons import Communication

N, STEP, SPIN, FLIGHT, REPEAT = 6, 0.1, 20, 3, 8  # robots, s; steps: a turn, on the way, a wait


def scenario(loss: float = 0.3, acknowledge: bool = True):
    def take_turns(robot):
        number, since, passed_on = (0, 0, False) if robot.index == 0 else (-1, -SPIN, True)
        for step in count():
            for message in robot.inbox:
                what, given = message.content
                if what == "token":
                    robot.send(["thanks", given], to=message.sender)
                    if given > number:
                        number, since, passed_on = given, step, False
                elif given == number + 1:
                    passed_on = True
            left = since + SPIN - step  # steps of its turn `number`
            if left <= 0 and not passed_on and left % REPEAT == 0:
                robot.send(["token", number + 1], to=(robot.index + 1) % N)
                passed_on = not acknowledge
            yield 0.0, 2 * np.pi / (SPIN * STEP) if left > 0 else 0.0

    robot, angles = Robot(controller=take_turns, sees="sensors"), 2 * np.pi * np.arange(N) / N
    return Scenario(
        title="Token ring",
        robots=[robot.at(1.5 * np.cos(a), 1.5 * np.sin(a), a) for a in angles],
        workspace=[(-2, -2), (-2, 2), (2, 2), (2, -2)],
        sampling_time=STEP,
        stop_time=120.0,
        addons=[Communication(loss=loss, delay=FLIGHT * STEP)],
    )


def checks(record):
    p, steps = min(record.scenario.addons[0].loss, 0.999), len(record) - 1
    spins = record.command[:, 1] > 0  # (T, n)
    _, who = np.nonzero(np.diff(spins, axis=0, prepend=False) & spins)  # begins, in order
    turn = SPIN + FLIGHT + REPEAT * p / (1 - p)
    by_chance = 4 * REPEAT * np.sqrt(p * steps / turn) / (1 - p) / turn
    yield Prediction("robots that spin at once, at most", 1, spins.sum(axis=1).max(), 0)
    if by_chance < steps / turn:  # else so little gets through that nothing can be said
        yield Prediction("turns", 1 + steps / turn, len(who), 1 + by_chance)
    yield Prediction("turns out of order", 0, np.sum(np.diff(who) % N != 1), 0)
