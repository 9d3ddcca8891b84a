"""How many substeps an engine needs in each control step, to overlap by no more than MARS2D.

    peers/pymunk/bin/python benchmarks/peers/substeps.py pymunk_peer [--scenes S2 ...]

From one substep upwards, a scene is run from its start for more control steps than `run.py` does
in it, and given up as soon as bodies overlap, or are in walls or boxes, by more than the bound. The
first number that is not given up stands in the `SUBSTEPS` of the engine's script.
"""

from __future__ import annotations

import argparse
import dataclasses
import importlib
import sys

from peer import SCENES, Engine, gaps
from run import PEERS

BOUND = 1e-3
"""The overlap that MARS2D allows by default, metres."""

CHECKED = 1000
"""The number of control steps that are looked at, or those of an episode."""


def deepest(kind: type[Engine], scene: str, substeps: int) -> tuple[float, int]:
    """Return the deepest overlap [m], and after how many control steps the run ended."""
    engine = kind(dataclasses.replace(SCENES[scene](), beams=0), "15 substeps")
    engine.substeps = substeps
    steps = min(CHECKED, engine.episode)
    measure, deep = gaps.Gaps(engine.scene), 0.0
    for step in range(steps):
        engine.advance()
        deep = max(deep, *(-float(gap.min()) for gap in measure(engine.poses())))
        if deep > BOUND:
            return deep, step + 1
    return deep, steps


def main() -> None:
    """Find the substeps of each scene, and print the overlap that is left with them."""
    parser = argparse.ArgumentParser(description="How many substeps does an engine need?")
    scripts = {k.script.removesuffix(".py"): k for k in PEERS.values() if "1 mm" in k.settings}
    parser.add_argument("script", choices=scripts, help="the engine's")
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--most", type=int, default=1000, help="substeps to try (default 1000)")
    arguments = parser.parse_args()
    module = importlib.import_module(arguments.script)
    (kind,) = (c for c in vars(module).values() if isinstance(c, type) and "SUBSTEPS" in vars(c))
    left_out = scripts[arguments.script].without
    for scene in arguments.scenes:
        if scene in left_out:
            continue
        for substeps in range(1, arguments.most + 1):
            deep, steps = deepest(kind, scene, substeps)
            if deep <= BOUND:
                print(f"{scene}: {substeps} substeps, {1e3 * deep:.3f} mm in {steps} control steps")
                break
        else:
            sys.exit(f"{scene}: more than {1e3 * BOUND:g} mm even with {arguments.most} substeps")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
