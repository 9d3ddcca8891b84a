"""What theory says of capturing the flag, and whether a run agrees."""

import numpy as np
from scipy.optimize import linear_sum_assignment

from mars2d import Prediction
from mars2d.geometry import dominance

FLAG, REACH, CAPTURE = np.array([[-4.0], [0.0]]), 0.5, 0.5  # m
HOME = [(3, -4), (6, -4), (6, 4), (3, 4)]


def nearest(attacker, guard, mu):
    """The point nearest to the flag that an attacker reaches before a guard."""
    edge = dominance(attacker, guard, mu, CAPTURE)
    return edge[:, np.hypot(*(edge - FLAG)).argmin()]


def stops(guard, attacker, mu):
    """Whether a guard keeps an attacker off the flag: all of it is out of the attacker's region."""
    guard_way, way = (np.hypot(*(place - FLAG[:, 0])) for place in (guard, attacker))
    left = np.hypot(*(nearest(attacker, guard, mu) - FLAG[:, 0]))
    return way / mu > guard_way - CAPTURE and left > REACH


def matching(starts, guards, mu):
    """Pairs of guards and attackers that they stop, as many as can be."""
    can = [[stops(one, other, mu) for other in starts[guards:]] for one in starts[:guards]]
    pairs = np.transpose(linear_sum_assignment(can, maximize=True))
    return [(i, j) for i, j in pairs if can[i][j]]


def safe(record):
    """The attackers that are safe: those at the flag, or who have carried it home."""
    exits = record.scenario.addons[0].exits_at(record.frame(-1))
    return [leaving.robot for leaving in exits if leaving.result > 0]


def checks(record):
    guards, attackers = record.scenario.addons[0].players(record.scenario)
    quick, slow = (record.scenario.robots[k].drive.max_linear_speed for k in (0, -1))
    if slow > quick:
        yield Prediction.silent("at the flag", "for guards that are as quick as attackers")
        return
    most = len(attackers) - len(matching(record.pose[0, :2].T, len(guards), slow / quick))
    home = record.scenario.addons[0].home is not None
    name = "home with the flag: N - m" if home else "at the flag: N - m"
    yield Prediction(name, most, len(safe(record)), 0, bound="at most")
