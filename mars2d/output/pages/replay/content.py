"""The content of a replay, as plain data and columns."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.colors import prop_colors
from mars2d.core.description import snake_case
from mars2d.core.quantity import ANGLE, DISTANCE, Quantity
from mars2d.core.scene import Scene
from mars2d.output.figures.extent import View, check_rows
from mars2d.output.layers.arrows import MAX_ARROW
from mars2d.output.layers.forces import (
    FAINTEST,
    MAX_CONTACTS,
    SLIPPING,
    force_scale,
    in_newtons,
)
from mars2d.output.layers.legend import Legend, legends
from mars2d.output.layers.rings import RING, has_ring
from mars2d.output.layers.table import LAST_BODIES, LAYERS, Layer, standing
from mars2d.output.layers.trails import (
    PROP_TRAIL_WIDTH,
    TRAIL_WIDTH,
    prop_trail_colors,
    trail_colors,
)
from mars2d.output.marks import MARKS
from mars2d.output.pages.replay import sensors
from mars2d.output.pages.replay.columns import Columns, Int, rounded
from mars2d.output.pages.replay.drawings import (
    Drawing,
    Flat,
    Float,
    flat,
    follows,
    kept_rows,
    pack,
    shapes_of,
)
from mars2d.output.pages.replay.sensors import Carried
from mars2d.record.contact import mean_forces
from mars2d.record.frame import Frame
from mars2d.record.interventions import leaps_of
from mars2d.record.marks import marks_of
from mars2d.scenario.animation import Animation

if TYPE_CHECKING:
    from mars2d.record.rows import Rows

ROOM = 1_380_000
"""The most bytes of all columns; as text they take a third more."""

POSES, PANEL = 480_000, 200_000
"""The most bytes of each; beyond, they are thinned. Sensors get the rest."""

LAYER_ROOM = {"addons": 240_000, "forces": 180_000}
OTHER_ROOM = 60_000
"""The most bytes of a layer."""

LAYER_ROWS = {"addons": 300, "theory": 100, "velocities": 500}
OTHER_ROWS = 2000
"""The most rows at which a layer is drawn, since it may take long."""

CROWD = 100_000
"""The most rows times bodies at which a layer of a crowd is drawn."""

FINE, TURN, COARSE, OF_SENSORS = 2**-20, 2 * np.pi / 2**16, 2**-18, 2**-14
"""Steps of positions, of headings [rad], of moving shapes, and of what sensors draw.

Those of lengths are shares of the view.
"""

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
        view = View.of(record, len(record) - 1)
        self.view = view
        self.size = max(view.width, view.height)
        self.columns = Columns()
        self.notes: list[str] = []
        self.kept = np.empty(0, dtype=np.int64)
        self.poses = np.empty((0, 3, 0))
        self.carried: list[Carried] = []

    def made(self) -> tuple[dict[str, Any], Columns]:
        """Return the data and the columns."""
        self._add_poses()
        header = self._about()
        header["bodies"] = self._bodies()
        header["readings"] = self._add_panel()
        header["marks"] = self._add_marks()
        header["layers"] = _table(self.scenario.animation)
        header["legends"] = [_legend(each) for each in legends(self.scenario)]
        header["longestArrow"] = MAX_ARROW
        header["drawn"] = self._add_layers()
        if self.record.drawn.shapes:
            self.notes.append("what add-ons drew while they ran is shown at the end alone")
        self._add_sensors(header["drawn"])
        header["notes"] = self.notes
        header["columns"] = self.columns.index
        return header, self.columns

    def _about(self) -> dict[str, Any]:
        record, scenario, view = self.record, self.scenario, self.view
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
            "view": [view.xmin, view.xmax, view.ymin, view.ymax],
            "grid": list(scenario.bounds) if bounded else None,
            "workspace": scenario.workspace is not None,
            "speed": scenario.animation.playback_speed,
            "slipping": SLIPPING,
            "lastBodies": LAST_BODIES,
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
        gaps = np.argwhere(_gaps(ways, poses, kept, self.size))
        leaps = [
            (int(np.searchsorted(kept, row)), body) for row, body in leaps_of(record.interventions)
        ]
        rows, bodies = np.array([*leaps, *gaps.tolist()], dtype=int).reshape(-1, 2).T
        columns.add("leaps:row", rows)
        columns.add("leaps:body", bodies)
        self.columns.take(columns)
        self.kept, self.poses = kept, poses[kept]
        self.carried = list(sensors.carried(record, self.kept))
        if len(self.kept) < len(record):
            self.notes.append(
                f"{len(self.kept)} of {len(record)} rows are in this file, more where bodies move"
            )
        if len(gaps):
            self.notes.append("paths have gaps where a body goes round a bend between two rows")

    def _bodies(self) -> list[dict[str, Any]]:
        """Return the robots and props: their names, their sizes, and how their paths look."""
        scenario = self.scenario
        robots, props, wake = scenario.robots, scenario.props, scenario.animation.wake_style
        kinds = (*(robot.drive for robot in robots), *props)
        colors = (*scenario.colors, *prop_colors(props))
        trails = [(color, TRAIL_WIDTH, wake) for color in trail_colors(scenario)]
        trails += [(color, PROP_TRAIL_WIDTH, "-") for color in prop_trail_colors(scenario)]
        bodies: list[dict[str, Any]] = [
            {
                "name": str(body.name),
                "kind": snake_case(type(kind).__name__).replace("_", " "),
                "robot": i < len(robots),
                "color": color,
                "bound": [*body.shape.bound[0], body.shape.bound[1]],
                "ring": RING if i < len(robots) and has_ring(scenario, i) else 0,
                "trail": trail,
            }
            for i, (body, kind, color, trail) in enumerate(
                zip(scenario.bodies, kinds, colors, trails, strict=True)
            )
        ]
        for robot, told in zip(robots, bodies, strict=False):
            told["commands"] = [[q.symbol, q.unit, q.kind] for q in robot.drive.inputs]
        return bodies

    # -- the panel ----------------------------------------------------------------------------

    def _add_panel(self) -> list[dict[str, Any]]:
        """Add commands, efforts and readings; return how the readings are said in words."""
        record = self.record
        command, effort = record.command[self.kept], record.effort[self.kept]
        step = max(float(np.abs(command).max(initial=0.0)), 1e-6) / 2**14

        def packed(every: int) -> tuple[Columns, list[dict[str, Any]], int]:
            columns = Columns()
            columns.add("command", rounded(command[::every], step), order=1, step=step, every=every)
            columns.add("effort", rounded(effort[::every], 1e-3), order=1, step=1e-3, every=every)
            readings, words = pack_readings(self.carried, every)
            columns.take(readings)
            return columns, words, len(command[::every])

        words: list[dict[str, Any]] = self._fit(
            "commands and readings in the panel", PANEL, packed
        )[0]
        return words

    def _add_marks(self) -> list[dict[str, Any]]:
        """Add the rows that have marks on the time bar; return which kinds there are."""
        kinds = []
        for kind, rows in marks_of(self.record).items():
            if rows:
                at = np.minimum(np.searchsorted(self.kept, rows), len(self.kept) - 1)
                self.columns.add(f"marks:{kind}", np.unique(at), order=1)
                kinds.append(kind)
        return [
            {"kind": kind, "above": mark.above, "below": mark.below, "meaning": mark.meaning}
            for kind, mark in MARKS.items()
            if kind in kinds
        ]

    # -- layers -------------------------------------------------------------------------------

    def _add_layers(self) -> dict[str, dict[str, Any]]:
        """Add all layers but those that the page makes of poses and readings; return headers."""
        headers: dict[str, dict[str, Any]] = {}
        moving = []
        for layer in LAYERS:
            if layer.shapes is None or layer.name in ("trails", "sensors"):
                continue
            if layer.stands:
                drawings = self._standing(layer)
            elif layer.each is not None:
                drawings = self._carried(layer)
            else:
                moving.append(layer)
                continue
            if drawings:
                columns, header, _ = pack(layer.name, drawings, 1, self.size * FINE)
                self.columns.take(columns)
                headers[layer.name] = header
        return headers | self._add_moving(moving)

    def _standing(self, layer: Layer) -> list[Drawing]:
        """Return a layer that stands still until the scenario is changed."""
        record = self.record
        changes = sorted({0, *(min(c.row, len(record) - 1) for c in record.changes)})
        rows = np.searchsorted(self.kept, changes, side="left").tolist()
        return [Drawing(rows, [_drawn(layer, record.frame(row)) for row in changes])]

    def _carried(self, layer: Layer) -> list[Drawing]:
        """Return a layer that depends on poses alone: for each body once, or by its heading."""
        assert layer.each is not None
        each, found = layer.each, []

        def at(body: int, pose: Float) -> Flat:
            scene = Scene()
            each(scene, self.scenario, body, pose)
            return flat(scene.shapes)

        for body in range(len(self.scenario.bodies)):
            here, there = at(body, np.zeros(3)), at(body, sensors.ELSEWHERE)
            if not here.styles:
                continue
            turned = follows(here, there, sensors.ELSEWHERE)
            if turned or follows(here, there, sensors.ELSEWHERE * (1, 1, 0)):
                found.append(Drawing([0], [here], body, upright=not turned))
                continue
            stride = -(-len(self.kept) // OTHER_ROWS)
            rows = range(0, len(self.kept), stride)
            headings = self.poses[rows, 2, body].tolist()
            scenes = [at(body, np.array([0.0, 0.0, theta])) for theta in headings]
            found.append(Drawing(rows, scenes, body, upright=True))
        return found

    def _add_moving(self, layers: list[Layer]) -> dict[str, dict[str, Any]]:
        """Add layers that are drawn row by row, at as many rows as there is room for."""
        count = len(self.kept)
        crowd = CROWD // len(self.scenario.bodies)
        most = {each.name: min(LAYER_ROWS.get(each.name, OTHER_ROWS), crowd) for each in layers}
        strides = {name: -(-count // max(rows, 1)) for name, rows in most.items()}
        scenes: dict[str, dict[int, Flat]] = {layer.name: {} for layer in layers}
        rows = {count - 1, *(k for stride in strides.values() for k in range(0, count, stride))}
        for row in sorted(rows):
            frame = self.record.frame(int(self.kept[row]))
            for layer in layers:
                if row % strides[layer.name] == 0 or row == count - 1:
                    scenes[layer.name][row] = _drawn(layer, frame)
        headers = {}
        for layer in layers:
            found = scenes[layer.name]
            if any(scene.styles for scene in found.values()):
                headers[layer.name] = self._add_rows(layer, found, strides[layer.name])
        return headers

    def _add_rows(self, layer: Layer, scenes: dict[int, Flat], stride: int) -> dict[str, Any]:
        """Add the scenes of a layer, by row; return their header.

        The contacts of the panel stand beside the arrows, so they are those of the same rows.
        """
        drawings = [Drawing([*scenes], [*scenes.values()])]

        def packed(every: int) -> tuple[Columns, dict[str, Any], int]:
            columns, header, most = pack(layer.name, drawings, every, self.size * COARSE)
            if layer.name == "forces" and len(self.record.contacts):
                columns.take(pack_contacts(self.record, self.kept, kept_rows(drawings[0], every)))
            return columns, header, most

        seen = any(scenes[row].styles for row in [*scenes][:-1])
        room = LAYER_ROOM.get(layer.name, OTHER_ROOM)
        header, every = self._fit(layer.title.lower() if seen else "", room, packed, stride)
        return {**header, "every": every, "leap": LEAP * self.size}

    def _add_sensors(self, drawn: dict[str, Any]) -> None:
        """Add what sensors draw to `drawn`, at as many rows as there is room for."""
        if self.record.missing:
            listed = ", ".join(self.record.missing)
            self.notes.append(f"not drawn, since their code is not in the record: {listed}")
        if not self.carried:
            return
        drawings, stride = sensors.drawings(self.carried, self.scenario.colors)
        header, every = self._fit(
            "what sensors draw",
            ROOM - self.columns.size - self.columns.beside,
            lambda every: pack("sensors", drawings, every, self.size * OF_SENSORS),
            stride,
        )
        drawn["sensors"] = {**header, "held": every}

    def _fit(
        self, what: str, room: int, pack: Callable[[int], tuple[Columns, Any, int]], stride: int = 1
    ) -> tuple[Any, int]:
        """Add columns of at most `room` bytes, and a note; return what is said of them, and stride.

        what: for the note; "" for none. pack: returns the columns of one row in so many, what is
        said of them, and the number of their rows. stride: the first to try; its multiples follow
        until the columns fit, or until one row is left.
        """
        times = 1
        while True:
            columns, told, rows = pack(times * stride)
            size = columns.size + columns.beside
            if size <= room or rows <= 1:
                break
            times = max(times + 1, int(times * size / max(room, 1)))
        every = times * stride
        self.columns.take(columns)
        if every > 1 and what:
            self.notes.append(f"{what}: one row in {every} of this file")
        return told, every


def _table(animation: Animation) -> list[dict[str, Any]]:
    """Return the layers for the page, the lowest first."""
    stand = standing()
    return [
        {
            "name": layer.name,
            "title": layer.title,
            "key": layer.key,
            "switch": layer.switch,
            "along": layer.along,
            "on": layer.at_first(animation),
            "stands": layer in stand,
        }
        for layer in LAYERS
    ]


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


def _gaps(ways: Float, poses: Float, kept: Int, size: float) -> NDArray[np.bool_]:
    """Return on the way to which kept rows a line would not do for a body's path, (R, n).

    A line does for a path that is less than a tenth longer, as an arc of less than 90 degrees is,
    or by less than a five hundredth of the view's size.
    """
    gone = np.diff(ways[kept], axis=0, prepend=ways[:1])
    line = np.hypot(*np.diff(poses[kept, :2], axis=0, prepend=poses[:1, :2]).swapaxes(0, 1))
    return np.asarray(gone - line > np.maximum(0.1 * gone, size / 500))


# -- the numbers in the panel ---------------------------------------------------------------------

MAX_NUMBERS = 8
"""The most numbers of a reading that is shown as text."""


def pack_contacts(record: Rows, kept: Int, shown: Sequence[int]) -> Columns:
    """Return the contacts of rows as columns, the strongest of each row.

    kept: the record's rows of the replay. shown: those of them that have arrows.
    """
    columns = Columns()
    strongest = force_scale(record.scenario).most
    rows = record.contact_rows
    place = np.searchsorted(kept, rows)
    at = np.minimum(place, len(kept) - 1)
    chosen = np.flatnonzero((kept[at] == rows) & np.isin(at, shown))
    contacts, at = record.contacts[chosen], at[chosen]
    size = np.linalg.norm(mean_forces(contacts, record.scenario.sampling_time), axis=1)
    order = np.lexsort((-size, at))
    rank = np.arange(len(order)) - np.searchsorted(at[order], at[order], side="left")
    order = order[(rank < MAX_CONTACTS) & (size[order] >= FAINTEST * strongest)]
    contacts, at, size = contacts[order], at[order], size[order]
    columns.add("contacts:shown", np.array(shown), order=1)
    columns.add("contacts:row", at, order=1)
    columns.add("contacts:a", contacts["a"].astype(int), order=1)
    columns.add("contacts:b", contacts["b"].astype(int), order=1)
    words, said = np.unique([in_newtons(each) for each in size.tolist()], return_inverse=True)
    columns.add("contacts:force", said, words=words.tolist())
    return columns


def pack_readings(sensors: list[Carried], every: int) -> tuple[Columns, list[dict[str, Any]]]:
    """Return the readings of few numbers as columns, and the names and units for their text."""
    columns = Columns()
    found: list[dict[str, Any]] = []
    for each in sensors:
        title, values, quantities = _said(each, each.readings[::every])
        if not 0 < values.shape[1] <= MAX_NUMBERS:
            continue
        finite = values[np.isfinite(values)]
        step = max(float(np.abs(finite).max(initial=0.0)), 1e-6) / 2**15
        name = f"reading{len(found)}"
        columns.add(name, rounded(values, step), order=1, step=step, every=every)
        found.append({
            "name": title,
            "robot": each.robot,
            "column": name,
            "parts": [[q.name, q.unit, q.kind] for q in quantities],
        })  # fmt: skip
    return columns, found


def _said(each: Carried, readings: NDArray[Any]) -> tuple[str, Float, list[Quantity]]:
    """Return a sensor's title, and its readings as numbers (R, m) to be read, with what each is.

    Of distances along many beams, the nearest and its direction.
    """
    sensor, values = each.sensor, readings.reshape(len(readings), -1).astype(float)
    fan, count = sensor.fan, values.shape[1]
    if fan is not None and count == len(fan.angles) > MAX_NUMBERS:
        near = values.argmin(axis=1)
        angles = sensor.mount[2] + np.asarray(fan.angles)[near]
        nearest = np.column_stack([values[np.arange(len(values)), near], angles])
        return f"{each.name}, nearest", nearest, [DISTANCE, ANGLE]
    stated = list(sensor.quantities) or [Quantity("value")]
    if count % len(stated) == 0 and len(stated) > 1:
        return each.name, values, stated * (count // len(stated))
    first = stated[0]
    if count == 1:
        return each.name, values, [first]
    each_one = [Quantity(f"{first.name} {k}", first.unit, first.kind) for k in range(count)]
    return each.name, values, each_one
