"""Checks for all kinds of parts: arguments of methods, fields, drawing, repeatability."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import json
import pickle
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

from mars2d.core.deadline import Deadline
from mars2d.core.description import Description
from mars2d.core.errors import Late, shown
from mars2d.core.hints import described
from mars2d.core.scene import Scene
from mars2d.scenario import serialize
from mars2d.scenario.scenario import Scenario
from mars2d.testing.finding import Noted, Notes, Report
from mars2d.testing.state import Places
from mars2d.testing.trial import (
    Difference,
    Run,
    Trial,
    as_input_error,
    coordinates,
    difference,
)
from mars2d.world.world import World

Part = TypeVar("Part", bound=Description)

ControlLaw = Callable[[Any], Any]

KEEP = "Keep such things in attributes of self, set in on_start"
"""Advice on things that a part with an `on_start` keeps elsewhere."""

SHARES = "worlds and robots that run in one process would disturb each other"


def is_own(part: Description, method: str, base: type[Description]) -> bool:
    """Return whether a part's class defines a method instead of inheriting it from its base."""
    return getattr(type(part), method, None) is not getattr(base, method)


def check_methods(
    part: Description,
    base: type[Description],
    methods: Mapping[str, Sequence[str]],
    notes: Notes,
) -> bool:
    """Report a part's own methods that can't be called as documented; return whether none."""
    own = [method for method in methods if is_own(part, method, base)]
    callables = [_check_arguments(part, method, methods[method], notes) for method in own]
    return all(callables)


def _check_arguments(
    part: Description, method: str, arguments: Sequence[str], notes: Notes
) -> bool:
    """Report a method that can't be called with these arguments; return whether it can."""
    function = getattr(part, method)
    expected = f"expected {method}({', '.join(['self', *arguments])})"
    if not callable(function):
        notes.report.wrong(f"{notes.name}.{method} = {shown(function)}: {expected}")
        return False
    try:
        signature = inspect.signature(function)
    except ValueError:  # a built-in: the first call will tell
        return True
    names = list(signature.parameters)
    with_self = f"({', '.join(['self', *names])})"
    try:
        signature.bind(*arguments)
    except TypeError:
        notes.report.wrong(f"{notes.name}.{method} has the arguments {with_self}: {expected}")
        return False
    if names != [*arguments] and sorted(names) == sorted(arguments):
        notes.report.wrong(
            f"{notes.name}.{method} has the arguments {with_self} in another order than they are "
            f"given: {expected}"
        )
        return False
    return True


def check_fields(part: Description, base: type[Description], notes: Notes) -> bool:
    """Report fields that can't be copied, sent to another process or saved in a file.

    Returns whether all can be copied, since each world needs its own copy.
    """
    report, name, copies = notes.report, notes.name, True
    for field in dataclasses.fields(part):
        value = getattr(part, field.name)
        if inspect.isroutine(value):
            report.hint(
                f"{name}.{field.name} = {shown(value)}: a function is not kept in a record's file, "
                f"so a saved run is shown without {name}"
            )
            continue
        for what, attempt in (("copied", copy.deepcopy), ("sent to another process", pickle.dumps)):
            try:
                attempt(value)
            except Exception as error:  # whatever a user's object raises
                copies = copies and what != "copied"
                report.wrong(
                    f"{name}.{field.name} = {shown(value)} can't be {what} ({described(error)}): "
                    "a field holds numbers, text, lists and descriptions; make the rest in "
                    "on_start"
                )
                break
        else:
            _check_in_file(part, field.name, value, notes)
    inherited = {field.name for field in dataclasses.fields(base)}
    for field in dataclasses.fields(part):
        if field.name in inherited or field.type not in ("float", float):
            continue
        if not (field.metadata.get("unit") or field.metadata.get("doc")):
            report.hint(
                f"{name}.{field.name} says neither its unit nor its bounds: declare it as "
                f"`{field.name}: float = number(default=..., low=..., unit=..., doc=...)`, "
                "by mars2d.core.description"
            )
    return copies


def _check_in_file(part: Description, field: str, value: Any, notes: Notes) -> None:
    try:
        kept = json.loads(json.dumps(serialize.from_description(value)))
        back = part.replace(**{field: serialize.to_value(kept)})
        same = bool(getattr(back, field) == value)
    except Exception:  # whatever a user's own check raises at what it does not know
        same = False
    if not same:
        notes.report.wrong(
            f"{notes.name}.{field} = {shown(value)} does not come back from a record's file: a "
            "field holds numbers, text, lists and descriptions, and a check of its own must take "
            "what it returned"
        )


def check_places(places: Places, notes: Notes) -> None:
    """Hint at mutable attributes of a class, which all its objects share."""
    for place in places.of_classes():
        notes.report.hint(
            f"{place}, is shared by all objects and worlds: what is written there is seen "
            f"everywhere. {notes.keep}"
        )


def run_ended(run: Run, notes: Notes) -> bool:
    """Report why a run did not reach its end; return whether it did.

    Errors raised by the part itself are reported before; any other error is not its fault.
    """
    if run.late is not None:
        where = f"{run.late}: " if run.late else ""
        notes.report.wrong(
            f"{where}{notes.name} did not come to an end within {run.patience:g} s, and was "
            "broken off. Is there a loop that never ends? A law that waits yields at each step"
        )
    elif run.error is not None and not isinstance(run.error, Noted):
        why = "" if notes.small_world else f"{notes.name}: its scenario does not run: "
        notes.report.wrong(f"{why}{run.error}", untried=not notes.small_world)
    return not run.failed


Place = Callable[[Scenario | None, ControlLaw | None], tuple[Scenario, ControlLaw | None]]


def first_run(
    place: Place,
    scenario: Scenario | None,
    control: ControlLaw | None,
    looked: Callable[[World], None],
    deadline: Deadline,
    notes: Notes,
) -> tuple[Trial, Run] | None:
    """Run a part for the first time; return None, after reporting why, if the run fails.

    place: puts the part into a scenario, or into the small world for None; returns the scenario and
    the team's law. If the scenario fails for other reasons than the part, the small world is used.
    """
    run, trial = Run(), None
    notes.small_world = scenario is None
    try:
        tried, law = place(scenario, control)
        trial = Trial(tried, law, deadline, looked=looked)
        run = trial.run()
    except Late:
        run.late, run.patience = deadline.arrived(), deadline.patience
    except Exception as error:  # whatever a user's object raises
        run.error = as_input_error(error)
    if scenario is not None and run.error is not None and not isinstance(run.error, Noted):
        notes.report.hint(
            f"{notes.name} was tried in a small world, as its scenario does not run: {run.error}"
        )
        return first_run(place, None, None, looked, deadline, notes)
    ended = run_ended(run, notes)
    return (trial, run) if ended and trial is not None else None


def check_repeatable(
    trial: Trial, first: Run, places: Places, notes: Notes, own: tuple[str, ...]
) -> None:
    """Report if the same seed does not give the same run, alone or beside another world.

    first: an earlier run of the trial. own: prefixes of those names in `Run.rows` for which the
    part is responsible.
    """
    again, tick = trial.shortened(first), trial.scenario.sampling_time
    found = difference(first, again.run(noise=2), tick)
    between = difference(first, again.interleaved(), tick)
    changed = places.changed()
    kept = f"keeps something in {' and in '.join(changed)}" if changed else ""
    if "generator" in kept:
        kept += f" (draw from {notes.own})"
    if not _answers(found, own):
        found = None
    if not _answers(between, own):
        between = None
    name, report = notes.name, notes.report
    if found and changed:
        report.wrong(
            f"{name} {kept}: the same seed does not give the same run, {_what(found)}; "
            f"{SHARES}. {notes.keep}"
        )
    elif found and not notes.shared_randomness:
        report.wrong(
            f"{name} is not repeatable: the same seed gives another run, {_what(found)}. Is there "
            f"a clock, a generator without a seed, or something kept elsewhere than in a part of "
            f"the world? Draw from {notes.own}. {notes.keep}"
        )
    elif between and not found:
        what = kept or "shares something between worlds"
        report.wrong(
            f"{name} {what}: beside a second world the run is another one, {_what(between)}. "
            f"{notes.keep}"
        )
    elif changed and not found:
        report.hint(f"{name} {kept}: {SHARES}, if it matters to anything. {notes.keep}")


def _answers(found: Difference | None, own: tuple[str, ...]) -> bool:
    return found is not None and found.what.startswith((*own, "the end"))


def _what(found: Difference) -> str:
    return f"from {found.time:g} s on ({found.what})"


def check_finite(scene: Scene, name: str, when: str, report: Report) -> None:
    """Report a shape with coordinates that are nan or infinite."""
    for shape in scene.shapes:
        for value in coordinates(shape):
            if isinstance(value, (float, tuple, np.ndarray)) and not np.isfinite(value).all():
                report.wrong(
                    f"{name} draws a {type(shape).__name__.lower()} with nan or inf in it{when}: "
                    "leave out what is missing, and end at the range what has no end"
                )
                return


def with_methods(part: Part, methods: Mapping[str, Callable[..., Any]]) -> Part:
    """Return a copy of a part, of a subclass in which functions of the part replace methods."""
    kind = type(part)
    body: dict[str, Any] = {"__module__": kind.__module__, "__doc__": kind.__doc__}
    body |= {name: _as_method(function) for name, function in methods.items()}
    twin: Part = object.__new__(type(kind.__name__, (kind,), body))
    twin.__dict__.update(vars(part))
    return twin


def _as_method(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that is called with the part first, as a bound method would not be."""

    def method(part: Any, *arguments: Any) -> Any:
        return function(part, *arguments)

    return method
