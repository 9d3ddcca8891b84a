"""Styles of figures for the screen, print and projectors, as data applied to each artist."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from mars2d.core.errors import InputError, likely, shown
from mars2d.core.scene import color_of, rgb
from mars2d.output.raster.theme import contrast
from mars2d.record.interventions import Change

if TYPE_CHECKING:
    from mars2d.record.rows import Rows
    from mars2d.scenario.scenario import Scenario

MILLIMETRE = 1 / 25.4
"""Inches."""

DASHES = ("-", "--", ":", "-.")
"""Line styles that tell robots apart without colours, named as in matplotlib and Matlab."""

GREYS = ("#000000", "#808080")
"""Greys of curves: with the line styles, as many combinations as a legend has robots."""


@dataclass(frozen=True)
class Style:
    """The look of a figure.

    title, label, small: sizes of text, points; ticks and legends are small. A title of 0 is left
    out, for figures with a caption below. stroke: a factor for the widths of lines. ink, muted,
    grid, line: the colours of text, ticks, grid and axes. single, full: the widths of figures with
    one drawing and of others, inches; None: as wide as the drawing needs. page: the size of every
    figure, inches, which replaces both. panel: the height of a panel over time, inches. dpi: of a
    .png. family: fonts, in the order in which letters are looked up; empty: those of the user's
    matplotlib. greys: whether greys and dashes tell robots apart. contrast: the least contrast of
    curves to white, from 1 to 21. rows: the most bars, one below the other, that can be told apart.
    """

    name: str
    title: float
    label: float
    small: float
    stroke: float
    ink: str
    muted: str
    grid: str
    line: str
    panel: float
    dpi: int
    single: float | None = None
    full: float | None = None
    page: tuple[float, float] | None = None
    family: tuple[str, ...] = ()
    greys: bool = False
    contrast: float = 1.0
    rows: int = 16

    @property
    def trim(self) -> bool:
        """Whether blank margins are cut off in a file: only if the size is not fixed."""
        return self.single is None and self.page is None

    @property
    def spacing(self) -> float:
        """The distance of lines in labels, in heights of text: fonts for print are airy."""
        return 1.0 if self.family else 1.2

    def colors(self, scenario: Scenario) -> tuple[str, ...]:
        """Return the colours of the robots' curves."""
        if self.greys:
            return tuple(self.curve(i)[0] for i in range(len(scenario.robots)))
        return tuple(_dark_enough(color, self.contrast) for color in scenario.colors)

    def curve(self, index: int) -> tuple[str, str]:
        """Return the colour and line style of a curve that belongs to no single robot."""
        dash = DASHES[index % len(DASHES)]
        if self.greys:
            return GREYS[index // len(DASHES) % len(GREYS)], dash
        return _dark_enough(CURVES[index % len(CURVES)], self.contrast), "-"

    def dash(self, index: int) -> str:
        """Return the line style of a robot's path."""
        return DASHES[index % len(DASHES)] if self.greys else "-"

    def robot_curve(self, scenario: Scenario, index: int) -> tuple[str, str]:
        """Return the colour and line style of a robot's curve; dashes tell equal colours apart."""
        if self.greys:
            return self.curve(index)
        colors = self.colors(scenario)
        return colors[index], DASHES[colors[:index].count(colors[index]) % len(DASHES)]

    def restyled(self, record: Rows) -> Rows:
        """Return the record with the colours that this style gives its robots."""
        if self.colors(record.scenario) == record.scenario.colors:
            return record
        changed = tuple(
            replace(each, scenario=self._restyled(each.scenario))
            if isinstance(each, Change)
            else each
            for each in record.interventions
        )
        return replace(record, scenario=self._restyled(record.scenario), interventions=changed)

    def _restyled(self, scenario: Scenario) -> Scenario:
        pairs = zip(scenario.robots, self.colors(scenario), strict=True)
        return scenario.replace(robots=[robot.replace(color=color) for robot, color in pairs])

    @contextmanager
    def fonts(self) -> Iterator[None]:
        """Use the fonts of this style for text that is made in the block."""
        import matplotlib as mpl

        with mpl.rc_context({"font.family": list(self.family)} if self.family else {}):
            yield


CURVES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#7a5c2e")
"""The colours of curves that belong to no single robot."""

SCREEN = Style(
    name="screen", title=12, label=10, small=9, stroke=1.0,
    ink="#1f2933", muted="#616e7c", grid="#e6e9ed", line="#c3cad2", panel=1.45, dpi=200,
)  # fmt: skip
"""For reading at a desk."""

PRINT = Style(
    name="print", title=0, label=9, small=8, stroke=0.75,
    ink="#000000", muted="#000000", grid="#dddddd", line="#000000", panel=0.95, dpi=600,
    single=85 * MILLIMETRE, full=170 * MILLIMETRE, family=("STIXGeneral", "DejaVu Sans"),
    greys=True,
)  # fmt: skip
"""For one column of a paper, 85 mm, or two, 170 mm: black on white, text of 8 and 9 points."""

PROJECTOR = Style(
    name="projector", title=26, label=22, small=20, stroke=2.2,
    ink="#000000", muted="#262626", grid="#c8ccd0", line="#595959", panel=2.0, dpi=144,
    page=(40 / 3, 7.5), contrast=3.0, rows=8,
)  # fmt: skip
"""For a slide of 16:9, 1920 x 1080 pixels, that can be read from afar."""

STYLES = {style.name: style for style in (SCREEN, PRINT, PROJECTOR)}


def style_of(name: object) -> Style:
    """Return a style by its name, or the style itself. Raises InputError for another name."""
    if isinstance(name, Style):
        return name
    if not isinstance(name, str) or name not in STYLES:
        known = ", ".join(map(repr, STYLES))
        raise InputError(f"style = {shown(name)}: expected one of {known}{likely(name, STYLES)}")
    return STYLES[name]


def _dark_enough(color: str, least: float) -> str:
    """Return a colour, darkened until it has a contrast to white."""
    found, share = color, 1.0
    while contrast(found, "#ffffff") < least:
        share *= 0.95
        found = color_of(share * part for part in rgb(color))
    return found
