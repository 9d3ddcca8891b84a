"""Messages between robots, over a channel that may lose and delay them."""

from __future__ import annotations

import numpy as np

from mars2d.addons.base import Addon
from mars2d.core.checks import instance, optional
from mars2d.core.description import Description, entry, flag, number
from mars2d.core.errors import InputError


class Burst(Description):
    """The channel of Gilbert and Elliott: each link is good for a while, then bad for a while.

    At each control step a good link turns bad with the probability `to_bad`, a bad one good with
    `to_good`, whether or not anything is sent over it. In each of its states it loses a message
    with a probability of its own. Sources: Gilbert (1960), whose good state loses nothing; Elliott
    (1963), whose good state may.

    >>> burst = Burst(to_bad=0.1, to_good=0.3)
    >>> burst.mean_loss, round(burst.mean_length, 3)
    (0.25, 3.333)
    """

    to_bad: float = number(
        default=0.05, above=0, high=1, doc="probability per control step that a good link turns bad"
    )
    to_good: float = number(
        default=0.25, above=0, high=1, doc="probability per control step that a bad link turns good"
    )
    loss_good: float = number(
        default=0.0, low=0, high=1, doc="probability that a good link loses a message"
    )
    loss_bad: float = number(
        default=1.0, low=0, high=1, doc="probability that a bad link loses a message"
    )

    @property
    def share_bad(self) -> float:
        """The share of the time in which a link is bad: to_bad / (to_bad + to_good)."""
        return self.to_bad / (self.to_bad + self.to_good)

    @property
    def mean_loss(self) -> float:
        """The share of messages that is lost in the long run."""
        return (1 - self.share_bad) * self.loss_good + self.share_bad * self.loss_bad

    @property
    def mean_length(self) -> float:
        """The mean number of control steps that a link stays bad: 1 / to_good."""
        return 1 / self.to_good

    def turns(self, bad: bool | None, steps: int, rng: np.random.Generator) -> bool:
        """Return whether a link is bad, `steps` control steps after it was known to be `bad`.

        bad: None when nothing is known; then the link is bad with the probability `share_bad`. One
        random number is drawn, whatever the number of steps: with q = 1 - to_bad - to_good, the
        knowledge fades as q**steps.
        """
        share = self.share_bad
        if bad is not None:
            share += (float(bad) - share) * _whole_power(1 - self.to_bad - self.to_good, steps)
        return bool(rng.random() < share)

    def loses(self, bad: bool, rng: np.random.Generator) -> bool:
        """Return whether a link loses a message; one random number is drawn."""
        return bool(rng.random() < (self.loss_bad if bad else self.loss_good))


_burst = optional(instance(Burst, "Burst(to_bad=0.05, to_good=0.25)"))


class Communication(Addon):
    """Lets robots send messages to each other, over a channel that may be bad.

    Laws call ``robot.send(content, to)`` and read ``robot.inbox``. A message sent at a control step
    is in the inbox of its receivers at the first later one that is at least `delay` after it, so
    never in the same one. The receivers in reach are those at the time of sending. Each receiver
    gets or loses a message by itself, and the sender is not told: laws that need to know send
    acknowledgements. All messages are recorded and drawn.

    By default the channel is perfect and draws no random numbers.
    """

    only_one = "robots talk over one"
    acts = True
    carries_messages = True

    range: float | None = number(
        default=None, above=0, high=1e6, unit="m", optional=True,
        doc="the range of radio, from pose to pose; None: unbounded",
    )  # fmt: skip
    line_of_sight: bool = flag(
        default=False, doc="whether walls, props and other robots block the view"
    )
    neighbours_only: bool = flag(
        default=False, doc="whether robots hear only their neighbours, by `Scenario.neighbours`"
    )
    delay: float = number(
        default=0.0, low=0, high=1e6, unit="s", doc="the least time from sending to arrival"
    )
    loss: float = number(
        default=0.0, low=0, high=1, doc="probability that a receiver never gets a message"
    )
    burst: Burst | None = entry(
        default=None, check=_burst, doc="losses in bursts, in place of `loss`; None: none"
    )
    bandwidth: float | None = number(
        default=None, above=0, high=1e12, unit="bytes", optional=True,
        doc="the most that a robot may send in one control step; None: no bound",
    )  # fmt: skip

    def _validate(self) -> None:
        super()._validate()
        if self.loss and self.burst is not None:
            raise InputError(
                f"Communication.loss = {self.loss:g}: with a burst there are the losses of its "
                "loss_good and loss_bad; leave one of both out"
            )


def _whole_power(x: float, exponent: int) -> float:
    """Return a number to the power of a whole one, which is 0 or more."""
    result = 1.0
    while exponent:
        if exponent % 2:
            result *= x
        x *= x
        exponent //= 2
    return result
