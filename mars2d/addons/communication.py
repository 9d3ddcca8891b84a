"""Messages between robots, over a channel that may lose and delay them."""

from __future__ import annotations

from mars2d.addons.base import Addon
from mars2d.addons.gilbert_elliott import Burst
from mars2d.core.checks import instance
from mars2d.core.description import entry, flag, number
from mars2d.core.errors import InputError

__all__ = ["Communication"]


_is_burst = instance(Burst, "Burst(to_bad=0.05, to_good=0.25)")


def _burst(name: str, value: object) -> object:
    return None if value is None else _is_burst(name, value)


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
        doc="how far robots hear each other, from pose to pose; None: everywhere",
    )  # fmt: skip
    line_of_sight: bool = flag(
        default=False, doc="whether walls, props and other robots between two are in the way"
    )
    neighbours_only: bool = flag(
        default=False, doc="whether robots hear only their neighbours, by `Scenario.neighbours`"
    )
    delay: float = number(
        default=0.0, low=0, high=1e6, unit="s", doc="from sending to arrival, at least"
    )
    loss: float = number(
        default=0.0, low=0, high=1, doc="probability that a receiver never gets a message"
    )
    burst: Burst | None = entry(
        default=None, check=_burst, doc="losses in bursts, in place of `loss`; None: none"
    )
    bandwidth: float | None = number(
        default=None, above=0, high=1e12, unit="bytes", optional=True,
        doc="what a robot may send in one control step; None: anything",
    )  # fmt: skip

    def _validate(self) -> None:
        super()._validate()
        if self.loss and self.burst is not None:
            raise InputError(
                f"Communication.loss = {self.loss:g}: with a burst there are the losses of its "
                "loss_good and loss_bad; leave one of both out"
            )
