"""All bad inputs, by their kinds."""

from __future__ import annotations

from tests.cli.bad_inputs import (
    commands,
    constructors,
    files,
    laws,
    maps,
    messages,
    options,
    records,
    sensors,
)
from tests.cli.bad_inputs.case import Case

__all__ = ["KINDS"]

KINDS: dict[str, list[Case]] = {
    "constructor values": constructors.CASES,
    "options": options.CASES,
    "files": files.CASES,
    "laws": laws.CASES,
    "commands": commands.CASES,
    "sensors": sensors.CASES,
    "messages": messages.CASES,
    "records": records.CASES,
    "maps": maps.CASES,
}
