"""``.mat``: a struct that Matlab and Octave open."""

from __future__ import annotations

import re
import shutil
import subprocess

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
        "Addons", "Robot", "Animation", "History",
    }  # fmt: skip
    assert in_table_1 <= out.keys()
    assert out["Robots"] == 3
    assert out["Robot"]["Diameter"].tolist() == [0.3, 0.3, 0.3]
    assert out["Non_holonomic"].tolist() == [1, 0, 1]
    assert out["Animation"]["Title"].rstrip() == "Grüße 🤖"
    assert out["Seed"] == 2**63 - 1


def test_no_column_is_twice_in_the_file(tmp_path):
    record = everything()
    out = loadmat(record.save(tmp_path / "run.mat"))["out_data"]
    sizes = []

    def walk(value) -> None:
        if value.dtype.names:
            for name in value.dtype.names:
                walk(value[name][0, 0])
        elif value.dtype.kind in "fbu" and value.size > 15:
            sizes.append(value.size)

    walk(out)
    columns = [column.size for name, column in record.columns().items() if "conte" not in name]
    assert sorted(sizes) == sorted(
        [size for size in columns if size > 15] + [len(record.messages)]  # message:content
    )


@pytest.mark.slow
@needs_octave
def test_octave_opens_it_with_shapes_values_and_texts(tmp_path):
    record = everything()
    record.save(tmp_path / "run.mat")
    code = """
load run.mat
H = out_data.History;
disp(size(H.Time)), disp(size(H.Pose)), disp(size(H.Command)), disp(size(H.Prop_pose))
printf("%.17g\\n", H.Pose(end, 1, 3), H.Command(2, 2, 3), H.Time(end))
disp(class(out_data.Contacts.began)), disp(class(out_data.Contacts.a))
printf("%d %d\\n", [out_data.Contacts.a, out_data.Contacts.b]')
disp(out_data.Robot.Name{out_data.Contacts.a(1)})
disp(size(out_data.Sensors.gr__e)), disp(class(out_data.Sensors.gr__e))
disp(out_data.Sensor_robots.grid')
disp(out_data.Exp_over_msg), disp(out_data.Animation.Title), disp(out_data.Robot.Name{2})
header = jsondecode(out_data.Header);
disp(header.contents{out_data.Messages.content(1)})
"""
    text = octave(code, tmp_path)
    n = len(record)
    shapes = [[int(number) for number in line.split()] for line in text[:4]]
    assert shapes == [[n, 1], [n, 3, 3], [n, 2, 3], [n, 3, 2]]
    exact = [record.pose[-1, 0, 2], record.command[1, 1, 2], record.time[-1]]
    assert [float(line) for line in text[4:7]] == exact
    assert text[7:9] == ["logical", "double"]
    contacts = record.contacts
    # Bodies are counted from 1; obstacles are below 0 here and there.
    pairs = [f"{a + 1} {b + 1 if b >= 0 else b}" for a, b in contacts[["a", "b"]].tolist()]
    assert (contacts["b"] < 0).any()
    assert (contacts["b"] > 0).any()
    text = text[9:]
    assert text[: len(pairs)] == pairs
    text = text[len(pairs) :]
    assert text[0] == ["robot0", 'größe, "x"', "robot2"][contacts["a"][0]]
    assert text[1].split() == [str(n), "1", "4"]
    assert text[2] == "logical"
    assert text[3].split() == ["1", "3"]
    assert text[4:7] == ["Time is over: 2 s", "Grüße 🤖", 'größe, "x"']
    assert text[7] == record.contents[record.messages["content"][0]]


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
