"""The rules of a game as a page of their own, and as a part of a tournament's page."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from mars2d.core.files import atomic_write
from mars2d.output.pages.replay import colors, filled, policy
from mars2d.output.raster.theme import DARK
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.roles import contest_of
from mars2d.study.plan import Plan, settings_of
from mars2d.tournaments.isolation.limits import Limits
from mars2d.tournaments.page.words import escaped, read
from mars2d.tournaments.rules import Role, Rules

NOTE = re.compile(r"[A-Z][\w ,]{2,24}: ")
"""How a line of a docstring begins that says something new."""


def save_rules(
    path: Path,
    experiment: str | Path,
    limits: Limits,
    *,
    settings: Mapping[str, Any],
    stop_time: float | None,
    first_seed: int,
) -> None:
    """Write the page of a game's rules, in its first round. Raises InputError if that fails."""
    options = next(iter(Plan(settings_of(settings), (first_seed,)).points()))
    always = {} if stop_time is None else {"stop_time": stop_time}
    opened = open_experiment(experiment, {**options, **always}, seed=first_seed)
    rules = Rules.of(opened, contest_of(opened.scenario, str(experiment)))
    with atomic_write(path) as file:
        page = rules_page(replace(rules, limits=limits))
        file.write(page.encode("utf-8", errors="replace"))


def rules_page(rules: Rules) -> str:
    """Return the rules as the text of an HTML file, with a picture of the start."""
    script, style = read("rules.js"), colors() + dot_style(rules) + read("league.css")
    words = {
        "policy": policy([script], [style]),
        "title": escaped(rules.title),
        "style": style,
        "script": script,
        "rules": rules_part(rules),
    }
    return filled(read("rules.html"), words)


def rules_section(rules: Rules) -> str:
    """Return the rules as a part of a tournament's page, which a click opens."""
    return (
        '<section aria-labelledby="rulesTitle">\n<details>\n'
        f'<summary><h2 id="rulesTitle">The rules</h2></summary>\n{rules_part(rules)}\n'
        "</details>\n</section>"
    )


def rules_part(rules: Rules) -> str:
    """Return the rules as sections of HTML."""
    limits = rules.limits
    roles = "\n".join(_role(rules, number) for number in range(len(rules.roles)))
    facts = {
        "What is counted": rules.counts,
        "Arena": rules.arena,
        "Time": rules.time,
        "Points": "A match won gives 1 point, a draw ½.",
        "Forfeit": f"A law forfeits the match by an error, by a command that is not two finite "
        f"numbers, by more than {limits.tick:g} s for one step or {limits.match:g} s for all of a "
        f"match, or by more than {limits.memory:g} MB.",
    }
    listed = "\n".join(f"<dt>{term}</dt><dd>{escaped(what)}</dd>" for term, what in facts.items())
    first = rules.roles[0].name
    lines = [
        f"mars2d play {rules.game}",
        f"mars2d check my_law.py --for {rules.game} --role {first}",
    ]
    start = base64.b64encode(rules.start.encode()).decode()
    commands = "\n".join(f"<pre>{escaped(line)}</pre>" for line in lines)
    return (
        f'<div class="story">{_story(rules.story)}</div>\n'
        '<figure class="start"><img alt="The start of the game" '
        f'src="data:image/svg+xml;base64,{start}"></figure>\n'
        f'<div class="roles">\n{roles}\n</div>\n<dl class="rules">\n{listed}\n</dl>\n'
        f'<p class="note">To play it by hand, and to try a law in it:</p>\n{commands}'
    )


def _role(rules: Rules, number: int) -> str:
    role: Role = rules.roles[number]
    aim = (
        f"<p><strong>{escaped(role.aim[:1].upper() + role.aim[1:])}.</strong></p>"
        if role.aim
        else ""
    )
    rows = {
        "Robots": ", ".join(role.robots),
        "Drive": role.drive,
        "A law returns": role.command,
        "It sees": role.sees,
    }
    listed = "".join(f"<dt>{term}</dt><dd>{escaped(what)}</dd>" for term, what in rows.items())
    return (
        f'<section class="role"><h3>{dots(rules, role.name)} {escaped(role.name)}</h3>{aim}'
        f"<dl>{listed}</dl></section>"
    )


def _story(text: str) -> str:
    """Return a docstring as paragraphs; tables, set by blanks, stay as they are."""
    return "\n".join(
        f"<pre>{escaped(part)}</pre>" if _is_table(part) else f"<p>{escaped(part)}</p>"
        for part in _parts(text)
    )


def _parts(text: str) -> Iterator[str]:
    """Yield the paragraphs and tables of a docstring."""
    part: list[str] = []
    for line in [*text.splitlines(), ""]:
        table = _is_table(line)
        if part and (not line.strip() or NOTE.match(line) or table != _is_table(part[-1])):
            yield "\n".join(part)
            part = []
        if line.strip():
            part.append(line)


def _is_table(text: str) -> bool:
    return "  " in text.strip()


# -- the colours of roles -------------------------------------------------------------------------


def dots(rules: Rules | None, role: str) -> str:
    """Return a dot in each colour of a role's robots."""
    if rules is None:
        return ""
    names = [each.name for each in rules.roles]
    count = len(rules.colors[role])
    kinds = (f"of{names.index(role)}-{k}" for k in range(count))
    return "".join(f'<i class="dot {kind}" aria-hidden="true"></i>' for kind in kinds)


def dot_style(rules: Rules | None) -> str:
    """Return the colours of the dots as CSS, for the light and the dark theme."""
    lines = []
    for number, role in enumerate(() if rules is None else rules.roles):
        for k, color in enumerate(role.colors):
            kind = f".of{number}-{k}"
            lines.append(f"{kind} {{ background: {color}; }}")
            lines.append(f":root.dark {kind} {{ background: {DARK.shade(color)}; }}")
    return "\n".join(lines) + "\n"
