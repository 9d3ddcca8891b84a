"""The rules of a game as a part of a page."""

from __future__ import annotations

import base64
import re

from mars2d.tournaments.page.words import dots, escaped, named, terms
from mars2d.tournaments.rules import Role, Rules

PARAGRAPH = re.compile(r"\n(?:\s*\n|(?=[A-Z][\w ,]{2,24}: | ))")
"""Between paragraphs of a docstring: an empty line, or before a word and colon, or a table."""


def rules_part(rules: Rules) -> str:
    """Return the rules as sections of HTML."""
    story = "\n".join(
        f"<pre>{escaped(part)}</pre>" if "  " in part.strip() else f"<p>{escaped(part)}</p>"
        for part in PARAGRAPH.split(rules.story)
    )
    roles = "\n".join(map(_role, rules.roles.values()))
    start = base64.b64encode(rules.start.encode()).decode()
    law = f"mars2d check my_law.py --for {rules.game} --role {next(iter(rules.roles))}"
    return (
        f'<div class="story">{story}</div>\n'
        f'<img alt="The start of the game" src="data:image/svg+xml;base64,{start}">\n'
        f'<div class="roles">\n{roles}\n</div>\n<dl>\n{terms(rules.facts)}\n</dl>\n'
        '<p class="note">To play it by hand, and to try a law in it:</p>\n'
        f"<pre>mars2d play {escaped(rules.game)}\n{escaped(law)}</pre>"
    )


def _role(role: Role) -> str:
    aim = f"<p><b>{escaped(role.aim[:1].upper() + role.aim[1:])}.</b></p>" if role.aim else ""
    return (
        f"<section><h3>{dots(role.colors)} {named(role.name)}</h3>{aim}"
        f"<dl>{terms(role.facts)}</dl></section>"
    )
