"""Check an add-on: its hooks, obstacles, beacons and seeds, and that drawing changes nothing."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from mars2d.addons.base import Addon, hooks_of
from mars2d.core import checks
from mars2d.core.deadline import Deadline
from mars2d.core.errors import InputError, shown
from mars2d.core.plane import rectangle
from mars2d.core.scene import Scene
from mars2d.core.usercode import called
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.base import Sensor
from mars2d.testing.finding import Finding, judge
from mars2d.testing.subject import ControlLaw, Placed, Subject, own_methods, with_methods
from mars2d.testing.trial import (
    Run,
    Trial,
    changed,
    contents,
    difference,
    shepherd,
    small_world,
    untouchable,
)
from mars2d.world.world import World


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
    control: ControlLaw | None = None,
    deadline: Deadline | None = None,
) -> tuple[Finding, ...]:
    """Return the findings of `check_addon`, including hints.

    control: the law of the scenario's team. deadline: the limit of each control step.
    """
    checks.instance(Addon, "Map([...])")("check_addon(addon)", addon)
    subject = _Subject(addon)
    if subject.check_methods(addon, Addon) and subject.check_fields(addon, Addon):
        with deadline or Deadline() as limit:
            place = partial(subject.placed, sensors, scenario, control)
            done = subject.first_run(place, limit, subject.look, small=scenario is None)
            if done is not None:
                # Everything else in the small world is known to be repeatable.
                subject.check_repeatable(*done, (f"add-on {addon.key}." if scenario else "",))
                subject.check_drawing(*done)
    return subject.report.findings


class _Subject(Subject):
    """The add-on on trial, and the observations so far."""

    def __init__(self, addon: Addon) -> None:
        self.addon, self.kind = addon, type(addon)
        stream, label = "self.rng, the add-on's own stream", f"add-on {addon.key!r}"
        super().__init__(self.kind.__name__, stream, label=label)
        self._own = own_methods(addon, Addon)
        self._painted: set[str] = set()  # attributes that on_draw sets
        self._shapes = 0

    def placed(
        self, sensors: Sequence[Sensor], scenario: Scenario | None, control: ControlLaw | None
    ) -> Placed:
        """Return the scenario for the trial, and the law of its team.

        The small world is moved, and without walls, if the add-on's obstacles are in it.
        """
        witness = with_methods(self.addon, {h: self._watched(h) for h in hooks_of(self.addon)})
        if scenario is not None:
            others = [each for each in scenario.addons if each.key != witness.key]
            return scenario.replace(addons=[*others, witness]), control
        try:
            return small_world(sensors, [witness]), shepherd
        except InputError:
            world = small_world(sensors)
            outlines = checks.outlines(f"{self.name}.obstacles()", witness.obstacles())
            x = 3 + max((x for outline in outlines for x, _ in outline), default=0.0)
            robots = [r.at(r.pose[0] + x, *r.pose[1:]) for r in world.robots]
            props = [p.replace(pose=(p.pose[0] + x, *p.pose[1:])) for p in world.props]
            return world.replace(
                robots=robots, props=props, workspace=None, on_exit="ignore", addons=[witness]
            ), shepherd

    def _watched(self, hook: str) -> Callable[..., None]:
        """Return a hook that does the same, and reports its effects."""

        def watched(live: Addon, world: World, *more: Any) -> None:
            if hook != "on_draw":
                with self.calling(f"{self.name}.{hook}"):
                    getattr(self.kind, hook)(live, world)
                return
            before, stream = untouchable(world, live.key), contents(live.rng)
            mine = {name: contents(value) for name, value in vars(live).items()}
            with self.calling(f"{self.name}.on_draw"):
                self.kind.on_draw(live, world, *more)
            self._painted |= {k for k, v in vars(live).items() if contents(v) != mine.get(k)}
            self._shapes += len(more[0].shapes)
            what = changed(before, world, live.key)
            if contents(live.rng) != stream:
                what = "self.rng"
            if what:
                self.report.wrong(
                    f"{self.name}.on_draw changes {what} (at {world.time:g} s): it is called only "
                    "where somebody watches, so it must only look; do this in on_step"
                )
            self.check_finite(more[0], f"{self.name}.on_draw")

        return watched

    def look(self, world: World) -> None:
        """Check its obstacles, beacons, floor and drawings after a control step."""
        live = getattr(world.addons, self.addon.key)
        if "obstacles" in self._own and contents(live.obstacles()) != contents(
            self.addon.obstacles()
        ):
            self.report.wrong(
                f"{self.name}.obstacles() returns other outlines than before (at {world.time:g} "
                "s): obstacles are put into the world once, at its start, and never move; what "
                "moves is a prop or a robot"
            )
        if "beacons" in self._own:
            found = live.beacons()
            if not isinstance(found, Mapping):
                self.report.wrong(
                    f"{self.name}.beacons() returned {shown(found)}: expected a dict of names and "
                    "points, as {'lamp': (1.0, 2.0)}"
                )
                found = {}
            for key, point in found.items():
                checks.point(f"{self.name}.beacons()[{key!r}]", point)
        if "ground" in self._own:
            for x, y in world.position.T.tolist():
                color = live.ground((x, y))
                if color is not None and not _is_color(color):
                    self.report.wrong(
                        f"{self.name}.ground((x, y)) returned {shown(color)}: expected red, green "
                        "and blue from 0 to 1, such as (1.0, 0.5, 0.0), or None"
                    )
        area = world.workspace or rectangle(*world.bounds)
        for method in {"paint", "draw", "theory"}.intersection(self._own):
            scene, function = Scene(), getattr(self.addon, method)  # as a replay does
            with called(f"{self.name}.{method}", function):
                function(scene, area if method == "paint" else world.frame)
            self.check_finite(scene, f"{self.name}.{method}")

    def check_drawing(self, trial: Trial, first: Run) -> None:
        """Report a run that drawing changes, in more than what it keeps of the picture."""
        if "on_draw" not in self._own or not self.report.sound:
            return
        watched = trial.run(draw=True)
        if watched.error is not None:
            self.report.wrong(str(watched.error))
        painted = {f"add-on {self.addon.key}.{attribute}" for attribute in self._painted}
        found = difference(first, watched, lambda what: what not in painted)
        if self.report.sound and found:
            self.report.wrong(
                f"{self.name}.on_draw changes how the run goes, from {found}: it is called only "
                "where somebody watches, so what it sets must not matter to the other hooks"
            )
        if not self._shapes:
            self.report.hint(f"{self.name}.on_draw drew nothing in the whole trial")


def _is_color(color: Any) -> bool:
    try:
        values = np.asarray(color, dtype=float)
    except (TypeError, ValueError):
        return False
    return values.shape == (3,) and bool(((values >= 0) & (values <= 1)).all())
