"""The colours of bodies that nobody has painted, which cameras see and pictures show."""

from __future__ import annotations

from collections.abc import Sequence

from mars2d.bodies.props.base import Prop

OBSTACLE = "#b8c0c8"
"""The colour of all obstacles."""

NEUTRAL = "#d8cbb3"
"""The colour of a prop of which neither colour nor material is said."""

MATERIAL_COLORS = {
    "aluminium": "#c3ced8",
    "cardboard": "#c9a26b",
    "concrete": "#bdb8ae",
    "felt": "#a9bd97",
    "foam": "#f1e3b0",
    "glass": "#cfe8e4",
    "ice": "#d6ecf8",
    "plastic": "#e8c7d9",
    "rubber": "#77716b",
    "steel": "#9fb2c4",
    "teflon": "#eceae4",
    "wood": "#d9b384",
}


def prop_color(prop: Prop) -> str:
    """Return the colour of a prop: its own, or that of its material."""
    return prop.color or MATERIAL_COLORS.get(prop.material or "", NEUTRAL)


def prop_colors(props: Sequence[Prop]) -> tuple[str, ...]:
    """Return the colour of each prop."""
    return tuple(prop_color(prop) for prop in props)
