"""What the mouse does is done by the keyboard alone, too."""


def test_a_menu_opens_on_what_is_selected_or_on_the_floor(open_window, room):
    window = open_window(0, experiment=str(room))
    window.press("F10")
    assert "Show all" in window.settle()["menu"]
    window.press("Escape", "Tab", "Tab", "Tab", "F10")
    menu = window.shown.menu
    window.type("f")  # by its first letter
    assert menu.chosen == "Follow with the camera"
    window.press("Return")
    window.until(lambda s: s["following"])


def test_sliders_are_reached_and_set_by_keys(open_window, pushing):
    window = open_window(0, experiment=str(pushing))
    window.press("Tab", "Tab", "Tab", "shift+F2")
    panel = window.shown.dock.parameters
    assert panel.is_open
    window.settle()
    assert panel.focus.startswith("props.crate.")
    assert panel.focus in panel.places, "it is seen"
    before = panel.parameters()[panel.focus].value
    window.press("Right")
    assert panel.parameters()[panel.focus].value > before
    assert window.settle()["row"] == 0
    window.press("Escape", "Right")
    assert window.settle()["row"] == 1
    window.press("shift+F2")
    window.click(2.5, 1.5)
    window.press("Right")
    assert window.settle()["row"] == 2, "a click beside the panel gives keys back to the window"


def test_panels_are_scrolled_by_keys(open_window, tmp_path):
    path = tmp_path / "long.py"
    words = "Question: " + " ".join(f"what is {k} times {k}?" for k in range(200))
    path.write_text(
        f"'''Long. {words} Try: it.'''\nfrom mars2d import Robot, Scenario\n"
        "scenario = Scenario(robots=[Robot()])\n"
    )
    window = open_window(0, experiment=str(path))
    window.press("F4")
    lesson = window.shown.dock.lesson
    window.shown.dock.scopes.switch("x", (0,))
    window.settle()
    assert lesson.scroll.cut
    window.press("shift+Next", "shift+Next")
    assert lesson.scroll.at > 100
    window.press("shift+Prior", "shift+Prior", "shift+Prior")
    assert window.settle()["row"] == 0, "without Shift they are steps"
    assert lesson.scroll.at == 0


def test_with_a_slider_in_the_hand_the_help_opens_and_escape_closes_it(open_window, pushing):
    window = open_window(0, experiment=str(pushing), text=2.2)
    window.resize(1152, 720)
    window.press("F2", "F4", "Tab", "shift+F2")
    assert "parameters" in window.settle()["panels"], "the sliders come to sight"
    window.press("F1")
    window.until(lambda s: s["help"] == 0)
    window.press("Escape")
    window.until(lambda s: s["help"] is None)
    assert window.shown.dock.parameters.focus
