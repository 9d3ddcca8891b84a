"""The sub-commands of ``mars2d``, one module each.

A module has the verb's `NAME`, an `add_arguments(parser)`, and an `execute(arguments)` whose
docstring is the verb's help.
"""

from mars2d.cli import (
    bench,
    check,
    compare,
    demo,
    doctor,
    edit,
    paper,
    parts,
    plot,
    replay,
    run,
    sweep,
    tournament,
)

__all__ = ["VERBS"]

VERBS = (
    demo,
    run,
    edit,
    compare,
    replay,
    plot,
    sweep,
    tournament,
    parts,
    check,
    paper,
    bench,
    doctor,
)
"""In the order in which the help lists them."""
