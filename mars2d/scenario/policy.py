"""Policies: laws that were learned, as ONNX files."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from mars2d.core.errors import InputError, LawError, Mars2dError, likely, nearest, one_line, shown
from mars2d.core.extras import extra
from mars2d.core.files import note_file
from mars2d.scenario.observation import SEEN, SENSED, Action, Observation, Part

SUFFIX = ".onnx"

KEY = "mars2d"
"""The key of the metadata of an ONNX file under which the spaces of its policy stand, as JSON."""


def describe(
    observation: Observation, action: Action, drive: str, experiment: str = "", robot: str = ""
) -> str:
    """Return the metadata of a policy, as JSON: its observation, its action, the drive's name.

    experiment, robot: where it was learned, so that `mars2d check` can try it there.
    """
    described = {
        "observation": [part._asdict() for part in observation.parts],
        "action": action._asdict(),
        "drive": drive,
        "experiment": experiment,
        "robot": robot,
    }
    return json.dumps(described)


class Policy:
    """A law that was learned: a network from observations to commands, read from an ONNX file.

    It has no memory: copies of it are itself. Its network takes one input (1, k), float32, and
    returns an action (1, m), from -1 for the least command that it was learned with to 1 for the
    largest. The file's metadata say which observation and commands these are, see `mars2d.rl`.
    """

    def __init__(self, file: Path, read: Callable[[str], bytes] | None = None) -> None:
        """Read a file, by a function if it is given.

        Raises InputError, which names the file, and MissingExtraError.
        """
        note_file(file)
        self.file = file
        self.__name__ = file.stem
        with extra("rl", f"{file.name}: a learned law needs onnxruntime"):
            import onnxruntime
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = options.inter_op_num_threads = 1  # the same bits everywhere
        options.log_severity_level = 4
        try:
            self._session = onnxruntime.InferenceSession(
                read(str(file)) if read else file.read_bytes(),
                options,
                providers=["CPUExecutionProvider"],
            )
        except Exception as error:  # of many kinds, of the library's own
            raise InputError(f"{file}: no network in the format ONNX: {one_line(error)}") from error
        self._take(self._session.get_modelmeta().custom_metadata_map)

    def _take(self, metadata: dict[str, str]) -> None:
        """Take the spaces of its metadata, and compare them with those of the network."""
        hint = "; mars2d.rl's environments have them as `policy_metadata`"
        if KEY not in metadata:
            self._refuse(f"has no metadata {KEY!r} with its spaces{likely(KEY, metadata)}{hint}")
        try:
            given = json.loads(metadata[KEY])
            self.drive, action = str(given["drive"]), given["action"]
            low, high = (tuple(map(float, action[end])) for end in ("low", "high"))
            self.action = Action(low, high)
            self.experiment, self.robot = str(given["experiment"]), str(given["robot"])
            parts = [
                Part(each["name"], *(tuple(map(float, each[end])) for end in ("low", "high")))
                for each in given["observation"]
            ]
        except (ValueError, TypeError, KeyError):
            self._refuse(f"has metadata {KEY!r} that can't be read{hint}")
        for name in (part.name for part in parts):
            if name not in SEEN and not name.startswith(SENSED):
                self._refuse(f"its observation has a part {name!r}{nearest(name, SEEN)}")
        self.observation = Observation(parts)
        taken, made = self._session.get_inputs(), self._session.get_outputs()[0]
        size = len(self.observation.low)
        if [(each.type, each.shape[-1]) for each in taken] != [("tensor(float)", size)]:
            found = ", ".join(f"{each.type} {each.shape}" for each in taken)
            self._refuse(f"takes {found}; its metadata say one tensor(float) [1, {size}]")
        if made.shape[-1] != len(self.action.low):
            self._refuse(f"returns {made.shape}, expected an action [1, {len(self.action.low)}]")
        self._input = taken[0].name

    def _refuse(self, why: str) -> NoReturn:
        raise InputError(f"{self.file}: {why}")

    def __deepcopy__(self, memo: dict[int, Any]) -> Policy:
        return self

    def __call__(self, robot: Any) -> tuple[float, ...]:
        """Return the command for a robot's present observation.

        Raises LawError for a robot with another drive, or another observation.
        """
        if getattr(robot.memory, "_fits", None) is not self:
            self._check(robot)
        (result, *_) = self._session.run(None, {self._input: self.observation(robot)[None]})
        shares = result[0].tolist()
        if not np.isfinite(shares).all():
            raise LawError(f"{self.file.name} returned {shown(tuple(shares))}: expected numbers")
        return self.action(shares)

    def _check(self, robot: Any) -> None:
        """Raise LawError unless a robot has the drive and the parts that it was learned with."""
        drive = type(robot.drive).__name__
        if drive != self.drive:
            problem = f"commands a {self.drive}, and {robot.name} is a {drive}"
            raise LawError(f"{self.file.name} {problem}")
        try:
            self.observation.check(robot)
        except (Mars2dError, IndexError, ValueError) as error:
            names = ", ".join(part.name for part in self.observation.parts)
            problem = f"does not fit: it observes {names}; {one_line(error)}"
            raise LawError(f"{self.file.name} {problem}") from error
        robot.memory._fits = self
