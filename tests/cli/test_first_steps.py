"""The first steps: a new experiment, a copy of an example, completion in a shell."""

import shutil
import subprocess

import pytest

import mars2d
from mars2d.cli import command_line as cli
from mars2d.scenario.examples import examples, games
from tests.cases import each_case


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_new_experiment_runs_and_is_kept(here, capsys):
    assert cli.main(["new", "my_walk"]) == 0
    assert capsys.readouterr().out == "my_walk.py: written; run it: mars2d run my_walk.py\n"
    assert cli.main(["run", "my_walk.py", "--headless", "--stop-time", "5"]) == 0
    assert "My walk: finished after" in capsys.readouterr().out
    (here / "my_walk.py").write_text("mine")
    assert cli.main(["new", "my_walk.py"]) == cli.BAD_INPUT
    assert (here / "my_walk.py").read_text() == "mine"


@each_case("name", ["3d", "a-b", "walk.toml", "mars2d", "", "a b.py"])
def test_a_name_that_python_can_not_import_is_refused(here, capsys, name):
    assert cli.main(["new", name]) == cli.BAD_INPUT
    assert "expected a name of letters, digits and underscores" in capsys.readouterr().err
    assert not [*here.iterdir()]


@pytest.mark.slow
@each_case("name", examples())
def test_an_example_is_copied_with_all_that_it_needs(here, name):
    assert cli.main(["copy", name, "mine"]) == 0
    copied = here / "mine" / (f"{name}/game.py" if name in games() else f"{name}.py")
    assert copied.read_bytes() == examples()[name].read_bytes()
    record = mars2d.run(copied, stop_time=0.2, show=False)
    assert record.pose.tolist() == mars2d.run(name, stop_time=0.2, show=False).pose.tolist()


def test_a_copy_replaces_nothing_and_a_wrong_name_is_answered(here, capsys):
    assert cli.main(["copy", "corner_game"]) == 0
    assert "run it: mars2d run corner_game/game.py" in capsys.readouterr().out
    copied = {path.name for path in (here / "corner_game").iterdir()}
    assert copied == {"game.py", "pursuers", "evaders", "learned.onnx"}
    assert cli.main(["run", "corner_game/"]) == cli.BAD_INPUT
    assert "did you mean corner_game/game.py?" in capsys.readouterr().err
    (here / "corner_game" / "game.py").write_text("mine")
    assert cli.main(["copy", "corner_game"]) == cli.BAD_INPUT
    assert "corner_game: is there already" in capsys.readouterr().err
    assert (here / "corner_game" / "game.py").read_text() == "mine"
    assert cli.main(["copy", "corner_gam"]) == cli.BAD_INPUT
    assert "did you mean 'corner_game'?" in capsys.readouterr().err


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash here")
@each_case(
    "words, wanted",
    [
        (["mars2d", "swe"], {"sweep"}),
        (["mars2d", "copy", "corner_g"], {"corner_game"}),
        (["mars2d", "run", "wal"], {"walk.py", "walk.txt"}),
        (["mars2d", "run", "x.py", "--headl"], {"--headless"}),
    ],
)
def test_bash_completes_commands_options_and_files(here, capsys, words, wanted):
    pytest.importorskip("shtab")
    (here / "walk.py").touch()
    (here / "walk.txt").touch()
    assert cli.main(["doctor", "--completion", "bash"]) == 0
    (here / "complete.sh").write_text(capsys.readouterr().out)
    for shell in ("zsh", "tcsh", "fish", "powershell"):
        assert cli.main(["doctor", "--completion", shell]) == 0
        assert "tournament" in capsys.readouterr().out
    line = " ".join(words)
    script = (
        f"source complete.sh; COMP_WORDS=({line}); COMP_CWORD={len(words) - 1}; "
        f"COMP_LINE='{line}'; _shtab_mars2d; printf '%s\\n' \"${{COMPREPLY[@]}}\""
    )
    done = subprocess.run(
        ["bash", "--norc", "-c", script], check=False, capture_output=True, text=True
    )
    assert set(done.stdout.split()) == wanted, done.stderr
