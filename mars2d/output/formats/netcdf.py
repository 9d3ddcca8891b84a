"""``.nc``: the dataset of xarray as netCDF 3, which ncdump, R, Matlab and Panoply open."""

from __future__ import annotations

from io import BufferedReader, FileIO
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from mars2d.core.errors import InputError
from mars2d.core.extras import extra
from mars2d.core.files import atomic_write
from mars2d.output.formats import header as headers
from mars2d.output.formats.columns import plain_names
from mars2d.output.formats.dataset import HEADER, named_dataset, variable_of
from mars2d.output.formats.guard import check_size, in_bytes, reading
from mars2d.record.record import Record

MAX_VARIABLE = 2**31 - 4
"""The size of the largest variable that netCDF 3 holds, bytes."""


def require(path: Path) -> None:
    """Raise MissingExtraError where xarray isn't installed."""
    with extra("data", f"{path}: netCDF needs xarray", ".npz, .mat and .csv need nothing"):
        import xarray  # noqa: F401


def write(record: Record, path: Path) -> None:
    """Write a record to a file; InputError where it can't be, MissingExtraError without xarray.

    Names of sensors become ASCII. Variables without values are left out: a length of 0 means in
    netCDF 3 that a dimension can grow.
    """
    require(path)
    largest = max(each.nbytes for each in headers.numbers_of(record).values())
    if largest > MAX_VARIABLE:
        raise InputError(
            f"{path}: can't be written: {in_bytes(largest)} in one variable are more than netCDF 3 "
            "holds, 2 GB: save it as .npz"
        )
    dataset = named_dataset(record, plain_names(record.sensors))
    empty = [name for name, each in dataset.variables.items() if not each.size]
    dataset = dataset.drop_vars([*empty, "contents"], errors="ignore")
    dataset.attrs[HEADER] = headers.as_text(headers.with_shapes(record))
    plain = {name: {"_FillValue": None} for name in dataset.variables}
    content = dataset.to_netcdf(engine="scipy", format="NETCDF3_64BIT", encoding=plain)
    with atomic_write(path) as file:
        file.write(content)


def read(path: Path, largest: int) -> Record:
    """Read the record in a file; InputError where there is none, or it is larger than allowed."""
    with reading(path):
        check_size(path, path.stat().st_size, largest)
        attributes, variables = _contents(path)
        header = headers.of_text(path, attributes[HEADER], largest)
        sensors = plain_names(header["sensor_robots"])
        names = {name: variable_of(name, sensors) for name in headers.names_in(header)}
        columns = {name: variables[its] for name, its in names.items() if its in variables}
        return headers.restored(header, columns)


def _contents(path: Path) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Return a file's global attributes and its variables, by name.

    Raises InputError for netCDF 4, and various exceptions for a damaged file.
    """
    from scipy.io import netcdf_file

    class Reader(netcdf_file):
        """Keeps a file's attributes apart from its own, which one called ``fp`` would replace."""

        def __setattr__(self, name: str, value: Any) -> None:
            attributes = vars(self).get("_attributes")
            if attributes is None:
                super().__setattr__(name, value)
            else:
                attributes[name] = value

    with _Once(path) as file:
        if file.read(4) == b"\x89HDF":
            raise InputError("netCDF 4 (HDF5); expected netCDF 3: 'nccopy -k nc6' makes it of this")
        file.seek(0)
        found = Reader(file, mmap=False)
        variables = {name: each.data for name, each in found.variables.items()}
        return dict(vars(found)["_attributes"]), variables


class _Once(BufferedReader):
    """A file of which no more bytes are read than it has.

    scipy asks for as many bytes as the file claims to hold, before it looks at what is there, and
    copies them for each variable. A sound file has every byte for one variable only.
    """

    def __init__(self, path: Path) -> None:
        super().__init__(FileIO(path))
        self._size = path.stat().st_size
        self._left = self._size + 4  # the first bytes are read twice

    def read(self, size: int | None = -1) -> bytes:
        """Return the next bytes. Raises ValueError for more than may be left."""
        if size is None or not 0 <= size <= self._left:
            raise ValueError("more than there is")
        self._left -= size
        return super().read(size)

    def seek(self, offset: int, whence: int = 0) -> int:
        """Go to a place in the file. Raises ValueError for any other."""
        if not 0 <= offset <= self._size:
            raise ValueError("a place outside the file")
        return super().seek(offset, whence)
