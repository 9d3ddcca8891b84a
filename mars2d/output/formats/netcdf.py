"""``.nc``: the dataset of xarray as netCDF 3, which ncdump, R, Matlab and Panoply open."""

from __future__ import annotations

from pathlib import Path

from mars2d.core.errors import InputError, MissingExtraError
from mars2d.core.files import atomic_write
from mars2d.output.formats import header as headers
from mars2d.output.formats.dataset import HEADER, named_dataset, variable_of
from mars2d.output.formats.naming import plain_names
from mars2d.output.formats.netcdf3 import read_netcdf
from mars2d.output.formats.size import check_size, in_bytes
from mars2d.record.record import Record

__all__ = ["read", "require", "write"]

MOST = 2**31 - 4
"""The largest variable, bytes."""


def require(path: Path) -> None:
    """Raise MissingExtraError where xarray isn't installed."""
    try:
        import xarray  # noqa: F401
    except ImportError:
        raise MissingExtraError(
            f'{path}: netCDF needs xarray: pip install "mars2d[data]"; .npz, .mat and .csv need '
            "nothing"
        ) from None


def write(record: Record, path: Path) -> None:
    """Write a record to a file; InputError where it can't be, MissingExtraError without xarray.

    Names of sensors are ASCII there. Variables without values are left out: in netCDF 3 a length of
    0 means that a dimension grows.
    """
    require(path)
    largest = max(each.nbytes for each in headers.numbers_of(record).values())
    if largest > MOST:
        raise InputError(
            f"{path}: can't be written: {in_bytes(largest)} in one variable are more than netCDF 3 "
            "holds, 2 GB: save it as .npz"
        )
    dataset = named_dataset(record, plain_names(record.sensors))
    gone = [name for name, each in dataset.variables.items() if not each.size]
    dataset = dataset.drop_vars([*gone, "contents"], errors="ignore")
    dataset.attrs[HEADER] = headers.as_text(headers.with_shapes(record))
    plain = {name: {"_FillValue": None} for name in dataset.variables}
    content = dataset.to_netcdf(engine="scipy", format="NETCDF3_64BIT", encoding=plain)
    with atomic_write(path) as file:
        file.write(content)


def read(path: Path, largest: int) -> Record:
    """Read the record in a file; InputError where there is none, or it is larger than allowed."""
    with headers.reading(path):
        check_size(path, path.stat().st_size, largest)
        content = memoryview(path.read_bytes())
        attributes, variables = read_netcdf(content)
        header = headers.of_text(path, attributes[HEADER], largest)
        sensors = plain_names(header["sensor_robots"])
        names = {name: variable_of(name, sensors) for name in headers.names_in(header)}
        columns = {name: variables[its] for name, its in names.items() if its in variables}
        if sum(column.nbytes for column in columns.values()) > len(content):
            raise ValueError("variables that share their values")
        return headers.restored(header, columns)
