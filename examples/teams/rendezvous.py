"""Rendezvous: robots meet although they lose half of their messages.

Setting: distributed, sensors only: each knows its own position, and what its two neighbours say.
Question: how do robots meet that nobody leads? What if messages are lost, or come late?
Law: each walks towards those whom it hears, x_i' = gain sum_j (x_j - x_i), with what it heard of
them last (consensus). Source: Olfati-Saber, Fax and Murray, Proceedings of the IEEE 95(1), 2007.
Prediction: a pattern along the ring with m = 2 cos(k pi / 3) shrinks by z at each step. With h =
gain x sampling time, messages d steps old and the loss p, z^(d-1) (z - 1 + 2 h) (z - p) =
h m (1 - p), on average; they meet in the middle of their starts if no message is lost. With
``past`` each compares what it hears with where it was itself at that time: z^(d-1) (z - 1) (z - p)
= h (m - 2) (1 - p), and messages that are too late drive them apart.
"""

from functools import partial

import numpy as np

from mars2d import Animation, Graph, Holonomic, Prediction, Robot, Scenario
from mars2d.addons import Communication
from mars2d.sensors import Pose

GAIN, SPEED = 0.2, 2.0  # 1/s, m/s
APART = 0.7  # m, of each robot from the meeting point, at a place of its own
STARTS = [(2.6, -1.4), (3.2, 1.8), (0.9, 2.9), (-1.8, 2.1), (-3.3, -0.6), (-1.0, -3.0)]
PLACES = [APART * np.array([np.cos(a), np.sin(a)]) for a in np.arange(6) * np.pi / 3 - 0.5]
RING = np.roll(np.eye(6), 1, axis=0) + np.roll(np.eye(6), -1, axis=0)


def meet(gain, past, robot):
    mine = robot.sense.pose[:2] - PLACES[robot.index]  # where it would have them meet
    robot.send(mine)
    own, heard = (vars(robot.memory).setdefault(name, {}) for name in ("own", "heard"))
    own[robot.time] = mine
    for message in robot.inbox:
        heard[message.name] = np.array(message.content), own[message.time]
    ways = (other - (then if past else mine) for other, then in heard.values())
    return gain * sum(ways, np.zeros(2))


def scenario(loss: float = 0.5, delay: float = 0.0, past: bool = False, gain: float = GAIN):
    fast = Holonomic(max_linear_speed=SPEED)
    law = partial(meet, gain, past)
    walker = Robot(drive=fast, sensors=[Pose()], controller=law, sees="sensors")
    return Scenario(
        title="Rendezvous",
        robots=[walker.at(x, y) for x, y in STARTS],
        neighbours=Graph(RING),
        workspace=[(-4, -4), (-4, 4), (4, 4), (4, -4)],
        sampling_time=0.5,
        stop_time=90.0,
        addons=[Communication(loss=loss, delay=delay, neighbours_only=True)],
        animation=Animation(playback_speed=3),
    )


def slowest(h, d, p, past):
    """Return the largest |z|, and the number k of the waves round the ring that have it."""
    found = []
    for k in (1, 2, 3):
        factors = np.poly([1 if past else 1 - 2 * h, p] + [0] * (d - 1))
        factors[-1] += h * (1 - p) * (2 * past - 2 * np.cos(k * np.pi / 3))
        found.append((np.abs(np.roots(factors)).max(), k))
    return max(found)


def checks(record):
    talk, step, sent = record.scenario.addons[0], record.scenario.sampling_time, record.messages
    gain, past = record.scenario.robots[0].controller.args
    aims = record.pose[:, :2] - np.transpose(PLACES)  # (T, 2, n): where each would meet
    left, lost = np.ptp(aims, axis=2).max(axis=1), np.isnan(sent["arrival"]).mean()
    by_chance = 4 * np.sqrt(talk.loss * (1 - talk.loss) / len(sent))
    yield Prediction("share that is lost", talk.loss, lost, by_chance)
    age = max(1, round(talk.delay / step + 0.499))
    z, waves = slowest(gain * step, age, talk.loss, past)
    meet = z < 1 and 1.3 * np.log(0.01) / np.log(z) < len(record)
    if meet:
        yield Prediction("way left at the end", 0.0, left[-1], 0.01 * left[0], "m")
    if meet and talk.loss == 0:
        off = np.hypot(*(aims[-1] - aims[0].mean(axis=1, keepdims=True))).max()
        yield Prediction("off the middle of the starts", 0.0, off, 0.01 * left[0], "m")
    fastest = np.hypot(*record.command.swapaxes(0, 1)).max() + 1e-9
    a, b, end = np.searchsorted(record.time, [30, 50, 60])
    if talk.loss == 0 and (end == len(record) or record.collisions or fastest >= SPEED):
        why = "it is over before 60 s, or robots came to their largest speed or touched"
        yield Prediction.silent("its factor a step", why)
    elif talk.loss == 0:
        size = np.hypot(*abs(aims @ np.exp(2j * np.pi / 6 * waves * np.arange(6))).T)
        each = size[a:end] / z ** np.arange(end - a)  # swings, but neither grows nor shrinks
        grown = each[b - a :].max() / each[: end - b].max()
        yield Prediction("its factor a step", z, z * grown ** (1 / (b - a)), 1e-3)
