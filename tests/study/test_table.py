"""Tables of studies as files, and what is no table."""

from __future__ import annotations

import pytest

from mars2d import InputError
from mars2d.study.table import Result, Table
from tests.cases import each_case

ROWS = (
    Result(1, {"n": 1, "red": "a, b.py"}, 0, {"time": 0.1 + 0.2, "won": "red"}, "", "ab", "12"),
    Result(2, {"n": 1, "red": "5"}, 1, {"time": None, "won": None}, 'a.py, line 3: "no"', "", ""),
    Result(3, {"n": (1, 2), "red": ""}, 2, {"time": 3, "won": "blue"}, "", "cd", "12"),
)
TABLE = Table("duel.py", ("n", "red"), ("time", "won"), ROWS)


def of(*results):
    return Table("duel.py", ("n", "red"), ("time", "won"), results)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "results.csv"


def test_a_table_comes_back_from_its_file_as_it_was(path):
    assert Table.load(TABLE.save(path)) == TABLE


def test_the_file_is_as_rfc_4180_has_it(path):
    TABLE.save(path)
    assert path.read_bytes().decode().split("\r\n") == [
        "row,experiment,n,red,seed,time,won,digest,code,error",
        '1,duel.py,1,"a, b.py",0,0.30000000000000004,red,ab,12,',
        '2,duel.py,1,\'5\',1,,,,,"a.py, line 3: ""no"""',
        '3,duel.py,"(1, 2)",,2,3,blue,cd,12,',
        "",
    ]


@each_case(
    "data, said",
    [
        (b"", "it is empty"),
        (b"a,b\r\n1,2\r\n", "is no table of a study"),
        (b"\xff\xfe\r\n", "UTF-8"),
        (b"row,experiment,seed,digest,code,error\r\n1,a.py,0\r\n", "line 2: 3 cells, expected 6"),
        (b"row,experiment,seed,digest,code,error\r\nx,a.py,0,,,\r\n", "line 2: row = 'x'"),
        (b"row,experiment,seed,digest,code,error\r\n1,a.py,-1,,,\r\n", "line 2: seed = '-1'"),
        (b'row,experiment,seed,digest,code,error\r\n1,"a"b,0,,,\r\n', "line 2"),
        (
            b"row,experiment,seed,digest,code,error\r\n1,a.py,0,,,\r\n2,b.py,0,,,\r\n",
            "line 3: experiment 'b.py', where the rows before have 'a.py'",
        ),
    ],
)
def test_what_is_no_table_says_so_in_one_line(path, data, said):
    path.write_bytes(data)
    with pytest.raises(InputError) as caught:
        Table.load(path)
    assert said in str(caught.value)
    assert str(path) in str(caught.value)


def test_a_frame_has_a_row_a_run_and_columns_of_settings_and_measures():
    pytest.importorskip("pandas")
    frame = TABLE.to_frame()
    assert [*frame.columns] == ["n", "red", "seed", "time", "won", "digest", "code", "error"]
    assert frame.loc[1, "time"] == 0.1 + 0.2
    assert frame["n"].tolist() == [1, 1, (1, 2)]
    assert of(ROWS[1]).to_frame()["time"].dtype == float  # a column of nothing is one of numbers
