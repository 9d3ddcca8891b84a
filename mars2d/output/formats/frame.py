"""Tables of pandas: bodies over time, contacts, messages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.description import wrong
from mars2d.core.errors import nearest
from mars2d.core.extras import extra
from mars2d.output.formats.columns import (
    CONTACT_UNITS,
    MESSAGE_UNITS,
    Part,
    parts_of,
    units_of,
)
from mars2d.record.message import STATUS
from mars2d.record.rows import Rows

if TYPE_CHECKING:
    from pandas import DataFrame


def to_frame(record: Rows, table: str = "bodies") -> DataFrame:
    """Return a table of a record; ``frame.attrs["units"]`` has the units of its columns.

    "bodies": indexed by time and body, robots first, then props. Values that a body does not have
    are missing, for example the command of a prop. A reading that is an array has a column for each
    value, for example ``scan_0``. "contacts": the rows of `Record.contacts`, with the names of both
    bodies; those of obstacles are ``obstacle 0`` or ``wall``. "messages": the rows of
    `Record.messages`, with the names of both robots, the text, and the status in words. Raises
    InputError for another table, MissingExtraError without pandas.
    """
    tables = {"bodies": _bodies, "contacts": _contacts, "messages": _messages}
    if not isinstance(table, str) or table not in tables:
        expected = "one of " + ", ".join(map(repr, tables))
        hint = nearest(table, tables, most=0) if isinstance(table, str) else ""
        raise wrong("table", table, expected + hint)
    with extra("data", "tables need pandas"):
        import pandas as pd  # noqa: F401
    frame, units = tables[table](record)
    frame.attrs["units"] = {name: unit for name, unit in units.items() if name in frame}
    return frame


def _bodies(record: Rows) -> tuple[DataFrame, dict[str, str]]:
    import pandas as pd

    columns, names = record.columns(), [body.name for body in record.scenario.bodies]
    parts = parts_of(record)
    table = {name: _column(columns, where, len(names)) for name, where in parts.items()}
    index = pd.MultiIndex.from_product([record.time, names], names=["time", "body"])
    return pd.DataFrame(table, index=index), units_of(record, parts)


def _column(columns: dict[str, NDArray[Any]], parts: list[Part], bodies: int) -> Any:
    """Return a column of the table, (T x bodies,): numbers or flags, some may be missing."""
    import pandas as pd

    values = [columns[part.name][(slice(None), *part.at)] for part in parts]
    lacking = np.ones((len(columns["time"]), bodies), dtype=bool)
    flags = values[0].dtype == np.bool_
    found = np.zeros(lacking.shape, bool) if flags else np.full(lacking.shape, np.nan)
    for part, some in zip(parts, values, strict=True):
        found[:, list(part.bodies)] = some
        lacking[:, list(part.bodies)] = False
    if flags and lacking.any():
        return pd.arrays.BooleanArray(found.ravel(), lacking.ravel())
    return found.ravel()


def _contacts(record: Rows) -> tuple[DataFrame, dict[str, str]]:
    import pandas as pd

    rows = record.contacts
    table: dict[str, Any] = {}
    for field in rows.dtype.names or ():
        values = rows[field]
        if values.ndim == 2:
            table |= {f"{field}_{axis}": values[:, k] for k, axis in enumerate("xy")}
            continue
        table[field] = values
        if field in ("a", "b"):
            names = {body: record.scenario.body_name(body) for body in np.unique(values).tolist()}
            named = [names[body] for body in values.tolist()]
            table[f"body_{field}"] = np.array(named, dtype=object)
    units = CONTACT_UNITS | {
        f"{field}_{axis}": CONTACT_UNITS[field] for field in ("point", "normal") for axis in "xy"
    }
    return pd.DataFrame(table), units


def _messages(record: Rows) -> tuple[DataFrame, dict[str, str]]:
    import pandas as pd

    rows, names = record.messages, [str(robot.name) for robot in record.scenario.robots]
    table: dict[str, Any] = {}
    for field in rows.dtype.names or ():
        words: dict[str, Any] = {"content": record.contents, "status": STATUS}
        if field in words:
            table[field] = np.array([words[field][i] for i in rows[field].tolist()], dtype=object)
            continue
        table[field] = rows[field]
        if field in ("sender", "receiver"):
            named = [names[i] for i in rows[field].tolist()]
            table[f"{field}_name"] = np.array(named, dtype=object)
    return pd.DataFrame(table), MESSAGE_UNITS
