"""Pages that need no network: a template's places filled, its scripts and styles the only ones."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Iterable, Mapping

from mars2d.output.raster.theme import DARK, LIGHT, Theme

__all__ = ["colors", "filled", "policy"]


def filled(template: str, words: Mapping[str, str]) -> str:
    """Return a template with each {{name}} replaced by its words, which are taken as they are."""
    parts = template.split("{{")
    found = [parts[0]]
    for part in parts[1:]:
        name, _, rest = part.partition("}}")
        found.append(words[name] + rest)
    return "".join(found)


def policy(scripts: Iterable[str], styles: Iterable[str]) -> str:
    """Return a content security policy: these scripts and styles run, nothing else is loaded."""
    may_run, may_style = (
        " ".join(f"'{_hash(text)}'" for text in texts) for texts in (scripts, styles)
    )
    return (
        f"default-src 'none'; script-src {may_run}; style-src {may_style}; "
        "img-src data:; base-uri 'none'; form-action 'none'"
    )


def colors() -> str:
    """Return the colours of the light and the dark theme as variables of CSS."""
    return f":root {{ {_variables(LIGHT)} }}\n:root.dark {{ {_variables(DARK)} }}\n"


def _variables(theme: Theme) -> str:
    names = ("page", "paper", "bar", "plate", "edge", "grid", "ink", "text", "muted", "key")
    values = {name: getattr(theme, name) for name in names}
    values |= {
        "axis": theme.grid_axis, "key-edge": theme.key_edge, "track": theme.track,
        "accent": theme.running.ink, "accent-pale": theme.running.pale,
        "warn": theme.waiting.ink, "warn-pale": theme.waiting.pale,
        "over": theme.over, "on-over": theme.on_banner, "effort": theme.effort,
        "failed": theme.failed,
    }  # fmt: skip
    return " ".join(f"--{name}: {value};" for name, value in values.items())


def _hash(text: str) -> str:
    """Return the name of a script or style in a content security policy."""
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
