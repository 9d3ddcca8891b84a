"""Messages between robots, over a channel that may lose and delay them."""

from __future__ import annotations

import numpy as np

from mars2d.addons.base import Addon
from mars2d.core.arithmetic import decay
from mars2d.core.checks import instance
from mars2d.core.description import Description, entry, flag, number
from mars2d.core.errors import InputError


class Burst(Description):
    """The channel of Gilbert and Elliott: each link is good for a while, then bad for a while.

    How long it stays so is exponentially distributed, with the means `good` and `bad`, whether or
    not anything is sent over it. In each of its states it loses a message with a probability of its
    own. Sources: Gilbert (1960), whose good state loses nothing; Elliott (1963), whose good state
    may. Theirs takes steps; this is the same chain in continuous time.

    >>> Burst(good=1.5, bad=0.5).mean_loss
    0.25
    """

    good: float = number(
        default=2.0, above=0, high=1e6, unit="s", doc="how long a link stays good, on average"
    )
    bad: float = number(
        default=0.4, above=0, high=1e6, unit="s", doc="how long a link stays bad, on average"
    )
    loss_good: float = number(
        default=0.0, low=0, high=1, doc="probability that a good link loses a message"
    )
    loss_bad: float = number(
        default=1.0, low=0, high=1, doc="probability that a bad link loses a message"
    )

    @property
    def share_bad(self) -> float:
        """The share of the time in which a link is bad: bad / (good + bad)."""
        return self.bad / (self.good + self.bad)

    @property
    def mean_loss(self) -> float:
        """The share of messages that is lost in the long run."""
        return (1 - self.share_bad) * self.loss_good + self.share_bad * self.loss_bad

    def turns(self, bad: bool | None, duration: float, rng: np.random.Generator) -> bool:
        """Return whether a link is bad a duration [s] after it was known to be `bad`.

        bad: None when nothing is known; then the link is bad with the probability `share_bad`. One
        random number is drawn: the knowledge fades as exp(-duration (1 / good + 1 / bad)).
        """
        share = self.share_bad
        if bad is not None:
            share += (float(bad) - share) * decay(duration * (1 / self.good + 1 / self.bad))
        return bool(rng.random() < share)

    def loses(self, bad: bool, rng: np.random.Generator) -> bool:
        """Return whether a link loses a message; one random number is drawn."""
        return bool(rng.random() < (self.loss_bad if bad else self.loss_good))


class Communication(Addon):
    """Lets robots send messages to each other, over a channel that may be bad.

    Laws call ``robot.send(content, to)`` and read ``robot.inbox``. A message sent at a control step
    is in the inbox of its receivers at the first later one that is at least `delay` after it, so
    never in the same one. With a `bandwidth` it first takes size / `bandwidth` to be sent, after
    all that its sender sent before. The receivers in reach are those at the time of sending. Each
    receiver gets or loses a message by itself, and the sender is not told: laws that need to know
    send acknowledgements. All messages are recorded and drawn.

    By default the channel is perfect and draws no random numbers.
    """

    only_one = "robots talk over one"
    acts = True
    carries_messages = True

    range: float | None = number(
        default=None, above=0, high=1e6, unit="m", optional=True,
        doc="the range of radio, from pose to pose; None: unbounded",
    )  # fmt: skip
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
        default=None, check=instance(Burst, "Burst(good=2, bad=0.4)"), optional=True,
        doc="losses in bursts, in place of `loss`; None: none",
    )  # fmt: skip
    bandwidth: float | None = number(
        default=None, low=1, high=1e12, unit="bytes/s", optional=True,
        doc="how fast a robot sends; None: at once",
    )  # fmt: skip

    def _validate(self) -> None:
        super()._validate()
        if self.loss and self.burst is not None:
            raise InputError(
                f"Communication.loss = {self.loss:g}: with a burst there are the losses of its "
                "loss_good and loss_bad; leave one of both out"
            )
