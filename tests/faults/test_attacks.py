"""Attacks by names, variables and settings: each works, or is one named error; nothing is lost."""

import itertools
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d import InputError, Scenario
from mars2d.addons import Map
from mars2d.cli.command_line import main
from mars2d.output.formats import SUFFIXES
from tests.processes import PATIENCE, bare_environment, mars

# -- names of files -------------------------------------------------------------------------------

NAMES = [
    "a b", "a  b ", "-a", "--set", "a;b", "a|b", "$HOME", "`id`", "a'b", 'a"b', "a*b", "a?b", "[a]",
    "{a}", "~", "a,b", "a=b", "a:b", "a%b", "%s", "{0}", "a\\b", "#a", "a#b", "a&b", "<a>", "a\tb",
    "a\nb", "\x1b[31m", "\u202ea", "\u4e2d\u6587", "\u00e9", "e\u0301", "\U0001f916", "CON", "nul",
    ".hidden", "..a", "a.npz", "a.csv.npz", "x" * 200, "\udcff", "y" * 254,
]  # fmt: skip


@pytest.fixture(scope="module")
def record():
    return mars2d.run(Scenario(robots=2, stop_time=0.3), control=lambda world: np.zeros((2, 2)))


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("name", NAMES, ids=ascii)
def test_a_record_is_found_again_under_any_name(record, tmp_path, name, suffix):
    path = tmp_path / (name + suffix)
    if len(os.fsencode(path.name)) > 255:
        with pytest.raises(InputError, match="can't be written"):
            record.save(path)
        assert list(tmp_path.iterdir()) == []
        return
    saved = record.save(path)
    assert mars2d.load(saved).digest == record.digest
    assert all(each.name.startswith(name) for each in tmp_path.iterdir())


# -- settings -------------------------------------------------------------------------------------

FIELDS = [
    "sampling_time", "stop_time", "command_delay", "max_overlap", "on_exit", "physics", "title",
    "robots", "robots.0.pose", "robots.*.diameter", "robots.0.drive.max_linear_speed",
    "robots.0.mass", "workspace", "animation.wake_style", "neighbours", "sees", "seed", "",
]  # fmt: skip

VALUES = [
    "nan", "inf", "-1", "1e400", "0", "True", "None", "''", "[]", "{}", "()", "(1, 2, 3)", "1j",
    "'a' * 10", "__import__('os').system('true')", "lambda: 0", "9" * 400, "0x10", "1_000",
    "[[[[[[]]]]]]", "\x00", "\u0661", "b'x'", "...",
]  # fmt: skip


@pytest.mark.parametrize("field", FIELDS, ids=lambda each: each or "none")
def test_no_setting_breaks_a_run(field, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("walk.py").write_text(
        "from mars2d import Robot, Scenario\n"
        "scenario = Scenario(robots=[Robot(controller=lambda robot: (0.1, 0))], stop_time=0.3)\n"
    )
    for value in VALUES:
        code = main(
            ["run", "walk.py", "--headless", "--set", f"{field}={value}", "--stop-time", "0.3"]
        )
        told = capsys.readouterr().err
        assert code in (0, 2), (value, told)
        assert "Traceback" not in told, value
        assert "fault of MARS2D" not in told, value
        assert code == 0 or told.count("mars2d: ") == 1, (value, told)


# -- the environment ------------------------------------------------------------------------------

VARIABLES = {
    "LANG": ["C", "nonsense", "tr_TR.UTF-8"],
    "LC_ALL": ["C", "POSIX", "de_DE.ISO-8859-1"],
    "PYTHONIOENCODING": ["ascii", "latin-1", "utf-16", "utf-8:strict"],
    "PYTHONUTF8": ["0", "1"],
    "PYTHONHASHSEED": ["0", "4294967295"],
    "PYTHONOPTIMIZE": ["1", "2"],
    "PYTHONWARNINGS": ["error", "ignore"],
    "PYTHONDEVMODE": ["1"],
    "TZ": ["", "Nowhere/Land", "Pacific/Kiritimati"],
    "HOME": ["", "/nowhere", "/dev/null"],
    "TMPDIR": ["/nowhere", "/dev/null"],
    "XDG_RUNTIME_DIR": ["/nowhere"],
    "XDG_CONFIG_HOME": ["/nowhere", "/dev/null"],
    "MPLBACKEND": ["agg", "TkAgg", "svg"],
    "MPLCONFIGDIR": ["/nowhere"],
    "COLUMNS": ["0", "-1", "1", "many"],
    "TERM": ["", "dumb", "vt52"],
    "SDL_VIDEODRIVER": ["dummy", "nonsense"],
    "OMP_NUM_THREADS": ["1", "0", "many"],
    "MARS2D_PATIENCE": ["1", "0", "1e-3", "1e300"],
    "MARS2D_SCALE": ["2", "1e9"],
}


def alone(*words, cwd, **environment):
    """Run a command line in a process that has imported nothing before."""
    return subprocess.run(
        [sys.executable, "-m", "mars2d", *words], cwd=cwd, timeout=PATIENCE, check=False,
        capture_output=True, text=True, errors="replace", env=bare_environment(**environment),
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("variable", VARIABLES)
def test_no_variable_changes_a_run(variable, tmp_path):
    (tmp_path / "walk.py").write_text(
        "from mars2d import Robot, Scenario\n"
        "scenario = Scenario(robots=[Robot(controller=lambda robot: (0.1, 0))], stop_time=0.5)\n"
    )
    digests = set()
    for value in VARIABLES[variable]:
        words = ["run", "walk.py", "--headless", "--record", "a.npz", "--figure", "a.png"]
        done = alone(*words, cwd=tmp_path, **{variable: value})
        assert done.returncode == 0, (value, done.stderr)
        assert "Traceback" not in done.stderr, value
        digests.add(mars2d.load(tmp_path / "a.npz").digest)
        os.remove(tmp_path / "a.npz")  # noqa: PTH107
    assert len(digests) == 1


@pytest.mark.parametrize("line", ["run walk.py --headless", "check x.png", "sweep walk.py"])
def test_a_backend_that_is_none_is_named_before_the_run(line, tmp_path):
    (tmp_path / "walk.py").write_text("from mars2d import Scenario\nscenario = Scenario()\n")
    (tmp_path / "x.png").write_bytes(b"")
    done = alone(*line.split(), "--figure", "a.png", cwd=tmp_path, MPLBACKEND="nonsense")
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "MPLBACKEND='nonsense': matplotlib has no such backend" in done.stderr or "x.png" in line
    assert "Traceback" not in done.stderr


def test_they_are_many():
    variables = sum(map(len, VARIABLES.values()))
    settings = len([*itertools.product(FIELDS, VALUES)])
    assert (len(NAMES) * len(SUFFIXES), settings, variables) == (129, 432, 52)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes of POSIX")
@pytest.mark.parametrize(
    "words",
    [
        ("run", "law.py", "--headless"),
        ("run", "law.toml"),
        ("check", "law.npz"),
        ("replay", "l.csv"),
    ],
)
def test_a_pipe_that_nobody_writes_to_is_not_waited_for(tmp_path, words):
    os.mkfifo(tmp_path / next(word for word in words if "." in word))
    done = mars(*words, cwd=tmp_path)
    assert done.returncode == 2
    assert ": not a file; expected a" in done.stderr


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes of POSIX")
def test_a_map_is_no_pipe(tmp_path):
    os.mkfifo(tmp_path / "map.dxf")
    with pytest.raises(InputError, match="not a file; expected a map"):
        Map.from_file(tmp_path / "map.dxf")
