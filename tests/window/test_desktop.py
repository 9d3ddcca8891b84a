"""How many pixels a point has is found out, or said by a variable; a window fits on the screen."""

from mars2d.window.screen import desktop
from mars2d.window.screen.desktop import desktop_scale, opening_size
from tests.cases import each_case


@each_case("chosen, scale", [("1.5", 1.5), ("2", 2.0), ("0.5", 0.5)])
def test_the_variable_decides(monkeypatch, chosen, scale):
    monkeypatch.setenv("MARS2D_SCALE", chosen)
    assert desktop_scale() == scale


@each_case(
    "screen, scale, size",
    [
        ((3840, 2160), 2.0, (2560, 1440)),
        ((2560, 1440), 2.0, (2304, 1296)),  # nine tenths
        ((1920, 1080), 1.0, (1280, 720)),
        ((1366, 768), 1.0, (1229, 691)),  # the desktop's own bars need room
        ((1024, 768), 3.0, (922, 691)),
        ((1920, 1080), 0.5, (640, 360)),
    ],
)
def test_a_window_is_as_large_as_its_points_but_fits(monkeypatch, screen, scale, size):
    monkeypatch.setattr(desktop.pygame.display, "get_desktop_sizes", lambda: [screen])
    assert opening_size((1280, 720), scale) == size
