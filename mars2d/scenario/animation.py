"""The frozen description of an experiment's looks."""

from __future__ import annotations

from collections.abc import Sequence

from mars2d.core.description import Description, accepts, bounded, entry, flag, wrong
from mars2d.core.scene import PALETTE, color, wake_style

_factor = bounded(
    "a factor of real time (1 is real time), 0 for one step a key press, or 'max'", low=0, high=1e6
)


@accepts({"anyOf": [vars(_factor)["schema"], {"const": "max"}]})
def playback_speed(name: str, value: object) -> float | str:
    """Check a playback speed: a factor of real time, 0 for one step a key press, or "max"."""
    return "max" if isinstance(value, str) and value == "max" else float(_factor(name, value))


@accepts({"type": "array", "items": {"type": "string"}, "minItems": 1})
def _colors(name: str, value: object) -> tuple[str, ...]:
    if isinstance(value, str) or not isinstance(value, (list, tuple)) or not value:
        raise wrong(name, value, "a list of colours, such as ['#0072b2', 'orange']")
    return tuple(color(f"{name}[{i}]", item) for i, item in enumerate(value))


class Animation(Description):
    """How an experiment looks when it is drawn: the Animation fields of the paper's Table 1."""

    grid: bool = flag(default=True, doc="draw the grid")
    show_initial_pose: bool = flag(default=True, doc="draw the initial poses")
    show_real_shape: bool = flag(default=True, doc="draw robots to scale, else as points")
    wake: bool = flag(default=True, doc="draw the paths behind the robots")
    forces: bool = flag(default=False, doc="draw contact forces, and mark slipping drives")
    names: bool = flag(default=False, doc="write the names of robots and props")
    neighbours: bool = flag(default=False, doc="draw the links between neighbours")
    ranges: bool = flag(default=False, doc="draw the range of radio")
    theory: bool = flag(default=False, doc="draw theoretical predictions, where add-ons do so")
    wake_style: str = entry(default="-", check=wake_style, doc="line style of the paths")
    playback_speed: float | str = entry(
        default=1.0,
        check=playback_speed,
        doc="1 is real time, 0 one step per key press, 'max' as fast as possible",
    )
    base_colors: Sequence[str] = entry(
        default=PALETTE, check=_colors, doc="the robots' colours, cycled"
    )
