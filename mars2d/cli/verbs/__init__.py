"""The verbs of ``mars2d``, one module each, imported when it is asked for.

The module `run` is the verb ``mars2d run``. A verb's module has `ARGUMENTS`, by
name, and a function `execute(arguments)`, whose docstring is the verb's help.
"""

__all__ = ["GROUPS", "VERBS"]

BEGIN = {
    "list": "the examples, drives, props, joints, sensors, laws and add-ons",
    "new": "write a first experiment to change",
    "copy": "copy an example, with its laws and maps, to change it",
    "demo": "run an example; without a display, make a picture and a film",
}

RUN = {
    "run": "run an experiment, in a window or without, and save its files",
    "play": "play a game against a law or another person",
    "edit": "draw a scenario with the mouse",
    "check": "describe code, a scenario, a record or a map, and find mistakes",
}

LOOK = {
    "replay": "play a recorded run, or make a film or a page of it",
    "plot": "draw figures of a recorded run",
    "compare": "run an experiment with each physics, side by side",
}

STUDY = {
    "sweep": "run an experiment over settings and seeds into a table",
    "tournament": "let laws play each other: a league, and a page with replays",
}

PROGRAM = {
    "paper": "make the figures of the MARS paper, beside theory",
    "doctor": "test the installation; completion for shells, a schema for editors",
}

GROUPS = {
    "To begin": BEGIN,
    "To run": RUN,
    "To look at a run": LOOK,
    "Many runs": STUDY,
    "This program": PROGRAM,
}
"""What each verb is for, by name, in the order of the help."""

VERBS = {name: line for group in GROUPS.values() for name, line in group.items()}
"""The verbs of all groups."""
