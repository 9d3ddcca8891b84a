"""Check an add-on: its hooks, obstacles, beacons and seeds, and that drawing changes nothing."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from mars2d.addons.base import HOOKS, Addon
from mars2d.core import checks
from mars2d.core.deadline import Deadline
from mars2d.core.errors import InputError, shown
from mars2d.core.plane import rectangle
from mars2d.core.scene import Scene
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.base import Sensor
from mars2d.testing.common import (
    KEEP,
    check_fields,
    check_finite,
    check_methods,
    check_places,
    check_repeatable,
    first_run,
    is_own,
    run_ended,
    with_methods,
)
from mars2d.testing.finding import Finding, Notes, Report, at, judge
from mars2d.testing.state import Places, fingerprint
from mars2d.testing.trial import Run, Trial, changes, difference, prints, shepherd, small_world
from mars2d.world.world import World

METHODS = {
    "on_start": ("world",),
    "on_step": ("world",),
    "on_sensed": ("world",),
    "on_draw": ("world", "scene"),
    "on_stop": ("world",),
    "obstacles": (),
    "beacons": (),
    "ground": ("point",),
    "paint": ("scene", "area"),
    "draw": ("scene", "frame"),
    "theory": ("scene", "frame"),
}
"""The methods that an add-on can define, with their arguments."""


def check_addon(
    addon: Addon, *, sensors: Sequence[Sensor] = (), scenario: Scenario | None = None
) -> None:
    """Try an add-on, and raise CheckError, which lists everything that is wrong with it.

    The add-on runs for 50 control steps in a small world with robots that carry `sensors`, or in a
    `scenario`. The check reports exceptions in its hooks, random numbers from shared generators,
    drawing that changes the run, and runs that differ with the same seed.

    >>> from mars2d.addons import Map
    >>> check_addon(Map([[(0, 0), (0, 1)]]))
    """
    found = addon_findings(addon, sensors=sensors, scenario=scenario)
    judge(f"add-on {type(addon).__name__}", found)


def addon_findings(
    addon: Addon,
    *,
    sensors: Sequence[Sensor] = (),
    scenario: Scenario | None = None,
    control: Callable[[Any], Any] | None = None,
    deadline: Deadline | None = None,
) -> tuple[Finding, ...]:
    """Return the findings of `check_addon`, including hints.

    control: the law of the scenario's team. deadline: the limit of each control step.
    """
    checks.instance(Addon, "Map([...])")("check_addon(addon)", addon)
    subject = _Subject(addon)
    places = Places(type(addon))
    copies = check_fields(addon, Addon, subject.notes)
    if subject.can_be_called() and copies:
        with deadline or Deadline() as limit:
            place = partial(subject.placed, sensors)
            done = first_run(place, scenario, control, subject.look, limit, subject.notes)
            if done is not None:
                # Everything else in the small world is known to be repeatable.
                own = ("",) if scenario is None else (f"add-on {addon.key}.",)
                check_repeatable(*done, places, subject.notes, own)
                subject.check_drawing(*done)
    check_places(places, subject.notes)
    return subject.report.findings


class _Subject:
    """The add-on on trial, and the observations so far."""

    def __init__(self, addon: Addon) -> None:
        self.addon, self.kind = addon, type(addon)
        self.report = Report()
        own = "self.rng, the add-on's own stream"
        self.notes = Notes(self.kind.__name__, self.report, own, KEEP)
        self._outlines = ""
        self._painted: set[str] = set()  # attributes that on_draw sets

    def can_be_called(self) -> bool:
        """Report methods that can't be called; return whether it can be tried."""
        return check_methods(self.addon, Addon, METHODS, self.notes)

    def placed(
        self,
        sensors: Sequence[Sensor],
        scenario: Scenario | None,
        control: Callable[[Any], Any] | None,
    ) -> tuple[Scenario, Callable[[Any], Any] | None]:
        """Return the scenario for the trial, and the law of its team."""
        hooks = [hook for hook in HOOKS if is_own(self.addon, hook, Addon)]
        witness = with_methods(self.addon, {hook: partial(self.call, hook) for hook in hooks})
        self._outlines = self._standing(witness)
        if scenario is None:
            return self._somewhere(sensors, witness), shepherd
        keys = [addon.key for addon in scenario.addons]
        addons = [witness if each.key == witness.key else each for each in scenario.addons]
        return scenario.replace(
            addons=[*addons, *([] if witness.key in keys else [witness])]
        ), control

    def _somewhere(self, sensors: Sequence[Sensor], witness: Addon) -> Scenario:
        """Return a small world with the add-on; moved and without walls if obstacles are in it."""
        try:
            return small_world(sensors, [witness])
        except InputError:
            elsewhere = small_world(sensors)
            xmax = max(
                (x for outline in checks.outlines("obstacles()", witness.obstacles())
                 for x, _ in outline), default=0.0,
            )  # fmt: skip
            robots = [r.at(r.pose[0] + xmax + 3, *r.pose[1:]) for r in elsewhere.robots]
            props = [
                prop.replace(pose=(prop.pose[0] + xmax + 3, *prop.pose[1:]))
                for prop in elsewhere.props
            ]
            return elsewhere.replace(
                robots=robots, props=props, workspace=None, on_exit="ignore", addons=[witness]
            )

    def _standing(self, live: Addon) -> str:
        """Return a fingerprint of its current obstacles; raise if they are not outlines."""
        with self.notes.calling("obstacles", self.kind.obstacles, None):
            found = self.kind.obstacles(live)
        return fingerprint(checks.outlines(f"{self.notes.name}.obstacles()", found))

    # -- called by the witness ------------------------------------------------------------------

    def call(self, hook: str, live: Addon, world: World, *more: Any) -> None:
        """Call a hook, and check its effects."""
        function = getattr(self.kind, hook)
        with self.notes.calling(hook, function, world.time):
            if hook != "on_draw":
                function(live, world)
                return
            before, stream = prints(world, live.key), fingerprint(live.rng)
            mine = {name: fingerprint(value) for name, value in vars(live).items()}
            function(live, world, *more)
            self._painted |= {k for k, v in vars(live).items() if fingerprint(v) != mine.get(k)}
            changed = changes(before, world, live.key)
            if changed:
                self.report.wrong(
                    f"{self.notes.name}.on_draw changes {changed}{at(world.time)}: it is called "
                    "only where somebody watches, so it must only look; do this in on_step"
                )
            if fingerprint(live.rng) != stream:
                self.report.wrong(
                    f"{self.notes.name}.on_draw draws from self.rng{at(world.time)}: a run that is "
                    "watched would go another way than one that is not; draw in on_step, and keep "
                    "the numbers in attributes of self"
                )
            check_finite(more[0], f"{self.notes.name}.on_draw", at(world.time), self.report)

    def look(self, world: World) -> None:
        """Check its obstacles, beacons, floor and drawings after a control step."""
        live = getattr(world.addons, self.addon.key)
        time = world.time
        if is_own(self.addon, "obstacles", Addon) and self._standing(live) != self._outlines:
            self.report.wrong(
                f"{self.notes.name}.obstacles() returns other outlines than before{at(time)}: "
                "obstacles are put into the world once, at its start, and never move; what "
                "moves is a prop or a robot"
            )
        if is_own(self.addon, "beacons", Addon):
            self._look_at_beacons(live, time)
        if is_own(self.addon, "ground", Addon):
            self._look_at_ground(live, world)
        for method in ("paint", "draw", "theory"):
            if is_own(self.addon, method, Addon):
                self._look_at_drawing(method, world)

    def _look_at_beacons(self, live: Addon, time: float) -> None:
        name = f"{self.notes.name}.beacons()"
        with self.notes.calling("beacons", self.kind.beacons, time):
            found = self.kind.beacons(live)
        if not isinstance(found, Mapping):
            self.report.wrong(
                f"{name} returned {shown(found)}{at(time)}: expected a dict of names and points, "
                "as {'lamp': (1.0, 2.0)}"
            )
            return
        for key, point in found.items():
            try:
                checks.point(f"{name}[{key!r}]", point)
            except InputError as error:
                self.report.wrong(f"{error}{at(time)}")

    def _look_at_ground(self, live: Addon, world: World) -> None:
        for x, y in world.position.T.tolist():
            with self.notes.calling("ground", self.kind.ground, world.time):
                color = self.kind.ground(live, (x, y))
            if color is not None and not _is_color(color):
                self.report.wrong(
                    f"{self.notes.name}.ground((x, y)) returned {shown(color)}{at(world.time)}: "
                    "expected red, green and blue from 0 to 1, such as (1.0, 0.5, 0.0), or None"
                )

    def _look_at_drawing(self, method: str, world: World) -> None:
        """Draw as a replay does, by the frozen add-on of the scenario."""
        area = world.workspace or rectangle(*world.bounds)
        function, scene = getattr(self.kind, method), Scene()
        with self.notes.calling(method, function, world.time):
            function(self.addon, scene, area if method == "paint" else world.frame)
        check_finite(scene, f"{self.notes.name}.{method}", at(world.time), self.report)

    # -- after the runs -------------------------------------------------------------------------

    def check_drawing(self, trial: Trial, first: Run) -> None:
        """Report a run that drawing changes, and drawings that differ between equal runs."""
        if not is_own(self.addon, "on_draw", Addon):
            return
        again, sound = trial.shortened(first), self.report.sound
        watched = again.run(draw=True)
        if not run_ended(watched, self.notes):
            return
        found = difference(first, watched, trial.scenario.sampling_time)
        if found is not None and sound and self.report.sound:
            painted = {f"add-on {self.addon.key}.{attribute}" for attribute in self._painted}
            if _same_but(first, watched, painted):
                self.report.hint(
                    f"{self.notes.name}.on_draw sets self.{', self.'.join(sorted(self._painted))}, "
                    "which depends on how often it is drawn: set in on_step what others ask for"
                )
            else:
                self.report.wrong(
                    f"{self.notes.name}.on_draw changes how the run goes, from {found.time:g} s on "
                    f"({found.what}): it is called only where somebody watches, so what it sets "
                    "must not matter to the other hooks"
                )
        if self.report.sound and watched.scenes != again.run(draw=True, noise=2).scenes:
            self.report.wrong(
                f"{self.notes.name}.on_draw draws the same instant of the same run in different "
                f"ways. Is there a clock, or a generator without a seed?"
            )
        if not any(shapes != fingerprint([]) for shapes in watched.scenes):
            self.report.hint(f"{self.notes.name}.on_draw drew nothing in the whole trial")


def _same_but(one: Run, other: Run, what: set[str]) -> bool:
    """Return whether two runs are equal except for some names in `Run.rows`."""
    kept = [
        [{k: v for k, v in row.items() if k not in what} for row in run.rows]
        for run in (one, other)
    ]
    return kept[0] == kept[1]


def _is_color(color: Any) -> bool:
    try:
        values = np.asarray(color, dtype=float)
    except (TypeError, ValueError):
        return False
    return values.shape == (3,) and bool(((values >= 0) & (values <= 1)).all())
