"""The findings of a check about a part, collected as sentences."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from mars2d.core.errors import InputError, counted

_NUMBER = re.compile(r"[-+]?(\d[\d.]*(e[-+]?\d+)?|\binf\b|\bnan\b)")


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


class Report:
    """Collects findings about what has a title; of those that differ only in numbers, the first."""

    def __init__(self, title: str) -> None:
        self._title = title
        self._findings: dict[str, Finding] = {}

    def wrong(self, text: str, *, untried: bool = False) -> None:
        """Add something that is wrong; untried: as in `Finding`."""
        self._findings.setdefault(_NUMBER.sub("#", text), Finding("wrong", text, untried))

    def hint(self, text: str) -> None:
        """Add something that could be better."""
        self._findings.setdefault(_NUMBER.sub("#", text), Finding("hint", text))

    @property
    def sound(self) -> bool:
        """Whether nothing wrong has been found so far."""
        return not any(finding.kind == "wrong" for finding in self._findings.values())

    def hints(self) -> tuple[Finding, ...]:
        """Return the hints; raise CheckError if anything is wrong."""
        found = sorted(self._findings.values(), key=lambda finding: finding.kind == "hint")
        if not self.sound:
            raise CheckError(self._title, found)
        return tuple(found)
