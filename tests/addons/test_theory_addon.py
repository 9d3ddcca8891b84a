"""What theory predicts is drawn where it is asked for: in figures, pictures, films and replays."""

import numpy as np
import pytest

import mars2d
from mars2d import Animation, InputError, LawError, Robot, Scenario, World, load
from mars2d.addons import Beacon, Theory
from mars2d.core.scene import Circle
from mars2d.output.layers import addons as drawn
from mars2d.output.raster.picture import paint_frame
from tests.cases import each_case

VIOLET = "#7b3294"


def circle(scene, seen):
    scene.circle(seen.pose[:2, 0], 1.5, fill=VIOLET)


def scenario(**fields):
    return Scenario(robots=[Robot(pose=(0, 0, 0))], stop_time=2.0, **fields)


def east(world):
    return 0.5, 0.0


def rings(scene):
    return [shape for shape in scene.shapes if isinstance(shape, Circle) and shape.radius == 1.5]


def test_theory_follows_the_frame_at_all_times():
    record = mars2d.run(scenario(addons=[Theory(circle)]), control=east)
    for row in (0, 10, 20):
        (ring,) = rings(drawn.theory(record.frame(row)))
        assert ring.center == (pytest.approx(row * 0.05), 0.0)


def test_theory_is_painted_only_on_request():
    def violet(surface):
        import pygame

        seen = pygame.surfarray.array3d(surface)
        return int((seen == (0x7B, 0x32, 0x94)).all(axis=2).sum())

    world = World(scenario(addons=[Theory(circle)]))
    assert violet(paint_frame(world.frame)) == 0
    assert violet(paint_frame(world.frame, theory=True)) > 100
    asked = World(scenario(addons=[Theory(circle)], animation=Animation(theory=True)))
    assert violet(paint_frame(asked.frame)) > 100
    assert violet(paint_frame(asked.frame, theory=False)) == 0


def test_a_saved_record_names_the_theory_that_it_lacks(tmp_path):
    record = mars2d.run(scenario(addons=[Theory(circle), Beacon((1, 2))]), control=east)
    loaded = load(record.save(tmp_path / "run.npz"))
    assert loaded.missing == ("Theory, with its function circle",)
    assert [addon.key for addon in loaded.scenario.addons] == ["beacon"]
    assert loaded.digest == record.digest
    assert np.array_equal(loaded.pose, record.pose)


@each_case("bad", [None, 3, "circle", lambda scene: None])
def test_anything_but_a_function_of_scene_and_frame_is_refused(bad):
    with pytest.raises(InputError, match=r"Theory\.draws.*two arguments, the scene and the frame"):
        Theory(bad)


def test_a_theory_that_fails_is_named_with_its_line():
    def broken(scene, frame):
        return 1 / 0

    world = World(scenario(addons=[Theory(broken)]))
    with pytest.raises(LawError, match="add-on 'theory' raised ZeroDivisionError"):
        drawn.theory(world.frame)
