"""Rendezvous: robots meet although they lose half of their messages.

Setting: distributed, sensors only: each knows its own position, and what its two neighbours say.
Question: how do robots meet that nobody leads? And what if many messages are lost?
Law: each walks towards those whom it hears, x_i' = gain sum_j (x_j - x_i), with what it heard of
them last (consensus). Source: Olfati-Saber, Fax and Murray, Proceedings of the IEEE 95(1), 2007.
Prediction: they meet, unless all is lost. If nothing is, they do so in the middle of their starts,
and the way left shrinks by one z at each step: z^2 = (1 - 2 h) z + h, h = gain x sampling time.
"""

import numpy as np

from mars2d import Animation, Graph, Holonomic, Prediction, Robot, Scenario
from mars2d.addons import Communication
from mars2d.sensors import Pose

GAIN, APART = 0.2, 0.7  # 1/s; m, of each robot from the meeting point, at a place of its own
STARTS = [(2.6, -1.4), (3.2, 1.8), (0.9, 2.9), (-1.8, 2.1), (-3.3, -0.6), (-1.0, -3.0)]
PLACES = [APART * np.array([np.cos(a), np.sin(a)]) for a in np.arange(6) * np.pi / 3 - 0.5]
RING = np.roll(np.eye(6), 1, axis=0) + np.roll(np.eye(6), -1, axis=0)


def meet(robot):
    mine = robot.sense.pose[:2] - PLACES[robot.index]  # where it would have them meet
    robot.send(mine)
    heard = vars(robot.memory)
    heard |= {message.name: np.array(message.content) for message in robot.inbox}
    return GAIN * sum((other - mine for other in heard.values()), np.zeros(2))


def scenario(loss: float = 0.5):
    fast = Holonomic(max_linear_speed=2)
    walker = Robot(drive=fast, sensors=[Pose()], controller=meet, sees="sensors")
    return Scenario(
        title="Rendezvous",
        robots=[walker.at(x, y) for x, y in STARTS],
        neighbours=Graph(RING),
        workspace=[(-4, -4), (-4, 4), (4, 4), (4, -4)],
        sampling_time=0.5,
        stop_time=90.0,
        addons=[Communication(loss=loss, neighbours_only=True)],
        animation=Animation(playback_speed=3),
    )


def checks(record):
    loss, sent = record.scenario.addons[0].loss, len(record.messages)
    aims = record.pose[:, :2] - np.transpose(PLACES)  # (T, 2, n): where each would meet
    left, lost = np.ptp(aims, axis=2).max(axis=1), np.isnan(record.messages["arrival"]).mean()
    yield Prediction("share that is lost", loss, lost, 4 * np.sqrt(loss * (1 - loss) / sent))
    if (1 - loss) * (record.scenario.stop_time - 30) > 5:  # else some are on their way still
        yield Prediction("way left at the end", 0.0, left[-1], 0.01 * left[0], "m")
    if loss == 0 and record.time[-1] >= 30:
        h = GAIN * record.scenario.sampling_time
        z = (1 - 2 * h + np.sqrt((1 - 2 * h) ** 2 + 4 * h)) / 2
        a, b = np.searchsorted(record.time, [10, 30])
        yield Prediction("its factor a step", z, (left[b] / left[a]) ** (1 / (b - a)), 1e-3)
        off = np.hypot(*(aims[-1] - aims[0].mean(axis=1, keepdims=True))).max()
        yield Prediction("off the middle of the starts", 0.0, off, 1e-3, "m")
