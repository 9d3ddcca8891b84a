"""``.mat``: a struct that Matlab and Octave open."""

from __future__ import annotations

import re
import shutil
import subprocess

import numpy as np
import pytest
from scipy.io import loadmat

from tests.house.test_docs import ROOT, Reader, blocks
from tests.output.formats.records import everything
from tests.processes import PATIENCE

OCTAVE = shutil.which("octave-cli")
needs_octave = pytest.mark.skipif(OCTAVE is None, reason="GNU Octave is not installed")


def octave(code: str, folder) -> list[str]:
    """Run lines of Octave in a folder, where any error is one; return what they print."""
    (folder / "lines.m").write_text(code, encoding="utf-8")
    command = [OCTAVE, "--quiet", "--no-gui", "--no-init-file", "lines.m"]
    result = subprocess.run(
        command, cwd=folder, capture_output=True, encoding="utf-8", check=False, timeout=PATIENCE
    )
    assert result.returncode == 0, result.stderr
    return result.stdout.splitlines()


def test_the_struct_has_the_names_of_the_paper(tmp_path):
    out = loadmat(everything().save(tmp_path / "run.mat"), simplify_cells=True)["out_data"]
    in_table_1 = {
        "Robots", "Initial_pose", "Sampling_time", "Stop_time", "Workspace", "Bounds",
        "Non_holonomic", "Command_delay", "Exp_over", "Exp_over_msg", "Filename", "Version",
        "Addons", "Robot", "History",
    }  # fmt: skip
    assert in_table_1 <= out.keys()
    assert out["Robots"] == 3
    assert out["Robot"]["Diameter"].tolist() == [0.3, 0.3, 0.3]
    assert out["Non_holonomic"].tolist() == [1, 0, 1]
    obstacles = everything().scenario.obstacles
    vertices = [each["Vertex"].tolist() for each in np.atleast_1d(out["Map"]["Obstacle"])]
    assert vertices == [[[*point] for point in outline] for outline in obstacles]
    assert vertices
    assert out["Seed"] == 2**63 - 1


@pytest.mark.slow
@needs_octave
def test_the_lines_of_octave_in_the_docs_do_what_they_say(tmp_path, monkeypatch):
    document = ROOT / "docs" / "data.md"
    monkeypatch.chdir(tmp_path)
    reader, every = Reader(document), list(blocks(document))
    reader.python(next(block for block in every if block.language == "python"), "")
    lines = next(block.text for block in every if block.language == "matlab")
    hidden = "set(0, 'defaultfigurevisible', 'off')\n"
    plot = [OCTAVE, "--quiet", "--no-gui", "--no-init-file", "--eval", f"{hidden}axes"]
    if subprocess.run(plot, capture_output=True, check=False, timeout=PATIENCE).returncode:
        pytest.skip("Octave can't plot: apt-get install gnuplot-nox fonts-freefont-otf")
    code = hidden + lines + "\nprintf('%.17g\\n', first), size(get(gca, 'children'))"
    text = "\n".join(octave(code, tmp_path))
    contacts = reader.namespace["record"].contacts
    assert re.search(r"ans =\s+201\s+3\s+3", text)
    assert f"{contacts[contacts['a'] == 2]['time'][0]:.17g}\n" in text
    assert "ans = robot2" in text
    assert "ans = 20\n" in text
    assert re.search(r"ans =\s+4\s+1$", text)  # four lines are in the figure
