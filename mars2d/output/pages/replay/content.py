"""The content of a replay, as plain data and columns."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from mars2d.core.description import snake_case
from mars2d.core.scene import Scene
from mars2d.output.controls import MARKS
from mars2d.output.figures.extent import View, check_rows
from mars2d.output.layers.arrows import MAX_ARROW
from mars2d.output.layers.forces import SLIPPING
from mars2d.output.layers.legend import Legend, legends
from mars2d.output.layers.table import LAST_BODIES, LAYERS, Layer, standing
from mars2d.output.layers.trails import (
    PROP_TRAIL_WIDTH,
    TRAIL_WIDTH,
    prop_trail_colors,
    trail_colors,
)
from mars2d.output.pages.replay.columns import Columns, rounded
from mars2d.output.pages.replay.drawings import Drawing, Flat, Float, flat, pack, shapes_of
from mars2d.output.raster.theme import LIGHT, mixed
from mars2d.record.frame import Frame
from mars2d.record.interventions import leaps_of
from mars2d.record.marks import marks_of

if TYPE_CHECKING:
    from mars2d.record.rows import Rows

ROOM = 1_380_000
"""The most bytes of all columns; as text they take a third more."""

POSES, PANEL, LAYER = 480_000, 200_000, 200_000
"""The most bytes of each; beyond, rows are left out. Sensors, the last layer, get the rest."""

MOST, CROWD = 1000, 100_000
"""The most rows, and rows times bodies, at which layers are drawn, since that takes long."""

FINE, TURN, COARSE = 2**-20, 2 * np.pi / 2**16, 2**-16
"""Steps of positions, of headings [rad], and of moving shapes; lengths in shares of the view."""

LEAP = 0.12
"""The share of the view beyond which a shape leaps between rows, rather than moving evenly."""


def content_of(record: Rows) -> tuple[dict[str, Any], Columns]:
    """Return the content of a replay: plain data, and columns of numbers.

    Raises InputError for a record without rows.
    """
    check_rows(record, "replay")
    return _Content(record).made()


class _Content:
    """Assembles a replay, and notes the parts that are left out."""

    def __init__(self, record: Rows) -> None:
        self.record, self.scenario = record, record.scenario
        self.view = View.of(record, len(record) - 1)
        self.size = max(self.view.width, self.view.height)
        self.columns = Columns()
        self.notes: list[str] = []
        self.kept = np.empty(0, dtype=np.int64)

    def made(self) -> tuple[dict[str, Any], Columns]:
        """Return the data and the columns."""
        self._add_poses()
        header = self._about()
        header["bodies"] = self._bodies()
        self._add_panel()
        header["marks"] = self._add_marks()
        header["layers"] = self._table()
        header["legends"] = [_legend(each) for each in legends(self.scenario)]
        header["drawn"] = self._add_layers()
        if self.record.drawn.shapes:
            self.notes.append("what add-ons drew while they ran is shown at the end alone")
        if self.record.missing:
            listed = ", ".join(self.record.missing)
            self.notes.append(f"not drawn, since their code is not in the record: {listed}")
        header["notes"] = self.notes
        header["columns"] = self.columns.index
        return header, self.columns

    def _about(self) -> dict[str, Any]:
        record, scenario = self.record, self.scenario
        bounded = scenario.workspace is not None and scenario.on_exit != "ignore"
        return {
            "title": scenario.title,
            "file": record.filename,
            "seed": record.seed,
            "digest": record.digest,
            "versions": dict(record.versions),
            "over": record.over_message,
            "finished": record.finished,
            "changed": len(record.interventions),
            "step": scenario.sampling_time,
            "rows": len(record),
            "view": self.view,
            "grid": list(scenario.bounds) if bounded else None,
            "ground": LIGHT.paper if scenario.workspace is None else LIGHT.page,
            "colors": LIGHT._asdict(),
            "speed": scenario.animation.playback_speed,
            "slipping": SLIPPING,
            "lastBodies": LAST_BODIES,
            "longestArrow": MAX_ARROW,
        }

    # -- bodies -------------------------------------------------------------------------------

    def _add_poses(self) -> None:
        """Add the poses of all bodies at as many rows as fit, and remember these rows."""
        record, step = self.record, self.size * FINE
        low = np.array([self.view.xmin, self.view.ymin])
        poses = record.all_poses
        turn = max(TURN, float(np.abs(poses[:, 2]).max()) * 2**-27)
        ways = _ways(poses)
        progress = _progress(ways)

        at_all, count = np.arange(len(record)), len(record)
        while True:
            at = np.linspace(0.0, progress[-1], count)
            kept = np.unique(np.searchsorted(progress, at)) if count < len(record) else at_all
            columns = Columns()
            columns.add("rows", kept, order=1)
            places = rounded(poses[kept, :2] - low[:, None], step)
            columns.add("places", places, order=2, step=step, low=low.tolist())
            columns.add("headings", rounded(poses[kept, 2], turn), order=2, step=turn)
            if columns.size <= POSES or count <= 2:
                break
            count = max(2, int(count * min(0.9, POSES / columns.size)))
        # A line does for a path that is less than a tenth longer, as an arc of less than 90 degrees
        # is, or by less than a five hundredth of the view's size.
        gone = np.diff(ways[kept], axis=0, prepend=ways[:1])
        line = np.hypot(*np.diff(poses[kept, :2], axis=0, prepend=poses[:1, :2]).swapaxes(0, 1))
        gaps = np.argwhere(gone - line > np.maximum(0.1 * gone, self.size / 500))
        leaps = [
            (int(np.searchsorted(kept, row)), body) for row, body in leaps_of(record.interventions)
        ]
        rows, bodies = np.array([*leaps, *gaps.tolist()], dtype=int).reshape(-1, 2).T
        columns.add("leaps:row", rows)
        columns.add("leaps:body", bodies)
        self.columns.take(columns)
        self.kept = kept
        if len(kept) < len(record):
            self.notes.append(
                f"{len(kept)} of {len(record)} rows are in this file, more where bodies move"
            )
        if len(gaps):
            self.notes.append("paths have gaps where a body goes round a bend between two rows")

    def _bodies(self) -> list[dict[str, Any]]:
        """Return the robots and props: their names, their sizes, and how their paths look."""
        scenario = self.scenario
        robots, props, wake = scenario.robots, scenario.props, scenario.animation.wake_style
        kinds = (*(robot.drive for robot in robots), *props)
        trails = [(color, TRAIL_WIDTH, wake) for color in trail_colors(scenario)]
        trails += [(color, PROP_TRAIL_WIDTH, "-") for color in prop_trail_colors(scenario)]
        bodies: list[dict[str, Any]] = [
            {
                "name": str(body.name),
                "kind": snake_case(type(kind).__name__).replace("_", " "),
                "robot": i < len(robots),
                "color": color,
                "bound": [*body.shape.bound[0], body.shape.bound[1]],
                # Opaque, as over paper: the pieces of a path overlap.
                "trail": ["line", mixed(ink, LIGHT.paper, int(ink[7:], 16) / 255), width, style],
            }
            for i, (body, kind, color, (ink, width, style)) in enumerate(
                zip(scenario.bodies, kinds, scenario.body_colors, trails, strict=True)
            )
        ]
        for robot, told in zip(robots, bodies, strict=False):
            told["commands"] = [[q.symbol, q.unit, q.kind] for q in robot.drive.inputs]
        return bodies

    # -- the panel ----------------------------------------------------------------------------

    def _add_panel(self) -> None:
        """Add commands and efforts."""

        def packed(every: int) -> Columns:
            columns = Columns()
            for name in ("command", "effort"):
                values = getattr(self.record, name)
                step = max(float(np.abs(values).max(initial=0.0)), 1e-6) / 2**15
                rows = rounded(values[self.kept][::every], step)
                columns.add(name, rows, order=1, step=step, every=every)
            return columns

        self._fit("commands in the panel", PANEL, packed)

    def _add_marks(self) -> list[dict[str, Any]]:
        """Add the rows that have marks on the time bar; return which kinds there are."""
        found = {kind: rows for kind, rows in marks_of(self.record).items() if rows}
        for kind, rows in found.items():
            at = np.minimum(np.searchsorted(self.kept, rows), len(self.kept) - 1)
            self.columns.add(f"marks:{kind}", np.unique(at), order=1)
        return [
            {"kind": kind, "above": mark.above, "below": mark.below, "meaning": mark.meaning}
            for kind, mark in MARKS.items()
            if kind in found
        ]

    # -- layers -------------------------------------------------------------------------------

    def _table(self) -> list[dict[str, Any]]:
        """Return the layers for the page, the lowest first."""
        stand = standing()
        return [
            {
                "name": layer.name,
                "title": layer.title,
                "key": layer.key,
                "switch": layer.switch,
                "along": layer.along,
                "on": layer.at_first(self.scenario.animation),
                "stands": layer in stand,
            }
            for layer in LAYERS
        ]

    def _add_layers(self) -> dict[str, dict[str, Any]]:
        """Add all layers but those that the page makes of poses; return headers."""
        headers: dict[str, dict[str, Any]] = {}
        moving: dict[str, Layer] = {}
        for layer in LAYERS:
            if layer.shapes is None or layer.name == "trails":
                continue
            if layer.stands:
                drawings = self._standing(layer)
            elif layer.each is not None:
                drawings = self._carried(layer)
            else:
                moving[layer.name] = layer
                continue
            if drawings:
                columns, headers[layer.name] = pack(layer.name, drawings, self.size * FINE)
                self.columns.take(columns)
        count = len(self.kept)
        stride = -(-count // max(min(MOST, CROWD // len(self.scenario.bodies)), 1))
        rows = sorted({*range(0, count, stride), count - 1})
        scenes: dict[str, list[Flat]] = {name: [] for name in moving}
        for row in rows:
            frame = self.record.frame(int(self.kept[row]))
            for name, layer in moving.items():
                scenes[name].append(_drawn(layer, frame))
        for name in sorted(moving, key="sensors".__eq__):  # the last ones
            if any(scene.styles for scene in scenes[name]):
                headers[name] = self._add_rows(moving[name], rows, scenes[name], stride)
        return headers

    def _standing(self, layer: Layer) -> list[Drawing]:
        """Return a layer that stands still until the scenario is changed."""
        record = self.record
        changes = sorted({0, *(min(c.row, len(record) - 1) for c in record.changes)})
        rows = np.searchsorted(self.kept, changes, side="left").tolist()
        return [Drawing(rows, [_drawn(layer, record.frame(row)) for row in changes])]

    def _carried(self, layer: Layer) -> list[Drawing]:
        """Return a layer that moves with bodies: one scene for each, in its frame."""
        assert layer.each is not None
        found = []
        for body in range(len(self.scenario.bodies)):
            scene = Scene()
            layer.each(scene, self.scenario, body, np.zeros(3))
            if scene.shapes:
                found.append(Drawing([0], [flat(scene.shapes)], body, layer.upright))
        return found

    def _add_rows(
        self, layer: Layer, rows: list[int], scenes: list[Flat], stride: int
    ) -> dict[str, Any]:
        """Add the scenes of a layer, at rows of so many each; return their header."""
        header: dict[str, Any] = {}

        def packed(every: int) -> Columns:
            chosen = sorted({*range(0, len(rows), every), len(rows) - 1})
            drawing = Drawing([rows[k] for k in chosen], [scenes[k] for k in chosen])
            columns, told = pack(layer.name, [drawing], self.size * COARSE)
            header.update(told, every=every * stride, leap=LEAP * self.size)
            return columns

        seen = any(scene.styles for scene in scenes[:-1])
        room = ROOM - self.columns.size if layer.name == "sensors" else LAYER
        self._fit(layer.title.lower() if seen else "", room, packed, stride)
        return header

    def _fit(self, what: str, room: int, pack: Callable[[int], Columns], stride: int = 1) -> None:
        """Add columns of at most `room` bytes, and a note.

        what: for the note; "" for none. pack: returns the columns of one row in so many of those
        that there are, which are one in `stride` of the file.
        """
        every = 1
        while True:
            columns = pack(every)
            size = columns.size + columns.beside
            if size <= room or every >= len(self.kept):
                break
            every = max(every + 1, int(every * size / max(room, 1)))
        self.columns.take(columns)
        if every * stride > 1 and what:
            self.notes.append(f"{what}: one row in {every * stride} of this file")


def _legend(legend: Legend) -> dict[str, Any]:
    """Return a legend for the page: its arrow at all round numbers, and its signs."""
    ruler = legend.ruler
    return {
        "layer": legend.layer,
        "arrow": ruler and ["arrow", ruler.color, None, ruler.width],
        "lengths": ruler.lengths if ruler else [],
        "signs": [
            {"room": sign.room, "meaning": sign.name, "shapes": shapes_of(sign.scene)}
            for sign in legend.signs
        ],
    }


def _drawn(layer: Layer, frame: Frame) -> Flat:
    assert layer.shapes is not None
    return flat(layer.shapes(frame).shapes)


def _ways(poses: Float) -> Float:
    """Return how far each body has gone up to each row, (T, n): metres."""
    steps = np.hypot(*np.diff(poses[:, :2], axis=0).swapaxes(0, 1))
    return np.concatenate([np.zeros((1, poses.shape[2])), np.cumsum(steps, axis=0)])


def _progress(ways: Float) -> Float:
    """Return how far the run has got at each row, half by time and half by what moves, (T,)."""
    time = np.linspace(0.0, 1.0, len(ways))
    moved = np.concatenate([[0.0], np.cumsum(np.diff(ways, axis=0).max(axis=1, initial=0.0))])
    return time + moved / max(float(moved[-1]), 1e-300)
