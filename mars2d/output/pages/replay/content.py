"""The content of a replay, as plain data and columns."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mars2d.bodies.colors import prop_colors
from mars2d.core.description import snake_case
from mars2d.core.errors import ordinal
from mars2d.core.quantity import UNKNOWN, Quantity
from mars2d.core.scene import Scene
from mars2d.output.figures.extent import View, check_rows
from mars2d.output.layers.arrows import MAX_ARROW
from mars2d.output.layers.forces import (
    FAINTEST,
    MAX_CONTACTS,
    SLIPPING,
    as_read,
    force_scale,
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
from mars2d.output.marks import MARKS, Mark
from mars2d.output.pages.replay import sensors
from mars2d.output.pages.replay.columns import Columns, Int, fitted, rounded
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
from mars2d.scenario.robot import Robot
from mars2d.sensors.base import Sensor

if TYPE_CHECKING:
    from mars2d.record.rows import Rows

MAX_ROWS = 20_000
"""The most rows of a replay."""

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

FINE, TURN, COARSE = 2**-20, 2 * np.pi / 2**16, 2**-18
"""Steps of positions and of moving shapes, in shares of the view; of headings, radians."""

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
        self.stride = 1
        self.kept = np.empty(0, dtype=np.int64)
        self.fans: list[sensors.Carried] = []
        self.others: list[sensors.Carried] = []

    def made(self) -> tuple[dict[str, Any], Columns]:
        """Return the data and the columns."""
        self._add_poses()
        header = self._about()
        header["bodies"] = self._bodies()
        header["leaps"] = self._leaps()
        header["readings"] = self._add_panel()
        header["marks"] = self._add_marks()
        header["layers"] = _table(self.scenario.animation)
        header["legends"] = [_legend(each) for each in legends(self.scenario)]
        header["longestArrow"] = MAX_ARROW
        header["drawn"] = self._add_layers()
        if self.record.drawn.shapes:
            self.notes.append("what add-ons drew while they ran is shown at the end alone")
        header |= self._add_sensors(header["drawn"])
        header["notes"] = self.notes
        header["columns"] = self.columns.index
        return header, self.columns

    def _about(self) -> dict[str, Any]:
        record, scenario, view = self.record, self.scenario, self.view
        bounded = scenario.workspace is not None and scenario.on_exit != "ignore"
        return {
            "title": scenario.title,
            "file": Path(record.filename).name,
            "seed": record.seed,
            "digest": record.digest,
            "versions": dict(record.versions),
            "over": record.over_message,
            "finished": record.finished,
            "changed": len(record.interventions),
            "step": scenario.sampling_time,
            "stride": self.stride,
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
        record = self.record
        step = self.size * FINE
        low = np.array([self.view.xmin, self.view.ymin])
        turned = (record.pose[:, 2], record.prop_pose[:, 2])
        most = max(max(part.max(initial=0.0), -part.min(initial=0.0)) for part in turned)
        turn = max(TURN, float(most) * 2**-27)

        def packed(every: int) -> tuple[Columns, int]:
            rows = _rows(len(record), every)
            columns = Columns()
            poses = self._poses(rows)
            places = rounded(poses[:, :2] - low[:, None], step)
            columns.add("places", places, order=2, step=step, low=low.tolist())
            columns.add("headings", rounded(poses[:, 2], turn), order=2, step=turn)
            return columns, len(rows)

        first = 1
        while len(record) / first > MAX_ROWS:
            first *= 2
        columns, self.stride = fitted(POSES, packed, first)
        self.kept = _rows(len(record), self.stride)
        self.columns.take(columns)
        carried = list(sensors.carried(record, self.kept))
        self.fans = [each for each in carried if each.is_fan]
        self.others = [each for each in carried if not each.is_fan]
        if self.stride > 1:
            which = f"every {ordinal(self.stride)} row of {len(record)}"
            self.notes.append(f"{which} is in this file, and the last one")

    def _poses(self, rows: Int) -> Float:
        """Return the poses of all bodies at some rows, (R, 3, n + p)."""
        record = self.record
        return np.concatenate([record.pose[rows], record.prop_pose[rows]], axis=2)

    def _bodies(self) -> list[dict[str, Any]]:
        """Return the robots and props: their names, their sizes, and how their paths look."""
        scenario = self.scenario
        wake, colors = scenario.animation.wake_style, prop_colors(scenario.props)
        robots = [
            {
                "name": str(robot.name),
                "kind": _in_words(robot.drive),
                "robot": True,
                "color": color,
                "bound": [*robot.chassis.bound[0], robot.chassis.bound[1]],
                "ring": RING if has_ring(scenario, i) else 0,
                "trail": [trail, TRAIL_WIDTH, wake],
                "commands": commands_of(robot),
            }
            for i, (robot, color, trail) in enumerate(
                zip(scenario.robots, scenario.colors, trail_colors(scenario), strict=True)
            )
        ]
        props = [
            {
                "name": str(prop.name),
                "kind": _in_words(prop),
                "robot": False,
                "color": color,
                "bound": [*prop.shape.bound[0], prop.shape.bound[1]],
                "trail": [trail, PROP_TRAIL_WIDTH, "-"],
            }
            for prop, color, trail in zip(
                scenario.props, colors, prop_trail_colors(scenario), strict=True
            )
        ]
        return robots + props

    def _leaps(self) -> list[list[int]]:
        """Return where bodies were put elsewhere: the first kept row after it, and the body."""
        leaps = leaps_of(self.record.interventions)
        return [[int(np.searchsorted(self.kept, row)), body] for row, body in leaps]

    # -- the panel ----------------------------------------------------------------------------

    def _add_panel(self) -> list[dict[str, Any]]:
        """Add commands, efforts and readings; return how the readings are said in words."""
        record = self.record
        command, effort = record.command[self.kept], record.effort[self.kept]
        step = max(float(np.abs(command).max(initial=0.0)), 1e-6) / 2**14
        words: list[dict[str, Any]] = []

        def packed(every: int) -> tuple[Columns, int]:
            columns = Columns()
            columns.add("command", rounded(command[::every], step), order=1, step=step, every=every)
            columns.add("effort", rounded(effort[::every], 1e-3), order=1, step=1e-3, every=every)
            readings, words[:] = pack_readings(self.others, every)
            columns.take(readings)
            return columns, len(command[::every])

        columns, every = fitted(PANEL, packed)
        self.columns.take(columns)
        self._note("commands and readings in the panel", every)
        return words

    def _add_marks(self) -> list[dict[str, str]]:
        """Add the rows that have marks on the time bar; return which kinds there are."""
        kinds = []
        for kind, rows in marks_of(self.record).items():
            if rows:
                at = np.minimum(np.searchsorted(self.kept, rows), len(self.kept) - 1)
                self.columns.add(f"marks:{kind}", np.unique(at), order=1)
                kinds.append(kind)
        return [{"kind": kind, **_place_of(MARKS[kind])} for kind in MARKS if kind in kinds]

    # -- layers -------------------------------------------------------------------------------

    def _add_layers(self) -> dict[str, dict[str, Any]]:
        """Add all layers but those that the page makes of poses and readings; return headers."""
        headers: dict[str, dict[str, Any]] = {}
        moving = []
        for layer in LAYERS:
            if layer.shapes is None or layer.name in ("trails", "sensors"):
                continue
            if layer.stands:
                headers[layer.name] = self._pack(layer, self._standing(layer), FINE, 1)
            elif layer.each is not None:
                drawings = self._carried(layer)
                if drawings:
                    headers[layer.name] = self._pack(layer, drawings, FINE, 1)
            else:
                moving.append(layer)
        return headers | self._add_moving(moving)

    def _pack(
        self, layer: Layer, drawings: list[Drawing], step: float, every: int
    ) -> dict[str, Any]:
        """Add drawings of a layer; return their header."""
        columns, header, _ = pack(layer.name, drawings, every, self.size * step)
        self.columns.take(columns)
        return header

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
            headings = self._poses(self.kept[rows])[:, 2, body].tolist()
            scenes = [at(body, np.array([0.0, 0.0, theta])) for theta in headings]
            found.append(Drawing(rows, scenes, body, upright=True))
        return found

    def _add_moving(self, layers: list[Layer]) -> dict[str, dict[str, Any]]:
        """Add layers that are drawn row by row, at as many rows as there is room for."""
        last = len(self.kept) - 1
        crowd = CROWD // len(self.scenario.bodies)
        most = {each.name: min(LAYER_ROWS.get(each.name, OTHER_ROWS), crowd) for each in layers}
        strides = {name: -(-len(self.kept) // max(rows, 1)) for name, rows in most.items()}
        scenes: dict[str, dict[int, Flat]] = {layer.name: {} for layer in layers}
        for row in range(last + 1):
            due = [each for each in layers if row % strides[each.name] == 0 or row == last]
            if due:
                frame = self.record.frame(int(self.kept[row]))
                for layer in due:
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
        headers: list[dict[str, Any]] = []

        def packed(every: int) -> tuple[Columns, int]:
            columns, header, most = pack(layer.name, drawings, every, self.size * COARSE)
            headers.append(header)
            if layer.name == "forces" and len(self.record.contacts):
                columns.take(pack_contacts(self.record, self.kept, kept_rows(drawings[0], every)))
            return columns, most

        columns, every = fitted(LAYER_ROOM.get(layer.name, OTHER_ROOM), packed, stride)
        self.columns.take(columns)
        if any(scenes[row].styles for row in [*scenes][:-1]):
            self._note(layer.title.lower(), every)
        return {**headers[-1], "every": every, "leap": LEAP * self.size}

    def _add_sensors(self, drawn: dict[str, Any]) -> dict[str, Any]:
        """Add the sensors: distances along beams as such, the shapes of others to `drawn`."""
        record = self.record
        fans, others = self.fans, self.others
        if record.missing:
            listed = ", ".join(record.missing)
            self.notes.append(f"not drawn, since their code is not in the record: {listed}")
        drawings, stride = sensors.drawings(others, self._poses(self.kept), self.scenario.colors)
        headers: list[dict[str, Any]] = []

        def packed(every: int) -> tuple[Columns, int]:
            columns, header, most = pack("sensors", drawings, every, self.size * COARSE)
            headers.append(header)
            return columns, most

        room = ROOM - self.columns.size - self.columns.beside
        if others:
            columns, every = fitted(room // 2 if fans else room, packed)
            self.columns.take(columns)
            self._note("what sensors draw", max(every, stride))
            drawn["sensors"] = headers[-1]
        if fans:
            room = ROOM - self.columns.size - self.columns.beside
            columns, every = fitted(room, lambda every: sensors.pack_fans(fans, every))
            self.columns.take(columns)
            self._note("distances of scanners", every)
            self.notes += sensors.beams_left_out(fans)
        return {"fans": sensors.fans_of(fans, self.scenario.colors)}

    def _note(self, what: str, every: int) -> None:
        if every > 1:
            self.notes.append(f"{what}: one row in {every} of this file")


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


def _place_of(mark: Mark) -> dict[str, Any]:
    return {"above": mark.above, "below": mark.below, "meaning": mark.meaning}


def _legend(legend: Legend) -> dict[str, Any]:
    """Return a legend for the page: its arrow at all round numbers, and its signs."""
    ruler = legend.ruler
    return {
        "layer": legend.layer,
        "arrow": ruler and ["arrow", ruler.color, None, ruler.width],
        "lengths": ruler.lengths if ruler else [],
        "signs": [
            {"room": sign.room, "meaning": sign.meaning, "shapes": shapes_of(sign.scene)}
            for sign in legend.signs
        ],
    }


def _drawn(layer: Layer, frame: Frame) -> Flat:
    assert layer.shapes is not None
    return flat(layer.shapes(frame).shapes)


def _in_words(part: object) -> str:
    """Return the kind of a part, in words."""
    return snake_case(type(part).__name__).replace("_", " ")


def _rows(count: int, every: int) -> Int:
    """Return one row in `every`, and the last one."""
    return np.unique(np.append(np.arange(0, count, every), count - 1))


# -- the numbers in the panel ---------------------------------------------------------------------

NEWTON = 0.01
"""The step of forces, newtons: the last digit with which they are read."""

MAX_NUMBERS = 8
"""The most numbers of a reading that is shown as text."""


def commands_of(robot: Robot) -> list[list[str]]:
    """Return the names, units and kinds of the two numbers of a robot's command."""
    quantities = robot.drive.quantities or UNKNOWN
    return [[quantity.symbol, quantity.unit, quantity.kind] for quantity in quantities]


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
    said = np.array([as_read(each) for each in size.tolist()])
    columns.add("contacts:force", rounded(said, NEWTON), order=1, step=NEWTON)
    return columns


def pack_readings(sensors: list[Carried], every: int) -> tuple[Columns, list[dict[str, Any]]]:
    """Return the readings of few numbers as columns, and the names and units for their text."""
    columns = Columns()
    found: list[dict[str, Any]] = []
    for each in sensors:
        values = each.readings[::every].reshape(len(each.readings[::every]), -1).astype(float)
        if not 0 < values.shape[1] <= MAX_NUMBERS:
            continue
        finite = values[np.isfinite(values)]
        step = max(float(np.abs(finite).max(initial=0.0)), 1e-6) / 2**15
        name = f"reading{len(found)}"
        columns.add(name, rounded(values, step), order=1, step=step, every=every)
        found.append({
            "name": each.name,
            "robot": each.robot,
            "column": name,
            "parts": [_part(q) for q in _quantities(each.sensor, values.shape[1])],
        })  # fmt: skip
    return columns, found


def _quantities(sensor: Sensor, count: int) -> list[Quantity]:
    """Return the quantity of each number of a reading."""
    stated = list(sensor.quantities) or [Quantity("value")]
    if count % len(stated) == 0 and len(stated) > 1:
        return stated * (count // len(stated))
    first = stated[0]
    if count == 1:
        return [first]
    return [Quantity(f"{first.name} {k}", first.unit, first.kind) for k in range(count)]


def _part(quantity: Quantity) -> list[str]:
    return [quantity.name, quantity.unit, quantity.kind]
