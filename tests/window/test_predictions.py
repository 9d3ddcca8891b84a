"""What checks predict stands beside what is measured, as it happens."""

from __future__ import annotations

from mars2d.core.deadline import Deadline
from mars2d.output.raster.layout import TEXT_SIZES, Layout
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.theme import LIGHT
from mars2d.scenario.experiment import open_experiment
from mars2d.window.panels.predictions import Predictions
from mars2d.world.timeline import Timeline
from tests.cases import each_case
from tests.window.written import THEMES, Written, painter

HEAD = """
from mars2d import Prediction, Robot, Scenario
import time

def ahead(robot):
    return 0.5, 0.0

scenario = Scenario(robots=[Robot(controller=ahead)], workspace=None, stop_time=2.0)

def checks(record):
"""
WAY = "    yield Prediction('way', 1.0, record.pose[-1, 0, 0], 0.01, 'm')\n"


class Desk:
    """A panel over a run, and what it says."""

    def __init__(self, path, body, size=(320, 400), theme=LIGHT, text=1.0):
        path = path / "mine.py"
        path.write_text(HEAD + body)
        self.timeline, self.now = Timeline(open_experiment(path)), 0.0
        layout = Layout.of((1280, 720), text=text, controls=True)
        self.panel = Predictions(painter(layout, theme), self.timeline, lambda: self.now)
        self.panel.wanted = True
        self.size = size

    def run(self, rows):
        for _ in range(rows):
            self.timeline.advance()

    def finish(self):
        while not self.timeline.over:
            self.timeline.advance()

    def look(self, seconds=10.0, *, playing=True):
        self.now += seconds
        return self.panel.look(playing=playing)

    def drawn(self):
        part = Written(self.size)
        self.panel.draw(part, part.get_rect(), self.timeline.frame)
        return part

    @property
    def says(self):
        return self.drawn().texts


def test_a_prediction_is_not_yet_then_ok_so_far_then_ok(tmp_path):
    desk = Desk(tmp_path, WAY)
    desk.run(6)
    assert desk.look()
    assert {"way", "1.000", "0.250", "0.01 m", "not yet"} <= set(desk.says)
    assert "0 of 1 prediction ok at 0.5 s" in desk.says
    desk.finish()
    assert desk.look()
    assert {"1.000", "ok"} <= set(desk.says)
    assert "1 of 1 prediction ok at the end" in desk.says


def test_an_error_while_the_run_goes_on_is_not_yet_and_at_the_end_an_error(tmp_path):
    body = WAY + "    yield Prediction('blow', 1.0, record.contacts['impulse'][0], 0.01, 'N s')\n"
    desk = Desk(tmp_path, body)
    desk.run(5)
    desk.look()
    assert "way" in desk.says
    told = " ".join(desk.says)
    assert "Not yet: mine.py, line 12: checks raised IndexError" in told
    assert desk.timeline.error is None
    desk.finish()
    desk.look()
    assert "Failed: mine.py, line 12: checks raised IndexError" in " ".join(desk.says)
    assert desk.timeline.over, "the run has come to its own end"


def test_checks_that_never_return_are_broken_off_and_the_run_goes_on(tmp_path):
    desk = Desk(tmp_path, "    while record.scenario is not None:\n        time.sleep(0)\n")
    desk.run(5)
    with Deadline(0.3, calls=lambda: desk.timeline.world.simulation.calls):
        desk.look()
    assert "did not return within 0.3 s" in str(desk.panel.error)
    desk.run(5)
    assert desk.timeline.row == 10


def test_checks_are_asked_seldom_while_time_passes(tmp_path):
    desk = Desk(tmp_path, WAY)
    desk.run(2)
    assert desk.look()
    assert not desk.look(0.0), "nothing has happened since"
    desk.run(1)
    assert not desk.look(0.1)
    assert desk.look(0.2)
    desk.run(1)
    assert not desk.look(0.1)
    assert desk.look(0.0, playing=False)


def test_a_run_changed_by_hand_has_no_predictions_and_a_new_start_has(tmp_path):
    desk = Desk(tmp_path, WAY)
    desk.run(3)
    desk.timeline.change(lambda world: world.operator.place(0, (1, 1, 0)))
    desk.run(3)
    desk.look()
    assert "A hand has changed this run" in " ".join(desk.says)
    desk.timeline.restart()
    desk.run(4)
    desk.look()
    assert "way" in desk.says


def test_after_a_slider_r_runs_again_with_its_value_and_predicts(open_window):
    window = open_window(0, experiment="push_box")
    window.press("F3", "Right")
    panel = window.shown.dock.predictions
    window.shown.dock.parameters._set("mu", 0.4)
    window.settle()
    assert "R: again with mu = 0.4, and predict." in panel._words()
    window.press("r", "Right")
    window.settle()
    assert panel._timeline.experiment.options == {"mu": 0.4}
    assert panel._words() == "Nothing is measured yet.", "it predicts, as of a run unchanged"


@THEMES
@each_case("text", TEXT_SIZES)
def test_words_and_numbers_never_lie_on_each_other(tmp_path, theme, text):
    body = "".join(
        f"    yield Prediction('{name}', {value!r}, {value!r} + 1e-12, {tolerance!r}, '{unit}')\n"
        for name, value, tolerance, unit in (
            ("a", 2.0, 1e-9, "kg m/s"),
            ("a long name that has no room beside its verdict at all", 12345.678, 1e-3, "degrees"),
            ("count", 3, 0, ""),
            ("infinite", 1e12, 1.0, "N"),
        )
    )
    body += "    yield Prediction('none', 1.0, float('nan'), 0.1, 'm')\n"
    desk = Desk(tmp_path, body, size=(round(316 * text), round(420 * text)), theme=theme, text=text)
    desk.run(3)
    desk.look()
    assert desk.drawn().crowded() == []
    assert "-" in desk.says


def test_without_a_measurement_the_panel_says_so_at_its_top():
    panel = Predictions(Painter(), None)
    assert len(panel.rows(None, 300.0)) == 1
    assert panel.foot(300.0) == ()
