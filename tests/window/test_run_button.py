"""The Run button of an editor: it runs an experiment's file with Python."""

import subprocess
import sys

import pytest

from mars2d.cli import command_line as cli
from tests.processes import PATIENCE, bare_environment, started, wait_until
from tests.window.person import needs_screen


@needs_screen
@pytest.mark.slow
def test_the_run_button_of_an_editor_opens_the_window(tmp_path, screen):
    assert cli.main(["new", str(tmp_path / "my_walk")]) == 0
    environment = bare_environment(DISPLAY=screen)
    with started([sys.executable, "my_walk.py"], env=environment, cwd=tmp_path) as window:

        def title():
            asked = ["xdotool", "getwindowfocus", "getwindowname"]
            return subprocess.run(
                asked, env=environment, capture_output=True, text=True, check=False
            ).stdout

        wait_until(lambda: title() == "My walk - MARS2D\n", window)
        subprocess.run(["xdotool", "key", "Escape"], env=environment, check=True)
        assert window.wait(PATIENCE) == 0
