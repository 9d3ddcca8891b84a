"""Which files play which role."""

from __future__ import annotations

from pathlib import Path

import pytest

from mars2d.core.errors import InputError
from mars2d.tournaments.isolation.source import law_code
from mars2d.tournaments.schedule import entrants, law_files, names_of
from tests.cases import each_case

ROLES = ("pursuer", "evader")


@pytest.fixture
def laws(tmp_path, monkeypatch) -> Path:
    for name in ("hunters/b.py", "hunters/a.py", "hunters/_help.py", "hunters/notes.txt", "c.py"):
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text("raise SystemExit('laws are not run here')\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@each_case("named", ["hunters", "hunters/", "hunters/*.py", "hunters/[ab].py"])
def test_a_folder_and_a_pattern_stand_for_their_laws_in_order(laws, named):
    assert law_files(named) == (laws / "hunters/a.py", laws / "hunters/b.py")


def test_names_show_what_nobody_sees():
    files = ["a\nb.py", "a\\nb.py", "c\u202e\u200b.py"]
    assert [*names_of(files).values()] == ["a\\nb", "a\\\\nb", "c\\u202e\\u200b"]


def test_files_between_commas_are_taken_once_each(laws):
    assert law_files("c.py,hunters/b.py, c.py") == (laws / "c.py", laws / "hunters/b.py")
    assert law_files("hunters/_help.py") == (laws / "hunters/_help.py",)  # as it is named


def test_laws_in_the_current_folder_come_first_then_those_beside_the_game(laws, tmp_path):
    game = tmp_path / "game"
    (game / "hunters").mkdir(parents=True)
    for name in ("c.py", "d.py", "hunters/a.py", "hunters/z.py"):
        (game / name).touch()
    assert law_files("c.py,d.py", game) == (laws / "c.py", game / "d.py")
    assert law_files("hunters", game) == (laws / "hunters/a.py", laws / "hunters/b.py")
    assert law_files("hunters/z.py", game) == (game / "hunters/z.py",)


@each_case(
    "named, message",
    [
        ("hunter", "hunter: no such file; .* did you mean 'hunters'?"),
        ("hunters/c.py", "hunters/c.py: no such file; .*"),
        ("hunters/*.txt", r"hunters/\*.txt: no such file"),
        ("hunters/notes.txt", "hunters/notes.txt: expected the file of a law"),
        (" , ", "expected files of laws"),
    ],
)
def test_what_is_no_law_is_an_error_with_the_nearest_name(laws, named, message):
    with pytest.raises(InputError, match=message):
        law_files(named)


def test_players_play_every_role_beside_those_given_for_one(laws):
    found = entrants(ROLES, {"pursuer": "hunters"}, ["c.py"])
    assert [path.name for path in found["pursuer"]] == ["a.py", "b.py", "c.py"]
    assert [path.name for path in found["evader"]] == ["c.py"]


def test_roles_that_are_not_there_or_that_nobody_plays_are_errors(laws):
    with pytest.raises(InputError, match="no role 'pursuers'; did you mean 'pursuer'"):
        entrants(ROLES, {"pursuers": "no such file"})
    with pytest.raises(InputError, match=r"no laws for the role 'evader': .*--role evader=FILES"):
        entrants(ROLES, {"pursuer": "c.py"})
    with pytest.raises(InputError, match="expected files of laws"):
        entrants(ROLES, {"pursuer": [3]})  # type: ignore[dict-item]


def test_the_code_of_a_law_is_its_file_and_what_it_imports_from_beside_it(laws):
    (laws / "c.py").write_text("import math, help1 as h\n    from help2 import thing\n")
    (laws / "help1.py").write_text("import c\n")
    (laws / "help2.py").write_text("# from help3 import nothing\n")
    (laws / "help3.py").touch()
    assert {path.name for path in law_code(laws / "c.py")} == {"c.py", "help1.py", "help2.py"}
    assert law_code(laws / "gone.py") == {}


def test_the_code_of_a_law_is_also_that_of_the_folders_it_imports(tmp_path):
    law, tool, other = tmp_path / "law.py", tmp_path / "mine" / "tool.py", tmp_path / "other.py"
    tool.parent.mkdir()
    law.write_text("import math; from mine.tool import K\n")
    tool.write_text("import other\n")
    other.write_text("K = 1\n")
    (tmp_path / "stranger.py").write_text("K = 2\n")
    assert set(law_code(law)) == {law, tool, other}
