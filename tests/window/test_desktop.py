"""How many pixels a point has is found out, or said by a variable; a window fits on the screen."""

import os
import shutil
import subprocess
import sys

import pytest

from mars2d.core.errors import InputError
from mars2d.window import desktop
from mars2d.window.desktop import be_sharp, desktop_scale, opening_size
from tests.cases import each_case
from tests.processes import x_server

TOOLS = ("Xvfb", "xprop")
missing = [tool for tool in TOOLS if shutil.which(tool) is None]
ASK = """
import pygame
from mars2d.window.desktop import desktop_scale, opening_size
from mars2d.window.display import open_display
open_display()
print(desktop_scale(), *opening_size((1280, 720), desktop_scale()))
"""


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


@each_case("chosen", ["large", "0", "-2", "nan", "inf", "1e9"])
def test_a_variable_that_is_no_scale_is_refused(monkeypatch, chosen):
    monkeypatch.setenv("MARS2D_SCALE", chosen)
    with pytest.raises(InputError, match=r"MARS2D_SCALE=.*expected the pixels of a point"):
        desktop_scale()


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


@each_case("driver", ["cocoa", "wayland", "dummy", None])
def test_where_the_system_enlarges_windows_a_point_is_a_pixel(on, driver):
    on(driver, "Xft.dpi: 192")
    assert desktop_scale() == 1.0


def test_windows_is_asked_not_to_enlarge_unless_somebody_has_said_otherwise(monkeypatch):
    monkeypatch.delenv("SDL_WINDOWS_DPI_AWARENESS", raising=False)
    be_sharp()
    assert os.environ["SDL_WINDOWS_DPI_AWARENESS"] == "permonitorv2"
    monkeypatch.setenv("SDL_WINDOWS_DPI_AWARENESS", "unaware")
    be_sharp()
    assert os.environ["SDL_WINDOWS_DPI_AWARENESS"] == "unaware"


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


@pytest.mark.slow
@pytest.mark.skipif(bool(missing), reason=f"{', '.join(missing)} not installed")
def test_a_real_x_server_tells_its_scale():
    with x_server(3000, 2000) as (screen, _):
        hidden = ("WAYLAND_DISPLAY", "SDL_VIDEODRIVER", "GDK_SCALE", "MARS2D_SCALE")
        environment = {k: v for k, v in os.environ.items() if k not in hidden} | {"DISPLAY": screen}

        def asked():
            command = [sys.executable, "-c", ASK]
            done = subprocess.run(
                command, env=environment, capture_output=True, text=True, check=False
            )
            assert done.returncode == 0, done.stderr
            return done.stdout.split()

        assert asked() == ["1.0", "1280", "720"]
        command = ["xprop", "-root", "-f", "RESOURCE_MANAGER", "8s"]
        command += ["-set", "RESOURCE_MANAGER", "Xft.dpi:\t192\n"]
        subprocess.run(command, env=environment, check=True)
        assert asked() == ["2.0", "2560", "1440"]
