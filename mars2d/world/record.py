"""The record of a run, with what people and programs do with it; and records from files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from numpy.typing import NDArray

from mars2d.record.rows import Rows

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike
    from xarray import Dataset

LOAD_LIMIT = 2**31
"""The most data that `load` reads by default, bytes."""


@dataclass(frozen=True, eq=False, repr=False)
class Record(Rows):
    """All data of a run, see `Rows`: to be plotted, filmed, saved, and made into tables.

    branches: runs in a window that were left for this one, which are kept in files of their own.
    """

    branches: tuple[Record, ...] = field(default=(), repr=False)

    @classmethod
    def of(cls, rows: Rows) -> Self:
        """Return the record with these data."""
        return cls(**{each.name: getattr(rows, each.name) for each in fields(rows)})

    def __reduce__(self) -> tuple[Any, ...]:
        """Return the state to pickle: that of files, without laws, with drawing and branches."""
        from mars2d.output.formats import header

        kept = header.of_record(self), self.columns()
        return _restored, kept, {"drawn": self.drawn, "branches": self.branches}

    # -- for people ---------------------------------------------------------------------------

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the paths: initial poses hollow, final poses filled, obstacles and grid.

        ax: matplotlib axes to draw on; by default those of a new figure. Returns the axes.
        """
        from mars2d.output.figures.figure import plot_paths

        return plot_paths(self, ax)

    def plot_snapshots(self, times: ArrayLike) -> Figure:
        """Draw the paths until each of some times [s], one panel a time; return the figure."""
        from mars2d.output.figures.figure import plot_snapshots

        return plot_snapshots(self, times)

    def plot_signals(
        self,
        *columns: str | Sequence[str],
        robots: Sequence[str | int] | None = None,
        axes: Sequence[Axes] | None = None,
        start: float | None = None,
        end: float | None = None,
    ) -> list[Axes]:
        """Draw columns over time, one panel a column; see `figures.signals.plot_signals`."""
        from mars2d.output.figures.signals import plot_signals

        return plot_signals(self, columns, robots, axes, start=start, end=end)

    def plot_contacts(self, axes: Sequence[Axes] | None = None) -> list[Axes]:
        """Draw who touched whom when, and how hard; see `figures.contacts.plot_contacts`."""
        from mars2d.output.figures.contacts import plot_contacts

        return plot_contacts(self, axes)

    def plot_impacts(self, axes: Sequence[Axes] | None = None) -> list[Axes]:
        """Draw what touches did to velocities, with numbers; see `figures.impacts.plot_impacts`."""
        from mars2d.output.figures.impacts import plot_impacts

        return plot_impacts(self, axes)

    def plot_distances(self, ax: Axes | None = None) -> Axes:
        """Draw distances over time; see `mars2d.output.figures.distances.plot_distances`."""
        from mars2d.output.figures.distances import plot_distances

        return plot_distances(self, ax)

    def film(
        self,
        path: str | Path,
        *,
        speed: float = 1.0,
        size: tuple[int, int] = (1280, 720),
        fps: float = 25,
        start: float | None = None,
        end: float | None = None,
    ) -> Path:
        """Make a film, .gif or .mp4, of a part of the run; see `films.film.film_record`."""
        from mars2d.output.films.film import film_record

        return film_record(self, path, speed=speed, size=size, fps=fps, start=start, end=end)

    def save_html(self, path: str | Path) -> Path:
        """Write a replay as one HTML file, which any browser plays without a network."""
        from mars2d.output.pages.replay import save_html

        return save_html(self, path)

    def _repr_html_(self) -> str:
        """Return an inline replay, for a notebook."""
        from mars2d.output.pages.notebook import record_html

        return record_html(self)

    def _repr_svg_(self) -> str:
        """Return a picture of the end, for viewers of notebooks without scripts."""
        from mars2d.output.pages.notebook import record_svg

        return record_svg(self)

    # -- for programs -------------------------------------------------------------------------

    def to_xarray(self) -> Dataset:
        """Return all columns as a dataset of xarray, with units; see `output.formats.dataset`."""
        from mars2d.output.formats.dataset import to_xarray

        return to_xarray(self)

    def save(self, path: str | Path) -> Path:
        """Write the record to a file and return its path; the ending says in which format.

        ``.npz`` numpy, ``.csv`` a long table, ``.mcap`` a log for Foxglove: `load` reads these
        again, with the same digest. ``.mat`` for Matlab and Octave: an export. Raises
        InputError where it can't be written, MissingExtraError where a library is missing.
        """
        from mars2d.output import formats

        return formats.save(self, path)


def _restored(header: Mapping[str, Any], columns: Mapping[str, NDArray[Any]]) -> Record:
    from mars2d.output.formats.header import to_record

    return Record.of(to_record(header, columns))


def load(path: str | Path, largest: float = LOAD_LIMIT) -> Record:
    """Read a record that `Record.save` wrote, or the log of a run, whole or broken off.

    largest: the most data that are read, bytes; a file that holds or claims more is refused before
    memory is taken. Raises InputError for such files, and for files that are no record.
    """
    from mars2d.output import formats

    return Record.of(formats.load(path, largest))
