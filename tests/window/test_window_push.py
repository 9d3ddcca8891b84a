"""A measured push: aimed with the mouse or typed, on the record, and seen as it acts."""

from math import hypot

import pytest

from mars2d.core.errors import InputError
from mars2d.core.scene import Scene
from mars2d.record.interventions import Push
from mars2d.window.run.push import draw_pushes, pushed
from tests.cases import each_case
from tests.window.test_window_buttons import choose


@each_case(
    "text, force, seconds",
    [
        ("3 N for 0.5 s at 90°", (0, 3), 0.5),
        ("2.5", (-2.5, 0), 0.5),
        ("4N for 2s", (-4, 0), 2.0),
        (" 1 N at -90 ", (0, -1), 0.5),
    ],
)
def test_a_push_is_typed_as_one_says_it(text, force, seconds):
    found, duration = pushed(text, heading=3.141592653589793)
    assert found == pytest.approx(force, abs=1e-12)
    assert duration == seconds
    with pytest.raises(InputError, match=r"such as 3 N for 0\.5 s at 90°"):
        pushed(f"{text} or so", heading=0.0)


def test_shift_and_drag_push_with_the_newtons_at_the_arrow_and_undo_takes_them_back(
    open_window, room
):
    window = open_window(1, experiment=str(room))
    window.press("space")
    window.do("keydown", "shift")
    window.drag((1, -1), (1, -0.5), (1, 0))
    window.do("keyup", "shift")
    timeline = window.shown.director.timeline
    (push,) = timeline.world.operator.log
    assert isinstance(push, Push)
    assert (push.row, push.body, push.duration) == (timeline.row, 2, 0.5)
    assert push.force[1] > 1
    assert push.force[1] == pytest.approx(hypot(*push.force), rel=0.02)
    assert window.settle()["props"][0] == [1, -1, 0]  # time stands still
    window.press("space")
    window.until(lambda s: s["props"][0][1] > -0.95)
    assert timeline.world.frame.energy.by("hands") > 0
    window.press("space", "ctrl+z")
    window.until(lambda s: s["props"][0][1] == -1 and s["branches"] == 1)


def test_by_keys_alone_a_push_is_typed_and_a_mistake_is_said_in_place(open_window, room):
    window = open_window(1, experiment=str(room))
    window.press("w")
    window.says("Tab selects what is pushed")
    window.press("space", "Tab", "Tab", "Tab", "w")
    prompts = window.shown.prompts
    assert prompts.prompt.text.endswith("N for 0.5 s at 0°")
    window.press("ctrl+a")
    window.type("much")
    window.press("Return")
    assert "such as 3 N" in prompts.prompt.error
    window.press("ctrl+a")
    window.type("30 N for 0.2 s at 90")
    window.press("Return")
    window.says("a push of 30 N for 0.2 s at 90")
    assert prompts.prompt is None
    window.press("space")
    window.until(lambda s: s["props"][0][1] > -0.95)
    window.click(-2, -1, button=3)
    choose(window, "Push with a force ...")
    assert "Push blue" in prompts.prompt.label
    window.press("Escape")
    assert prompts.prompt is None
    scene, frame = Scene(), window.shown.player.frame
    strong = Push(0, 2, (0.0, 0.0), (-900.0, 900.0), 1.0)  # its arrow is longer than the room
    draw_pushes(scene, frame, [strong], window.shown.viewpoint.camera)
    x, y = scene.shapes[-1].position
    assert x == -3
    assert 2 <= y < 2.5
