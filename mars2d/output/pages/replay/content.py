"""All that a replay shows, as plain data and columns."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mars2d.addons.base import Addon
from mars2d.bodies.drives.base import Drive
from mars2d.core.description import snake_case
from mars2d.core.errors import ordinal
from mars2d.core.quantity import UNKNOWN
from mars2d.core.scene import Scene, faded
from mars2d.output.figures.extent import View
from mars2d.output.figures.rows import check_rows
from mars2d.output.layers import parts as scenes
from mars2d.output.layers.bodies import draw_prop, draw_robot, prop_colors
from mars2d.output.layers.forces import force_scale
from mars2d.output.layers.names import FEW
from mars2d.output.pages.replay import sensors
from mars2d.output.pages.replay.columns import Columns, Int, fitted, rounded
from mars2d.output.pages.replay.contacts import pack_contacts, pack_messages
from mars2d.output.pages.replay.drawings import Drawing, pack
from mars2d.output.pages.replay.shapes import Float, flat, plain_shapes
from mars2d.record.frame import Frame

if TYPE_CHECKING:
    from mars2d.record.record import Record

__all__ = ["content_of"]

ROWS = 20_000
"""A replay has so many rows at most."""

ALL = 1_380_000
"""Bytes for all columns: as text they are a third more."""

POSES, PANEL, CONTACTS, MESSAGES = 480_000, 200_000, 120_000, 60_000
"""Bytes of these at most, before they are thinned; sensors have what is left of all."""

FINE, TURN, COARSE = 2**-20, 2 * np.pi / 2**16, 2**-18
"""Steps of positions and of what is drawn, in shares of the view; of headings, radians."""

LEAP = 0.12
"""What add-ons draw moves evenly between rows, or leaps: by more than this share of the view."""


class _Layer(NamedTuple):
    """What add-ons have drawn of frames.

    method: of an add-on, which draws it. part: returns what all draw of a frame. most: at how many
    rows it is drawn, since it may take long. room: bytes. words: what it is called.
    """

    name: str
    method: Callable[..., None]
    part: Callable[[Frame], Scene]
    most: int
    room: int
    words: str


ADDONS = _Layer("addons", Addon.draw, scenes.addons, 300, 240_000, "what add-ons draw")
THEORY = _Layer("theory", Addon.theory, scenes.theory, 100, 60_000, "theory")


def content_of(record: Record) -> tuple[dict[str, Any], Columns]:
    """Return what a replay shows: plain data, and columns of numbers.

    Raises InputError for a record without rows.
    """
    check_rows(record, "replay")
    return _Content(record).made()


class _Content:
    """Puts a replay together, piece by piece, and notes what it shows less of."""

    def __init__(self, record: Record) -> None:
        self.record, self.scenario = record, record.scenario
        view = View.of(record, len(record) - 1)
        self.view = view
        self.size = max(view.width, view.height)
        self.columns = Columns()
        self.notes: list[str] = []
        self.stride = 1
        self.kept = np.empty(0, dtype=np.int64)
        self.fans: list[sensors.Fan] = []
        self.others: list[sensors.Carried] = []

    def made(self) -> tuple[dict[str, Any], Columns]:
        """Return the data and the columns."""
        self._add_poses()
        header = self._about()
        header |= {"bodies": self._bodies(), "ties": self._ties()}
        header["readings"] = self._add_panel()
        self._add_contacts()
        self._add_messages()
        header["ground"] = self._add_ground()
        header["addons"] = self._add_drawn(ADDONS, at_end=bool(self.record.drawn.shapes))
        header["theory"] = self._add_drawn(THEORY)
        if self.record.drawn.shapes:
            self.notes.append("what add-ons drew while they ran is shown at the end alone")
        header |= self._add_sensors()
        header["notes"] = self.notes
        header["columns"] = self.columns.index
        return header, self.columns

    def _about(self) -> dict[str, Any]:
        record, scenario, view = self.record, self.scenario, self.view
        looks = scenario.animation
        force = force_scale(scenario)
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
            "layers": {
                "grid": looks.grid,
                "trails": looks.wake,
                "contacts": looks.forces,
                "theory": looks.theory,
            },
            "starts": looks.show_initial_pose,
            "wake": looks.wake_style,
            "speed": looks.playback_speed,
            "force": force._asdict(),
            "crowd": len(scenario.bodies) > FEW,
        }

    # -- what moves ---------------------------------------------------------------------------

    def _add_poses(self) -> None:
        """Add the poses of all bodies, at as many rows as there is room for, and keep these."""
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
        while len(record) / first > ROWS:
            first *= 2
        columns, self.stride = fitted(POSES, packed, first)
        self.kept = _rows(len(record), self.stride)
        self.columns.take(columns)
        carried = list(sensors.carried(record, self.kept))
        self.fans = [each for each in carried if isinstance(each, sensors.Fan)]
        self.others = [each for each in carried if not isinstance(each, sensors.Fan)]
        if self.stride > 1:
            which = f"every {ordinal(self.stride)} row of {len(record)}"
            self.notes.append(f"{which} is in this file, and the last one")

    def _poses(self, rows: Int) -> Float:
        """Return the poses of all bodies at some rows, (R, 3, n + p)."""
        record = self.record
        return np.concatenate([record.pose[rows], record.prop_pose[rows]], axis=2)

    def _bodies(self) -> list[dict[str, Any]]:
        """Return the robots and props: what they are called, and how they look at the origin."""
        scenario, here, found = self.scenario, np.zeros(3), []
        step = self.size * FINE
        for robot, color in zip(scenario.robots, scenario.colors, strict=True):
            looks = []
            for fill, stroke in ((color, "#ffffff"), (None, faded(color, 0.8))):
                scene = Scene()
                if scenario.animation.show_real_shape:
                    draw_robot(scene, robot, here, fill, stroke)
                else:
                    scene.circle((0, 0), 0.0, fill=fill, stroke=stroke, pixels=5.0)
                looks.append(plain_shapes(flat(scene.shapes), step))
            found.append({
                "name": str(robot.name),
                "kind": snake_case(type(robot.drive).__name__).replace("_", " "),
                "robot": True,
                "color": color,
                "filled": looks[0],
                "hollow": looks[1],
                "bound": [*robot.chassis.bound[0], robot.chassis.bound[1]],
                "start": list(robot.pose),
                "commands": _commands(robot.drive),
            })  # fmt: skip
        for prop, color in zip(scenario.props, prop_colors(scenario.props), strict=True):
            looks = []
            for hollow in (False, True):
                scene = Scene()
                draw_prop(scene, prop, here, color, hollow=hollow)
                looks.append(plain_shapes(flat(scene.shapes), step))
            found.append({
                "name": str(prop.name),
                "kind": snake_case(type(prop).__name__).replace("_", " "),
                "robot": False,
                "color": color,
                "filled": looks[0],
                "hollow": looks[1],
                "bound": [*prop.shape.bound[0], prop.shape.bound[1]],
                "start": list(prop.pose),
            })  # fmt: skip
        return found

    def _ties(self) -> list[dict[str, Any]]:
        if self.scenario.physics != "contact":
            return []
        return [
            {
                "kind": snake_case(type(tie.joint).__name__),
                "a": tie.a,
                "b": tie.b,
                "from": list(tie.joint.anchor_a),
                "to": list(tie.joint.anchor_b),
                "length": tie.length,
            }
            for tie in self.scenario.ties
        ]

    # -- what is said of bodies ---------------------------------------------------------------

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
            readings, words[:] = sensors.pack_readings(self.others, every)
            columns.take(readings)
            return columns, len(command[::every])

        columns, every = fitted(PANEL, packed)
        self.columns.take(columns)
        self._note("commands and readings in the panel", every)
        return words

    def _add_contacts(self) -> None:
        if not len(self.record.contacts):
            return
        step = self.size * COARSE

        def packed(every: int) -> tuple[Columns, int]:
            return pack_contacts(self.record, self.kept, every, step)

        columns, every = fitted(CONTACTS, packed)
        self.columns.take(columns)
        self._note("contacts", every)

    def _add_messages(self) -> None:
        if not len(self.record.messages):
            return

        def packed(every: int) -> tuple[Columns, int]:
            return pack_messages(self.record, every)

        columns, every = fitted(MESSAGES, packed)
        self.columns.take(columns)
        if every > 1:
            self.notes.append(f"one message in {every} is in this file")

    # -- what is drawn ------------------------------------------------------------------------

    def _add_ground(self) -> dict[str, Any]:
        """Add what stands still until it is changed: the workspace, the floor and the obstacles."""
        record = self.record
        changes = sorted({0, *(min(c.row, len(record) - 1) for c in record.changes)})
        rows = np.searchsorted(self.kept, changes, side="left").tolist()
        parts = (scenes.workspace, scenes.floor, scenes.obstacles)
        drawings = [
            Drawing(rows, [flat(part(record.scenario_at(row)).shapes) for row in changes])
            for part in parts
        ]
        columns, header, _ = pack("ground", drawings, 1, self.size * FINE)
        self.columns.take(columns)
        return header

    def _add_drawn(self, layer: _Layer, *, at_end: bool = False) -> dict[str, Any] | None:
        """Add what the add-ons draw of frames; at_end: at the last one, whether they do or not."""
        last = len(self.kept) - 1
        scenarios = [self.scenario, *(change.scenario for change in self.record.changes)]
        draws = any(
            getattr(type(addon), layer.method.__name__) is not layer.method
            for scenario in scenarios
            for addon in scenario.addons
        )
        stride = -(-len(self.kept) // layer.most)
        rows = sorted({*range(0, last + 1, stride), last}) if draws else [last] if at_end else []
        if not rows:
            return None
        frames = (self.record.frame(int(self.kept[row])) for row in rows)
        drawings = [Drawing(rows, [flat(layer.part(frame).shapes) for frame in frames])]
        headers: list[dict[str, Any]] = []

        def packed(every: int) -> tuple[Columns, int]:
            columns, header, most = pack(layer.name, drawings, every, self.size * COARSE)
            headers.append(header)
            return columns, most

        columns, every = fitted(layer.room, packed)
        self.columns.take(columns)
        if draws:
            self._note(layer.words, max(every, stride))
        return {**headers[-1], "every": max(every, stride), "leap": LEAP * self.size}

    def _add_sensors(self) -> dict[str, Any]:
        """Add what the sensors draw: distances along beams as such, all else as shapes."""
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

        room = ALL - self.columns.size
        if others:
            columns, every = fitted(room // 2 if fans else room, packed)
            self.columns.take(columns)
            self._note("what sensors draw", max(every, stride))
        if fans:
            room = ALL - self.columns.size
            columns, every = fitted(room, lambda every: sensors.pack_fans(fans, every))
            self.columns.take(columns)
            self._note("distances of scanners", every)
            self.notes += sensors.beams_left_out(fans)
        return {"sensors": headers[-1] if headers else None, "fans": sensors.fans_of(fans)}

    def _note(self, what: str, every: int) -> None:
        if every > 1:
            self.notes.append(f"{what}: one row in {every} of this file")


def _rows(count: int, every: int) -> Int:
    """Return each so-manieth row, and the last one."""
    return np.unique(np.append(np.arange(0, count, every), count - 1))


def _commands(drive: Drive) -> list[list[str]]:
    """Return the names, units and kinds of the two numbers of a drive's command."""
    quantities = drive.quantities or UNKNOWN
    return [[quantity.symbol, quantity.unit, quantity.kind] for quantity in quantities]
