"""The findings of a check about a part, as sentences."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from mars2d.core.errors import InputError, counted


@dataclass(frozen=True)
class Finding:
    """A sentence about a part: something "wrong", or a "hint" at a possible improvement.

    untried: whether the fault lies elsewhere, so that the part could not be tried.
    """

    kind: Literal["wrong", "hint"]
    text: str
    untried: bool = False


class CheckError(InputError):
    """A user's part is not sound; the message lists everything that is wrong.

    findings: all findings, including hints.
    """

    def __init__(self, name: str, findings: Iterable[Finding]) -> None:
        self.findings = tuple(findings)
        lines = [finding.text for finding in self.findings if finding.kind == "wrong"]
        super().__init__("\n- ".join([f"{name}: {counted(len(lines), 'thing')} wrong", *lines]))
