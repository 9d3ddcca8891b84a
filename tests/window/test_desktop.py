"""How many pixels a point has is found out, or said by a variable; a window fits on the screen."""

import pytest

from mars2d.window.screen import desktop
from mars2d.window.screen.desktop import desktop_scale, opening_size
from tests.cases import each_case


@pytest.fixture
def on(monkeypatch):
    """Pretend that the display has a driver, and that the X server has resources."""

    def pretend(driver, resources=""):
        monkeypatch.delenv("MARS2D_SCALE", raising=False)
        monkeypatch.delenv("GDK_SCALE", raising=False)
        monkeypatch.setattr(desktop.pygame.display, "get_init", lambda: driver is not None)
        monkeypatch.setattr(desktop.pygame.display, "get_driver", lambda: driver)
        monkeypatch.setattr(desktop, "_resources", lambda: resources)

    return pretend


@each_case("chosen, scale", [("1.5", 1.5), ("2", 2.0), ("0.5", 0.5)])
def test_the_variable_decides(on, monkeypatch, chosen, scale):
    on("x11", "Xft.dpi:\t288\n")
    monkeypatch.setenv("MARS2D_SCALE", chosen)
    assert desktop_scale() == scale


@each_case(
    "resources, scale",
    [
        ("Xft.dpi:\t192\n", 2.0),
        ("Xcursor.size:\t24\nXft.dpi:\t120\nXft.hinting:\t1\n", 1.25),
        ("Xft.dpi: 96.0", 1.0),
        ("Xft.dpi:\t72\n", 1.0),
        ("Xft.dpi:\t99999\n", 8.0),
        ("Xft.dpi:\tmany\n", 1.0),
        ("", 1.0),
    ],
)
def test_an_x_server_is_asked_for_its_resources(on, resources, scale):
    on("x11", resources)
    assert desktop_scale() == scale


@each_case("chosen, scale", [("2", 2.0), ("much", 1.5)])
def test_gdk_scale_goes_before_them(on, monkeypatch, chosen, scale):
    on("x11", "Xft.dpi: 144")
    monkeypatch.setenv("GDK_SCALE", chosen)
    assert desktop_scale() == scale


@each_case(
    "screen, scale, size",
    [
        ((3840, 2160), 2.0, (2560, 1440)),
        ((2560, 1440), 2.0, (2304, 1296)),  # nine tenths
        ((1920, 1080), 1.0, (1280, 720)),
        ((1366, 768), 1.0, (1229, 691)),  # the desktop's own bars need room
        ((1024, 768), 1.0, (922, 691)),
        ((1024, 768), 3.0, (922, 691)),
        ((1920, 1080), 0.5, (640, 360)),
    ],
)
def test_a_window_is_as_large_as_its_points_but_fits(monkeypatch, screen, scale, size):
    monkeypatch.setattr(desktop.pygame.display, "get_desktop_sizes", lambda: [screen])
    assert opening_size((1280, 720), scale) == size
