"""What a check has found, in words."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from mars2d.core.errors import InputError, counted

__all__ = ["CheckError", "Finding", "Report", "judge"]


@dataclass(frozen=True)
class Finding:
    """One sentence about a part: something "wrong", or a "hint" at what could be better.

    untried: whether something else is what is wrong, for which the part could not be tried.
    """

    kind: Literal["wrong", "hint"]
    text: str
    untried: bool = False


_NUMBER = re.compile(r"[-+]?(\d[\d.]*(e[-+]?\d+)?|\binf\b|\bnan\b)")


class CheckError(InputError):
    """A part of one's own is not sound; the message lists all that is wrong.

    findings: all that was found, hints too.
    """

    def __init__(self, name: str, findings: Iterable[Finding]) -> None:
        self.findings = tuple(findings)
        lines = [finding.text for finding in self.findings if finding.kind == "wrong"]
        super().__init__("\n- ".join([f"{name}: {counted(len(lines), 'thing')} wrong", *lines]))


class Report:
    """Collects findings; what differs in its numbers alone is said once."""

    def __init__(self) -> None:
        self._findings: dict[str, Finding] = {}

    def wrong(self, text: str, *, untried: bool = False) -> None:
        """Add something that is wrong; untried: as in `Finding`."""
        self._add(Finding("wrong", text, untried))

    def hint(self, text: str) -> None:
        """Add something that could be better."""
        self._add(Finding("hint", text))

    def _add(self, finding: Finding) -> None:
        self._findings.setdefault(_NUMBER.sub("#", finding.text), finding)

    @property
    def sound(self) -> bool:
        """Whether nothing wrong was found until now."""
        return not any(finding.kind == "wrong" for finding in self._findings.values())

    @property
    def findings(self) -> tuple[Finding, ...]:
        """All findings, what is wrong first."""
        return tuple(sorted(self._findings.values(), key=lambda finding: finding.kind == "hint"))


def judge(name: str, findings: tuple[Finding, ...]) -> None:
    """Raise CheckError if anything is wrong."""
    if any(finding.kind == "wrong" for finding in findings):
        raise CheckError(name, findings)
