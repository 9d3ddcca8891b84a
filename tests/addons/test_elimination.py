"""Contests that robots leave: a loaded record tells the same, draws the same and runs again."""

import numpy as np
import pytest

import mars2d
from mars2d import World
from mars2d.addons import Game
from mars2d.core.scene import Circle, Line, Polygon, Scene, Text
from mars2d.world.verify import rerun
from tests.addons.test_game import ROLES, chase
from tests.addons.test_game_goal import carried, looking, race
from tests.addons.test_ring import bout
from tests.cases import each_case
from tests.worlds import finished

THREE = {"pursuer": ["red"], "evader": ["blue", "green", "pink"]}
IN_A_ROW = [(1.0, 0.28), (2.0, -0.28), (2.6, 0.28)]
RACE = {"starts": [-1.0, 1.5, -2.0], "wanted": 2, "capture": 0.8}
CROSSED, RINGED = [Circle, Line, Line, Text], [Circle, Text]


def drawn(addon, frame):
    scene = Scene()
    addon.draw(scene, frame)
    return scene.shapes


@each_case(
    ("scenario", "first", "last", "times"),
    [
        (chase(Game(THREE), IN_A_ROW), [], 3 * CROSSED, ["1.8 s", "3.8 s", "5 s"]),
        (chase(Game(ROLES, capture=1.02)), [Circle], [Circle, *CROSSED], ["2 s"]),
        (race([0.0, 1.0, 0.0], 2.0, **RACE), [Circle], [Circle, *CROSSED, *RINGED],
         ["1.2 s", "0.5 s"]),
        (carried(), [Circle, Line, Polygon], [Circle, Line, Polygon, *CROSSED, *RINGED],
         ["4.2 s", "14 s"]),
        (looking(0.25), [], [Line, *CROSSED], ["5.4 s"]),
        (bout([1.0, 0.5, 0.6, 0.0]), [Circle], [Circle, *3 * CROSSED], ["2 s", "3.1 s", "3.9 s"]),
    ],
)  # fmt: skip
def test_a_loaded_record_tells_and_shows_what_was_seen_live(tmp_path, scenario, first, last, times):
    world = finished(scenario)
    loaded = mars2d.load(world.record.save(tmp_path / "game.npz"))
    k = len(scenario.addons) - 1
    kept = loaded.scenario.addons[k]
    live = getattr(world.addons, kept.key)
    assert kept == world.scenario.addons[k]
    outcome = kept.outcome(loaded)
    assert (outcome.score, outcome.winner) == (live.score, live.winner)
    assert outcome.captures == getattr(live, "captures", ())
    ended = outcome.capture_time == getattr(live, "capture_times", (0,))[-1]
    assert ended or np.isnan(outcome.capture_time)
    shapes = drawn(kept, loaded.frame(-1))
    assert [str(shape) for shape in shapes] == [str(s) for s in drawn(kept, world.frame)]
    assert [type(shape) for shape in shapes] == last
    assert [shape.text.strip() for shape in shapes if isinstance(shape, Text)] == times
    assert [type(shape) for shape in drawn(kept, loaded.frame(2))] == first


@pytest.mark.parametrize("scenario", [chase(), race([0.5]), bout([1.0, 0.5, 0.6, 0.0])])
def test_a_record_runs_again_from_its_commands_without_its_laws(tmp_path, scenario):
    world = finished(scenario)
    loaded = mars2d.load(world.record.save(tmp_path / "game.npz"))
    assert rerun(loaded) is None
    again = World(loaded.scenario, seed=loaded.seed)
    for command in loaded.command:
        if not again.over:
            again.step(command)
    assert (again.over_message, again.record.digest) == (world.over_message, world.record.digest)
