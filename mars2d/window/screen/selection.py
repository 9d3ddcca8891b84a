"""The body that is selected in a window."""

from __future__ import annotations


class Selection:
    """The selected body, an index of `Scenario.bodies`; None for none."""

    def __init__(self, body: int | None = None) -> None:
        """Start with a body, or with none."""
        self.body = body
